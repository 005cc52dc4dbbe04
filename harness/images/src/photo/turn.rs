//! The orientation that a photograph asks for.

use std::fmt;

use calibench_model::Image;
use image::DynamicImage;
use image::metadata::Orientation;

/// How pixels are turned so that a photograph stands upright; never "not at all".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turn(Orientation);

impl Turn {
    /// `None` for an image that stands upright.
    pub(crate) fn of(orientation: Orientation) -> Option<Self> {
        (orientation != Orientation::NoTransforms).then_some(Self(orientation))
    }

    /// The value of the EXIF tag: 2 to 8.
    pub fn exif(self) -> u8 {
        self.0.to_exif()
    }

    /// Whether columns become rows.
    pub(super) const fn is_on_its_side(self) -> bool {
        matches!(self.0, Orientation::Rotate90FlipH | Orientation::Rotate90 | Orientation::Rotate270FlipH | Orientation::Rotate270)
    }

    /// The pixels of a file turned to be upright.
    pub(crate) fn apply_to_levels(self, image: &mut DynamicImage) {
        image.apply_orientation(self.0);
    }

    /// The image turned: of the file's pixels the image as it is meant to be seen.
    pub(super) fn apply(self, image: &Image) -> Image<'static> {
        let (width, height) = (image.width(), image.height());
        let (right, bottom) = (width.saturating_sub(1), height.saturating_sub(1));
        let at = |x: usize, y: usize| image.row(y)[x];
        let upright = |of: &dyn Fn(usize, usize) -> f32| Image::from_fn(width, height, of);
        let on_its_side = |of: &dyn Fn(usize, usize) -> f32| Image::from_fn(height, width, of);
        match self.0 {
            Orientation::NoTransforms => upright(&at),
            Orientation::FlipHorizontal => upright(&|x, y| at(right - x, y)),
            Orientation::Rotate180 => upright(&|x, y| at(right - x, bottom - y)),
            Orientation::FlipVertical => upright(&|x, y| at(x, bottom - y)),
            Orientation::Rotate90FlipH => on_its_side(&|x, y| at(y, x)),
            Orientation::Rotate90 => on_its_side(&|x, y| at(y, bottom - x)),
            Orientation::Rotate270FlipH => on_its_side(&|x, y| at(right - y, bottom - x)),
            Orientation::Rotate270 => on_its_side(&|x, y| at(right - y, x)),
        }
    }
}

impl fmt::Display for Turn {
    /// As in `EXIF orientation 6, turned by 90 degrees clockwise`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let how = match self.0 {
            Orientation::NoTransforms => "upright",
            Orientation::FlipHorizontal => "mirrored left to right",
            Orientation::Rotate180 => "turned by 180 degrees",
            Orientation::FlipVertical => "mirrored top to bottom",
            Orientation::Rotate90FlipH => "turned by 90 degrees clockwise and mirrored left to right",
            Orientation::Rotate90 => "turned by 90 degrees clockwise",
            Orientation::Rotate270FlipH => "turned by 90 degrees counter-clockwise and mirrored left to right",
            Orientation::Rotate270 => "turned by 90 degrees counter-clockwise",
        };
        write!(f, "EXIF orientation {}, {how}", self.exif())
    }
}
