//! The wide-angle models that are the same in part: pinhole, unified, enhanced unified, double sphere; fisheyes with and without prism.

use super::Target;
use super::brown::BrownForm;
use crate::PixelPoint;
use crate::camera::{
    AgisoftFisheye, Camera, DoubleSphere, Eucm, FisheyeProjection, Fov, ImageSize, LensProjection, Ocam, Omni, OpenCv, OpenCvFisheye,
    PrismFisheye, PtLens, RadTanPrismFisheye, SixPrismFisheye,
};

/// The same camera in the target's convention where a formula leads to it; `None` where there is none or the target cannot hold all terms.
pub(super) fn exact(source: &Camera, target: &Target) -> Option<Camera> {
    match (source, target) {
        (Camera::DoubleSphere(_), Target::DoubleSphere)
        | (Camera::Omni(_), Target::Omni { distortion: true })
        | (Camera::Fov(_), Target::Fov)
        | (Camera::PrismFisheye(_), Target::PrismFisheye)
        | (Camera::RadTanPrismFisheye(_), Target::RadTanPrismFisheye)
        | (Camera::Ocam(_), Target::Ocam { .. })
        | (Camera::Eucm(Eucm { alpha: 0.5, .. }), Target::Division) => Some(*source),
        // Tools bound beta from below by zero.
        (Camera::Eucm(from), Target::Eucm) if from.beta > 0.0 => Some(*source),
        (Camera::SixPrismFisheye(from), Target::SixPrismFisheye { prism }) => (*prism || from.s == [0.0; 4]).then_some(*source),
        (_, Target::SixPrismFisheye { prism }) => to_six(source).filter(|six| *prism || six.s == [0.0; 4]).map(Camera::from),
        (Camera::SixPrismFisheye(from), _) => exact(&of_six(from)?.into(), target),
        (_, Target::Ocam { .. }) => to_ocam(source),
        (Camera::PtLens(from), Target::PtLens { projection }) => (from.projection == *projection).then_some(*source),
        (_, Target::PtLens { projection }) => to_pt_lens(source, *projection),
        (Camera::PtLens(from), Target::OpenCvFisheye) => of_pt_lens(from).filter(|camera| matches!(camera, Camera::OpenCvFisheye(_))),
        (Camera::PtLens(from), _) => exact(&of_pt_lens(from)?, target),
        (Camera::OpenCvFisheye(from), Target::RadTanPrismFisheye) => then_prism(from),
        (Camera::OpenCvFisheye(from), Target::PrismFisheye) => with_prism(from),
        (Camera::PrismFisheye(from), Target::OpenCvFisheye) => without_prism(from),
        (Camera::AgisoftFisheye(from), Target::MetashapeFisheye { projection }) => (from.projection == *projection).then_some(*source),
        (_, Target::MetashapeFisheye { projection: FisheyeProjection::Equidistant }) => to_metashape(source),
        (Camera::AgisoftFisheye(from), Target::PrismFisheye | Target::OpenCvFisheye | Target::RadTanPrismFisheye) => {
            exact(&equidistant(from)?.into(), target)
        }
        _ => from_unified(&unified(source)?, target),
    }
}

/// The division model, with the stereographic projection and the pinhole, as a polynomial without higher terms.
fn to_ocam(source: &Camera) -> Option<Camera> {
    let Camera::Eucm(Eucm { size, fx, fy, cx, cy, beta, .. }) = exact(source, &Target::Division)? else { return None };
    let a = [-fx, 0.0, beta / (4.0 * fx), 0.0, 0.0, 0.0, 0.0];
    Some(Ocam { c: fy / fx, ..Ocam::round(size, [cx, cy], a) }.into())
}

fn with_prism(from: &OpenCvFisheye) -> Option<Camera> {
    let OpenCvFisheye { size, fx, fy, cx, cy, skew, k } = *from;
    (skew == 0.0).then(|| PrismFisheye { size, fx, fy, cx, cy, k, p: [0.0; 2], s: [0.0; 2] }.into())
}

fn then_prism(from: &OpenCvFisheye) -> Option<Camera> {
    let OpenCvFisheye { size, fx, fy, cx, cy, skew, k: [k0, k1, k2, k3] } = *from;
    let k = [k0, k1, k2, k3, 0.0, 0.0];
    (skew == 0.0).then(|| RadTanPrismFisheye { size, fx, fy, cx, cy, k, p: [0.0; 2], s: [0.0; 4] }.into())
}

fn without_prism(from: &PrismFisheye) -> Option<Camera> {
    let PrismFisheye { size, fx, fy, cx, cy, k, p, s } = *from;
    (p == [0.0; 2] && s == [0.0; 2]).then(|| OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k }.into())
}

/// One with four radial coefficients and less of a prism as one with six.
fn to_six(source: &Camera) -> Option<SixPrismFisheye> {
    let from = match source {
        Camera::OpenCvFisheye(from) => with_prism(from)?,
        Camera::AgisoftFisheye(from) => equidistant(from)?.into(),
        _ => *source,
    };
    let Camera::PrismFisheye(PrismFisheye { size, fx, fy, cx, cy, k: [k1, k2, k3, k4], p, s: [s0, s2] }) = from else { return None };
    Some(SixPrismFisheye { size, fx, fy, cx, cy, k: [k1, k2, k3, k4, 0.0, 0.0], p, s: [s0, 0.0, s2, 0.0] })
}

fn of_six(from: &SixPrismFisheye) -> Option<PrismFisheye> {
    let SixPrismFisheye { size, fx, fy, cx, cy, k: [k1, k2, k3, k4, k5, k6], p, s: [s0, s1, s2, s3] } = *from;
    ([k5, k6, s1, s3] == [0.0; 4]).then_some(PrismFisheye { size, fx, fy, cx, cy, k: [k1, k2, k3, k4], p, s: [s0, s2] })
}

/// A lens of one focal length whose distortion is of the square of the radius alone, in PanoTools' words.
fn to_pt_lens(source: &Camera, projection: LensProjection) -> Option<Camera> {
    let lens = |size: ImageSize, f: f64, centre: PixelPoint, b: f64| -> Option<Camera> {
        let (cx, cy) = (centre.x, centre.y);
        Some(PtLens { size, projection, f, cx, cy, a: 0.0, b, c: 0.0 }.into())
    };
    match (source, projection) {
        (Camera::OpenCvFisheye(OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k: [k1, 0.0, 0.0, 0.0] }), LensProjection::Equidistant)
            if fx == fy =>
        {
            lens(*size, *fx, PixelPoint::new(*cx, *cy), *k1)
        }
        (_, LensProjection::Rectilinear) => {
            let form = BrownForm::of(source).filter(|_| BrownForm::holds(source))?;
            let held = form.b == 0.0 && form.a == form.d && form.k[1..] == [0.0; 3] && form.p == [0.0; 4];
            held.then(|| lens(form.size, form.a, form.centre, form.k[0]))?
        }
        _ => None,
    }
}

/// The lens in the words of OpenCV where it has only such terms.
fn of_pt_lens(from: &PtLens) -> Option<Camera> {
    let PtLens { size, projection, f, cx, cy, a: 0.0, b, c: 0.0 } = *from else { return None };
    match projection {
        LensProjection::Equidistant => Some(OpenCvFisheye { size, fx: f, fy: f, cx, cy, skew: 0.0, k: [b, 0.0, 0.0, 0.0] }.into()),
        LensProjection::Rectilinear => {
            let mut distortion = [0.0; 14];
            distortion[0] = b;
            Some(OpenCv { size, fx: f, fy: f, cx, cy, distortion, coefficients: 4 }.into())
        }
        _ => None,
    }
}

/// Metashape's equidistant fisheye as one with a prism, which has no shear.
fn equidistant(from: &AgisoftFisheye) -> Option<PrismFisheye> {
    let AgisoftFisheye { size, projection, f, b1, b2, k, p: [p1, p2], .. } = *from;
    let PixelPoint { x: cx, y: cy } = from.principal_point();
    let held = projection == FisheyeProjection::Equidistant && b2 == 0.0;
    held.then_some(PrismFisheye { size, fx: f + b1, fy: f, cx, cy, k, p: [p2, p1], s: [0.0; 2] })
}

fn to_metashape(source: &Camera) -> Option<Camera> {
    let of = |size: ImageSize, [fx, fy, cx, cy]: [f64; 4], b2: f64, k: [f64; 4], [p2, p1]: [f64; 2]| {
        let (at, half) = (PixelPoint::new(cx, cy).to_corner(), |length: u32| f64::from(length) / 2.0);
        let (cx, cy) = (at.x - half(size.width), at.y - half(size.height));
        let projection = FisheyeProjection::Equidistant;
        Some(AgisoftFisheye { size, projection, f: fy, cx, cy, b1: fx - fy, b2, k, p: [p1, p2] }.into())
    };
    match *source {
        Camera::OpenCvFisheye(OpenCvFisheye { size, fx, fy, cx, cy, skew, k }) => of(size, [fx, fy, cx, cy], fx * skew, k, [0.0; 2]),
        Camera::PrismFisheye(PrismFisheye { size, fx, fy, cx, cy, k, p, s: [0.0, 0.0] }) => of(size, [fx, fy, cx, cy], 0.0, k, p),
        _ => None,
    }
}

/// The unified camera that pictures alike, `None` where there is none.
fn unified(source: &Camera) -> Option<Omni> {
    // 1 / (alpha d + (1 - alpha) Z) = 1 / (1 - alpha) / (xi d + Z) with xi = alpha / (1 - alpha).
    let of_alpha = |size: ImageSize, [fx, fy, cx, cy]: [f64; 4], alpha: f64| {
        let s = 1.0 - alpha;
        (s > 0.0).then(|| Omni { size, fx: fx / s, fy: fy / s, cx, cy, xi: alpha / s, k: [0.0; 2], p: [0.0; 2] })
    };
    match *source {
        Camera::Omni(camera) => Some(camera),
        Camera::Eucm(Eucm { size, fx, fy, cx, cy, alpha, beta: 1.0 })
        | Camera::DoubleSphere(DoubleSphere { size, fx, fy, cx, cy, xi: 0.0, alpha }) => of_alpha(size, [fx, fy, cx, cy], alpha),
        Camera::DoubleSphere(DoubleSphere { size, fx, fy, cx, cy, xi, alpha: 0.0 }) => {
            Some(Omni { size, fx, fy, cx, cy, xi, k: [0.0; 2], p: [0.0; 2] })
        }
        _ => {
            let form = BrownForm::of(source).filter(|_| BrownForm::holds(source))?;
            let plain = form.b == 0.0 && form.k[2..] == [0.0; 2] && form.p[2..] == [0.0; 2];
            let (k, p) = ([form.k[0], form.k[1]], [form.p[1], form.p[0]]);
            plain.then_some(Omni { size: form.size, fx: form.a, fy: form.d, cx: form.centre.x, cy: form.centre.y, xi: 0.0, k, p })
        }
    }
}

fn from_unified(from: &Omni, target: &Target) -> Option<Camera> {
    let Omni { size, fx, fy, cx, cy, xi, k, p } = *from;
    let straight = k == [0.0; 2] && p == [0.0; 2];
    let s = 1.0 + xi;
    match target {
        Target::Omni { distortion } => (straight || *distortion).then(|| (*from).into()),
        Target::Eucm if straight && s > 0.0 => Some(Eucm { size, fx: fx / s, fy: fy / s, cx, cy, alpha: xi / s, beta: 1.0 }.into()),
        Target::DoubleSphere if straight && s > 0.0 => {
            Some(DoubleSphere { size, fx: fx / s, fy: fy / s, cx, cy, xi: 0.0, alpha: xi / s }.into())
        }
        // The stereographic projection, and the pinhole.
        Target::Division if straight && xi == 1.0 => Some(Eucm { size, fx: fx / s, fy: fy / s, cx, cy, alpha: 0.5, beta: 1.0 }.into()),
        Target::Division if straight && xi == 0.0 => Some(Eucm { size, fx, fy, cx, cy, alpha: 0.5, beta: 0.0 }.into()),
        Target::DoubleSphere | Target::Eucm | Target::Division => None,
        _ if xi == 0.0 => {
            let centre = PixelPoint::new(cx, cy);
            let form = BrownForm { size, a: fx, b: 0.0, d: fy, centre, k: [k[0], k[1], 0.0, 0.0], p: [p[1], p[0], 0.0, 0.0] };
            let camera = form.to_target(target)?;
            super::closed_form::is_held(&form, target, &camera).then_some(camera)
        }
        _ => None,
    }
}

/// Cameras of a wide-angle target that agree with `form` on the axis and beside it, from which a fit may start; the last is the pinhole itself.
pub(super) fn starts(form: &BrownForm, target: &Target) -> Vec<Camera> {
    let BrownForm { size, a: fx, d: fy, .. } = *form;
    let (cx, cy) = (form.centre.x, form.centre.y);
    match target {
        Target::DoubleSphere => [(-0.2, 0.6), (0.0, 0.5), (0.0, 0.0)]
            .map(|(xi, alpha)| DoubleSphere { size, fx: fx * (1.0 + xi), fy: fy * (1.0 + xi), cx, cy, xi, alpha }.into())
            .into(),
        Target::Eucm => [0.6, 0.5, 0.01].map(|alpha| Eucm { size, fx, fy, cx, cy, alpha, beta: 1.0 }.into()).into(),
        Target::Division => [0.0, 0.4, 1.0].map(|beta| Eucm { size, fx, fy, cx, cy, alpha: 0.5, beta }.into()).into(),
        Target::Omni { .. } => [2.0, 1.0, 0.0]
            .map(|xi| Omni { size, fx: fx * (1.0 + xi), fy: fy * (1.0 + xi), cx, cy, xi, k: [0.0; 2], p: [0.0; 2] }.into())
            .into(),
        Target::Fov => [1.2_f64, 0.8, 0.3]
            .map(|w| {
                let slope = 2.0 * (0.5 * w).tan() / w;
                Fov { size, fx: fx / slope, fy: fy / slope, cx, cy, w }.into()
            })
            .into(),
        Target::PrismFisheye => vec![PrismFisheye { size, fx, fy, cx, cy, k: [0.0; 4], p: [0.0; 2], s: [0.0; 2] }.into()],
        Target::MetashapeFisheye { projection } => {
            let plain = PrismFisheye { size, fx, fy, cx, cy, k: [0.0; 4], p: [0.0; 2], s: [0.0; 2] };
            let as_asked = |camera| match camera {
                Camera::AgisoftFisheye(camera) => AgisoftFisheye { projection: *projection, ..camera }.into(),
                other => other,
            };
            to_metashape(&plain.into()).map(as_asked).into_iter().collect()
        }
        Target::SixPrismFisheye { .. } => vec![SixPrismFisheye { size, fx, fy, cx, cy, k: [0.0; 6], p: [0.0; 2], s: [0.0; 4] }.into()],
        Target::PtLens { projection } => {
            // Thoby's radius is longer than the angle already on the axis.
            let f = 0.5 * (fx + fy) / PtLens::slope_on_axis(*projection);
            vec![PtLens { size, projection: *projection, f, cx, cy, a: 0.0, b: 0.0, c: 0.0 }.into()]
        }
        // Equidistant to its second term, stereographic, the pinhole.
        Target::Ocam { .. } => [1.0 / 3.0, 0.25, 0.0]
            .map(|bend| Ocam { c: fy / fx, ..Ocam::round(size, [cx, cy], [-fx, 0.0, bend / fx, 0.0, 0.0, 0.0, 0.0]) }.into())
            .into(),
        Target::RadTanPrismFisheye => {
            vec![RadTanPrismFisheye { size, fx, fy, cx, cy, k: [0.0; 6], p: [0.0; 2], s: [0.0; 4] }.into()]
        }
        _ => Vec::new(),
    }
}
