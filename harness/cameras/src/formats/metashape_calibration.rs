//! The calibration XML of Metashape, and the one with `fx`, `fy` of PhotoScan before 1.2 and of Lens.

use calibench_model::NamedCamera;
use calibench_model::camera::{Agisoft, AgisoftVersion, Camera, CameraModel, ImageSize};

use super::PLAIN;
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions, agisoft, xml};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "metashape",
    tool: "Agisoft Metashape, PhotoScan, Lens",
    versions: "calibration XML: Metashape and PhotoScan from 1.2 (f; frame cameras and fisheyes), older PhotoScan and Lens (fx, fy)",
    extension: "xml",
    words: "calibration projection width height f cx cy b1 b2 k1 k2 k3 k4 p1 p2 date",
    verified: Some(
        "Metashape's own OpenCV export of the same adjustment pictures every ray alike, to 1e-10 of the frame (frame cameras with f; not fx, fy, not fisheyes)",
    ),
    many: false,
    states_size: true,
    recognise: |source| {
        // Qualisys' calibrations have that root too, around their cameras.
        let rig = source.xml.as_ref().is_some_and(|document| document.root_element().children().any(|child| child.has_tag_name("cameras")));
        if rig { Err("`calibration` holds `cameras`".into()) } else { xml::root_is(source.xml.as_ref(), "calibration") }
    },
    read,
    write: Some(write),
    ..PLAIN
};

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let Some(document) = &source.xml else { return Ok(Vec::new()) };
    let root = document.root_element();
    let size = options.size_or(Some(xml::size_of_children(root)?)).map_err(|error| xml::at(root, error))?;
    let (camera, mut notes) = agisoft::read(root, size, None, options)?;
    if matches!(camera, Camera::Agisoft(Agisoft { version: AgisoftVersion::PhotoScan | AgisoftVersion::Lens, .. })) {
        notes.push("read as PhotoScan's before 1.2; Lens writes the same elements, with the same formulas".into());
    }
    Ok(vec![NamedCamera { notes, ..NamedCamera::new("", camera) }])
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let camera = &cameras[0].camera;
    let inside = agisoft::written(camera, "  ").ok_or_else(|| FORMAT.other_model("a camera of Agisoft's models"))?;
    let (projection, ImageSize { width, height }) = (agisoft::projection_name(camera), camera.size());
    let size = format!("  <projection>{projection}</projection>\n  <width>{width}</width>\n  <height>{height}</height>\n");
    Ok(format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<calibration>\n{size}{inside}</calibration>\n"))
}
