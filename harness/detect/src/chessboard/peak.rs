//! A corner of squares that are hardly larger than the blur: the saddle of the grey values there.

use calibench_model::Image;
use nalgebra::{SMatrix, SVector};

use crate::plane::{Point, distance, length, plus};

/// The radius of what is looked at, as a share of the shorter step; px at least and at most.
const RADIUS: f64 = 0.35;
const LEAST: f64 = 2.0;
const GREATEST: f64 = 5.0;
/// Rounds at most, and the length of the last way, px.
const ROUNDS: usize = 5;
const LAST: f64 = 0.05;

/// The saddle of the surface of second degree that is adjusted to the grey values around a point, px; `None` where it is none, is farther away than what is looked at
/// or lies on the border of the image. `step`: the shorter step to a neighbour, px.
pub(super) fn saddle(image: &Image, from: Point, step: f64) -> Option<Point> {
    let radius = (RADIUS * step).clamp(LEAST, GREATEST);
    let mut at = from;
    for _ in 0..ROUNDS {
        let next = stationary(image, at, radius)?;
        let moved = distance(next, at);
        at = next;
        if distance(at, from) > radius {
            return None;
        }
        if moved < LAST {
            break;
        }
    }
    Some(at)
}

/// Pixels weigh the less the nearer they are to the rim of what is looked at.
fn stationary(image: &Image, middle: Point, radius: f64) -> Option<Point> {
    let [column, row] = middle.map(|at| at.round() as i64);
    let reach = radius.ceil() as i64;
    if !image.holds(column, row, reach) {
        return None;
    }
    let mut normal = SMatrix::<f64, 6, 6>::zeros();
    let mut right = SVector::<f64, 6>::zeros();
    for (x, y) in (row - reach..=row + reach).flat_map(|y| (column - reach..=column + reach).map(move |x| (x, y))) {
        let [u, v] = [x as f64 - middle[0], y as f64 - middle[1]];
        let weight = 1.0 - length([u, v]) / (radius + 0.5);
        if weight > 0.0 {
            let terms = SVector::<f64, 6>::from([1.0, u, v, u * u, u * v, v * v]);
            normal += terms * terms.transpose() * weight;
            right += terms * (weight * f64::from(image.at(x as usize, y as usize)));
        }
    }
    let surface = normal.cholesky()?.solve(&right);
    let [xx, xy, yy] = [2.0 * surface[3], surface[4], 2.0 * surface[5]];
    let det = xx * yy - xy * xy;
    let off = [(xy * surface[2] - yy * surface[1]) / det, (xy * surface[1] - xx * surface[2]) / det];
    (det < 0.0 && length(off) < radius).then(|| plus(middle, off))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_saddle_is_met_and_a_hill_is_none() {
        let surface = |sign: f64| {
            Image::from_fn(30, 30, move |x, y| (0.5 + 0.01 * ((x as f64 - 14.3).powi(2) - sign * (y as f64 - 15.2).powi(2))) as f32)
        };
        let at = saddle(&surface(1.0), [15.5, 14.5], 8.0).unwrap();
        assert!(distance(at, [14.3, 15.2]) < 1e-4, "{at:?}");
        assert_eq!(saddle(&surface(-1.0), [15.5, 14.5], 8.0), None);
        assert_eq!(saddle(&surface(1.0), [1.0, 14.5], 8.0), None);
    }
}
