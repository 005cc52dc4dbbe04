//! Targets of two images.

use calibench_model::PixelPoint;

/// A target of one image or of both.
pub struct Seen {
    pub target: String,
    /// Where, in the left and in the right image.
    pub at: [Option<PixelPoint>; 2],
}

impl Seen {
    /// Where it is in both images, if it is in both.
    pub fn pair(&self) -> Option<[PixelPoint; 2]> {
        Some([self.at[0]?, self.at[1]?])
    }
}
