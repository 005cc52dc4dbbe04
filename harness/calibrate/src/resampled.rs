//! Standard deviations that the images themselves show: from leaving some of them out.

use calibench_adjust::{Exterior, ImageObservation, Interior, Network, Options, Status, Surface, adjust};
use calibench_model::camera::CameraModel;
use rayon::prelude::*;

use crate::Calibration;
use crate::calibration::ITERATIONS;

/// Groups of images at most: a standard deviation from so many is known to a sixth.
const GROUPS: usize = 20;
/// Images at least.
const LEAST: usize = 6;
/// Image points up to which all is adjusted so many times again.
const MOST: usize = 100_000;

/// Standard deviations of the interior orientations by the jackknife over images.
#[derive(Clone, Debug, PartialEq)]
pub struct Resampled {
    /// Groups of images, each of which was left out once.
    pub groups: usize,
    /// Of each unknown parameter, in its unit, in the order of [`calibench_adjust::Covariances::parameters`].
    pub sigmas: Vec<f64>,
}

impl Resampled {
    /// The median of their ratio to `formal` standard deviations, a number: 1 if residuals are as independent as the adjustment takes them.
    pub fn ratio(&self, formal: impl IntoIterator<Item = f64>) -> Option<f64> {
        let mut ratios: Vec<f64> =
            self.sigmas.iter().zip(formal).filter(|(_, formal)| *formal > 0.0).map(|(own, formal)| own / formal).collect();
        ratios.sort_by(f64::total_cmp);
        ratios.get(ratios.len() / 2).copied()
    }
}

impl Calibration<'_> {
    /// Adjusts once more without each of some groups of images, and keeps the scatter in [`Self::resampled`]: `Err` with the reason where that cannot be.
    /// Systematic errors that an image shares with itself alone, as of its own focus or of corners that lie off together, show here and not in the
    /// covariances.
    ///
    /// Source: Efron & Tibshirani 1993, chapter 11.
    pub fn resample(&mut self) {
        self.resampled = Some(self.without_groups());
    }

    fn without_groups(&self) -> Result<Resampled, String> {
        let network = &self.prepared.network;
        let images = network.images.len();
        if images < LEAST {
            return Err(format!("{images} images; it takes {LEAST}"));
        }
        if network.observations.len() > MOST {
            return Err(format!("more than {MOST} image points"));
        }
        if network.points.iter().any(|point| point.coordinates != [Status::Fixed; 3]) {
            return Err("object points are unknown too".into());
        }
        let groups = images.min(GROUPS);
        let found = (0..groups).into_par_iter().map(|group| self.without(group, groups)).collect::<Option<Vec<_>>>();
        let found = found.ok_or("without some of the images the camera is not determined")?;
        let sigma = |k: usize| {
            let mean = found.iter().map(|values| values[k]).sum::<f64>() / groups as f64;
            let squares: f64 = found.iter().map(|values| (values[k] - mean).powi(2)).sum();
            (squares * (groups as f64 - 1.0) / groups as f64).sqrt()
        };
        Ok(Resampled { groups, sigmas: (0..self.covariances.parameters.len()).map(sigma).collect() })
    }

    /// The unknown parameters without one of `groups` of images; `None` if they are not determined.
    fn without(&self, group: usize, groups: usize) -> Option<Vec<f64>> {
        let (network, left_out) = self.part(|image| image % groups != group);
        let options = Options { huber: self.prepared.settings.huber, most_iterations: ITERATIONS, left_out };
        let solution = adjust(&network, &options).ok()?;
        let value = |(camera, name): &(usize, &'static str)| {
            solution.cameras()[*camera].parameters().iter().find(|parameter| parameter.name == *name).map(|parameter| parameter.value)
        };
        self.covariances.parameters.iter().map(value).collect()
    }

    /// The network of some images, from where the adjustment ended, and which of its observations were rejected.
    fn part(&self, keeps: impl Fn(usize) -> bool) -> (Network, Vec<usize>) {
        let (whole, solution) = (&self.prepared.network, &self.solution);
        let mut place = vec![None; whole.images.len()];
        let mut images: Vec<Exterior> = Vec::new();
        for (index, (image, pose)) in whole.images.iter().zip(solution.poses()).enumerate().filter(|(index, _)| keeps(*index)) {
            place[index] = Some(images.len());
            images.push(Exterior { pose: *pose, ..image.clone() });
        }
        let rejected: std::collections::HashSet<usize> =
            self.found.iter().filter(|found| found.left_out).map(|found| found.observation).collect();
        let (mut observations, mut left_out) = (Vec::new(), Vec::new());
        for (index, o) in whole.observations.iter().enumerate() {
            let Some(image) = place[o.image] else { continue };
            if rejected.contains(&index) {
                left_out.push(observations.len());
            }
            observations.push(ImageObservation { image, ..*o });
        }
        let cameras =
            whole.cameras.iter().zip(solution.cameras()).map(|(interior, camera)| Interior { camera: *camera, ..interior.clone() });
        let surfaces =
            whole.surfaces.iter().zip(solution.surfaces()).map(|(surface, coefficients)| Surface { coefficients, ..surface.clone() });
        let network = Network {
            cameras: cameras.collect(),
            images,
            points: whole.points.clone(),
            observations,
            datum: whole.datum.clone(),
            surfaces: surfaces.collect(),
        };
        (network, left_out)
    }
}
