//! OpenSfM's and OpenDroneMap's camera_models.json, camera_models_overrides.json, cameras.json, reconstruction.json: units of the longer side, from the middle.

use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCvFisheye, SixPrismFisheye, tool_conventions};
use calibench_model::convert::Target;
use calibench_model::{NamedCamera, PixelPoint};

use super::PLAIN;
use crate::brown::{Brown, middle, positive};
use crate::format::{Keeps, Model};
use crate::json::{self, quoted};
use crate::number::{shortened, shortest};
use crate::pose::{of_rotation_vector, of_rt};
use crate::source::Source;
use crate::tree::{Entry, Value};
use crate::{CameraFileError, CameraFormat, ReadOptions, noted};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "opensfm",
    tool: "OpenSfM, OpenDroneMap",
    versions: "camera_models.json, cameras.json; reconstruction.json is read, a camera with its pose for each shot",
    extension: "json",
    words: "projection_type width height focal k1 k2 focal_x focal_y c_x c_y cameras shots points",
    many: true,
    recognise: |source| {
        let found = source.text.trim_start().starts_with(['{', '[']) && source.text.contains("\"projection_type\"");
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
            Model { name: "fisheye62", target: Target::SixPrismFisheye { prism: false } },
            Model { name: "fisheye624", target: Target::SixPrismFisheye { prism: true } },
        ]
    },
    keeps: Keeps { name: true, ..PLAIN.keeps },
    ..PLAIN
};

static FISHEYE624: [&str; 16] =
    ["focal_x", "focal_y", "c_x", "c_y", "k1", "k2", "k3", "k4", "k5", "k6", "p1", "p2", "s0", "s1", "s2", "s3"];

/// Names of numbers for each projection.
fn numbers(projection: &str) -> Option<&'static [&'static str]> {
    Some(match projection {
        "perspective" | "fisheye" => &["focal", "k1", "k2"],
        "brown" => &["focal_x", "focal_y", "c_x", "c_y", "k1", "k2", "k3", "p1", "p2"],
        "fisheye_opencv" => &["focal_x", "focal_y", "c_x", "c_y", "k1", "k2", "k3", "k4"],
        "fisheye62" => &FISHEYE624[..12],
        "fisheye624" => &FISHEYE624[..],
        "simple_radial" => &["focal_x", "focal_y", "c_x", "c_y", "k1"],
        "radial" => &["focal_x", "focal_y", "c_x", "c_y", "k1", "k2"],
        _ => return None,
    })
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let root = json::json_without(source.text, "points")?;
    let of = |cameras: &Entry| -> Result<Vec<NamedCamera>, CameraFileError> {
        cameras
            .entries()?
            .iter()
            .map(|(name, entry)| camera(name, entry, options).map_err(|error| error.in_key(&shortened(name))))
            .collect()
    };
    // A list of reconstructions, or one.
    let parts: Vec<&Entry> = match &root.value {
        Value::List(items) => items.iter().collect(),
        _ if root.key("cameras")?.is_some_and(|cameras| cameras.key("projection_type").is_ok_and(|one| one.is_none())) => vec![&root],
        _ => return of(&root),
    };
    let mut found = Vec::new();
    for part in &parts {
        let cameras = of(part.required("cameras")?)?;
        match part.key("shots")?.map(Entry::entries).transpose()?.filter(|shots| !shots.is_empty()) {
            None => found.extend(cameras),
            Some(shots) => {
                for (name, shot) in shots {
                    found.push(taken(name, shot, &cameras).map_err(|error| error.in_key(&shortened(name)))?);
                }
            }
        }
    }
    let note = (parts.len() > 1).then(|| format!("{} reconstructions, each with a world of its own", parts.len()));
    Ok(noted(found, note.as_slice()))
}

/// The camera of a shot, with its name and pose.
fn taken(name: &str, shot: &Entry, cameras: &[NamedCamera]) -> Result<NamedCamera, CameraFileError> {
    let own = shot.text_of("camera")?;
    let camera = cameras.iter().find(|camera| camera.name == own);
    let camera = camera.ok_or_else(|| shot.wrong(&format!("`{}` is not among the cameras", shortened(own))).of("camera"))?;
    let (rotation, t) = (shot.row_of("rotation")?, shot.row_of("translation")?);
    let pose = of_rt(of_rotation_vector(rotation), t).map_err(|error| error.on_line(shot.line).of("rotation"))?;
    Ok(NamedCamera { name: name.to_owned(), pose: Some(pose), ..camera.clone() })
}

fn longer(size: ImageSize) -> f64 {
    f64::from(size.width.max(size.height))
}

fn camera(name: &str, entry: &Entry, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let size = options.size_or(Some(entry.size_of("width", "height")?)).map_err(|error| error.on_line(entry.line))?;
    let projection = entry.text_of("projection_type")?;
    let Some(names) = numbers(projection) else {
        let known = "perspective, brown, simple_radial, radial, fisheye, fisheye_opencv, fisheye62 or fisheye624";
        let whole = ["spherical", "equirectangular", "dual"].contains(&projection);
        let why = if whole { "is no camera model here" } else { "is not known" };
        let problem = format!("`{}` {why}; expected {known}", shortened(projection));
        return Err(entry.required("projection_type")?.wrong(&problem).of("projection_type"));
    };
    let v = |name: &str| if names.contains(&name) { entry.number_or_zero(name) } else { Ok(0.0) };
    let focal = |name: &str| positive(name, entry.number_of(name)? * longer(size)).map_err(|error| error.on_line(entry.line));
    let one = names[0] == "focal";
    let (fx, fy) = if one { (focal("focal")?, focal("focal")?) } else { (focal("focal_x")?, focal("focal_y")?) };
    let centre = middle(size);
    let (cx, cy) = (centre.x + v("c_x")? * longer(size), centre.y + v("c_y")? * longer(size));
    let k = [v("k1")?, v("k2")?, v("k3")?, v("k4")?];
    let camera = if projection.starts_with("fisheye6") {
        let ([k5, k6], p, s) = ([v("k5")?, v("k6")?], [v("p1")?, v("p2")?], [v("s0")?, v("s1")?, v("s2")?, v("s3")?]);
        SixPrismFisheye { size, fx, fy, cx, cy, k: [k[0], k[1], k[2], k[3], k5, k6], p, s }.into()
    } else if projection.starts_with("fisheye") {
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
        let (projection, values) = parts(&named.camera)
            .ok_or_else(|| FORMAT.other_model("cameras of perspective, brown, fisheye_opencv, fisheye62 and fisheye624"))?;
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
    if let Camera::SixPrismFisheye(SixPrismFisheye { fx, fy, cx, cy, k, p, s, .. }) = *camera {
        let (name, prism) = if s == [0.0; 4] { ("fisheye62", &s[..0]) } else { ("fisheye624", &s[..]) };
        return Some((name, [&head(fx, fy, cx, cy)[..], &k, &p, prism].concat()));
    }
    let brown = Brown::of(camera).filter(|brown| brown.skew == 0.0 && brown.k[3] == 0.0)?;
    let Brown { fx, fy, cx, cy, k: [k1, k2, k3, _], p1, p2, .. } = brown;
    if brown.has_one_focal() && PixelPoint::new(cx, cy) == centre && brown.radial() <= 2 && !brown.has_tangential() {
        return Some(("perspective", vec![fx / s, k1, k2]));
    }
    Some(("brown", [head(fx, fy, cx, cy), vec![k1, k2, k3, p1, p2]].concat()))
}
