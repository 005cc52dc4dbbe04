//! Round dark areas.

use calibench_model::{Image, stop, upper_median};

use crate::ground::{Ground, grey};
use crate::patches::{Patches, Run};
use crate::plane::Point;
use crate::quads::{hull, largest_quad};

/// The least diameter, px.
const LEAST: u32 = 4;
/// Where between dark (0) and light (1) areas end.
const LEVEL: f32 = 0.5;
/// An area as a fraction of that of the ellipse of its moments: 0.955 for a square, 1 for an ellipse; pixels of a small one make the difference.
const FILLED: [f64; 2] = [0.93, 1.05];
/// How many times as long as wide.
const ELONGATED: f64 = 4.0;
/// The share of its hull that the largest quadrangle in it takes up at most: 0.64 for an ellipse; told from this many px on.
const SHARE: f64 = 0.84;
pub(crate) const TOLD: f64 = 60.0;
/// Where the middle, the ring and the surroundings of a ring are looked at, in radii.
const MIDDLE: [f64; 3] = [0.12, 0.75, 1.4];

/// A dark area, with what is in it: of those that are round a disc or a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Round {
    /// Its centre of gravity.
    pub at: Point,
    /// Its second moments xx, xy, yy, px^2.
    pub moments: [f64; 3],
    /// Its area, px^2.
    pub area: f64,
    /// Whether its outline is a circle seen from anywhere.
    pub is_oval: bool,
    /// Whether it reaches the border of the image: what is beyond is not seen.
    pub is_cut: bool,
}

/// The round dark areas of an image, in reading order of their tops.
pub(crate) fn rounds(image: &Image) -> Vec<Round> {
    let mut all = areas(image);
    all.retain(|area| area.is_oval && !area.is_cut);
    all
}

/// The dark areas of an image that are not much longer than wide, in reading order of their tops.
pub(crate) fn areas(image: &Image) -> Vec<Round> {
    let most = image.width().min(image.height()) as u32 / 2;
    let patches = Patches::with_cut(image, &Ground::new(image), LEVEL, [LEAST, most]);
    let border = [image.width() as u32, image.height() as u32 - 1];
    patches.iter().map(|runs| Round::of(runs, border)).filter(|area| area.elongation() < ELONGATED).collect()
}

impl Round {
    /// Of these runs in an image that ends at `border`: the column after its last, its last row.
    fn of(runs: &[Run], border: [u32; 2]) -> Self {
        stop::point();
        let filled = filled(runs);
        let [mut area, mut x, mut y] = [0.0; 3];
        for &[row, from, to] in &filled {
            let count = to - from;
            area += count;
            x += count * 0.5 * (from + to - 1.0);
            y += count * row;
        }
        let is_cut = runs.iter().any(|run| run.from == 0 || run.y == 0 || run.to == border[0] || run.y == border[1]);
        let at = [x / area, y / area];
        let mut moments = [0.0; 3];
        for &[row, from, to] in &filled {
            let (count, dx, dy) = (to - from, 0.5 * (from + to - 1.0) - at[0], row - at[1]);
            moments[0] += count * (dx * dx + count * count / 12.0);
            moments[1] += count * dx * dy;
            moments[2] += count * (dy * dy + 1.0 / 12.0);
        }
        let round = Self { at, moments: moments.map(|moment| moment / area), area, is_oval: false, is_cut };
        let is_filled = round.elongation() < ELONGATED && (FILLED[0]..FILLED[1]).contains(&round.share());
        Self { is_oval: is_filled && (area < TOLD || largest_quad(&hull(runs)).is_some_and(|(_, share)| share < SHARE)), ..round }
    }

    /// How light its middle is between its own grey value (0) and that of its surroundings (1): a ring has a hole.
    pub(crate) fn hole(&self, image: &Image) -> f64 {
        let [x, y] = self.axes();
        let around = |radius: f64, count: u32| {
            let at = |step: u32| {
                let (sine, cosine) = (f64::from(step) * std::f64::consts::TAU / f64::from(count)).sin_cos();
                let [u, v] = [radius * cosine, radius * sine];
                grey(image, [self.at[0] + x[0] * u + x[1] * v, self.at[1] + y[0] * u + y[1] * v])
            };
            upper_median((0..count).map(at)).unwrap_or(f64::NAN)
        };
        let (middle, own, outside) = (around(MIDDLE[0], 5), around(MIDDLE[1], 16), around(MIDDLE[2], 16));
        (middle - own) / (outside - own)
    }

    /// By how much its area is not that of the ellipse of its moments, as a fraction.
    pub(crate) fn unlike(&self) -> f64 {
        (self.share() - 1.0).abs()
    }

    /// The ratio of the axes of its ellipse, 1 or more.
    pub(crate) fn elongation(&self) -> f64 {
        let [xx, xy, yy] = self.moments;
        let (middle, half) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
        ((middle + half) / (middle - half).max(1e-9)).sqrt()
    }

    fn share(&self) -> f64 {
        let [xx, xy, yy] = self.moments;
        self.area / (4.0 * std::f64::consts::PI * (xx * yy - xy * xy).max(0.0).sqrt())
    }

    /// From the unit circle to its ellipse, without a turn.
    pub(crate) fn axes(&self) -> [[f64; 2]; 2] {
        let [xx, xy, yy] = self.moments.map(|moment| 4.0 * moment);
        let det = (xx * yy - xy * xy).max(0.0).sqrt();
        let root = (xx + yy + 2.0 * det).sqrt();
        [[(xx + det) / root, xy / root], [xy / root, (yy + det) / root]]
    }

    /// As it is in the mirrored image (x is -x).
    pub(crate) fn mirrored(&self) -> Self {
        let [xx, xy, yy] = self.moments;
        Self { at: [-self.at[0], self.at[1]], moments: [xx, -xy, yy], ..*self }
    }
}

/// Each row of an area from its first to after its last pixel: holes are filled.
fn filled(runs: &[Run]) -> Vec<[f64; 3]> {
    let mut rows: Vec<[f64; 3]> = Vec::new();
    for run in runs {
        let (y, from, to) = (f64::from(run.y), f64::from(run.from), f64::from(run.to));
        match rows.last_mut() {
            Some(row) if row[0] == y => *row = [y, row[1].min(from), row[2].max(to)],
            _ => rows.push([y, from, to]),
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn discs_and_rings_are_round_and_squares_are_not() {
        let image = Image::from_fn(120, 60, |x, y| {
            let off = |u: f64, v: f64| [x as f64 - u, y as f64 - v];
            let (disc, ring, square) = (off(20.3, 30.6), off(60.0, 30.0), off(98.0, 30.0));
            let ellipse = (disc[0] / 6.0).hypot(disc[1] / 12.0) < 1.0;
            let dark = ellipse || (6.0..11.0).contains(&ring[0].hypot(ring[1])) || square[0].abs().max(square[1].abs()) < 9.0;
            if dark { 0.1 } else { 0.8 }
        });
        let found = rounds(&image);
        assert_eq!(found.len(), 2, "{found:?}");
        let holes = found.iter().map(|round| round.hole(&image)).collect::<Vec<_>>();
        assert!(
            holes.iter().filter(|hole| **hole < 0.1).count() == 1 && holes.iter().filter(|hole| **hole > 0.9).count() == 1,
            "{holes:?}"
        );
        let disc = found.iter().find(|round| round.at[0] < 40.0).unwrap();
        assert!((disc.at[0] - 20.3).abs() < 0.15 && (disc.at[1] - 30.6).abs() < 0.15, "{disc:?}");
        let axes = disc.axes();
        assert!((axes[0][0] - 6.0).abs() < 0.3 && (axes[1][1] - 12.0).abs() < 0.3 && axes[0][1].abs() < 0.3, "{axes:?}");
    }
}
