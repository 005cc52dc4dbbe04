//! The sectors of a ring around a disc.

use std::f64::consts::TAU;

use calibench_model::Image;
use calibench_model::boards::least_rotation;

use crate::ground::grey;
use crate::plane::{Point, plus};
use crate::round::Round;

/// Samples along a sector.
const FINE: usize = 8;
/// The least contrast of disc and ground, fraction of full scale.
const CONTRAST: f64 = 0.03;
/// The share of the samples around a disc, and of those just beyond its ring, that have to be light.
const LIGHT: f64 = 0.9;
const BEYOND: f64 = 0.8;
/// How far out "just beyond" is, in outer radii of the ring.
const OUT: f64 = 1.13;
/// How far from dark and light the middle of a sector may be, as a fraction of the contrast.
const OFF: f64 = 0.33;
/// How well the borders of sectors have to stand where equal sectors have them: 1 is exactly, 0 anywhere.
const REGULAR: f64 = 0.7;

/// Reads rings.
#[derive(Clone, Copy)]
pub(crate) struct Reader<'a> {
    pub image: &'a Image<'a>,
    /// Sectors.
    pub bits: usize,
    /// Inner and outer diameter of the ring, in diameters of the disc.
    pub ring: [f64; 2],
    /// Whether places are those of the mirrored image (x is -x).
    pub mirrored: bool,
}

/// A ring's code.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Code {
    /// The smallest of its rotations.
    pub least: u32,
    /// Where that begins on the circle of the disc's axes, clockwise from x.
    pub start: f64,
    /// Whether it looks the same after another turn.
    pub turnable: bool,
}

impl Reader<'_> {
    /// The code around a disc; `None` if there is none.
    pub(crate) fn read(&self, round: &Round) -> Option<Code> {
        let circle = Circle { reader: self, at: round.at, axes: round.axes() };
        let [dark, light] = circle.levels(0.5 * (1.0 + self.ring[0]), LIGHT)?;
        circle.levels(OUT * self.ring[1], BEYOND)?;
        let threshold = 0.5 * (dark + light);
        let fine = FINE * self.bits;
        let angle = |index: usize| TAU * index as f64 / fine as f64;
        let depths: Vec<f64> = (0..fine).map(|index| threshold - circle.across(self.ring, angle(index))).collect();
        let borders: Vec<f64> = (0..fine).filter_map(|index| border(&depths, index).map(|part| angle(1) * (index as f64 + part))).collect();
        let phase = self.phase(&borders)?;
        let sector = TAU / self.bits as f64;
        let mut code = 0_u32;
        for k in 0..self.bits {
            let middle = phase + (k as f64 + 0.5) * sector;
            let spots = [-0.15, 0.0, 0.15].map(|step| circle.across(self.ring, middle + step * sector));
            let level = spots.iter().sum::<f64>() / 3.0;
            if (level - dark).min(light - level) > OFF * (light - dark) {
                return None;
            }
            code = code << 1 | u32::from(level < threshold);
        }
        let least = least_rotation(code, self.bits);
        let all = (1_u32 << self.bits) - 1;
        let turned = |k: &usize| (code << k | code >> (self.bits - k)) & all == least;
        let mut starts = (0..self.bits).filter(turned);
        let first = starts.next()?;
        Some(Code { least, start: phase + first as f64 * sector, turnable: starts.next().is_some() })
    }

    /// Where the first sector begins, from where borders are.
    fn phase(&self, borders: &[f64]) -> Option<f64> {
        let bits = self.bits as f64;
        let sum = borders.iter().fold([0.0, 0.0], |sum, at| plus(sum, [(bits * at).cos(), (bits * at).sin()]));
        let regular = borders.len() >= 2 && sum[0].hypot(sum[1]) > REGULAR * borders.len() as f64;
        regular.then(|| sum[1].atan2(sum[0]) / bits)
    }
}

/// How far after a sample the sign changes, in steps.
fn border(values: &[f64], index: usize) -> Option<f64> {
    let [a, b] = [values[index], values[(index + 1) % values.len()]];
    ((a > 0.0) != (b > 0.0)).then(|| a / (a - b))
}

/// A disc's circle, seen as an ellipse.
struct Circle<'a> {
    reader: &'a Reader<'a>,
    at: Point,
    axes: [[f64; 2]; 2],
}

impl Circle<'_> {
    /// The grey value so many radii from the middle, in a direction clockwise from x.
    fn grey(&self, radii: f64, angle: f64) -> f64 {
        let (sine, cosine) = angle.sin_cos();
        let step = self.axes.map(|row| radii * (row[0] * cosine + row[1] * sine));
        let [x, y] = plus(self.at, step);
        grey(self.reader.image, [if self.reader.mirrored { -x } else { x }, y])
    }

    /// The mean grey value across the middle of the ring.
    fn across(&self, [inner, outer]: [f64; 2], angle: f64) -> f64 {
        [0.35, 0.5, 0.65].iter().map(|part| self.grey(inner + part * (outer - inner), angle)).sum::<f64>() / 3.0
    }

    /// The grey values of the disc and of the circle so many radii away; `None` where less than a share of that is light.
    fn levels(&self, radii: f64, share: f64) -> Option<[f64; 2]> {
        let around: Vec<f64> = (0..24).map(|k| self.grey(radii, TAU * f64::from(k) / 24.0)).collect();
        let (dark, light) = (self.grey(0.0, 0.0), around.iter().sum::<f64>() / 24.0);
        let bright = around.iter().filter(|grey| **grey > 0.5 * (dark + light)).count() as f64;
        (light - dark > CONTRAST && bright >= 24.0 * share).then_some([dark, light])
    }
}
