//! A minimum that the observations do not tell from the one found.

use calibench_model::camera::Camera;

/// Another camera that fits as well, as far as noise allows to say.
#[derive(Clone, Debug, PartialEq)]
pub struct Rival {
    /// Index of the camera among those of the settings.
    pub camera: usize,
    /// The camera of the minimum that was taken, as a sample of the images gives it.
    pub found: Camera,
    /// That of the other minimum.
    pub other: Camera,
    /// Where the other was reached from, in words.
    pub origin: String,
    /// How far they are apart over the frame after the best rotation, px (RMS); `None` where they cannot be compared.
    pub distance_px: Option<f64>,
}
