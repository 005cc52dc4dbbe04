//! OpenUSD's cameras with Omniverse's lens distortion, in text (.usda): OpenCV's pinhole camera and fisheye.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, ImageSize, OpenCv, OpenCvFisheye, tool_conventions};
use calibench_model::convert::Target;

use super::PLAIN;
use crate::format::{Keeps, Model};
use crate::number::{pixels, shortened, shortest};
use crate::opencv;
use crate::source::Source;
use crate::tree::{self, Entry, Value};
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "usd",
    tool: "OpenUSD with Omniverse's lens distortion, Isaac Sim",
    versions: ".usda with OmniLensDistortionOpenCvPinholeAPI and OmniLensDistortionOpenCvFisheyeAPI",
    extension: "usda",
    words: "usda def Camera apiSchemas omni lensdistortion opencvPinhole opencvFisheye imageSize clippingRange focalLength horizontalAperture",
    many: true,
    recognise: |source| {
        let found = source.text.starts_with("#usda") && source.text.contains(PREFIX);
        if found { Ok(()) } else { Err("no `#usda` with `omni:lensdistortion`".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::USD),
    models: |_| {
        vec![
            Model { name: "opencvPinhole", target: Target::OpenCv { coefficients: 5 } },
            Model { name: "opencvPinhole", target: Target::OpenCv { coefficients: 12 } },
            Model { name: "opencvFisheye", target: Target::OpenCvFisheye },
        ]
    },
    keeps: Keeps { name: true, ..PLAIN.keeps },
    origin_is_open: true,
    half_space: true,
    ..PLAIN
};

const PREFIX: &str = "omni:lensdistortion:";
/// In OpenCV's order.
const PINHOLE: [&str; 12] = ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6", "s1", "s2", "s3", "s4"];
const FISHEYE: [&str; 4] = ["k1", "k2", "k3", "k4"];

/// A value and its name.
type Named = (String, Entry);

/// The attributes of the lens distortion of each prim that has some, called by what follows the prefix.
fn prims(source: &Source<'_>) -> Result<Vec<Named>, CameraFileError> {
    let mut open: Vec<Option<String>> = Vec::new();
    let mut next: Option<String> = None;
    let mut found: Vec<(String, usize, Vec<Named>)> = Vec::new();
    for (number, line) in source.lines() {
        let defines = ["def ", "over ", "class "].iter().any(|word| line.starts_with(word));
        if let (true, Some(name)) = (defines, line.split('"').nth(1)) {
            next = Some(name.to_owned());
        }
        if let Some((name, value)) = attribute(line) {
            let path = open.iter().flatten().cloned().collect::<Vec<_>>().join("/");
            if found.last().is_none_or(|(last, ..)| *last != path) {
                found.push((path, number, Vec::new()));
            }
            if let Some((_, _, attributes)) = found.last_mut() {
                attributes.push((name.to_owned(), Entry { line: number, value }));
            }
        }
        // Braces within quotes are text.
        for c in line.split('"').step_by(2).flat_map(str::chars) {
            match c {
                '{' => open.push(next.take()),
                '}' => drop(open.pop()),
                _ => {}
            }
        }
    }
    found.into_iter().map(|(path, line, attributes)| Ok((path, Entry { line, value: tree::map(attributes)? }))).collect()
}

/// Name and value of a line `TYPE omni:lensdistortion:NAME = VALUE`.
fn attribute(line: &str) -> Option<(&str, Value)> {
    let (head, value) = line.split_once('=')?;
    let name = head.split_whitespace().last()?.strip_prefix(PREFIX)?;
    let value = value.trim();
    let scalar = |text: &str| Value::Scalar(text.trim().trim_matches('"').to_owned());
    let value = match value.strip_prefix(['(', '[']).and_then(|value| value.strip_suffix([')', ']'])) {
        Some(inner) => Value::List(inner.split(',').map(|part| Entry { line: 0, value: scalar(part) }).collect()),
        None => scalar(value),
    };
    Some((name, value))
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let found = prims(source)?;
    found.iter().map(|(path, prim)| camera(path, prim, options).map_err(|error| error.in_key(&shortened(path)))).collect()
}

fn camera(path: &str, prim: &Entry, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let model = prim.text_of("model")?;
    let names: &[&str] = match model {
        "opencvPinhole" => &PINHOLE,
        "opencvFisheye" => &FISHEYE,
        other => {
            let problem = format!("`{}` is no model here; expected opencvPinhole or opencvFisheye", shortened(other));
            return Err(prim.required("model")?.wrong(&problem).of("model"));
        }
    };
    let key = |name: &str| format!("{model}:{name}");
    let size = prim.required(&key("imageSize"))?;
    let side = |entry: &Entry| pixels(entry.text()?).map_err(|error| error.on_line(size.line).of(key("imageSize")));
    let [width, height] = size.items()? else { return Err(size.wrong("expected columns and rows").of(key("imageSize"))) };
    let size = options.size_or(Some(ImageSize { width: side(width)?, height: side(height)? }))?;
    let value = |name: &str| prim.number_of(&key(name));
    let k = [value("fx")?, 0.0, value("cx")?, 0.0, value("fy")?, value("cy")?, 0.0, 0.0, 1.0];
    for name in ["fx", "fy"] {
        crate::brown::positive(&key(name), value(name)?).map_err(|error| error.on_line(prim.line))?;
    }
    let d = names.iter().map(|name| prim.number_or_zero(&key(name))).collect::<Result<Vec<_>, _>>()?;
    let camera: Camera = if model == "opencvFisheye" {
        opencv::fisheye_camera(size, &k, &d)?
    } else {
        let count = if d[8..].iter().any(|s| *s != 0.0) {
            12
        } else if d[5..].iter().any(|k| *k != 0.0) {
            8
        } else {
            5
        };
        opencv::pinhole(size, &k, &d[..count])?
    };
    // What other models would have is kept by the tool and has no effect.
    let own: Vec<(&str, usize)> = prim.entries()?.iter().map(|(name, entry)| (name.as_str(), entry.line)).collect();
    let own = own.into_iter().filter(|(name, _)| *name == "model" || name.starts_with(&key("")));
    let known: Vec<String> =
        names.iter().chain(&["fx", "fy", "cx", "cy", "imageSize"]).map(|name| key(name)).chain(["model".to_owned()]).collect();
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    let notes = options.of_lens(own, &known, |line, error| error.on_line(line))?;
    let name = path.rsplit('/').next().unwrap_or_default();
    Ok(NamedCamera { notes, ..NamedCamera::new(name, camera) })
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut out = String::from("#usda 1.0\n\n");
    for (index, named) in cameras.iter().enumerate() {
        let wrong = || FORMAT.other_model("OpenCV's pinhole cameras of up to 12 coefficients, and its fisheye without skew");
        let (model, schema, size, k, names, d): (_, _, _, _, &[&str], Vec<f64>) = match named.camera {
            Camera::OpenCvFisheye(OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k }) => {
                ("opencvFisheye", "OmniLensDistortionOpenCvFisheyeAPI", size, [fx, fy, cx, cy], &FISHEYE[..], k.to_vec())
            }
            Camera::OpenCv(OpenCv { size, fx, fy, cx, cy, distortion, coefficients }) if coefficients <= 12 => {
                ("opencvPinhole", "OmniLensDistortionOpenCvPinholeAPI", size, [fx, fy, cx, cy], &PINHOLE[..], distortion[..12].to_vec())
            }
            _ => return Err(wrong()),
        };
        let values = ["fx", "fy", "cx", "cy"].iter().chain(names).zip(k.into_iter().chain(d));
        let lines: String = values.map(|(name, value)| format!("    float {PREFIX}{model}:{name} = {}\n", shortest(value))).collect();
        out.push_str(&format!(
            "def Camera \"{}\" (\n    prepend apiSchemas = [\"{schema}\"]\n)\n{{\n    uniform token {PREFIX}model = \"{model}\"\n    \
             int2 {PREFIX}{model}:imageSize = ({}, {})\n{lines}}}\n\n",
            identifier(&named.name, index),
            size.width,
            size.height
        ));
    }
    Ok(out)
}

/// A name as prims have them: letters, digits and underscores, and no digit first.
fn identifier(name: &str, index: usize) -> String {
    let kept: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    match kept.chars().next() {
        None => format!("camera_{index}"),
        Some(first) if first.is_ascii_digit() => format!("_{kept}"),
        Some(_) => kept,
    }
}
