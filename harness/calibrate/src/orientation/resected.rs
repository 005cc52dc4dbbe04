//! Exterior orientations, one image at a time.

use std::io;

use calibench_adjust::approximate::{ApproximateError, Resection, Search, Tolerance, resect};
use calibench_exchange::{POSE_COLUMNS, POSE_SIGMA_COLUMNS, station_numbers};
use calibench_files::write_table;
use calibench_model::camera::{Camera, CameraModel};
use rayon::prelude::*;

use super::misfit::{Misfit, ROUNDING};
use super::precision::{Residuals, StatedPrecision};
use crate::placed::is_outside;
use crate::{Survey, control_of};

/// A second minimum whose sum of squares is less than this many times the first one's makes a pose doubtful.
const RIVAL: f64 = 2.0;

const FURTHER_COLUMNS: [&str; 6] = ["points", "sigma0_px", "redundancy", "rejected", "another", "note"];

/// The exterior orientation of an image of a survey.
#[derive(Clone, Debug)]
pub struct ImageOrientation {
    /// Index of the image.
    pub image: usize,
    /// How many control points are measured in it.
    pub points: usize,
    /// The pose and its cofactors.
    pub found: Resection,
    /// How many of them lie outside of the image.
    pub outside: usize,
    /// Indices of the targets whose points were left out.
    pub rejected: Vec<usize>,
    /// Of those that were not left out, the ones that do not fit.
    pub misfit: Option<Misfit>,
}

/// The exterior orientations of a survey's images.
#[derive(Clone, Debug, Default)]
pub struct Orientations {
    /// Of the images that have one, in their order.
    pub found: Vec<ImageOrientation>,
    /// Indices of the others, and why they have none.
    pub failed: Vec<(usize, ApproximateError)>,
    /// The standard deviation of an image coordinate that was stated, px.
    pub sigma_px: Option<f64>,
}

/// Resects every image of `survey` from its control points; `cameras` holds that of each image.
pub fn resect_images(survey: &Survey, cameras: &[Camera], stated: StatedPrecision) -> Orientations {
    let StatedPrecision { tolerance_px, sigma_px } = stated;
    let known: Vec<_> = (0..survey.targets()).map(|target| survey.known(target)).collect();
    let against = tolerance_px.map(|px| Search { seed: 1, tolerance: Tolerance::Pixels(px) });
    let one = |image: usize| {
        let control = control_of(survey, &known, image);
        let found = resect(&cameras[image], &control, against.as_ref()).map_err(|error| (image, error))?;
        let targets: Vec<usize> =
            survey.of_image(image).map(|sight| survey.sight(sight).target).filter(|&target| known[target].is_some()).collect();
        let kept: Vec<usize> = (0..control.len()).filter(|place| found.rejected.binary_search(place).is_err()).collect();
        let of = |places: &[usize]| places.iter().map(|&place| targets[place]).collect::<Vec<usize>>();
        let controls: Vec<_> = kept.iter().map(|&place| control[place]).collect();
        let misfit = Misfit::of(&cameras[image], &controls, &of(&kept), &found);
        let outside = control.iter().filter(|point| is_outside(cameras[image].size(), point.image)).count();
        Ok(ImageOrientation { image, points: control.len(), outside, rejected: of(&found.rejected), found, misfit })
    };
    let (mut all, images) = (Orientations { sigma_px, ..Orientations::default() }, 0..survey.images.len());
    for result in images.into_par_iter().map(one).collect::<Vec<_>>() {
        match result {
            Ok(found) => all.found.push(found),
            Err(failed) => all.failed.push(failed),
        }
    }
    all
}

impl Orientations {
    /// The standard deviation of an image coordinate from the residuals of all images, px; `None` without redundancy.
    pub fn pooled(&self) -> Option<f64> {
        self.residuals().sigma0()
    }

    /// Whether residuals say of image coordinates what was stated, if anything was: chi squared, both sides, at a thousandth.
    pub fn agree_with_stated(&self) -> bool {
        self.sigma_px.is_none_or(|sigma| self.residuals().agree_with(sigma))
    }

    fn residuals(&self) -> Residuals {
        Residuals::pooled(self.found.iter().map(ImageOrientation::residuals))
    }

    /// The standard deviation of an image coordinate that half of the images do not exceed, px.
    pub(super) fn middle(&self) -> Option<f64> {
        let mut each: Vec<f64> = self.found.iter().filter_map(|one| one.residuals().sigma0()).collect();
        each.sort_by(f64::total_cmp);
        each.get(each.len().checked_sub(1)? / 2).copied().filter(|sigma0| *sigma0 > ROUNDING)
    }

    /// Writes a station file: poses in object units and degrees with standard deviations, sigma0 in px, and as a note what is in doubt ([`Self::doubts`]).
    ///
    /// # Errors
    /// What `file` returns.
    pub fn write(&self, survey: &Survey, doubts: &[Vec<String>], file: impl io::Write) -> io::Result<()> {
        let columns = [&["image"], &POSE_COLUMNS[..], &POSE_SIGMA_COLUMNS, &FURTHER_COLUMNS].concat();
        write_table(file, &columns, self.found.iter().zip(doubts).map(|(row, doubts)| row.cells(survey, doubts)))
    }
}

impl ImageOrientation {
    /// Standard deviations from the residuals: of X0, Y0, Z0 in object units, then of a small rotation about the camera's x, y and z axes in rad.
    pub fn sigmas(&self) -> [f64; 6] {
        [3, 4, 5, 0, 1, 2].map(|i| self.found.sigma0 * self.found.cofactor[(i, i)].sqrt())
    }

    /// How close another minimum comes: the ratio of its sum of squared residuals to this one's.
    pub fn rival(&self) -> Option<f64> {
        self.found.rival.map(|rival| rival.squares / self.residuals().squares.max(f64::MIN_POSITIVE))
    }

    /// Another pose fits nearly as well.
    pub fn has_rival(&self) -> bool {
        self.rival().is_some_and(|ratio| ratio < RIVAL)
    }

    pub(super) fn residuals(&self) -> Residuals {
        Residuals::new(self.found.sigma0, self.found.redundancy as f64)
    }

    fn cells(&self, survey: &Survey, doubts: &[String]) -> Vec<String> {
        let [sx, sy, sz, turns @ ..] = self.sigmas();
        let numbers = station_numbers(&self.found.pose).into_iter().chain([sx, sy, sz]).chain(turns.map(f64::to_degrees));
        let mut row = vec![survey.images[self.image].clone()];
        row.extend(numbers.map(|number| number.to_string()));
        let rejected: Vec<&str> = self.rejected.iter().map(|&target| survey.target(target)).collect();
        row.extend([self.points.to_string(), self.found.sigma0.to_string(), self.found.redundancy.to_string(), rejected.join(" ")]);
        row.push(self.rival().map_or(String::new(), |ratio| ratio.to_string()));
        row.push(doubts.join("; "));
        row
    }
}
