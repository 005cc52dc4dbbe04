//! The canonical orientation with Ebner's twelve additional parameters.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, Direction, PixelOrigin, TangentialOrder, Verification, Vertical};
use super::measured_to_ideal::{Correction, measured_camera};
use super::newton::ValueAndDerivatives;
use super::plane_map::{PlaneMap, is_one_to_one};
use super::{CameraModel, CameraParameter, DerivativeBuffer, Photogrammetric, Reframe, Resampling, Turn, named};

/// [`Photogrammetric`] with Ebner's twelve additional parameters. Direction: **measured to ideal**; mm; y points up.
///
/// On measured coordinates `x`, `y` from the principal point, with the spacing `b` of a 3 x 3 grid, `B = 2 b^2 / 3`, `X = x^2 - B`, `Y = y^2 - B`:
/// `dx = b1 x + b2 y - 2 b3 X + b4 x y + b5 Y + b7 x Y + b9 y X + b11 X Y`,
/// `dy = -b1 y + b2 x + b3 x y - 2 b4 Y + b6 X + b8 y X + b10 x Y + b12 X Y`,
/// subtracted from the measured coordinates beside the base's own terms.
///
/// On the grid, and there only, they are orthogonal to each other and to the effects of the exterior orientation.
///
/// Source: Ebner 1976; Vosselman and Förstner 1988. Whether the origin is the principal point or the centre of the frame is not settled by them; the
/// principal point is assumed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ebner {
    /// Principal distance, principal point and, usually zero, distortion.
    pub base: Photogrammetric,
    /// Spacing of the grid, mm.
    pub b_mm: f64,
    /// b1 to b12: b1, b2 are numbers; b3 to b6 in mm^-1; b7 to b10 in mm^-2; b11, b12 in mm^-3.
    pub parameters: [f64; 12],
}

/// The convention of [`Ebner`].
pub const CONVENTION: Convention = Convention {
    name: "ebner",
    about: "photogrammetric with Ebner's 12 additional parameters on a 3 x 3 grid",
    version: "",
    direction: Direction::MeasuredToIdeal,
    pixel_origin: PixelOrigin::PixelCentre,
    principal_point_from: PixelOrigin::FrameCentre,
    y: Vertical::Up,
    order: TangentialOrder::Brown,
    normalisation: "none: mm from the principal point, grid spacing b",
    source: "Ebner 1976; Vosselman and Förstner 1988",
    verification: Verification::Unverified(
        "that the parameters act on coordinates from the principal point and are subtracted is assumed; the sources print no example",
    ),
};

const NAMES: [(&str, &str); 12] = [
    ("e1", ""),
    ("e2", ""),
    ("e3", "mm^-1"),
    ("e4", "mm^-1"),
    ("e5", "mm^-1"),
    ("e6", "mm^-1"),
    ("e7", "mm^-2"),
    ("e8", "mm^-2"),
    ("e9", "mm^-2"),
    ("e10", "mm^-2"),
    ("e11", "mm^-3"),
    ("e12", "mm^-3"),
];

impl Ebner {
    /// The effect (dx, dy) of each parameter at measured coordinates from the principal point, mm.
    pub fn effects(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 12] {
        let mean = 2.0 * self.b_mm * self.b_mm / 3.0;
        let (xx, yy) = (x * x - mean, y * y - mean);
        [
            [x, -y],
            [y, x],
            [-2.0 * xx, x * y],
            [x * y, -2.0 * yy],
            [yy, 0.0],
            [0.0, xx],
            [x * yy, 0.0],
            [0.0, y * xx],
            [y * xx, 0.0],
            [0.0, x * yy],
            [xx * yy, 0.0],
            [0.0, xx * yy],
        ]
    }

    /// d(effect) / d(x, y), row by row.
    fn slopes(&self, [x, y]: [f64; 2]) -> [[[f64; 2]; 2]; 12] {
        let mean = 2.0 * self.b_mm * self.b_mm / 3.0;
        let (xx, yy, none) = (x * x - mean, y * y - mean, [0.0, 0.0]);
        [
            [[1.0, 0.0], [0.0, -1.0]],
            [[0.0, 1.0], [1.0, 0.0]],
            [[-4.0 * x, 0.0], [y, x]],
            [[y, x], [0.0, -4.0 * y]],
            [[0.0, 2.0 * y], none],
            [none, [2.0 * x, 0.0]],
            [[yy, 2.0 * x * y], none],
            [none, [2.0 * x * y, xx]],
            [[2.0 * x * y, xx], none],
            [none, [yy, 2.0 * x * y]],
            [[2.0 * x * yy, 2.0 * y * xx], none],
            [none, [2.0 * x * yy, 2.0 * y * xx]],
        ]
    }

    /// What the Frobenius norm of each of [`Self::slopes`] does not exceed within `radius` (mm) of the principal point.
    fn steepest(&self, radius: f64) -> [f64; 12] {
        let (mean, rr) = (2.0 * self.b_mm * self.b_mm / 3.0, radius * radius);
        // |X| and |Y|; 2 |x y| is at most r^2.
        let form = mean.max(rr - mean);
        let (linear, square, cubic) = (std::f64::consts::SQRT_2, 17.0_f64.sqrt() * radius, form + rr);
        let product = 2.0 * radius * form;
        [linear, linear, square, square, 2.0 * radius, 2.0 * radius, cubic, cubic, cubic, cubic, product, product]
    }
}

impl PlaneMap for Ebner {
    fn map(&self, at: [f64; 2]) -> ValueAndDerivatives {
        let (mut value, mut by) = self.base.map(at);
        for (parameter, (effect, slope)) in self.parameters.iter().zip(self.effects(at).iter().zip(self.slopes(at))) {
            for row in 0..2 {
                value[row] -= parameter * effect[row];
                by[row][0] -= parameter * slope[row][0];
                by[row][1] -= parameter * slope[row][1];
            }
        }
        (value, by)
    }

    fn start(&self, goal: [f64; 2]) -> Option<[f64; 2]> {
        self.base.start(goal)
    }

    fn is_surely_one_to_one(&self, radius: f64) -> bool {
        let Photogrammetric { k, p, b, .. } = self.base;
        let rest: f64 = self.parameters.iter().zip(self.steepest(radius)).map(|(parameter, slope)| parameter.abs() * slope).sum();
        is_one_to_one(radius, &k.map(|k| -k), &p, b[0].abs() + b[1].abs() + rest)
    }
}

impl Correction for Ebner {
    fn base(&self) -> &Photogrammetric {
        &self.base
    }

    fn by_coefficients(&self, at: [f64; 2], into: &mut DerivativeBuffer) {
        self.base.by_coefficients(at, into);
        into.extend(self.effects(at).map(|[x, y]| [-x, -y]));
    }
}

impl Ebner {
    fn named_parameters(&self) -> Vec<CameraParameter> {
        let mut all = self.base.parameters();
        all.extend(named(&NAMES, &self.parameters));
        all
    }

    fn with_values(&self, values: &[f64]) -> Self {
        let (base, own) = values.split_at(values.len() - self.parameters.len());
        let mut parameters = self.parameters;
        parameters.copy_from_slice(own);
        Self { base: self.base.with_parameters(base), parameters, ..*self }
    }
}

measured_camera!(Ebner);

impl Reframe for Ebner {
    fn has_two_scales(&self) -> bool {
        false
    }

    fn resampled(&self, by: &Resampling) -> Self {
        Self { base: self.base.resampled(by), ..*self }
    }

    fn without_place(&self, turn: Turn) -> Option<&'static str> {
        self.base.without_place(turn)
    }

    fn turned(&self, turn: Turn) -> Self {
        let base = self.base.turned(turn);
        // What the base's ideal coordinates were multiplied by.
        let s = base.c / self.base.c;
        let [e1, e2, e3, e4, e5, e6, e7, e8, e9, e10, e11, e12] = self.parameters.map(|e| s * e);
        let parameters = match turn {
            Turn::Quarter => [-e1, -e2, e4, -e3, e6, -e5, e8, e7, -e10, -e9, e12, -e11],
            // Terms of even degree change their sign.
            Turn::Half => [e1, e2, -e3, -e4, -e5, -e6, e7, e8, e9, e10, -e11, -e12],
            Turn::ThreeQuarters => [-e1, -e2, -e4, e3, -e6, e5, e8, e7, -e10, -e9, -e12, e11],
        };
        Self { base, parameters: parameters.map(|e| 0.0 + e), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::ImageSize;
    use crate::camera::conformance::{self, Shape};

    fn camera() -> Ebner {
        let size = ImageSize { width: 3000, height: 2000 };
        let (k, p, b) = ([-1e-4, 0.0, 0.0], [0.0; 2], [0.0; 2]);
        let base = Photogrammetric { size, pitch_um: 6.0, c: 15.0, x0: 0.03, y0: -0.05, k, p, b };
        let parameters = [1e-4, -2e-4, 1e-5, -2e-5, 3e-5, 1e-5, 2e-6, -3e-6, 1e-6, 2e-6, -1e-7, 2e-7];
        Ebner { base, b_mm: 6.0, parameters }
    }

    #[test]
    fn conforms() {
        conformance::check(&camera(), Shape::Barrel);
    }

    #[test]
    fn no_slope_is_steeper_than_its_bound_and_some_place_comes_near() {
        let camera = Ebner { b_mm: 2.1, ..camera() };
        for radius in [0.3, 1.0, 2.0, 3.5, 6.0] {
            let mut most = [0.0_f64; 12];
            for place in 0..3600 {
                let (r, (sin, cos)) = (radius * f64::from(place % 10 + 1) / 10.0, (f64::from(place) * 0.01).sin_cos());
                for (most, slope) in most.iter_mut().zip(camera.slopes([r * cos, r * sin])) {
                    *most = most.max(slope.as_flattened().iter().map(|s| s * s).sum::<f64>().sqrt());
                }
            }
            for (parameter, (most, bound)) in most.into_iter().zip(camera.steepest(radius)).enumerate() {
                assert!(most <= bound * (1.0 + 1e-12) && most > 0.3 * bound, "e{} at {radius}: {most} of {bound}", parameter + 1);
            }
        }
    }

    #[test]
    fn what_is_surely_one_to_one_does_not_fold() {
        let times = |scale: f64| Ebner { parameters: camera().parameters.map(|e| e * scale), ..camera() };
        let (mut sure, mut folded) = (0, 0);
        for scale in [0.0, 1.0, 10.0, 100.0, 300.0, 1000.0, 3000.0, 10_000.0] {
            let camera = times(scale);
            let folds = (0..360).any(|degrees| {
                let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
                (0..=200).any(|i| {
                    crate::camera::newton::determinant(camera.map([0.05 * f64::from(i) * cos, 0.05 * f64::from(i) * sin]).1) <= 0.0
                })
            });
            let is_sure = camera.is_surely_one_to_one(10.0);
            assert!(!(is_sure && folds), "at {scale} times its parameters");
            (sure, folded) = (sure + i32::from(is_sure), folded + i32::from(folds));
        }
        assert!(sure >= 2 && folded >= 1, "{sure} are sure, {folded} fold");
    }

    #[test]
    fn effects_are_orthogonal_on_the_grid() {
        let camera = camera();
        let grid = (0..9).map(|i| [f64::from(i % 3 - 1) * camera.b_mm, f64::from(i / 3 - 1) * camera.b_mm]);
        let effects: Vec<[[f64; 2]; 12]> = grid.map(|at| camera.effects(at)).collect();
        for i in 0..12 {
            for j in 0..i {
                let sum: f64 = effects.iter().map(|e| e[i][0] * e[j][0] + e[i][1] * e[j][1]).sum();
                assert!(sum.abs() < 1e-9, "{i} {j}: {sum}");
            }
        }
    }
}
