//! Of 2 x 2 pixels: linear interpolation, and means over areas.

use super::job::Job;
use crate::cell::{Cell, Run, SIDE};
use crate::picture::Sample;

/// Channels of a pixel at most for which there are loops.
const CHANNELS: usize = 3;

/// The 2 x 2 pixels around each place, in `LANES` levels a pixel, `CH` of which are its channels; lines of `BOTH` levels hold a pixel and that beside it.
#[inline(always)]
pub(super) fn linear<T: Sample, const CH: usize, const LANES: usize, const BOTH: usize>(job: &Job<'_, T>, into: &mut [T]) {
    let (mut run, width, mut left) = (Run::EMPTY, job.width(), 0);
    let (stride, mut begins) = (job.picture.size.width as usize * CH, [0; SIDE]);
    let mut lines = [[[T::default(); BOTH]; SIDE]; 2];
    for cell in job.cells {
        let whole = job.window_of_cell::<CH>(cell, 0, [BOTH.next_multiple_of(CH), 2]);
        for row in 0..cell.size[1] {
            let begin = (row * width + left) * CH;
            let Some(into) = into.get_mut(begin..begin + cell.size[0] * CH) else { return };
            let window = if let Some(whole) = &whole {
                job.run_inside(cell, row, &mut run);
                whole.begins::<CH>(&run, stride, &mut begins);
                Some(whole.levels)
            } else {
                job.run(cell, row, [0.0; 2], &mut run);
                if !cell.is_full() && run.is_outside() {
                    into.fill(T::default());
                    continue;
                }
                job.window::<CH>(&run, 0, [BOTH.next_multiple_of(CH), 2], &mut begins)
            };
            if let Some(window) = window {
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

/// As [`linear`], channel by channel, which is faster where there are several.
#[inline(always)]
pub(super) fn linear_by_channels<T: Sample, const CH: usize>(job: &Job<'_, T>, into: &mut [T]) {
    by_channels::<T, CH, false>(job, into);
}

/// Means over the area of a pixel where the picture shrinks, and of 2 x 2 pixels elsewhere.
#[inline(always)]
pub(super) fn area<T: Sample, const CH: usize>(job: &Job<'_, T>, into: &mut [T]) {
    by_channels::<T, CH, true>(job, into);
}

#[inline(always)]
fn by_channels<T: Sample, const CH: usize, const IS_AREA: bool>(job: &Job<'_, T>, into: &mut [T]) {
    let (mut run, width, mut left) = (Run::EMPTY, job.width(), 0);
    let (stride, mut begins) = (job.picture.size.width as usize * CH, [0; SIDE]);
    let mut corners = Corners([[[T::default(); SIDE]; 4]; CHANNELS]);
    for cell in job.cells {
        let whole = job.window_of_cell::<CH>(cell, 0, [2 * CH, 2]);
        for row in 0..cell.size[1] {
            let begin = (row * width + left) * CH;
            let Some(into) = into.get_mut(begin..begin + cell.size[0] * CH) else { return };
            if let Some(whole) = &whole {
                job.run_inside(cell, row, &mut run);
                whole.begins::<CH>(&run, stride, &mut begins);
                gather_within::<T, CH>(whole.levels, stride, &begins, &mut corners);
            } else {
                job.run(cell, row, [0.0; 2], &mut run);
                if !cell.is_full() && run.is_outside() {
                    into.fill(T::default());
                    continue;
                }
                gather::<T, CH>(job, &run, &mut corners);
            }
            let mut levels = [[0.0_f32; SIDE]; CHANNELS];
            for channel in 0..CH {
                mix(&corners.0[channel], &run, &mut levels[channel]);
            }
            if IS_AREA {
                mean::<T, CH>(job, cell, row, &mut corners, &mut levels);
            }
            let mut found = [[T::default(); SIDE]; CHANNELS];
            for channel in 0..CH {
                for i in 0..SIDE {
                    found[channel][i] = T::of_f32(levels[channel][i]);
                }
            }
            if whole.is_none() {
                for channel in 0..CH {
                    for i in 0..SIDE {
                        found[channel][i] = if run.inside[i] { found[channel][i] } else { T::default() };
                    }
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
    match window {
        Some(window) => gather_within::<T, CH>(window, stride, &begins, corners),
        None => gather_at_border::<T, CH>(job, run, corners),
    }
}

#[inline(always)]
fn gather_within<T: Sample, const CH: usize>(window: &[T], stride: usize, begins: &[u32; SIDE], corners: &mut Corners<T>) {
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
        for i in (0..SIDE).filter(|i| count[*i] > 0.0) {
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
