//! The squares of a band, pixel by pixel: what takes the time.

use calibench_model::camera::ImageSize;

use crate::cell::{Cell, Run, SIDE};
use crate::kernel::{Kernel, Table, step};
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

/// What a kernel needs, made once.
pub(super) struct Weights {
    /// Of columns, for each channel, and of rows.
    across: Table,
    down: Table,
}

impl Weights {
    pub(super) fn new(kernel: Kernel, channels: usize) -> Self {
        // Lines of a power of two.
        let across = Table::new(kernel, channels, kernel.taps().next_power_of_two() * channels);
        Self { across, down: Table::new(kernel, 1, kernel.taps()) }
    }
}

/// Fills rows of squares, as many as they have.
pub(super) type Squares<T> = fn(&Job<'_, T>, &mut [T]);

/// Levels for which there are loops.
pub trait Sampled: Sized {
    /// The loop of a kernel for so many channels, if there is one.
    #[expect(private_interfaces, reason = "nobody else can call it, nor need to")]
    fn squares(kernel: Kernel, channels: usize) -> Option<Squares<Self>>;
}

/// Channels of a pixel at most for which there are loops.
const CHANNELS: usize = 3;

macro_rules! loops {
    ($level:ty: $($name:ident = $inner:ident<$($number:literal),*>;)*) => {
        $(
            // The first target that the machine has is taken.
            #[cfg_attr(
                not(any(test, debug_assertions)),
                multiversion::multiversion(targets("x86_64+avx512f+avx512bw+avx512vl+avx512dq", "x86_64+avx2"))
            )]
            fn $name(job: &Job<'_, $level>, into: &mut [$level]) {
                $inner::<$level, $($number),*>(job, into);
            }
        )*
    };
}

macro_rules! sampled {
    ($level:ty, $module:ident) => {
        mod $module {
            use super::*;

            loops! {
                $level:
                linear_grey = linear<1, 1, 2>;
                linear_colour = linear<3, 4, 8>;
                area_grey = area<1>;
                area_colour = area<3>;
                cubic_grey = taps<1, 4, 4>;
                cubic_colour = taps<3, 4, 12>;
                lanczos3_grey = taps<1, 6, 8>;
                lanczos3_colour = taps<3, 6, 24>;
                lanczos4_grey = taps<1, 8, 8>;
                lanczos4_colour = taps<3, 8, 24>;
            }

            impl Sampled for $level {
                #[expect(private_interfaces, reason = "as in the trait")]
                fn squares(kernel: Kernel, channels: usize) -> Option<Squares<Self>> {
                    Some(match (kernel, channels) {
                        (Kernel::Linear, 1) => linear_grey,
                        (Kernel::Linear, 3) => linear_colour,
                        (Kernel::Area, 1) => area_grey,
                        (Kernel::Area, 3) => area_colour,
                        (Kernel::Cubic, 1) => cubic_grey,
                        (Kernel::Cubic, 3) => cubic_colour,
                        (Kernel::Lanczos3, 1) => lanczos3_grey,
                        (Kernel::Lanczos3, 3) => lanczos3_colour,
                        (Kernel::Lanczos4, 1) => lanczos4_grey,
                        (Kernel::Lanczos4, 3) => lanczos4_colour,
                        _ => return None,
                    })
                }
            }
        }
    };
}

sampled!(u8, bytes);
sampled!(u16, words);

loops! {
    f32:
    linear_plane = linear<1, 1, 2>;
    area_plane = area<1>;
    cubic_plane = taps<1, 4, 4>;
    six_plane = taps<1, 6, 8>;
    eight_plane = taps<1, 8, 8>;
}

impl Sampled for f32 {
    #[expect(private_interfaces, reason = "as in the trait")]
    fn squares(_: Kernel, _: usize) -> Option<Squares<Self>> {
        None
    }
}

/// The loop for a plane, which may hold the coefficients of a spline.
pub(super) fn of_plane(kernel: Kernel) -> Squares<f32> {
    match kernel {
        Kernel::Linear => linear_plane,
        Kernel::Area => area_plane,
        Kernel::Cubic => cubic_plane,
        Kernel::Lanczos3 | Kernel::Spline => six_plane,
        Kernel::Lanczos4 => eight_plane,
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
    fn mirrored_line<const CH: usize>(&self, column: i32, row: i32, into: &mut [T]) {
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
    fn window<const CH: usize>(&self, run: &Run, before: i32, [lanes, rows]: [usize; 2], begins: &mut [u32; SIDE]) -> Option<&[T]> {
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

    /// Columns of all squares together.
    fn width(&self) -> usize {
        self.cells.iter().map(|cell| cell.size[0]).sum()
    }

    #[inline(always)]
    fn run(&self, cell: &Cell, row: usize, shift: [f32; 2], run: &mut Run) {
        cell.run(row, shift, self.source, run);
        if self.offset != [0, 0] {
            for i in 0..SIDE {
                run.column[i] -= self.offset[0];
                run.row[i] -= self.offset[1];
            }
        }
    }
}

// Closures of any size would be compiled for the least of machines: in what follows there are none.

/// `CH` channels, `ROWS` x `ROWS` pixels, of which lines of `LANES` levels are read: `CH` times a power of two.
#[inline(always)]
fn taps<T: Sample, const CH: usize, const ROWS: usize, const LANES: usize>(job: &Job<'_, T>, into: &mut [T]) {
    let (across, vertical) = (job.weights.across.of::<LANES>(), job.weights.down.of::<ROWS>());
    let (mut run, width, mut left) = (Run::EMPTY, job.width(), 0);
    let (mut sums, mut begins) = ([[0.0_f32; LANES]; SIDE], [0; SIDE]);
    for cell in job.cells {
        for row in 0..cell.size[1] {
            let begin = (row * width + left) * CH;
            let Some(into) = into.get_mut(begin..begin + cell.size[0] * CH) else { return };
            job.run(cell, row, [0.0; 2], &mut run);
            if !cell.is_full() && run.is_outside() {
                into.fill(T::default());
                continue;
            }
            let (mut right, mut down) = ([(0, 0.0); SIDE], [(0, 0.0); SIDE]);
            for i in 0..SIDE {
                right[i] = step(run.right[i]);
                down[i] = step(run.down[i]);
            }
            let before = (ROWS / 2 - 1) as i32;
            let window = job.window::<CH>(&run, before, [LANES, ROWS], &mut begins);
            for i in 0..SIDE {
                let mut lines = [[T::default(); LANES]; ROWS];
                match window {
                    Some(window) => copy(window, begins[i] as usize, job.picture.size.width as usize * CH, &mut lines),
                    None if run.inside[i] && i < run.count => {
                        for (tap, line) in (0..).zip(&mut lines) {
                            job.mirrored_line::<CH>(run.column[i] - before, run.row[i] - before + tap, line);
                        }
                    }
                    None => {}
                }
                let (across, down) = (across.at(right[i]), vertical.at(down[i]));
                let mut here = [0.0_f32; LANES];
                for tap in 0..ROWS {
                    for lane in 0..LANES {
                        here[lane] += down[tap] * lines[tap][lane].to_f32();
                    }
                }
                for lane in 0..LANES {
                    sums[i][lane] = here[lane] * across[lane];
                }
            }
            // Of runs that are inside as a whole nothing is to be left out.
            for i in 0..SIDE {
                if !run.inside[i] {
                    sums[i] = [0.0; LANES];
                }
            }
            let into = into.as_chunks_mut::<CH>().0;
            for i in 0..into.len().min(SIDE) {
                let mut half = LANES / 2;
                let mut sums = sums[i];
                while half >= CH {
                    for lane in 0..half {
                        sums[lane] += sums[lane + half];
                    }
                    half /= 2;
                }
                for channel in 0..CH {
                    into[i][channel] = T::of_f32(sums[channel]);
                }
            }
        }
        left += cell.size[0];
    }
}

/// Copies the lines that begin at `begin` and in the rows below.
#[inline(always)]
fn copy<T: Copy, const ROWS: usize, const LANES: usize>(window: &[T], begin: usize, stride: usize, lines: &mut [[T; LANES]; ROWS]) {
    let Some(window) = window.get(begin..begin + (ROWS - 1) * stride + LANES) else { return };
    for tap in 0..ROWS {
        if let Some(line) = window.get(tap * stride..tap * stride + LANES).and_then(<[T]>::first_chunk) {
            lines[tap] = *line;
        }
    }
}

/// The 2 x 2 pixels around each place, in `LANES` levels a pixel, `CH` of which are its channels; lines of `BOTH` levels hold a pixel and that beside it.
#[inline(always)]
fn linear<T: Sample, const CH: usize, const LANES: usize, const BOTH: usize>(job: &Job<'_, T>, into: &mut [T]) {
    let (mut run, width, mut left) = (Run::EMPTY, job.width(), 0);
    let (stride, mut begins) = (job.picture.size.width as usize * CH, [0; SIDE]);
    let mut lines = [[[T::default(); BOTH]; SIDE]; 2];
    for cell in job.cells {
        for row in 0..cell.size[1] {
            let begin = (row * width + left) * CH;
            let Some(into) = into.get_mut(begin..begin + cell.size[0] * CH) else { return };
            job.run(cell, row, [0.0; 2], &mut run);
            if !cell.is_full() && run.is_outside() {
                into.fill(T::default());
                continue;
            }
            if let Some(window) = job.window::<CH>(&run, 0, [BOTH.next_multiple_of(CH), 2], &mut begins) {
                for i in 0..SIDE {
                    let begin = begins[i] as usize;
                    if let Some(window) = window.get(begin..begin + stride + BOTH) {
                        let below = window.last_chunk::<BOTH>();
                        if let (Some(above), Some(below)) = (window.first_chunk::<BOTH>(), below) {
                            lines[0][i] = *above;
                            lines[1][i] = *below;
                        }
                    }
                }
            } else {
                lines_at_border::<T, CH, BOTH>(job, &run, &mut lines);
            }
            let mut found = [[T::default(); LANES]; SIDE];
            for i in 0..SIDE {
                for lane in 0..LANES {
                    let [a, b] = [lines[0][i][lane].to_f32(), lines[0][i][lane + CH].to_f32()];
                    let [c, d] = [lines[1][i][lane].to_f32(), lines[1][i][lane + CH].to_f32()];
                    let (above, below) = (a + run.right[i] * (b - a), c + run.right[i] * (d - c));
                    found[i][lane] = T::of_f32(above + run.down[i] * (below - above));
                }
            }
            if !cell.is_full() {
                for i in 0..SIDE {
                    if !run.inside[i] {
                        found[i] = [T::default(); LANES];
                    }
                }
            }
            let into = into.as_chunks_mut::<CH>().0;
            for i in 0..into.len().min(SIDE) {
                if let Some(found) = found[i].first_chunk() {
                    into[i] = *found;
                }
            }
        }
        left += cell.size[0];
    }
}

#[inline(never)]
fn lines_at_border<T: Sample, const CH: usize, const BOTH: usize>(job: &Job<'_, T>, run: &Run, lines: &mut [[[T; BOTH]; SIDE]; 2]) {
    for i in (0..run.count.min(SIDE)).filter(|i| run.inside[*i]) {
        for (row, lines) in (run.row[i]..).zip(lines.iter_mut()) {
            job.mirrored_line::<CH>(run.column[i], row, &mut lines[i]);
        }
    }
}

/// The 2 x 2 pixels around each place of a run, channel by channel.
struct Corners<T>([[[T; SIDE]; 4]; CHANNELS]);

/// Means over the area of a pixel where the picture shrinks, and of 2 x 2 pixels elsewhere.
#[inline(always)]
fn area<T: Sample, const CH: usize>(job: &Job<'_, T>, into: &mut [T]) {
    let (mut run, width, mut left) = (Run::EMPTY, job.width(), 0);
    let mut corners = Corners([[[T::default(); SIDE]; 4]; CHANNELS]);
    for cell in job.cells {
        for row in 0..cell.size[1] {
            let begin = (row * width + left) * CH;
            let Some(into) = into.get_mut(begin..begin + cell.size[0] * CH) else { return };
            job.run(cell, row, [0.0; 2], &mut run);
            if !cell.is_full() && run.is_outside() {
                into.fill(T::default());
                continue;
            }
            let mut levels = [[0.0_f32; SIDE]; CHANNELS];
            gather::<T, CH>(job, &run, &mut corners);
            for channel in 0..CH {
                mix(&corners.0[channel], &run, &mut levels[channel]);
            }
            mean::<T, CH>(job, cell, row, &run.inside, &mut corners, &mut levels);
            let mut found = [[T::default(); SIDE]; CHANNELS];
            for channel in 0..CH {
                for i in 0..SIDE {
                    let level = if run.inside[i] { levels[channel][i] } else { 0.0 };
                    found[channel][i] = T::of_f32(level);
                }
            }
            let into = into.as_chunks_mut::<CH>().0;
            for i in 0..into.len().min(SIDE) {
                for channel in 0..CH {
                    into[i][channel] = found[channel][i];
                }
            }
        }
        left += cell.size[0];
    }
}

#[inline(always)]
fn gather<T: Sample, const CH: usize>(job: &Job<'_, T>, run: &Run, corners: &mut Corners<T>) {
    let (stride, mut begins) = (job.picture.size.width as usize * CH, [0; SIDE]);
    let window = job.window::<CH>(run, 0, [2 * CH, 2], &mut begins);
    let Some(window) = window else { return gather_at_border::<T, CH>(job, run, corners) };
    for i in 0..SIDE {
        let begin = begins[i] as usize;
        if let Some(window) = window.get(begin..begin + stride + 2 * CH) {
            let below = &window[window.len() - 2 * CH..];
            for channel in 0..CH {
                let of = &mut corners.0[channel];
                of[0][i] = window[channel];
                of[1][i] = window[CH + channel];
                of[2][i] = below[channel];
                of[3][i] = below[CH + channel];
            }
        }
    }
}

#[inline(never)]
fn gather_at_border<T: Sample, const CH: usize>(job: &Job<'_, T>, run: &Run, corners: &mut Corners<T>) {
    for i in (0..run.count.min(SIDE)).filter(|i| run.inside[*i]) {
        for line in 0..2 {
            let mut two = [[T::default(); CH]; 2];
            job.mirrored_line::<CH>(run.column[i], run.row[i] + line as i32, two.as_flattened_mut());
            for channel in 0..CH {
                corners.0[channel][2 * line][i] = two[0][channel];
                corners.0[channel][2 * line + 1][i] = two[1][channel];
            }
        }
    }
}

#[inline(always)]
fn mix<T: Sample>([a, b, c, d]: &[[T; SIDE]; 4], run: &Run, into: &mut [f32; SIDE]) {
    for i in 0..SIDE {
        let above = a[i].to_f32() + run.right[i] * (b[i].to_f32() - a[i].to_f32());
        let below = c[i].to_f32() + run.right[i] * (d[i].to_f32() - c[i].to_f32());
        into[i] = above + run.down[i] * (below - above);
    }
}

/// Puts means over the area of a pixel in the place of its middle's levels, where the picture shrinks.
#[inline(never)]
fn mean<T: Sample, const CH: usize>(
    job: &Job<'_, T>,
    cell: &Cell,
    row: usize,
    inside: &[bool; SIDE],
    corners: &mut Corners<T>,
    levels: &mut [[f32; SIDE]; CHANNELS],
) {
    let [across, down] = cell.stretch.map(places);
    if across.len() * down.len() == 1 {
        return;
    }
    let (mut sums, mut count) = ([[0.0_f32; SIDE]; CHANNELS], [0.0_f32; SIDE]);
    let mut run = Run::EMPTY;
    for v in &down {
        for u in &across {
            job.run(cell, row, [*u, *v], &mut run);
            gather::<T, CH>(job, &run, corners);
            for channel in 0..CH {
                let mut here = [0.0; SIDE];
                mix(&corners.0[channel], &run, &mut here);
                for i in 0..SIDE {
                    sums[channel][i] += if run.inside[i] { here[i] } else { 0.0 };
                }
            }
            for i in 0..SIDE {
                count[i] += f32::from(u8::from(run.inside[i]));
            }
        }
    }
    for channel in 0..CH {
        for i in (0..SIDE).filter(|i| inside[*i] && count[*i] > 0.0) {
            levels[channel][i] = sums[channel][i] / count[i];
        }
    }
}

/// Places along a side of a pixel, from its middle, whose mean stands for the mean over it, where the source moves by `stretch` px from one pixel to the
/// next. Linear interpolation is a mean over about a pixel of the source itself: the places spread so far that both together are as wide as the pixel.
fn places(stretch: f32) -> Vec<f32> {
    if stretch <= 1.0 {
        return vec![0.0];
    }
    let width = (1.0 - 1.0 / (stretch * stretch)).sqrt();
    let count = (2.0 * stretch * width).ceil().clamp(2.0, 64.0);
    (0..count as usize).map(|i| width * ((i as f32 + 0.5) / count - 0.5)).collect()
}
