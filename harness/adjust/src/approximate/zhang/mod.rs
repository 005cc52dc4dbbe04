//! The interior orientation from pictures of planes.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, ImageSize};
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2};

use super::ApproximateError;
use super::error::at_least;
use super::homography::normalised;
use super::interior::{centre, pinhole};
use super::pose_fit::Control;
use super::projective::Normaliser;
use super::shape::{Shape, ascending};

/// Perspective must exceed its own standard deviation, taken from the homography's residuals, this many times, and what rounding leaves.
const SIGNIFICANT: f64 = 5.0;
const ROUNDING: f64 = 1e-9;
/// Eigenvalues whose ratio is below this are not told from zero.
const WEAK: f64 = 1e-9;
/// Focal lengths in halves of the longer side, and the ratio of the two, that a camera may have.
const FOCAL: [f64; 2] = [0.1, 200.0];
const ASPECT: f64 = 1.5;

/// What had to be assumed for want of views.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Assumed {
    /// Nothing but a rectangular pixel: two focal lengths and the principal point are from the views.
    Nothing,
    /// The principal point is the centre of the frame.
    Centre,
    /// The principal point is the centre of the frame, and pixels are square.
    CentreAndSquare,
}

/// An interior orientation from planes.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneInterior {
    /// The camera, without distortion.
    pub camera: Camera,
    /// What had to be assumed.
    pub assumed: Assumed,
    /// Views that were of use: those whose plane is tilted enough to show perspective.
    pub used: Vec<usize>,
}

/// The interior orientation from views of planes whose points are known, in closed form; distortion is neglected, so it is a start.
///
/// Each view is a list of coplanar control points (each view may show another plane, in axes of its own). The principal point comes from three useful
/// views or more, and only if it lies in the middle half of the frame; else it is the centre. Pixels are square where there is one view, or one
/// direction of tilt alone. The answer says what was assumed. Useful are views of four points or more that show perspective beyond what their residuals
/// could feign.
///
/// # Errors
/// [`ApproximateError::TooFew`] without a view of four points, [`ApproximateError::NoPerspective`] when all views are parallel to their planes,
/// [`ApproximateError::NoInterior`] when no focal length fits; what [`super::homography`] says of the first view if no view has one.
///
/// Source: Zhang 2000, A flexible new technique for camera calibration, section 3.1, without skew.
pub fn interior_from_planes(views: &[&[Control]], size: ImageSize) -> Result<PlaneInterior, ApproximateError> {
    at_least(1, views.iter().filter(|view| view.len() >= 4).count(), "views of four points", "an interior orientation")?;
    let middle = centre(size)?;
    let frame = Normaliser { centre: [middle.x, middle.y], scale: 2.0 / f64::from(size.width.max(size.height)) };
    let (mut used, mut rows, mut failure) = (Vec::new(), Vec::with_capacity(2 * views.len()), None);
    for (index, view) in views.iter().enumerate() {
        match columns(view, &frame) {
            Ok(Some([a, b])) => {
                used.push(index);
                rows.extend([conic_row(&a, &b), conic_row(&a, &a) - conic_row(&b, &b)]);
            }
            Ok(None) => failure = Some(ApproximateError::NoPerspective),
            Err(error) => failure = failure.or(Some(error)),
        }
    }
    if used.is_empty() {
        return Err(failure.unwrap_or(ApproximateError::NoPerspective));
    }
    let half = [f64::from(size.width), f64::from(size.height)].map(|side| 0.25 * side * frame.scale);
    let (focal, [x, y], assumed) = complete(&rows, used.len(), half)
        .map(|(focal, point)| (focal, point, Assumed::Nothing))
        .or_else(|| centred(&rows, used.len()).map(|focal| (focal, [0.0; 2], Assumed::Centre)))
        .or_else(|| square(&rows).map(|focal| ([focal; 2], [0.0; 2], Assumed::CentreAndSquare)))
        .ok_or(ApproximateError::NoInterior)?;
    let px = 1.0 / frame.scale;
    let camera = pinhole(size, focal.map(|f| f * px), PixelPoint::new(middle.x + x * px, middle.y + y * px));
    Ok(PlaneInterior { camera: camera.into(), assumed, used })
}

type Row = SVector<f64, 5>;

/// The pictures of the plane's two axes, in the normalised frame; `None` if the view shows no perspective.
fn columns(view: &[Control], frame: &Normaliser) -> Result<Option<[nalgebra::Vector3<f64>; 2]>, ApproximateError> {
    let shape = Shape::of(view.iter().map(|point| point.object));
    let pairs: Vec<_> = view.iter().map(|point| (shape.in_plane(&point.object), [point.image.x, point.image.y])).collect();
    let (matrix, from, to) = normalised(&pairs)?;
    let h = matrix / matrix[(2, 2)];
    // In normalised coordinates an element of the last row has the standard deviation of a mean of the residuals.
    let sigma = (squares(&h, &pairs, &from, &to) / (2 * pairs.len() - 8).max(1) as f64 / pairs.len() as f64).sqrt();
    if h[(2, 0)].hypot(h[(2, 1)]) <= SIGNIFICANT * sigma + ROUNDING {
        return Ok(None);
    }
    let picture = frame.matrix() * to.inverse() * h * Matrix3::from_diagonal(&nalgebra::Vector3::new(from.scale, from.scale, 1.0));
    let (a, b) = (picture.column(0).into_owned(), picture.column(1).into_owned());
    let norm = a.norm().hypot(b.norm());
    Ok(Some([a / norm, b / norm]))
}

/// The sum of the squared residuals of a normalised homography.
fn squares(h: &Matrix3<f64>, pairs: &[([f64; 2], [f64; 2])], from: &Normaliser, to: &Normaliser) -> f64 {
    let square = |&(a, b): &([f64; 2], [f64; 2])| {
        let ([x, y], [u, v]) = (from.apply(a), to.apply(b));
        let p = h * nalgebra::Vector3::new(x, y, 1.0);
        (p.x / p.z - u).powi(2) + (p.y / p.z - v).powi(2)
    };
    pairs.iter().map(square).sum()
}

/// `a' B b` in the elements b11, b22, b13, b23, b33 of the picture B of the absolute conic.
fn conic_row(a: &nalgebra::Vector3<f64>, b: &nalgebra::Vector3<f64>) -> Row {
    Row::from([a.x * b.x, a.y * b.y, a.x * b.z + a.z * b.x, a.y * b.z + a.z * b.y, a.z * b.z])
}

/// Focal lengths and principal point from three views or more; `None` if they are weak or impossible.
fn complete(rows: &[Row], views: usize, half: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
    if views < 3 {
        return None;
    }
    let mut normal = SMatrix::<f64, 5, 5>::zeros();
    rows.iter().for_each(|row| normal.ger(1.0, row, row, 1.0));
    let (values, vectors) = ascending(normal);
    if values[1] <= WEAK * values[4] {
        return None;
    }
    let b: Row = vectors.column(0).into();
    let [xx, yy, xz, yz, zz] = b.into();
    let (x, y) = (-xz / xx, -yz / yy);
    let scale = zz - x * x * xx - y * y * yy;
    let focal = possible([scale / xx, scale / yy])?;
    (x.abs() <= half[0] && y.abs() <= half[1]).then_some((focal, [x, y]))
}

/// Both focal lengths from two views or more, with the principal point in the centre.
fn centred(rows: &[Row], views: usize) -> Option<[f64; 2]> {
    if views < 2 {
        return None;
    }
    let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
    for row in rows {
        let a = Vector2::new(row[0], row[1]);
        normal += a * a.transpose();
        right -= a * row[4];
    }
    let (values, _) = ascending(normal);
    if values[0] <= WEAK * values[1] {
        return None;
    }
    let inverse = normal.try_inverse()? * right;
    possible([1.0 / inverse.x, 1.0 / inverse.y])
}

/// One focal length, with the principal point in the centre.
fn square(rows: &[Row]) -> Option<f64> {
    let (mut normal, mut right) = (0.0, 0.0);
    for row in rows {
        let a = row[0] + row[1];
        (normal, right) = (normal + a * a, right - a * row[4]);
    }
    possible([normal / right; 2]).map(|[focal, _]| focal)
}

/// The roots of two squared focal lengths, if a camera may have them.
fn possible(squares: [f64; 2]) -> Option<[f64; 2]> {
    let [x, y] = squares.map(f64::sqrt);
    let usual = |f: f64| f > FOCAL[0] && f < FOCAL[1];
    (usual(x) && usual(y) && x < ASPECT * y && y < ASPECT * x).then_some([x, y])
}

#[cfg(test)]
mod tests;
