//! What tells the squares of a coded field apart.

use crate::testfield::PlatePoint;

/// The code of a square from the places of its large pairs: squares, triangles, crosses, discs, in either order within a pair.
///
/// Bit 0 is set if the segment between the squares crosses that between the triangles, bit 1 for squares and crosses, bit 2 for squares and discs, bit 3 for
/// triangles and crosses, bit 4 for triangles and discs, bit 5 for crosses and discs. Turning the field, and any perspective view, leaves it as it is; so does
/// a mirror.
///
/// Source: Vosselman & Förstner 1988, section 3.3.
pub fn code(large: &[[PlatePoint; 2]; 4]) -> u8 {
    let pairs = (0..4).flat_map(|i| (i + 1..4).map(move |j| (i, j)));
    pairs.enumerate().map(|(bit, (i, j))| u8::from(cross(large[i], large[j])) << bit).sum()
}

fn cross([a, b]: [PlatePoint; 2], [c, d]: [PlatePoint; 2]) -> bool {
    let side = |p: PlatePoint, q: PlatePoint, r: PlatePoint| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0.0;
    side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_bit_is_a_pair_of_segments_that_cross() {
        let apart = |i: f64| [[10.0 * i, 0.0], [10.0 * i + 1.0, 1.0]];
        let none = [apart(0.0), apart(1.0), apart(2.0), apart(3.0)];
        assert_eq!(code(&none), 0);
        for (bit, (i, j)) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)].into_iter().enumerate() {
            let mut large = none;
            let [[x, y], _] = large[i];
            large[j] = [[x, y + 1.0], [x + 1.0, y]];
            assert_eq!(code(&large), 1 << bit, "{i} and {j}");
        }
    }

    #[test]
    fn a_segment_that_ends_before_another_does_not_cross_it() {
        let far = [[50.0, 50.0], [51.0, 51.0]];
        let large = [[[0.0, 0.0], [1.0, 1.0]], [[3.0, 1.0], [1.0, 3.0]], far, [[70.0, 0.0], [71.0, 0.0]]];
        assert_eq!(code(&large), 0);
    }
}
