//! One colour at each photosite to a grey value at each.

use calibench_model::Image;
use rayon::prelude::*;

use super::filter::{BLUE, ColourFilter, GREEN, RED};
use super::{SensorError, check};

/// How the picture of a colour filter becomes grey.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demosaic {
    /// Which grey.
    pub to: DemosaicTo,
    /// Factors of red, green and blue, in this order, before; `None` makes a grey target grey, with the most sensitive colour's as 1.
    pub white_balance: Option<[f64; 3]>,
}

/// The grey value of a pixel whose colours are interpolated bilinearly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DemosaicTo {
    /// 0.299 red + 0.587 green + 0.114 blue. Source: ITU-R BT.601.
    Grey,
    /// Green alone.
    Green,
}

impl Demosaic {
    pub(super) fn check(&self) -> Result<(), SensorError> {
        let factors = self.white_balance.unwrap_or([1.0; 3]);
        factors.iter().try_for_each(|&factor| check("a factor of the white balance", factor, 1e-3, 1e3))
    }

    /// The factors of red, green and blue behind `filter`.
    pub(super) fn balance(&self, filter: &ColourFilter) -> [f64; 3] {
        let most = filter.sensitivity.iter().fold(0.0, |most: f64, &s| most.max(s));
        self.white_balance.unwrap_or(filter.sensitivity.map(|s| most / s))
    }

    /// The grey image of the balanced mosaic `raw`. Beyond its border the mosaic goes on mirrored.
    pub(super) fn interpolate(&self, raw: &Image, filter: &ColourFilter) -> Image<'static> {
        let (width, height) = (raw.width(), raw.height());
        let mut grey = vec![0.0; width * height];
        grey.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, grey)| {
            let (up, down) = mirrored(y, height);
            let rows = [raw.row(up), raw.row(y), raw.row(down)];
            self.interpolate_row(rows, filter.pattern.row(y), grey);
        });
        Image::new(width, height, grey)
    }

    fn interpolate_row(&self, [up, here, down]: [&[f32]; 3], colours: [usize; 2], grey: &mut [f32]) {
        let weights = match self.to {
            DemosaicTo::Grey => [0.299, 0.587, 0.114],
            DemosaicTo::Green => [0.0, 1.0, 0.0],
        };
        let row_colour = if colours[0] == GREEN { colours[1] } else { colours[0] };
        for (x, value) in grey.iter_mut().enumerate() {
            let (left, right) = mirrored(x, here.len());
            let across = (here[left] + here[right]) / 2.0;
            let along = (up[x] + down[x]) / 2.0;
            let mut colour = [0.0; 3];
            if colours[x % 2] == GREEN {
                colour[GREEN] = here[x];
                colour[row_colour] = across;
                colour[RED + BLUE - row_colour] = along;
            } else {
                colour[GREEN] = (across + along) / 2.0;
                colour[row_colour] = here[x];
                colour[RED + BLUE - row_colour] = (up[left] + up[right] + down[left] + down[right]) / 4.0;
            }
            *value = weights[RED] * colour[RED] + weights[GREEN] * colour[GREEN] + weights[BLUE] * colour[BLUE];
        }
    }
}

/// The neighbours of `i` of `n`, mirrored at the ends so that colours alternate.
fn mirrored(i: usize, n: usize) -> (usize, usize) {
    let before = if i == 0 { 1.min(n - 1) } else { i - 1 };
    let after = if i + 1 < n { i + 1 } else { i.saturating_sub(1) };
    (before, after)
}
