//! Moniwa's affinity (A, B), as Galo et al. use it: a shear and a difference of scale in another basis than b1, b2.

use super::convention::{Convention, Verification};
use super::{Photogrammetric, photogrammetric};

/// Moniwa's affinity parameters. Direction: **measured to ideal**; mm; y points up.
///
/// Assumed: `dx = A yb`, `dy = B yb`, subtracted like the other corrections of [`Photogrammetric`]. Galo et al. 2011 name A and B and print no formula,
/// nor does any public source found: **unverified**. Under the assumption the conversion is exact: with `s = 1 / (1 - B)`,
/// `b1 = 1 - s`, `b2 = s A`, and c, k and p are multiplied by `s`.
///
/// Source: Moniwa 1972, after Galo et al. 2011, section 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moniwa {
    /// Shear A, a number.
    pub a: f64,
    /// Difference of scale B, a number.
    pub b: f64,
}

/// The convention of [`Photogrammetric`] with [`Moniwa`]'s parameters.
pub const CONVENTION: Convention = Convention {
    name: "moniwa",
    about: "photogrammetric with Moniwa's affinity A, B in place of b1, b2",
    source: "Moniwa 1972, after Galo et al. 2011",
    verification: Verification::Unverified("no public source prints the formula; dx = A y, dy = B y is assumed"),
    ..photogrammetric::CONVENTION
};

impl Moniwa {
    /// The camera `with_ab`, whose b1 and b2 are not used and whose affinity is this, in b1 and b2. `None` if B is 1 or more.
    pub fn to_in_plane(self, with_ab: &Photogrammetric) -> Option<Photogrammetric> {
        let s = 1.0 / (1.0 - self.b);
        (s > 0.0 && s.is_finite()).then(|| scaled(with_ab, s, [1.0 - s, s * self.a]))
    }

    /// The affinity of `camera`, and the camera without b1 and b2 that it belongs to. `None` if b1 is 1 or more.
    pub fn from_in_plane(camera: &Photogrammetric) -> Option<(Self, Photogrammetric)> {
        let s = 1.0 - camera.b[0];
        (s > 0.0 && s.is_finite()).then(|| (Self { a: camera.b[1] / s, b: 1.0 - 1.0 / s }, scaled(camera, 1.0 / s, [0.0; 2])))
    }
}

/// Ideal coordinates multiplied by `s`: the same rays.
fn scaled(camera: &Photogrammetric, s: f64, b: [f64; 2]) -> Photogrammetric {
    Photogrammetric { c: camera.c * s, k: camera.k.map(|k| k * s), p: camera.p.map(|p| p * s), b, ..*camera }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PixelPoint;
    use crate::camera::{CameraModel, ImageSize};

    #[test]
    fn the_conversion_is_exact() {
        let size = ImageSize { width: 1362, height: 1021 };
        let (k, p) = ([-1e-3, 2e-6, 0.0], [1e-4, -2e-4]);
        let camera = Photogrammetric { size, pitch_um: 4.7, c: 6.6, x0: 0.0411, y0: -0.02, k, p, b: [0.0; 2] };
        let moniwa = Moniwa { a: 3e-4, b: -2e-3 };
        let in_plane = moniwa.to_in_plane(&camera).unwrap();
        // The assumed formula, written out at one point.
        let (x, y) = (1.3, -0.9);
        let (r2, [p1, p2], [k1, k2, k3]) = (x * x + y * y, p, k);
        let q = k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
        let ideal_x = x - (x * q + p1 * (r2 + 2.0 * x * x) + 2.0 * p2 * x * y + moniwa.a * y);
        let ideal_y = y - (y * q + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * y * y) + moniwa.b * y);
        let pixel = PixelPoint::new(680.5 + (x + 0.0411) / 4.7e-3, 510.0 - (y - 0.02) / 4.7e-3);
        let (right, up) = in_plane.unproject(pixel).unwrap().tangent().unwrap();
        assert!((right - ideal_x / 6.6).abs() < 1e-15 && (up - ideal_y / 6.6).abs() < 1e-15);
        let (back, base) = Moniwa::from_in_plane(&in_plane).unwrap();
        assert!((back.a - moniwa.a).abs() < 1e-17 && (back.b - moniwa.b).abs() < 1e-15 && (base.c - camera.c).abs() < 1e-14);
        assert_eq!(Moniwa { a: 0.0, b: 1.0 }.to_in_plane(&camera), None);
    }
}
