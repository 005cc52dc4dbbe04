//! OpenCV's FileStorage in JSON.

use super::PLAIN;
use crate::format::{Keeps, KeptCovariance, KeptPose};
use crate::json::{json, quoted};
use crate::number::row;
use crate::opencv_names::has_camera_matrix;
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions, opencv};
use calibench_model::NamedCamera;

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "opencv-json",
    tool: "OpenCV",
    versions: "FileStorage JSON of 3.4 to 5; lists of lists, as Python's json writes them",
    extension: "json",
    words: "type_id rows cols dt data camera_matrix distortion_coefficients image_width image_height",
    verified: Some("the same numbers as OpenCV's own YAML of one camera"),
    recognise,
    read,
    write: Some(write),
    keeps: Keeps { splines: false, name: true, pitch: false, pose: KeptPose::None, covariance: KeptCovariance::Variances },
    half_space: true,
    named_matrices: true,
    ..PLAIN
};

/// Longer texts are no lists of a camera's numbers.
const LONGEST_LISTS: usize = 1 << 20;

/// Matrices with their tags, or lists of numbers that may be a camera matrix, as Python's json writes them.
fn recognise(source: &Source<'_>) -> Result<(), String> {
    let text = source.text;
    let tagged = || ["\"opencv-matrix\"", "\"opencv-nd-matrix\""].iter().any(|tag| text.contains(tag));
    // MATLAB's structs have a `K` too, which counts from one.
    let listed = || {
        let may_be = text.len() <= LONGEST_LISTS && !text.contains("\"RadialDistortion\"");
        may_be && json(text).is_ok_and(|root| has_camera_matrix(&root))
    };
    let found = text.trim_start().starts_with('{') && (tagged() || listed());
    if found { Ok(()) } else { Err("no JSON with `\"type_id\": \"opencv-matrix\"`, nor with a camera matrix in lists".into()) }
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    opencv::read(&json(source.text)?, options)
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let camera = opencv::written(&cameras[0].camera, &FORMAT)?;
    let mut lines = Vec::new();
    if !cameras[0].name.is_empty() {
        lines.push(format!("\"camera_name\": {}", quoted(&cameras[0].name)));
    }
    lines.push(format!("\"image_width\": {}", camera.size.width));
    lines.push(format!("\"image_height\": {}", camera.size.height));
    lines.push(format!("\"fisheye_model\": {}", u8::from(camera.fisheye)));
    lines.push(matrix("camera_matrix", 3, &camera.matrix));
    lines.push(matrix("distortion_coefficients", camera.distortion.len(), &camera.distortion));
    lines.extend(camera.xi.map(|xi| matrix("xi", 1, &[xi])));
    lines.extend(opencv::written_spreads(&cameras[0]).iter().map(|(name, sigmas)| matrix(name, sigmas.len(), sigmas)));
    Ok(format!("{{\n    {}\n}}\n", lines.join(",\n    ")))
}

fn matrix(name: &str, rows: usize, data: &[f64]) -> String {
    let columns = data.len() / rows;
    let shape = format!("\"type_id\": \"opencv-matrix\", \"rows\": {rows}, \"cols\": {columns}, \"dt\": \"d\"");
    format!("\"{name}\": {{ {shape}, \"data\": [ {} ] }}", row(data))
}
