//! Bouguet's toolbox: Calib_Results.m, with its uncertainties, which are three standard deviations.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv, tool_conventions};
use calibench_model::convert::Target;
use calibench_model::named_camera::ParameterCovariance;

use super::PLAIN;
use crate::brown::{Brown, positive};
use crate::format::{Keeps, KeptCovariance, Model};
use crate::number::{finite, pixels, shortest};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "caltech",
    tool: "Camera Calibration Toolbox for Matlab",
    versions: "Calib_Results.m",
    extension: "m",
    words: "fc cc kc alpha_c fc_error cc_error kc_error nx ny est_fc est_dist",
    recognise,
    read,
    write: Some(write),
    convention: Some(&tool_conventions::CALTECH),
    models: |_| vec![Model { name: "fc, cc, kc", target: Target::OpenCv { coefficients: 5 } }],
    keeps: Keeps { covariance: KeptCovariance::Variances, ..PLAIN.keeps },
    ..PLAIN
};

const NAMES: [&str; 9] = ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"];

/// What is read, and how the calibration was made.
const KNOWN: [&str; 16] = [
    "fc",
    "cc",
    "alpha_c",
    "kc",
    "fc_error",
    "cc_error",
    "alpha_c_error",
    "kc_error",
    "nx",
    "ny",
    "n_ima",
    "est_fc",
    "est_aspect_ratio",
    "center_optim",
    "est_alpha",
    "est_dist",
];

fn recognise(source: &Source<'_>) -> Result<(), String> {
    let has = |name: &str| statements(source).any(|(_, key, _)| key == name);
    if source.xml.is_none() && has("fc") && has("kc") { Ok(()) } else { Err("no `fc = ` and `kc = `".into()) }
}

/// Line, name and value of each `name = value;` that stands on a line.
fn statements<'a>(source: &Source<'a>) -> impl Iterator<Item = (usize, &'a str, &'a str)> + use<'a> {
    let lines = source.text.lines().enumerate();
    lines.filter_map(|(index, line)| {
        let code = line.split('%').next().unwrap_or("");
        let (name, value) = code.split_once('=')?;
        let value = value.trim().trim_end_matches(';').trim();
        Some((index + 1, name.trim(), value.trim_start_matches('[').trim_end_matches(']').trim()))
    })
}

/// The numbers called `name`, and their line.
fn values(source: &Source<'_>, name: &str) -> Result<Option<(usize, Vec<f64>)>, CameraFileError> {
    let mut found = statements(source).filter(|(_, key, _)| *key == name);
    let Some((line, _, text)) = found.next() else { return Ok(None) };
    if let Some((second, _, _)) = found.next() {
        return Err(CameraFileError::new(format!("stands twice, first on line {line}")).on_line(second).of(name));
    }
    let words = text.split([';', ',', ' ', '\t']).filter(|word| !word.is_empty());
    let numbers = words.map(finite).collect::<Result<_, _>>().map_err(|error| error.on_line(line).of(name))?;
    Ok(Some((line, numbers)))
}

fn exactly<const N: usize>(source: &Source<'_>, name: &str) -> Result<[f64; N], CameraFileError> {
    let (line, found) = values(source, name)?.ok_or_else(|| CameraFileError::new("missing").of(name))?;
    let count = found.len();
    found.try_into().map_err(|_| CameraFileError::new(format!("expected {N} numbers, found {count}")).on_line(line).of(name))
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let side = |name| exactly::<1>(source, name).and_then(|[v]| pixels(&v.to_string()).map_err(|error| error.of(name)));
    let stated = if values(source, "nx")?.is_some() { Some(ImageSize { width: side("nx")?, height: side("ny")? }) } else { None };
    let size = options.size_or(stated)?;
    let ([fx, fy], [cx, cy]) = (exactly(source, "fc")?, exactly(source, "cc")?);
    positive("fc", fx.min(fy))?;
    let (line, kc) = values(source, "kc")?.ok_or_else(|| CameraFileError::new("missing").of("kc"))?;
    let [k1, k2, p1, p2, k3] = match kc[..] {
        [k1, k2, p1, p2] => [k1, k2, p1, p2, 0.0],
        [k1, k2, p1, p2, k3] => [k1, k2, p1, p2, k3],
        _ => return Err(CameraFileError::new(format!("expected 5 numbers, found {}", kc.len())).on_line(line).of("kc")),
    };
    let alpha = if values(source, "alpha_c")?.is_some() { exactly::<1>(source, "alpha_c")?[0] } else { 0.0 };
    let mut notes = Vec::new();
    if kc.len() == 4 {
        notes.push("four coefficients: read as k1, k2, p1, p2 of the older toolbox, not as its fisheye's".to_owned());
    }
    let (camera, covariance) = if alpha == 0.0 {
        let mut distortion = [0.0; 14];
        distortion[..5].copy_from_slice(&[k1, k2, p1, p2, k3]);
        let camera = OpenCv { size, fx, fy, cx, cy, distortion, coefficients: 5 };
        (camera.into(), covariance(source)?)
    } else {
        notes.push("`alpha_c` is not zero: read as Metashape's camera, which has a shear; the uncertainties were left out".into());
        let plain = Brown::plain(size, [fx, fy, cx, cy]);
        (Brown { skew: alpha * fx, k: [k1, k2, k3, 0.0], p1, p2, ..plain }.camera(), None)
    };
    if statements(source).any(|(_, key, _)| key.starts_with("omc_")) {
        notes.push("the poses of the calibration images were left out".into());
    }
    let of_images = |key: &str| ["omc_", "Tc_"].iter().any(|start| key.starts_with(start));
    let unknown = statements(source).filter(|(_, key, _)| !KNOWN.contains(key) && !of_images(key)).map(|(line, key, _)| (key, line));
    notes.extend(options.of_file(unknown, |line, error| error.on_line(line))?);
    Ok(vec![NamedCamera { covariance, notes, ..NamedCamera::new("", camera) }])
}

/// Variances of what was estimated: an uncertainty of zero is that of a value held fixed.
fn covariance(source: &Source<'_>) -> Result<Option<ParameterCovariance>, CameraFileError> {
    let mut errors = Vec::new();
    for (name, most) in [("fc_error", 2), ("cc_error", 2), ("kc_error", 5)] {
        let Some((line, found)) = values(source, name)? else { return Ok(None) };
        if found.len() > most {
            return Err(CameraFileError::new(format!("expected {most} numbers, found {}", found.len())).on_line(line).of(name));
        }
        errors.extend((0..most).map(|i| found.get(i).copied().unwrap_or(0.0)));
    }
    let estimated: Vec<(&str, f64)> = NAMES.into_iter().zip(errors).filter(|(_, error)| *error != 0.0).collect();
    let n = estimated.len();
    if n == 0 {
        return Ok(None);
    }
    let mut matrix = vec![0.0; n * n];
    estimated.iter().enumerate().for_each(|(i, (_, error))| matrix[i * n + i] = (error / 3.0).powi(2));
    let names = estimated.iter().map(|(name, _)| (*name).to_owned()).collect();
    ParameterCovariance::new(names, matrix).map(Some).map_err(|problem| CameraFileError::new(problem).of("fc_error"))
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let named = &cameras[0];
    let brown =
        Brown::of(&named.camera).filter(|brown| brown.k[3] == 0.0).ok_or_else(|| FORMAT.other_model("a camera of fc, cc, alpha_c, kc"))?;
    let Brown { fx, fy, skew, cx, cy, k, p1, p2, .. } = brown;
    let ImageSize { width, height } = named.camera.size();
    let column = |values: &[f64]| values.iter().map(|&value| shortest(value)).collect::<Vec<_>>().join(" ; ");
    let mut out = String::from("% Intrinsic and Extrinsic Camera Parameters\n\n");
    let mut line = |about: &str, name: &str, values: &[f64]| out.push_str(&format!("%-- {about}:\n{name} = [ {} ];\n\n", column(values)));
    line("Focal length", "fc", &[fx, fy]);
    line("Principal point", "cc", &[cx, cy]);
    line("Distortion coefficients", "kc", &[k[0], k[1], p1, p2, k[2]]);
    if let Some(errors) = errors(&named.camera, named.covariance.as_ref()) {
        line("Focal length uncertainty", "fc_error", &errors[..2]);
        line("Principal point uncertainty", "cc_error", &errors[2..4]);
        line("Distortion coefficients uncertainty", "kc_error", &errors[4..]);
    }
    out.push_str(&format!("%-- Skew coefficient:\nalpha_c = {};\n\n%-- Image size:\nnx = {width};\nny = {height};\n", shortest(skew / fx)));
    Ok(out)
}

/// Three standard deviations, zero for what was held fixed.
fn errors(camera: &Camera, covariance: Option<&ParameterCovariance>) -> Option<[f64; 9]> {
    let (covariance, Camera::OpenCv(_)) = (covariance?, camera) else { return None };
    let n = covariance.parameters.len();
    let place = |name: &str| covariance.parameters.iter().position(|own| own == name);
    Some(NAMES.map(|name| place(name).map_or(0.0, |i| 3.0 * covariance.values[i * n + i].sqrt())))
}
