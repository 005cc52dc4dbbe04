//! Camera models by name, for start values and unknowns.

use calibench_adjust::approximate::interior_from_size;
use calibench_diagnostics::nearest;
use calibench_model::camera::{Camera, CameraModel, DoubleSphere, Eucm, TangentialOrder};
use calibench_model::convert::{ConvertOptions, Target, convert};

use super::{CalibrationError, Optics};

/// Where spherical models start.
const HALF_WAY: f64 = 0.5;

/// The models that can be calibrated.
pub const MODELS: [&str; 15] = [
    "photogrammetric",
    "ebner",
    "opencv4",
    "opencv5",
    "opencv8",
    "opencv12",
    "opencv14",
    "opencv-fisheye",
    "metashape",
    "pix4d",
    "double-sphere",
    "eucm",
    "omni",
    "fov",
    "prism-fisheye",
];

/// Those of them for lenses that picture angles.
const WIDE: [&str; 6] = ["opencv-fisheye", "double-sphere", "eucm", "omni", "fov", "prism-fisheye"];
/// Those with a rational function, which suit wide lenses too.
const RATIONAL: [&str; 3] = ["opencv8", "opencv12", "opencv14"];

/// What the user asked for, or the model that suits what is known.
pub(super) fn name(optics: &Optics) -> &str {
    let usual = if optics.pitch_um.is_some() { "photogrammetric" } else { "opencv5" };
    optics.model.as_deref().unwrap_or(usual)
}

fn target(name: &str, optics: &Optics) -> Result<Target, CalibrationError> {
    let pitch = || optics.pitch_um.ok_or_else(|| CalibrationError::NoPitch { what: format!("{name} is") });
    let width_mm = |pitch_um: f64| f64::from(optics.size.width) * pitch_um * 1e-3;
    Ok(match name {
        "photogrammetric" => Target::photogrammetric(pitch()?),
        // The grid's outer points lie at four tenths of the width.
        "ebner" => Target::Ebner { pitch_um: pitch()?, b_mm: 0.4 * width_mm(pitch()?) },
        "opencv-fisheye" => Target::OpenCvFisheye,
        "metashape" => Target::metashape(),
        "pix4d" => Target::Pix4d { sensor_width_mm: width_mm(pitch()?), order: TangentialOrder::OpenCv },
        "double-sphere" => Target::DoubleSphere,
        "eucm" => Target::Eucm,
        "omni" => Target::Omni { distortion: true },
        "fov" => Target::Fov,
        "prism-fisheye" => Target::PrismFisheye,
        _ => match name.strip_prefix("opencv").map(|n| if n.is_empty() { Ok(5) } else { n.parse() }) {
            Some(Ok(coefficients @ (4 | 5 | 8 | 12 | 14))) => Target::OpenCv { coefficients },
            _ => return Err(unknown(name)),
        },
    })
}

fn unknown(name: &str) -> CalibrationError {
    let near = nearest(name, MODELS).map(str::to_owned);
    CalibrationError::UnknownModel { name: name.to_owned(), known: MODELS.join(", "), near }
}

/// The model that the user asked for, as near to `start` as it comes.
pub(super) fn camera(start: &Camera, optics: &Optics) -> Result<Camera, CalibrationError> {
    // Of a start the misfit does not matter.
    let camera = converted(start, optics, &ConvertOptions { accept: true, ..ConvertOptions::default() })?;
    Ok(if optics.start.is_some() { camera } else { regular(camera) })
}

/// `start` in the model that the user asked for.
pub(super) fn converted(start: &Camera, optics: &Optics, options: &ConvertOptions) -> Result<Camera, CalibrationError> {
    let camera = convert(start, target(name(optics), optics)?, options)?.camera;
    // A zero without a sign.
    let values: Vec<f64> = camera.parameters().iter().map(|parameter| parameter.value + 0.0).collect();
    Ok(camera.with_parameters(&values))
}

/// Whether the model pictures lenses that a camera without distortion does not come near.
pub(super) fn is_wide(optics: &Optics) -> bool {
    // Coefficients that are not solved for are to stay zero.
    WIDE.contains(&name(optics)) || (RATIONAL.contains(&name(optics)) && optics.solve.is_none())
}

/// The model, and its unknowns, that is adjusted first where that of `optics` does not converge from a lens without distortion such as `rough`.
pub(super) fn simpler(rough: &Camera, optics: &Optics) -> Option<(&'static str, &'static [&'static str])> {
    let name = name(optics);
    let angles = matches!(rough, Camera::OpenCvFisheye(_)) || WIDE.contains(&name);
    match name {
        "opencv-fisheye" => None,
        _ if angles => Some(("opencv-fisheye", &["fx", "fy", "cx", "cy", "k1", "k2"])),
        _ if RATIONAL.contains(&name) => Some(("opencv5", &["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"])),
        _ => None,
    }
}

/// Models of spheres hold a pinhole camera where some of their parameters have no effect; there no adjustment can start. The lens half-way to the other
/// end of the range, with the same focal length, is as good a guess.
fn regular(camera: Camera) -> Camera {
    match camera {
        Camera::Eucm(eucm) if eucm.alpha < HALF_WAY => Eucm { alpha: HALF_WAY, beta: 1.0, ..eucm }.into(),
        Camera::DoubleSphere(sphere) if sphere.alpha < HALF_WAY => DoubleSphere { xi: 0.0, alpha: HALF_WAY, ..sphere }.into(),
        other => other,
    }
}

/// Refuses an unknown model, and one in mm without a pixel pitch, before start values are looked for.
pub(super) fn check(optics: &Optics) -> Result<(), CalibrationError> {
    if optics.model.is_none() && optics.pitch_um.is_none() && optics.solve.iter().flatten().any(|name| name == "c") {
        return Err(CalibrationError::NoPitch { what: "c, x0 and y0 are".into() });
    }
    target(name(optics), optics).map(|_| ())
}

/// The names of all parameters of the model of `optics`.
///
/// # Errors
/// As of an unknown model, or one in mm without a pitch.
pub fn parameters(optics: &Optics) -> Result<Vec<&'static str>, CalibrationError> {
    check(optics)?;
    let camera = camera(&interior_from_size(optics.size)?, optics)?;
    Ok(camera.parameters().iter().map(|parameter| parameter.name).collect())
}

/// The parameters to be solved for.
pub(super) fn unknowns(camera: &Camera, optics: &Optics) -> Vec<String> {
    if let Some(names) = &optics.solve {
        return names.clone();
    }
    let rarely: &[&str] = match camera {
        Camera::Photogrammetric(_) => &["k3", "b1", "b2"],
        Camera::Ebner(_) => &["k1", "k2", "k3", "p1", "p2", "b1", "b2"],
        Camera::Agisoft(_) => &["b1", "b2", "k4", "p3", "p4"],
        _ => &[],
    };
    camera.parameters().iter().map(|parameter| parameter.name.to_owned()).filter(|name| !rarely.contains(&name.as_str())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_model::camera::ImageSize;

    const SIZE: ImageSize = ImageSize { width: 1600, height: 1200 };

    #[test]
    fn a_sphere_that_is_one_stays_and_a_pinhole_is_put_half_way() {
        let sphere = |xi: f64, alpha: f64| DoubleSphere { size: SIZE, fx: 500.0, fy: 500.0, cx: 800.0, cy: 600.0, xi, alpha };
        let values = |camera: Camera| camera.parameters().iter().map(|parameter| parameter.value).collect::<Vec<_>>();
        for (before, after) in [((-0.2, 0.6), (-0.2, 0.6)), ((-0.2, 0.5), (-0.2, 0.5)), ((-0.2, 0.4), (0.0, 0.5))] {
            assert_eq!(values(regular(sphere(before.0, before.1).into())), values(sphere(after.0, after.1).into()), "{before:?}");
        }
    }

    #[test]
    fn the_outer_points_of_ebners_grid_lie_at_four_tenths_of_the_width() {
        let optics = Optics { pitch_um: Some(5.0), model: Some("ebner".into()), ..Optics::new(SIZE) };
        let Target::Ebner { pitch_um, b_mm } = target("ebner", &optics).unwrap() else { panic!("another model") };
        assert!((b_mm - 3.2).abs() < 1e-12 && pitch_um == 5.0, "{b_mm}");
    }
}
