//! The coefficients of the spline through all pixels of a plane.

/// The poles of the quintic spline's filter within the unit circle: Unser 1999, "Splines: a perfect fit for signal and image processing", box 2.
const POLES: [f32; 2] = [-0.430_575_34, -0.043_096_29];
/// Pixels after which what lies beyond changes nothing: the first pole to this power is 2e-9.
pub(super) const MARGIN: usize = 24;
/// Lines that are filtered side by side.
const LINES: usize = 16;

/// Turns the levels of a plane into coefficients, mirrored at the middles of its outermost pixels.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
pub(super) fn filter(plane: &mut [f32], width: usize, height: usize) {
    down(plane, width, height);
    let mut turned = vec![0.0; width * LINES];
    for lines in plane.chunks_mut(width * LINES) {
        let count = lines.len() / width;
        for (line, levels) in lines.chunks_exact(width).enumerate() {
            for (column, level) in levels.iter().enumerate() {
                turned[column * LINES + line] = *level;
            }
        }
        down(&mut turned, LINES, width);
        for (line, levels) in lines.chunks_exact_mut(width).enumerate().take(count) {
            for (column, level) in levels.iter_mut().enumerate() {
                *level = turned[column * LINES + line];
            }
        }
    }
}

/// Along the columns of `width` x `height` levels.
#[inline(always)]
fn down(plane: &mut [f32], width: usize, height: usize) {
    if height < 2 {
        return;
    }
    for pole in POLES {
        first(plane, width, height, pole);
        for row in 1..height {
            let (before, here) = plane.split_at_mut(row * width);
            let above = &before[(row - 1) * width..];
            for (level, above) in here[..width].iter_mut().zip(above) {
                *level += pole * above;
            }
        }
        let (before, last) = plane.split_at_mut((height - 1) * width);
        let share = pole / (pole * pole - 1.0);
        for (level, above) in last.iter_mut().zip(&before[(height - 2) * width..]) {
            *level = share * (*level + pole * above);
        }
        for row in (0..height - 1).rev() {
            let (before, below) = plane.split_at_mut((row + 1) * width);
            for (level, below) in before[row * width..].iter_mut().zip(&below[..width]) {
                *level = pole * (below - *level);
            }
        }
        let gain = (1.0 - pole) * (1.0 - 1.0 / pole);
        plane.iter_mut().for_each(|level| *level *= gain);
    }
}

/// The first row of the filter downwards: all that lies above, mirrored, by falling powers of the pole.
#[inline(always)]
fn first(plane: &mut [f32], width: usize, height: usize, pole: f32) {
    let mut sums = plane[..width].to_vec();
    let mut power = 1.0;
    for row in 1..=MARGIN as i64 {
        power *= pole;
        let from = super::job::mirrored(row, height) * width;
        for (sum, level) in sums.iter_mut().zip(&plane[from..from + width]) {
            *sum += power * level;
        }
    }
    plane[..width].copy_from_slice(&sums);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Kernel;

    /// At the pixels the spline has their levels again.
    #[test]
    fn the_spline_goes_through_all_pixels() {
        for (width, height) in [(1, 1), (2, 1), (1, 3), (2, 2), (17, 40), (70, 33)] {
            let levels: Vec<f32> = (0..width * height).map(|i| ((i * i * 31 + 7 * i) % 256) as f32).collect();
            let mut plane = levels.clone();
            filter(&mut plane, width, height);
            let weights = Kernel::Spline.weights(0.0);
            let at = |x: i64, y: i64| {
                let line = |y: i64| -> f64 {
                    let of = |k: i64| {
                        f64::from(plane[super::super::job::mirrored(y, height) * width + super::super::job::mirrored(x + k - 2, width)])
                    };
                    (0..6).map(|k| weights[k as usize] * of(k)).sum()
                };
                (0..6).map(|k| weights[k as usize] * line(y + k - 2)).sum::<f64>()
            };
            for (i, level) in levels.iter().enumerate() {
                let found = at((i % width) as i64, (i / width) as i64);
                assert!((found - f64::from(*level)).abs() < 1e-3, "{width} x {height} at {i}: {found} {level}");
            }
        }
    }
}
