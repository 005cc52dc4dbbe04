//! The page `detectors of boards`.

use super::load::{Counted, Detectors, Found};
use crate::markdown::plain;
use crate::markdown::{MarkdownTable, contents, fixed, signed};
use crate::speeds::Speeds;
use crate::sweep::titled;
use crate::targets::{kind, without_kinds};

/// The page's name.
pub const FILE: &str = "detectors.md";

/// The page; `None` without a sweep of detectors over boards.
pub fn page(sweeps: &[&Detectors], speeds: &Speeds) -> Option<String> {
    sweeps.first()?;
    let mut body = String::new();
    for sweep in sweeps {
        for (place, board) in sweep.boards().into_iter().enumerate() {
            body.push_str(&format!("## `{board}`\n\n{}\n", table(sweep, place, speeds).render()));
        }
    }
    body.push_str(&rules(speeds));
    body.push_str("\n## Evidence\n\n");
    for sweep in sweeps {
        let loaded = &sweep.sweep;
        let trials = loaded.cells.iter().map(|cell| cell.trials).max().unwrap_or(0);
        body.push_str(&format!(
            "- `{0}`: `calibench run {0}`, seed {1}, {2} cells, trials of each: {trials}\n",
            loaded.name,
            loaded.seed,
            loaded.cells.len()
        ));
        loaded
            .scenario
            .notes
            .iter()
            .for_each(|note| body.push_str(&format!("- {}\n", note.split_whitespace().collect::<Vec<_>>().join(" "))));
    }
    Some(format!(
        "# Detectors of boards\n\n{}\n{}Made by `calibench report targets` from records; nothing here is written by hand.\n\n{}\n",
        answers(sweeps),
        contents(&body),
        body.trim_end()
    ))
}

/// Of each board at the first value of the other key: who finds how much of it, and whose origin of the pixel is elsewhere.
fn answers(sweeps: &[&Detectors]) -> String {
    let mut rows = MarkdownTable::new(&["board", "detector", "version", "found, %", "its points lie by dx, dy, px", "scatter, px"]);
    for sweep in sweeps {
        for (place, board) in sweep.boards().into_iter().enumerate() {
            for (method, found) in sweep.found(place, 0).into_iter().filter(|(method, _)| sweep.counted(place, 0, method).is_some()) {
                let version = sweep.version(method).unwrap_or_default().to_owned();
                let found_of_all = share(found.asked - missed(found), found.asked);
                rows.row([format!("`{board}`"), format!("`{method}`"), version, found_of_all, median(found), scatter(found)]);
            }
        }
    }
    rows.render()
}

const fn missed(found: &Found) -> u64 {
    found.asked - found.right - found.off
}

fn share(part: u64, whole: u64) -> String {
    if whole == 0 { String::new() } else { fixed(100.0 * part as f64 / whole as f64, 1) }
}

fn median(found: &Found) -> String {
    found.median().map_or_else(String::new, |[x, y]| format!("{}, {}", signed(x, 2), signed(y, 2)))
}

fn scatter(found: &Found) -> String {
    found.scatter().map_or_else(String::new, |scatter| fixed(scatter, 3))
}

fn table(sweep: &Detectors, board: usize, speeds: &Speeds) -> MarkdownTable {
    let axis = sweep.sweep.sweep.axes.get(1).map(titled);
    let rest = [
        "method",
        "boards",
        "points",
        "right, %",
        "missed, %",
        "beyond 1 px, %",
        "taken for another",
        "nowhere",
        "median dx, dy, px",
        "scatter, px",
        "over its bound",
        "ms an image",
    ];
    let header: Vec<&str> = axis.as_deref().into_iter().chain(rest).collect();
    let mut rows = MarkdownTable::new(&header);
    for (value, text) in sweep.values().into_iter().enumerate() {
        for (method, found) in sweep.found(board, value) {
            let first = axis.is_some().then(|| text.trim_matches(['[', ']']).to_owned());
            let own = cells(method, found, sweep.counted(board, value, method));
            rows.row(first.into_iter().chain(own).chain([milliseconds(sweep.boards()[board], method, speeds)]));
        }
    }
    rows
}

fn cells(method: &str, found: &Found, counted: Option<Counted>) -> Vec<String> {
    let of = |what: fn(Counted) -> f64| counted.map_or_else(String::new, |counted| fixed(what(counted), 0));
    let ratio = found.scatter().zip(found.bound()).map_or_else(String::new, |(scatter, bound)| plain(scatter / bound));
    vec![
        format!("`{}`", without_kinds(method)),
        counted.map_or_else(String::new, |counted| format!("{:.0} of {:.0}", counted.boards, counted.images)),
        found.asked.to_string(),
        share(found.right, found.asked),
        share(missed(found), found.asked),
        share(found.off, found.asked),
        of(|counted| counted.wrong),
        of(|counted| counted.nowhere),
        median(found),
        scatter(found),
        ratio,
    ]
}

/// How long a detector takes for the first image of the scenario of that board, as measured by `calibench speed`, one thread.
fn milliseconds(board: &str, method: &str, speeds: &Speeds) -> String {
    let speed = speeds.of(&format!("targets/{}", kind(board)), method);
    speed.map_or_else(String::new, |speed| plain(1e3 * speed.points as f64 / speed.points_per_second))
}

fn rules(speeds: &Speeds) -> String {
    let machine = if speeds.machine.is_empty() { String::new() } else { format!(" ({})", speeds.machine) };
    format!(
        "## How to read it\n\n\
         - **Points** are those wholly in view, all trials together; each is *right* (within 1 px of its truth), *missed*, or *beyond 1 px*. Detectors are asked for the whole board and see \
         the image and the board's design alone; other methods start from a hand's pixel.\n\
         - **Taken for another**: named as a point that lies elsewhere, at the place of another one. **Nowhere**: named, and further than 1 px from every point of the board. Both count points outside of the image or hidden, too.\n\
         - **Boards**: images in which anything of the board was found. Boards without marks that say which point is which are numbered as the truth is, if that can be done one to one.\n\
         - **Median, scatter**: of the errors of all points that were found. The scatter is the standard deviation by the median absolute deviation, of one coordinate; **over its bound**: over the mean Cramér-Rao bound of a coordinate \
         in the usual window. A median beside 0 is an origin of the pixel elsewhere: who mixes detectors moves the principal point by that.\n\
         - **ms an image**: the first image of the scenario `targets/` of that kind of board, from `reference/speeds.csv`{machine}.\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::speeds::Speed;

    #[test]
    fn a_row_tells_right_missed_and_wrong_apart() {
        let found = Found { asked: 200, right: 150, off: 20, ..Found::default() };
        let counted = Counted { images: 8.0, boards: 7.0, wrong: 12.0, nowhere: 8.0 };
        let cells = cells("detect", &found, Some(counted));
        assert_eq!(cells[..8], ["`detect`", "7 of 8", "200", "75.0", "15.0", "10.0", "12", "8"]);
        assert_eq!(super::cells("lsm", &found, None)[1], "");
    }

    #[test]
    fn times_are_those_of_the_scenario_of_the_same_kind() {
        let speed = Speed {
            scenario: "targets/charuco".into(),
            method: "detect".into(),
            version: "1".into(),
            points_per_second: 2700.0,
            low: 0.0,
            high: 0.0,
            points: 54,
            rounds: 5,
            image: "1280x960".into(),
        };
        let speeds = Speeds { machine: String::new(), rows: vec![speed] };
        assert_eq!(milliseconds("charuco:10x7:38:19:DICT_4X4_50", "detect", &speeds), "20.0");
        assert_eq!(milliseconds("aprilgrid:6x4:48:0.3", "detect", &speeds), "");
    }
}
