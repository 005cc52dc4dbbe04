//! camodocal's YAML, an OpenCV FileStorage with names of its own.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel, ImageSize, Omni, OpenCvFisheye, tool_conventions};
use calibench_model::convert::Target;

use super::PLAIN;
use super::opencv_yaml::{quoted, tree};
use crate::brown::{Brown, positive};
use crate::format::{Keeps, Model};
use crate::number::{shortened, shortest};
use crate::source::Source;
use crate::tree::Entry;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "camodocal",
    tool: "camodocal, VINS",
    versions: "camera YAML: MEI, KANNALA_BRANDT, PINHOLE",
    extension: "yaml",
    words: "model_type camera_name image_width image_height mirror_parameters distortion_parameters projection_parameters gamma1 gamma2 u0 v0 mu mv k2 k3 k4 k5",
    recognise: |source| {
        let found = source.xml.is_none() && source.text.lines().any(|line| line.starts_with("model_type:"));
        if found { Ok(()) } else { Err("no `model_type:`".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::CAMODOCAL),
    models: |_| {
        vec![
            Model { name: "PINHOLE", target: Target::OpenCv { coefficients: 4 } },
            Model { name: "KANNALA_BRANDT", target: Target::OpenCvFisheye },
            Model { name: "MEI", target: Target::Omni { distortion: true } },
        ]
    },
    keeps: Keeps { name: true, ..PLAIN.keeps },
    ..PLAIN
};

const KNOWN: [&str; 7] =
    ["model_type", "camera_name", "image_width", "image_height", "mirror_parameters", "distortion_parameters", "projection_parameters"];

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let root = tree(source.text)?;
    let size = options.size_or(Some(root.size_of("image_width", "image_height")?))?;
    let kind = root.text_of("model_type")?;
    let projection = root.required("projection_parameters")?;
    let v = |name: &str| projection.number_of(name).map_err(|error| error.in_key("projection_parameters"));
    let focal = |name: &str| v(name).and_then(|f| positive(name, f).map_err(|error| error.on_line(projection.line)));
    let d = || -> Result<[f64; 4], CameraFileError> {
        let entry = root.required("distortion_parameters")?;
        let v = |name: &str| entry.number_of(name).map_err(|error| error.in_key("distortion_parameters"));
        Ok([v("k1")?, v("k2")?, v("p1")?, v("p2")?])
    };
    let camera: Camera = match kind {
        "PINHOLE" => {
            let [k1, k2, p1, p2] = d()?;
            let plain = Brown::plain(size, [focal("fx")?, focal("fy")?, v("cx")?, v("cy")?]);
            Brown { k: [k1, k2, 0.0, 0.0], p1, p2, ..plain }.camera()
        }
        "MEI" => {
            let [k1, k2, p1, p2] = d()?;
            let xi = root.required("mirror_parameters")?.number_of("xi")?;
            let (fx, fy, cx, cy) = (focal("gamma1")?, focal("gamma2")?, v("u0")?, v("v0")?);
            Omni { size, fx, fy, cx, cy, xi, k: [k1, k2], p: [p1, p2] }.into()
        }
        // theta + k2 theta^3 + ... + k5 theta^9: OpenCV's k1 to k4.
        "KANNALA_BRANDT" => {
            let k = [v("k2")?, v("k3")?, v("k4")?, v("k5")?];
            OpenCvFisheye { size, fx: focal("mu")?, fy: focal("mv")?, cx: v("u0")?, cy: v("v0")?, skew: 0.0, k }.into()
        }
        _ => {
            let problem = format!("`{}` is not known; expected MEI, KANNALA_BRANDT or PINHOLE", shortened(kind));
            return Err(root.required("model_type")?.wrong(&problem).of("model_type"));
        }
    };
    let name = root.key("camera_name")?.map_or(Ok(""), Entry::text)?;
    let mut notes = root.of_file(&KNOWN, options)?;
    for (group, known) in parts(&camera).map_or(Vec::new(), |(_, groups)| groups) {
        let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
        let of_group =
            root.key(group)?.map_or(Ok(Vec::new()), |entry| entry.of_lens(&names, options)).map_err(|error| error.in_key(group))?;
        notes.extend(of_group.into_iter().map(|note| format!("of {group}, {note}")));
    }
    Ok(vec![NamedCamera { notes, ..NamedCamera::new(name, camera) }])
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let named = &cameras[0];
    let ImageSize { width, height } = named.camera.size();
    let (kind, groups) = parts(&named.camera).ok_or_else(|| FORMAT.other_model("a camera of MEI, KANNALA_BRANDT or PINHOLE"))?;
    let mut out = format!("%YAML:1.0\n---\nmodel_type: {kind}\ncamera_name: {}\n", quoted(&named.name));
    out.push_str(&format!("image_width: {width}\nimage_height: {height}\n"));
    for (group, values) in groups {
        out.push_str(&format!("{group}:\n"));
        values.iter().for_each(|(name, value)| out.push_str(&format!("   {name}: {}\n", shortest(*value))));
    }
    Ok(out)
}

type Group = (&'static str, Vec<(&'static str, f64)>);

fn parts(camera: &Camera) -> Option<(&'static str, Vec<Group>)> {
    let distortion = |[k1, k2, p1, p2]: [f64; 4]| ("distortion_parameters", vec![("k1", k1), ("k2", k2), ("p1", p1), ("p2", p2)]);
    let projection = |names: [&'static str; 4], values: [f64; 4]| ("projection_parameters", names.into_iter().zip(values).collect());
    Some(match *camera {
        Camera::Omni(Omni { fx, fy, cx, cy, xi, k, p, .. }) => {
            let mirror = ("mirror_parameters", vec![("xi", xi)]);
            ("MEI", vec![mirror, distortion([k[0], k[1], p[0], p[1]]), projection(["gamma1", "gamma2", "u0", "v0"], [fx, fy, cx, cy])])
        }
        Camera::OpenCvFisheye(OpenCvFisheye { fx, fy, cx, cy, skew: 0.0, k, .. }) => {
            let names = ["k2", "k3", "k4", "k5", "mu", "mv", "u0", "v0"];
            let values = [k[0], k[1], k[2], k[3], fx, fy, cx, cy];
            ("KANNALA_BRANDT", vec![("projection_parameters", names.into_iter().zip(values).collect())])
        }
        _ => {
            let Brown { fx, fy, cx, cy, k, p1, p2, .. } = Brown::of(camera).filter(|b| b.skew == 0.0 && b.radial() <= 2)?;
            ("PINHOLE", vec![distortion([k[0], k[1], p1, p2]), projection(["fx", "fy", "cx", "cy"], [fx, fy, cx, cy])])
        }
    })
}
