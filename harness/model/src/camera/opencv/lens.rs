//! The terms before the tilt, straight-line, for loops that the compiler vectorises.

use super::OpenCv;

/// Value and derivatives of the distortion at one point.
#[derive(Clone, Copy)]
pub(super) struct Slope {
    pub(super) value: [f64; 2],
    pub(super) by: [[f64; 2]; 2],
}

/// Distortion without branches.
pub(super) trait Lens: Copy {
    /// Of a camera whose other coefficients are zero.
    fn of(camera: &OpenCv) -> Self;
    /// The radial factor of r^2.
    fn factor(&self, r2: f64) -> f64;
    /// What is not radial.
    fn rest(&self, at: [f64; 2]) -> [f64; 2];
    /// All of it.
    #[inline(always)]
    fn value(&self, at @ [x, y]: [f64; 2]) -> [f64; 2] {
        let q = self.factor(x * x + y * y);
        let [rx, ry] = self.rest(at);
        [x * q + rx, y * q + ry]
    }
    /// All of it, with derivatives.
    fn slope(&self, at: [f64; 2]) -> Slope;
    /// d(distorted) / d(coefficient), x and y, of the coefficients with the places 0 to 11.
    fn by_coefficients(&self, at: [f64; 2]) -> [[f64; 2]; 12];
}

/// k1, k2, p1, p2, k3.
#[derive(Clone, Copy)]
pub(super) struct Five {
    k: [f64; 3],
    p: [f64; 2],
}

impl Lens for Five {
    fn of(camera: &OpenCv) -> Self {
        let [k1, k2, p1, p2, k3, ..] = camera.distortion;
        Self { k: [k1, k2, k3], p: [p1, p2] }
    }

    #[inline(always)]
    fn factor(&self, r2: f64) -> f64 {
        1.0 + r2 * (self.k[0] + r2 * (self.k[1] + r2 * self.k[2]))
    }

    #[inline(always)]
    fn rest(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [p1, p2] = self.p;
        let (r2, lean) = (x * x + y * y, 2.0 * p1 * y + 2.0 * p2 * x);
        [x * lean + p2 * r2, y * lean + p1 * r2]
    }

    #[inline(always)]
    fn value(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [p1, p2] = self.p;
        let r2 = x * x + y * y;
        let along = self.factor(r2) + (2.0 * p1 * y + 2.0 * p2 * x);
        [x * along + p2 * r2, y * along + p1 * r2]
    }

    #[inline(always)]
    fn slope(&self, [x, y]: [f64; 2]) -> Slope {
        let ([k1, k2, k3], [p1, p2]) = (self.k, self.p);
        let r2 = x * x + y * y;
        let lean = 2.0 * p1 * y + 2.0 * p2 * x;
        let along = self.factor(r2) + lean;
        let rise = 2.0 * k1 + r2 * (4.0 * k2 + r2 * (6.0 * k3));
        let (rise_x, rise_y) = (x * rise, y * rise);
        let cross = rise_x * y + (2.0 * p1 * x + 2.0 * p2 * y);
        let value = [x * along + p2 * r2, y * along + p1 * r2];
        let by = [[along + x * (rise_x + 4.0 * p2), cross], [cross, along + y * (rise_y + 4.0 * p1)]];
        Slope { value, by }
    }

    #[inline(always)]
    fn by_coefficients(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 12] {
        let (r2, xy, none) = (x * x + y * y, 2.0 * x * y, [0.0; 2]);
        let (r4, r6) = (r2 * r2, r2 * r2 * r2);
        let tangential = ([xy, r2 + 2.0 * y * y], [r2 + 2.0 * x * x, xy]);
        let five = [[x * r2, y * r2], [x * r4, y * r4], tangential.0, tangential.1, [x * r6, y * r6]];
        [five[0], five[1], five[2], five[3], five[4], none, none, none, none, none, none, none]
    }
}

/// All twelve, with a rational factor.
#[derive(Clone, Copy)]
pub(super) struct Twelve([f64; 12]);

impl Lens for Twelve {
    fn of(camera: &OpenCv) -> Self {
        Self(std::array::from_fn(|i| camera.distortion[i]))
    }

    #[inline(always)]
    fn factor(&self, r2: f64) -> f64 {
        let [k1, k2, _, _, k3, k4, k5, k6, ..] = self.0;
        (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1.0 + r2 * (k4 + r2 * (k5 + r2 * k6)))
    }

    #[inline(always)]
    fn rest(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [_, _, p1, p2, _, _, _, _, s1, s2, s3, s4] = self.0;
        let (r2, xy) = (x * x + y * y, 2.0 * x * y);
        [p1 * xy + p2 * (r2 + 2.0 * x * x) + r2 * (s1 + r2 * s2), p1 * (r2 + 2.0 * y * y) + p2 * xy + r2 * (s3 + r2 * s4)]
    }

    #[inline(always)]
    fn slope(&self, at @ [x, y]: [f64; 2]) -> Slope {
        let [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4] = self.0;
        let r2 = x * x + y * y;
        let inverse = 1.0 / (1.0 + r2 * (k4 + r2 * (k5 + r2 * k6)));
        let q = (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))) * inverse;
        let rise = 2.0 * inverse * (k1 + r2 * (2.0 * k2 + r2 * (3.0 * k3)) - q * (k4 + r2 * (2.0 * k5 + r2 * (3.0 * k6))));
        let (prism_x, prism_y) = (2.0 * s1 + 4.0 * r2 * s2, 2.0 * s3 + 4.0 * r2 * s4);
        let cross = x * y * rise + 2.0 * (p1 * x + p2 * y);
        let [rx, ry] = self.rest(at);
        let by = [
            [q + x * x * rise + 2.0 * p1 * y + 6.0 * p2 * x + prism_x * x, cross + prism_x * y],
            [cross + prism_y * x, q + y * y * rise + 6.0 * p1 * y + 2.0 * p2 * x + prism_y * y],
        ];
        Slope { value: [x * q + rx, y * q + ry], by }
    }

    #[inline(always)]
    fn by_coefficients(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 12] {
        let [k1, k2, _, _, k3, k4, k5, k6, ..] = self.0;
        let (r2, xy) = (x * x + y * y, 2.0 * x * y);
        let inverse = 1.0 / (1.0 + r2 * (k4 + r2 * (k5 + r2 * k6)));
        let q = (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))) * inverse;
        let (a, b, c) = (r2 * inverse, r2 * r2 * inverse, r2 * r2 * r2 * inverse);
        let radial = |factor: f64| [x * factor, y * factor];
        [
            radial(a),
            radial(b),
            [xy, r2 + 2.0 * y * y],
            [r2 + 2.0 * x * x, xy],
            radial(c),
            radial(-q * a),
            radial(-q * b),
            radial(-q * c),
            [r2, 0.0],
            [r2 * r2, 0.0],
            [0.0, r2],
            [0.0, r2 * r2],
        ]
    }
}
