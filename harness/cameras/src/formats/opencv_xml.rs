//! OpenCV's FileStorage in XML; Metashape's export for OpenCV is one.

use calibench_model::NamedCamera;
use roxmltree::Node;

use super::PLAIN;
use crate::format::{Keeps, KeptCovariance, KeptPose};
use crate::number::scientific;
use crate::source::Source;
use crate::tree::{self, Entry, Value};
use crate::{CameraFileError, CameraFormat, ReadOptions, opencv, xml};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "opencv-xml",
    tool: "OpenCV, Metashape's export for OpenCV",
    versions: "FileStorage XML of 2.4 to 5",
    extension: "xml",
    words: "opencv_storage type_id rows cols dt data camera_matrix distortion_coefficients image_width image_height",
    verified: Some(
        "OpenCV's FileStorage reads what is written, number for number; Metashape's two exports of one adjustment agree to 1e-10",
    ),
    many: false,
    states_size: true,
    recognise: |source| xml::root_is(source.xml.as_ref(), "opencv_storage"),
    read,
    write: Some(write),
    keeps: Keeps { splines: false, name: true, pitch: false, pose: KeptPose::None, covariance: KeptCovariance::Variances },
    half_space: true,
    named_matrices: true,
    ..PLAIN
};

/// Depth of nesting at most.
const MOST_DEPTH: usize = 32;

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let Some(document) = &source.xml else { return Ok(Vec::new()) };
    let mut lines = Lines { text: source.text, byte: 0, line: 1 };
    opencv::read(&entry(document.root_element(), &mut lines, 0)?, options)
}

/// Lines of byte positions that grow: counted once, not from the top for each.
struct Lines<'a> {
    text: &'a str,
    byte: usize,
    line: usize,
}

impl Lines<'_> {
    fn at(&mut self, byte: usize) -> usize {
        self.line += self.text.get(self.byte..byte).map_or(0, |part| part.matches('\n').count());
        self.byte = byte;
        self.line
    }
}

fn entry(node: Node<'_, '_>, lines: &mut Lines<'_>, depth: usize) -> Result<Entry, CameraFileError> {
    let line = lines.at(node.range().start);
    if depth > MOST_DEPTH {
        return Err(xml::at(node, CameraFileError::new(format!("more than {MOST_DEPTH} elements inside each other; expected a camera"))));
    }
    let mut children = Vec::new();
    for child in xml::elements(node) {
        children.push((child.tag_name().name().to_owned(), entry(child, lines, depth + 1)?));
    }
    let value = if children.is_empty() {
        Value::Scalar(node.text().unwrap_or("").to_owned())
    } else if children.iter().all(|(name, _)| name == "_") {
        Value::List(children.into_iter().map(|(_, entry)| entry).collect())
    } else {
        tree::map(children)?
    };
    Ok(Entry { line, value })
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let camera = opencv::written(&cameras[0].camera, &FORMAT)?;
    let mut out = String::from("<?xml version=\"1.0\"?>\n<opencv_storage>\n");
    if !cameras[0].name.is_empty() {
        out.push_str(&format!("<camera_name>\"{}\"</camera_name>\n", xml::escaped(&cameras[0].name.replace('"', "'"))));
    }
    out.push_str(&format!("<image_width>{}</image_width>\n<image_height>{}</image_height>\n", camera.size.width, camera.size.height));
    out.push_str(&format!("<fisheye_model>{}</fisheye_model>\n", u8::from(camera.fisheye)));
    out.push_str(&matrix("camera_matrix", 3, &camera.matrix));
    out.push_str(&matrix("distortion_coefficients", camera.distortion.len(), &camera.distortion));
    out.extend(camera.xi.map(|xi| matrix("xi", 1, &[xi])));
    out.extend(opencv::written_spreads(&cameras[0]).iter().map(|(name, sigmas)| matrix(name, sigmas.len(), sigmas)));
    Ok(out + "</opencv_storage>\n")
}

fn matrix(name: &str, rows: usize, data: &[f64]) -> String {
    let columns = data.len() / rows;
    let lines: Vec<String> =
        data.chunks(columns.max(3)).map(|row| row.iter().map(|&v| scientific(v)).collect::<Vec<_>>().join(" ")).collect();
    let shape = format!("  <rows>{rows}</rows>\n  <cols>{columns}</cols>\n  <dt>d</dt>\n");
    format!("<{name} type_id=\"opencv-matrix\">\n{shape}  <data>\n    {}</data></{name}>\n", lines.join("\n    "))
}
