//! A square of a map: where its pixels come from.

use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;

/// Pixels along a side.
pub(crate) const SIDE: usize = 32;
/// Polynomials through 4 x 4 exact places stand for a square if they are so near, px, to exact places between these, where they are worst.
const CLOSE: f64 = 2e-4;
/// Places along a side through which a polynomial goes, and those at which it is held against exact ones; from -1 to 1.
const NODES: [f64; 4] = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0];
const WORST: f64 = 0.745;
const CHECKS: [[f64; 2]; 5] = [[0.0, 0.0], [-WORST, -WORST], [WORST, -WORST], [-WORST, WORST], [WORST, WORST]];
/// Places further from the source than this are none, px.
const FAR: f64 = 1e6;

/// Where the pixels of a square come from, less `base`.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// Nowhere, or from outside of the source.
    Nothing,
    /// By powers of the place down: the coefficients of the powers of the place to the right, of x and then of y; both places from -1 to 1.
    Smooth([[f32; 8]; 4]),
    /// One by one, row by row; not-a-numbers where there is no ray.
    Single(Box<[[f32; 2]]>),
}

/// A square of a map.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    /// Columns and rows: [`SIDE`], or what is left at the border.
    pub(crate) size: [usize; 2],
    base: [i32; 2],
    pub(crate) shape: Shape,
    /// Pixels that come from the source.
    pub(crate) covered: usize,
    /// First and last columns and rows of the source, before rounding down, from which they come.
    pub(crate) columns: [i32; 2],
    pub(crate) rows: [i32; 2],
    /// The most that the source moves per pixel to the right, and down, px.
    pub(crate) stretch: [f32; 2],
}

/// Pixels of a row of a square.
pub(crate) struct Run {
    /// How many there are.
    pub(crate) count: usize,
    /// The pixels of the source at or before the places.
    pub(crate) column: [i32; SIDE],
    pub(crate) row: [i32; SIDE],
    /// How far behind them the places are, 0 to 1.
    pub(crate) right: [f32; SIDE],
    pub(crate) down: [f32; SIDE],
    /// Which of them lie in the source.
    pub(crate) inside: [bool; SIDE],
}

impl Run {
    pub(crate) const EMPTY: Self =
        Self { count: 0, column: [0; SIDE], row: [0; SIDE], right: [0.0; SIDE], down: [0.0; SIDE], inside: [false; SIDE] };

    /// Whether none of its pixels lies in the source.
    #[inline(never)]
    pub(crate) fn is_outside(&self) -> bool {
        let mut any = false;
        for i in 0..SIDE {
            any |= self.inside[i];
        }
        !any
    }
}

/// Monomials from values at [`NODES`].
fn coefficients([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [(9.0 * (b + c) - (a + d)) / 16.0, (27.0 * (c - b) + a - d) / 16.0, 9.0 * (a + d - b - c) / 16.0, 9.0 * (3.0 * (b - c) + d - a) / 16.0]
}

impl Cell {
    /// The square whose first pixel is `first`, of a map to `source` through `place`.
    pub(crate) fn new(first: [usize; 2], size: [usize; 2], source: ImageSize, place: &impl Fn(PixelPoint) -> Option<PixelPoint>) -> Self {
        let half = size.map(|count| 0.5 * (count.max(2) - 1) as f64);
        let near = |at: &PixelPoint| at.x.abs() < FAR && at.y.abs() < FAR;
        let exact = |[u, v]: [f64; 2]| {
            let at = PixelPoint::new(first[0] as f64 + half[0] * (1.0 + u), first[1] as f64 + half[1] * (1.0 + v));
            place(at).filter(near).map(|at| [at.x, at.y])
        };
        let nodes: [[Option<[f64; 2]>; 4]; 4] = NODES.map(|v| NODES.map(|u| exact([u, v])));
        let checks = CHECKS.map(exact);
        let known = nodes.iter().flatten().chain(&checks).flatten().count();
        let mut cell = Self { size, base: [0; 2], shape: Shape::Nothing, covered: 0, columns: [0; 2], rows: [0; 2], stretch: [0.0; 2] };
        if known == 0 {
            return cell;
        }
        match cell.smooth(&nodes, &checks) {
            Some(smooth) => cell.shape = smooth,
            None => {
                let all = (0..size[0] * size[1]).map(|i| {
                    let at = PixelPoint::new((first[0] + i % size[0]) as f64, (first[1] + i / size[0]) as f64);
                    place(at).filter(near)
                });
                let all: Vec<Option<PixelPoint>> = all.collect();
                // That nearest to the source's middle: what is far off, and less exact in single precision, lies outside of it.
                let middle = PixelPoint::new(0.5 * f64::from(source.width), 0.5 * f64::from(source.height));
                let nearest =
                    all.iter().flatten().min_by(|a, b| a.distance(middle).total_cmp(&b.distance(middle))).copied().unwrap_or_default();
                cell.base = [nearest.x.round() as i32, nearest.y.round() as i32];
                let less = |at: &PixelPoint| [(at.x - f64::from(cell.base[0])) as f32, (at.y - f64::from(cell.base[1])) as f32];
                cell.shape = Shape::Single(all.iter().map(|at| at.as_ref().map_or([f32::NAN; 2], less)).collect());
            }
        }
        cell.look(source);
        cell
    }

    /// The polynomials through the nodes, if they are close enough to the checks.
    fn smooth(&mut self, nodes: &[[Option<[f64; 2]>; 4]; 4], checks: &[Option<[f64; 2]>; 5]) -> Option<Shape> {
        let middle = checks[0]?;
        self.base = middle.map(|along| along.round() as i32);
        let mut shape = [[0.0_f32; 8]; 4];
        for axis in 0..2 {
            let mut along = [[0.0; 4]; 4];
            for (row, nodes) in along.iter_mut().zip(nodes) {
                let mut values = [0.0; 4];
                for (value, node) in values.iter_mut().zip(nodes) {
                    *value = (*node)?[axis] - f64::from(self.base[axis]);
                }
                *row = coefficients(values);
            }
            for power in 0..4 {
                let down = coefficients([along[0][power], along[1][power], along[2][power], along[3][power]]);
                for (line, value) in shape.iter_mut().zip(down) {
                    line[4 * axis + power] = value as f32;
                }
            }
        }
        for (at, exact) in CHECKS.iter().zip(checks) {
            let (exact, row) = ((*exact)?, row_of(&shape, at[1] as f32));
            for axis in 0..2 {
                let found = f64::from(polynomial(&row, 4 * axis, at[0] as f32)) + f64::from(self.base[axis]);
                let is_close = (found - exact[axis]).abs() <= CLOSE;
                if !is_close {
                    return None;
                }
            }
        }
        Some(Shape::Smooth(shape))
    }

    /// Whether all its pixels lie in the source.
    #[inline(always)]
    pub(crate) fn is_full(&self) -> bool {
        self.covered == self.size[0] * self.size[1]
    }

    /// Fills in what is known only from all places.
    fn look(&mut self, source: ImageSize) {
        let (mut run, mut before) = (Run::EMPTY, Run::EMPTY);
        let (mut columns, mut rows) = ([i32::MAX, i32::MIN], [i32::MAX, i32::MIN]);
        for row in 0..self.size[1] {
            self.run(row, [0.0; 2], source, &mut run);
            for i in (0..run.count).filter(|i| run.inside[*i]) {
                self.covered += 1;
                columns = [columns[0].min(run.column[i]), columns[1].max(run.column[i])];
                rows = [rows[0].min(run.row[i]), rows[1].max(run.row[i])];
                let place = |run: &Run, i: usize| [run.column[i] as f32 + run.right[i], run.row[i] as f32 + run.down[i]];
                let here = place(&run, i);
                let from = |other: [f32; 2]| (here[0] - other[0]).hypot(here[1] - other[1]);
                if i > 0 && run.inside[i - 1] {
                    self.stretch[0] = self.stretch[0].max(from(place(&run, i - 1)));
                }
                if row > 0 && before.inside[i] {
                    self.stretch[1] = self.stretch[1].max(from(place(&before, i)));
                }
            }
            std::mem::swap(&mut run, &mut before);
        }
        if self.covered == 0 {
            self.shape = Shape::Nothing;
        } else {
            (self.columns, self.rows) = (columns, rows);
        }
    }

    /// The pixels of row `row` of the square, each taken `shift` px to the right and down of its middle.
    #[inline(always)]
    pub(crate) fn run(&self, row: usize, shift: [f32; 2], source: ImageSize, run: &mut Run) {
        run.count = self.size[0];
        let (mut x, mut y) = ([f32::NAN; SIDE], [f32::NAN; SIDE]);
        match &self.shape {
            Shape::Nothing => {
                run.inside = [false; SIDE];
                return;
            }
            Shape::Smooth(shape) => {
                let across = 2.0 / (self.size[0].max(2) - 1) as f32;
                let line = self.line(shape, row as f32 + shift[1]);
                let begin = shift[0] * across - 1.0;
                for i in 0..SIDE {
                    let u = i as f32 * across + begin;
                    x[i] = polynomial(&line, 0, u);
                    y[i] = polynomial(&line, 4, u);
                }
            }
            Shape::Single(places) => self.single(places, row, shift, &mut x, &mut y),
        }
        let low = [-0.5 - self.base[0] as f32, -0.5 - self.base[1] as f32];
        let high = [low[0] + source.width as f32, low[1] + source.height as f32];
        for i in 0..SIDE {
            let inside = (x[i] >= low[0]) & (x[i] <= high[0]) & (y[i] >= low[1]) & (y[i] <= high[1]);
            let (place_x, place_y) = (if inside { x[i] } else { 0.0 }, if inside { y[i] } else { 0.0 });
            let ((column, right), (row, down)) = (parted(place_x), parted(place_y));
            run.column[i] = column + self.base[0];
            run.row[i] = row + self.base[1];
            run.right[i] = right;
            run.down[i] = down;
            run.inside[i] = inside;
        }
    }

    /// Whether polynomials stand for its places.
    #[inline(always)]
    pub(crate) fn is_smooth(&self) -> bool {
        matches!(self.shape, Shape::Smooth(_))
    }

    /// The pixels of row `row` of a square of polynomials all of whose pixels lie in the source, of which `offset` columns and rows are left out.
    #[inline(always)]
    pub(crate) fn run_inside(&self, row: usize, offset: [i32; 2], run: &mut Run) {
        let Shape::Smooth(shape) = &self.shape else { return };
        run.count = self.size[0];
        let across = 2.0 / (self.size[0].max(2) - 1) as f32;
        let line = self.line(shape, row as f32);
        for i in 0..SIDE {
            // Behind the last one there is none, wherever that would be.
            let u = if i < self.size[0] { i as f32 * across - 1.0 } else { 1.0 };
            let ((column, right), (row, down)) = (parted(polynomial(&line, 0, u)), parted(polynomial(&line, 4, u)));
            run.column[i] = column + self.base[0] - offset[0];
            run.row[i] = row + self.base[1] - offset[1];
            run.right[i] = right;
            run.down[i] = down;
        }
    }

    /// The coefficients of a row.
    #[inline(always)]
    fn line(&self, shape: &[[f32; 8]; 4], row: f32) -> [f32; 8] {
        let down = 2.0 / (self.size[1].max(2) - 1) as f32;
        row_of(shape, row * down - 1.0)
    }

    /// The places of a row of single ones.
    #[inline(never)]
    fn single(&self, places: &[[f32; 2]], row: usize, shift: [f32; 2], x: &mut [f32; SIDE], y: &mut [f32; SIDE]) {
        let line = &places[row * self.size[0]..(row + 1) * self.size[0]];
        for (i, at) in line.iter().enumerate() {
            let by = self.slopes(places, row, i);
            x[i] = at[0] + shift[0] * by[0][0] + shift[1] * by[1][0];
            y[i] = at[1] + shift[0] * by[0][1] + shift[1] * by[1][1];
        }
    }

    /// Differences of single places to those beside and below them, 0 where there are none.
    fn slopes(&self, places: &[[f32; 2]], row: usize, column: usize) -> [[f32; 2]; 2] {
        let [width, height] = self.size;
        let at = |row: usize, column: usize| places[row * width + column];
        let difference = |a: [f32; 2], b: [f32; 2]| {
            let by = [b[0] - a[0], b[1] - a[1]];
            if by[0].is_finite() && by[1].is_finite() { by } else { [0.0; 2] }
        };
        let (left, above) = (column.min(width.saturating_sub(2)), row.min(height.saturating_sub(2)));
        [
            if width > 1 { difference(at(row, left), at(row, left + 1)) } else { [0.0; 2] },
            if height > 1 { difference(at(above, column), at(above + 1, column)) } else { [0.0; 2] },
        ]
    }
}

/// What rounds a number of single precision below 2^22 when added: 1.5 * 2^23.
const ROUND: f32 = 12_582_912.0;

/// The whole number at or before another one, and how far behind it that is, 0 to 1. Neither a cast, which is taken apart into those of single numbers, nor
/// `floor`, which older machines call a function for.
#[inline(always)]
pub(crate) fn parted(value: f32) -> (i32, f32) {
    let shifted = value + ROUND;
    let (near, off) = (shifted.to_bits().wrapping_sub(ROUND.to_bits()) as i32, value - (shifted - ROUND));
    if off < 0.0 { (near - 1, off + 1.0) } else { (near, off) }
}

/// The coefficients of a row, `v` from -1 to 1.
#[inline(always)]
fn row_of([a, b, c, d]: &[[f32; 8]; 4], v: f32) -> [f32; 8] {
    let mut row = [0.0; 8];
    for i in 0..8 {
        row[i] = a[i] + v * (b[i] + v * (c[i] + v * d[i]));
    }
    row
}

#[inline(always)]
fn polynomial(row: &[f32; 8], first: usize, u: f32) -> f32 {
    row[first] + u * (row[first + 1] + u * (row[first + 2] + u * row[first + 3]))
}
