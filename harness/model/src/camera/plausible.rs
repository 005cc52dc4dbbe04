//! Whether a camera may be that of a lens over its whole frame, also beyond the points that it was found from.

use std::fmt;

use super::fold::{corners, is_inside};
use super::{CameraModel, Ray};
use crate::PixelPoint;

/// How far the image of the axis may be from the middle of the frame, as a share of a side: shifted lenses come near it.
const FARTHEST: f64 = 0.2;
/// How near to the middle it is of a camera whose image was reduced.
const NEAR: f64 = 0.06;
/// Steps from the axis to a corner.
const STEPS: usize = 6;
/// How many times a lens may stretch the image along the radius in place of a lens without distortion, and how small a part of it is left within 45 degrees.
const STRETCHED: f64 = 2.0;
const SQUEEZED: f64 = 0.1;
/// Angle from the axis up to which the plane of a lens without distortion is a measure, radians.
const WIDEST: f64 = 1.3;

/// What no lens has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Implausible {
    /// The image of the axis is far from the middle of the frame.
    PrincipalPoint {
        /// Where it is, px.
        at: PixelPoint,
        /// How far from the middle, as shares of width and height.
        off: [f64; 2],
        /// Of images that were so many times reduced it would be in their middle.
        reduced: Option<u32>,
    },
    /// Along the radius the distortion changes the scale more than any lens does.
    Distortion {
        /// Where, px.
        at: PixelPoint,
        /// Scale there, in that of a lens without distortion.
        scale: f64,
    },
}

impl fmt::Display for Implausible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PrincipalPoint { at, off, reduced } => {
                let [x, y] = off.map(|share| 100.0 * share);
                write!(
                    f,
                    "the principal point, ({:.1}, {:.1}), is {x:.0} % of the width and {y:.0} % of the height from the middle of the frame: no lens has that \
                     unless it is shifted, or the images are parts of larger ones",
                    at.x, at.y
                )?;
                reduced.map_or(Ok(()), |times| {
                    write!(
                        f,
                        "; it is in the middle of images reduced or binned {times} x {times} times: is the size that of the whole sensor?"
                    )
                })
            }
            Self::Distortion { at, scale } => write!(
                f,
                "at ({:.0}, {:.0}) the image is {scale:.2} times as large along the radius as that of a lens without distortion: no lens has that",
                at.x, at.y
            ),
        }
    }
}

/// What of `camera` no lens has, over its frame.
pub fn implausible(camera: &dyn CameraModel) -> Vec<Implausible> {
    let Ok(axis) = camera.project(Ray::from_tangent(0.0, 0.0)) else { return Vec::new() };
    principal_point(camera, axis).into_iter().chain(distortion(camera, axis)).collect()
}

fn principal_point(camera: &dyn CameraModel, at: PixelPoint) -> Option<Implausible> {
    let (size, corner) = (camera.size(), at.to_corner());
    let off = |times: f64| [times * corner.x / f64::from(size.width) - 0.5, times * corner.y / f64::from(size.height) - 0.5].map(f64::abs);
    let worst = |times: u32| off(f64::from(times)).into_iter().fold(0.0, f64::max);
    if worst(1) <= FARTHEST {
        return None;
    }
    let reduced = (2..=8).min_by(|a, b| worst(*a).total_cmp(&worst(*b))).filter(|times| worst(*times) < NEAR);
    Some(Implausible::PrincipalPoint { at, off: off(1.0), reduced })
}

/// The place where the scale along the radius is farthest from that of the plane, if it is beyond what lenses have.
fn distortion(camera: &dyn CameraModel, axis: PixelPoint) -> Option<Implausible> {
    let mut worst: Option<(f64, Implausible)> = None;
    for corner in corners(camera.size()) {
        let place = |share: f64| PixelPoint::new(axis.x + share * (corner.x - axis.x), axis.y + share * (corner.y - axis.y));
        let length = corner.distance(axis);
        let angle = |point: PixelPoint| camera.unproject(point).ok().map(|ray| ray.angle_to(Ray::from_tangent(0.0, 0.0)));
        let Some(first) = angle(place(1.0 / length)).filter(|_| length > 1.0) else { continue };
        for step in 1..STEPS {
            let (from, to) = (place(step as f64 / STEPS as f64), place((step + 1) as f64 / STEPS as f64));
            let (Some(a), Some(b)) = (angle(from), angle(to)) else { break };
            let middle = f64::midpoint(a, b);
            if b <= a || middle > WIDEST || !is_inside(camera.size(), from) {
                continue;
            }
            let scale = from.distance(to) / (b - a) * first * middle.cos().powi(2);
            let is_squeezed = scale < SQUEEZED && middle < std::f64::consts::FRAC_PI_4;
            let size = scale.ln().abs();
            if (scale > STRETCHED || is_squeezed) && worst.as_ref().is_none_or(|(before, _)| size > *before) {
                worst = Some((size, Implausible::Distortion { at: to, scale }));
            }
        }
    }
    worst.map(|(_, found)| found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, Eucm, ImageSize, OpenCv, OpenCvFisheye};

    fn pinhole(f: f64, [cx, cy]: [f64; 2], k: [f64; 3]) -> Camera {
        let mut distortion = [0.0; 14];
        [distortion[0], distortion[1], distortion[4]] = k;
        OpenCv { size: ImageSize { width: 2064, height: 1544 }, fx: f, fy: f, cx, cy, distortion, coefficients: 5 }.into()
    }

    #[test]
    fn a_camera_matrix_of_reduced_images_beside_the_size_of_the_sensor_is_named() {
        for (times, at) in [(4, [254.1, 183.9]), (2, [520.0, 380.0]), (3, [340.0, 262.0])] {
            let [Implausible::PrincipalPoint { off, reduced, .. }, ..] = implausible(&pinhole(300.0, at, [-0.1, 0.0, 0.0]))[..] else {
                panic!("{at:?}")
            };
            assert_eq!(reduced, Some(times));
            assert!(off.iter().all(|share| *share > 0.2), "{off:?}");
        }
        let far = implausible(&pinhole(1200.0, [2500.0, 770.0], [0.0; 3]));
        assert!(matches!(far[..], [Implausible::PrincipalPoint { reduced: None, .. }]), "{far:?}");
        assert!(far[0].to_string().contains("(2500.0, 770.0), is 71 % of the width and 0 % of the height"), "{}", far[0]);
    }

    #[test]
    fn distortion_that_no_lens_has_is_named_and_that_of_lenses_is_not() {
        for k in [[0.0, 0.0, 4.0], [0.1, 1.5, 8.0], [3.0, 0.0, 0.0]] {
            let found = implausible(&pinhole(1500.0, [1030.0, 770.0], k));
            assert!(matches!(found[..], [Implausible::Distortion { scale, .. }] if scale > 2.0), "{k:?}: {found:?}");
        }
        // A wide lens, a long one, fisheyes.
        let size = ImageSize { width: 2064, height: 1544 };
        let (cx, cy) = (1040.0, 760.0);
        for camera in [
            pinhole(1100.0, [cx, cy], [-0.3, 0.11, -0.02]),
            pinhole(9000.0, [cx, cy], [0.4, 2.0, 0.0]),
            OpenCvFisheye { size, fx: 500.0, fy: 500.0, cx, cy, skew: 0.0, k: [-0.02, 3e-3, 0.0, 0.0] }.into(),
            Eucm { size, fx: 600.0, fy: 600.0, cx, cy, alpha: 0.6, beta: 1.05 }.into(),
        ] {
            assert_eq!(implausible(&camera), [], "{camera:?}");
        }
    }
}
