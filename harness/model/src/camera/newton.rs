//! Newton's method for two equations in two unknowns.

use super::NoCounterpart;

/// A value and its 2 x 2 derivatives, row by row.
pub(super) type ValueAndDerivatives = ([f64; 2], [[f64; 2]; 2]);

/// Steps at most; distortions of real lenses need four to six.
const MOST_STEPS: usize = 60;
/// A misclosure that counts as none, relative to the coordinates (at least 1): below 1e-9 px for any real camera.
const CLOSED: f64 = 1e-13;
/// A misclosure and a step after which one more step ends at the last bits, relative to the coordinates: its error is about the square of this.
const NEAR: f64 = 1e-8;

pub(super) fn determinant(d: [[f64; 2]; 2]) -> f64 {
    d[0][0] * d[1][1] - d[0][1] * d[1][0]
}

/// The solution of `f(x) = goal` from `start`, to the last bits: steps are halved until the residual falls, and the determinant stays positive, so
/// that no step ends beyond a fold.
pub(super) fn solve(goal: [f64; 2], start: [f64; 2], f: impl Fn([f64; 2]) -> ValueAndDerivatives) -> Result<[f64; 2], NoCounterpart> {
    // Squares, which order as the lengths do: `hypot` takes as long as a model's polynomial.
    let misclosure = |value: [f64; 2]| (goal[0] - value[0]).powi(2) + (goal[1] - value[1]).powi(2);
    let extent = goal[0].abs().max(goal[1].abs()).max(1.0);
    let (closed, near) = ((CLOSED * extent).powi(2), (NEAR * extent).powi(2));
    let mut x = start;
    let (mut value, mut slope) = f(x);
    let mut residual = misclosure(value);
    if !residual.is_finite() {
        return Err(NoCounterpart::NoSolution);
    }
    for _ in 0..MOST_STEPS {
        let det = determinant(slope);
        if det <= 0.0 {
            return Err(NoCounterpart::Fold);
        }
        let (rx, ry) = (goal[0] - value[0], goal[1] - value[1]);
        let step = [(slope[1][1] * rx - slope[0][1] * ry) / det, (slope[0][0] * ry - slope[1][0] * rx) / det];
        if residual <= near && step[0] * step[0] + step[1] * step[1] <= near {
            return Ok([x[0] + step[0], x[1] + step[1]]);
        }
        let mut share = 1.0;
        let better = loop {
            let next = [x[0] + share * step[0], x[1] + share * step[1]];
            let (next_value, next_slope) = f(next);
            let next_residual = misclosure(next_value);
            if determinant(next_slope) > 0.0 && next_residual < residual {
                break Some((next, next_value, next_slope, next_residual));
            }
            share *= 0.5;
            if share < 1e-6 || residual <= closed {
                break None;
            }
        };
        let Some(better) = better else { break };
        (x, value, slope, residual) = better;
    }
    // Nothing gets closer: rounding, or the edge of a fold.
    if residual <= closed { Ok(x) } else { Err(NoCounterpart::Fold) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x - x^3 / 3 folds at 1, where it is 2 / 3: a small misclosure says little there.
    #[test]
    fn beside_a_fold_solutions_are_as_good_as_their_misclosure() {
        let f = |[x, y]: [f64; 2]| ([x - x.powi(3) / 3.0, y], [[1.0 - x * x, 0.0], [0.0, 1.0]]);
        for off in [1e-1, 1e-3, 1e-5, 1e-6] {
            let wanted = 1.0 - off;
            let [x, y] = solve(f([wanted, 0.3]).0, [0.5, 0.0], f).unwrap();
            // The misclosure that counts as none, over the slope.
            assert!((x - wanted).abs() < 2.0 * CLOSED / off && (y - 0.3).abs() < 1e-15, "{off}: {x}");
        }
    }
}
