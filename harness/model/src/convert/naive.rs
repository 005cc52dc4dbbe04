//! The Canon paper's Table 2: the direct conversion, which ignores the direction of the polynomial.

use super::brown::{BrownForm, frame};
use super::{ConvertError, Target};
use crate::SensorPoint;
use crate::camera::{Camera, Photogrammetric, TangentialOrder};

/// What the direct conversion makes of the decentring coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tangential {
    /// As printed: p1 is the tool's first, p2 its second, over c, whatever their order and the direction of y.
    AsPrinted,
    /// In Brown's order and with y up, as the tool's formulas mean them.
    Converted,
}

/// The direct conversion of the Canon paper: `k_i = K_i / c^(2i)`, `p_i = P_i / c`, with c in mm through the pixel pitch.
///
/// Right to first order only: the tools map ideal to distorted coordinates, this camera measured to ideal ones. The printed `kc5 / c^4` of
/// OpenCV's k3 is a misprint for `kc5 / c^6`. The principal distance is the mean of those along x and y; an affinity is left out.
///
/// # Errors
/// [`ConvertError::NotInTable`] for other models and for terms that the table does not have; a pitch that is not positive.
///
/// Source: Canon T3 paper, Table 2; Hastedt and Luhmann 2015.
pub fn naive(source: &Camera, pitch_um: f64, tangential: Tangential) -> Result<Photogrammetric, ConvertError> {
    Target::photogrammetric(pitch_um).check()?;
    let form = BrownForm::of(source).filter(|form| BrownForm::holds(source) && form.k[3] == 0.0 && form.p[2..] == [0.0; 2]);
    let form = form.ok_or(ConvertError::NotInTable)?;
    let c = 0.5 * (form.a + form.d) * pitch_um * 1e-3;
    let principal = frame(form.size, pitch_um)?.to_sensor(form.centre);
    let k = [form.k[0] / c.powi(2), form.k[1] / c.powi(4), form.k[2] / c.powi(6)];
    let [first, second] = match tangential {
        // y up turns the sign of the term that is even in y: Brown's p2.
        Tangential::Converted => [form.p[0], -form.p[1]],
        Tangential::AsPrinted if order(source) == TangentialOrder::OpenCv => [form.p[1], form.p[0]],
        Tangential::AsPrinted => [form.p[0], form.p[1]],
    };
    let p = [first / c, second / c];
    Ok(Photogrammetric { size: form.size, pitch_um, c, x0: principal.x, y0: principal.y, k, p, b: [0.0; 2] })
}

/// The tool's camera of which [`naive`] makes `camera`: Table 2 read backwards, for published values that were converted by it. Without b1 and b2.
///
/// # Errors
/// A target that is not OpenCV's, Agisoft's or Pix4D's.
pub fn from_naive(camera: &Photogrammetric, target: Target, tangential: Tangential) -> Result<Camera, ConvertError> {
    target.check()?;
    let form = first_order_form(camera).ok_or(ConvertError::NotInTable)?;
    let blank = target.blank(camera.size);
    if BrownForm::of(&blank).is_none() {
        return Err(ConvertError::NotInTable);
    }
    let printed = camera.p.map(|p| p * camera.c);
    let form = match tangential {
        Tangential::Converted => form,
        Tangential::AsPrinted if order(&blank) == TangentialOrder::OpenCv => BrownForm { p: [printed[1], printed[0], 0.0, 0.0], ..form },
        Tangential::AsPrinted => BrownForm { p: [printed[0], printed[1], 0.0, 0.0], ..form },
    };
    form.to_target(&target).ok_or(ConvertError::NotInTable)
}

/// A start for a fit across the directions.
pub(super) fn first_order(source: &Camera, target: &Target) -> Option<Camera> {
    match (source, target) {
        (Camera::Photogrammetric(camera), _) => first_order_form(camera)?.to_target(target),
        (_, &Target::Photogrammetric { pitch_um, .. }) => {
            let camera = naive(source, pitch_um, Tangential::Converted).ok()?;
            Some(super::brown::without_left_out(camera.into(), target))
        }
        _ => super::closed_form::closed_form(source, target),
    }
}

/// The polynomial with its sign turned, normalised.
fn first_order_form(camera: &Photogrammetric) -> Option<BrownForm> {
    let centre = frame(camera.size, camera.pitch_um).ok()?.to_pixel(SensorPoint { x: camera.x0, y: camera.y0 });
    let (c, [k1, k2, k3], [p1, p2]) = (camera.c, camera.k, camera.p);
    let focal = c * 1e3 / camera.pitch_um;
    let k = [k1 * c.powi(2), k2 * c.powi(4), k3 * c.powi(6), 0.0];
    Some(BrownForm { size: camera.size, a: focal, b: 0.0, d: focal, centre, k, p: [p1 * c, -p2 * c, 0.0, 0.0] })
}

fn order(camera: &Camera) -> TangentialOrder {
    match camera {
        Camera::Pix4d(camera) => camera.order,
        _ => camera.convention().order,
    }
}
