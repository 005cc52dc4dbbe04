//! Pictures without blur against the area of clipped polygons.

use calibench_model::{PixelPoint, Polygon, Scene};
use proptest::prelude::*;

use crate::render;

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

/// The covered fraction of each pixel as it is rendered.
fn covered(polygon: &Polygon, width: usize, height: usize) -> Vec<f64> {
    let scene = Scene { width, height, background: 0.0, polygons: vec![polygon.clone()], targets: Vec::new() };
    render(&scene).grey().iter().map(|&grey| f64::from(grey)).collect()
}

fn worst_error(polygon: &Polygon, width: usize, height: usize) -> f64 {
    let covered = covered(polygon, width, height);
    let errors = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    errors.map(|(x, y)| (covered[y * width + x] - clipped_area(polygon, x, y)).abs()).fold(0.0, f64::max)
}

#[test]
fn half_pixels_and_diagonals_by_hand() {
    // The square [0.25, 2] x [0, 1.5] in pixel coordinates: columns 0 to 2, rows 0 to 1 in part.
    let square = covered(&polygon(&[(0.25, 0.0), (2.0, 0.0), (2.0, 1.5), (0.25, 1.5)]), 4, 3);
    let expected = [0.125, 0.5, 0.25, 0.0, 0.25, 1.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert!(square.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-7), "{square:?}");
    // A diagonal through pixel corners halves the pixels that it crosses.
    let halved = covered(&polygon(&[(-0.5, -0.5), (2.5, 2.5), (-0.5, 2.5)]), 3, 3);
    let expected = [0.5, 0.0, 0.0, 1.0, 0.5, 0.0, 1.0, 1.0, 0.5];
    assert!(halved.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-7), "{halved:?}");
}

#[test]
fn parts_outside_the_image_are_clipped() {
    for vertices in [
        [(-30.0, -20.0), (40.0, 3.0), (-11.0, 25.0)],
        [(3.3, -8.0), (3.4, 30.0), (25.0, 7.7)],
        [(-9.0, 2.0), (-2.0, 2.0), (-2.0, 7.0)],
        [(14.0, 2.0), (30.0, 2.0), (30.0, 7.0)],
    ] {
        assert!(worst_error(&polygon(&vertices), 12, 9) < 1e-7);
    }
}

proptest! {
    #[test]
    fn any_triangle_agrees_with_clipping(v in prop::array::uniform6(-5.0..20.0f64)) {
        let triangle = polygon(&[(v[0], v[1]), (v[2], v[3]), (v[4], v[5])]);
        prop_assume!(triangle.doubled_area().abs() > 1e-6);
        prop_assert!(worst_error(&triangle, 16, 13) < 1e-7);
    }
}
