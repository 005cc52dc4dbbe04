//! An image at one of several scales, and how much of a saddle each of its pixels is.

use calibench_model::{CornerPoint, Image, PixelPoint};

use super::side::Sides;
use crate::plane::Point;
use crate::smooth::smoothed;

/// Pixels of the level that is looked at first, and of the finest, at most.
const FIRST: usize = 800_000;
const FINEST: usize = 4_000_000;
/// Pixels of an image that is also looked at enlarged, at most.
const ENLARGED: usize = 160_000;
/// The least side of a level, px.
const LEAST_SIDE: usize = 24;

/// An image, and means of squares of two, four and so on of its pixels.
pub(crate) struct Pyramid<'a> {
    images: Vec<Image<'a>>,
    sides: Sides,
}

/// An image at one scale.
pub(crate) struct Level {
    /// px of the image to one of the level.
    pub factor: f64,
    /// Its grey values, smoothed by a standard deviation of one px.
    pub smooth: Image<'static>,
    /// Minus the determinant of their second derivatives, row by row: positive at saddles. Zero along the border.
    pub saddle: Vec<f32>,
    /// How the sides of squares are looked at.
    pub sides: Sides,
}

/// A point of an image in one whose pixels are `factor` times smaller.
pub(crate) fn scaled([x, y]: Point, factor: f64) -> Point {
    let corner = PixelPoint::new(x, y).to_corner();
    let at = CornerPoint { x: factor * corner.x, y: factor * corner.y }.to_pixel();
    [at.x, at.y]
}

impl Level {
    fn new(image: &Image, factor: f64, sides: Sides) -> Self {
        let smooth = smoothed(image);
        let saddle = saddles(&smooth);
        Self { factor, smooth, saddle, sides }
    }
}

impl<'a> Pyramid<'a> {
    pub(crate) fn new(image: &'a Image<'a>, sides: Sides) -> Self {
        let mut all = vec![image.lent()];
        while let Some(next) = all.last().map(|last| last.reduced(2)).filter(|next| next.width().min(next.height()) >= LEAST_SIDE) {
            all.push(next);
        }
        Self { images: all, sides }
    }

    /// The image as it is.
    pub(crate) fn image(&self) -> &Image<'a> {
        &self.images[0]
    }

    /// The images whose pixels are at most `most` of the image's, and how many px of the image theirs are; the finest first.
    pub(super) fn up_to(&self, most: f64) -> impl Iterator<Item = (&Image<'a>, f64)> {
        self.images.iter().enumerate().map(|(index, image)| (image, (1_u64 << index) as f64)).take_while(move |(_, factor)| *factor <= most)
    }

    /// Levels in the order in which they are looked at: a small one, smaller ones, larger ones, an enlarged one.
    pub(crate) fn levels(&self) -> impl Iterator<Item = Level> {
        let pixels: Vec<usize> = self.images.iter().map(|level| level.width() * level.height()).collect();
        let below = |most: usize| pixels.iter().position(|pixels| *pixels <= most).unwrap_or(pixels.len() - 1);
        let (first, finest) = (below(FIRST), below(FINEST));
        let order = (first..pixels.len()).chain((finest..first).rev());
        let ordinary = order.map(|index| Level::new(&self.images[index], (1_u64 << index) as f64, self.sides));
        let enlarged = (pixels[0] <= ENLARGED).then(|| self.image());
        ordinary.chain(enlarged.into_iter().map(|image| Level::new(&doubled(image), 0.5, self.sides)))
    }
}

fn saddles(image: &Image) -> Vec<f32> {
    let (width, height) = (image.width(), image.height());
    let mut all = vec![0.0_f32; width * height];
    for y in 1..height.saturating_sub(1) {
        let (a, b, c) = (&image.row(y - 1)[..width], &image.row(y)[..width], &image.row(y + 1)[..width]);
        let out = &mut all[y * width + 1..(y + 1) * width - 1];
        for (x, out) in out.iter_mut().enumerate() {
            let xx = b[x] - 2.0 * b[x + 1] + b[x + 2];
            let yy = a[x + 1] - 2.0 * b[x + 1] + c[x + 1];
            let xy = 0.25 * (a[x] - a[x + 2] - c[x] + c[x + 2]);
            *out = xy * xy - xx * yy;
        }
    }
    all
}

/// The image twice as large, by bilinear interpolation.
fn doubled(image: &Image) -> Image<'static> {
    let (width, height) = (image.width(), image.height());
    // An enlarged pixel lies a quarter of a pixel beside the one it is of.
    let other = |at: usize, size: usize| if at.is_multiple_of(2) { (at / 2).saturating_sub(1) } else { (at / 2 + 1).min(size - 1) };
    Image::from_fn(2 * width, 2 * height, |x, y| {
        let along = |y: usize| 0.75 * image.at(x / 2, y) + 0.25 * image.at(other(x, width), y);
        0.75 * along(y / 2) + 0.25 * along(other(y, height))
    })
}
