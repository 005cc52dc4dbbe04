//! Our own camera file: the canonical interior orientation in TOML, every unit in its key, unknown keys refused.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::named_camera::ParameterCovariance;

use super::PLAIN;
use crate::format::{Keeps, KeptCovariance, KeptPose};
use crate::photogrammetric_toml::{CovarianceRows, Head, Wire};
use crate::source::Source;
use crate::toml_tree::{LARGEST, located};
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "photogrammetric",
    tool: "calibench",
    versions: "1",
    extension: "toml",
    words: "format version model image width_px height_px pitch_um interior_orientation c_mm x0_mm y0_mm",
    verified: Some("our own: every number is read back exactly"),
    many: false,
    states_size: true,
    recognise,
    read,
    write: Some(write),
    keeps: Keeps { splines: false, name: true, pitch: true, pose: KeptPose::None, covariance: KeptCovariance::Whole },
    ..PLAIN
};

const NAME: &str = "calibench-camera";
const VERSION: u32 = 1;
fn recognise(source: &Source<'_>) -> Result<(), String> {
    let says_so = |line: &str| line.split_once('=').is_some_and(|(key, value)| key.trim() == "format" && value.contains(NAME));
    if source.xml.is_none() && source.lines().any(|(_, line)| says_so(line)) {
        Ok(())
    } else {
        Err(format!("no line `format = \"{NAME}\"`"))
    }
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    if source.text.len() > LARGEST {
        return Err(CameraFileError::new(format!("is larger than {} MB; expected a camera", LARGEST >> 20)));
    }
    let wrong = |error: toml::de::Error| located(source.text, &error);
    let head: Head = toml::from_str(source.text).map_err(wrong)?;
    if head.version != VERSION {
        return Err(CameraFileError::new(format!("version {} is not known; expected {VERSION}", head.version)).of("version"));
    }
    let wire: Wire = toml::from_str(source.text).map_err(wrong)?;
    if wire.format != NAME {
        return Err(CameraFileError::new(format!("expected \"{NAME}\"")).of("format"));
    }
    let mismatch = || CameraFileError::new("expected a table `ebner` for the model `ebner`, and for no other").of("model");
    let camera = wire.camera().ok_or_else(mismatch)?;
    check(&wire, &camera)?;
    options.size_or(Some(camera.size())).map_err(|error| error.of("image"))?;
    let covariance = wire.covariance.map(|rows| covariance(rows, &camera)).transpose()?;
    let pitch_um = Some(wire.image.pitch_um);
    Ok(vec![NamedCamera { pitch_um, covariance, ..NamedCamera::new(wire.name.unwrap_or_default(), camera) }])
}

/// Values that no camera has.
fn check(wire: &Wire, camera: &Camera) -> Result<(), CameraFileError> {
    let positive = |key: &str, value: f64| {
        let good = value > 0.0 && value.is_finite();
        if good { Ok(()) } else { Err(CameraFileError::new(format!("expected a number above zero, found {value}")).of(key)) }
    };
    positive("pitch_um", wire.image.pitch_um)?;
    positive("width_px", f64::from(wire.image.width_px))?;
    positive("height_px", f64::from(wire.image.height_px))?;
    positive("c_mm", wire.interior_orientation.c_mm)?;
    if let Some(twelve) = &wire.ebner {
        positive("spacing_mm", twelve.spacing_mm)?;
    }
    match camera.parameters().iter().find(|parameter| !parameter.value.is_finite()) {
        Some(wrong) => Err(CameraFileError::new(format!("expected a finite number, found {}", wrong.value)).of(wrong.name)),
        None => Ok(()),
    }
}

fn covariance(wire: CovarianceRows, camera: &Camera) -> Result<ParameterCovariance, CameraFileError> {
    let wrong = |problem: String| CameraFileError::new(problem).of("covariance");
    let known = camera.parameters();
    if let Some(unknown) = wire.parameters.iter().find(|name| known.iter().all(|parameter| parameter.name != name.as_str())) {
        let names: Vec<&str> = known.iter().map(|parameter| parameter.name).collect();
        return Err(wrong(format!("parameter `{unknown}` is not one of {}", names.join(", "))));
    }
    let n = wire.parameters.len();
    if wire.rows.len() != n || wire.rows.iter().any(|row| row.len() != n) {
        return Err(wrong(format!("expected {n} rows of {n} numbers for {n} parameters")));
    }
    ParameterCovariance::new(wire.parameters, wire.rows.concat()).map_err(wrong)
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let named = &cameras[0];
    let mut wire = match &named.camera {
        Camera::Photogrammetric(camera) => Wire::new(NAME, VERSION, camera, None),
        Camera::Ebner(camera) => Wire::new(NAME, VERSION, &camera.base, Some(camera)),
        _ => return Err(FORMAT.other_model("a photogrammetric camera")),
    };
    check(&wire, &named.camera)?;
    wire.name = Some(named.name.clone()).filter(|name| !name.is_empty());
    wire.covariance = named.covariance.as_ref().map(|covariance| {
        let rows = covariance.values.chunks(covariance.parameters.len().max(1)).map(<[f64]>::to_vec).collect();
        CovarianceRows { parameters: covariance.parameters.clone(), rows }
    });
    let body = toml::to_string(&wire).map_err(|error| CameraFileError::new(error.to_string()))?;
    Ok(format!("{ABOUT}\n{body}"))
}

const ABOUT: &str = "\
# A camera in calibench's canonical convention: measured to ideal, mm, y up, from the centre of the frame.
# With xb = x' - x0, yb = y' - y0, r2 = xb^2 + yb^2:
#   x = xb - [xb (k1 r2 + k2 r2^2 + k3 r2^3) + p1 (r2 + 2 xb^2) + 2 p2 xb yb + b1 xb + b2 yb]
#   y = yb - [yb (k1 r2 + k2 r2^2 + k3 r2^3) + 2 p1 xb yb + p2 (r2 + 2 yb^2)]
";
