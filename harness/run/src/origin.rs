//! Where a finder of boards has the centre of the first pixel, and whether it sees boards or their markers larger or smaller than they are: boards pictured at
//! 16 phases, without noise and sharp.

use std::collections::HashMap;

use calibench_measure::finder::find_named;
use calibench_measure::{BoardFinder, Registry, Sought};
use calibench_model::PixelPoint;
use calibench_model::boards::{Board, KINDS};
use calibench_random::Key;
use calibench_scenario::{Subject, ViewsSubject, parse};
use calibench_synth::view::TargetTruth;

use crate::RunError;
use crate::views::{Prepared, is_pointed_at};

/// Phases along each axis.
const PHASES: usize = 4;
/// Fewer points than this say nothing.
const FEWEST: usize = 30;
/// From the median absolute deviation to the standard deviation, and from that of a mean to that of a median, of normal errors.
const NORMAL: [f64; 2] = [1.482_602_218_505_602, 1.253_314_137_315_5];
/// How far the middle of a sound finder may lie from its stated origin, px, beyond so many standard errors.
const FAR: (f64, f64) = (0.05, 3.0);

/// Where a finder's points lie in the middle, whatever a few of them do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Origin {
    /// Median of found less true position, px.
    pub median: [f64; 2],
    /// Its standard error, px.
    pub error: [f64; 2],
    /// Mean displacement outwards, from the middle of its marker for a marker's corner, else from that of the board, and its standard error, px.
    pub outwards: [f64; 2],
    /// Points in all images, and those found.
    pub points: [usize; 2],
}

/// Where `finder` has the points of `board` in the middle of 16 phases.
///
/// # Errors
/// A board that cannot be pictured.
pub fn origin_of(finder: &dyn BoardFinder, board: Board) -> Result<Origin, RunError> {
    let sought = Sought::new(board).map_err(|error| RunError::Asked(error.to_string()))?;
    let (mut errors, mut outwards, mut points) = (Vec::new(), Vec::new(), 0);
    let markers = markers(&sought);
    for phase in 0..PHASES * PHASES {
        let subject = pictured(&sought, [phase % PHASES, phase / PHASES].map(|step| step as f64 / PHASES as f64))?;
        let key = Key { seed: 1, scenario: "phases", trial: 0, view: "", target: "" };
        let prepared = Prepared::new(&subject, key)?;
        for view in &prepared.views {
            let image = prepared.image(view, key)?.image;
            let seen = subject.field.targets.iter().zip(&view.truth).filter(|(_, truth)| is_pointed_at(&subject, truth));
            // The centre of a disc's picture is not the picture of its centre.
            let place = |truth: &TargetTruth| Some(truth.ellipse.map_or(truth.at?, |ellipse| ellipse.centre));
            let expected: Vec<_> = seen.filter_map(|(target, truth)| Some((target.id.as_str(), place(truth)?))).collect();
            points += expected.len();
            let directions = directions(&expected, &markers);
            let Ok(found) = find_named(finder, (&image, &sought), &expected) else { continue };
            for (name, at) in found {
                let Some(place) = expected.iter().position(|(other, _)| *other == name) else { continue };
                let off = [at.x - expected[place].1.x, at.y - expected[place].1.y];
                errors.push(off);
                outwards.extend(directions[place].map(|[x, y]| off[0] * x + off[1] * y));
            }
        }
    }
    let [x, y] = [0, 1].map(|axis| middle(errors.iter().map(|off| off[axis]).collect()));
    Ok(Origin { median: [x.0, y.0], error: [x.1, y.1], outwards: mean(&outwards), points: [points, errors.len()] })
}

/// Of each point that is the corner of a marker the place of the marker.
fn markers(sought: &Sought) -> HashMap<&str, usize> {
    let is_at = |a: [f64; 2], b: [f64; 2], size: f64| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-6 * size;
    let layout = &sought.layout;
    let of = |point: &'_ calibench_model::boards::BoardPoint| {
        layout.markers.iter().position(|marker| marker.corners.iter().any(|corner| is_at(*corner, point.at, point.size)))
    };
    layout.points.iter().filter_map(|point| Some((point.id.as_str(), of(point)?))).collect()
}

/// Of each point the direction outwards in the image: from the middle of its marker, if all four of its corners are there, or from that of all points.
fn directions(points: &[(&str, PixelPoint)], markers: &HashMap<&str, usize>) -> Vec<Option<[f64; 2]>> {
    let mut sums: HashMap<Option<usize>, (f64, [f64; 2])> = HashMap::new();
    let marker = |name: &str| markers.get(name).copied();
    for (name, at) in points {
        let (count, sum) = sums.entry(marker(name)).or_default();
        (*count, *sum) = (*count + 1.0, [sum[0] + at.x, sum[1] + at.y]);
    }
    let direction = |(name, at): &(&str, PixelPoint)| {
        let marker = marker(name);
        let (count, [x, y]) = sums[&marker];
        let (x, y) = (at.x - x / count, at.y - y / count);
        (marker.is_none() || count == 4.0).then(|| [x / x.hypot(y), y / x.hypot(y)]).filter(|[x, y]| x.is_finite() && y.is_finite())
    };
    points.iter().map(direction).collect()
}

/// The mean and its standard error; nothing of nothing.
fn mean(values: &[f64]) -> [f64; 2] {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    [mean, (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count * (count - 1.0).max(1.0))).sqrt()]
}

/// The median and its standard error; nothing of nothing.
fn middle(mut errors: Vec<f64>) -> (f64, f64) {
    let count = errors.len();
    let median = |values: &mut Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values.get(count / 2).copied().unwrap_or(f64::NAN)
    };
    let middle = median(&mut errors);
    let deviation = median(&mut errors.iter().map(|error| (error - middle).abs()).collect());
    (middle, NORMAL[0] * NORMAL[1] * deviation / (count as f64).sqrt())
}

/// Where `finder` has the points of one board of each kind that it finds.
///
/// # Errors
/// As [`origin_of`].
pub fn origins(finder: &dyn BoardFinder) -> Result<Vec<(Board, Origin)>, RunError> {
    let boards = KINDS.iter().filter_map(|(.., example)| example.parse::<Board>().ok());
    boards.filter(|board| finder.unfit(board).is_none()).map(|board| Ok((board, origin_of(finder, board)?))).collect()
}

/// Whether `finder` has its origin where it states it, on each of the `boards` on which it was found out.
///
/// # Errors
/// In words what is wrong: no board that it finds, hardly a point found, another origin.
pub fn check_origins(finder: &dyn BoardFinder, boards: &[(Board, Origin)]) -> Result<(), String> {
    if boards.is_empty() {
        return Err("it finds none of the kinds of boards".into());
    }
    boards.iter().try_for_each(|(board, origin)| check_origin(finder, *board, origin))
}

fn check_origin(finder: &dyn BoardFinder, board: Board, origin: &Origin) -> Result<(), String> {
    let Origin { median, error, outwards, points: [all, found] } = *origin;
    if found < FEWEST {
        return Err(format!("`{board}`: {found} of {all} points are found; expected at least {FEWEST}"));
    }
    let stated = finder.origin(&board);
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        if (median[axis] - stated[axis]).abs() - FAR.1 * error[axis] > FAR.0 {
            return Err(format!(
                "`{board}`: points lie {:+.3} ± {:.3} px off in {name} in the median of 16 phases, and its origin is stated as {:+.3}; expected within {} px",
                median[axis], error[axis], stated[axis], FAR.0
            ));
        }
    }
    let ([mean, error], stated) = (outwards, finder.outwards(&board));
    if (mean - stated).abs() - FAR.1 * error > FAR.0 {
        return Err(format!(
            "`{board}`: points lie {mean:+.3} ± {error:.3} px outwards in the mean, from the middle of their marker or board, and {stated:+.3} is stated: what \
             is seen is {} than it is; expected within {} px",
            if mean > stated { "larger" } else { "smaller" },
            FAR.0
        ));
    }
    Ok(())
}

/// The board from the front, somewhat tilted, with its image moved by parts of a pixel.
fn pictured(sought: &Sought, phase: [f64; 2]) -> Result<ViewsSubject, RunError> {
    let [low, high] = sought.layout.printed;
    let side = (high[0] - low[0]).max(4.0 / 3.0 * (high[1] - low[1]));
    let [x0, y0] = phase.map(|part| 0.005 * part);
    let text = format!(
        "why = \"phases\"\nsource = \"ours\"\nseed = 1\n[camera]\nsize = [960, 720]\npitch = 5.0\nc = 6.0\nx0 = {x0}\ny0 = {y0}\n\
         [testfield]\nkind = \"board\"\nunit = \"mm\"\nboard = \"{}\"\nmargin = {}\n\
         [stations]\nkind = \"board\"\ntilts = [[12, -9]]\ndistances = [{}]\nrolls = [3]\n\
         [optics]\nblur = 0.7\n[sensor]\nadc_bits = 8\n[pointing]\nsigma = 0\nwhole_pixels = false\n[[method]]\nname = \"pixel\"\n",
        sought.board,
        0.1 * side,
        1.8 * side
    );
    let scenario = parse("phases", "phases", &text, &Registry::builtin()).map_err(|problems| RunError::Asked(problems.to_string()))?;
    match scenario.subject {
        Subject::Views(subject) => Ok(*subject),
        _ => Err(RunError::NothingToRender),
    }
}

#[cfg(test)]
mod tests {
    use calibench_measure::BoardPointFound;
    use calibench_model::{Image, Rejection};

    use super::*;

    /// Our own finder with its points moved, which it may state.
    #[derive(Default)]
    struct Moved {
        by: [f64; 2],
        stated: [f64; 2],
        /// Outwards from the middle of each marker, and what is stated of it.
        grown: [f64; 2],
    }

    impl BoardFinder for Moved {
        fn unfit(&self, board: &Board) -> Option<String> {
            let fit = matches!((board, self.grown), (Board::Charuco(_), [0.0, _]) | (Board::AprilGrid(_), _));
            (!fit).then(|| "others alone".into())
        }

        fn outwards(&self, _: &Board) -> f64 {
            self.grown[1]
        }

        fn origin(&self, _: &Board) -> [f64; 2] {
            self.stated
        }

        fn find(&self, image: &Image, sought: &Sought) -> Result<Vec<BoardPointFound>, Rejection> {
            let mut found = own().board_finder().unwrap().find(image, sought)?;
            let seen: Vec<_> = found.iter().map(|point| (sought.layout.points[point.index].id.as_str(), point.position)).collect();
            let directions = directions(&seen, &markers(sought));
            for (point, direction) in found.iter_mut().zip(directions) {
                let [x, y] = direction.unwrap_or_default().map(|part| self.grown[0] * part);
                point.position = PixelPoint::new(point.position.x + self.by[0] + x, point.position.y + self.by[1] + y);
            }
            Ok(found)
        }
    }

    fn own() -> calibench_measure::Configured {
        Registry::builtin().parse("detect").unwrap()
    }

    #[test]
    fn our_own_finder_and_the_crates_have_the_origin_that_they_state() {
        for name in ["detect", "calib_targets"] {
            let method = Registry::builtin().parse(name).unwrap();
            let finder = method.board_finder().unwrap();
            check_origins(finder, &origins(finder).unwrap()).unwrap();
        }
    }

    #[test]
    fn half_a_pixel_is_found_unless_it_is_stated() {
        let half = [0.5, 0.5];
        let check = |moved: &Moved| check_origins(moved, &origins(moved).unwrap());
        assert!(check(&Moved { by: half, stated: half, ..Moved::default() }).is_ok());
        for (by, stated, axis) in
            [(half, [0.0; 2], "in x"), ([0.0, 0.1], [0.0; 2], "in y"), ([0.0; 2], half, "in x"), ([-0.07, 0.0], [0.0; 2], "in x")]
        {
            let wrong = check(&Moved { by, stated, ..Moved::default() }).unwrap_err();
            assert!(wrong.contains(axis), "{by:?} {stated:?}: {wrong}");
        }
    }

    /// Markers that are seen too small or too large leave every median where it is.
    #[test]
    fn a_size_that_is_not_the_marker_s_is_found_unless_it_is_stated() {
        let check = |grown: [f64; 2]| {
            let moved = Moved { grown, ..Moved::default() };
            check_origins(&moved, &origins(&moved).unwrap())
        };
        assert!(check([-0.3, -0.3]).is_ok());
        for (grown, expected) in [([-0.3, 0.0], "smaller"), ([0.1, 0.0], "larger"), ([-0.3, -0.4], "larger")] {
            let wrong = check(grown).unwrap_err();
            assert!(wrong.contains(expected) && wrong.contains("aprilgrid"), "{grown:?}: {wrong}");
        }
    }
}
