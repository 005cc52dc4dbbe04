//! The same camera in other images: of a part of them, resampled, or turned. What becomes of a model's numbers stands in the model's file.

use super::{ImageSize, Ray};
use crate::{CornerPoint, PixelPoint};

/// A part of images, resampled: `u' = scale (u - offset)`, counted from the outer corner of the first pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resampling {
    /// Size of the images before.
    pub from: ImageSize,
    /// Columns and rows that are cut off before the first, px of the images before.
    pub offset: [f64; 2],
    /// New pixels for an old one, along rows and along columns.
    pub scale: [f64; 2],
    /// Size of the new images.
    pub size: ImageSize,
}

impl Resampling {
    /// Images as they are.
    pub const fn none(size: ImageSize) -> Self {
        Self { from: size, offset: [0.0; 2], scale: [1.0; 2], size }
    }

    /// Where a place of the images before is in the new ones.
    pub fn point(&self, at: PixelPoint) -> PixelPoint {
        let (CornerPoint { x, y }, [left, top], [along, down]) = (at.to_corner(), self.offset, self.scale);
        CornerPoint { x: along * (x - left), y: down * (y - top) }.to_pixel()
    }

    /// Whether columns and rows are scaled alike.
    pub fn is_isotropic(&self) -> bool {
        self.scale[0] == self.scale[1]
    }

    /// Two lengths along x and along y, px, in new pixels.
    pub(super) fn lengths(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.scale[0] * x, self.scale[1] * y]
    }
}

/// By how much images are turned, clockwise as they are looked at; the camera's axes turn with them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// 90 degrees: the left side comes up.
    Quarter,
    /// 180 degrees.
    Half,
    /// 270 degrees: the right side comes up.
    ThreeQuarters,
}

impl Turn {
    /// All turns.
    pub const ALL: [Self; 3] = [Self::Quarter, Self::Half, Self::ThreeQuarters];

    /// Degrees, clockwise.
    pub const fn degrees(self) -> u16 {
        match self {
            Self::Quarter => 90,
            Self::Half => 180,
            Self::ThreeQuarters => 270,
        }
    }

    /// Whether columns become rows.
    pub const fn swaps_axes(self) -> bool {
        !matches!(self, Self::Half)
    }

    /// The size of turned images.
    pub const fn size(self, ImageSize { width, height }: ImageSize) -> ImageSize {
        if self.swaps_axes() { ImageSize { width: height, height: width } } else { ImageSize { width, height } }
    }

    /// Where a place of images of `size` is in the turned ones.
    pub fn point(self, size: ImageSize, at: PixelPoint) -> PixelPoint {
        let (CornerPoint { x, y }, [width, height]) = (at.to_corner(), [size.width, size.height].map(f64::from));
        let turned = match self {
            Self::Quarter => CornerPoint { x: height - y, y: x },
            Self::Half => CornerPoint { x: width - x, y: height - y },
            Self::ThreeQuarters => CornerPoint { x: y, y: width - x },
        };
        turned.to_pixel()
    }

    /// A vector in the image, x right and y **down**, in the turned axes.
    pub fn vector(self, [x, y]: [f64; 2]) -> [f64; 2] {
        // No zero becomes a negative one.
        match self {
            Self::Quarter => [0.0 - y, x],
            Self::Half => [0.0 - x, 0.0 - y],
            Self::ThreeQuarters => [y, 0.0 - x],
        }
    }

    /// A vector in the image, x right and y **up**, in the turned axes.
    pub fn vector_up(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.vector([x, -y]);
        [x, 0.0 - y]
    }

    /// A ray in the turned camera's axes.
    pub fn ray(self, ray: Ray) -> Ray {
        let [x, y] = self.vector_up([ray.x, ray.y]);
        Ray { x, y, z: ray.z }
    }

    /// The rotation from a camera's axes (x right, y down, z forward) to those of the turned one, row by row.
    pub fn rotation(self) -> [[f64; 3]; 3] {
        let (right, down) = (self.vector([1.0, 0.0]), self.vector([0.0, 1.0]));
        [[right[0], down[0], 0.0], [right[1], down[1], 0.0], [0.0, 0.0, 1.0]]
    }

    /// What belongs to x and to y, as two focal lengths, in the turned axes.
    pub(super) fn along(self, [x, y]: [f64; 2]) -> [f64; 2] {
        if self.swaps_axes() { [y, x] } else { [x, y] }
    }
}

/// A camera model whose images can be resampled and turned: the same camera, exactly. [`super::conformance`] checks every model.
pub trait Reframe: Sized {
    /// Whether the model holds columns and rows that are scaled differently: it has two focal lengths.
    fn has_two_scales(&self) -> bool {
        true
    }

    /// The camera of resampled images. Of a model with one focal length it is none where the scales differ.
    #[must_use]
    fn resampled(&self, by: &Resampling) -> Self;

    /// The parameter for which the model has no place in images turned so, if it is not zero.
    fn without_place(&self, turn: Turn) -> Option<&'static str> {
        let _ = turn;
        None
    }

    /// The camera of turned images, its axes turned with them. Of a camera that is [`Self::without_place`] it is none.
    #[must_use]
    fn turned(&self, turn: Turn) -> Self;
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: ImageSize = ImageSize { width: 6, height: 4 };

    #[test]
    fn pixels_are_counted_from_their_outer_corners() {
        let half = Resampling { scale: [0.5; 2], size: ImageSize { width: 3, height: 2 }, ..Resampling::none(SIZE) };
        // The centre of four pixels is the centre of the one that they become.
        assert_eq!(half.point(PixelPoint::new(0.5, 2.5)), PixelPoint::new(0.0, 1.0));
        let part = Resampling { offset: [2.0, 1.0], ..Resampling::none(SIZE) };
        assert_eq!(part.point(PixelPoint::new(2.0, 1.0)), PixelPoint::new(0.0, 0.0));
        assert!(half.is_isotropic() && !Resampling { scale: [0.5, 1.0], ..half }.is_isotropic());
    }

    #[test]
    fn a_turn_takes_pixels_to_pixels() {
        let corners = |turn: Turn| [(0.0, 0.0), (5.0, 0.0)].map(|(x, y)| turn.point(SIZE, PixelPoint::new(x, y)));
        let at = |x, y| PixelPoint::new(x, y);
        // Top left and top right.
        assert_eq!(corners(Turn::Quarter), [at(3.0, 0.0), at(3.0, 5.0)]);
        assert_eq!(corners(Turn::Half), [at(5.0, 3.0), at(0.0, 3.0)]);
        assert_eq!(corners(Turn::ThreeQuarters), [at(0.0, 5.0), at(0.0, 0.0)]);
        for turn in Turn::ALL {
            // What lies to the right of another place lies where the turned vector points.
            let [from, to] = [at(1.0, 1.0), at(2.0, 1.0)].map(|place| turn.point(SIZE, place));
            assert_eq!(turn.vector([1.0, 0.0]), [to.x - from.x, to.y - from.y], "{turn:?}");
            let [x, y] = turn.vector_up([0.0, 1.0]);
            assert_eq!(turn.vector([0.0, -1.0]), [x, -y], "{turn:?}");
        }
        assert_eq!(Turn::Quarter.rotation()[0], [0.0, -1.0, 0.0]);
    }
}
