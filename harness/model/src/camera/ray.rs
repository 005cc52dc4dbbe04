//! Rays.

/// A direction in the camera: x right, y up, z towards the viewer. The camera looks along -z; the length does not matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// To the right; any unit of length, the same for all three.
    pub x: f64,
    /// Upwards.
    pub y: f64,
    /// Backwards: negative for what lies before the camera.
    pub z: f64,
}

impl Ray {
    /// The ray whose ideal image coordinates, divided by the principal distance, are (`x`, `y`): x right, y up.
    pub const fn from_tangent(x: f64, y: f64) -> Self {
        Self { x, y, z: -1.0 }
    }

    /// The tangents (right, up); `None` for a ray that does not point forward.
    pub fn tangent(self) -> Option<(f64, f64)> {
        (self.z < 0.0 && self.x.is_finite() && self.y.is_finite()).then(|| (self.x / -self.z, self.y / -self.z))
    }

    /// d(tangent) / d(ray): rows right, up; columns x, y, z. Only for rays that point forward.
    pub fn tangent_derivatives(self) -> [[f64; 3]; 2] {
        let n = -1.0 / self.z;
        [[n, 0.0, self.x * n * n], [0.0, n, self.y * n * n]]
    }

    /// The angle to another ray, radians.
    pub fn angle_to(self, other: Self) -> f64 {
        let cross = [self.y * other.z - self.z * other.y, self.z * other.x - self.x * other.z, self.x * other.y - self.y * other.x];
        let sine = cross.iter().map(|c| c * c).sum::<f64>().sqrt();
        sine.atan2(self.x * other.x + self.y * other.y + self.z * other.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tangents_are_those_of_collinearity() {
        // x = -c X/Z: a point to the right and before the camera has a positive x.
        assert_eq!(Ray { x: 2.0, y: 1.0, z: -4.0 }.tangent(), Some((0.5, 0.25)));
        assert_eq!(Ray { x: 2.0, y: 1.0, z: 4.0 }.tangent(), None);
    }

    #[test]
    fn tangent_derivatives_are_differences() {
        let ray = Ray { x: 0.7, y: -0.4, z: -1.9 };
        let at = |d: [f64; 3]| Ray { x: ray.x + d[0], y: ray.y + d[1], z: ray.z + d[2] }.tangent().unwrap();
        let analytic = ray.tangent_derivatives();
        let [by_right, by_up] = analytic;
        for (axis, (by_right, by_up)) in by_right.into_iter().zip(by_up).enumerate() {
            let step = |h: f64| std::array::from_fn(|i| if i == axis { h } else { 0.0 });
            let (high, low) = (at(step(1e-6)), at(step(-1e-6)));
            assert!((by_right - (high.0 - low.0) / 2e-6).abs() < 1e-9);
            assert!((by_up - (high.1 - low.1) / 2e-6).abs() < 1e-9);
        }
    }
}
