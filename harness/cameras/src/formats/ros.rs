//! ROS: the YAML that camera_calibration writes and camera_info_manager reads.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv, OpenCvFisheye, tool_conventions};
use calibench_model::convert::Target;

use super::PLAIN;
use super::opencv_yaml::{quoted, tree};
use crate::brown::{Brown, positive};
use crate::format::{Keeps, Model};
use crate::number::{row, shortened};
use crate::source::Source;
use crate::tree::Entry;
use crate::tree::left_out;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "ros",
    tool: "ROS",
    versions: "camera_info YAML of ROS 1 and 2",
    extension: "yaml",
    words: "image_width image_height camera_name camera_matrix distortion_model distortion_coefficients rectification_matrix projection_matrix rows cols data",
    verified: Some("camera_calibration_parsers 1.12 of ROS reads what is written, and OpenCV projects alike, to 1e-8 px"),
    recognise,
    read,
    write: Some(write),
    convention: Some(&tool_conventions::ROS),
    models: |_| {
        vec![
            Model { name: "plumb_bob", target: Target::OpenCv { coefficients: 5 } },
            Model { name: "rational_polynomial", target: Target::OpenCv { coefficients: 8 } },
            Model { name: "equidistant", target: Target::OpenCvFisheye },
        ]
    },
    keeps: Keeps { name: true, ..PLAIN.keeps },
    half_space: true,
    ..PLAIN
};

const KNOWN: [&str; 8] = [
    "image_width",
    "image_height",
    "camera_name",
    "camera_matrix",
    "distortion_model",
    "distortion_coefficients",
    "rectification_matrix",
    "projection_matrix",
];

fn recognise(source: &Source<'_>) -> Result<(), String> {
    let has = |key: &str| source.text.lines().any(|line| line.starts_with(key));
    if source.xml.is_none() && has("camera_matrix:") && has("distortion_model:") && !source.text.contains("!!opencv-matrix") {
        return Ok(());
    }
    Err("no `distortion_model:`".into())
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let root = tree(source.text)?;
    let size = options.size_or(Some(root.size_of("image_width", "image_height")?))?;
    let k: [f64; 9] = matrix(&root, "camera_matrix")?;
    check("camera_matrix", root.required("camera_matrix")?, &k)?;
    let entry = root.required("distortion_coefficients")?;
    let d = entry.required("data").and_then(Entry::row).map_err(|error| error.of("distortion_coefficients"))?;
    let model = root.text_of("distortion_model")?;
    let camera = of_model(model, size, [k[0], k[4], k[2], k[5]], &d);
    let camera = camera.map_err(|error| error.on_line(entry.line).of("distortion_coefficients"))?;
    let mut notes = root.of_file(&KNOWN, options)?;
    let rectification = root.key("rectification_matrix")?.map(|_| matrix(&root, "rectification_matrix")).transpose()?;
    let projection = root.key("projection_matrix")?.map(|_| matrix(&root, "projection_matrix")).transpose()?;
    notes.extend(rectified(["rectification_matrix", "projection_matrix"], &k, rectification, projection));
    let name = root.key("camera_name")?.map(Entry::text).transpose()?.unwrap_or("");
    Ok(vec![NamedCamera { notes, ..NamedCamera::new(name, camera) }])
}

/// Whether `k`, of the entry called `name`, is a camera matrix without a skew.
pub(super) fn check(name: &str, entry: &Entry, k: &[f64; 9]) -> Result<(), CameraFileError> {
    let lower = k[3] == 0.0 && k[6..] == [0.0, 0.0, 1.0];
    if !lower || k[1] != 0.0 {
        return Err(entry.wrong("expected fx, 0, cx; 0, fy, cy; 0, 0, 1").of(name));
    }
    positive(name, k[0])?;
    positive(name, k[4])?;
    Ok(())
}

fn matrix<const N: usize>(root: &Entry, name: &str) -> Result<[f64; N], CameraFileError> {
    root.required(name)?.row_of::<N>("data").map_err(|error| error.of(name))
}

/// The camera of a distortion model and its coefficients.
pub(super) fn of_model(model: &str, size: ImageSize, [fx, fy, cx, cy]: [f64; 4], d: &[f64]) -> Result<Camera, CameraFileError> {
    let wrong = |expected: &str| Err(CameraFileError::new(format!("expected {expected} coefficients for {model}, found {}", d.len())));
    match (model, d.len()) {
        ("plumb_bob", 4 | 5) | ("rational_polynomial", 8 | 12 | 14) | ("plumb_bob" | "", 0) => {
            let mut distortion = [0.0; 14];
            distortion[..d.len()].copy_from_slice(d);
            Ok(OpenCv { size, fx, fy, cx, cy, distortion, coefficients: d.len().max(4) }.into())
        }
        ("equidistant" | "fisheye", 4) => Ok(OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k: [d[0], d[1], d[2], d[3]] }.into()),
        ("plumb_bob", _) => wrong("4 or 5"),
        ("rational_polynomial", _) => wrong("8, 12 or 14"),
        ("equidistant" | "fisheye", _) => wrong("4"),
        _ => {
            let known = "plumb_bob, rational_polynomial, equidistant";
            Err(CameraFileError::new(format!("model `{}` is not known; expected {known}", shortened(model))))
        }
    }
}

/// What is said of the rectified image, which is another camera's, under these names.
pub(super) fn rectified([of_r, of_p]: [&str; 2], k: &[f64; 9], r: Option<[f64; 9]>, p: Option<[f64; 12]>) -> Vec<String> {
    let mut notes = Vec::new();
    if r.is_some_and(|r| r != [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]) {
        notes.push(left_out(of_r));
    }
    if let Some(p) = p {
        if p[3] != 0.0 && p[0] != 0.0 {
            notes.push(format!("`{of_p}` says a stereo baseline of {}: left out", -p[3] / p[0]));
        }
        if p[..3] != k[..3] || p[4..7] != k[3..6] {
            notes.push(format!("`{of_p}` is that of the rectified image, not of this one: left out"));
        }
    }
    notes
}

/// What a camera without a name is called.
const UNNAMED: &str = "camera";

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let named = &cameras[0];
    let ImageSize { width, height } = named.camera.size();
    let (model, [fx, fy, cx, cy], d) =
        parts(&named.camera).ok_or_else(|| FORMAT.other_model("a camera of OpenCV's models, without shear"))?;
    // camera_info_manager compares the name: an empty one is no name.
    let name = if named.name.trim().is_empty() { UNNAMED } else { &named.name };
    let mut out = format!("image_width: {width}\nimage_height: {height}\ncamera_name: {}\n", quoted(name));
    let mut matrix = |name: &str, rows: usize, data: &[f64]| {
        let columns = data.len() / rows;
        out.push_str(&format!("{name}:\n  rows: {rows}\n  cols: {columns}\n  data: [{}]\n", row(data)));
    };
    matrix("camera_matrix", 3, &[fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0]);
    matrix("distortion_coefficients", 1, &d);
    matrix("rectification_matrix", 3, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    matrix("projection_matrix", 3, &[fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0]);
    Ok(out.replacen("distortion_coefficients", &format!("distortion_model: {model}\ndistortion_coefficients"), 1))
}

/// Model, fx, fy, cx, cy and coefficients.
fn parts(camera: &Camera) -> Option<(&'static str, [f64; 4], Vec<f64>)> {
    match *camera {
        Camera::OpenCvFisheye(OpenCvFisheye { fx, fy, cx, cy, skew: 0.0, k, .. }) => Some(("equidistant", [fx, fy, cx, cy], k.to_vec())),
        Camera::OpenCv(OpenCv { fx, fy, cx, cy, distortion, coefficients, .. }) if coefficients > 5 => {
            Some(("rational_polynomial", [fx, fy, cx, cy], distortion[..coefficients].to_vec()))
        }
        _ => {
            let Brown { fx, fy, cx, cy, k: [k1, k2, k3, _], p1, p2, .. } = Brown::of(camera).filter(|b| b.skew == 0.0 && b.k[3] == 0.0)?;
            Some(("plumb_bob", [fx, fy, cx, cy], vec![k1, k2, p1, p2, k3]))
        }
    }
}
