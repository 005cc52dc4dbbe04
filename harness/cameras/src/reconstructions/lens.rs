//! Cameras with the parameters that a tool's model has, ready to be adjusted.

use calibench_model::camera::{Agisoft, AgisoftFisheye, AgisoftVersion, Camera, FisheyeProjection, ImageSize, OpenCvFisheye};
use calibench_model::reconstruction::ReconstructedCamera;
use calibench_model::{CornerPoint, NamedCamera, PixelPoint};

use crate::brown::Brown;

/// Names of the radial coefficients.
const RADIAL: [&str; 4] = ["k1", "k2", "k3", "k4"];

/// A frame around `[cx, cy]` px; the principal point as Agisoft counts it, from the middle.
fn from_middle(size: ImageSize, [cx, cy]: [f64; 2]) -> [f64; 2] {
    let corner = PixelPoint::new(cx, cy).to_corner();
    [corner.x - f64::from(size.width) / 2.0, corner.y - f64::from(size.height) / 2.0]
}

/// A camera of one focal length and `radial` coefficients, which two focal lengths that vary apart would not be.
pub(super) fn one_focal(name: &str, size: ImageSize, f: f64, centre: [f64; 2], k: [f64; 4], radial: usize) -> ReconstructedCamera {
    let [cx, cy] = from_middle(size, centre);
    let camera = Agisoft { size, version: AgisoftVersion::Metashape, f, cx, cy, b1: 0.0, b2: 0.0, k, p: [0.0; 4] };
    let lens = ["f"].iter().chain(&RADIAL[..radial]).copied().collect();
    ReconstructedCamera { named: NamedCamera::new(name, camera.into()), lens, principal_point: vec!["cx", "cy"] }
}

/// The same of a fisheye whose radius is a polynomial of the angle.
pub(super) fn one_focal_fisheye(name: &str, camera: &OpenCvFisheye, radial: usize) -> ReconstructedCamera {
    let OpenCvFisheye { size, fx, cx, cy, k, .. } = *camera;
    let [cx, cy] = from_middle(size, [cx, cy]);
    let camera = AgisoftFisheye { size, projection: FisheyeProjection::Equidistant, f: fx, cx, cy, b1: 0.0, b2: 0.0, k, p: [0.0; 2] };
    let lens = ["f"].iter().chain(&RADIAL[..radial]).copied().collect();
    ReconstructedCamera { named: NamedCamera::new(name, camera.into()), lens, principal_point: vec!["cx", "cy"] }
}

/// Brown's camera of one focal length with k1 to k3 and p1, p2.
pub(super) fn one_focal_brown(name: &str, brown: &Brown) -> ReconstructedCamera {
    let mut camera = one_focal(name, brown.size, brown.fx, [brown.cx, brown.cy], brown.k, 3);
    if let Camera::Agisoft(agisoft) = &mut camera.named.camera {
        // Brown's order.
        agisoft.p = [brown.p2, brown.p1, 0.0, 0.0];
    }
    camera.lens.extend(["p1", "p2"]);
    camera
}

/// The camera of a COLMAP model of this name.
pub(super) fn colmap(named: NamedCamera, model: &str) -> ReconstructedCamera {
    let two = |lens: &[&'static str]| -> Vec<&'static str> { ["fx", "fy"].iter().chain(lens).copied().collect() };
    let name = named.name.clone();
    let radial = match model {
        "SIMPLE_PINHOLE" | "SIMPLE_FISHEYE" => Some(0),
        "SIMPLE_RADIAL" | "SIMPLE_RADIAL_FISHEYE" => Some(1),
        "RADIAL" | "RADIAL_FISHEYE" => Some(2),
        _ => None,
    };
    if let (Camera::OpenCvFisheye(fisheye), Some(radial)) = (&named.camera, radial) {
        return one_focal_fisheye(&name, fisheye, radial);
    }
    if let (Some(brown), Some(radial)) = (Brown::of(&named.camera), radial) {
        return one_focal(&name, brown.size, brown.fx, [brown.cx, brown.cy], brown.k, radial);
    }
    let lens = match model {
        "OPENCV" => two(&["k1", "k2", "p1", "p2"]),
        "OPENCV_FISHEYE" => two(&RADIAL),
        "FULL_OPENCV" => two(&["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"]),
        "FOV" => two(&["w"]),
        "THIN_PRISM_FISHEYE" => two(&["k1", "k2", "p1", "p2", "k3", "k4", "s1", "s2"]),
        "RAD_TAN_THIN_PRISM_FISHEYE" => two(&["k0", "k1", "k2", "k3", "k4", "k5", "p0", "p1", "s0", "s1", "s2", "s3"]),
        "SIMPLE_DIVISION" | "DIVISION" => two(&["beta"]),
        "EUCM" => two(&["alpha", "beta"]),
        _ => two(&[]),
    };
    ReconstructedCamera { named, lens, principal_point: vec!["cx", "cy"] }
}

/// The middle of a frame that holds all points around it, and the frame: `half` are the largest distances along x and y, px.
pub(super) fn frame_around([x, y]: [f64; 2]) -> ImageSize {
    let side = |half: f64| (2.0 * half.abs().ceil() + 2.0).clamp(2.0, f64::from(1 << 20)) as u32;
    ImageSize { width: side(x), height: side(y) }
}

/// From the middle of a frame, y up, to its pixels.
pub(super) fn from_the_middle(size: ImageSize, [x, y]: [f64; 2]) -> PixelPoint {
    CornerPoint { x: f64::from(size.width) / 2.0 + x, y: f64::from(size.height) / 2.0 - y }.to_pixel()
}
