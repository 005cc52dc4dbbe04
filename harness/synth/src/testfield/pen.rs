//! A polygon whose outline is drawn with a pen, as drawing programs fill and frame.

use std::f64::consts::FRAC_PI_8;

use calibench_model::{PixelPoint, Polygon};

/// The polygon grown by half the width of a round pen: convex vertices become arcs (of steps of at most 22.5 degrees, their vertices on the arc), reflex ones stay sharp.
pub(super) fn grown(polygon: &Polygon, pen: f64) -> Polygon {
    if pen == 0.0 {
        return polygon.clone();
    }
    // With y down a positive area runs clockwise to the eye; outwards is then to the left of the way.
    let turn = polygon.doubled_area().signum();
    let (vertices, half) = (&polygon.vertices, 0.5 * pen);
    let count = vertices.len();
    let direction = |from: PixelPoint, to: PixelPoint| (to.y - from.y).atan2(to.x - from.x);
    let mut outline = Vec::new();
    for index in 0..count {
        let (before, here, behind) = (vertices[(index + count - 1) % count], vertices[index], vertices[(index + 1) % count]);
        let first = direction(before, here) - turn * std::f64::consts::FRAC_PI_2;
        let change =
            (direction(here, behind) - direction(before, here)).sin().atan2((direction(here, behind) - direction(before, here)).cos());
        let at = |angle: f64, far: f64| PixelPoint::new(here.x + far * angle.cos(), here.y + far * angle.sin());
        if change * turn > 0.0 {
            // A right angle is four steps, whatever rounding makes of it.
            let steps = (change.abs() / FRAC_PI_8 - 1e-9).ceil().max(1.0);
            outline.extend((0..=steps as u32).map(|step| at(first + change * f64::from(step) / steps, half)));
        } else {
            outline.push(at(first + 0.5 * change, half / (0.5 * change).cos()));
        }
    }
    Polygon { vertices: outline, ..polygon.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_grows_on_all_sides() {
        for vertices in [[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)], [(0.0, 0.0), (0.0, 10.0), (10.0, 10.0), (10.0, 0.0)]] {
            let square = Polygon { id: "s".into(), vertices: vertices.map(|(x, y)| PixelPoint::new(x, y)).to_vec(), grey: 0.0 };
            let found = grown(&square, 2.0);
            // Four sides of 10 x 1, and a polygon of 16 sides in the pen's circle.
            let area = found.doubled_area().abs() / 2.0;
            assert!((area - (100.0 + 40.0 + 8.0 * FRAC_PI_8.sin())).abs() < 1e-9, "{area}");
            assert!(found.vertices.iter().all(|v| v.x >= -1.0 - 1e-12 && v.x <= 11.0 + 1e-12));
            assert_eq!(grown(&square, 0.0).vertices, square.vertices);
        }
    }

    #[test]
    fn reflex_vertices_stay_sharp() {
        let notch = [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (6.0, 9.0), (6.0, 3.0), (0.0, 3.0)];
        let found = grown(&Polygon { id: "l".into(), vertices: notch.map(|(x, y)| PixelPoint::new(x, y)).to_vec(), grey: 0.0 }, 1.0);
        assert!(found.vertices.iter().any(|v| (v.x - 5.5).abs() < 1e-12 && (v.y - 3.5).abs() < 1e-12), "{:?}", found.vertices);
    }
}
