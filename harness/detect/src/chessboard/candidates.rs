//! Saddles of the grey values: what may be a corner of squares.

use std::f64::consts::TAU;

use calibench_model::{Image, stop};

use super::level::Level;
use crate::ground::grey;
use crate::plane::{Point, distance, length, minus, plus};

/// So many saddles of a level are looked at, the strongest.
const MOST: usize = 3000;
/// A saddle is stronger than this share of the strongest (of determinants, which go with the square of the contrast).
const SHARE: f32 = 1e-3;
/// A saddle is at most so far from the pixel where it is strongest, px.
const FAR: f64 = 1.5;
/// What is looked at around a saddle, px of the level.
const RING: f64 = 3.0;
const SAMPLES: usize = 16;
/// The saddles nearest to a point are looked up in squares of this side at least, px, and that hold about so many.
const CELL: f64 = 8.0;
const IN_CELL: f64 = 3.0;

/// A saddle of the grey values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Saddle {
    /// Where, px of the level.
    pub at: Point,
    /// The direction of the light on both of its sides, of length 1; its negative is the same.
    pub light: Point,
}

impl Saddle {
    /// The saddle around pixel (x, y), which is not on the border.
    fn at_pixel(level: &Level, x: usize, y: usize) -> Option<Self> {
        let image = &level.smooth;
        let g = |dx: usize, dy: usize| f64::from(image.at(x + dx - 1, y + dy - 1));
        let (gx, gy) = (0.5 * (g(2, 1) - g(0, 1)), 0.5 * (g(1, 2) - g(1, 0)));
        let (xx, yy) = (g(0, 1) - 2.0 * g(1, 1) + g(2, 1), g(1, 0) - 2.0 * g(1, 1) + g(1, 2));
        let xy = 0.25 * (g(0, 0) - g(2, 0) - g(0, 2) + g(2, 2));
        let det = xx * yy - xy * xy;
        if det >= 0.0 {
            return None;
        }
        let off = [(xy * gy - yy * gx) / det, (xy * gx - xx * gy) / det];
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        let at = plus([x as f64, y as f64], off);
        (length(off) < FAR).then_some(Self { at, light: [angle.cos(), angle.sin()] })
    }

    /// The strongest saddle within `radius` px of a point.
    pub(super) fn near(level: &Level, at: Point, radius: f64) -> Option<Self> {
        let (width, height) = (level.smooth.width(), level.smooth.height());
        let range = |at: f64, size: usize| {
            let end = |at: f64| at.clamp(1.0, size as f64 - 2.0) as usize;
            end((at - radius).ceil())..=end((at + radius).floor())
        };
        let pixels = range(at[1], height).flat_map(|y| range(at[0], width).map(move |x| (x, y)));
        let inside = pixels.filter(|(x, y)| distance([*x as f64, *y as f64], at) <= radius);
        let strength = |(x, y): (usize, usize)| level.saddle[y * width + x];
        let (x, y) = inside.max_by(|a, b| strength(*a).total_cmp(&strength(*b)))?;
        Self::at_pixel(level, x, y)
    }

    /// Whether it is lighter and darker twice around it.
    fn is_crossed(&self, image: &Image) -> bool {
        let sample = |index: usize| {
            let (sine, cosine) = (TAU * index as f64 / SAMPLES as f64).sin_cos();
            grey(image, plus(self.at, [RING * cosine, RING * sine]))
        };
        let ring: [f64; SAMPLES] = std::array::from_fn(sample);
        let mean = ring.iter().sum::<f64>() / SAMPLES as f64;
        (0..SAMPLES).filter(|index| (ring[*index] > mean) != (ring[(index + 1) % SAMPLES] > mean)).count() == 4
    }
}

/// The saddles of a level, the strongest first, to be looked up by place.
pub(crate) struct Saddles {
    pub all: Vec<Saddle>,
    /// The side of a cell, px.
    side: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<usize>>,
}

impl Saddles {
    pub(crate) fn of(level: &Level) -> Self {
        let (width, height) = (level.smooth.width() as f64, level.smooth.height() as f64);
        let all: Vec<Saddle> = strongest(level).into_iter().filter(|saddle| saddle.is_crossed(&level.smooth)).collect();
        let side = (IN_CELL * width * height / all.len().max(1) as f64).sqrt().max(CELL);
        let (columns, rows) = ((width / side) as usize + 1, (height / side) as usize + 1);
        let mut saddles = Self { all, side, columns, rows, cells: vec![Vec::new(); columns * rows] };
        for (index, saddle) in saddles.all.iter().enumerate() {
            let [column, row] = [saddles.cell(saddle.at[0], columns), saddles.cell(saddle.at[1], rows)];
            saddles.cells[row * columns + column].push(index);
        }
        saddles
    }

    fn cell(&self, at: f64, count: usize) -> usize {
        ((at / self.side).max(0.0) as usize).min(count - 1)
    }

    /// The saddles within `radius` px of a point, the nearest first.
    pub(super) fn within(&self, at: Point, radius: f64) -> Vec<usize> {
        let range = |at: f64, count: usize| self.cell(at - radius, count)..=self.cell(at + radius, count);
        let mut found: Vec<(f64, usize)> = Vec::new();
        for row in range(at[1], self.rows) {
            for column in range(at[0], self.columns) {
                let cell = self.cells[row * self.columns + column].iter();
                found.extend(cell.map(|index| (distance(self.all[*index].at, at), *index)).filter(|(far, _)| *far <= radius));
            }
        }
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.into_iter().map(|(_, index)| index).collect()
    }

    /// About `count` saddles nearest to one, the nearest first, without itself.
    pub(super) fn nearest(&self, of: usize, count: usize) -> Vec<usize> {
        let far = self.side * (self.columns + self.rows) as f64;
        let mut radius = self.side;
        loop {
            let mut found = self.within(self.all[of].at, radius);
            if found.len() > count || radius > far {
                found.retain(|index| *index != of);
                found.truncate(count);
                return found;
            }
            radius *= 1.6;
        }
    }
}

/// The strongest pixels among their neighbours, the strongest first.
fn strongest(level: &Level) -> Vec<Saddle> {
    let (width, height) = (level.smooth.width(), level.smooth.height());
    let least = SHARE * greatest(&level.saddle);
    let mut found = Vec::new();
    for y in 2..height.saturating_sub(2) {
        stop::point();
        let row = &level.saddle[y * width..(y + 1) * width];
        for x in 2..width - 2 {
            let own = row[x];
            if own > least && own > row[x - 1] && own >= row[x + 1] && is_peak(level, x, y) {
                found.push((own, x, y));
            }
        }
    }
    let order = |a: &(f32, usize, usize), b: &(f32, usize, usize)| b.0.total_cmp(&a.0).then((a.2, a.1).cmp(&(b.2, b.1)));
    if found.len() > MOST {
        found.select_nth_unstable_by(MOST, order);
        found.truncate(MOST);
    }
    found.sort_unstable_by(order);
    found.into_iter().filter_map(|(_, x, y)| Saddle::at_pixel(level, x, y)).collect()
}

/// In lanes, which a compiler turns into instructions that do many at once.
fn greatest(values: &[f32]) -> f32 {
    let mut lanes = [0.0_f32; 16];
    for chunk in values.chunks(16) {
        for (lane, value) in lanes.iter_mut().zip(chunk) {
            *lane = if *value > *lane { *value } else { *lane };
        }
    }
    lanes.into_iter().fold(0.0, f32::max)
}

/// Whether no pixel of the 5 x 5 around is stronger.
fn is_peak(level: &Level, x: usize, y: usize) -> bool {
    let width = level.smooth.width();
    let own = level.saddle[y * width + x];
    (y - 2..=y + 2).all(|row| level.saddle[row * width + x - 2..=row * width + x + 2].iter().all(|other| *other <= own))
}

/// Unit direction from one point to another, and how far; `None` for the same point.
pub(super) fn direction(from: Point, to: Point) -> Option<(Point, f64)> {
    let step = minus(to, from);
    let far = length(step);
    (far > 0.0).then(|| ([step[0] / far, step[1] / far], far))
}
