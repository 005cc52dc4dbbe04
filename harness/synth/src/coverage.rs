//! Exact area coverage of a polygon: signed areas, accumulated edge by edge.
//!
//! An edge changes the area to its right in every row that it crosses. What it adds to a pixel is the signed area between the edge and the
//! pixel's right side; everything further right gets the full height crossed. Writing the two as differences along the row makes the
//! cost that of the edge's length, and one prefix sum turns them into coverage. Nothing is sampled: the only error is rounding.

use calibench_model::{CornerPoint, Polygon};

/// The covered fraction of every pixel, row by row, for one polygon: in [0, 1] up to rounding (about 1e-13).
///
/// `width` and `height` in px. Parts of the polygon outside the image are clipped. The sense of rotation does not matter.
pub fn coverage(polygon: &Polygon, width: usize, height: usize) -> Vec<f64> {
    let mut accumulator = Accumulator::new(width, height);
    for (from, to) in polygon.edges() {
        accumulator.edge(from.to_corner(), to.to_corner());
    }
    // Positive for an edge that runs down on the polygon's left: opposite to the sense of the doubled area.
    accumulator.into_coverage(-polygon.doubled_area().signum())
}

/// 1 for every pixel whose centre lies in the polygon and 0 for every other, row by row: how programs draw that know no partial coverage.
///
/// A centre on an edge counts for the polygon to its right or below.
pub fn centres(polygon: &Polygon, width: usize, height: usize) -> Vec<f64> {
    let mut covered = vec![0.0; width * height];
    for (y, row) in covered.chunks_exact_mut(width).enumerate() {
        let y = y as f64;
        let crossed = polygon.edges().filter(|(a, b)| (a.y <= y) != (b.y <= y));
        let mut crossings: Vec<f64> = crossed.map(|(a, b)| a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y)).collect();
        crossings.sort_by(f64::total_cmp);
        for inside in crossings.chunks_exact(2) {
            let column = |x: f64| x.ceil().clamp(0.0, width as f64) as usize;
            row[column(inside[0])..column(inside[1])].fill(1.0);
        }
    }
    covered
}

/// Differences of coverage along each row; one spare column takes what falls off the right side.
struct Accumulator {
    width: usize,
    height: usize,
    differences: Vec<f64>,
}

impl Accumulator {
    fn new(width: usize, height: usize) -> Self {
        Self { width, height, differences: vec![0.0; (width + 2) * height] }
    }

    fn edge(&mut self, from: CornerPoint, to: CornerPoint) {
        if from.y == to.y {
            return;
        }
        let (sign, top, bottom) = if from.y < to.y { (1.0, from, to) } else { (-1.0, to, from) };
        let slope = (bottom.x - top.x) / (bottom.y - top.y);
        // Interpolated from the nearer end, so that an edge ends exactly where its vertex is.
        let x_at = |y: f64| if y - top.y < bottom.y - y { top.x + (y - top.y) * slope } else { bottom.x - (bottom.y - y) * slope };
        let first = top.y.max(0.0).floor() as usize;
        let end = (bottom.y.min(self.height as f64).ceil().max(0.0)) as usize;
        for row in first..end.min(self.height) {
            let y0 = top.y.max(row as f64);
            let y1 = bottom.y.min((row + 1) as f64);
            if y1 > y0 {
                self.segment(row, sign * (y1 - y0), x_at(y0), x_at(y1));
            }
        }
    }

    /// A piece of an edge inside one row: it crosses the signed height `rise` between `x0` and `x1`.
    fn segment(&mut self, row: usize, rise: f64, x0: f64, x1: f64) {
        let right = self.width as f64;
        let (low, high) = if x0 < x1 { (x0, x1) } else { (x1, x0) };
        if high <= 0.0 || low >= right || high - low == 0.0 {
            return self.vertical(row, rise, low.clamp(0.0, right));
        }
        let per_px = rise / (high - low);
        if low < 0.0 {
            self.vertical(row, -low * per_px, 0.0);
        }
        if high > right {
            self.vertical(row, (high - right) * per_px, right);
        }
        let (low, high) = (low.max(0.0), high.min(right));
        let mut x = low;
        while x < high {
            let next = (x.floor() + 1.0).min(high);
            self.vertical(row, (next - x) * per_px, 0.5 * (x + next));
            x = next;
        }
    }

    /// The signed height `rise` at mean position `x`, inside one pixel: its area is that of a vertical edge there.
    fn vertical(&mut self, row: usize, rise: f64, x: f64) {
        let column = (x.floor() as usize).min(self.width);
        let inside = (column + 1) as f64 - x;
        let start = row * (self.width + 2) + column;
        self.differences[start] += rise * inside;
        self.differences[start + 1] += rise * (1.0 - inside);
    }

    fn into_coverage(self, sign: f64) -> Vec<f64> {
        let mut covered = Vec::with_capacity(self.width * self.height);
        for row in self.differences.chunks_exact(self.width + 2) {
            let mut sum = 0.0;
            covered.extend(row[..self.width].iter().map(|difference| {
                sum += difference;
                (sign * sum).clamp(0.0, 1.0)
            }));
        }
        covered
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_model::PixelPoint;
    use proptest::prelude::*;

    fn polygon(vertices: &[(f64, f64)]) -> Polygon {
        Polygon { id: "p".into(), grey: 1.0, vertices: vertices.iter().map(|&(x, y)| PixelPoint::new(x, y)).collect() }
    }

    /// The second method: the polygon clipped to the pixel's square (Sutherland and Hodgman), its area by the shoelace formula.
    fn clipped_area(polygon: &Polygon, column: usize, row: usize) -> f64 {
        let (left, top) = (column as f64 - 0.5, row as f64 - 0.5);
        let mut vertices: Vec<(f64, f64)> = polygon.vertices.iter().map(|v| (v.x - left, v.y - top)).collect();
        let sides: [fn((f64, f64)) -> f64; 4] = [|p| p.0, |p| 1.0 - p.0, |p| p.1, |p| 1.0 - p.1];
        for side in sides {
            let mut kept = Vec::new();
            for i in 0..vertices.len() {
                let (p, q) = (vertices[i], vertices[(i + 1) % vertices.len()]);
                let (dp, dq) = (side(p), side(q));
                if dp >= 0.0 {
                    kept.push(p);
                }
                if dp * dq < 0.0 {
                    let t = dp / (dp - dq);
                    kept.push((p.0 + t * (q.0 - p.0), p.1 + t * (q.1 - p.1)));
                }
            }
            vertices = kept;
        }
        let n = vertices.len();
        let doubled: f64 = (0..n).map(|i| vertices[i].0 * vertices[(i + 1) % n].1 - vertices[(i + 1) % n].0 * vertices[i].1).sum();
        doubled.abs() / 2.0
    }

    fn worst_error(polygon: &Polygon, width: usize, height: usize) -> f64 {
        let covered = coverage(polygon, width, height);
        let errors = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        errors.map(|(x, y)| (covered[y * width + x] - clipped_area(polygon, x, y)).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn half_pixels_and_diagonals_by_hand() {
        // The square [0.25, 2] x [0, 1.5] in pixel coordinates: columns 0 to 2, rows 0 to 1 in part.
        let covered = coverage(&polygon(&[(0.25, 0.0), (2.0, 0.0), (2.0, 1.5), (0.25, 1.5)]), 4, 3);
        let expected = [0.125, 0.5, 0.25, 0.0, 0.25, 1.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert!(covered.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{covered:?}");
        // A diagonal through pixel corners halves the pixels that it crosses.
        let covered = coverage(&polygon(&[(-0.5, -0.5), (2.5, 2.5), (-0.5, 2.5)]), 3, 3);
        assert_eq!(covered, [0.5, 0.0, 0.0, 1.0, 0.5, 0.0, 1.0, 1.0, 0.5]);
    }

    #[test]
    fn parts_outside_the_image_are_clipped() {
        for vertices in [
            [(-30.0, -20.0), (40.0, 3.0), (-11.0, 25.0)],
            [(3.3, -8.0), (3.4, 30.0), (25.0, 7.7)],
            [(-9.0, 2.0), (-2.0, 2.0), (-2.0, 7.0)],
            [(14.0, 2.0), (30.0, 2.0), (30.0, 7.0)],
        ] {
            assert!(worst_error(&polygon(&vertices), 12, 9) < 1e-12);
        }
    }

    #[test]
    fn centres_are_those_that_coverage_by_a_pixel_would_have() {
        // Drawn by centres, a polygon is the union of pixels: its area differs from the true one by less than its border's length.
        let triangle = polygon(&[(3.2, 1.1), (28.7, 9.4), (11.3, 24.6)]);
        let drawn = centres(&triangle, 30, 26);
        assert!(drawn.iter().all(|&c| c == 0.0 || c == 1.0));
        let covered = coverage(&triangle, 30, 26);
        // Wholly covered and wholly free pixels agree; a centre inside a convex polygon has at least a fifth of its pixel covered here.
        assert!(drawn.iter().zip(&covered).all(|(d, c)| if *c > 0.999 { *d == 1.0 } else { *c > 0.001 || *d == 0.0 }));
        let (sum, area) = (drawn.iter().sum::<f64>(), triangle.doubled_area().abs() / 2.0);
        assert!((sum - area).abs() < 10.0, "{sum} {area}");
        // Neighbours share no pixel and leave none out, also when their common edge runs through centres.
        let left = centres(&polygon(&[(1.0, 1.0), (5.0, 1.0), (5.0, 6.0), (1.0, 6.0)]), 12, 8);
        let right = centres(&polygon(&[(5.0, 1.0), (9.0, 1.0), (9.0, 6.0), (5.0, 6.0)]), 12, 8);
        assert!(left.iter().zip(&right).all(|(l, r)| l + r <= 1.0));
        assert_eq!(left.iter().chain(&right).sum::<f64>(), 40.0);
    }

    proptest! {
        #[test]
        fn any_triangle_agrees_with_clipping(v in prop::array::uniform6(-5.0..20.0f64)) {
            let triangle = polygon(&[(v[0], v[1]), (v[2], v[3]), (v[4], v[5])]);
            prop_assume!(triangle.doubled_area().abs() > 1e-6);
            prop_assert!(worst_error(&triangle, 16, 13) < 1e-11);
        }

        #[test]
        fn coverage_sums_to_the_area(angle in 0.0..std::f64::consts::TAU, x in 9.0..11.0f64, y in 9.0..11.0f64, side in 1.0..8.0f64) {
            let (c, s) = (angle.cos() * side / 2.0, angle.sin() * side / 2.0);
            let square = polygon(&[(x + c - s, y + s + c), (x - c - s, y - s + c), (x - c + s, y - s - c), (x + c + s, y + s - c)]);
            let sum: f64 = coverage(&square, 21, 21).iter().sum();
            prop_assert!((sum - side * side).abs() < 1e-10);
        }
    }
}
