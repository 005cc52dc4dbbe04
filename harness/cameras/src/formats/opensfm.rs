//! OpenSfM's and OpenDroneMap's camera_models.json, camera_models_overrides.json, cameras.json: units of the longer side, from the middle.

use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCvFisheye, tool_conventions};
use calibench_model::convert::Target;
use calibench_model::{NamedCamera, PixelPoint};

use super::PLAIN;
use crate::brown::{Brown, middle, positive};
use crate::format::{Keeps, Model};
use crate::json::{self, quoted};
use crate::number::{shortened, shortest};
use crate::source::Source;
use crate::tree::Entry;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "opensfm",
    tool: "OpenSfM, OpenDroneMap",
    versions: "camera_models.json, cameras.json",
    extension: "json",
    many: true,
    recognise: |source| {
        let found = source.text.trim_start().starts_with('{') && source.text.contains("\"projection_type\"");
        if found { Ok(()) } else { Err("no JSON with `projection_type`".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::OPENSFM),
    models: |_| {
        vec![
            Model { name: "perspective", target: Target::Centred { radial: 2 } },
            Model { name: "brown", target: Target::OpenCv { coefficients: 5 } },
            Model { name: "fisheye_opencv", target: Target::OpenCvFisheye },
        ]
    },
    keeps: Keeps { name: true, ..PLAIN.keeps },
    ..PLAIN
};

/// Names of numbers for each projection.
fn numbers(projection: &str) -> Option<&'static [&'static str]> {
    Some(match projection {
        "perspective" | "fisheye" => &["focal", "k1", "k2"],
        "brown" => &["focal_x", "focal_y", "c_x", "c_y", "k1", "k2", "k3", "p1", "p2"],
        "fisheye_opencv" => &["focal_x", "focal_y", "c_x", "c_y", "k1", "k2", "k3", "k4"],
        "simple_radial" => &["focal_x", "focal_y", "c_x", "c_y", "k1"],
        "radial" => &["focal_x", "focal_y", "c_x", "c_y", "k1", "k2"],
        _ => return None,
    })
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let root = json::json(source.text)?;
    let cameras = root.entries()?.iter();
    cameras.map(|(name, entry)| camera(name, entry, options).map_err(|error| error.in_key(&shortened(name)))).collect()
}

fn longer(size: ImageSize) -> f64 {
    f64::from(size.width.max(size.height))
}

fn camera(name: &str, entry: &Entry, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let size = options.size_or(Some(entry.size_of("width", "height")?)).map_err(|error| error.on_line(entry.line))?;
    let projection = entry.text_of("projection_type")?;
    let Some(names) = numbers(projection) else {
        let known = "perspective, brown, simple_radial, radial, fisheye or fisheye_opencv";
        let problem = format!("`{}` is not known; expected {known}", shortened(projection));
        return Err(entry.required("projection_type")?.wrong(&problem).of("projection_type"));
    };
    let v = |name: &str| if names.contains(&name) { entry.number_or_zero(name) } else { Ok(0.0) };
    let focal = |name: &str| positive(name, entry.number_of(name)? * longer(size)).map_err(|error| error.on_line(entry.line));
    let one = names[0] == "focal";
    let (fx, fy) = if one { (focal("focal")?, focal("focal")?) } else { (focal("focal_x")?, focal("focal_y")?) };
    let centre = middle(size);
    let (cx, cy) = (centre.x + v("c_x")? * longer(size), centre.y + v("c_y")? * longer(size));
    let k = [v("k1")?, v("k2")?, v("k3")?, v("k4")?];
    let camera = if projection.starts_with("fisheye") {
        OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k }.into()
    } else {
        Brown { k, p1: v("p1")?, p2: v("p2")?, ..Brown::plain(size, [fx, fy, cx, cy]) }.camera()
    };
    let notes = entry.of_lens(&[names, &["projection_type", "width", "height"]].concat(), options)?;
    Ok(NamedCamera { notes, ..NamedCamera::new(name, camera) })
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut entries = Vec::new();
    for (index, named) in cameras.iter().enumerate() {
        let (projection, values) =
            parts(&named.camera).ok_or_else(|| FORMAT.other_model("cameras of perspective, brown and fisheye_opencv"))?;
        let name = if named.name.is_empty() { format!("camera {index}") } else { named.name.clone() };
        let size = named.camera.size();
        let mut lines = vec![
            format!("\"projection_type\": \"{projection}\""),
            format!("\"width\": {}", size.width),
            format!("\"height\": {}", size.height),
        ];
        let names = numbers(projection).unwrap_or(&[]);
        lines.extend(names.iter().zip(values).map(|(name, value)| format!("\"{name}\": {}", shortest(value))));
        entries.push(format!("    {}: {{\n        {}\n    }}", quoted(&name), lines.join(",\n        ")));
    }
    Ok(format!("{{\n{}\n}}\n", entries.join(",\n")))
}

fn parts(camera: &Camera) -> Option<(&'static str, Vec<f64>)> {
    let size = camera.size();
    let (s, centre) = (longer(size), middle(size));
    let head = |fx: f64, fy: f64, cx: f64, cy: f64| vec![fx / s, fy / s, (cx - centre.x) / s, (cy - centre.y) / s];
    if let Camera::OpenCvFisheye(OpenCvFisheye { fx, fy, cx, cy, skew: 0.0, k, .. }) = *camera {
        if fx == fy && PixelPoint::new(cx, cy) == centre && k[2..] == [0.0; 2] {
            return Some(("fisheye", vec![fx / s, k[0], k[1]]));
        }
        return Some(("fisheye_opencv", [head(fx, fy, cx, cy), k.to_vec()].concat()));
    }
    let brown = Brown::of(camera).filter(|brown| brown.skew == 0.0 && brown.k[3] == 0.0)?;
    let Brown { fx, fy, cx, cy, k: [k1, k2, k3, _], p1, p2, .. } = brown;
    if brown.has_one_focal() && PixelPoint::new(cx, cy) == centre && brown.radial() <= 2 && !brown.has_tangential() {
        return Some(("perspective", vec![fx / s, k1, k2]));
    }
    Some(("brown", [head(fx, fy, cx, cy), vec![k1, k2, k3, p1, p2]].concat()))
}
