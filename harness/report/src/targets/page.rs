//! The page `which target, when`.

use super::load::{Camera, Comparison, Found, kind};
use super::picture::picture;
use crate::Canvas;
use crate::markdown::plain;
use crate::markdown::{MarkdownTable, contents, fixed};
use crate::sweep::titled;

/// The page's name.
pub const FILE: &str = "which-target.md";

/// A board that has fewer points than this share is not recommended where another has more.
const ENOUGH: f64 = 0.9;

/// The page, and its pictures; `None` without a sweep over boards.
pub fn page(sweeps: &[&Comparison]) -> Option<(String, Vec<(String, Canvas)>)> {
    let first = sweeps.first()?;
    let mut pictures = Vec::new();
    let mut body = String::new();
    // The budget is of what the others leave out.
    for sweep in sweeps.iter().filter(|sweep| !sweep.is_budget()).chain(sweeps.iter().filter(|sweep| sweep.is_budget())) {
        body.push_str(&section(sweep, &mut pictures));
    }
    body.push_str(&rules(first.sweep.scenario.window_of_discs()));
    body.push_str("\n## Evidence\n\n");
    for sweep in sweeps {
        let (name, trials) = (&sweep.sweep.name, sweep.sweep.cells.iter().map(|cell| cell.trials).max().unwrap_or(0));
        body.push_str(&format!(
            "- `{name}`: `calibench run {name}`, seed {}, {} cells of {trials} trials\n",
            sweep.sweep.seed,
            sweep.sweep.cells.len()
        ));
    }
    let boards: Vec<String> = first.boards().iter().map(|word| format!("`{word}`")).collect();
    let text = format!(
        "# Which target, when\n\n{}\n{}Boards: {}. Made by `calibench report targets` from the records of the scenarios `targets/by-*`; nothing here is written by hand.\n\n{}\n",
        answers(sweeps),
        contents(&body),
        boards.join(", "),
        body.trim_end()
    );
    Some((text, pictures))
}

fn heading(sweep: &Comparison) -> String {
    let name = sweep.sweep.name.rsplit('/').next().unwrap_or_default().replace('-', " ");
    let mut letters = name.chars();
    if sweep.is_budget() {
        "Error budget".into()
    } else {
        letters.next().map_or(String::new(), |first| format!("{}{}", first.to_uppercase(), letters.as_str()))
    }
}

/// What to take at each value of each key.
fn answers(sweeps: &[&Comparison]) -> String {
    let mut table = MarkdownTable::new(&["what changes", "value", "take", "as good", "the worst"]);
    for sweep in sweeps.iter().filter(|sweep| sweep.is_calibrated() && !sweep.is_budget()) {
        for (value, text) in sweep.values().into_iter().enumerate() {
            let Some(verdict) = Verdict::of(sweep, value) else { continue };
            let named = |board: &usize| format!("`{}`", kind(sweep.boards()[*board]));
            table.row([
                titled(&sweep.sweep.sweep.axes[1]),
                text,
                named(&verdict.best),
                verdict.as_good.iter().map(named).collect::<Vec<_>>().join(", "),
                verdict
                    .worst
                    .map_or_else(String::new, |(board, times)| format!("{} ({}{})", named(&board), plain(times), " times the error")),
            ]);
        }
    }
    table.render()
}

/// Which board's camera is nearest to the true one.
struct Verdict {
    best: usize,
    /// Boards whose mean errors cannot be told from the best.
    as_good: Vec<usize>,
    /// Of the others, and by how many times its error is larger.
    worst: Option<(usize, f64)>,
}

impl Verdict {
    fn of(sweep: &Comparison, value: usize) -> Option<Self> {
        let of = |board: usize| {
            let method = sweep.method(board, value)?;
            let (found, camera) = (sweep.found(board, value, method)?, sweep.camera(board, value, method)?);
            Some((board, found.share(), camera))
        };
        Self::among(&(0..sweep.boards().len()).filter_map(of).collect::<Vec<_>>())
    }

    /// Of boards with the share of their points that were found, and their cameras.
    fn among(all: &[(usize, f64, Camera)]) -> Option<Self> {
        let most = all.iter().map(|(_, share, _)| *share).fold(0.0, f64::max);
        let sound = |(_, share, camera): &&(usize, f64, Camera)| camera.failed == 0 && (*share >= ENOUGH || *share >= ENOUGH * most);
        let (best, _, least) = all.iter().filter(sound).min_by(|a, b| a.2.worth().total_cmp(&b.2.worth()))?;
        let half = |camera: &Camera| camera.error.1.unwrap_or(f64::INFINITY);
        let near = |(_, _, camera): &&(usize, f64, Camera)| camera.worth() - least.worth() <= half(camera).hypot(half(least));
        let as_good = all.iter().filter(sound).filter(near).map(|(board, ..)| *board).filter(|board| board != best).collect();
        let worse = |one: &&(usize, f64, Camera)| !near(one) && one.2.worth() > least.worth();
        let worst = all.iter().filter(worse).max_by(|a, b| a.2.worth().total_cmp(&b.2.worth()));
        Some(Self { best: *best, as_good, worst: worst.map(|(board, _, camera)| (*board, camera.worth() / least.worth())) })
    }
}

fn section(sweep: &Comparison, pictures: &mut Vec<(String, Canvas)>) -> String {
    let scenario = &sweep.sweep.scenario;
    let mut text = format!("## {}\n\n{}\n\n", heading(sweep), scenario.why.trim());
    scenario.notes.iter().for_each(|note| text.push_str(&format!("- {}\n", note.split_whitespace().collect::<Vec<_>>().join(" "))));
    if sweep.is_budget() {
        text.push_str(&format!("\n{}\n", budget(sweep).render()));
        return text;
    }
    if let Some(drawn) = picture(sweep) {
        let name = format!("{}.png", sweep.sweep.name.rsplit('/').next().unwrap_or_default());
        text.push_str(&format!("\n![Camera error by {}]({name})\n", titled(&sweep.sweep.sweep.axes[1])));
        pictures.push((name, drawn));
    }
    text.push_str(&format!("\n{}\n", table(sweep).render()));
    text
}

/// The camera's error with each cause alone, with several and with all.
fn budget(sweep: &Comparison) -> MarkdownTable {
    let boards = sweep.boards();
    let header: Vec<String> =
        std::iter::once("beside noise".to_owned()).chain(boards.iter().map(|word| format!("`{}`, px", kind(word)))).collect();
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for (value, text) in sweep.values().into_iter().enumerate() {
        let of = |board: usize| Some(camera(sweep.camera(board, value, sweep.method(board, value)?)?).swap_remove(0));
        rows.row(std::iter::once(text).chain((0..boards.len()).map(|board| of(board).unwrap_or_default())));
    }
    rows
}

fn table(sweep: &Comparison) -> MarkdownTable {
    let axis = titled(&sweep.sweep.sweep.axes[1]);
    let mut header = vec![axis.as_str(), "board", "operator", "found, %", "lost", "RMSE, px", "scatter / bound"];
    if sweep.is_calibrated() {
        header.extend(["camera, px", "predicted, px", "images left out", "failed"]);
    }
    let mut rows = MarkdownTable::new(&header);
    for (value, text) in sweep.values().into_iter().enumerate() {
        for (board, word) in sweep.boards().into_iter().enumerate() {
            let Some(method) = sweep.method(board, value) else {
                let nothing = [text.clone(), format!("`{}`", kind(word)), String::new(), "0".into()].into_iter();
                rows.row(nothing.chain(std::iter::repeat_n(String::new(), header.len() - 4)));
                continue;
            };
            let mut row = vec![text.clone(), format!("`{}`", kind(word)), format!("`{}`", without_kinds(method))];
            row.extend(sweep.found(board, value, method).map_or_else(|| vec![String::new(); 4], points));
            if sweep.is_calibrated() {
                row.extend(sweep.camera(board, value, method).map_or_else(|| vec![String::new(); 4], camera));
            }
            rows.row(row);
        }
    }
    rows
}

/// A label without the kinds that it is limited to: the board says them.
pub fn without_kinds(label: &str) -> &str {
    label.split("kinds=").next().unwrap_or(label).trim_end_matches([',', ':'])
}

fn points(found: &Found) -> Vec<String> {
    vec![
        fixed(100.0 * found.share(), 1),
        found.lost.to_string(),
        found.rmse().map_or_else(String::new, plain),
        found.scatter_to_bound().map_or_else(String::new, |ratio| fixed(ratio, 2)),
    ]
}

fn camera(camera: Camera) -> Vec<String> {
    let (error, half) = camera.error;
    vec![
        half.map_or_else(|| plain(error), |half| format!("{} ± {}", plain(error), plain(half))),
        camera.predicted.map_or_else(String::new, plain),
        fixed(camera.left_out, 1),
        camera.failed.to_string(),
    ]
}

/// `window`: of the bounds of discs, px.
fn rules(window: usize) -> String {
    format!(
        "\n## How to read it\n\n\
         - **Found**: points in view that the board's detector found and the operator measured within 1 px, of all that are in view; *lost* are further off.\n\
         - **RMSE** of a coordinate, against the picture of the point; of discs it holds the eccentricity. **Scatter / bound**: what trials differ by at one point, over the Cramér-Rao bound of the operator's unknowns; in the bound of discs all counts that lies in its window of {window} px, rings and neighbours, which the operator does not use.\n\
         - **Camera**: its distance from the true one over the frame after the best rotation, root mean square, mean of the trials ± half of its 95 % interval; **predicted**: what its own covariance says of that. Stations are the same in all trials, so what they leave undetermined is the same, too.\n\
         - **Operator**: of those that measured 98 % of the most points, the one with the least RMSE. Cameras are those of the same operator.\n\
         - **Taken** is the board with the nearest camera, by the larger of the two figures (a few trials may be lucky; a covariance knows of no systematic error), of those that found {enough:.0} % of the points or nearly as many as any other; *as good* are those whose figure differs by less than both intervals together.\n",
        enough = 100.0 * ENOUGH
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn board(index: usize, share: f64, error: f64, half: f64, predicted: f64) -> (usize, f64, Camera) {
        (index, share, Camera { error: (error, Some(half)), predicted: Some(predicted), left_out: 0.0, failed: 0 })
    }

    #[test]
    fn the_nearest_camera_of_a_board_that_is_found_is_taken() {
        let all = [
            board(0, 1.0, 0.02, 0.005, 0.01),
            // Lucky: its covariance says so.
            board(1, 1.0, 0.005, 0.001, 0.03),
            board(2, 1.0, 0.024, 0.005, 0.01),
            // Best where it is found, which it is not.
            board(3, 0.5, 0.001, 0.001, 0.001),
            board(4, 1.0, 0.2, 0.01, 0.01),
        ];
        let found = Verdict::among(&all).unwrap();
        assert_eq!((found.best, found.as_good.as_slice()), (0, [2].as_slice()));
        assert_eq!(found.worst, Some((4, 10.0)));
        assert_eq!(Verdict::among(&[all[0], all[2], all[3]]).unwrap().worst, None, "one is as good, of one few points are found");
        // Where all are found badly the best of them is taken; a board that fails is none.
        let mut failed = board(1, 0.5, 0.001, 0.001, 0.001);
        failed.2.failed = 1;
        assert_eq!(Verdict::among(&[board(0, 0.5, 0.02, 0.001, 0.01), failed]).unwrap().best, 0);
        assert!(Verdict::among(&[]).is_none());
        assert_eq!(without_kinds("ellipse_edges:kinds=disc"), "ellipse_edges");
        assert_eq!(without_kinds("saddle:window=7,kinds=chess_corner"), "saddle:window=7");
    }
}
