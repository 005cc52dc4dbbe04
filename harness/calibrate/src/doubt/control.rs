//! Whether control points are where their file says.

use calibench_adjust::{Datum, Network, ObjectPoint, Options, Solution, Status, Variance, adjust};
use calibench_model::upper_median;
use nalgebra::{Matrix3, Point3, Vector3};

use crate::Calibration;
use crate::allowed::Allowed;
use crate::datum::DatumChoice;
use crate::resampled::NEAR;

/// Control points at most, up to which all are freed.
const MOST: usize = 20_000;
/// Standard deviations beyond which a point is off.
const OFF: f64 = 6.0;
/// Points that are named one by one.
const NAMED: usize = 3;
/// Share of the squares of all shifts that a cause must explain.
const PART: f64 = 0.6;

/// The same observations with every control point free, in a free network.
pub(super) fn check(calibration: &Calibration<'_>) -> Allowed {
    let whole = &calibration.prepared.network;
    if !matches!(calibration.prepared.settings.datum, DatumChoice::Control | DatumChoice::Fixed) {
        return Allowed::untested("they are free already");
    }
    if whole.points.iter().any(|point| point.coordinates != [Status::Fixed; 3]) {
        return Allowed::untested("they are weighted, or some points are none");
    }
    if !whole.per_image.is_empty() {
        return Allowed::untested("images have numbers of their own");
    }
    if whole.points.len() > MOST {
        return Allowed::untested("there are too many");
    }
    let network = freed(calibration);
    let Ok(free) = adjust(&network, &Options { most_iterations: NEAR, ..calibration.options() }) else {
        return Allowed::untested("without them the network is not determined");
    };
    // Seven of all coordinates are the frame's (six where distances give the scale), and a bend is a part of them.
    let frame = 7 - usize::from(!whole.distances.is_empty());
    let bends = whole.surfaces.iter().flat_map(|surface| surface.statuses).filter(|status| status.is_unknown()).count();
    calibration.adjusted(&free, 3 * network.points.len() - frame - bends, || cause(&network, &free, bends > 0))
}

/// Every point free: where too few images see one, the network is not determined.
fn freed(calibration: &Calibration<'_>) -> Network {
    let ended = calibration.ended();
    let points =
        ended.points.iter().zip(calibration.solution.points()).map(|(point, position)| ObjectPoint::free(point.name.clone(), *position));
    Network { points: points.collect(), surfaces: Vec::new(), datum: Datum::Inner, ..ended }
}

/// What the shifts of the points look like; `is_bent`: a bend of the board is adjusted already.
fn cause(network: &Network, free: &Solution<'_>, is_bent: bool) -> String {
    let shifts: Vec<Vector3<f64>> = network.points.iter().zip(free.points()).map(|(point, found)| found - point.position).collect();
    let off = off(free, &shifts);
    if let Some([a, b]) = swapped(network, free, &off) {
        return format!("the names of control points {a} and {b} are swapped");
    }
    if (1..=NAMED).contains(&off.len()) {
        let names: Vec<&str> = off.iter().map(|&i| network.points[i].name.as_str()).collect();
        let most = off.iter().map(|&i| shifts[i].norm()).fold(0.0, f64::max);
        return format!("control point {} moved, by {most:.3} object units", names.join(", "));
    }
    if let Some(stretch) = stretched(network, &shifts) {
        return stretch;
    }
    if is_along_normal(network, &shifts) {
        let not_yet = "the board is bent; try --board-shape bent or free";
        let already = "the board is bent otherwise than a surface of second order, which is allowed for; try --board-shape free";
        return if is_bent { already } else { not_yet }.into();
    }
    let worst = (0..shifts.len()).max_by(|&a, &b| shifts[a].norm().total_cmp(&shifts[b].norm())).unwrap_or(0);
    format!(
        "the coordinates of control points are not as their file says: {} is {:.3} object units off, the most; try --board-shape free",
        network.points[worst].name,
        shifts[worst].norm()
    )
}

/// The points whose shift is not to be explained by their standard deviations and those of the others.
fn off(free: &Solution<'_>, shifts: &[Vector3<f64>]) -> Vec<usize> {
    let usual = upper_median(shifts.iter().map(Vector3::norm)).unwrap_or(0.0);
    let Ok(covariances) = free.covariances(Variance::Estimated) else { return Vec::new() };
    let is_off = |i: &usize| shifts[*i].norm() > OFF * usual.max(covariances.points[*i].trace().max(0.0).sqrt());
    (0..shifts.len()).filter(is_off).collect()
}

/// Two points of which each is where the other should be.
fn swapped<'n>(network: &'n Network, free: &Solution<'_>, off: &[usize]) -> Option<[&'n str; 2]> {
    let near = |a: usize, b: usize| {
        let apart = (network.points[a].position - network.points[b].position).norm();
        (free.points()[a] - network.points[b].position).norm() < 0.2 * apart
    };
    let pairs = off.iter().enumerate().flat_map(|(k, &a)| off[k + 1..].iter().map(move |&b| (a, b)));
    let found = pairs.into_iter().find(|&(a, b)| near(a, b) && near(b, a));
    found.map(|(a, b)| [network.points[a].name.as_str(), network.points[b].name.as_str()])
}

/// One direction that is too long against another: of squares that are none.
fn stretched(network: &Network, shifts: &[Vector3<f64>]) -> Option<String> {
    let middle = network.points.iter().map(|point| point.position.coords).sum::<Vector3<f64>>() / network.points.len() as f64;
    let from: Vec<Vector3<f64>> = network.points.iter().map(|point| point.position.coords - middle).collect();
    let (spread, moved) = from.iter().zip(shifts).fold((Matrix3::zeros(), Matrix3::zeros()), |(spread, moved), (from, shift)| {
        (spread + from * from.transpose(), moved + shift * from.transpose())
    });
    // Across a board there is no extent to speak of.
    let inverse = spread.pseudo_inverse(1e-3 * spread.trace()).ok()?;
    let affine = moved * inverse;
    let strain = 0.5 * (affine + affine.transpose());
    let explained: f64 = from.iter().map(|from| (strain * from).norm_squared()).sum();
    let all: f64 = shifts.iter().map(Vector3::norm_squared).sum();
    if explained < PART * all {
        return None;
    }
    let eigen = strain.symmetric_eigen();
    let (low, high) = (eigen.eigenvalues.imin(), eigen.eigenvalues.imax());
    let along = |k: usize| {
        let axis = eigen.eigenvectors.column(k);
        ["X", "Y", "Z"][axis.iamax()]
    };
    let percent = 100.0 * (eigen.eigenvalues[high] - eigen.eigenvalues[low]);
    Some(format!(
        "the testfield is {percent:.2} % longer along {} against {} than its file says: is the size of a square right?",
        along(high),
        along(low)
    ))
}

/// Whether the shifts are along the normal of a plane.
fn is_along_normal(network: &Network, shifts: &[Vector3<f64>]) -> bool {
    let points: Vec<Point3<f64>> = network.points.iter().map(|point| point.position).collect();
    let middle = points.iter().map(|point| point.coords).sum::<Vector3<f64>>() / points.len() as f64;
    let spread: Matrix3<f64> = points.iter().map(|point| (point.coords - middle) * (point.coords - middle).transpose()).sum();
    let eigen = spread.symmetric_eigen();
    let (low, high) = (eigen.eigenvalues.imin(), eigen.eigenvalues.imax());
    let normal = eigen.eigenvectors.column(low).into_owned();
    let along: f64 = shifts.iter().map(|shift| shift.dot(&normal).powi(2)).sum();
    let all: f64 = shifts.iter().map(Vector3::norm_squared).sum();
    eigen.eigenvalues[low] < 1e-3 * eigen.eigenvalues[high] && along > PART * all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::{board, lens, settings};

    #[test]
    fn a_testfield_that_is_too_long_one_way_is_said() {
        let network = board(lens()).prepared(&settings("opencv5")).unwrap().network;
        let shifts = |strain: f64, other: f64| -> Vec<Vector3<f64>> {
            let one = |(i, point): (usize, &ObjectPoint)| {
                let at = point.position.coords;
                Vector3::new(strain * (at.x - 120.0), -strain * (at.y - 90.0), 0.0) + other * Vector3::new((7.0 * i as f64).sin(), 0.0, 1.0)
            };
            network.points.iter().enumerate().map(one).collect()
        };
        for strain in [0.000_5, 0.0025, 0.02] {
            let said = stretched(&network, &shifts(strain, 0.0)).unwrap();
            let expected = format!("{:.2} % longer along X against Y", 200.0 * strain);
            assert!(said.contains(&expected), "{strain}: {said}");
        }
        let said = stretched(&network, &shifts(-0.01, 0.1)).unwrap();
        assert!(said.contains("longer along Y against X"), "{said}");
        // Shifts of which a strain explains less than six tenths.
        for (strain, other) in [(0.0, 0.1), (0.001, 0.1), (0.0, 3.0), (0.02, 3.0)] {
            assert_eq!(stretched(&network, &shifts(strain, other)), None, "{strain} {other}");
        }
    }
}
