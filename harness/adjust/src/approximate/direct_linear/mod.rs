//! Camera and pose from control points alone: the direct linear transformation.

use calibench_model::camera::{Camera, CameraModel, ImageSize, Photogrammetric};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Matrix3, Point3, SMatrix, SVector, Vector3, Vector4};

use super::ApproximateError;
use super::consensus::{Search, each, others, search};
use super::error::at_least;
use super::interior::interior_from_data_sheet;
use super::least_squares::{Normal, minimise};
use super::planar::orthogonal;
use super::pose_fit::{Control, all_finite, moved_pose, pose_row, residual, square};
use super::projective::{Normaliser, Undetermined, projective};
use super::shape::Shape;

/// Places of c, x0, y0, b1 and b2 among the parameters of [`Photogrammetric`].
const LINEAR: [usize; 5] = [0, 1, 2, 8, 9];
/// Points that determine the eleven parameters.
const NEEDED: usize = 6;

/// A camera and its pose from one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectLinear {
    /// c, x0, y0, b1, b2; no distortion.
    pub camera: Photogrammetric,
    /// Its pose.
    pub pose: Pose,
    /// The standard deviation of an image coordinate from the residuals, px; `None` without redundancy.
    pub sigma0: Option<f64>,
    /// Observations minus eleven.
    pub redundancy: usize,
    /// Cofactors of c, x0, y0 (mm), b1, b2 (numbers), a small rotation about the camera's axes (rad) and the projection centre (object units), for 1
    /// px.
    pub cofactor: SMatrix<f64, 11, 11>,
    /// Computed minus measured for each point, px; `None` where the camera does not picture the point.
    pub residuals: Vec<Option<[f64; 2]>>,
    /// Points that did not fit.
    pub rejected: Vec<usize>,
}

/// The eleven parameters of a picture without distortion, c, x0, y0, b1, b2 and the pose, from six control points or more: linear, then least squares
/// in the image. With `against`, gross errors are searched for.
///
/// `pitch_um` turns px into mm.
///
/// # Errors
/// [`ApproximateError::TooFew`] below six, [`ApproximateError::NotFinite`], [`ApproximateError::Collinear`], [`ApproximateError::Coplanar`],
/// [`ApproximateError::Critical`] when the points lie on a twisted cubic or the like, [`ApproximateError::NoConsensus`], [`ApproximateError::DataSheet`].
///
/// Source: Abdel-Aziz & Karara 1971; the decomposition after Hartley & Zisserman 2004, section 6.2.
pub fn direct_linear(
    control: &[Control],
    size: ImageSize,
    pitch_um: f64,
    against: Option<&Search>,
) -> Result<DirectLinear, ApproximateError> {
    at_least(NEEDED, control.len(), "points", "a direct linear transformation")?;
    all_finite(control)?;
    let blank = interior_from_data_sheet(size, pitch_um, 1.0)?;
    let all: Vec<usize> = (0..control.len()).collect();
    let Some(against) = against else {
        let start = linear(control, &blank)?;
        return fitted(&start, control, &all);
    };
    let of = |chosen: &[usize]| chosen.iter().map(|&i| control[i]).collect::<Vec<_>>();
    let distance = |(camera, pose): &Start, index: usize| square(&Camera::from(*camera), pose, &control[index]);
    let propose = |chosen: &[usize]| linear(&of(chosen), &blank).into_iter().collect();
    let refine = |_: &Start, chosen: &[usize]| fit(&linear(&of(chosen), &blank).ok()?, &of(chosen)).map(|(start, _)| start);
    // A critical set of points is worth its own name.
    linear(control, &blank).map(|_| ()).or_else(|error| if error == ApproximateError::NoSolution { Ok(()) } else { Err(error) })?;
    let (start, agreeing) = search(control.len(), NEEDED, 2, against, propose, each(distance), refine)?;
    fitted(&start, control, &agreeing)
}

type Start = (Photogrammetric, Pose);

/// The linear solution, decomposed.
fn linear(control: &[Control], blank: &Photogrammetric) -> Result<Start, ApproximateError> {
    let shape = Shape::of(control.iter().map(|point| point.object));
    if shape.is_line() {
        return Err(ApproximateError::Collinear);
    }
    if shape.is_plane() {
        return Err(ApproximateError::Coplanar);
    }
    let image = Normaliser::of(control.iter().map(|point| [point.image.x, point.image.y])).ok_or(ApproximateError::ImageCollinear)?;
    // Each axis to a root mean square of one: a flat object is no worse than a cube.
    let rows = control.iter().map(|point| {
        let p = shape.axes.transpose() * (point.object - shape.centroid);
        let p = p.component_div(&Vector3::from(shape.extents));
        (Vector4::new(p.x, p.y, p.z, 1.0), image.apply([point.image.x, point.image.y]))
    });
    let normalised = projective(rows).map_err(|why| match why {
        Undetermined::Object => ApproximateError::Coplanar,
        Undetermined::Several => ApproximateError::Critical { what: "the eleven parameters" },
    })?;
    let map = image.inverse() * normalised;
    let left = map.fixed_columns::<3>(0) * Matrix3::from_diagonal(&Vector3::from(shape.extents.map(f64::recip))) * shape.axes.transpose();
    let last = map.column(3).into_owned();
    let centre = shape.centroid - left.lu().solve(&last).ok_or(ApproximateError::NoSolution)?;
    decomposed(&left, centre, blank).ok_or(ApproximateError::NoSolution)
}

/// `left = s K R` with K upper triangular of a positive diagonal and R the rotation of a camera whose y points down and z forward; `None` if `left` is
/// singular or a mirror image.
fn decomposed(left: &Matrix3<f64>, centre: Point3<f64>, blank: &Photogrammetric) -> Option<Start> {
    let left = left / left.row(2).norm();
    let rows: [_; 3] = std::array::from_fn(|i| left.row(i).transpose());
    let forward = rows[2];
    let (cy, cx) = (rows[1].dot(&forward), rows[0].dot(&forward));
    let across = rows[1] - forward * cy;
    let (fy, down) = (across.norm(), across.try_normalize(0.0)?);
    let skew = rows[0].dot(&down);
    let along = rows[0] - forward * cx - down * skew;
    let (fx, right) = (along.norm(), along.try_normalize(0.0)?);
    let axes = Matrix3::from_rows(&[right.transpose(), -down.transpose(), -forward.transpose()]);
    // The third coordinate is positive on average: a mirror image is no camera.
    if axes.determinant() <= 0.0 || !(fx * fy).is_finite() {
        return None;
    }
    let mm = blank.pitch_um * 1e-3;
    let frame = calibench_model::Frame::new(blank.size.width, blank.size.height, blank.pitch_um).ok()?;
    let point = frame.to_sensor(PixelPoint::new(cx, cy));
    let camera = Photogrammetric { c: fy * mm, x0: point.x, y0: point.y, b: [1.0 - fy / fx, -skew / fx], ..*blank };
    Some((camera, Pose { rotation: orthogonal(&axes), centre }))
}

/// Least squares in the image over the chosen points.
fn fit(start: &Start, chosen: &[Control]) -> Option<(Start, Normal<11>)> {
    let moved = |(camera, pose): &Start, step: &SVector<f64, 11>| {
        let mut values: Vec<f64> = camera.parameters().iter().map(|parameter| parameter.value).collect();
        LINEAR.iter().enumerate().for_each(|(i, &place)| values[place] += step[i]);
        (camera.with_parameters(&values), moved_pose(pose, &step.fixed_rows::<6>(5).into_owned()))
    };
    minimise(*start, |state| normal(state, chosen), moved)
}

/// Rows for c, x0, y0, b1, b2 and the pose.
fn normal((camera, pose): &Start, chosen: &[Control]) -> Option<Normal<11>> {
    let mut normal = Normal::new();
    for point in chosen {
        let found = camera.derivatives(pose.ray(&point.object)).ok()?;
        let misclosure = [found.point.x - point.image.x, found.point.y - point.image.y];
        let n = pose.camera_from_world(&point.object);
        for (axis, misclosure) in misclosure.into_iter().enumerate() {
            let by_pose = pose_row(pose, &n, found.by_ray[axis]);
            let row = |i: usize| if i < 5 { found.by_parameters[LINEAR[i]][axis] } else { by_pose[i - 5] };
            normal.add(&SVector::<f64, 11>::from_fn(|i, _| row(i)), misclosure);
        }
    }
    Some(normal)
}

fn fitted(start: &Start, control: &[Control], agreeing: &[usize]) -> Result<DirectLinear, ApproximateError> {
    let chosen: Vec<_> = agreeing.iter().map(|&i| control[i]).collect();
    let ((camera, pose), normal) = fit(start, &chosen).ok_or(ApproximateError::NoSolution)?;
    let cofactor = normal.cofactor().ok_or(ApproximateError::Critical { what: "the eleven parameters" })?;
    let redundancy = normal.redundancy();
    Ok(DirectLinear {
        camera,
        pose,
        sigma0: (redundancy > 0).then(|| (normal.squares / redundancy as f64).sqrt()),
        redundancy,
        cofactor,
        residuals: control.iter().map(|point| residual(&camera.into(), &pose, point)).collect(),
        rejected: others(control.len(), agreeing),
    })
}

#[cfg(test)]
mod tests;
