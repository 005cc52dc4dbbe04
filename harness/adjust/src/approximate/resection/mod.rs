//! Resection: the pose of a picture from control points.

use std::ops::Range;

use calibench_model::Pose;
use calibench_model::camera::Camera;
use nalgebra::Matrix6;

use super::ApproximateError;
use super::consensus::{AT_A_TIME, Search, Tolerance, others, search};
use super::error::at_least;
use super::p3p::p3p;
use super::planar::flattened_starts;
use super::pose_fit::{Control, FittedPose, Pictures, all_finite, fit_pictures, rays, residual};
use super::rival::is_worth;
use super::shape::Shape;

/// The least number of points: three fit up to four poses.
const NEEDED: usize = 4;
/// Height of points above their plane, as a share of the extent, below which a second pose is looked for.
const NEARLY_FLAT: f64 = 0.1;
/// Triples of which the poses may lead to a second minimum.
const RIVAL_TRIPLES: usize = 6;
/// Rotations that differ by less are one, as the norm of the difference.
const SAME: f64 = 1e-5;

/// The pose of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Resection {
    /// The pose, in the object's frame and units.
    pub pose: Pose,
    /// The standard deviation of an image coordinate from the residuals, px.
    pub sigma0: f64,
    /// Observations minus six.
    pub redundancy: usize,
    /// Cofactors of a small rotation about the camera's own x, y and z axes (rad) and of the projection centre (object units), for 1 px.
    pub cofactor: Matrix6<f64>,
    /// Computed minus measured for each point, px; `None` where the camera does not picture the point.
    pub residuals: Vec<Option<[f64; 2]>>,
    /// Points that did not fit.
    pub rejected: Vec<usize>,
    /// Another minimum, if one was met (four points, or nearly coplanar ones, often have two): compare its `squares` with `sigma0^2 redundancy`.
    pub rival: Option<FittedPose>,
}

/// The pose of a picture from four control points or more, interior orientation fixed: the best of the poses of point triples, then least squares in the
/// image. With `against`, gross errors are searched for; without, every point counts.
///
/// # Errors
/// [`ApproximateError::TooFew`] below four (see [`super::poses_of_three`] for three), [`ApproximateError::NotFinite`], [`ApproximateError::Collinear`],
/// [`ApproximateError::NotInCamera`], [`ApproximateError::NoSolution`], [`ApproximateError::NoConsensus`], and [`ApproximateError::Critical`] when the
/// pose can move while the points stay where they are (the projection centre is on the cylinder through three points, say).
///
/// Source: Fischler & Bolles 1981; see [`super::p3p()`] and [`super::fit_pose`].
pub fn resect(camera: &Camera, control: &[Control], against: Option<&Search>) -> Result<Resection, ApproximateError> {
    at_least(NEEDED, control.len(), "points", "a resection")?;
    all_finite(control)?;
    if Shape::of(control.iter().map(|point| point.object)).is_line() {
        return Err(ApproximateError::Collinear);
    }
    if against.is_none() {
        rays(camera, control.iter().map(|point| point.image))?;
    }
    let everything = Search { seed: 0, tolerance: Tolerance::Pixels(f64::INFINITY) };
    let propose = |chosen: &[usize]| {
        let three = [chosen[0], chosen[1], chosen[2]].map(|index| control[index]);
        match rays(camera, three.iter().map(|point| point.image)) {
            Ok(rays) => p3p(&[rays[0], rays[1], rays[2]], &three.map(|point| point.object)),
            Err(_) => Vec::new(),
        }
    };
    let pictures = Pictures::of(camera);
    let squares = |pose: &Pose, range: Range<usize>, found: &mut Vec<f64>| pictures.squares(pose, &control[range], found);
    let refine = |pose: &Pose, chosen: &[usize]| fit_pictures(&pictures, pose, &of(control, chosen)).ok().map(|fit| fit.pose);
    let (pose, agreeing) = search(control.len(), 3, 2, against.unwrap_or(&everything), propose, squares, refine)?;
    let rivals = spread_triples(&agreeing).flat_map(|triple| propose(&triple)).collect();
    let (best, rival) = best_of(camera, &pictures, &pose, rivals, &of(control, &agreeing))?;
    let cofactor = best.cofactor.ok_or(ApproximateError::Critical { what: "the pose" })?;
    Ok(Resection {
        pose: best.pose,
        sigma0: best.sigma0().unwrap_or(0.0),
        redundancy: best.redundancy,
        cofactor,
        residuals: control.iter().map(|point| residual(camera, &best.pose, point)).collect(),
        rejected: others(control.len(), &agreeing),
        rival,
    })
}

fn of(control: &[Control], chosen: &[usize]) -> Vec<Control> {
    chosen.iter().map(|&i| control[i]).collect()
}

/// Some triples of the points, far apart in their order.
fn spread_triples(agreeing: &[usize]) -> impl Iterator<Item = [usize; 3]> + '_ {
    let n = agreeing.len();
    (0..RIVAL_TRIPLES.min(n)).map(move |k| [k, k + n / 3, k + 2 * n / 3].map(|i| agreeing[i % n]))
}

/// The least squares from a start, from those of `others` that are worth it and, where the points are nearly coplanar, from the two poses before their
/// plane: the best and the next.
fn best_of(
    camera: &Camera,
    pictures: &Pictures<'_>,
    start: &Pose,
    others: Vec<Pose>,
    chosen: &[Control],
) -> Result<(FittedPose, Option<FittedPose>), ApproximateError> {
    let shape = Shape::of(chosen.iter().map(|point| point.object));
    if shape.is_line() {
        return Err(ApproximateError::Collinear);
    }
    let first = fit_pictures(pictures, start, chosen)?;
    // Most are hopeless after a few points.
    let is_worth = |pose: &Pose| {
        let (mut sum, mut squares) = (0.0, Vec::new());
        chosen.chunks(AT_A_TIME).all(|some| {
            squares.clear();
            pictures.squares(pose, some, &mut squares);
            sum += squares.iter().sum::<f64>();
            is_worth(sum, first.squares, chosen.len())
        })
    };
    let mut starts: Vec<Pose> = others.into_iter().filter(is_worth).collect();
    if shape.extents[2] < NEARLY_FLAT * shape.extents[0] {
        starts.extend(flattened_starts(camera, chosen, &shape).into_iter().flatten());
    }
    let mut fitted: Vec<_> = starts.iter().filter_map(|start| fit_pictures(pictures, start, chosen).ok()).chain([first]).collect();
    fitted.sort_by(|a, b| a.squares.total_cmp(&b.squares));
    let best = fitted[0];
    let differs = |other: &&FittedPose| (other.pose.rotation - best.pose.rotation).norm() > SAME;
    Ok((best, fitted.iter().find(differs).copied()))
}

#[cfg(test)]
mod tests;
