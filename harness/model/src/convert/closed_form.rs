//! Conversions between models that are the same up to units: closed forms.

use super::Target;
use super::brown::{BrownForm, without_left_out};
use crate::CornerPoint;
use crate::camera::{Camera, Ebner, OpenCv, Photogrammetric};

/// The same camera in the target's convention, `None` if the target cannot hold it. Decided by what the models are and which terms are zero.
pub(super) fn exact(source: &Camera, target: &Target) -> Option<Camera> {
    if let Some(camera) = super::wide_angle::exact(source, target) {
        return Some(camera);
    }
    if loses_terms(source, target) {
        return None;
    }
    let camera = by_formula(source, target, || None)?;
    is_complete(source, target, &camera).then_some(camera)
}

/// Whether terms of Brown's form are surely lost: asked before the camera is made, since most formats have many models.
fn loses_terms(source: &Camera, target: &Target) -> bool {
    let is_brown = match source {
        Camera::OpenCv(_) => !matches!(target, Target::OpenCv { .. }),
        Camera::MicMac(_) => !matches!(target, Target::MicMac { .. }),
        Camera::Agisoft(_) | Camera::Pix4d(_) => true,
        _ => false,
    };
    let is_lost = |form: BrownForm| !matches!(target, Target::Ebner { .. }) && !is_held(&form, target, source);
    is_brown && (!BrownForm::holds(source) || BrownForm::of(source).is_some_and(is_lost))
}

/// The camera in the target's convention by formula, without what the target cannot hold; `None` where there is no formula.
pub(super) fn closed_form(source: &Camera, target: &Target) -> Option<Camera> {
    by_formula(source, target, || super::wide_angle::exact(source, target))
}

/// The same; `wide` is what leads to it from a wide-angle model.
fn by_formula(source: &Camera, target: &Target, wide: impl FnOnce() -> Option<Camera>) -> Option<Camera> {
    match (source, target) {
        (Camera::Photogrammetric(camera), &Target::Photogrammetric { pitch_um, .. }) => {
            Some(without_left_out(pitch(camera, pitch_um).into(), target))
        }
        (Camera::Ebner(camera), &Target::Ebner { pitch_um, .. }) => Some(without_left_out(ebner_pitch(camera, pitch_um).into(), target)),
        (Camera::Ebner(Ebner { base, .. }), &Target::Photogrammetric { pitch_um, .. }) => {
            Some(without_left_out(pitch(base, pitch_um).into(), target))
        }
        (Camera::OpenCv(camera), &Target::OpenCv { coefficients }) => Some(shorter(camera, coefficients).into()),
        (Camera::OpenCvFisheye(_), Target::OpenCvFisheye) => Some(without_left_out(*source, target)),
        (Camera::Photogrammetric(camera), _) if is_pinhole(camera) => BrownForm::of_pinhole(camera)?.to_target(target),
        (Camera::MicMac(camera), &Target::MicMac { .. }) => Some(without_left_out((*camera).into(), target)),
        _ => wide().or_else(|| BrownForm::of(source)?.to_target(target)),
    }
}

/// Whether the closed form holds every term of `source`.
fn is_complete(source: &Camera, target: &Target, camera: &Camera) -> bool {
    match (source, target) {
        (Camera::Photogrammetric(_), Target::Photogrammetric { .. })
        | (Camera::OpenCvFisheye(_), Target::OpenCvFisheye)
        | (Camera::MicMac(_), Target::MicMac { .. }) => target.holds(source),
        (Camera::Ebner(from), &Target::Ebner { pitch_um, b_mm }) => {
            let scaled = from.b_mm * pitch_um / from.base.pitch_um;
            target.holds(source) && (scaled - b_mm).abs() <= 1e-14 * b_mm
        }
        (Camera::Ebner(from), Target::Photogrammetric { .. }) => {
            from.parameters.iter().all(|&value| value == 0.0) && target.holds(&from.base.into())
        }
        (Camera::OpenCv(from), &Target::OpenCv { coefficients }) => from.distortion[coefficients..].iter().all(|&value| value == 0.0),
        (Camera::Photogrammetric(from), _) => {
            is_pinhole(from) && BrownForm::of_pinhole(from).is_some_and(|form| is_held(&form, target, camera))
        }
        _ => BrownForm::holds(source) && BrownForm::of(source).is_some_and(|form| is_held(&form, target, camera)),
    }
}

/// Whether the target holds every term of the form.
pub(super) fn is_held(form: &BrownForm, target: &Target, camera: &Camera) -> bool {
    let affine = form.a != form.d;
    let (k, p) = (form.k, form.p);
    match *target {
        Target::OpenCv { coefficients } => form.b == 0.0 && k[3] == 0.0 && (coefficients > 4 || k[2] == 0.0) && p[2..] == [0.0; 2],
        Target::Agisoft { radial, tangential, affinity, .. } => {
            let zero = |rest: &[f64]| rest.iter().all(|&value| value == 0.0);
            zero(&k[radial..]) && zero(&p[tangential..]) && (affinity || (!affine && form.b == 0.0))
        }
        Target::Pix4d { .. } => !affine && form.b == 0.0 && k[3] == 0.0 && p[2..] == [0.0; 2],
        Target::Photogrammetric { affinity, .. } => form.is_without_distortion() && (affinity || (!affine && form.b == 0.0)),
        Target::Ebner { .. } => form.is_without_distortion() && !affine && form.b == 0.0 && matches!(camera, Camera::Ebner(_)),
        Target::Centred { radial } => {
            let middle = CornerPoint { x: f64::from(form.size.width) / 2.0, y: f64::from(form.size.height) / 2.0 };
            let centred = form.centre.to_corner() == middle;
            centred && !affine && form.b == 0.0 && k[radial..].iter().all(|&k| k == 0.0) && p == [0.0; 4]
        }
        Target::MicMac { radial, tangential, .. } => {
            let held = k[radial.min(4)..].iter().all(|&k| k == 0.0) && p[if tangential { 2 } else { 0 }..].iter().all(|&p| p == 0.0);
            held && !affine && form.b == 0.0
        }
        Target::OpenCvFisheye
        | Target::DoubleSphere
        | Target::Eucm
        | Target::Division
        | Target::Omni { .. }
        | Target::Fov
        | Target::PrismFisheye
        | Target::RadTanPrismFisheye
        | Target::SixPrismFisheye { .. }
        | Target::PtLens { .. }
        | Target::Ocam { .. }
        | Target::MetashapeFisheye { .. } => false,
    }
}

fn is_pinhole(camera: &Photogrammetric) -> bool {
    camera.k == [0.0; 3] && camera.p == [0.0; 2]
}

/// The same pixels, whose size is called another: all lengths scale.
fn pitch(camera: &Photogrammetric, pitch_um: f64) -> Photogrammetric {
    let s = pitch_um / camera.pitch_um;
    let [k1, k2, k3] = camera.k;
    Photogrammetric {
        pitch_um,
        c: camera.c * s,
        x0: camera.x0 * s,
        y0: camera.y0 * s,
        k: [k1 / s.powi(2), k2 / s.powi(4), k3 / s.powi(6)],
        p: camera.p.map(|p| p / s),
        ..*camera
    }
}

fn ebner_pitch(camera: &Ebner, pitch_um: f64) -> Ebner {
    const POWERS: [i32; 12] = [0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3];
    let s = pitch_um / camera.base.pitch_um;
    let parameters = std::array::from_fn(|i| camera.parameters[i] / s.powi(POWERS[i]));
    Ebner { base: pitch(&camera.base, pitch_um), b_mm: camera.b_mm * s, parameters }
}

fn shorter(camera: &OpenCv, coefficients: usize) -> OpenCv {
    let mut shorter = OpenCv { coefficients, ..*camera };
    shorter.distortion[coefficients..].fill(0.0);
    shorter
}
