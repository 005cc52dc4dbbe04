//! OpenCV's FileStorage in JSON.

use super::PLAIN;
use crate::format::{Keeps, KeptCovariance, KeptPose};
use crate::json::{json, quoted};
use crate::number::row;
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions, opencv};
use calibench_model::NamedCamera;

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "opencv-json",
    tool: "OpenCV",
    versions: "FileStorage JSON of 3.4 to 5",
    extension: "json",
    verified: Some("the same numbers as OpenCV's own YAML of one camera"),
    recognise: |source| {
        let text = source.text;
        let found =
            text.trim_start().starts_with('{') && ["\"opencv-matrix\"", "\"opencv-nd-matrix\""].iter().any(|tag| text.contains(tag));
        if found { Ok(()) } else { Err("no JSON with `\"type_id\": \"opencv-matrix\"`".into()) }
    },
    read,
    write: Some(write),
    keeps: Keeps { splines: false, name: true, pitch: false, pose: KeptPose::None, covariance: KeptCovariance::Variances },
    half_space: true,
    ..PLAIN
};

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
