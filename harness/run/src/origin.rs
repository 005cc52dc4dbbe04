//! Where a finder of boards has the centre of the first pixel, and whether it sees what it finds too large or too small: boards pictured at 16 phases, without
//! noise and sharp.

use calibench_measure::finder::find_named;
use calibench_measure::{BoardFinder, Registry, Sought};
use calibench_model::PixelPoint;
use calibench_model::boards::{Board, KINDS, Layout};
use calibench_random::Key;
use calibench_scenario::{Subject, ViewsSubject, parse};
use calibench_synth::view::TargetTruth;
use nalgebra::{Matrix2x3, Matrix3, Vector2, Vector3};

use crate::RunError;
use crate::prepared::{Prepared, is_pointed_at};

/// Phases along each axis.
const PHASES: usize = 4;
/// Fewer points than this say nothing.
const FEWEST: usize = 30;
/// From the median length of plane normal errors to the standard deviation of a coordinate, and from that of a mean to that of a spatial median.
const NORMAL: [f64; 2] = [0.849_321_800_288_019, std::f64::consts::FRAC_2_SQRT_PI];
/// Steps towards a spatial median, and the length below which errors weigh no more, px.
const STEPS: (usize, f64) = (100, 1e-5);
/// How far the middle of a sound finder may lie from what it states, px, beyond so many standard errors.
const FAR: (f64, f64) = (0.05, 3.0);
/// A standard error from which on a median says nothing, px.
const VAGUE: f64 = 0.1;
/// What is held, in the order of [`Origin::median`].
pub const DIRECTIONS: [&str; 3] = ["in x", "in y", "outwards"];

/// Where a finder's points lie in the middle, whatever a few of them do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Origin {
    /// Spatial median of found less true position, px: x, y, and away from the middle of the marker whose corner it is, or of the board.
    pub median: [f64; 3],
    /// Its standard error, px.
    pub error: [f64; 3],
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
            let middles = middles(&sought, &expected);
            let off = |(name, at): (&str, PixelPoint)| {
                let k = expected.iter().position(|(other, _)| *other == name)?;
                let place = expected[k].1;
                let out = Vector2::new(place.x - middles[k].x, place.y - middles[k].y).try_normalize(0.0).unwrap_or_default();
                Some((Vector2::new(at.x - place.x, at.y - place.y), out))
            };
            errors.extend(found.into_iter().filter_map(off));
        }
    }
    let (median, error) = spatial_median(&errors);
    Ok(Origin { median, error, points: [points, errors.len()] })
}

/// For each of the `expected` the middle of those that belong together: the corners of a marker, otherwise all.
fn middles(sought: &Sought, expected: &[(&str, PixelPoint)]) -> Vec<PixelPoint> {
    let Layout { points, markers, .. } = &sought.layout;
    let marker = |name: &str| {
        let at = points.iter().find(|point| point.id == name)?.at;
        markers.iter().position(|marker| marker.corners.contains(&at))
    };
    let of: Vec<Option<usize>> = expected.iter().map(|(name, _)| marker(name)).collect();
    let middle = |own: &Option<usize>| {
        let places: Vec<PixelPoint> = expected.iter().zip(&of).filter(|(_, other)| *other == own).map(|((_, at), _)| *at).collect();
        let mean = |of: fn(&PixelPoint) -> f64| places.iter().map(of).sum::<f64>() / places.len() as f64;
        PixelPoint::new(mean(|at| at.x), mean(|at| at.y))
    };
    of.iter().map(middle).collect()
}

/// The displacement in x, in y and outwards that leaves the least sum of the lengths of what is left of the `errors`, each with its direction outwards, and its
/// standard errors; nothing of nothing.
fn spatial_median(errors: &[(Vector2<f64>, Vector2<f64>)]) -> ([f64; 3], [f64; 3]) {
    let slopes = |out: &Vector2<f64>| Matrix2x3::new(1.0, 0.0, out.x, 0.0, 1.0, out.y);
    let mut median = Vector3::zeros();
    let mut inverse = Matrix3::from_element(f64::NAN);
    let left = |median: &Vector3<f64>, (error, out): &(Vector2<f64>, Vector2<f64>)| (error - slopes(out) * median).norm();
    for step in 0..STEPS.0 {
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for one in errors {
            let weight = if step == 0 { 1.0 } else { left(&median, one).max(STEPS.1).recip() };
            normal += slopes(&one.1).tr_mul(&slopes(&one.1)) * weight;
            right += slopes(&one.1).tr_mul(&one.0) * weight;
        }
        if step == 0 {
            inverse = normal.try_inverse().unwrap_or(inverse);
        }
        median = normal.try_inverse().unwrap_or(inverse) * right;
    }
    let mut lengths: Vec<f64> = errors.iter().map(|one| left(&median, one)).collect();
    lengths.sort_by(f64::total_cmp);
    let sigma = NORMAL[0] * NORMAL[1] * lengths.get(lengths.len() / 2).copied().unwrap_or(f64::NAN);
    (median.into(), [0, 1, 2].map(|k| sigma * inverse[(k, k)].sqrt()))
}

/// Where `finder` has the points of one board of each kind that it finds.
///
/// # Errors
/// As [`origin_of`].
pub fn origins(finder: &dyn BoardFinder) -> Result<Vec<(Board, Origin)>, RunError> {
    let boards = KINDS.iter().filter_map(|(.., example)| example.parse::<Board>().ok());
    boards.filter(|board| finder.unfit(board).is_none()).map(|board| Ok((board, origin_of(finder, board)?))).collect()
}

/// Whether `finder` has its points where it states them, on each of the `boards` on which it was found out.
///
/// # Errors
/// In words what is wrong: no board that it finds, hardly a point found, another origin, all seen too large or too small.
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
    let [x, y] = finder.origin(&board);
    let stated = [x, y, finder.outwards(&board)];
    for (k, direction) in DIRECTIONS.into_iter().enumerate() {
        if error[k].is_nan() || error[k] > VAGUE {
            return Err(format!("`{board}`: points scatter too much, or lie too much alike, to tell whether they are off {direction}"));
        }
        if (median[k] - stated[k]).abs() - FAR.1 * error[k] > FAR.0 {
            return Err(format!(
                "`{board}`: points lie {:+.3} ± {:.3} px off {direction} in the median of 16 phases, where {:+.3} are stated; expected within {} px",
                median[k], error[k], stated[k], FAR.0
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

    /// Our own finder with its points moved, all alike and outwards, which it may state.
    #[derive(Default)]
    struct Moved {
        by: [f64; 2],
        stated: [f64; 2],
        outwards: f64,
        stated_outwards: f64,
        tags: bool,
    }

    impl BoardFinder for Moved {
        fn unfit(&self, board: &Board) -> Option<String> {
            (!matches!((self.tags, board), (false, Board::Charuco(_)) | (true, Board::AprilGrid(_)))).then(|| "one kind alone".into())
        }

        fn outwards(&self, _: &Board) -> f64 {
            self.stated_outwards
        }

        fn origin(&self, _: &Board) -> [f64; 2] {
            self.stated
        }

        fn find(&self, image: &Image, sought: &Sought) -> Result<Vec<BoardPointFound>, Rejection> {
            let mut found = own().board_finder().unwrap().find(image, sought)?;
            let four = if self.tags { 4 } else { found.len() };
            found.sort_by_key(|point| point.index);
            for marker in found.chunks_mut(four) {
                let mean = |of: fn(&BoardPointFound) -> f64| marker.iter().map(of).sum::<f64>() / marker.len() as f64;
                let middle = PixelPoint::new(mean(|point| point.position.x), mean(|point| point.position.y));
                for point in marker {
                    let at = point.position;
                    let out = self.outwards / at.distance(middle).max(1e-9);
                    point.position =
                        PixelPoint::new(at.x + self.by[0] + out * (at.x - middle.x), at.y + self.by[1] + out * (at.y - middle.y));
                }
            }
            Ok(found)
        }
    }

    #[test]
    fn a_few_gross_errors_do_not_move_the_median() {
        let out = |k: usize| Vector2::new(f64::cos(k as f64), f64::sin(k as f64));
        let off = |k: usize| Vector2::new(0.5, -0.25) - 2.0 * out(k) + 0.01 * out(7 * k + 1);
        let mut errors: Vec<_> = (0..1000).map(|k| (off(k), out(k))).collect();
        errors.iter_mut().step_by(10).for_each(|(error, _)| error.x += 20.0);
        let (median, error) = spatial_median(&errors);
        let truth = [0.5, -0.25, -2.0];
        assert!((0..3).all(|k| (median[k] - truth[k]).abs() < 0.003 && error[k] < 0.001), "{median:?} {error:?}");
        assert!(spatial_median(&[]).1.iter().all(|error| error.is_nan()));
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

    #[test]
    fn what_is_seen_too_small_is_found_unless_it_is_stated() {
        for tags in [true, false] {
            for (outwards, stated, sound) in [(0.0, 0.0, true), (-0.3, -0.3, true), (-0.3, 0.0, false), (0.07, 0.0, false)] {
                let moved = Moved { outwards, stated_outwards: stated, tags, ..Moved::default() };
                let [(_, origin)] = origins(&moved).unwrap()[..] else { panic!("one board") };
                assert!((origin.median[2] - outwards).abs() < 0.02 && origin.median[0].abs() < 0.02, "{origin:?}");
                let checked = check_origins(&moved, &[("aprilgrid:2x2:30:0.3".parse().unwrap(), origin)]);
                assert!(checked.as_ref().map_or_else(|wrong| wrong.contains("outwards"), |()| sound), "{outwards} {tags}: {checked:?}");
                assert_eq!(checked.is_ok(), sound, "{outwards} {tags}");
            }
        }
    }
}
