//! Where the fit starts: from what is given, and for the rest from the image.

use calibench_model::{Affine, Image, Rejection, Start};

use super::area::{self, Area, Grey};
use super::fit::{Parameters, Work};
use super::mask::Mask;
use super::planes::Pose;
use crate::operator::window_centre;

/// Directions that are tried over one period of the mask's symmetry.
const TURNS: u32 = 6;
/// Of an open corner, all round.
const TURNS_OF_A_CORNER: u32 = 12;
/// The fewest pixels whose moments give a shape.
const FEWEST: usize = 8;

/// The target's pixels around `start`, if they can be told from the ground and the window holds all of them.
pub(super) fn area(mask: &Mask, grey: Grey<'_>, range: (f32, f32), start: [f64; 2]) -> Option<Area> {
    if mask.is_open() { None } else { area::of(grey, range, start, FEWEST) }
}

/// The middle pixel of the window around a start; next to the image's border the window is laid inside the image if that shows the `whole` target.
///
/// # Errors
/// Those of [`window_centre`].
pub(super) fn centre(image: &Image, start: &Start, half: i64, whole: bool) -> Result<(i64, i64), Rejection> {
    match window_centre(image, start, half) {
        Err(Rejection::Border) if whole => {
            let pixel = window_centre(image, start, 0)?;
            inside(image, pixel, half).ok_or(Rejection::Border)
        }
        centre => centre,
    }
}

/// The pixel nearest to another around which a window is inside the image; `None` if the image is too small.
pub(super) fn inside(image: &Image, (x, y): (i64, i64), half: i64) -> Option<(i64, i64)> {
    let [right, bottom] = [image.width(), image.height()].map(|side| side as i64 - 1 - half);
    (right >= half && bottom >= half).then(|| (x.clamp(half, right), y.clamp(half, bottom)))
}

/// The shapes to try, each an affine map: the given one, or else, turned in steps, one of the given size, one with the pixels' moments, or one that
/// fills half the window.
pub(super) fn shapes(mask: &Mask, given: Option<Affine>, size: f64, area: Option<&Area>, window: f64) -> Vec<Affine> {
    if let Some(affine) = given {
        return vec![if mask.is_open() { lengthened(&affine, window) } else { affine }];
    }
    let side = if mask.is_open() {
        open_length(window)
    } else if size > 0.0 {
        size
    } else {
        window / 2.0
    };
    let root = match area {
        Some(area) if size <= 0.0 => moment_root(area, mask.moment),
        _ => None,
    };
    let shape = root.unwrap_or([side, 0.0, side]);
    let turns = match mask.symmetry() {
        0 => 1,
        1 => TURNS_OF_A_CORNER,
        _ => TURNS,
    };
    let period = std::f64::consts::TAU / f64::from(mask.symmetry().max(1));
    (0..turns).map(|turn| turned(shape, period * f64::from(turn) / f64::from(turns))).collect()
}

/// The shape with the smallest residuals; `None` if there are several and none has any contrast.
pub(super) fn best(work: &mut Work, mask: &Mask, at: [f64; 2], shapes: &[Affine], sigma: f64) -> Option<Parameters> {
    let of = |affine: Affine| Parameters { pose: Pose { at, affine }, ground: 0.0, contrast: 0.0, sigma };
    if let [only] = shapes {
        return Some(of(*only));
    }
    let mut found: Option<(f64, Parameters)> = None;
    for &affine in shapes {
        let mut parameters = of(affine);
        let Some(omega) = work.levels(mask, &mut parameters) else { continue };
        if found.is_none_or(|(best, _)| omega < best) {
            found = Some((omega, parameters));
        }
    }
    found.map(|(_, parameters)| parameters)
}

/// Edges of this length cross the window wherever the corner is in it.
fn open_length(window: f64) -> f64 {
    2.0 * window + 20.0
}

/// The same directions, long enough.
fn lengthened(a: &Affine, window: f64) -> Affine {
    let length = open_length(window);
    let (u, v) = (a.axx.hypot(a.ayx), a.axy.hypot(a.ayy));
    Affine { axx: a.axx / u * length, ayx: a.ayx / u * length, axy: a.axy / v * length, ayy: a.ayy / v * length }
}

/// The symmetric root of second moments `M`, in units of the mask's: `A A^T moment = M`. `None` if the moments are those of a line.
fn moment_root(area: &Area, moment: f64) -> Option<[f64; 3]> {
    let [xx, xy, yy] = area.moments;
    let determinant = xx * yy - xy * xy;
    if determinant <= 1e-2 * (xx + yy) * (xx + yy) / 4.0 {
        return None;
    }
    // Of a 2 x 2 matrix the root is (M + sqrt(det) I) / sqrt(tr + 2 sqrt(det)).
    let root = determinant.sqrt();
    let scale = 1.0 / ((xx + yy + 2.0 * root) * moment).sqrt();
    Some([(xx + root) * scale, xy * scale, (yy + root) * scale])
}

fn turned([xx, xy, yy]: [f64; 3], angle: f64) -> Affine {
    let (sine, cosine) = angle.sin_cos();
    Affine { axx: xx * cosine + xy * sine, axy: xy * cosine - xx * sine, ayx: xy * cosine + yy * sine, ayy: yy * cosine - xy * sine }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lsm::planes::Planes;

    #[test]
    fn moments_give_the_shape() {
        // A sheared disc: A = R S with any turn R of the disc's own plane.
        let (axx, axy, ayy) = (14.0, 5.0, 9.0);
        let inside = |x: f64, y: f64| {
            let v = y / ayy;
            let u = (x - axy * v) / axx;
            u * u + v * v < 0.25
        };
        let image = Image::from_fn(61, 61, |x, y| if inside(x as f64 - 30.2, y as f64 - 30.4) { 0.1 } else { 0.9 });
        let mask = Mask::new(calibench_model::TargetKind::Disc).unwrap();
        let mut planes = Planes::new(31);
        planes.observe(image.rows_around(30, 30, 15).unwrap());
        let area = area(&mask, planes.grey(), area::range(planes.grey()).unwrap(), [15.0, 15.0]).unwrap();
        let shapes = shapes(&mask, None, 0.0, Some(&area), 31.0);
        assert_eq!(shapes.len(), 1);
        let a = shapes[0];
        // A A^T is what an ellipse tells of A.
        let found = [a.axx * a.axx + a.axy * a.axy, a.axx * a.ayx + a.axy * a.ayy, a.ayx * a.ayx + a.ayy * a.ayy];
        let truth = [axx * axx + axy * axy, axy * ayy, ayy * ayy];
        assert!(found.iter().zip(truth).all(|(a, b)| (a - b).abs() < 0.08 * truth[0]), "{found:?} {truth:?}");
    }

    #[test]
    fn what_is_given_is_taken() {
        let mask = Mask::new(calibench_model::TargetKind::Square).unwrap();
        let given = Affine { axx: 7.0, axy: 1.0, ayx: -1.0, ayy: 6.0 };
        assert_eq!(shapes(&mask, Some(given), 3.0, None, 15.0), [given]);
        let sized = shapes(&mask, None, 8.0, None, 15.0);
        assert_eq!(sized.len(), TURNS as usize);
        assert!(sized.iter().all(|a| (a.axx.hypot(a.ayx) - 8.0).abs() < 1e-12 && (a.axx * a.ayy - a.axy * a.ayx - 64.0).abs() < 1e-10));
    }
}
