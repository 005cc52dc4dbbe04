//! Measures of outlines: the box around one, and a polygon for it.

use std::f64::consts::{FRAC_PI_2, PI};

use calibench_model::testfield::{Curve, Outline, PlatePoint};
use calibench_model::{PixelPoint, Polygon};

/// Pieces of a full turn in [`polygon`].
const PIECES: f64 = 256.0;

/// The box around an outline: lowest and highest coordinates.
pub fn bounds(outline: &Outline) -> [PlatePoint; 2] {
    let points = outline.0.iter().flat_map(extremes);
    points.fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], [u, v]| {
        [[low[0].min(u), low[1].min(v)], [high[0].max(u), high[1].max(v)]]
    })
}

/// The ends of a curve, and where an arc turns back in u or v.
fn extremes(curve: &Curve) -> Vec<PlatePoint> {
    let mut points = vec![curve.at(0.0), curve.at(1.0)];
    if let Curve::Arc { start, sweep, .. } = *curve {
        let (from, to) = if sweep < 0.0 { (start + sweep, start) } else { (start, start + sweep) };
        let (first, last) = ((from / FRAC_PI_2).ceil() as i64, (to / FRAC_PI_2).floor() as i64);
        points.extend((first..=last).map(|quarter| curve.at((quarter as f64 * FRAC_PI_2 - start) / sweep)));
    }
    points
}

/// A polygon for an outline, in the plate's axes; arcs that turn from u towards v are replaced by lines around them, at most 1e-4 of the radius too far out.
pub fn polygon(outline: &Outline) -> Polygon {
    let mut vertices: Vec<PixelPoint> = Vec::new();
    for curve in &outline.0 {
        match *curve {
            Curve::Line { from, .. } => vertices.push(PixelPoint::new(from[0], from[1])),
            Curve::Arc { centre, radius, start, sweep } => {
                let pieces = (sweep.abs() / (2.0 * PI) * PIECES).ceil().max(1.0);
                let step = sweep / pieces;
                let around = radius / (0.5 * step).cos();
                for i in 0..pieces as usize {
                    let (sine, cosine) = (start + (i as f64 + 0.5) * step).sin_cos();
                    vertices.push(PixelPoint::new(centre[0] + around * cosine, centre[1] + around * sine));
                }
            }
        }
    }
    Polygon { id: String::new(), vertices, grey: 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disc_has_its_box_and_lies_inside_its_polygon() {
        let disc = Outline::disc([1.0, -2.0], 3.0);
        let [low, high] = bounds(&disc);
        for (found, expected) in low.into_iter().chain(high).zip([-2.0, -5.0, 4.0, 1.0]) {
            assert!((found - expected).abs() < 1e-12);
        }
        let around = polygon(&disc);
        let area = around.doubled_area().abs() / 2.0;
        assert!(area > 9.0 * PI && area < 9.0 * PI * 1.0002, "{area}");
    }

    #[test]
    fn an_arc_of_less_than_a_quarter_has_the_box_of_its_ends() {
        let outline = Outline(vec![Curve::Arc { centre: [0.0, 0.0], radius: 2.0, start: 0.9, sweep: -0.6 }]);
        let [low, high] = bounds(&outline);
        assert_eq!(low, [2.0 * 0.9_f64.cos(), 2.0 * (0.9_f64 - 0.6).sin()]);
        assert_eq!(high, [2.0 * (0.9_f64 - 0.6).cos(), 2.0 * 0.9_f64.sin()]);
    }
}
