//! The normal image: a square as if seen from the front, enlarged.

use calibench_model::Image;

use crate::mapping::Mapping;

/// Pixels to a side of a square: of the paper's recordings of 60 px a square, the normal image enlarged by two.
pub(crate) const SIDE: usize = 120;
/// The way into the image is taken at every so many pixels and is straight between them: the bend of perspective and lens over 4 px is thousandths of a pixel.
const STEP: usize = 8;
const NODES: usize = SIDE / STEP;
/// Of a square's pixels, what is paper for certain and what is ink: quantiles. About a quarter is ink.
const PAPER: f64 = 0.6;
const INK: f64 = 0.04;

/// Added to coordinates, so that they are positive and rounding is cheap, px.
const OFFSET: f64 = 1024.0;

/// A square, rectified.
#[derive(Clone, Debug)]
pub(crate) struct Normal {
    /// `SIDE` rows of as many values: 0 is the paper, 1 the ink.
    pub dark: Vec<f32>,
    /// From paper to ink, fraction of full scale.
    pub contrast: f64,
}

impl Normal {
    /// The square (column, row) of the grid. `None` where part of it has no place in the image.
    pub fn of(image: &Image, mapping: &Mapping, [column, row]: [i64; 2]) -> Option<Self> {
        let mut nodes = Vec::with_capacity((NODES + 1) * (NODES + 1));
        for node in 0..(NODES + 1) * (NODES + 1) {
            let [x, y] = [node % (NODES + 1), node / (NODES + 1)].map(|i| to_square((i * STEP) as f64));
            nodes.push(mapping.image([column as f64 + x, row as f64 + y])?);
        }
        let mut grey = Vec::with_capacity(SIDE * SIDE);
        for y in 0..SIDE {
            let (j, v) = (y / STEP, (y % STEP) as f64 / STEP as f64);
            let down = |i: usize| {
                let (a, b) = (nodes[j * (NODES + 1) + i], nodes[(j + 1) * (NODES + 1) + i]);
                [a[0] + v * (b[0] - a[0]), a[1] + v * (b[1] - a[1])]
            };
            for i in 0..NODES {
                let (a, b) = (down(i), down(i + 1));
                let step = [(b[0] - a[0]) / STEP as f64, (b[1] - a[1]) / STEP as f64];
                grey.extend((0..STEP).map(|k| cubic(image, [a[0] + k as f64 * step[0], a[1] + k as f64 * step[1]])));
            }
        }
        let mut sorted = grey.clone();
        let mut quantile = |share: f64| *sorted.select_nth_unstable_by((share * (SIDE * SIDE - 1) as f64) as usize, f32::total_cmp).1;
        let (paper, ink) = (quantile(PAPER), quantile(INK));
        let contrast = (paper - ink).max(1e-6);
        grey.iter_mut().for_each(|value| *value = (paper - *value) / contrast);
        Some(Self { dark: grey, contrast: f64::from(contrast) })
    }
}

/// From pixels of the normal image to squares.
pub(crate) fn to_square(pixel: f64) -> f64 {
    (pixel + 0.5) / SIDE as f64
}

/// The grey value at a place, px, by cubic convolution; beyond the border the image goes on as at it.
///
/// Source: Keys 1981, with a = -1/2.
#[inline]
pub(crate) fn cubic(image: &Image, [x, y]: [f64; 2]) -> f32 {
    // Towards minus infinity for all that lies near an image.
    let down = |value: f64| (value + OFFSET) as i64 - OFFSET as i64;
    let (i, j) = (down(x), down(y));
    let (u, v) = (weights((x - i as f64) as f32), weights((y - j as f64) as f32));
    let mut sum = 0.0;
    if i >= 1 && j >= 1 && i + 2 < image.width() as i64 && j + 2 < image.height() as i64 {
        let first = (j as usize - 1) * image.width() + i as usize - 1;
        for (k, weight) in v.iter().enumerate() {
            if let Some(row) = image.grey()[first + k * image.width()..].first_chunk::<4>() {
                sum += weight * (u[0] * row[0] + u[1] * row[1] + u[2] * row[2] + u[3] * row[3]);
            }
        }
        return sum;
    }
    let clamped = |value: i64, side: usize| value.clamp(0, side as i64 - 1) as usize;
    for (k, weight) in v.iter().enumerate() {
        let row = image.row(clamped(j + k as i64 - 1, image.height()));
        sum += weight * (0..4).map(|l| u[l] * row[clamped(i + l as i64 - 1, image.width())]).sum::<f32>();
    }
    sum
}

#[inline]
fn weights(t: f32) -> [f32; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [-0.5 * t + t2 - 0.5 * t3, 1.0 - 2.5 * t2 + 1.5 * t3, 0.5 * t + 2.0 * t2 - 1.5 * t3, -0.5 * t2 + 0.5 * t3]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubic_convolution_is_exact_for_parabolas_inside() {
        let value = |x: f64, y: f64| 0.1 + 0.02 * x - 0.01 * y + 0.001 * x * x + 0.002 * x * y;
        let image = Image::from_fn(12, 10, |x, y| value(x as f64, y as f64) as f32);
        for at in [[3.3, 4.7], [5.0, 2.5], [7.9, 6.1]] {
            assert!((f64::from(cubic(&image, at)) - value(at[0], at[1])).abs() < 1e-5);
        }
        assert_eq!(cubic(&image, [-5.0, -5.0]), image.at(0, 0));
    }
}
