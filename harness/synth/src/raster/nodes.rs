//! Points of outlines at which integrals along them are taken.

use std::sync::LazyLock;

use calibench_model::quadrature::gauss_legendre;

use super::piece::{Piece, Quartic, at, slope};
use crate::optics::Part;

/// Nodes of one stretch of a piece, at most.
const MOST_NODES: usize = 32;

/// Rules of quadrature for every number of nodes.
pub(crate) struct Rules(Vec<Vec<(f64, f64)>>);

impl Rules {
    /// The rules, computed once.
    pub fn all() -> &'static Self {
        static RULES: LazyLock<Rules> = LazyLock::new(|| Rules((0..=MOST_NODES).map(gauss_legendre).collect()));
        &RULES
    }
}

/// A point of an outline, and how far the outline goes along there.
pub(super) struct Node {
    /// (x, y), px.
    pub at: [f64; 2],
    /// (dx, dy), px, times the contrast and the part's share of the light.
    pub along: [f64; 2],
}

/// Calls `take(part, node)` for all nodes of a piece that reach into the rows of `bounds`, for every part of the kernel.
#[inline(always)]
pub(super) fn each_node(piece: &Piece, sigma: f64, bounds: [f64; 2], parts: &[Part], rules: &Rules, mut take: impl FnMut(&Part, Node)) {
    let [x, y] = piece.polynomial();
    let needed = 1.4 * piece.length() / sigma + 3.0;
    let stretches = (needed / MOST_NODES as f64).ceil();
    let rule = &rules.0[(needed / stretches).ceil() as usize];
    let step = 1.0 / stretches;
    let bulge = beyond_chord(y, step);
    for part in parts {
        let reach = part.down.reach();
        let (low, high) = (bounds[0] - reach, bounds[1] + reach);
        for stretch in 0..stretches as usize {
            let start = stretch as f64 * step;
            // Most of a long piece may lie above or below.
            let [from, to] = [start, start + step].map(|t| at(y, t) + part.shift[1]);
            if from.max(to) + bulge <= low || from.min(to) - bulge >= high {
                continue;
            }
            for &(t, weight) in rule {
                let t = start + t * step;
                let at_y = at(y, t) + part.shift[1];
                if at_y <= low || at_y >= high {
                    continue;
                }
                let along = |polynomial: Quartic| weight * step * slope(polynomial, t) * piece.contrast * part.weight;
                take(part, Node { at: [at(x, t) + part.shift[0], at_y], along: [along(x), along(y)] });
            }
        }
    }
}

/// How far the polynomial leaves the range of its values at both ends of any stretch of `step` between 0 and 1, at most.
#[inline(always)]
fn beyond_chord([_, _, c2, c3, c4]: Quartic, step: f64) -> f64 {
    (2.0 * c2.abs() + 6.0 * c3.abs() + 12.0 * c4.abs()) * step * step / 8.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_polynomial_leaves_its_chord_further_than_is_said() {
        // Between equal values at both ends, of each power alone.
        for power in 2..=4 {
            let mut polynomial = [0.0, -1.0, 0.0, 0.0, 0.0];
            polynomial[power] = 1.0;
            let lowest = (0..=100).map(|i| at(polynomial, 0.01 * f64::from(i))).fold(0.0, f64::min);
            let said = beyond_chord(polynomial, 1.0);
            assert!(lowest < -0.2 && -lowest <= said + 1e-12, "{power}: {lowest}, {said}");
        }
        // Of half the length a quarter, wherever the stretch begins.
        let polynomial = [3.0, -4.0, 7.0, -5.0, 9.0];
        assert_eq!(beyond_chord(polynomial, 0.5), 0.25 * beyond_chord(polynomial, 1.0));
        for start in (0..=50).map(|i| 0.01 * f64::from(i)) {
            let [from, to] = [start, start + 0.5].map(|t| at(polynomial, t));
            let between = (0..=100).map(|i| at(polynomial, start + 0.005 * f64::from(i)));
            let said = beyond_chord(polynomial, 0.5);
            between.for_each(|y| assert!(y >= from.min(to) - said && y <= from.max(to) + said, "from {start}"));
        }
    }
}
