//! Kernels of 4 x 4 pixels and more: what takes the time.

use super::job::Job;
use crate::cell::{Run, SIDE};
use crate::kernel::step;
use crate::picture::Sample;

// Closures of any size would be compiled for the least of machines: in what follows there are none.

/// `CH` channels, `ROWS` x `ROWS` pixels, of which lines of `LANES` levels are read: `CH` times a power of two.
#[inline(always)]
pub(super) fn taps<T: Sample, const CH: usize, const ROWS: usize, const LANES: usize>(job: &Job<'_, T>, into: &mut [T]) {
    let (across, vertical) = (job.weights.across.of::<LANES>(), job.weights.down.of::<ROWS>());
    let (mut run, width, mut left) = (Run::EMPTY, job.width(), 0);
    let (mut sums, mut begins) = ([[0.0_f32; LANES]; SIDE], [0; SIDE]);
    let (before, stride) = ((ROWS / 2 - 1) as i32, job.picture.size.width as usize * CH);
    for cell in job.cells {
        let whole = job.window_of_cell::<CH>(cell, before, [LANES, ROWS]);
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
                job.window::<CH>(&run, before, [LANES, ROWS], &mut begins)
            };
            let (mut right, mut down) = ([(0, 0.0); SIDE], [(0, 0.0); SIDE]);
            for i in 0..SIDE {
                right[i] = step(run.right[i]);
                down[i] = step(run.down[i]);
            }
            for i in 0..SIDE {
                let mut lines = [[T::default(); LANES]; ROWS];
                match window {
                    Some(window) => copy(window, begins[i] as usize, stride, &mut lines),
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
                if whole.is_none() && !run.inside[i] {
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
