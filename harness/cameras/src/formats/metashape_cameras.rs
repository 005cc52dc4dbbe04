//! The camera XML of Metashape and PhotoScan from 1.0: sensors with their calibrations below `<document>` or `<chunk>`.
//!
//! Each sensor is a camera here. The images' poses belong to the block, not to the cameras, and are not read.

use calibench_model::NamedCamera;
use calibench_model::camera::{Agisoft, AgisoftVersion, Camera, CameraModel, ImageSize};
use calibench_model::named_camera::ParameterCovariance;
use roxmltree::Node;

use super::PLAIN;
use crate::format::{Keeps, KeptCovariance, KeptPose};
use crate::ids::Ids;
use crate::number::{finite, scientific};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions, agisoft, xml};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "metashape-cameras",
    tool: "Agisoft Metashape, PhotoScan",
    versions: "camera XML with sensors: document versions 1 and 2",
    extension: "xml",
    words: "document chunk sensors sensor calibration resolution camera cameras transform label f cx cy k1 covariance",
    verified: None,
    many: true,
    states_size: true,
    recognise: |source| xml::root_is(source.xml.as_ref(), "document"),
    read,
    write: Some(write),
    keeps: Keeps { splines: false, name: true, pitch: true, pose: KeptPose::None, covariance: KeptCovariance::Whole },
    ..PLAIN
};

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let Some(document) = &source.xml else { return Ok(Vec::new()) };
    let root = document.root_element();
    let version = xml::attribute(root, "version")?;
    if !["0", "1", "2"].contains(&version.split('.').next().unwrap_or("")) {
        return Err(xml::at(root, CameraFileError::new(format!("version `{version}` is not known; expected 0, 1 or 2"))));
    }
    let mut cameras = Vec::new();
    for chunk in xml::elements(root).filter(|node| node.has_tag_name("chunk")) {
        let sensors = xml::required(chunk, "sensors")?;
        // Each chunk counts its own.
        let mut ids = Ids::default();
        for sensor in xml::elements(sensors).filter(|node| node.has_tag_name("sensor")) {
            if let Some(id) = sensor.attribute("id") {
                ids.take(id, sensor.document().text_pos_at(sensor.range().start).row as usize)?;
            }
            cameras.extend(self::sensor(sensor, options)?);
        }
    }
    if cameras.is_empty() {
        return Err(xml::at(root, CameraFileError::new("has no sensor with a calibration")));
    }
    Ok(cameras)
}

/// A sensor's camera; `None` for a sensor that was never calibrated.
fn sensor(node: Node<'_, '_>, options: &ReadOptions) -> Result<Option<NamedCamera>, CameraFileError> {
    let Some(calibration) = calibration(node)? else { return Ok(None) };
    let kind = |element: Node<'_, '_>| element.attribute("type").map(|kind| agisoft::projection(element, kind)).transpose();
    let (of_sensor, own) = (kind(node)?, kind(calibration)?);
    if of_sensor.is_some() && own.is_some() && of_sensor != own {
        return Err(xml::at(calibration, CameraFileError::new("is of another type than its sensor")));
    }
    let resolution = match xml::child(calibration, "resolution")? {
        Some(own) => own,
        None => xml::required(node, "resolution")?,
    };
    let size = options.size_or(Some(xml::size_of_attributes(resolution)?)).map_err(|error| xml::at(resolution, error))?;
    let (camera, mut notes) = agisoft::read(calibration, size, own.or(of_sensor), options)?;
    if calibration.attribute("class") == Some("initial") {
        notes.push("holds the initial calibration only, not an adjusted one".into());
    }
    let pitch_um = pitch(node, &mut notes)?;
    let covariance = covariance(node)?;
    let name = node.attribute("label").unwrap_or("");
    Ok(Some(NamedCamera { pitch_um, covariance, notes, ..NamedCamera::new(name, camera) }))
}

/// The adjusted calibration of a sensor, or else its only one.
fn calibration<'a, 'input>(sensor: Node<'a, 'input>) -> Result<Option<Node<'a, 'input>>, CameraFileError> {
    let all: Vec<_> = xml::elements(sensor).filter(|child| child.has_tag_name("calibration")).collect();
    let adjusted: Vec<_> = all.iter().copied().filter(|child| child.attribute("class") == Some("adjusted")).collect();
    match (&adjusted[..], &all[..]) {
        (&[one], _) | ([], &[one]) => Ok(Some(one)),
        (_, &[.., last]) => Err(xml::at(last, CameraFileError::new("stands in `sensor` more than once; expected one that is adjusted"))),
        _ => Ok(None),
    }
}

/// The pixel pitch, um, if it is stated and pixels are square.
fn pitch(sensor: Node<'_, '_>, notes: &mut Vec<String>) -> Result<Option<f64>, CameraFileError> {
    let side = |name: &str| {
        let found = xml::elements(sensor).find(|node| node.has_tag_name("property") && node.attribute("name") == Some(name));
        found.map(|node| xml::attribute(node, "value").and_then(|text| finite(text).map_err(|error| xml::at(node, error)))).transpose()
    };
    match (side("pixel_width")?, side("pixel_height")?) {
        (Some(width), Some(height)) if width == height && width > 0.0 => Ok(Some(width * 1e3)),
        (Some(width), Some(height)) => {
            notes.push(format!("pixels of {width} x {height} mm are not square: no pitch"));
            Ok(None)
        }
        _ => Ok(None),
    }
}

fn covariance(sensor: Node<'_, '_>) -> Result<Option<ParameterCovariance>, CameraFileError> {
    let Some(node) = xml::child(sensor, "covariance")? else { return Ok(None) };
    let parameters: Vec<String> = xml::text(xml::required(node, "params")?)?.split_whitespace().map(str::to_owned).collect();
    let coefficients = xml::required(node, "coeffs")?;
    let wrong = |problem| xml::at(coefficients, CameraFileError::new(problem));
    let text = xml::text(coefficients)?;
    let (n, found) = (parameters.len(), text.split_whitespace().count());
    if n > 32 || found != n * n {
        return Err(wrong(format!("expected {n} x {n} numbers for the parameters above, at most 32, found {found}")));
    }
    let values = text.split_whitespace().map(finite).collect::<Result<_, _>>().map_err(|error| xml::at(coefficients, error))?;
    ParameterCovariance::new(parameters, values).map(Some).map_err(wrong)
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut out = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<document version=\"1.5.0\">\n  <chunk label=\"Chunk 1\" enabled=\"true\">\n",
    );
    out.push_str(&format!("    <sensors next_id=\"{}\">\n", cameras.len()));
    for (id, named) in cameras.iter().enumerate() {
        let is_metashape_s =
            !matches!(named.camera, Camera::Agisoft(Agisoft { version: AgisoftVersion::PhotoScan | AgisoftVersion::Lens, .. }));
        let text = Some(named).filter(|_| is_metashape_s).and_then(|named| written(id, named));
        out.push_str(&text.ok_or_else(|| FORMAT.other_model("cameras of Metashape's models"))?);
    }
    out.push_str("    </sensors>\n  </chunk>\n</document>\n");
    Ok(out)
}

/// A sensor; `None` for a camera that is not Agisoft's.
fn written(id: usize, named: &NamedCamera) -> Option<String> {
    let (inside, kind) = (agisoft::written(&named.camera, "          ")?, agisoft::projection_name(&named.camera));
    let ImageSize { width, height } = named.camera.size();
    let resolution = format!("<resolution width=\"{width}\" height=\"{height}\"/>\n");
    let mut out = format!("      <sensor id=\"{id}\" label=\"{}\" type=\"{kind}\">\n        {resolution}", xml::escaped(&named.name));
    if let Some(pitch) = named.pitch_um {
        for side in ["pixel_width", "pixel_height"] {
            out.push_str(&format!("        <property name=\"{side}\" value=\"{}\"/>\n", scientific(pitch * 1e-3)));
        }
    }
    out.push_str(&format!("        <calibration type=\"{kind}\" class=\"adjusted\">\n          {resolution}{inside}"));
    out.push_str("        </calibration>\n");
    if let Some(covariance) = &named.covariance {
        let values: Vec<String> = covariance.values.iter().copied().map(scientific).collect();
        let (names, values) = (covariance.parameters.join(" "), values.join(" "));
        out.push_str(&format!("        <covariance>\n          <params>{}</params>\n", xml::escaped(&names)));
        out.push_str(&format!("          <coeffs>{values}</coeffs>\n        </covariance>\n"));
    }
    Some(out + "      </sensor>\n")
}
