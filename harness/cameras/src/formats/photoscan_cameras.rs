//! The camera XML of the oldest PhotoScan: a calibration and a pose for each image, below `<collection>`.

use calibench_model::NamedCamera;
use calibench_model::camera::{Agisoft, AgisoftVersion, Camera, CameraModel, ImageSize};
use calibench_model::named_camera::Pose;
use roxmltree::Node;

use super::PLAIN;
use crate::format::{Keeps, KeptCovariance, KeptPose};
use crate::ids::Ids;
use crate::number::{numbers, scientific};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions, agisoft, xml};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "photoscan-cameras",
    tool: "Agisoft PhotoScan",
    versions: "camera XML of the oldest versions, with fx, fy, skew",
    extension: "xml",
    words: "collection cameras camera transform calibration projection width height fx fy cx cy skew",
    verified: None,
    many: true,
    states_size: true,
    recognise: |source| xml::root_is(source.xml.as_ref(), "collection"),
    read,
    write: Some(write),
    keeps: Keeps { splines: false, name: true, pitch: false, pose: KeptPose::InWorld, covariance: KeptCovariance::None },
    ..PLAIN
};

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let Some(document) = &source.xml else { return Ok(Vec::new()) };
    let list = xml::required(document.root_element(), "cameras")?;
    let mut ids = Ids::default();
    let cameras = xml::elements(list).filter(|node| node.has_tag_name("camera")).map(|node| {
        if let Some(id) = node.attribute("id") {
            ids.take(id, node.document().text_pos_at(node.range().start).row as usize)?;
        }
        camera(node, options)
    });
    cameras.collect()
}

fn camera(node: Node<'_, '_>, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let name = xml::attribute(node, "label")?;
    let calibration = xml::required(node, "calibration")?;
    let size = xml::size_of_children(calibration)?;
    if let Some(resolution) = xml::child(node, "resolution")? {
        let stated = xml::size_of_attributes(resolution)?;
        if stated != size {
            let problem = format!("is {} x {} px, the calibration's {} x {}", stated.width, stated.height, size.width, size.height);
            return Err(xml::at(resolution, CameraFileError::new(problem)));
        }
    }
    let size = options.size_or(Some(size)).map_err(|error| xml::at(calibration, error))?;
    let (camera, notes) = agisoft::read(calibration, size, None, options)?;
    let pose = xml::child(node, "transform")?.map(pose).transpose()?;
    Ok(NamedCamera { pose, notes, ..NamedCamera::new(name, camera) })
}

/// The pose of a `<transform>`: 4 x 4, from the camera to the world of the block.
pub(super) fn pose(node: Node<'_, '_>) -> Result<Pose, CameraFileError> {
    let m: [f64; 16] = numbers(xml::text(node)?).map_err(|error| xml::at(node, error))?;
    if m[12..] != [0.0, 0.0, 0.0, 1.0] {
        return Err(xml::at(node, CameraFileError::new("expected 0 0 0 1 as the last row")));
    }
    let camera_from_world = std::array::from_fn(|row| std::array::from_fn(|column| m[4 * column + row]));
    Ok(Pose { camera_from_world, position: [m[3], m[7], m[11]] })
}

/// The text of a `<transform>`.
pub(super) fn transform(pose: &Pose) -> String {
    let rows = (0..3).flat_map(|row| {
        let rotation = (0..3).map(move |column| pose.camera_from_world[column][row]);
        rotation.chain([pose.position[row]])
    });
    rows.chain([0.0, 0.0, 0.0, 1.0]).map(scientific).collect::<Vec<_>>().join(" ")
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<collection>\n  <cameras>\n");
    for named in cameras {
        let is_older = matches!(named.camera, Camera::Agisoft(Agisoft { version: AgisoftVersion::PhotoScan | AgisoftVersion::Lens, .. }));
        let inside = Some(&named.camera).filter(|_| is_older).and_then(|camera| agisoft::written(camera, "        "));
        let inside = inside.ok_or_else(|| FORMAT.other_model("cameras of PhotoScan's older model"))?;
        let ImageSize { width, height } = named.camera.size();
        out.push_str(&format!("    <camera label=\"{}\">\n", xml::escaped(&named.name)));
        out.push_str(&format!("      <resolution width=\"{width}\" height=\"{height}\"/>\n      <calibration>\n"));
        out.push_str(&format!("        <width>{width}</width>\n        <height>{height}</height>\n"));
        out.push_str(&inside);
        out.push_str("      </calibration>\n");
        if let Some(pose) = &named.pose {
            out.push_str(&format!("      <transform>{}</transform>\n", transform(pose)));
        }
        out.push_str("    </camera>\n");
    }
    out.push_str("  </cameras>\n</collection>\n");
    Ok(out)
}
