//! OpenMVG's sfm_data.json: intrinsics as its serialisation writes them, where the name of a model stands at its first use alone.

use std::collections::HashMap;

use calibench_model::NamedCamera;
use calibench_model::camera::{AgisoftVersion, Camera, CameraModel, ImageSize, OpenCvFisheye, tool_conventions};
use calibench_model::convert::Target;

use super::PLAIN;
use crate::brown::{Brown, positive};
use crate::format::{Keeps, Model};
use crate::ids::Ids;
use crate::json;
use crate::number::{row, shortened, shortest};
use crate::source::Source;
use crate::tree::Entry;
use crate::{CameraFileError, CameraFormat, ReadOptions, noted};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "openmvg",
    tool: "OpenMVG",
    versions: "sfm_data.json 0.3 and later",
    extension: "json",
    words: "sfm_data_version root_path views intrinsics extrinsics polymorphic_id polymorphic_name ptr_wrapper focal_length principal_point disto_k3 disto_k1 disto_t2",
    many: true,
    recognise: |source| {
        let found = source.text.trim_start().starts_with('{') && source.text.contains("\"sfm_data_version\"");
        if found { Ok(()) } else { Err("no JSON with `sfm_data_version`".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::OPENMVG),
    models: |_| {
        let brown = |radial, tangential| Target::Agisoft { version: AgisoftVersion::Metashape, radial, tangential, affinity: false };
        vec![
            Model { name: "pinhole_radial_k1", target: brown(1, 0) },
            Model { name: "pinhole_radial_k3", target: brown(3, 0) },
            Model { name: "pinhole_brown_t2", target: brown(3, 2) },
        ]
    },
    keeps: Keeps { name: true, ..PLAIN.keeps },
    origin_is_open: true,
    ..PLAIN
};

/// Set where a model's name stands for the first time.
const NEW: u64 = 1 << 31;

/// What is read, and what says nothing of a camera.
const KNOWN: [&str; 7] = ["sfm_data_version", "root_path", "views", "intrinsics", "extrinsics", "structure", "control_points"];

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let root = json::json(source.text)?;
    let cameras = intrinsics(&root, options)?.into_iter().map(|(_, named)| named).collect();
    let posed = root.key("extrinsics")?.map_or(Ok(0), |entry| entry.items().map(<[Entry]>::len))?;
    let mut notes = root.of_file(&KNOWN, options)?;
    notes.extend((posed > 0).then(|| format!("`extrinsics`, {posed} poses of images, were left out")));
    Ok(noted(cameras, &notes))
}

/// The name of its model and the camera of each of `intrinsics`, whose key is its name.
pub(crate) fn intrinsics(root: &Entry, options: &ReadOptions) -> Result<Vec<(String, NamedCamera)>, CameraFileError> {
    let mut names = HashMap::new();
    // Views may have taken numbers before.
    for view in root.key("views")?.map_or(Ok(&[][..]), Entry::items)? {
        polymorphic(view.required("value")?, &mut names)?;
    }
    let (mut cameras, mut ids) = (Vec::new(), Ids::default());
    for entry in root.required("intrinsics")?.items()? {
        let (key, value) = (entry.text_of("key")?, entry.required("value")?);
        let at = |error: CameraFileError| error.in_key(&format!("intrinsics {}", shortened(key)));
        ids.take(key, entry.line)?;
        let model = polymorphic(value, &mut names)?;
        let Some(model) = model else { return Err(at(value.wrong("has no `polymorphic_name`"))) };
        let data = value.required("ptr_wrapper")?.required("data").map_err(at)?;
        let mut named = camera(&model, data, options).map_err(at)?;
        key.clone_into(&mut named.name);
        cameras.push((model, named));
    }
    Ok(cameras)
}

/// The name of a value's type, by its number if it was named before.
fn polymorphic(value: &Entry, names: &mut HashMap<u64, String>) -> Result<Option<String>, CameraFileError> {
    let Some(id) = value.key("polymorphic_id")? else { return Ok(None) };
    let number = id.text()?.parse::<u64>().map_err(|_| id.wrong("expected a whole number").of("polymorphic_id"))?;
    if let Some(name) = value.key("polymorphic_name")? {
        names.insert(number & !NEW, name.text()?.to_owned());
    }
    Ok(names.get(&(number & !NEW)).cloned())
}

fn camera(model: &str, data: &Entry, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let base = data.key("value0")?.unwrap_or(data);
    let size = options.size_or(Some(base.size_of("width", "height")?)).map_err(|error| error.on_line(base.line))?;
    let f = positive("focal_length", base.number_of("focal_length")?).map_err(|error| error.on_line(base.line))?;
    let [cx, cy] = base.row_of("principal_point")?;
    let plain = Brown::plain(size, [f, f, cx, cy]);
    let (camera, own): (Camera, &str) = match model {
        "pinhole" => (plain.camera(), ""),
        "pinhole_radial_k1" => {
            let [k1] = data.row_of("disto_k1")?;
            (Brown { k: [k1, 0.0, 0.0, 0.0], ..plain }.camera(), "disto_k1")
        }
        "pinhole_radial_k3" => {
            let [k1, k2, k3] = data.row_of("disto_k3")?;
            (Brown { k: [k1, k2, k3, 0.0], ..plain }.camera(), "disto_k3")
        }
        "pinhole_brown_t2" => {
            let [k1, k2, k3, p1, p2] = data.row_of("disto_t2")?;
            (Brown { k: [k1, k2, k3, 0.0], p1, p2, ..plain }.camera(), "disto_t2")
        }
        "fisheye" => (OpenCvFisheye { size, fx: f, fy: f, cx, cy, skew: 0.0, k: data.row_of("fisheye")? }.into(), "fisheye"),
        _ => {
            let known = "pinhole, pinhole_radial_k1, pinhole_radial_k3, pinhole_brown_t2 or fisheye";
            return Err(data.wrong(&format!("`{}` is not known; expected {known}", shortened(model))).of("polymorphic_name"));
        }
    };
    let of_base = ["width", "height", "focal_length", "principal_point"];
    let mut notes = data.of_lens(&[&of_base[..], &["value0", own]].concat(), options)?;
    if data.key("value0")?.is_some() {
        notes.extend(base.of_lens(&of_base, options)?);
    }
    Ok(NamedCamera { notes, ..NamedCamera::new("", camera) })
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let (mut entries, mut types): (Vec<String>, Vec<&str>) = (Vec::new(), Vec::new());
    for (index, named) in cameras.iter().enumerate() {
        let parts = parts(&named.camera).ok_or_else(|| {
            FORMAT.other_model("cameras of pinhole, pinhole_radial_k1, _k3, pinhole_brown_t2 and fisheye, with one focal length")
        })?;
        let known = types.iter().position(|name| *name == parts.model);
        let id = known.map_or_else(|| NEW + types.len() as u64 + 1, |place| place as u64 + 1);
        let mut lines = vec![format!("\"polymorphic_id\": {id}")];
        if known.is_none() {
            types.push(parts.model);
            lines.push(format!("\"polymorphic_name\": \"{}\"", parts.model));
        }
        let own = parts.own.map_or(String::new(), |(name, values)| format!(", \"{name}\": [{}]", row(&values)));
        let ImageSize { width, height } = named.camera.size();
        let base = format!(
            "\"width\": {width}, \"height\": {height}, \"focal_length\": {}, \"principal_point\": [{}]",
            shortest(parts.f),
            row(&parts.centre)
        );
        let base = if matches!(parts.model, "pinhole_brown_t2" | "fisheye") { format!("\"value0\": {{{base}}}") } else { base };
        lines.push(format!("\"ptr_wrapper\": {{\"id\": {}, \"data\": {{{base}{own}}}}}", NEW + index as u64 + 1));
        let key = named.name.parse::<u32>().map_or(index as u32, |key| key);
        entries.push(format!("    {{\"key\": {key}, \"value\": {{{}}}}}", lines.join(", ")));
    }
    Ok(format!(
        "{{\n  \"sfm_data_version\": \"0.3\",\n  \"root_path\": \"\",\n  \"views\": [],\n  \"intrinsics\": [\n{}\n  ],\n  \"extrinsics\": [],\n  \
         \"structure\": [],\n  \"control_points\": []\n}}\n",
        entries.join(",\n")
    ))
}

struct Parts {
    model: &'static str,
    f: f64,
    centre: [f64; 2],
    own: Option<(&'static str, Vec<f64>)>,
}

fn parts(camera: &Camera) -> Option<Parts> {
    if let Camera::OpenCvFisheye(OpenCvFisheye { fx, fy, cx, cy, skew: 0.0, k, .. }) = *camera {
        return (fx == fy).then(|| Parts { model: "fisheye", f: fx, centre: [cx, cy], own: Some(("fisheye", k.to_vec())) });
    }
    let brown = Brown::of(camera).filter(|brown| brown.skew == 0.0 && brown.k[3] == 0.0 && brown.has_one_focal())?;
    let ([k1, k2, k3, _], p1, p2) = (brown.k, brown.p1, brown.p2);
    let (model, own) = match (brown.has_tangential(), brown.radial()) {
        (true, _) => ("pinhole_brown_t2", Some(("disto_t2", vec![k1, k2, k3, p1, p2]))),
        (false, 0) => ("pinhole", None),
        (false, 1) => ("pinhole_radial_k1", Some(("disto_k1", vec![k1]))),
        (false, _) => ("pinhole_radial_k3", Some(("disto_k3", vec![k1, k2, k3]))),
    };
    Some(Parts { model, f: brown.fx, centre: [brown.cx, brown.cy], own })
}
