//! Calibrations of Qualisys Track Manager: focal lengths and principal point in 64ths of a pixel, OpenCV's coefficients.

use calibench_model::NamedCamera;
use calibench_model::camera::{ImageSize, tool_conventions};
use roxmltree::Node;

use super::PLAIN;
use crate::brown::{Brown, positive};
use crate::format::Keeps;
use crate::number::{finite, pixels};
use crate::source::Source;
use crate::tree::left_out;
use crate::{CameraFileError, CameraFormat, ReadOptions, noted, xml};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "qualisys",
    tool: "Qualisys Track Manager",
    versions: "calibration XML (.qca.txt), and that of its real-time protocol",
    extension: "xml",
    words: "calibration cameras camera serial viewrotation fov_marker fov_video transform intrinsic focallength sensorMinU sensorMaxU focalLengthU focalLengthV \
            centerPointU centerPointV radialDistortion1 tangentalDistortion1",
    many: true,
    recognise: |source| {
        let found = source.xml.as_ref().is_some_and(|document| {
            document.descendants().any(|node| node.has_tag_name("intrinsic") && node.has_attribute("focalLengthU"))
        });
        if found { Ok(()) } else { Err("no `intrinsic` with `focalLengthU`".into()) }
    },
    read,
    convention: Some(&tool_conventions::QUALISYS),
    keeps: Keeps { name: true, ..PLAIN.keeps },
    origin_is_open: true,
    ..PLAIN
};

/// Parts of a pixel that are its unit.
const PARTS: f64 = 64.0;
/// What `intrinsic` has; the focal length in mm belongs to a sensor whose size is not stated.
const KNOWN: [&str; 15] = [
    "focallength",
    "sensorMinU",
    "sensorMaxU",
    "sensorMinV",
    "sensorMaxV",
    "focalLengthU",
    "focalLengthV",
    "centerPointU",
    "centerPointV",
    "skew",
    "radialDistortion1",
    "radialDistortion2",
    "radialDistortion3",
    "tangentalDistortion1",
    "tangentalDistortion2",
];

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let Some(document) = &source.xml else { return Ok(Vec::new()) };
    let (mut cameras, mut without) = (Vec::new(), Vec::new());
    for (index, node) in document.descendants().filter(|node| node.has_tag_name("camera")).enumerate() {
        let name = node.attribute("serial").map_or_else(|| (index + 1).to_string(), str::to_owned);
        match xml::child(node, "intrinsic")? {
            Some(intrinsic) if node.attribute("calibrated") != Some("false") => cameras.push(camera(node, intrinsic, name, options)?),
            _ => without.push(name),
        }
    }
    let note = (!without.is_empty()).then(|| format!("left out, since not calibrated: {}", without.join(", ")));
    Ok(noted(cameras, note.as_slice()))
}

fn camera(node: Node<'_, '_>, intrinsic: Node<'_, '_>, name: String, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let wrong = |name: &str, error: CameraFileError| xml::at(intrinsic, error).of(name);
    let number = |name: &str| finite(xml::attribute(intrinsic, name)?).map_err(|error| wrong(name, error));
    let or_zero = |name: &str| if intrinsic.has_attribute(name) { number(name) } else { Ok(0.0) };
    // The first and the last of the parts that the sensor has.
    let side =
        |low: &str, high: &str| pixels(&((number(high)? - number(low)? + 1.0) / PARTS).to_string()).map_err(|error| wrong(high, error));
    let stated = ImageSize { width: side("sensorMinU", "sensorMaxU")?, height: side("sensorMinV", "sensorMaxV")? };
    let size = options.size_or(Some(stated)).map_err(|error| xml::at(intrinsic, error))?;
    let px = |name: &str| Ok::<f64, CameraFileError>(number(name)? / PARTS);
    let focal = |name: &str| positive(name, px(name)?).map_err(|error| wrong(name, error));
    let place = |name: &str, low: &str| Ok::<f64, CameraFileError>((number(name)? - number(low)?) / PARTS);
    let (cx, cy) = (place("centerPointU", "sensorMinU")?, place("centerPointV", "sensorMinV")?);
    let skew = or_zero("skew")?;
    if skew != 0.0 {
        return Err(wrong("skew", CameraFileError::new(format!("is {skew}: in which unit is not publicly known; expected 0"))));
    }
    let attributes = intrinsic.attributes().map(|attribute| (attribute.name(), ()));
    let mut notes =
        options.of_lens(attributes, &KNOWN, |(), error| xml::at(intrinsic, error.clone()).of(error.element.unwrap_or_default()))?;
    if xml::child(node, "transform")?.is_some() {
        notes.push(left_out("transform"));
    }
    if let Some(turned) = node.attribute("viewrotation").filter(|turned| *turned != "0") {
        notes.push(format!("`viewrotation` is {turned}: pictures are shown turned; the camera is that of the sensor"));
    }
    let k = [or_zero("radialDistortion1")?, or_zero("radialDistortion2")?, or_zero("radialDistortion3")?, 0.0];
    let (p1, p2) = (or_zero("tangentalDistortion1")?, or_zero("tangentalDistortion2")?);
    let brown = Brown { k, p1, p2, ..Brown::plain(size, [focal("focalLengthU")?, focal("focalLengthV")?, cx, cy]) };
    Ok(NamedCamera { notes, ..NamedCamera::new(name, brown.camera()) })
}
