//! Standard deviations that the images themselves show: from leaving some of them out.

use calibench_adjust::{Exterior, ImageObservation, Network, Options, adjust};
use calibench_model::camera::CameraModel;
use calibench_model::upper_median;
use rayon::prelude::*;

/// Groups of images at most: a standard deviation from so many is known to a sixth.
pub(crate) const GROUPS: usize = 20;
/// Images at least.
const LEAST: usize = 6;
/// Image points up to which all is adjusted so many times again.
pub(crate) const MOST: usize = 100_000;
/// Iterations at most: all starts are near their minima.
pub(crate) const NEAR: usize = 50;

/// Standard deviations of the interior orientations by the jackknife over images.
#[derive(Clone, Debug, PartialEq)]
pub struct Resampled {
    /// Groups of images, each of which was left out once.
    pub groups: usize,
    /// Of each unknown parameter, in its unit, in the order of [`calibench_adjust::Covariances::parameters`].
    pub sigmas: Vec<f64>,
    /// Of each group: the unknown parameters without it, in the same order.
    pub without: Vec<Vec<f64>>,
}

impl Resampled {
    /// From the unknown parameters as they are when one group after the other is left out: their standard deviations are the jackknife's.
    ///
    /// Source: Efron & Tibshirani 1993, chapter 11.
    pub(crate) fn from_groups(without: Vec<Vec<f64>>) -> Self {
        let groups = without.len() as f64;
        let sigma = |k: usize| {
            let mean = without.iter().map(|values| values[k]).sum::<f64>() / groups;
            let squares: f64 = without.iter().map(|values| (values[k] - mean).powi(2)).sum();
            (squares * (groups - 1.0) / groups).sqrt()
        };
        let sigmas = (0..without.first().map_or(0, Vec::len)).map(sigma).collect();
        Self { groups: without.len(), sigmas, without }
    }

    /// The median of their ratio to `formal` standard deviations, a number: 1 if residuals are as independent as the adjustment takes them.
    pub fn ratio(&self, formal: impl IntoIterator<Item = f64>) -> Option<f64> {
        upper_median(self.sigmas.iter().zip(formal).filter(|(_, formal)| *formal > 0.0).map(|(own, formal)| own / formal))
    }

    /// Of a network that starts at its minimum, and of the unknown parameters `names` (camera, name).
    ///
    /// # Errors
    /// Why there are none, in words.
    pub(crate) fn of(network: &Network, options: &Options, names: &[(usize, &'static str)]) -> Result<Self, String> {
        let images = network.images.len();
        if images < LEAST {
            return Err(format!("{images} images; it takes {LEAST}"));
        }
        if network.observations.len() > MOST {
            return Err(format!("more than {MOST} image points"));
        }
        let groups = images.min(GROUPS);
        let found = (0..groups).into_par_iter().map(|group| without(network, options, names, (group, groups))).collect::<Option<Vec<_>>>();
        let found = found.ok_or("without some of the images the camera is not determined")?;
        Ok(Self::from_groups(found))
    }
}

/// The unknown parameters without one of `groups` of images; `None` if they are not determined.
fn without(network: &Network, options: &Options, names: &[(usize, &'static str)], (group, groups): (usize, usize)) -> Option<Vec<f64>> {
    let (network, left_out) = part(network, &options.left_out, |image| image % groups != group);
    let options = Options { left_out, most_iterations: NEAR, ..options.clone() };
    let solution = adjust(&network, &options).ok()?;
    let value = |(camera, name): &(usize, &'static str)| {
        solution.cameras()[*camera].parameters().iter().find(|parameter| parameter.name == *name).map(|parameter| parameter.value)
    };
    names.iter().map(value).collect()
}

/// The network of some images, and which of its observations are left out.
fn part(whole: &Network, left_out: &[usize], keeps: impl Fn(usize) -> bool) -> (Network, Vec<usize>) {
    let mut place = vec![None; whole.images.len()];
    let mut images: Vec<Exterior> = Vec::new();
    for (index, image) in whole.images.iter().enumerate().filter(|(index, _)| keeps(*index)) {
        place[index] = Some(images.len());
        images.push(image.clone());
    }
    let rejected: std::collections::HashSet<usize> = left_out.iter().copied().collect();
    let (mut observations, mut left_out) = (Vec::new(), Vec::new());
    for (index, o) in whole.observations.iter().enumerate() {
        let Some(image) = place[o.image] else { continue };
        if rejected.contains(&index) {
            left_out.push(observations.len());
        }
        observations.push(ImageObservation { image, ..*o });
    }
    let (cameras, points, distances) = (whole.cameras.clone(), whole.points.clone(), whole.distances.clone());
    let (datum, surfaces, per_image) = (whole.datum.clone(), whole.surfaces.clone(), whole.per_image.clone());
    (Network { cameras, images, points, observations, distances, datum, surfaces, per_image }, left_out)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a mean it is what a sample says of its mean: `s / sqrt(n)`.
    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_deviation() {
        let sample = [1.0, 2.0, 4.0, 7.0, 11.0];
        let sum: f64 = sample.iter().sum();
        let without: Vec<Vec<f64>> = sample.iter().map(|left_out| vec![(sum - left_out) / 4.0, 3.0]).collect();
        let Resampled { groups, sigmas, .. } = Resampled::from_groups(without);
        assert_eq!(groups, 5);
        let squares: f64 = sample.iter().map(|value| (value - sum / 5.0).powi(2)).sum();
        assert!((sigmas[0] - (squares / 4.0 / 5.0).sqrt()).abs() < 1e-12, "{sigmas:?}");
        assert_eq!(sigmas[1], 0.0);
    }
}
