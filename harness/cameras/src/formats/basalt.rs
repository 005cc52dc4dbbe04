//! basalt's calibration JSON: cameras of a rig with an inertial sensor.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel, DoubleSphere, Eucm, Fov, ImageSize, OpenCv, OpenCvFisheye, tool_conventions};
use calibench_model::convert::Target;
use calibench_model::named_camera::{Pose, PoseFrame};

use super::PLAIN;
use crate::brown::{Brown, positive};
use crate::format::{Keeps, KeptPose, Model};
use crate::number::{row, shortened, shortest};
use crate::pose::{of_camera_to_world, of_quaternion, quaternion};
use crate::source::Source;
use crate::tree::Entry;
use crate::{CameraFileError, CameraFormat, ReadOptions, json, noted};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "basalt",
    tool: "basalt",
    versions: "calibration JSON",
    extension: "json",
    words: "value0 T_imu_cam intrinsics camera_type fx fy cx cy xi alpha resolution px py pz qx qy qz qw",
    many: true,
    recognise: |source| {
        let found = source.text.trim_start().starts_with('{') && source.text.contains("\"camera_type\"");
        if found { Ok(()) } else { Err("no JSON with `camera_type`".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::BASALT),
    models: |_| {
        vec![
            Model { name: "pinhole-radtan8", target: Target::OpenCv { coefficients: 8 } },
            Model { name: "kb4", target: Target::OpenCvFisheye },
            Model { name: "fov", target: Target::Fov },
            Model { name: "eucm", target: Target::Eucm },
            Model { name: "ds", target: Target::DoubleSphere },
        ]
    },
    keeps: Keeps { pose: KeptPose::InRig, ..PLAIN.keeps },
    ..PLAIN
};

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let tree = json::json(source.text)?;
    let root = tree.required("value0")?;
    let (intrinsics, sizes) = (root.required("intrinsics")?.items()?, root.required("resolution")?);
    if sizes.items()?.len() != intrinsics.len() {
        return Err(sizes
            .wrong(&format!("expected {} sizes, one for each camera, found {}", intrinsics.len(), sizes.items()?.len()))
            .of("resolution"));
    }
    let poses = root.key("T_imu_cam")?.map(Entry::items).transpose()?;
    if let Some(poses) = poses.filter(|poses| poses.len() != intrinsics.len()) {
        return Err(root
            .wrong(&format!("expected {} poses, one for each camera, found {}", intrinsics.len(), poses.len()))
            .of("T_imu_cam"));
    }
    let mut cameras = Vec::new();
    for (index, (entry, size)) in intrinsics.iter().zip(sizes.items()?).enumerate() {
        let [width, height] = size.items()? else { return Err(size.wrong("expected columns and rows").of("resolution")) };
        let side = |side: &Entry| crate::number::pixels(side.text()?).map_err(|error| error.on_line(side.line).of("resolution"));
        let size = options.size_or(Some(ImageSize { width: side(width)?, height: side(height)? }))?;
        let mut named = camera(entry, size, options).map_err(|error| error.in_key(&format!("intrinsics[{index}]")))?;
        if let Some(poses) = poses {
            (named.pose, named.pose_frame) = (Some(pose(&poses[index])?), PoseFrame::Imu);
        }
        cameras.push(named);
    }
    let mut notes = tree.of_file(&["value0"], options)?;
    notes.extend(root.of_file(&["T_imu_cam", "intrinsics", "resolution"], options)?);
    Ok(noted(cameras, &notes))
}

fn pose(entry: &Entry) -> Result<Pose, CameraFileError> {
    let value = |name| entry.number_of(name);
    let rotation = of_quaternion([value("qx")?, value("qy")?, value("qz")?, value("qw")?]).map_err(|error| error.on_line(entry.line))?;
    of_camera_to_world(rotation, [value("px")?, value("py")?, value("pz")?])
}

fn camera(entry: &Entry, size: ImageSize, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let kind = entry.text_of("camera_type")?;
    let values = entry.required("intrinsics")?;
    let v = |name| values.number_of(name);
    let at = |error: CameraFileError| error.on_line(values.line);
    let (fx, fy, cx, cy) = (v("fx")?, v("fy")?, v("cx")?, v("cy")?);
    positive("fx", fx).map_err(at)?;
    positive("fy", fy).map_err(at)?;
    let (camera, own): (Camera, &[&str]) = match kind {
        "ds" => (DoubleSphere { size, fx, fy, cx, cy, xi: v("xi")?, alpha: v("alpha")? }.into(), &["xi", "alpha"]),
        "eucm" => (Eucm { size, fx, fy, cx, cy, alpha: v("alpha")?, beta: v("beta")? }.into(), &["alpha", "beta"]),
        "ucm" => (Eucm { size, fx, fy, cx, cy, alpha: v("alpha")?, beta: 1.0 }.into(), &["alpha"]),
        "fov" => (Fov { size, fx, fy, cx, cy, w: v("w")? }.into(), &["w"]),
        "kb4" => {
            let k = [v("k1")?, v("k2")?, v("k3")?, v("k4")?];
            (OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k }.into(), &["k1", "k2", "k3", "k4"])
        }
        "pinhole" => (Brown::plain(size, [fx, fy, cx, cy]).camera(), &[]),
        "pinhole-radtan8" => {
            let mut distortion = [0.0; 14];
            for (slot, name) in distortion.iter_mut().zip(RADTAN) {
                *slot = v(name)?;
            }
            (OpenCv { size, fx, fy, cx, cy, distortion, coefficients: 8 }.into(), &RADTAN)
        }
        _ => {
            let problem = format!("`{}` is not known; expected ds, eucm, ucm, fov, kb4, pinhole or pinhole-radtan8", shortened(kind));
            return Err(entry.wrong(&problem).of("camera_type"));
        }
    };
    let known = [&["fx", "fy", "cx", "cy"], own].concat();
    let mut notes = entry.of_lens(&["camera_type", "intrinsics"], options)?;
    notes.extend(values.of_lens(&known, options)?);
    Ok(NamedCamera { notes, ..NamedCamera::new("", camera) })
}

const RADTAN: [&str; 8] = ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"];

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let intrinsics = cameras.iter().map(|named| written(&named.camera)).collect::<Result<Vec<_>, _>>()?;
    let posed: Vec<&Pose> = cameras.iter().filter_map(|named| named.pose.as_ref()).collect();
    let mut parts = Vec::new();
    if posed.len() == cameras.len() {
        parts.push(format!(
            "        \"T_imu_cam\": [\n{}\n        ]",
            posed.iter().map(|pose| transformation(pose)).collect::<Vec<_>>().join(",\n")
        ));
    }
    parts.push(format!("        \"intrinsics\": [\n{}\n        ]", intrinsics.join(",\n")));
    let sizes: Vec<String> =
        cameras.iter().map(|named| named.camera.size()).map(|size| format!("[{}, {}]", size.width, size.height)).collect();
    parts.push(format!("        \"resolution\": [{}]", sizes.join(", ")));
    Ok(format!("{{\n    \"value0\": {{\n{}\n    }}\n}}\n", parts.join(",\n")))
}

fn transformation(pose: &Pose) -> String {
    let names = ["px", "py", "pz", "qx", "qy", "qz", "qw"];
    let values = pose.position.into_iter().chain(quaternion(pose.world_from_camera()));
    let pairs: Vec<String> = names.iter().zip(values).map(|(name, value)| format!("\"{name}\": {}", shortest(value))).collect();
    format!("            {{{}}}", pairs.join(", "))
}

fn written(camera: &Camera) -> Result<String, CameraFileError> {
    let (kind, focal, own): (&str, [f64; 4], Vec<(&str, f64)>) = match *camera {
        Camera::DoubleSphere(DoubleSphere { fx, fy, cx, cy, xi, alpha, .. }) => {
            ("ds", [fx, fy, cx, cy], vec![("xi", xi), ("alpha", alpha)])
        }
        Camera::Eucm(Eucm { fx, fy, cx, cy, alpha, beta, .. }) => ("eucm", [fx, fy, cx, cy], vec![("alpha", alpha), ("beta", beta)]),
        Camera::Fov(Fov { fx, fy, cx, cy, w, .. }) => ("fov", [fx, fy, cx, cy], vec![("w", w)]),
        Camera::OpenCvFisheye(OpenCvFisheye { fx, fy, cx, cy, skew: 0.0, k, .. }) => {
            ("kb4", [fx, fy, cx, cy], ["k1", "k2", "k3", "k4"].into_iter().zip(k).collect())
        }
        Camera::OpenCv(OpenCv { fx, fy, cx, cy, distortion, .. }) if distortion[8..].iter().all(|&v| v == 0.0) => {
            let own = if distortion == [0.0; 14] { Vec::new() } else { RADTAN.into_iter().zip(distortion).collect() };
            (if own.is_empty() { "pinhole" } else { "pinhole-radtan8" }, [fx, fy, cx, cy], own)
        }
        _ => return Err(FORMAT.other_model("cameras of ds, eucm, fov, kb4 and pinhole-radtan8")),
    };
    let all = ["fx", "fy", "cx", "cy"].into_iter().zip(focal).chain(own);
    let pairs: Vec<String> = all.map(|(name, value)| format!("\"{name}\": {}", row(&[value]))).collect();
    Ok(format!("            {{\"camera_type\": \"{kind}\", \"intrinsics\": {{{}}}}}", pairs.join(", ")))
}
