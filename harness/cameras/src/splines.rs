//! mrcal's splines, which no other tool holds: kept as they are, and fitted where another model is wanted.

use calibench_model::camera::{Camera, CameraModel, Ray, Splined};
use calibench_model::convert::{Conversion, ConvertError, ConvertOptions, ERROR_PX, Region, Target, fit};
use calibench_model::named_camera::{Splines, within};
use calibench_model::{NamedCamera, PixelPoint};

/// Circles about the axis over which other models are fitted where a part of the frame has no ray, as shares of the one that holds the frame.
const CIRCLES: [f64; 8] = [0.99, 0.95, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4];

/// The camera of another model that is nearest to some splines after the best rotation, over the frame or over as much of it as has rays, and a note with its residual.
pub(super) fn nearest(spline: Splined) -> Result<(Camera, Splines, String), String> {
    let mut why = String::new();
    let whole = whole(&spline);
    for region in std::iter::once(Region::Frame).chain(CIRCLES.map(|share| Region::Radius { px: share * whole })) {
        match fitted(&spline, region) {
            Ok((name, found)) => {
                let [rms, max] = [found.residual.rms_px, found.residual.max_px];
                let (at, over) = (found.residual.at, within(region));
                let angle = found.rotation.angle().to_degrees();
                let turned = if angle > 0.0 { format!(", rotated by {angle:.4} degrees") } else { String::new() };
                let note = format!(
                    "a splined model, fitted by {name}{over}: residuals {rms:.3} px RMS, {max:.3} px at most, at ({:.0}, {:.0}){turned}",
                    at.x, at.y
                );
                return Ok((found.camera, Splines { model: spline, residual_px: max, region }, note));
            }
            Err(error) if why.is_empty() => why = format!(": {error}"),
            Err(_) => {}
        }
    }
    Err(format!("a splined model, to which no other can be fitted{why}"))
}

/// Splines as files hold them: with the camera of another model that is nearest, and a note with its residual.
///
/// # Errors
/// No other model can be fitted, in words.
pub fn of_splines(name: &str, spline: Splined) -> Result<NamedCamera, String> {
    let (camera, kept, note) = nearest(spline)?;
    Ok(NamedCamera { splines: Some(Box::new(kept)), notes: vec![note], ..NamedCamera::new(name, camera) })
}

/// The radius about the axis that holds the frame, px.
fn whole(spline: &Splined) -> f64 {
    let Ok(axis) = spline.project(Ray::from_tangent(0.0, 0.0)) else { return 1.0 };
    let (right, bottom) = (f64::from(spline.size.width) - 1.0, f64::from(spline.size.height) - 1.0);
    let corners = [(0.0, 0.0), (right, 0.0), (0.0, bottom), (right, bottom)];
    corners.map(|(x, y)| PixelPoint::new(x, y).distance(axis)).into_iter().fold(1.0, f64::max)
}

/// `spline` in the model of `target`; where that is more than half a pixel off, with the rotation free if this is nearer: its axes are those of the surface, and the camera
/// that is near it may stand askew to these.
///
/// # Errors
/// As [`fit`].
pub(super) fn turned_where_needed(spline: &Splined, target: Target, options: &ConvertOptions) -> Result<Conversion, ConvertError> {
    let held = fit(spline, target, options);
    if options.rotation || held.as_ref().is_ok_and(|found| found.residual.max_px <= ERROR_PX) {
        return held;
    }
    match (held, fit(spline, target, &ConvertOptions { rotation: true, ..options.clone() })) {
        (Ok(held), Ok(turned)) if held.residual.rms_px <= turned.residual.rms_px => Ok(held),
        (Ok(held), Err(_)) => Ok(held),
        (_, Ok(turned)) => Ok(turned),
        (Err(_), Err(turned @ ConvertError::Residual { .. })) => Err(turned),
        (Err(held), Err(_)) => Err(held),
    }
}

fn fitted(spline: &Splined, region: Region) -> Result<(&'static str, Conversion), ConvertError> {
    let held = of_models(spline, region, false);
    if held.as_ref().is_ok_and(|(_, found)| found.residual.max_px <= ERROR_PX) {
        return held;
    }
    match (held, of_models(spline, region, true)) {
        (Ok(held), Ok(turned)) if turned.1.residual.rms_px < held.1.residual.rms_px => Ok(turned),
        (Err(_), Ok(turned)) => Ok(turned),
        (held, _) => held,
    }
}

/// The nearest of several models.
fn of_models(spline: &Splined, region: Region, rotation: bool) -> Result<(&'static str, Conversion), ConvertError> {
    let options = ConvertOptions { accept: true, region, rotation, ..ConvertOptions::default() };
    let models = [
        ("OPENCV8", Target::OpenCv { coefficients: 8 }),
        ("OPENCV12", Target::OpenCv { coefficients: 12 }),
        ("OpenCV's fisheye", Target::OpenCvFisheye),
        ("a fisheye with thin prism", Target::PrismFisheye),
    ];
    let fitted = models.into_iter().map(|(name, target)| fit(spline, target, &options).map(|found| (name, found)));
    let (good, bad): (Vec<_>, Vec<_>) = fitted.partition(Result::is_ok);
    let best = good.into_iter().flatten().min_by(|(_, a), (_, b)| a.residual.rms_px.total_cmp(&b.residual.rms_px));
    best.ok_or_else(|| bad.into_iter().find_map(Result::err).unwrap_or(ConvertError::NotConverged))
}
