//! Points of one picture in another.

use calibench_model::{Affine, Covariance, PixelPoint, Start};

use crate::view::View;

/// Half the distance over which differences are taken, px.
const STEP: f64 = 0.25;

impl View {
    /// A point of this picture in another one, with its covariance and its affine shape, to first order; `None` for what only one of them can show. It may lie
    /// outside of the frame.
    pub fn point_in(&self, other: &Self, point: &Start) -> Option<Start> {
        let at = point.position;
        let position = self.place_in(other, at)?;
        let slopes = (point.covariance.is_some() || point.affine.is_some()).then(|| self.slopes_in(other, at)).flatten();
        let moved = Start { position, affine: None, covariance: None, warp: None, ..*point };
        let Some([[a, b], [c, d]]) = slopes else { return Some(moved) };
        let covariance = point.covariance.map(|s| Covariance {
            sxx: a * a * s.sxx + 2.0 * a * b * s.sxy + b * b * s.syy,
            sxy: a * c * s.sxx + (a * d + b * c) * s.sxy + b * d * s.syy,
            syy: c * c * s.sxx + 2.0 * c * d * s.sxy + d * d * s.syy,
        });
        let affine = point.affine.map(|of| Affine {
            axx: a * of.axx + b * of.ayx,
            axy: a * of.axy + b * of.ayy,
            ayx: c * of.axx + d * of.ayx,
            ayy: c * of.axy + d * of.ayy,
        });
        Some(Start { covariance, affine, ..moved })
    }

    /// How a place in another picture moves with that in this one: d(x, y) / d(column, row), rows x, y; by central differences over half a pixel.
    pub fn slopes_in(&self, other: &Self, at: PixelPoint) -> Option<[[f64; 2]; 2]> {
        let by = |x: f64, y: f64| {
            let [before, behind] = [-STEP, STEP].map(|step| self.place_in(other, PixelPoint::new(at.x + step * x, at.y + step * y)));
            let (before, behind) = (before?, behind?);
            Some([(behind.x - before.x) / (2.0 * STEP), (behind.y - before.y) / (2.0 * STEP)])
        };
        let ([ax, ay], [bx, by]) = (by(1.0, 0.0)?, by(0.0, 1.0)?);
        Some([[ax, bx], [ay, by]])
    }
}

#[cfg(test)]
mod tests {
    use calibench_model::camera::{Camera, ImageSize, OpenCv};

    use super::*;
    use crate::{Frame, Target, framed};

    #[test]
    fn points_go_both_ways() {
        let mut distortion = [0.0; 14];
        distortion[..4].copy_from_slice(&[-0.2, 0.05, 0.001, -0.002]);
        let size = ImageSize { width: 800, height: 600 };
        let camera: Camera = OpenCv { size, fx: 700.0, fy: 705.0, cx: 390.0, cy: 305.0, distortion, coefficients: 5 }.into();
        let (from, to) = (View::Camera(camera), framed(&View::Camera(camera), Target::Pinhole, Frame::All, 1.0).unwrap());
        let point = Start {
            position: PixelPoint::new(101.3, 77.7),
            kind: None,
            affine: Some(Affine { axx: 30.0, axy: 1.0, ayx: -2.0, ayy: 28.0 }),
            covariance: Some(Covariance { sxx: 0.01, sxy: 0.002, syy: 0.02 }),
            warp: None,
        };
        let there = from.point_in(&to, &point).unwrap();
        let back = to.point_in(&from, &there).unwrap();
        assert!(back.position.distance(point.position) < 1e-8);
        let (found, given) = (back.covariance.unwrap(), point.covariance.unwrap());
        assert!((found.sxx - given.sxx).abs() < 1e-6 && (found.sxy - given.sxy).abs() < 1e-6 && (found.syy - given.syy).abs() < 1e-6);
        assert!((back.affine.unwrap().ayx + 2.0).abs() < 1e-3);
        // A step of a hundredth of a pixel, straight.
        let near = from.place_in(&to, PixelPoint::new(101.31, 77.7)).unwrap();
        let [[a, _], [c, _]] = from.slopes_in(&to, point.position).unwrap();
        assert!((near.x - there.position.x - 0.01 * a).abs() < 1e-5 && (near.y - there.position.y - 0.01 * c).abs() < 1e-5);
        // In the corners the picture is drawn apart, and errors with it.
        assert!(there.covariance.unwrap().sxx > given.sxx);
    }
}
