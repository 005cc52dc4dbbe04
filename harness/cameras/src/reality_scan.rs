//! The camera of RealityCapture and RealityScan: lengths in units of the longer side, from the middle of the frame.

use calibench_model::camera::{AgisoftVersion, Camera, CameraModel, Eucm, ImageSize};
use calibench_model::convert::Target;

use super::brown::{Brown, middle, positive};
use super::format::Model;
use super::{CameraFileError, CameraFormat, Lens};

/// Focal length of a film 36 mm wide, mm, principal point and skew, in units of the longer side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lengths {
    pub f35: f64,
    pub u: f64,
    pub v: f64,
    pub skew: f64,
    /// Focal length along y over that along x.
    pub aspect: f64,
}

/// k1 to k4, t1, t2 in the tool's order.
pub(super) type Coefficients = [f64; 6];

/// What is assumed of a division model.
pub(super) const DIVISION: &str = "division model: the tool publishes no formula; assumed is the usual one, x = x' / (1 + k1 r'^2) from the image, in units of the focal length";

fn longer(size: ImageSize) -> f64 {
    f64::from(size.width.max(size.height))
}

/// The camera of a lens; coefficients that the lens has not are to be zero.
pub(super) fn camera(size: ImageSize, lengths: &Lengths, d: &Coefficients, lens: Lens) -> Result<Camera, CameraFileError> {
    let (scale, centre) = (longer(size), middle(size));
    let f = positive("f", lengths.f35)? / 36.0 * scale;
    let (fy, skew) = (positive("aspect", lengths.aspect)? * f, lengths.skew * scale);
    let (cx, cy) = (centre.x + lengths.u * scale, centre.y + lengths.v * scale);
    if lens == Lens::Division {
        if d[1..].iter().any(|&value| value != 0.0) {
            return Err(CameraFileError::new("has more than k1; the division model has no more"));
        }
        if skew != 0.0 {
            return Err(CameraFileError::new(format!("has a skew of {}, which is not known here beside the division model", lengths.skew)));
        }
        return Ok(Eucm { size, fx: f, fy, cx, cy, alpha: 0.5, beta: -4.0 * d[0] }.into());
    }
    let plain = Brown::plain(size, [f, fy, cx, cy]);
    // In Brown's order: t1 multiplies r^2 + 2 x^2.
    Ok(Brown { k: [d[0], d[1], d[2], d[3]], p1: d[5], p2: d[4], skew, ..plain }.camera())
}

/// The parts of a camera of the tool's lenses.
pub(super) fn parts(camera: &Camera, format: &CameraFormat) -> Result<(Lengths, Coefficients, Lens), CameraFileError> {
    let (brown, d, lens) = match *camera {
        Camera::Eucm(Eucm { size, fx, fy, cx, cy, alpha: 0.5, beta }) => {
            (Brown::plain(size, [fx, fy, cx, cy]), [0.0 - 0.25 * beta, 0.0, 0.0, 0.0, 0.0, 0.0], Lens::Division)
        }
        _ => {
            let brown = Brown::of(camera).ok_or_else(|| format.other_model("a camera of Brown's or the division model"))?;
            let [k1, k2, k3, k4] = brown.k;
            (brown, [k1, k2, k3, k4, brown.p2, brown.p1], Lens::Brown)
        }
    };
    let (scale, centre) = (longer(camera.size()), middle(camera.size()));
    let (u, v) = ((brown.cx - centre.x) / scale, (brown.cy - centre.y) / scale);
    let lengths = Lengths { f35: brown.fx * 36.0 / scale, u, v, skew: brown.skew / scale, aspect: brown.fy / brown.fx };
    Ok((lengths, d, lens))
}

/// Brown's lenses with one focal length.
pub(super) fn brown_models() -> Vec<Model> {
    [("brown3", 3, 0), ("brown4", 4, 0), ("brown3t2", 3, 2), ("brown4t2", 4, 2)].map(|lens| brown(lens, false)).into()
}

/// Those with skew and aspect ratio, then the division model.
pub(super) fn richer_models() -> Vec<Model> {
    let kplus = [("kplus-brown3t2", 3, 2), ("kplus-brown4t2", 4, 2)].map(|lens| brown(lens, true));
    [&kplus[..], &[Model { name: "division", target: Target::Division }]].concat()
}

fn brown((name, radial, tangential): (&'static str, usize, usize), affinity: bool) -> Model {
    Model { name, target: Target::Agisoft { version: AgisoftVersion::Metashape, radial, tangential, affinity } }
}
