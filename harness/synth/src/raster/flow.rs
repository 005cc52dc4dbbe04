//! Derivatives of grey values by how outlines move and by the blur, of a window, all in one pass along the outlines.
//!
//! An outline that moves by v changes a pixel by the integral of K (vx dy - vy dx) along it, with K the kernel around the pixel: where the outline is, it lets
//! in what lies behind it. A softer lens changes a pixel by the Laplacian of its grey value (the equation of heat), which is such an integral, too: that of K's
//! slope. Outlines that no kernel reaches give nothing, wherever they lie.

use super::nodes::{Node, Rules, each_node};
use super::{Picture, Piece, Renderer};
use crate::optics::{Kernel, Part, Spread};

/// What there are derivatives by: six motions and the blur.
pub(crate) const COLUMNS: usize = 7;
/// The place of the blur's among them.
const BLUR: usize = 6;
/// Pixels that are handled side by side.
pub(crate) const LANES: usize = 8;
/// Pixels before the first and behind the last of a row, at least.
pub(crate) const MARGIN: usize = LANES;

/// Derivatives of windows through one lens that has a blur.
pub(crate) struct Flow {
    /// Of each level of blur.
    levels: Vec<Level>,
}

struct Level {
    /// What each part of the kernel spreads, along a row and down a column: its density and the density's slope.
    spreads: Vec<[[Spread; 2]; 2]>,
}

/// The square window of the pixels from `corner` (left, top) on, `side` x `side` px.
#[derive(Clone, Copy)]
pub(crate) struct Square {
    pub corner: [i64; 2],
    pub side: usize,
}

impl Flow {
    /// Through the lens of `renderer`; `None` without a blur, where grey values have kinks.
    pub fn new(renderer: &Renderer) -> Option<Self> {
        let spreads = |part: &Part| {
            let [along, down] = part.profiles;
            let [densities, slopes]: [fn(&_) -> Spread; 2] = [Spread::density, Spread::slope];
            [densities, slopes].map(|of| {
                let down_a_column = of(&down);
                [if along == down { down_a_column.clone() } else { of(&along) }, down_a_column]
            })
        };
        let level = |kernel: &Kernel| match kernel {
            Kernel::Sharp(_) => None,
            Kernel::Smooth { parts, .. } => Some(Level { spreads: parts.iter().map(spreads).collect() }),
        };
        Some(Self { levels: renderer.levels.kernels.iter().map(level).collect::<Option<_>>()? })
    }

    /// Derivatives of the grey values of `square`, into `found`. Of motions seen from (`x0`, `y0`), by h: x + h; y + h; x + h (x - x0); x + h (y - y0);
    /// y + h (x - x0); y + h (y - y0), each per px and fraction of full scale. Of the blur by its logarithm.
    pub fn window(&self, renderer: &Renderer, picture: &Picture, seen_from: [f64; 2], square: Square, found: &mut Derivatives) {
        let Square { corner: [left, top], side } = square;
        let moved = |point: [f64; 2]| [point[0] - left as f64, point[1] - top as f64];
        let moved_piece = |piece: &Piece| Piece { points: piece.points.map(moved), ..*piece };
        let reach = renderer.reach();
        let pieces: Vec<Piece> = picture.pieces.iter().map(moved_piece).filter(|piece| reaches(piece, side, reach)).collect();
        let at_level = |level: usize, sums: &mut Derivatives| {
            sums.clear(side);
            add(sums, &pieces, (&renderer.levels.kernels[level], &self.levels[level]), moved(seen_from), renderer.rules);
        };
        if self.levels.len() == 1 {
            return at_level(0, found);
        }
        found.clear(side);
        let mut sums = Derivatives::default();
        for level in 0..self.levels.len() {
            at_level(level, &mut sums);
            for y in 0..side {
                let place = |x: usize| renderer.levels.place((left + x as i64) as f64, (top + y as i64) as f64);
                let places: Vec<_> = (0..side).map(place).collect();
                for column in 0..COLUMNS {
                    renderer.levels.add(level, &places, &sums.row(y, column)[MARGIN..], &mut found.row_mut(y, column)[MARGIN..]);
                }
            }
        }
    }
}

/// Whether any kernel of these reaches gets from a piece to a window of `side` x `side` px.
fn reaches(piece: &Piece, side: usize, reach: [f64; 2]) -> bool {
    [piece.columns(), piece.rows()].iter().zip(reach).all(|([low, high], reach)| *high > -reach - 1.0 && *low < side as f64 + reach)
}

/// The derivatives of a window: of each row every column of the Jacobian in turn, with a margin on both sides, in which anything may stand: pixels are handled in
/// groups, some of which are partly inside.
#[derive(Clone, Debug, Default)]
pub(crate) struct Derivatives {
    side: usize,
    stride: usize,
    values: Vec<f64>,
}

impl Derivatives {
    /// Makes them those of a window of `side` x `side` px, all zero; memory is used again.
    pub fn clear(&mut self, side: usize) {
        (self.side, self.stride) = (side, stride(side));
        self.values.clear();
        self.values.resize(side * COLUMNS * self.stride, 0.0);
    }

    /// Row `y` of a column, with its margins.
    pub fn row(&self, y: usize, column: usize) -> &[f64] {
        &self.values[(y * COLUMNS + column) * self.stride..][..self.stride]
    }

    /// The same, to be filled.
    pub fn row_mut(&mut self, y: usize, column: usize) -> &mut [f64] {
        &mut self.values[(y * COLUMNS + column) * self.stride..][..self.stride]
    }
}

/// The length of a row of `side` px with its margins: whole groups.
pub(crate) fn stride(side: usize) -> usize {
    side.next_multiple_of(LANES) + 2 * MARGIN
}

/// Adds what `pieces` give to each pixel of the window.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn add(sums: &mut Derivatives, pieces: &[Piece], (kernel, level): (&Kernel, &Level), [x0, y0]: [f64; 2], rules: &Rules) {
    let Kernel::Smooth { sigma, parts } = kernel else { return };
    let rows = [0.0, sums.side as f64 - 1.0];
    for (part, [densities, slopes]) in parts.iter().zip(&level.spreads) {
        // A tail stays as it is where the blur changes.
        let variance = if part.profiles[1].sigma == *sigma { sigma * sigma } else { 0.0 };
        let mut along = Along::new(&densities[0]);
        for piece in pieces {
            each_node(piece, *sigma, rows, std::slice::from_ref(part), rules, |part, Node { at, along: [dx, dy] }| {
                let [x, y] = [at[0] - part.shift[0] - x0, at[1] - part.shift[1] - y0];
                if along.around(at[0], [&densities[0], &slopes[0]], sums.side) {
                    let motions = [dy, -dx, dy * x, dy * y, -dx * x, -dx * y];
                    spread(sums, &along, at[1], [&densities[1], &slopes[1]], motions, [variance * dy, -variance * dx]);
                }
            });
        }
    }
}

/// What a point gives to the pixels of a row: the density and its slope, of the groups of pixels that are in the window, wholly or partly.
struct Along {
    /// The first pixel's place in a row of the sums.
    start: usize,
    groups: usize,
    density: Vec<[f64; LANES]>,
    slope: Vec<[f64; LANES]>,
}

impl Along {
    fn new(spread: &Spread) -> Self {
        let groups = vec![[0.0; LANES]; spread.taps.div_ceil(LANES)];
        Self { start: 0, groups: 0, density: groups.clone(), slope: groups }
    }

    /// Takes the point at column `x`; whether it reaches the window.
    #[inline(always)]
    fn around(&mut self, x: f64, [density, slope]: [&Spread; 2], side: usize) -> bool {
        let (first, low, high, share) = density.around(x);
        let (_, slope_low, slope_high, _) = slope.around(x);
        // Groups that end left of the window, and those that begin right of it.
        let left = (-first).max(0) as usize / LANES;
        let end = density.taps.min((side as i64 - first).max(0) as usize).div_ceil(LANES);
        if left >= end {
            return false;
        }
        (self.start, self.groups) = ((first + (left * LANES + MARGIN) as i64) as usize, end - left);
        let taps = left * LANES..(end * LANES).min(density.taps);
        let (densities, slopes) = (self.density.as_flattened_mut(), self.slope.as_flattened_mut());
        for (i, tap) in taps.clone().enumerate() {
            densities[i] = low[tap] + share * (high[tap] - low[tap]);
            slopes[i] = slope_low[tap] + share * (slope_high[tap] - slope_low[tap]);
        }
        densities[taps.len()..].fill(0.0);
        slopes[taps.len()..].fill(0.0);
        true
    }
}

/// Adds what a point of an outline gives: `motions` times the kernel, and `softer` times its slopes along a row and down a column.
#[inline(always)]
fn spread(sums: &mut Derivatives, along: &Along, y: f64, [density, slope]: [&Spread; 2], motions: [f64; BLUR], softer: [f64; 2]) {
    let (first, low, high, share) = density.around(y);
    let (_, steep_low, steep_high, _) = slope.around(y);
    let taps = (-first).max(0) as usize..((sums.side as i64 - first).max(0) as usize).min(density.reached);
    for tap in taps {
        let down = low[tap] + share * (high[tap] - low[tap]);
        let steep = steep_low[tap] + share * (steep_high[tap] - steep_low[tap]);
        let row = (first + tap as i64) as usize * COLUMNS * sums.stride;
        let rows = &mut sums.values[row..row + COLUMNS * sums.stride];
        for (row, motion) in rows.chunks_exact_mut(sums.stride).zip(motions) {
            let factor = motion * down;
            for (pixels, density) in row[along.start..].as_chunks_mut::<LANES>().0.iter_mut().zip(&along.density[..along.groups]) {
                for lane in 0..LANES {
                    pixels[lane] += factor * density[lane];
                }
            }
        }
        let (by_density, by_slope) = (softer[1] * steep, softer[0] * down);
        let row = &mut rows[BLUR * sums.stride + along.start..];
        let both = along.density.iter().zip(&along.slope).take(along.groups);
        for (pixels, (density, slope)) in row.as_chunks_mut::<LANES>().0.iter_mut().zip(both) {
            for lane in 0..LANES {
                pixels[lane] += by_density * density[lane] + by_slope * slope[lane];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::optics::{Motion, Optics};

    const SQUARE: Square = Square { corner: [9, 12], side: 21 };

    /// An ellipse, a triangle that leaves the window, a bar that runs through all of it, and squares a pixel left of it and above; of three contrasts.
    fn picture() -> Picture {
        let ellipse = |i: usize, t: f64| {
            let (sin, cos) = ((i as f64 + t) * TAU / 12.0).sin_cos();
            [18.3 + 7.0 * cos - 1.5 * sin, 21.6 + 4.0 * sin + 1.0 * cos]
        };
        let arc = |i: usize| Piece { points: [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| ellipse(i, t)), contrast: -0.6 };
        let straight = |corners: &[[f64; 2]], contrast: f64| -> Vec<Piece> {
            (0..corners.len()).map(|i| Piece::straight(corners[i], corners[(i + 1) % corners.len()], contrast)).collect()
        };
        let mut pieces: Vec<Piece> = (0..12).map(arc).collect();
        pieces.extend(straight(&[[24.0, 14.0], [70.0, 18.0], [27.0, 60.0]], 0.3));
        pieces.extend(straight(&[[-30.0, 28.0], [90.0, 31.0], [90.0, 33.5], [-30.0, 30.5]], -0.2));
        pieces.extend(straight(&[[5.0, 16.0], [8.0, 16.0], [8.0, 19.0], [5.0, 19.0]], 0.3));
        pieces.extend(straight(&[[12.0, 8.0], [15.0, 8.0], [15.0, 11.0], [12.0, 11.0]], 0.3));
        Picture { width: 41, height: 41, background: 0.8, pieces }
    }

    #[test]
    fn derivatives_are_those_of_differences_through_every_lens() {
        let blur = Optics { blur: 0.7, ..Optics::default() };
        let lenses = [
            ("narrow", Optics { blur: 0.3, aperture: 0.8, ..blur }),
            ("blur", blur),
            ("wide", Optics { blur: 2.2, ..blur }),
            ("corners", Optics { corner_blur: Some(1.6), ..blur }),
            ("defocus", Optics { defocus: 1.7, ..blur }),
            ("motion", Optics { motion: Some(Motion { length: 2.5, direction: 0.6 }), aperture: 0.9, ..blur }),
        ];
        let (picture, from) = (picture(), [18.3, 21.6]);
        for (name, optics) in lenses {
            let renderer = Renderer::new(&optics, 41, 41).unwrap();
            let softer = |factor: f64| {
                let corner_blur = optics.corner_blur.map(|blur| blur * factor);
                Renderer::new(&Optics { blur: optics.blur * factor, corner_blur, ..optics }, 41, 41).unwrap()
            };
            let light = |renderer: &Renderer, by: &dyn Fn([f64; 2]) -> [f64; 2]| {
                renderer.render_window(&picture, 0.8, |piece| Piece { points: piece.points.map(by), ..*piece }, SQUARE)
            };
            let moved = |column: usize, h: f64| {
                light(&renderer, &|[x, y]| {
                    let by = h * [1.0, 1.0, x - from[0], y - from[1], x - from[0], y - from[1]][column];
                    if [0, 2, 3].contains(&column) { [x + by, y] } else { [x, y + by] }
                })
            };
            let mut all = Derivatives::default();
            Flow::new(&renderer).unwrap().window(&renderer, &picture, from, SQUARE, &mut all);
            for column in 0..COLUMNS {
                let found = (0..SQUARE.side).flat_map(|y| all.row(y, column)[MARGIN..][..SQUARE.side].to_vec());
                // What is far moves the further; much smaller steps show the kernel's table.
                let step = if (2..BLUR).contains(&column) { 3e-4 } else { 1e-3 };
                let [high, low] = [1.0, -1.0].map(|sign| {
                    if column == BLUR { light(&softer(1.0 + sign * step), &|point| point) } else { moved(column, sign * step) }
                });
                let differences: Vec<f64> = high.iter().zip(&low).map(|(high, low)| (high - low) / (2.0 * step)).collect();
                let most = differences.iter().fold(0.0_f64, |most, d| most.max(d.abs()));
                let error = differences.iter().zip(found).fold(0.0_f64, |most, (d, found)| most.max((d - found).abs()));
                println!("{name}, column {column}: {error:.1e} of {most:.3}");
                assert!(most > 0.01 && error < 1e-4 * most, "{name}, column {column}: {error} of {most}");
            }
        }
    }

    #[test]
    fn without_a_blur_there_are_kinks() {
        assert!(Flow::new(&Renderer::new(&Optics::default(), 41, 41).unwrap()).is_none());
    }
}
