//! What is known of control points beforehand: that they are near zero, above all across.

use calibench_model::camera::Splined;

use super::{CORE, SplinedNetwork};

/// Share of the image coordinates' own expected sum of squares that the prior takes, and the offset that it expects, a number as u is.
const SHARE: f64 = 0.005 / 2.0;
const OFFSET: f64 = 0.2;
/// How many times as much an offset across weighs as one along.
const ACROSS: f64 = 10.0;

/// Two pseudo-observations a control point: its offset along the direction from the grid's middle is zero, and that across it.
///
/// A control point in the middle of the grid has no such direction: both are as along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnotPrior {
    /// One over the standard deviation of an offset along, a number as u is.
    pub along: f64,
    /// The same across.
    pub across: f64,
}

impl KnotPrior {
    /// mrcal's: weights that grow with the image coordinates, so that the prior's expected share of the sum of squares stays the same.
    ///
    /// Source: mrcal 2.2, whose residuals of 600 control points and 37,200 image coordinates are 1.392 and 13.92 times the offsets.
    pub fn of_mrcal(image_coordinates: usize, control_points: usize) -> Self {
        let expected = (2 * control_points) as f64 * OFFSET * OFFSET;
        let along = (SHARE * image_coordinates as f64 / expected).sqrt();
        Self { along, across: ACROSS * along }
    }

    pub(super) fn is_positive(&self) -> bool {
        [self.along, self.across].iter().all(|root| *root > 0.0 && (root * root).is_normal())
    }

    /// The weight matrix (xx, xy, yy) of a control point's offset.
    pub(super) fn weight(&self, camera: &Splined, place: usize) -> [f64; 3] {
        let from_middle = |at: usize, count: usize| at as f64 - 0.5 * (count - 1) as f64;
        let [x, y] = [from_middle(place % camera.columns, camera.columns), from_middle(place / camera.columns, camera.rows)];
        let length = x.hypot(y);
        let (along, across) = (self.along * self.along, self.across * self.across);
        if length == 0.0 {
            return [along, 0.0, along];
        }
        let [x, y] = [x / length, y / length];
        [along * x * x + across * y * y, (along - across) * x * y, along * y * y + across * x * x]
    }
}

/// The trace of the prior's weights times cofactors, both triangles, column by column: how many unknowns the prior determines, a number.
pub(super) fn prior_trace(of: &SplinedNetwork, cofactors: &[f64]) -> f64 {
    let n = cofactors.len().isqrt();
    let trace = |place: usize| {
        let ([xx, xy, yy], first) = (of.prior.weight(&of.camera, place), CORE + 2 * place);
        xx * cofactors[first * (n + 1)] + 2.0 * xy * cofactors[first * n + first + 1] + yy * cofactors[(first + 1) * (n + 1)]
    };
    (0..of.camera.control.len()).map(trace).sum()
}
