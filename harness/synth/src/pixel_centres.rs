//! Polygons drawn pixel by pixel, without partial coverage.

use calibench_model::Polygon;

/// 1 for every pixel whose centre lies in the polygon and 0 for every other, row by row, of an image of `width` x `height` px: how programs draw that
/// know no partial coverage.
///
/// A centre on an edge counts for the polygon to its right or below.
pub fn covered_centres(polygon: &Polygon, width: usize, height: usize) -> Vec<f64> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_model::PixelPoint;

    fn polygon(vertices: &[(f64, f64)]) -> Polygon {
        Polygon { id: "p".into(), grey: 1.0, vertices: vertices.iter().map(|&(x, y)| PixelPoint::new(x, y)).collect() }
    }

    #[test]
    fn drawn_pixels_are_those_whose_centres_are_inside() {
        let triangle = polygon(&[(3.2, 1.1), (28.6, 9.4), (11.3, 24.6)]);
        let drawn = covered_centres(&triangle, 30, 26);
        let v = &triangle.vertices;
        let inside =
            |x: f64, y: f64| (0..3).all(|i| (v[(i + 1) % 3].x - v[i].x) * (y - v[i].y) > (v[(i + 1) % 3].y - v[i].y) * (x - v[i].x));
        for (i, value) in drawn.iter().enumerate() {
            assert_eq!(*value == 1.0, inside((i % 30) as f64, (i / 30) as f64), "pixel {i}");
        }
        let (sum, area) = (drawn.iter().sum::<f64>(), triangle.doubled_area().abs() / 2.0);
        assert!((sum - area).abs() < 10.0, "{sum} {area}");
    }

    #[test]
    fn neighbours_share_no_pixel_and_leave_none_out_also_when_their_edge_runs_through_centres() {
        let left = covered_centres(&polygon(&[(1.0, 1.0), (5.0, 1.0), (5.0, 6.0), (1.0, 6.0)]), 12, 8);
        let right = covered_centres(&polygon(&[(5.0, 1.0), (9.0, 1.0), (9.0, 6.0), (5.0, 6.0)]), 12, 8);
        assert!(left.iter().zip(&right).all(|(l, r)| l + r <= 1.0));
        assert_eq!(left.iter().chain(&right).sum::<f64>(), 40.0);
    }
}
