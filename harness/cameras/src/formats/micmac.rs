//! MicMac's AutoCal: `<CalibrationInternConique>` with ModNoDist, ModRad or ModPhgrStd.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel, ImageSize, MicMac, micmac};
use calibench_model::convert::Target;
use roxmltree::Node;

use super::PLAIN;
use crate::brown::positive;
use crate::format::{Keeps, Model};
use crate::number::{finite, numbers, scientific, shortened};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions, xml};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "micmac",
    tool: "MicMac",
    versions: "AutoCal XML of Apero (not MMVII)",
    extension: "xml",
    words: "ExportAPERO CalibrationInternConique KnownConv PP F SzIm CalibDistortion ModRad ModPhgrStd ModUnif RadialePart CDist CoeffDist",
    recognise: |source| {
        let found = source.xml.as_ref().is_some_and(|document| calibration(document.root()).is_some());
        if found { Ok(()) } else { Err("no CalibrationInternConique".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&micmac::CONVENTION),
    models: |_| {
        vec![
            Model { name: "ModRad", target: Target::MicMac { radial: 3, tangential: false, affinity: false } },
            Model { name: "ModPhgrStd", target: Target::MicMac { radial: 5, tangential: true, affinity: false } },
            Model { name: "ModPhgrStd", target: Target::MicMac { radial: 5, tangential: true, affinity: true } },
        ]
    },
    keeps: Keeps { ..PLAIN.keeps },
    origin_is_open: true,
    ..PLAIN
};

const CONVENTION: &str = "eConvApero_DistM2C";
const KNOWN: [&str; 7] = ["KnownConv", "ConvOri", "PP", "F", "SzIm", "CalibDistortion", "RayonUtile"];

fn calibration<'a, 'input>(root: Node<'a, 'input>) -> Option<Node<'a, 'input>> {
    root.descendants().find(|node| node.has_tag_name("CalibrationInternConique"))
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let Some(node) = source.xml.as_ref().and_then(|document| calibration(document.root())) else { return Ok(Vec::new()) };
    let convention = match xml::child(node, "KnownConv")? {
        Some(convention) => convention,
        None => xml::required(xml::required(node, "ConvOri")?, "KnownConv")?,
    };
    let found = xml::text(convention)?;
    if found != CONVENTION {
        return Err(xml::at(convention, CameraFileError::new(format!("`{}` is not known here; expected {CONVENTION}", shortened(found)))));
    }
    let [width, height]: [f64; 2] = pair(node, "SzIm")?;
    let side = |value: f64| crate::number::pixels(&value.to_string()).map_err(|error| xml::at(node, error).of("SzIm"));
    let size = options.size_or(Some(ImageSize { width: side(width)?, height: side(height)? })).map_err(|error| xml::at(node, error))?;
    let f = positive("F", xml::required_number(node, "F")?).map_err(|error| xml::at(node, error).of("F"))?;
    let pp = pair(node, "PP")?;
    let mut camera = MicMac { size, f, pp, offset: [0.0; 2], k: [0.0; 5], p: [0.0; 2], b: [0.0; 2] };
    let mut models = xml::elements(node).filter(|child| child.has_tag_name("CalibDistortion")).flat_map(xml::elements);
    let mut notes = Vec::new();
    if let Some(model) = models.next() {
        distortion(model, &mut camera)?;
        let parts = ["P1", "P2", "b1", "b2", "RadialePart", "CDist", "CoeffDist", "CoeffDistInv"];
        let all = model.descendants().filter(|node| node.is_element() && *node != model).map(|node| (node.tag_name().name(), node));
        notes.extend(options.of_lens(all, &parts, xml::at)?);
    }
    if let Some(second) = models.next() {
        return Err(xml::at(second, CameraFileError::new("stands after another distortion; expected one")));
    }
    let others = xml::elements(node).map(|child| (child.tag_name().name(), child)).filter(|(name, _)| !KNOWN.contains(name));
    notes.extend(options.of_file(others, xml::at)?);
    if let Some(radius) = xml::number(node, "RayonUtile")? {
        notes.push(format!("`RayonUtile`, the calibration's own limit of {radius} px, was left out: restrict fits by a radius"));
    }
    Ok(vec![NamedCamera { notes, ..NamedCamera::new("", Camera::MicMac(camera)) }])
}

fn pair(node: Node<'_, '_>, name: &str) -> Result<[f64; 2], CameraFileError> {
    let child = xml::required(node, name)?;
    numbers(xml::text(child)?).map_err(|error| xml::at(child, error))
}

fn distortion(model: Node<'_, '_>, camera: &mut MicMac) -> Result<(), CameraFileError> {
    let radial = match model.tag_name().name() {
        "ModNoDist" => return Ok(()),
        "ModRad" => model,
        "ModPhgrStd" => {
            let v = |name| Ok::<f64, CameraFileError>(xml::number(model, name)?.unwrap_or(0.0));
            (camera.p, camera.b) = ([v("P1")?, v("P2")?], [v("b1")?, v("b2")?]);
            xml::required(model, "RadialePart")?
        }
        other => {
            let problem = format!("distortion `{}` is not known; expected ModNoDist, ModRad or ModPhgrStd", shortened(other));
            return Err(xml::at(model, CameraFileError::new(problem)));
        }
    };
    let centre = pair(radial, "CDist")?;
    camera.offset = [centre[0] - camera.pp[0], centre[1] - camera.pp[1]];
    for (index, node) in xml::elements(radial).filter(|node| node.has_tag_name("CoeffDist")).enumerate() {
        let value = finite(xml::text(node)?).map_err(|error| xml::at(node, error))?;
        match camera.k.get_mut(index) {
            Some(slot) => *slot = value,
            None if value == 0.0 => {}
            None => return Err(xml::at(node, CameraFileError::new(format!("is coefficient {}; expected five at most", index + 1)))),
        }
    }
    Ok(())
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let Camera::MicMac(camera) = &cameras[0].camera else { return Err(FORMAT.other_model("a camera of MicMac's model")) };
    let ImageSize { width, height } = camera.size();
    let two = |[x, y]: [f64; 2]| format!("{} {}", scientific(x), scientific(y));
    let centre = [camera.pp[0] + camera.offset[0], camera.pp[1] + camera.offset[1]];
    let count = camera.k.iter().rposition(|&k| k != 0.0).map_or(0, |last| last + 1);
    let coefficients = |indent: &str| {
        let lines = camera.k[..count].iter().map(|&k| format!("{indent}<CoeffDist>{}</CoeffDist>\n", scientific(k)));
        format!("{indent}<CDist>{}</CDist>\n{}", two(centre), lines.collect::<String>())
    };
    let indent = " ".repeat(20);
    let model = if camera.p == [0.0; 2] && camera.b == [0.0; 2] {
        format!("               <ModRad>\n{}               </ModRad>\n", coefficients(&indent))
    } else {
        let names = ["P1", "P2", "b1", "b2"].into_iter().zip(camera.p.into_iter().chain(camera.b));
        let rest: String = names.map(|(name, value)| format!("{indent}<{name}>{}</{name}>\n", scientific(value))).collect();
        let radial = coefficients(&format!("{indent}     "));
        format!("               <ModPhgrStd>\n{indent}<RadialePart>\n{radial}{indent}</RadialePart>\n{rest}               </ModPhgrStd>\n")
    };
    Ok(format!(
        "<?xml version=\"1.0\" ?>\n<ExportAPERO>\n     <CalibrationInternConique>\n          <KnownConv>{CONVENTION}</KnownConv>\n          <PP>{}</PP>\n          \
         <F>{}</F>\n          <SzIm>{width} {height}</SzIm>\n          <CalibDistortion>\n{model}          </CalibDistortion>\n     \
         </CalibrationInternConique>\n</ExportAPERO>\n",
        two(camera.pp),
        scientific(camera.f)
    ))
}
