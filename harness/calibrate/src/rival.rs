//! A minimum that the observations do not tell from the one found.

use calibench_diagnostics::plain;
use calibench_model::camera::{Camera, CameraModel};

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

impl Rival {
    /// Whether the two differ by more than `limit_px` over the frame, or by more than can be compared.
    pub fn is_beyond(&self, limit_px: f64) -> bool {
        self.distance_px.is_none_or(|px| px > limit_px)
    }

    /// In words; `of` is whose camera it is, where there are several.
    pub fn words(&self, of: &str) -> String {
        let first = |camera: &Camera| camera.parameters().first().map_or(("", 0.0), |first| (first.name, first.value));
        let ((name, found), (_, other)) = (first(&self.found), first(&self.other));
        let apart =
            self.distance_px.map_or_else(|| "too far to compare".to_owned(), |px| format!("{} px apart (RMS over the frame)", plain(px)));
        format!(
            "another camera{of} fits as well, as far as the noise tells: {name} of {} in place of {}, {apart}; reached from {}. More images from other directions decide",
            plain(other),
            plain(found),
            self.origin
        )
    }
}
