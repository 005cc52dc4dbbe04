//! What each image has for itself.

use crate::Calibration;

/// A number of an image's own, adjusted.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnNumber {
    /// Name of the image.
    pub image: String,
    /// Index of its camera.
    pub camera: usize,
    /// The number, as it was asked for.
    pub name: String,
    /// The first parameter that it changes, by its index: both have one unit.
    pub parameter: usize,
    /// By how much the image's camera differs from that of all, in that unit.
    pub value: f64,
    /// Its standard deviation, in that unit.
    pub sigma: f64,
    /// How far it was expected to be off zero, in that unit.
    pub prior_sigma: f64,
    /// How much of it the image points say, from 0 to 1.
    pub share: f64,
}

impl Calibration<'_> {
    /// What each image has for itself, image by image; empty where nothing was asked for.
    pub fn own_numbers(&self) -> Vec<OwnNumber> {
        let (network, scale) = (&self.prepared.network, self.covariances.variance_factor.sqrt());
        if network.per_image.is_empty() {
            return Vec::new();
        }
        let of = |number: calibench_adjust::OwnNumber| {
            let own = &network.per_image[number.of];
            OwnNumber {
                image: network.images[number.image].name.clone(),
                camera: own.camera,
                name: own.name.clone(),
                parameter: own.along.first().map_or(0, |(parameter, _)| *parameter),
                value: number.value,
                sigma: number.sigma,
                prior_sigma: own.sigma * scale,
                share: number.share,
            }
        };
        self.solution.own_numbers(self.variance()).unwrap_or_default().into_iter().map(of).collect()
    }
}
