//! What loops over squares are given, and where its levels stand.

use calibench_model::camera::ImageSize;

use crate::cell::{Cell, Run, SIDE};
use crate::kernel::{Kernel, Table};
use crate::picture::{Picture, Sample};

/// Squares side by side, and what they are made from.
pub(super) struct Job<'a, T> {
    pub(super) cells: &'a [Cell],
    /// The size of the map's source.
    pub(super) source: ImageSize,
    /// The source, or a part of it that begins at `offset`.
    pub(super) picture: Picture<'a, T>,
    pub(super) offset: [i32; 2],
    pub(super) weights: &'a Weights,
}

/// What the pixels of a square ask for.
pub(super) struct Window<'a, T> {
    /// From the first level on.
    pub(super) levels: &'a [T],
    left: i32,
    top: i32,
}

impl<T> Window<'_, T> {
    /// Where the levels of each pixel of a run begin.
    #[inline(always)]
    pub(super) fn begins<const CH: usize>(&self, run: &Run, stride: usize, begins: &mut [u32; SIDE]) {
        for i in 0..SIDE {
            begins[i] = (run.row[i] - self.top) as u32 * stride as u32 + (run.column[i] - self.left) as u32 * CH as u32;
        }
    }
}

/// What a kernel needs, made once.
pub(super) struct Weights {
    /// Of columns, for each channel, and of rows.
    pub(super) across: Table,
    pub(super) down: Table,
}

impl Weights {
    pub(super) fn new(kernel: Kernel, channels: usize) -> Self {
        // Lines of a power of two.
        let across = Table::new(kernel, channels, kernel.taps().next_power_of_two() * channels);
        Self { across, down: Table::new(kernel, 1, kernel.taps()) }
    }
}

/// The index of a pixel in a line that is mirrored at the middles of its outermost pixels.
pub(super) fn mirrored(index: i64, count: usize) -> usize {
    let last = count.saturating_sub(1) as i64;
    if last == 0 {
        return 0;
    }
    let within = index.rem_euclid(2 * last);
    (if within > last { 2 * last - within } else { within }) as usize
}

impl<T: Sample> Job<'_, T> {
    /// Levels of a row from a column on, mirrored at the borders.
    #[inline(never)]
    pub(super) fn mirrored_line<const CH: usize>(&self, column: i32, row: i32, into: &mut [T]) {
        let ImageSize { width, height } = self.picture.size;
        let row = mirrored(i64::from(row), height as usize);
        let begin = row.wrapping_sub(self.picture.first).wrapping_mul(self.picture.stride());
        for (lane, into) in into.iter_mut().enumerate() {
            let column = mirrored(i64::from(column) + (lane / CH) as i64, width as usize);
            *into = self.picture.samples.get(begin.wrapping_add(column * CH + lane % CH)).copied().unwrap_or_default();
        }
    }

    /// Where the levels begin that the pixels of a run ask for: `before` of `rows` rows and columns above and to the left of each, in lines of `lanes` levels;
    /// from the first level of what is returned. `None` if some are beyond the border.
    #[inline(always)]
    pub(super) fn window<const CH: usize>(
        &self,
        run: &Run,
        before: i32,
        [lanes, rows]: [usize; 2],
        begins: &mut [u32; SIDE],
    ) -> Option<&[T]> {
        let mut bounds = [i32::MAX, i32::MIN, i32::MAX, i32::MIN];
        for i in 0..SIDE {
            let (column, row) = (run.column[i], run.row[i]);
            bounds[0] = if column < bounds[0] { column } else { bounds[0] };
            bounds[1] = if column > bounds[1] { column } else { bounds[1] };
            bounds[2] = if row < bounds[2] { row } else { bounds[2] };
            bounds[3] = if row > bounds[3] { row } else { bounds[3] };
        }
        let ([left, right, top, bottom], ImageSize { width, height }) = (bounds, self.picture.size);
        let (first, last) = (top - before, bottom - before + rows as i32);
        let stride = width as usize * CH;
        let is_held = left >= before && first >= 0 && last <= height as i32 && (right - before) as usize + lanes / CH <= width as usize;
        // Places are counted in 32 bits.
        if !is_held || (bottom - top + 1) as usize * stride > i32::MAX as usize {
            return None;
        }
        for i in 0..SIDE {
            begins[i] = (run.row[i] - top) as u32 * stride as u32 + (run.column[i] - left) as u32 * CH as u32;
        }
        let row = (first as usize).checked_sub(self.picture.first)?;
        self.picture.samples.get(row * stride + (left - before) as usize * CH..)
    }

    /// What the pixels of a square ask for that lies in the picture as a whole, as [`Self::window`] of a run; `None` where some is beyond the border, or is not there.
    #[inline(always)]
    pub(super) fn window_of_cell<const CH: usize>(&self, cell: &Cell, before: i32, [lanes, rows]: [usize; 2]) -> Option<Window<'_, T>> {
        if !cell.is_full() || !cell.is_smooth() {
            return None;
        }
        let ImageSize { width, height } = self.picture.size;
        let [left, right] = [cell.columns[0] - self.offset[0], cell.columns[1] - self.offset[0]];
        let [top, bottom] = [cell.rows[0] - self.offset[1], cell.rows[1] - self.offset[1]];
        let (first, last) = (top - before, bottom - before + rows as i32);
        let stride = width as usize * CH;
        let is_held = left >= before && first >= 0 && last <= height as i32 && (right - before) as usize + lanes / CH <= width as usize;
        // Places are counted in 32 bits.
        if !is_held || (bottom - top + 1) as usize * stride > i32::MAX as usize {
            return None;
        }
        let row = (first as usize).checked_sub(self.picture.first)?;
        let levels = self.picture.samples.get(row * stride + (left - before) as usize * CH..)?;
        Some(Window { levels, left, top })
    }

    /// Columns of all squares together.
    pub(super) fn width(&self) -> usize {
        self.cells.iter().map(|cell| cell.size[0]).sum()
    }

    /// The pixels of a row of a square all of which lie in the source and by polynomials; which lie inside is left as it is.
    #[inline(always)]
    pub(super) fn run_inside(&self, cell: &Cell, row: usize, run: &mut Run) {
        cell.run_inside(row, self.offset, run);
    }

    #[inline(always)]
    pub(super) fn run(&self, cell: &Cell, row: usize, shift: [f32; 2], run: &mut Run) {
        cell.run(row, shift, self.source, run);
        if self.offset != [0, 0] {
            for i in 0..SIDE {
                run.column[i] -= self.offset[0];
                run.row[i] -= self.offset[1];
            }
        }
    }
}
