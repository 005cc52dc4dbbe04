//! What stands in a dark frame.

use calibench_model::Image;
use calibench_model::boards::Dictionary;

use crate::ground::grey;
use crate::plane::{Homography, Point, distance, mean};

/// How far beyond a frame it has to be light, cells.
const BEYOND: f64 = 0.35;
/// A cell is sampled in its middle and so far towards its corners, cells.
const SPREAD: f64 = 0.2;
/// The least contrast of a frame, fraction of full scale.
const CONTRAST: f64 = 0.03;

/// A marker's form: inner cells to a side, and how many cells wide the frame is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Form {
    pub side: usize,
    pub border: usize,
}

impl Form {
    /// Cells to a side, with the frame.
    pub(crate) const fn all(self) -> usize {
        self.side + 2 * self.border
    }
}

/// A dark frame with cells in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sight {
    /// Its corners, clockwise, px.
    pub corners: [Point; 4],
    /// Its cells from its first corner along its first side, row by row, as in a dictionary.
    pub cells: u64,
    /// Light less dark, fraction of full scale.
    pub contrast: f64,
}

impl Sight {
    pub(crate) fn middle(&self) -> Point {
        mean(&self.corners)
    }

    /// The length of its shortest side, px.
    pub(crate) fn least_side(&self) -> f64 {
        (0..4).map(|i| distance(self.corners[i], self.corners[(i + 1) % 4])).fold(f64::INFINITY, f64::min)
    }

    /// As it is read in a mirror: its corners in the mirrored image (x is -x), clockwise there, and its cells.
    pub(crate) fn mirrored(&self, side: usize) -> Self {
        let [a, b, c, d] = self.corners.map(|[x, y]| [-x, y]);
        let bit = |row: usize, column: usize| self.cells >> (side * side - 1 - (row * side + column)) & 1;
        let all = (0..side).flat_map(|row| (0..side).map(move |column| (row, column)));
        let cells = all.fold(0, |cells, (row, column)| cells << 1 | bit(row, side - 1 - column));
        Self { corners: [b, a, d, c], cells, ..*self }
    }

    /// The marker that it is: its id, wrong cells, and its corners in the marker's own order. About half of the wrong cells that leave it unmistakable are allowed:
    /// the more are, the more of what is no marker is taken for one.
    pub(crate) fn identify(&self, dictionary: &Dictionary) -> Option<(u32, u32, [Point; 4])> {
        let found = dictionary.identify(self.cells, dictionary.correctable * 3 / 5)?;
        let mut corners = self.corners;
        corners.rotate_left(found.turns as usize);
        Some((found.id, found.wrong, corners))
    }
}

/// The grey values at which dark turns to light, over the unit square.
struct Threshold {
    middle: f64,
    along: [f64; 2],
    contrast: f64,
}

impl Threshold {
    fn at(&self, [u, v]: Point) -> f64 {
        self.middle + self.along[0] * (u - 0.5) + self.along[1] * (v - 0.5)
    }
}

/// Reads the cells of a dark quadrangle; `None` if it has no frame of this form with light around it, or nothing in it.
pub(crate) fn read(image: &Image, corners: &[Point; 4], form: Form) -> Option<Sight> {
    let map = Homography::of_unit_square(*corners)?;
    let sampler = Sampler { image, map, all: form.all() };
    let threshold = sampler.threshold()?;
    let inner = form.border..form.border + form.side;
    let (mut cells, mut white_in_frame) = (0_u64, 0);
    for row in 0..form.all() {
        for column in 0..form.all() {
            let white = sampler.is_white(row, column, &threshold);
            if inner.contains(&row) && inner.contains(&column) {
                cells = cells << 1 | u64::from(white);
            } else {
                white_in_frame += usize::from(white);
            }
        }
    }
    let frame = form.all().pow(2) - form.side.pow(2);
    let full = (1_u64 << (form.side * form.side)) - 1;
    let good = white_in_frame <= frame / 16 && cells != 0 && cells != full;
    good.then_some(Sight { corners: *corners, cells, contrast: threshold.contrast })
}

struct Sampler<'a> {
    image: &'a Image<'a>,
    map: Homography,
    all: usize,
}

impl Sampler<'_> {
    fn grey(&self, at: Point) -> f64 {
        grey(self.image, self.map.at(at))
    }

    fn cell(&self, row: f64, column: f64) -> Point {
        [(column + 0.5) / self.all as f64, (row + 0.5) / self.all as f64]
    }

    fn is_white(&self, row: usize, column: usize, threshold: &Threshold) -> bool {
        let spots = [[0.0, 0.0], [-SPREAD, -SPREAD], [SPREAD, -SPREAD], [SPREAD, SPREAD], [-SPREAD, SPREAD]];
        let spots = spots.map(|[x, y]| self.cell(row as f64 + y, column as f64 + x));
        let over = spots.iter().map(|spot| self.grey(*spot) - threshold.at(*spot)).sum::<f64>();
        over > 0.0
    }

    /// From the dark frame and the light around it, side by side; `None` where one has no contrast or is not surrounded by light.
    fn threshold(&self) -> Option<Threshold> {
        let last = (self.all - 1) as f64;
        let (near, far) = (-0.5 - BEYOND, last + 0.5 + BEYOND);
        let places = || (0..self.all).map(|k| k as f64);
        let side = |at: &dyn Fn(f64, bool) -> Point| {
            let dark = places().map(|k| self.grey(at(k, false))).sum::<f64>() / self.all as f64;
            let light = places().map(|k| self.grey(at(k, true))).sum::<f64>() / self.all as f64;
            let middle = 0.5 * (dark + light);
            let dim = places().filter(|k| self.grey(at(*k, true)) < middle).count();
            (light - dark >= CONTRAST && dim * 5 <= self.all).then_some([middle, light - dark])
        };
        let top = side(&|k, out| self.cell(if out { near } else { 0.0 }, k))?;
        let bottom = side(&|k, out| self.cell(if out { far } else { last }, k))?;
        let left = side(&|k, out| self.cell(k, if out { near } else { 0.0 }))?;
        let right = side(&|k, out| self.cell(k, if out { far } else { last }))?;
        let mean = |i: usize| 0.25 * (top[i] + bottom[i] + left[i] + right[i]);
        Some(Threshold { middle: mean(0), along: [right[0] - left[0], bottom[0] - top[0]], contrast: mean(1) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Marker `id` upright at (20, 20), `cell` px to a cell.
    fn picture(dictionary: &Dictionary, id: u32, form: Form, cell: usize) -> Image<'static> {
        let size = 40 + form.all() * cell;
        Image::from_fn(size, size, |x, y| {
            let at = |x: usize| (x >= 20 && x < size - 20).then(|| (x - 20) / cell);
            let (Some(column), Some(row)) = (at(x), at(y)) else { return 0.9 };
            let inside = |k: usize| k.checked_sub(form.border).filter(|k| *k < form.side);
            let white = inside(row).zip(inside(column)).is_some_and(|(row, column)| dictionary.is_white(id, row, column) == Some(true));
            if white { 0.9 } else { 0.1 }
        })
    }

    #[test]
    fn cells_are_read_from_any_corner_and_in_a_mirror() {
        for (name, border) in [("DICT_4X4_50", 1), ("DICT_APRILTAG_36h11", 2), ("DICT_7X7_50", 1)] {
            let dictionary = Dictionary::named(name).unwrap();
            let form = Form { side: dictionary.side, border };
            let image = picture(dictionary, 7, form, 5);
            let (a, b) = (19.5, 19.5 + (5 * form.all()) as f64);
            let upright = [[a, a], [b, a], [b, b], [a, b]];
            for turn in 0..4 {
                let mut corners = upright;
                corners.rotate_left(turn);
                let sight = read(&image, &corners, form).unwrap();
                assert_eq!(sight.identify(dictionary), Some((7, 0, upright)), "{name} {turn}");
                let mirrored = sight.mirrored(form.side);
                assert_eq!(mirrored.mirrored(form.side).cells, sight.cells);
                assert_ne!(mirrored.identify(dictionary).map(|found| found.0), Some(7));
            }
        }
    }
}
