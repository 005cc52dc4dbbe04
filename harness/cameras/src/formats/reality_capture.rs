//! RealityCapture's and RealityScan's XMP beside an image.

use calibench_model::NamedCamera;
use calibench_model::camera::tool_conventions;
use calibench_model::named_camera::Pose;
use roxmltree::Node;

use super::PLAIN;
use crate::format::{Keeps, KeptPose};
use crate::number::{finite, numbers, shortened, shortest};
use crate::reality_scan::{self, Coefficients, DIVISION, Lengths};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, Lens, ReadOptions, xml};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "reality-capture",
    tool: "RealityCapture, RealityScan",
    versions: "XMP version 2 to 4",
    extension: "xmp",
    words: "xmpmeta RDF Description xcr DistortionModel FocalLength35mm PrincipalPointU PrincipalPointV DistortionCoeficients Rotation Position Skew AspectRatio",
    states_size: false,
    recognise: |source| {
        let found = source.xml.as_ref().is_some_and(|document| description(document.root()).is_some());
        if found { Ok(()) } else { Err("no XMP of namespace xcr".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::REALITY_CAPTURE),
    models: |_| [reality_scan::brown_models(), reality_scan::richer_models()].concat(),
    keeps: Keeps { pose: KeptPose::InWorld, ..PLAIN.keeps },
    ..PLAIN
};

const NAMESPACE: &str = "http://www.capturingreality.com/ns/xcr/1.1#";
/// What is read, and what says nothing of the camera.
const KNOWN: [&str; 29] = [
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
    "DistortionPrior",
    "LockedPoseGroup",
    "Rig",
    "RigInstance",
    "RigPoseIndex",
    "ExportCoordinateSystemType",
    "Gravity",
    "latitude",
    "longitude",
    "altitude",
    "ComponentId",
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
    let lengths = Lengths {
        f35: number("FocalLength35mm", None)?,
        u: number("PrincipalPointU", Some(0.0))?,
        v: number("PrincipalPointV", Some(0.0))?,
        skew: number("Skew", Some(0.0))?,
        aspect: number("AspectRatio", Some(1.0))?,
    };
    for (name, found) in [("FocalLength35mm", lengths.f35), ("AspectRatio", lengths.aspect)] {
        if found <= 0.0 {
            return Err(at(CameraFileError::new(format!("expected a number above zero, found {found}")), name));
        }
    }
    let coefficients = value(node, "DistortionCoeficients")?.unwrap_or("0 0 0 0 0 0");
    let d: Coefficients = numbers(coefficients).map_err(|error| at(error, "DistortionCoeficients"))?;
    let lens = lens(value(node, "DistortionModel")?.unwrap_or("perspective"), &d).map_err(|(error, name)| at(error, name))?;
    let camera = reality_scan::camera(size, &lengths, &d, lens).map_err(|error| at(error, "DistortionModel"))?;
    let assumed = (lens == Lens::Division).then(|| DIVISION.to_owned());
    let notes = assumed.into_iter().chain(unknown(node, options)?).collect();
    Ok(vec![NamedCamera { pose: pose(node)?, notes, ..NamedCamera::new("", camera) }])
}

/// The lens of a model's name, and whether it has all coefficients that are not zero; an error with the name of what is wrong.
fn lens(model: &str, d: &Coefficients) -> Result<Lens, (CameraFileError, &'static str)> {
    let (radial, tangential) = match model {
        "perspective" => (0, false),
        // Without coefficients it is a pinhole camera by any formula.
        "division" => (1, false),
        "brown3" => (3, false),
        "brown4" => (4, false),
        "brown3t2" => (3, true),
        "brown4t2" => (4, true),
        other => {
            let known = "perspective, division, brown3, brown4, brown3t2 or brown4t2";
            return Err((CameraFileError::new(format!("`{}` is not known; expected {known}", shortened(other))), "DistortionModel"));
        }
    };
    if d[radial..4].iter().chain(d[4..].iter().filter(|_| !tangential)).any(|&value| value != 0.0) {
        return Err((CameraFileError::new("has coefficients that the model has not; expected zeros"), "DistortionCoeficients"));
    }
    Ok(if model == "division" && d[0] != 0.0 { Lens::Division } else { Lens::Brown })
}

fn pose(node: Node<'_, '_>) -> Result<Option<Pose>, CameraFileError> {
    let (Some(rotation), Some(position)) = (value(node, "Rotation")?, value(node, "Position")?) else { return Ok(None) };
    let r: [f64; 9] = numbers(rotation).map_err(|error| xml::at(node, error).of("Rotation"))?;
    let position = numbers(position).map_err(|error| xml::at(node, error).of("Position"))?;
    let rows = std::array::from_fn(|row| std::array::from_fn(|column| r[3 * row + column]));
    let r = crate::pose::rotation(rows).map_err(|error| xml::at(node, error).of("Rotation"))?;
    Ok(Some(Pose { camera_from_world: r, position }))
}

fn unknown(node: Node<'_, '_>, options: &ReadOptions) -> Result<Vec<String>, CameraFileError> {
    let attributes = node.attributes().filter(|a| a.namespace() == Some(NAMESPACE)).map(|a| a.name());
    let elements = xml::elements(node).map(|child| child.tag_name().name());
    let others = attributes.chain(elements).filter(|name| !KNOWN.contains(name)).map(|name| (name, ()));
    options.of_file(others, |(), error| xml::at(node, error.clone()).of(error.element.unwrap_or_default()))
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let named = &cameras[0];
    let (Lengths { f35, u, v, skew, aspect }, d, lens) = reality_scan::parts(&named.camera, &FORMAT)?;
    let tangential = d[4..] != [0.0; 2];
    let model = match (lens, d) {
        (Lens::Division, _) => "division",
        (_, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]) => "perspective",
        (_, [_, _, _, 0.0, ..]) if tangential => "brown3t2",
        (_, [_, _, _, 0.0, ..]) => "brown3",
        _ if tangential => "brown4t2",
        _ => "brown4",
    };
    let words = |values: &[f64]| values.iter().map(|&value| shortest(value)).collect::<Vec<_>>().join(" ");
    let pose = named.pose.map_or(String::new(), |pose| {
        let rotation = words(pose.camera_from_world.as_flattened());
        format!("      <xcr:Rotation>{rotation}</xcr:Rotation>\n      <xcr:Position>{}</xcr:Position>\n", words(&pose.position))
    });
    let [f35, skew, aspect, u, v] = [f35, skew, aspect, u, v].map(shortest);
    Ok(format!(
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n  <rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n    <rdf:Description xcr:Version=\"3\" \
         xcr:DistortionModel=\"{model}\" xcr:FocalLength35mm=\"{f35}\"\n       xcr:Skew=\"{skew}\" xcr:AspectRatio=\"{aspect}\" xcr:PrincipalPointU=\"{u}\" \
         xcr:PrincipalPointV=\"{v}\"\n       xcr:CalibrationPrior=\"exact\" xmlns:xcr=\"{NAMESPACE}\">\n{pose}      \
         <xcr:DistortionCoeficients>{}</xcr:DistortionCoeficients>\n    </rdf:Description>\n  </rdf:RDF>\n</x:xmpmeta>\n",
        words(&d)
    ))
}
