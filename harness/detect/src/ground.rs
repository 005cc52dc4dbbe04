//! What is dark and light around each part of an image.

use calibench_model::{Image, stop};

/// The side of a tile, px.
pub(crate) const TILE: usize = 8;
/// By how much the tiles of the next coarser level are larger.
const COARSER: usize = 4;
/// Levels: what is far from every edge is compared with the edges of a coarser one.
const LEVELS: usize = 4;
/// The least contrast that is none of noise, fraction of full scale; more where the image is noisy, up to the second.
const LEAST_CONTRAST: [f32; 2] = [0.04, 0.2];
/// A window whose contrast is below this share of that of the next coarser one lies within something dark or light.
const SHARE: f32 = 0.25;

/// The least and the greatest grey value of each tile, and around it.
pub(crate) struct Ground {
    /// Tiles in a row.
    pub columns: usize,
    /// Of a tile itself.
    pub own: Vec<[f32; 2]>,
    /// Of the smallest window around it that has contrast; `None` where none has.
    pub around: Vec<Option<[f32; 2]>>,
}

struct Tiles {
    columns: usize,
    rows: usize,
    extremes: Vec<[f32; 2]>,
}

const NONE: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

/// Written so that what is no number is left out.
fn merged(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [if b[0] < a[0] { b[0] } else { a[0] }, if b[1] > a[1] { b[1] } else { a[1] }]
}

impl Ground {
    pub(crate) fn new(image: &Image) -> Self {
        let tiles = Tiles::of(image);
        let least = least_contrast(&tiles.extremes);
        let mut levels = vec![tiles];
        while levels.len() < LEVELS {
            levels.push(levels[levels.len() - 1].coarser());
        }
        let mut windows: Option<(usize, Vec<Option<[f32; 2]>>)> = None;
        for level in levels.iter().rev() {
            windows = Some((level.columns, level.windows(windows.as_ref(), least)));
        }
        let around = windows.map_or_else(Vec::new, |(_, around)| around);
        let tiles = levels.swap_remove(0);
        Self { columns: tiles.columns, own: tiles.extremes, around }
    }
}

/// Twice the range of the quieter tiles: noise reaches about that far in a window.
pub(crate) fn least_contrast(extremes: &[[f32; 2]]) -> f32 {
    let mut ranges: Vec<f32> = extremes.iter().map(|[low, high]| high - low).filter(|range| range.is_finite()).collect();
    if ranges.is_empty() {
        return LEAST_CONTRAST[1];
    }
    let tenth = ranges.len() / 10;
    let (_, quiet, _) = ranges.select_nth_unstable_by(tenth, f32::total_cmp);
    (2.0 * *quiet).clamp(LEAST_CONTRAST[0], LEAST_CONTRAST[1])
}

impl Tiles {
    fn of(image: &Image) -> Self {
        let (width, height) = (image.width(), image.height());
        let (columns, rows) = (width.div_ceil(TILE), height.div_ceil(TILE));
        let mut extremes = Vec::with_capacity(columns * rows);
        let (mut low, mut high) = (vec![0.0_f32; width], vec![0.0_f32; width]);
        for row in 0..rows {
            stop::point();
            low.fill(NONE[0]);
            high.fill(NONE[1]);
            for y in row * TILE..height.min((row + 1) * TILE) {
                for ((low, high), grey) in low.iter_mut().zip(&mut high).zip(image.row(y)) {
                    [*low, *high] = merged([*low, *high], [*grey, *grey]);
                }
            }
            let pairs = low.chunks(TILE).zip(high.chunks(TILE));
            extremes.extend(pairs.map(|(low, high)| low.iter().zip(high).fold(NONE, |all, (l, h)| merged(all, [*l, *h]))));
        }
        Self { columns, rows, extremes }
    }

    fn coarser(&self) -> Self {
        let (columns, rows) = (self.columns.div_ceil(COARSER), self.rows.div_ceil(COARSER));
        let mut extremes = vec![NONE; columns * rows];
        for (index, own) in self.extremes.iter().enumerate() {
            let (column, row) = (index % self.columns, index / self.columns);
            let to = &mut extremes[row / COARSER * columns + column / COARSER];
            *to = merged(*to, *own);
        }
        Self { columns, rows, extremes }
    }

    /// The extremes of the 3 x 3 tiles around each.
    fn dilated(&self) -> Vec<[f32; 2]> {
        let line = |row: usize| &self.extremes[row * self.columns..(row + 1) * self.columns];
        let mut across = vec![NONE; self.extremes.len()];
        for row in 0..self.rows {
            let to = &mut across[row * self.columns..(row + 1) * self.columns];
            for (column, to) in to.iter_mut().enumerate() {
                let around = column.saturating_sub(1)..self.columns.min(column + 2);
                *to = line(row)[around].iter().fold(NONE, |all, own| merged(all, *own));
            }
        }
        let up = |index: usize| across[index.checked_sub(self.columns).unwrap_or(index)];
        let down = |index: usize| *across.get(index + self.columns).unwrap_or(&across[index]);
        (0..across.len()).map(|index| merged(merged(up(index), across[index]), down(index))).collect()
    }

    /// The window of each tile: its own or, where that lies within something dark or light, that of the coarser level.
    fn windows(&self, coarser: Option<&(usize, Vec<Option<[f32; 2]>>)>, least: f32) -> Vec<Option<[f32; 2]>> {
        let above = |index: usize| {
            let (columns, windows) = coarser?;
            windows[index / self.columns / COARSER * columns + index % self.columns / COARSER]
        };
        let choose = |(index, own): (usize, [f32; 2])| {
            let above = above(index);
            let enough = above.map_or(least, |[low, high]| (SHARE * (high - low)).max(least));
            if own[1] - own[0] >= enough { Some(own) } else { above }
        };
        self.dilated().into_iter().enumerate().map(choose).collect()
    }
}

/// The grey value at a point between pixels, by bilinear interpolation; beyond the image that of its border.
pub(crate) fn grey(image: &Image, [x, y]: [f64; 2]) -> f64 {
    let (width, height) = (image.width(), image.height());
    let inside = |at: f64, size: usize| at.clamp(0.0, (size - 1) as f64);
    let (x, y) = (inside(x, width), inside(y, height));
    let (column, row) = (x as usize, y as usize);
    let (s, t) = (x - column as f64, y - row as f64);
    let along = |[a, b]: [f32; 2]| (1.0 - s) * f64::from(a) + s * f64::from(b);
    let between = |upper: [f32; 2], lower: [f32; 2]| (1.0 - t) * along(upper) + t * along(lower);
    let pair = |row: usize| image.grey().get(row * width + column..)?.first_chunk().copied();
    if column + 1 < width
        && let (Some(upper), Some(lower)) = (pair(row), pair(row + 1))
    {
        return between(upper, lower);
    }
    let next = (column + 1).min(width - 1);
    let [upper, lower] = [row, (row + 1).min(height - 1)].map(|row| [image.at(column, row), image.at(next, row)]);
    between(upper, lower)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_has_contrast_where_an_edge_is_and_is_coarse_far_from_it() {
        let image = Image::from_fn(200, 100, |x, _| if x < 60 { 0.2 } else { 0.8 });
        let ground = Ground::new(&image);
        assert_eq!(ground.columns, 25);
        assert_eq!((ground.own[0], ground.own[7]), ([0.2, 0.2], [0.2, 0.8]));
        assert!(ground.around.iter().all(|window| *window == Some([0.2, 0.8])));
        let flat = Ground::new(&Image::from_fn(50, 50, |x, y| 0.5 + 0.004 * ((7 * x + 13 * y) % 5) as f32));
        assert!(flat.around.iter().all(Option::is_none));
    }

    #[test]
    fn grey_values_are_interpolated_and_end_at_the_border() {
        let image = Image::from_fn(4, 3, |x, y| (x + 10 * y) as f32);
        assert_eq!(grey(&image, [1.5, 0.5]), 6.5);
        assert_eq!((grey(&image, [-3.0, 0.0]), grey(&image, [9.0, 9.0])), (0.0, 23.0));
    }
}
