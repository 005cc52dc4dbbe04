//! What the uncertainty of an interior orientation means in the image.

use calibench_model::camera::{Camera, CameraModel, DerivativeBuffer, Ray};
use calibench_model::convert::cell_share;
use calibench_model::{Covariance, PixelPoint};
use nalgebra::DMatrix;

use crate::AdjustError;

/// How far away the points are whose images are asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distance {
    /// At infinity: a rotation of the camera makes up for what it can.
    Far,
    /// In a plane before the camera, at this distance, object units: a shift of the camera makes up for what it can as well.
    Near(f64),
}

/// The uncertainty of a place in the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncertainty {
    /// The place.
    pub at: PixelPoint,
    /// Covariance of the image of the object point that is seen there, px^2.
    pub covariance: Covariance,
}

const NEEDS: &str = "a map needs 3 x 3 places at least, and the covariance of parameters that the camera has";

/// The uncertainty of projected points over the frame, on a grid of `columns` x `rows` places from the first pixel's centre to the last's, row by
/// row.
///
/// `covariance` belongs to the parameters `names` of `camera`, in their units, as [`crate::Covariances::of_camera`] returns them. What a change of
/// the exterior orientation makes up for (in the least-squares sense over the grid) is not the interior orientation's fault and is taken off. Places
/// without a ray are left out.
///
/// # Errors
/// [`AdjustError::NotAvailable`] for a grid of fewer than 3 x 3 places, names that the camera does not have, or a distance that is not positive.
///
/// Source: after the projection uncertainty of mrcal (Kogan 2022).
pub fn frame_uncertainty(
    camera: &Camera,
    (names, covariance): (&[&str], &DMatrix<f64>),
    (columns, rows): (usize, usize),
    distance: Distance,
) -> Result<Vec<Uncertainty>, AdjustError> {
    let (seen, left) = effects(camera, names, (columns, rows), distance, |_| 1.0)?;
    if covariance.shape() != (names.len(), names.len()) {
        return Err(AdjustError::NotAvailable(NEEDS));
    }
    let of = |(k, (at, _)): (usize, &Seen)| {
        let e = left.rows(2 * k, 2);
        let q = e * covariance * e.transpose();
        Uncertainty { at: *at, covariance: Covariance { sxx: q[(0, 0)], sxy: q[(0, 1)], syy: q[(1, 1)] } }
    };
    Ok(seen.iter().enumerate().map(of).collect())
}

/// The matrix `A` that makes of a covariance `C` of the parameters `names` the mean square over the area of the frame (trapezoidal rule), px^2: `trace(A C)`. What
/// a motion of the camera makes up for is taken off as by [`frame_uncertainty`], with the same weights.
///
/// # Errors
/// As [`frame_uncertainty`].
pub fn frame_weight(camera: &Camera, names: &[&str], grid: (usize, usize), distance: Distance) -> Result<DMatrix<f64>, AdjustError> {
    let weight = |at: PixelPoint| cell_share(camera.size(), at);
    let (seen, left) = effects(camera, names, grid, distance, weight)?;
    Ok(left.tr_mul(&left) / seen.iter().map(|seen| weight(seen.0)).sum::<f64>())
}

/// A place of the grid and its ray.
type Seen = (PixelPoint, Ray);

/// Places of the grid with their rays, and what the parameters do there that no motion of the camera does, times the root of the place's weight: two rows a place,
/// a column a parameter.
fn effects(
    camera: &Camera,
    names: &[&str],
    (columns, rows): (usize, usize),
    distance: Distance,
    weight: impl Fn(PixelPoint) -> f64,
) -> Result<(Vec<Seen>, DMatrix<f64>), AdjustError> {
    let parameters = camera.parameters();
    let places: Vec<usize> = names.iter().filter_map(|name| parameters.iter().position(|parameter| parameter.name == *name)).collect();
    if columns < 3 || rows < 3 || places.len() != names.len() {
        return Err(AdjustError::NotAvailable(NEEDS));
    }
    let shift = match distance {
        Distance::Far => None,
        Distance::Near(distance) if distance > 0.0 && distance.is_finite() => Some(distance),
        Distance::Near(_) => return Err(AdjustError::NotAvailable("a distance must be positive")),
    };
    let size = camera.size();
    let along = |i: usize, n: usize, length: u32| f64::from(length - 1) * i as f64 / (n - 1) as f64;
    let grid = (0..columns * rows).map(|k| PixelPoint::new(along(k % columns, columns, size.width), along(k / columns, rows, size.height)));
    let seen: Vec<Seen> = grid.filter_map(|at| Some((at, camera.unproject(at).ok()?))).collect();
    let (mut interior, mut exterior) = slopes(camera, &seen, &places, shift);
    for (k, seen) in seen.iter().enumerate() {
        let root = weight(seen.0).sqrt();
        interior.rows_mut(2 * k, 2).scale_mut(root);
        exterior.rows_mut(2 * k, 2).scale_mut(root);
    }
    // What is left of the parameters' effects: (1 - R R^+) J.
    let svd = exterior.svd(true, false);
    let Some(u) = svd.u else { return Err(AdjustError::NotAvailable("the frame has too few rays")) };
    let left = &interior - &u * u.tr_mul(&interior);
    Ok((seen, left))
}

/// Derivatives of all places by the parameters, and by a rotation and, at a distance, a shift of the camera.
fn slopes(camera: &Camera, seen: &[Seen], places: &[usize], shift: Option<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let mut interior = DMatrix::zeros(2 * seen.len(), places.len());
    let mut exterior = DMatrix::zeros(2 * seen.len(), if shift.is_some() { 6 } else { 3 });
    let mut buffer = DerivativeBuffer::default();
    for (k, (_, ray)) in seen.iter().enumerate() {
        let ray = at_depth(*ray, shift);
        if camera.derivatives_into(ray, &mut buffer).is_err() {
            continue;
        }
        for axis in 0..2 {
            let row = 2 * k + axis;
            places.iter().enumerate().for_each(|(j, &place)| interior[(row, j)] = buffer.by_parameters()[place][axis]);
            let [gx, gy, gz] = buffer.by_ray[axis];
            let scale = shift.unwrap_or(1.0);
            for (j, by) in
                by_turn([gx, gy, gz], ray).into_iter().chain([gx * scale, gy * scale, gz * scale]).take(exterior.ncols()).enumerate()
            {
                exterior[(row, j)] = by;
            }
        }
    }
    (interior, exterior)
}

/// The point of a ray in a plane before the camera, where that can be, or else at that distance; at infinity its direction.
pub(super) fn at_depth(ray: Ray, depth: Option<f64>) -> Ray {
    let length = (ray.x * ray.x + ray.y * ray.y + ray.z * ray.z).sqrt();
    let scale = depth.map_or(1.0 / length, |depth| if ray.z < -0.1 * length { depth / -ray.z } else { depth / length });
    Ray { x: ray.x * scale, y: ray.y * scale, z: ray.z * scale }
}

/// Derivatives of a pixel's coordinate by a small rotation of the camera about its axes, from those by the ray.
pub(crate) fn by_turn([gx, gy, gz]: [f64; 3], ray: Ray) -> [f64; 3] {
    [ray.y * gz - ray.z * gy, ray.z * gx - ray.x * gz, ray.x * gy - ray.y * gx]
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_model::camera::{ImageSize, Photogrammetric};

    fn camera() -> Camera {
        let size = ImageSize { width: 3001, height: 2001 };
        Photogrammetric { size, pitch_um: 8.0, c: 24.0, x0: 0.0, y0: 0.0, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2] }.into()
    }

    fn largest(name: &str, sigma: f64, distance: Distance) -> f64 {
        let covariance = DMatrix::from_element(1, 1, sigma * sigma);
        let map = frame_uncertainty(&camera(), (&[name], &covariance), (15, 11), distance).unwrap();
        assert_eq!(map.len(), 165);
        map.iter().map(|found| (found.covariance.sxx + found.covariance.syy).sqrt()).fold(0.0, f64::max)
    }

    #[test]
    fn what_the_exterior_orientation_makes_up_for_is_no_uncertainty() {
        // Before a plane at a known distance a shift along the axis does what c does, a shift across what x0 does.
        assert!(largest("c", 0.01, Distance::Near(5.0)) < 1e-9);
        assert!(largest("x0", 0.01, Distance::Near(5.0)) < 1e-9);
        // At infinity nothing does what c does: 0.01 mm of 24 mm at the corner, 1803 px from the middle.
        let corner = 1000.0_f64.hypot(1500.0) * 0.01 / 24.0;
        assert!((largest("c", 0.01, Distance::Far) - corner).abs() < 1e-9);
        // A rotation does most of what x0 does, not all.
        let x0 = largest("x0", 0.01, Distance::Far);
        assert!(x0 > 0.05 && x0 < 0.7 * 1.25, "{x0}");
    }

    /// Of a finer and finer grid the unweighted mean and the mean over the area are one.
    #[test]
    fn the_weight_makes_the_mean_square_over_the_frame() {
        let names = ["c", "x0", "k1"];
        let covariance = DMatrix::from_row_slice(3, 3, &[4e-4, 1e-4, -2e-8, 1e-4, 9e-4, 1e-8, -2e-8, 1e-8, 1e-11]);
        for distance in [Distance::Far, Distance::Near(3.0)] {
            let weighed = |grid| (frame_weight(&camera(), &names, grid, distance).unwrap() * &covariance).trace();
            let map = frame_uncertainty(&camera(), (&names, &covariance), (121, 81), distance).unwrap();
            let mean = map.iter().map(|found| found.covariance.sxx + found.covariance.syy).sum::<f64>() / map.len() as f64;
            let [fine, coarse] = [(121, 81), (31, 21)].map(weighed);
            assert!((fine - mean).abs() < 0.06 * mean && fine < mean, "{fine} {mean}");
            assert!((coarse - fine).abs() < 0.03 * fine, "{coarse} {fine}");
        }
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let covariance = DMatrix::from_element(1, 1, 1.0);
        let map = |names: &[&str], grid, distance| frame_uncertainty(&camera(), (names, &covariance), grid, distance);
        assert!(map(&["fx"], (5, 5), Distance::Far).is_err());
        assert!(map(&["c"], (2, 5), Distance::Far).is_err());
        assert!(map(&["c"], (5, 5), Distance::Near(0.0)).is_err());
        assert!(map(&["c", "x0"], (5, 5), Distance::Far).is_err());
    }
}
