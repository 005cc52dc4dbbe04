//! Object points from oriented images.

use std::collections::HashMap;
use std::io;

use calibench_adjust::approximate::{ApproximateError, Intersection, Search, Sight as Ray, Tolerance, intersect};
use calibench_exchange::POINT_QUALITY_COLUMNS;
use calibench_files::{Row, write_rows};
use calibench_model::camera::Camera;
use calibench_model::{Pose, StationRow};
use rayon::prelude::*;
use statrs::distribution::{Binomial, DiscreteCDF};

use super::precision::{MISFIT, Residuals, StatedPrecision};
use crate::doubt::ALPHA;
use crate::{CalibrationError, Survey};

const COLUMNS: [&str; 7] = ["target", "X", "Y", "Z", "sX", "sY", "sZ"];

/// Targets whose failure is kept one by one.
pub const TOLD: usize = 100;
/// Targets that are intersected before their rows are kept.
const BATCH: usize = 1 << 14;

/// The object points of a survey.
#[derive(Clone, Debug, Default)]
pub struct ObjectPoints {
    found: Vec<Found>,
    /// How many targets have no point.
    pub failed: usize,
    /// The first [`TOLD`] of them, by index, and why.
    pub first_failures: Vec<(usize, ApproximateError)>,
    /// The standard deviation of an image coordinate that the points' own come from, px: stated, or that of all residuals together.
    pub sigma_px: Option<f64>,
}

/// A point, small: there may be millions.
#[derive(Clone, Debug)]
struct Found {
    target: u32,
    images: u32,
    point: [f64; 3],
    /// Roots of the cofactors, object units for 1 px.
    spread: [f64; 3],
    angle: f64,
    sigma0: f64,
    redundancy: u32,
    /// Images whose sights did not fit.
    rejected: Vec<u32>,
}

impl ObjectPoints {
    /// Intersects every target of `survey`. Of each image its camera, and its pose if it has one; rays that meet at less than `least_angle` (rad) are
    /// parallel. Without a stated standard deviation of image coordinates, that of the residuals of all targets together counts: a target alone has too few.
    pub fn of(survey: &Survey, cameras: &[Camera], poses: &[Option<Pose>], least_angle: f64, stated: StatedPrecision) -> Self {
        let StatedPrecision { tolerance_px, sigma_px } = stated;
        let against = tolerance_px.map(|px| Search { seed: 1, tolerance: Tolerance::Pixels(px) });
        let one = |target: usize| {
            let seen = survey.of_target(target).map(|index| survey.sight(index));
            let oriented = seen.filter_map(|sight| poses[sight.image].as_ref().map(|pose| (sight, pose)));
            let images: Vec<usize> = oriented.clone().map(|(sight, _)| sight.image).collect();
            let rays: Vec<Ray<'_>> =
                oriented.map(|(sight, pose)| Ray { camera: &cameras[sight.image], pose, image: sight.position }).collect();
            intersect(&rays, least_angle, against.as_ref()).map(|found| Found::of(target, &images, &found))
        };
        let mut all = Self::default();
        for first in (0..survey.targets()).step_by(BATCH) {
            let batch: Vec<_> = (first..(first + BATCH).min(survey.targets())).into_par_iter().map(one).collect();
            for (target, found) in (first..).zip(batch) {
                match found {
                    Ok(found) => all.found.push(found),
                    Err(why) => {
                        all.failed += 1;
                        if all.first_failures.len() < TOLD {
                            all.first_failures.push((target, why));
                        }
                    }
                }
            }
        }
        all.sigma_px = sigma_px.or_else(|| all.pooled());
        all
    }

    /// The standard deviation of an image coordinate from the residuals of all targets, px; `None` without redundancy.
    pub fn pooled(&self) -> Option<f64> {
        self.residuals().sigma0()
    }

    /// Whether residuals say of image coordinates what `sigma_px` does: chi squared, both sides, at a thousandth.
    pub fn agrees_with(&self, sigma_px: f64) -> bool {
        self.residuals().agree_with(sigma_px)
    }

    fn residuals(&self) -> Residuals {
        Residuals::pooled(self.found.iter().map(Found::residuals))
    }

    /// Image points that did not fit and were left out.
    pub fn left_out(&self) -> usize {
        self.found.iter().map(|found| found.rejected.len()).sum()
    }

    /// Targets whose residuals are larger than the common standard deviation lets expect once in a thousand.
    pub fn misfits(&self) -> usize {
        self.found.iter().filter(|found| found.misfits(self.sigma_px)).count()
    }

    /// As many do not fit as chance makes once in 10,000.
    pub fn misfits_are_no_chance(&self) -> bool {
        let misfits = self.misfits() as u64;
        let checked = self.found.iter().filter(|found| found.redundancy > 0).count() as u64;
        misfits > 0 && Binomial::new(MISFIT, checked).is_ok_and(|chance| chance.sf(misfits - 1) < ALPHA)
    }

    /// How many points there are.
    pub fn len(&self) -> usize {
        self.found.len()
    }

    /// No target has a point.
    pub fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// Writes a control file: coordinates and standard deviations in object units, angles in degrees; sigma0, of the target's own residuals, in px.
    ///
    /// # Errors
    /// What `file` returns.
    pub fn write(&self, survey: &Survey, file: impl io::Write) -> io::Result<()> {
        let columns = [&COLUMNS[..], &POINT_QUALITY_COLUMNS].concat();
        write_rows(file, &columns, self.found.len(), |index, row| self.found[index].write(survey, self.sigma_px, row))
    }
}

/// The pose of each image of `survey` by its name, or else by its name without ending: `render` names stations, photographs have an ending.
///
/// # Errors
/// [`CalibrationError::NoStation`] where no image has one.
pub fn poses_of(survey: &Survey, stations: &[StationRow]) -> Result<Vec<Option<Pose>>, CalibrationError> {
    let stem = |name: &str| name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_owned();
    let named: HashMap<&str, &StationRow> = stations.iter().map(|row| (row.image.as_str(), row)).collect();
    let of = |image: &String| named.get(image.as_str()).or_else(|| named.get(stem(image).as_str())).map(|row| row.pose);
    let poses: Vec<Option<Pose>> = survey.images.iter().map(of).collect();
    if poses.iter().all(Option::is_none) {
        let first = |names: Option<&String>| names.cloned().unwrap_or_default();
        let (image, station) = (first(survey.images.first()), first(stations.first().map(|row| &row.image)));
        return Err(CalibrationError::NoStation { image, station });
    }
    Ok(poses)
}

impl Found {
    fn of(target: usize, images: &[usize], found: &Intersection) -> Self {
        let spread = |i: usize| found.cofactor[(i, i)].sqrt();
        Self {
            target: target as u32,
            images: images.len() as u32,
            point: found.point.into(),
            spread: [spread(0), spread(1), spread(2)],
            angle: found.angle,
            sigma0: found.sigma0,
            redundancy: found.redundancy as u32,
            rejected: found.rejected.iter().map(|&i| images[i] as u32).collect(),
        }
    }

    fn residuals(&self) -> Residuals {
        Residuals::new(self.sigma0, f64::from(self.redundancy))
    }

    /// Whether its residuals are too large for a standard deviation of image coordinates: chi squared at a thousandth.
    fn misfits(&self, sigma_px: Option<f64>) -> bool {
        sigma_px.is_some_and(|sigma| self.residuals().exceed(sigma, MISFIT))
    }

    /// A point with standard deviations from the common one of image coordinates; where there is none, without.
    fn write(&self, survey: &Survey, sigma_px: Option<f64>, row: &mut Row) {
        row.text(survey.target(self.target as usize));
        self.point.iter().for_each(|coordinate| row.number(*coordinate));
        for spread in self.spread {
            match sigma_px {
                Some(sigma) => row.number(sigma * spread),
                None => row.text(""),
            }
        }
        row.whole(self.images as usize);
        row.number(self.angle.to_degrees());
        row.number(self.sigma0);
        row.whole(self.redundancy as usize);
        let rejected: Vec<&str> = self.rejected.iter().map(|&image| survey.images[image as usize].as_str()).collect();
        row.text(&rejected.join(" "));
        row.text(match (self.redundancy > 0, self.misfits(sigma_px)) {
            (false, _) => "not checked",
            (true, true) => "does not fit",
            (true, false) => "",
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a thousand that are checked one misfits by chance; Poisson's distribution of mean 1 has 5.9e-4 from six on and 8.3e-5 from seven on.
    #[test]
    fn six_misfits_of_a_thousand_may_be_chance_and_seven_not() {
        let found = |sigma0: f64, redundancy: u32| Found {
            target: 0,
            images: 2,
            point: [0.0; 3],
            spread: [1.0; 3],
            angle: 1.0,
            sigma0,
            redundancy,
            rejected: Vec::new(),
        };
        // Ten thousand that nothing checks are no trials.
        let of = |misfits: usize| {
            let checked = (0..1000).map(|place| found(if place < misfits { 5.0 } else { 1.0 }, 1));
            let found: Vec<Found> = checked.chain((0..10_000).map(|_| found(0.0, 0))).collect();
            ObjectPoints { found, sigma_px: Some(1.0), ..ObjectPoints::default() }
        };
        for (misfits, no_chance) in [(0, false), (6, false), (7, true)] {
            assert_eq!((of(misfits).misfits(), of(misfits).misfits_are_no_chance()), (misfits, no_chance));
        }
    }
}
