//! RealityCapture's XMP beside an image: lengths in units of the longer side, from the middle.

use calibench_model::camera::{AgisoftVersion, CameraModel, ImageSize, tool_conventions};
use calibench_model::convert::Target;
use roxmltree::Node;

use super::PLAIN;
use crate::camera::brown::{Brown, middle, positive};
use crate::camera::fit::{Keeps, KeptPose, Model};
use crate::camera::number::{finite, numbers, shortened, shortest};
use crate::camera::source::Source;
use crate::camera::tree::all_left_out;
use crate::camera::{CameraFileError, CameraFormat, NamedCamera, Pose, ReadOptions, xml};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "reality-capture",
    tool: "RealityCapture, RealityScan",
    versions: "XMP version 2 and 3",
    extension: "xmp",
    states_size: false,
    recognise: |source| {
        let found = source.xml.as_ref().is_some_and(|document| description(document.root()).is_some());
        if found { Ok(()) } else { Err("no XMP of namespace xcr".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::REALITY_CAPTURE),
    models: |_| {
        let brown = |name, radial, tangential| Model {
            name,
            target: Target::Agisoft { version: AgisoftVersion::Metashape, radial, tangential, affinity: false },
        };
        vec![brown("brown3", 3, 0), brown("brown4", 4, 0), brown("brown3t2", 3, 2), brown("brown4t2", 4, 2)]
    },
    keeps: Keeps { pose: KeptPose::InWorld, ..PLAIN.keeps },
    ..PLAIN
};

const NAMESPACE: &str = "http://www.capturingreality.com/ns/xcr/1.1#";
/// What is read, and what says nothing of the camera.
const KNOWN: [&str; 18] = [
    "Version",
    "PosePrior",
    "Coordinates",
    "DistortionModel",
    "FocalLength35mm",
    "Skew",
    "AspectRatio",
    "PrincipalPointU",
    "PrincipalPointV",
    "CalibrationPrior",
    "CalibrationGroup",
    "DistortionGroup",
    "InTexturing",
    "InColoring",
    "InMeshing",
    "Rotation",
    "Position",
    "DistortionCoeficients",
];

fn description<'a, 'input>(root: Node<'a, 'input>) -> Option<Node<'a, 'input>> {
    let ours = |node: &Node<'_, '_>| {
        node.has_tag_name("Description")
            && (node.attributes().any(|a| a.namespace() == Some(NAMESPACE))
                || node.children().any(|c| c.tag_name().namespace() == Some(NAMESPACE)))
    };
    root.descendants().find(ours)
}

/// The value called `name`, an attribute or an element.
fn value<'a>(node: Node<'a, '_>, name: &str) -> Result<Option<&'a str>, CameraFileError> {
    match node.attribute((NAMESPACE, name)) {
        Some(text) => Ok(Some(text)),
        None => xml::child(node, name)?.map(xml::text).transpose(),
    }
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let Some(node) = source.xml.as_ref().and_then(|document| description(document.root())) else { return Ok(Vec::new()) };
    let size = options.size_or(None)?;
    let at = |error: CameraFileError, name: &str| xml::at(node, error).of(name);
    let number = |name: &str, default: Option<f64>| match value(node, name)? {
        Some(text) => finite(text).map_err(|error| at(error, name)),
        None => default.ok_or_else(|| at(CameraFileError::new("missing"), name)),
    };
    let longer = f64::from(size.width.max(size.height));
    let f = positive("FocalLength35mm", number("FocalLength35mm", None)?).map_err(|error| at(error, "FocalLength35mm"))? / 36.0 * longer;
    for (name, expected) in [("Skew", 0.0), ("AspectRatio", 1.0)] {
        let found = number(name, Some(expected))?;
        if found != expected {
            return Err(at(CameraFileError::new(format!("is {found}; how it acts is not published; expected {expected}")), name));
        }
    }
    let centre = middle(size);
    let (u, v) = (number("PrincipalPointU", Some(0.0))?, number("PrincipalPointV", Some(0.0))?);
    let coefficients = value(node, "DistortionCoeficients")?.unwrap_or("0 0 0 0 0 0");
    let d: [f64; 6] = numbers(coefficients).map_err(|error| at(error, "DistortionCoeficients"))?;
    let (radial, tangential) = match value(node, "DistortionModel")?.unwrap_or("perspective") {
        "perspective" => (0, false),
        "division" if d == [0.0; 6] => (0, false),
        "division" => {
            let problem =
                "has coefficients of the division model, whose formula is not published; expected zeros, or export with a Brown model";
            return Err(at(CameraFileError::new(problem), "DistortionCoeficients"));
        }
        "brown3" => (3, false),
        "brown4" => (4, false),
        "brown3t2" => (3, true),
        "brown4t2" => (4, true),
        other => {
            let known = "perspective, division, brown3, brown4, brown3t2 or brown4t2";
            return Err(at(CameraFileError::new(format!("`{}` is not known; expected {known}", shortened(other))), "DistortionModel"));
        }
    };
    if d[radial..4].iter().chain(d[4..].iter().filter(|_| !tangential)).any(|&value| value != 0.0) {
        return Err(at(CameraFileError::new("has coefficients that the model has not; expected zeros"), "DistortionCoeficients"));
    }
    let plain = Brown::plain(size, [f, f, centre.x + u * longer, centre.y + v * longer]);
    let camera = Brown { k: [d[0], d[1], d[2], d[3]], p1: d[5], p2: d[4], ..plain }.camera();
    Ok(vec![NamedCamera { pose: pose(node)?, notes: unknown(node), ..NamedCamera::new("", camera) }])
}

fn pose(node: Node<'_, '_>) -> Result<Option<Pose>, CameraFileError> {
    let (Some(rotation), Some(position)) = (value(node, "Rotation")?, value(node, "Position")?) else { return Ok(None) };
    let r: [f64; 9] = numbers(rotation).map_err(|error| xml::at(node, error).of("Rotation"))?;
    let position = numbers(position).map_err(|error| xml::at(node, error).of("Position"))?;
    let rows = std::array::from_fn(|row| std::array::from_fn(|column| r[3 * row + column]));
    let r = crate::camera::pose::rotation(rows).map_err(|error| xml::at(node, error).of("Rotation"))?;
    Ok(Some(Pose { camera_from_world: r, position }))
}

fn unknown(node: Node<'_, '_>) -> Vec<String> {
    let attributes = node.attributes().filter(|a| a.namespace() == Some(NAMESPACE)).map(|a| a.name());
    let elements = xml::elements(node).map(|child| child.tag_name().name());
    all_left_out(attributes.chain(elements).filter(|name| !KNOWN.contains(name)))
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let named = &cameras[0];
    let brown = Brown::of(&named.camera).filter(|brown| brown.skew == 0.0 && brown.has_one_focal());
    let brown = brown.ok_or_else(|| FORMAT.other_model("a camera of Brown's model with one focal length"))?;
    let ImageSize { width, height } = named.camera.size();
    let (longer, centre) = (f64::from(width.max(height)), middle(brown.size));
    let model = match (brown.radial(), brown.has_tangential()) {
        (0, false) => "perspective",
        (4, false) => "brown4",
        (4, true) => "brown4t2",
        (_, false) => "brown3",
        (_, true) => "brown3t2",
    };
    let (f, u, v) = (brown.fx * 36.0 / longer, (brown.cx - centre.x) / longer, (brown.cy - centre.y) / longer);
    let words = |values: &[f64]| values.iter().map(|&value| shortest(value)).collect::<Vec<_>>().join(" ");
    let [k1, k2, k3, k4] = brown.k;
    let pose = named.pose.map_or(String::new(), |pose| {
        let rotation = words(pose.camera_from_world.as_flattened());
        format!("      <xcr:Rotation>{rotation}</xcr:Rotation>\n      <xcr:Position>{}</xcr:Position>\n", words(&pose.position))
    });
    Ok(format!(
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n  <rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n    <rdf:Description xcr:Version=\"3\" \
         xcr:DistortionModel=\"{model}\" xcr:FocalLength35mm=\"{}\"\n       xcr:Skew=\"0\" xcr:AspectRatio=\"1\" xcr:PrincipalPointU=\"{}\" xcr:PrincipalPointV=\"{}\"\n       \
         xcr:CalibrationPrior=\"exact\" xmlns:xcr=\"{NAMESPACE}\">\n{pose}      <xcr:DistortionCoeficients>{}</xcr:DistortionCoeficients>\n    \
         </rdf:Description>\n  </rdf:RDF>\n</x:xmpmeta>\n",
        shortest(f),
        shortest(u),
        shortest(v),
        words(&[k1, k2, k3, k4, brown.p2, brown.p1])
    ))
}
