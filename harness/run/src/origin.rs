//! Where a finder of boards has the centre of the first pixel: boards pictured at 16 phases, without noise and sharp.

use calibench_measure::finder::find_named;
use calibench_measure::{BoardFinder, Registry, Sought};
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
    /// Points in all images, and those found.
    pub points: [usize; 2],
}

/// Where `finder` has the points of `board` in the middle of 16 phases.
///
/// # Errors
/// A board that cannot be pictured.
pub fn origin_of(finder: &dyn BoardFinder, board: Board) -> Result<Origin, RunError> {
    let sought = Sought::new(board).map_err(|error| RunError::Asked(error.to_string()))?;
    let (mut errors, mut points) = (Vec::new(), 0);
    for phase in 0..PHASES * PHASES {
        let subject = pictured(&sought, [phase % PHASES, phase / PHASES].map(|step| step as f64 / PHASES as f64))?;
        let key = Key { seed: 1, of: "phases", trial: 0, view: "", target: "" };
        let prepared = Prepared::new(&subject, key)?;
        for view in &prepared.views {
            let image = prepared.image(view, key)?.image;
            let seen = subject.field.targets.iter().zip(&view.truth).filter(|(_, truth)| is_pointed_at(&subject, truth));
            // The centre of a disc's picture is not the picture of its centre.
            let place = |truth: &TargetTruth| Some(truth.ellipse.map_or(truth.at?, |ellipse| ellipse.centre));
            let expected: Vec<_> = seen.filter_map(|(target, truth)| Some((target.id.as_str(), place(truth)?))).collect();
            points += expected.len();
            let Ok(found) = find_named(finder, (&image, &sought), &expected) else { continue };
            for (name, at) in found {
                let place = expected.iter().find(|(other, _)| *other == name).map(|(_, place)| [at.x - place.x, at.y - place.y]);
                errors.extend(place);
            }
        }
    }
    let [x, y] = [0, 1].map(|axis| middle(errors.iter().map(|off| off[axis]).collect()));
    Ok(Origin { median: [x.0, y.0], error: [x.1, y.1], points: [points, errors.len()] })
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
    let Origin { median, error, points: [all, found] } = *origin;
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
    use calibench_model::{Image, PixelPoint, Rejection};

    use super::*;

    /// Our own finder with its points moved, which it may state.
    struct Moved {
        by: [f64; 2],
        stated: [f64; 2],
    }

    impl BoardFinder for Moved {
        fn unfit(&self, board: &Board) -> Option<String> {
            (!matches!(board, Board::Charuco(_))).then(|| "ChArUco alone".into())
        }

        fn origin(&self, _: &Board) -> [f64; 2] {
            self.stated
        }

        fn find(&self, image: &Image, sought: &Sought) -> Result<Vec<BoardPointFound>, Rejection> {
            let mut found = own().board_finder().unwrap().find(image, sought)?;
            found
                .iter_mut()
                .for_each(|point| point.position = PixelPoint::new(point.position.x + self.by[0], point.position.y + self.by[1]));
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
        assert!(check(&Moved { by: half, stated: half }).is_ok());
        for (by, stated, axis) in
            [(half, [0.0; 2], "in x"), ([0.0, 0.1], [0.0; 2], "in y"), ([0.0; 2], half, "in x"), ([-0.07, 0.0], [0.0; 2], "in x")]
        {
            let wrong = check(&Moved { by, stated }).unwrap_err();
            assert!(wrong.contains(axis), "{by:?} {stated:?}: {wrong}");
        }
    }
}
