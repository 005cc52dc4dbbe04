//! The normal image: a square as if seen from the front, enlarged.

use calibench_model::Image;

use crate::mapping::Mapping;

/// Pixels to a side of a square: of the paper's recordings of 60 px a square, the normal image enlarged by two.
pub(crate) const SIDE: usize = 120;
/// Of a square's pixels, what is paper for certain and what is ink: quantiles. About a quarter is ink.
const PAPER: f64 = 0.6;
const INK: f64 = 0.04;

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
        let mut grey = Vec::with_capacity(SIDE * SIDE);
        for y in 0..SIDE {
            for x in 0..SIDE {
                let at = mapping.image([column as f64 + to_square(x as f64), row as f64 + to_square(y as f64)])?;
                grey.push(cubic(image, at));
            }
        }
        let mut sorted = grey.clone();
        let mut quantile = |share: f64| *sorted.select_nth_unstable_by((share * (SIDE * SIDE - 1) as f64) as usize, f32::total_cmp).1;
        let (paper, ink) = (quantile(PAPER), quantile(INK));
        let contrast = (paper - ink).max(1e-6);
        grey.iter_mut().for_each(|value| *value = (paper - *value) / contrast);
        Some(Self { dark: grey, contrast: f64::from(contrast) })
    }

    /// Darkness between pixels, linearly; at the border that of the nearest pixel.
    pub fn at(&self, x: f64, y: f64) -> f32 {
        let (x, y) = (x.clamp(0.0, SIDE as f64 - 1.001), y.clamp(0.0, SIDE as f64 - 1.001));
        let (i, j) = (x as usize, y as usize);
        let (a, b) = ((x - i as f64) as f32, (y - j as f64) as f32);
        let row = |j: usize| (1.0 - a) * self.dark[j * SIDE + i] + a * self.dark[j * SIDE + i + 1];
        (1.0 - b) * row(j) + b * row(j + 1)
    }
}

/// From pixels of the normal image to squares.
pub(crate) fn to_square(pixel: f64) -> f64 {
    (pixel + 0.5) / SIDE as f64
}

/// The grey value at a place, px, by cubic convolution; beyond the border the image goes on as at it.
///
/// Source: Keys 1981, with a = -1/2.
pub(crate) fn cubic(image: &Image, [x, y]: [f64; 2]) -> f32 {
    let (i, j) = (x.floor(), y.floor());
    let (u, v) = (weights((x - i) as f32), weights((y - j) as f32));
    let (i, j) = (i as i64, j as i64);
    let mut sum = 0.0;
    if i >= 1 && j >= 1 && i + 2 < image.width() as i64 && j + 2 < image.height() as i64 {
        for (k, weight) in v.iter().enumerate() {
            let row = &image.row(j as usize + k - 1)[i as usize - 1..i as usize + 3];
            sum += weight * (u[0] * row[0] + u[1] * row[1] + u[2] * row[2] + u[3] * row[3]);
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
