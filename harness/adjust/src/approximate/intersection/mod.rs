//! Forward intersection: an object point from oriented pictures.

use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Matrix3, Point3, SVector, Vector3};

use super::ApproximateError;
use super::consensus::{Search, each, others, search};
use super::error::at_least;
use super::least_squares::{Normal, minimise};

/// An angle between rays that rounding alone can make, rad.
const ROUNDING: f64 = 1e-10;

/// A point seen in an oriented picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight<'a> {
    /// Its interior orientation.
    pub camera: &'a Camera,
    /// Its exterior orientation.
    pub pose: &'a Pose,
    /// The measured image coordinates.
    pub image: PixelPoint,
}

/// An object point from its pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Intersection {
    /// Object units.
    pub point: Point3<f64>,
    /// Its cofactors, squared object units for 1 px.
    pub cofactor: Matrix3<f64>,
    /// The standard deviation of an image coordinate from the residuals, px.
    pub sigma0: f64,
    /// Observations minus three.
    pub redundancy: usize,
    /// Computed minus measured for each sight, px; `None` where the camera does not picture the point.
    pub residuals: Vec<Option<[f64; 2]>>,
    /// The largest angle between two of the rays that agree, rad.
    pub angle: f64,
    /// Sights that did not fit.
    pub rejected: Vec<usize>,
}

/// The object point of least squares in the images, interior and exterior orientations fixed: from the point closest to all rays. With `against`, gross
/// errors are searched for, which takes three sights or more.
///
/// `least_angle`, rad: rays that meet at less are called parallel.
///
/// # Errors
/// [`ApproximateError::TooFew`] below two sights, [`ApproximateError::NotFinite`], [`ApproximateError::NotInCamera`], [`ApproximateError::Parallel`],
/// [`ApproximateError::Behind`] when the rays meet behind a camera or in its projection centre, [`ApproximateError::NoConsensus`].
///
/// Source: Mikhail, Bethel & McGlone 2001, section 5.4; Hartley & Sturm 1997 for what is minimised.
pub fn intersect(sights: &[Sight<'_>], least_angle: f64, against: Option<&Search>) -> Result<Intersection, ApproximateError> {
    at_least(2, sights.len(), "sights", "an intersection")?;
    if let Some(index) = sights.iter().position(|sight| !is_finite(sight)) {
        return Err(ApproximateError::NotFinite { index });
    }
    let directions: Vec<Option<Vector3<f64>>> = sights.iter().map(direction).collect();
    let all: Vec<usize> = (0..sights.len()).collect();
    let Some(against) = against.filter(|_| sights.len() > 2) else {
        if let Some(index) = directions.iter().position(Option::is_none) {
            return Err(ApproximateError::NotInCamera { index });
        }
        return finish(sights, &closest(sights, &directions, &all, least_angle)?, &all, least_angle);
    };
    let propose = |chosen: &[usize]| closest(sights, &directions, chosen, least_angle).into_iter().collect();
    let distance = |point: &Point3<f64>, index: usize| residual(&sights[index], point).map_or(f64::INFINITY, |[x, y]| x * x + y * y);
    let refine = |point: &Point3<f64>, chosen: &[usize]| fit(sights, point, chosen).map(|(point, _)| point);
    let (start, agreeing) = search(sights.len(), 2, 2, against, propose, each(distance), refine)?;
    finish(sights, &start, &agreeing, least_angle)
}

fn is_finite(sight: &Sight<'_>) -> bool {
    sight.image.is_finite() && sight.pose.centre.iter().chain(sight.pose.rotation.iter()).all(|value| value.is_finite())
}

/// The unit vector of the measured ray, object axes.
fn direction(sight: &Sight<'_>) -> Option<Vector3<f64>> {
    sight.pose.world_from_ray(sight.camera.unproject(sight.image).ok()?).try_normalize(0.0)
}

/// The point closest to the chosen rays in space: the sum of the squared distances is least.
fn closest(
    sights: &[Sight<'_>],
    directions: &[Option<Vector3<f64>>],
    chosen: &[usize],
    least_angle: f64,
) -> Result<Point3<f64>, ApproximateError> {
    let rays: Vec<_> = chosen.iter().filter_map(|&i| Some((sights[i].pose.centre, directions[i]?, i))).collect();
    let directions: Vec<_> = rays.iter().map(|ray| ray.1).collect();
    let parallel = |angle: f64| ApproximateError::Parallel { angle_deg: angle.to_degrees() };
    let angle = largest_angle(&directions);
    if angle <= ROUNDING.max(0.1 * least_angle) {
        return Err(parallel(angle));
    }
    // From one of the centres, so that large coordinates cost no digits.
    let near = rays[0].0;
    let (mut matrix, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (centre, direction, _) in &rays {
        let across = Matrix3::identity() - direction * direction.transpose();
        matrix += across;
        right += across * (centre - near);
    }
    let point = near + matrix.cholesky().ok_or_else(|| parallel(angle))?.solve(&right);
    let reach = rays.iter().map(|(centre, ..)| (centre - near).norm()).fold(0.0, f64::max);
    if reach == 0.0 {
        return Err(parallel(0.0));
    }
    match rays.iter().find(|(centre, direction, _)| (point - centre).dot(direction) <= 0.0) {
        Some(&(_, _, index)) => Err(ApproximateError::Behind { index }),
        None => Ok(point),
    }
}

fn largest_angle(directions: &[Vector3<f64>]) -> f64 {
    let others = |(i, a): (usize, &Vector3<f64>)| directions[i + 1..].iter().map(|b| a.cross(b).norm().atan2(a.dot(b))).fold(0.0, f64::max);
    directions.iter().enumerate().map(others).fold(0.0, f64::max)
}

/// Least squares in the images of the chosen sights.
fn fit(sights: &[Sight<'_>], start: &Point3<f64>, chosen: &[usize]) -> Option<(Point3<f64>, Normal<3>)> {
    let normal = |point: &Point3<f64>| {
        let mut normal = Normal::new();
        for sight in chosen.iter().map(|&i| &sights[i]) {
            let found = sight.camera.slopes(sight.pose.ray(point)).ok()?;
            let misclosure = [found.point.x - sight.image.x, found.point.y - sight.image.y];
            for (by_ray, misclosure) in found.by_ray.into_iter().zip(misclosure) {
                normal.add(&(sight.pose.rotation.transpose() * Vector3::from(by_ray)), misclosure);
            }
        }
        Some(normal)
    };
    minimise(*start, normal, |point, step: &SVector<f64, 3>| point + step)
}

fn residual(sight: &Sight<'_>, point: &Point3<f64>) -> Option<[f64; 2]> {
    let found = sight.camera.project(sight.pose.ray(point)).ok()?;
    Some([found.x - sight.image.x, found.y - sight.image.y])
}

fn finish(sights: &[Sight<'_>], start: &Point3<f64>, agreeing: &[usize], least_angle: f64) -> Result<Intersection, ApproximateError> {
    let behind = |point: &Point3<f64>| agreeing.iter().copied().find(|&i| residual(&sights[i], point).is_none());
    let (point, normal) =
        fit(sights, start, agreeing).ok_or_else(|| ApproximateError::Behind { index: behind(start).unwrap_or(agreeing[0]) })?;
    let seen: Vec<_> = agreeing.iter().filter_map(|&i| (point - sights[i].pose.centre).try_normalize(0.0)).collect();
    let angle = largest_angle(&seen);
    let parallel = ApproximateError::Parallel { angle_deg: angle.to_degrees() };
    if angle <= ROUNDING.max(least_angle) {
        return Err(parallel);
    }
    let redundancy = normal.redundancy();
    Ok(Intersection {
        point,
        cofactor: normal.cofactor().ok_or(parallel)?,
        sigma0: (normal.squares / redundancy.max(1) as f64).sqrt(),
        redundancy,
        residuals: sights.iter().map(|sight| residual(sight, &point)).collect(),
        angle,
        rejected: others(sights.len(), agreeing),
    })
}

#[cfg(test)]
mod tests;
