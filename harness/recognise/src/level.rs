//! The image as it is looked at: as it is, or smaller.

use calibench_model::{CornerPoint, Image, PixelPoint};

/// The longer side of the smallest image that is looked at first, px at most.
const FIRST: usize = 640;
/// The longer side beyond which no more detail is looked at, px.
const LAST: usize = 2600;

/// An image some times smaller.
#[derive(Clone, Debug)]
pub(crate) struct Level<'a> {
    pub image: Image<'a>,
    pub factor: usize,
}

impl<'a> Level<'a> {
    pub fn of(image: &'a Image, factor: usize) -> Self {
        let image = if factor == 1 { image.lent() } else { image.reduced(factor) };
        Self { image, factor }
    }

    pub fn size(&self) -> [usize; 2] {
        [self.image.width(), self.image.height()]
    }

    /// A point of the smaller image in the image that was given.
    pub fn original(&self, [x, y]: [f64; 2]) -> PixelPoint {
        let corner = PixelPoint::new(x, y).to_corner();
        let times = self.factor as f64;
        CornerPoint { x: corner.x * times, y: corner.y * times }.to_pixel()
    }
}

/// By which factors an image is looked at smaller, one after the other.
pub(crate) fn factors(image: &Image) -> Vec<usize> {
    let longer = image.width().max(image.height());
    let (mut factor, last) = (longer.div_ceil(FIRST), longer.div_ceil(LAST));
    let mut factors = vec![factor];
    while factor > last {
        factor = (factor / 2).max(last);
        factors.push(factor);
    }
    factors
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_halve_down_to_the_bound() {
        let of = |width: usize| factors(&Image::new(width, 1, vec![0.0; width]));
        assert_eq!(of(240), [1]);
        assert_eq!(of(1000), [2, 1]);
        assert_eq!(of(4000), [7, 3, 2]);
    }

    #[test]
    fn points_keep_their_place() {
        let level = Level { image: Image::new(1, 1, vec![0.0]), factor: 3 };
        assert_eq!(level.original([0.0, 2.0]), PixelPoint::new(1.0, 7.0));
    }
}
