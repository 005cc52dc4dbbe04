//! Noise against level.

use calibench_model::median;

use super::square::SquareFit;
use crate::tone::Tone;

/// Bins of level.
const BINS: usize = 8;

/// Variance of light = dark + slope x light, fractions of full scale where grey is light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoiseLine {
    /// At level 0.
    pub dark: f64,
    /// For each unit of level.
    pub slope: f64,
}

impl NoiseLine {
    /// The variance at a level.
    pub fn at(&self, level: f64) -> f64 {
        (self.dark + self.slope * level).max(0.0)
    }
}

/// Level, median variance and number of squares of each bin of level that has some. Squares at the ends of the scale take no part.
pub fn binned<'s>(squares: impl Iterator<Item = &'s SquareFit>) -> Vec<[f64; 3]> {
    let good: Vec<&SquareFit> = squares.filter(|square| square.clipped < 0.01).collect();
    let bounds = good.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], square| [l.min(square.level), h.max(square.level)]);
    let bin = |square: &&&SquareFit| {
        (((square.level - bounds[0]) / (bounds[1] - bounds[0]).max(1e-9)) * BINS as f64).min(BINS as f64 - 1.0) as usize
    };
    let of = |index: usize| {
        let own: Vec<&SquareFit> = good.iter().filter(|square| bin(square) == index).copied().collect();
        Some([median(own.iter().map(|square| square.level))?, median(own.iter().map(|square| square.variance))?, own.len() as f64])
    };
    (0..BINS).filter_map(of).collect()
}

/// Squares on a steeper part of the curve tell the noise of light.
const FLATTEST: f64 = 0.25;

/// The line through bins of the light under a curve, none below zero; `None` of no square.
pub fn noise_line(squares: &[SquareFit], tone: Tone) -> Option<NoiseLine> {
    let told = |square: &&SquareFit| tone.slope(square.level) >= FLATTEST;
    let light = |square: &SquareFit| SquareFit {
        level: tone.light(square.level),
        variance: square.variance / tone.slope(square.level).powi(2),
        ..*square
    };
    let lit: Vec<SquareFit> = squares.iter().filter(told).map(light).collect();
    let bins = binned(lit.iter());
    let total: f64 = bins.iter().map(|bin| bin[2]).sum();
    if total == 0.0 {
        return None;
    }
    let mean = [0, 1].map(|k| bins.iter().map(|bin| bin[k] * bin[2]).sum::<f64>() / total);
    let spread: f64 = bins.iter().map(|bin| bin[2] * (bin[0] - mean[0]).powi(2)).sum();
    let together: f64 = bins.iter().map(|bin| bin[2] * (bin[0] - mean[0]) * (bin[1] - mean[1])).sum();
    let slope = if spread > 1e-6 * total { (together / spread).max(0.0) } else { 0.0 };
    let dark = mean[1] - slope * mean[0];
    Some(if dark > 0.0 { NoiseLine { dark, slope } } else { NoiseLine { dark: 0.0, slope: mean[1] / mean[0].max(1e-9) } })
}
