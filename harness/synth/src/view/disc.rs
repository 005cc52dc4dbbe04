//! The picture of a disc.

use calibench_model::{ObjectTarget, PixelPoint};
use nalgebra::{Matrix2, Vector2};

use super::View;
use super::truth::{Ellipse, tangents};

/// Places around the outline: of a smooth closed curve the trapezoid's error falls faster than any power of their number.
const PLACES: u32 = 64;

/// The picture of a disc, from the moments of its outline by Green's theorem; `None` where not all of the outline has a place in the image plane.
pub(super) fn ellipse(view: &View<'_>, target: &ObjectTarget) -> Option<Ellipse> {
    let plate = &view.field.plates[target.plate];
    let (radius, step) = (0.5 * target.size, std::f64::consts::TAU / f64::from(PLACES));
    let at = view.project(&view.field.position(target)).ok()?;
    let (mut area, mut first, mut second) = (0.0, Vector2::zeros(), Matrix2::zeros());
    for place in 0..PLACES {
        let (sine, cosine) = (f64::from(place) * step).sin_cos();
        let on = [target.at[0] + radius * cosine, target.at[1] + radius * sine];
        let point = plate.point(on);
        let [by_u, by_v] = tangents(plate, on, 1e-3 * target.size);
        let along = view.by_object(&point)? * (by_v * cosine - by_u * sine) * (radius * step);
        let seen = view.project(&point).ok()?;
        let from = Vector2::new(seen.x - at.x, seen.y - at.y);
        // A triangle to the next place: its area, by which first moments are a third and second ones a quarter.
        let swept = 0.5 * (from.x * along.y - from.y * along.x);
        area += swept;
        first += from * (swept * 2.0 / 3.0);
        second += from * from.transpose() * (swept * 0.5);
    }
    let centre = first / area;
    // Of an ellipse the second moments are a quarter of the squared semi-axes.
    let shape = ((second / area - centre * centre.transpose()) * 4.0).symmetric_eigen();
    let (long, short) = if shape.eigenvalues[0] >= shape.eigenvalues[1] { (0, 1) } else { (1, 0) };
    if shape.eigenvalues[short].is_nan() || shape.eigenvalues[short] <= 0.0 {
        return None;
    }
    let axis = shape.eigenvectors.column(long);
    let axes = [long, short].map(|which| shape.eigenvalues[which].sqrt());
    Some(Ellipse { centre: PixelPoint::new(at.x + centre.x, at.y + centre.y), axes, angle: (axis[1] / axis[0]).atan() })
}
