//! Kalibr's camchain YAML: cameras of a rig, each with the transformation from the one before.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel, DoubleSphere, Eucm, Fov, ImageSize, Omni, OpenCv, OpenCvFisheye, tool_conventions};
use calibench_model::convert::Target;
use calibench_model::named_camera::{Pose, PoseFrame};

use super::PLAIN;
use super::opencv_yaml::{quoted, tree};
use crate::brown::{Brown, positive};
use crate::format::{Keeps, KeptPose, Model};
use crate::number::{row, shortened};
use crate::pose::{of_rt, rigid};
use crate::source::Source;
use crate::tree::Entry;
use crate::tree::left_out;
use crate::{CameraFileError, CameraFormat, ReadOptions, noted};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "kalibr",
    tool: "Kalibr",
    versions: "camchain YAML",
    extension: "yaml",
    words: "cam0 cam1 camera_model intrinsics distortion_model distortion_coeffs resolution T_cn_cnm1 T_cam_imu rostopic cam_overlaps timeshift_cam_imu",
    many: true,
    recognise,
    read,
    write: Some(write),
    convention: Some(&tool_conventions::KALIBR),
    models: |_| {
        vec![
            Model { name: "pinhole-radtan", target: Target::OpenCv { coefficients: 4 } },
            Model { name: "pinhole-equi", target: Target::OpenCvFisheye },
            Model { name: "pinhole-fov", target: Target::Fov },
            Model { name: "omni-none", target: Target::Omni { distortion: false } },
            Model { name: "eucm-none", target: Target::Eucm },
            Model { name: "ds-none", target: Target::DoubleSphere },
            Model { name: "omni-radtan", target: Target::Omni { distortion: true } },
        ]
    },
    keeps: Keeps { name: true, pose: KeptPose::InRig, ..PLAIN.keeps },
    ..PLAIN
};

const KNOWN: [&str; 10] = [
    "camera_model",
    "intrinsics",
    "distortion_model",
    "distortion_coeffs",
    "resolution",
    "rostopic",
    "T_cn_cnm1",
    "T_cam_imu",
    // Which cameras see the same, and when against the inertial sensor: nothing of a camera.
    "cam_overlaps",
    "timeshift_cam_imu",
];
/// Largest difference of the two ways by which a rig's poses may be stated that passes without a word.
const AGREE: f64 = 1e-6;

fn recognise(source: &Source<'_>) -> Result<(), String> {
    let has = |key: &str| source.text.lines().any(|line| line.trim_start().starts_with(key));
    let found = source.text.lines().any(|line| line.starts_with("cam0:")) && has("distortion_coeffs:") && has("camera_model:");
    if source.xml.is_none() && found { Ok(()) } else { Err("no `cam0:` with `distortion_coeffs:`".into()) }
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let root = tree(source.text)?;
    let (mut cameras, mut chain, mut against_imu) = (Vec::new(), Vec::new(), Vec::new());
    let mut used = Vec::new();
    for index in 0.. {
        let key = format!("cam{index}");
        let Some(entry) = root.key(&key)? else { break };
        let at = |error: CameraFileError| error.in_key(&key);
        let mut named = camera(entry, options).map_err(at)?;
        if named.name.is_empty() {
            named.name.clone_from(&key);
        }
        let above = format!("T_cam{index}_cam{}", index.max(1) - 1);
        // That of the first camera is out of the rig's own frame.
        let beside = if index == 0 { None } else { root.key(&above)? };
        let step = entry.key("T_cn_cnm1")?.or(beside);
        chain.push(step.map(pose).transpose().map_err(at)?);
        against_imu.push(entry.key("T_cam_imu")?.map(pose).transpose().map_err(at)?);
        cameras.push(named);
        used.extend([key, above]);
    }
    let used: Vec<&str> = used.iter().map(String::as_str).collect();
    let unknown = root.of_file(&used, options)?;
    place(&mut cameras, &chain, &against_imu);
    Ok(noted(cameras, &unknown))
}

fn pose(entry: &Entry) -> Result<Pose, CameraFileError> {
    let found = entry.rows().and_then(|rows| rigid(&rows)).and_then(|(r, t)| of_rt(r, t));
    found.map_err(|error| if error.line.is_some() { error } else { error.on_line(entry.line) })
}

/// Poses against the inertial sensor, where all are known, or else against the first camera.
fn place(cameras: &mut [NamedCamera], chain: &[Option<Pose>], against_imu: &[Option<Pose>]) {
    if against_imu.iter().all(Option::is_some) {
        let mut off: f64 = 0.0;
        for (index, (camera, pose)) in cameras.iter_mut().zip(against_imu).enumerate() {
            (camera.pose, camera.pose_frame) = (*pose, PoseFrame::Imu);
            if let (Some(pose), Some(Some(before)), Some(step)) = (pose, index.checked_sub(1).map(|i| against_imu[i]), chain[index]) {
                let [a, b] = [pose.seen_from(&before), step];
                off = a.t().iter().zip(b.t()).map(|(a, b)| (a - b).abs()).fold(off, f64::max);
            }
        }
        if off > AGREE {
            let note = format!("the poses against the IMU and between the cameras differ by up to {off:.2e}: the former are kept");
            cameras.iter_mut().for_each(|camera| camera.notes.push(note.clone()));
        }
        return;
    }
    let first = chain.first().copied().flatten();
    let frame = if first.is_some() { PoseFrame::Rig } else { PoseFrame::FirstCamera };
    let mut last = Some(first.unwrap_or(Pose::IDENTITY));
    for (index, (camera, step)) in cameras.iter_mut().zip(chain).enumerate() {
        if index > 0 {
            last = step.zip(last).map(|(step, last)| step.out_of(&last));
        }
        camera.pose_frame = frame;
        camera.pose = last;
    }
    if first.is_none() && cameras[1..].iter().all(|camera| camera.pose.is_none()) {
        // One camera without another has no pose.
        cameras.iter_mut().for_each(|camera| (camera.pose, camera.pose_frame) = (None, PoseFrame::World));
    }
    for (camera, _) in cameras.iter_mut().zip(against_imu).filter(|(_, pose)| pose.is_some()) {
        camera.notes.push(left_out("T_cam_imu"));
    }
}

fn camera(entry: &Entry, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let size = options.size_or(Some(entry.size_in("resolution")?)).map_err(|error| error.on_line(entry.line))?;
    let model = entry.text_of("camera_model")?;
    let distortion = entry.key("distortion_model")?.map_or(Ok("none"), Entry::text)?;
    let d = entry.key("distortion_coeffs")?.map_or(Ok(Vec::new()), Entry::row)?;
    let d4 =
        || <[f64; 4]>::try_from(d.as_slice()).map_err(|_| entry.wrong(&format!("expected 4 numbers for {distortion}, found {}", d.len())));
    let focal = |v: [f64; 4]| -> Result<[f64; 4], CameraFileError> {
        positive("intrinsics", v[0])?;
        positive("intrinsics", v[1])?;
        Ok(v)
    };
    let camera: Camera = match (model, distortion) {
        ("pinhole", "radtan" | "equidistant" | "equi" | "none" | "fov") => {
            let [fx, fy, cx, cy] = focal(entry.row_of("intrinsics")?)?;
            let plain = Brown::plain(size, [fx, fy, cx, cy]);
            match distortion {
                "none" => plain.camera(),
                "radtan" => d4().map(|[k1, k2, p1, p2]| Brown { k: [k1, k2, 0.0, 0.0], p1, p2, ..plain }.camera())?,
                "fov" => match d[..] {
                    [w] => Fov { size, fx, fy, cx, cy, w }.into(),
                    _ => return Err(entry.wrong(&format!("expected 1 number for fov, found {}", d.len())).of("distortion_coeffs")),
                },
                _ => OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k: d4()? }.into(),
            }
        }
        ("omni", "radtan" | "none") => {
            let [xi, fx, fy, cx, cy] = entry.row_of("intrinsics")?;
            focal([fx, fy, cx, cy])?;
            let [k1, k2, p1, p2] = if distortion == "none" { [0.0; 4] } else { d4()? };
            Omni { size, fx, fy, cx, cy, xi, k: [k1, k2], p: [p1, p2] }.into()
        }
        ("eucm", "none") => {
            let [alpha, beta, fx, fy, cx, cy] = entry.row_of("intrinsics")?;
            focal([fx, fy, cx, cy])?;
            Eucm { size, fx, fy, cx, cy, alpha, beta }.into()
        }
        ("ds", "none") => {
            let [xi, alpha, fx, fy, cx, cy] = entry.row_of("intrinsics")?;
            focal([fx, fy, cx, cy])?;
            DoubleSphere { size, fx, fy, cx, cy, xi, alpha }.into()
        }
        _ => {
            let known = "pinhole with radtan, equidistant, fov or none, omni with radtan or none, eucm or ds with none";
            let problem = format!("`{}` with `{}` is not known; expected {known}", shortened(model), shortened(distortion));
            return Err(entry.wrong(&problem).of("camera_model"));
        }
    };
    let name = entry.key("rostopic")?.map_or(Ok(""), Entry::text)?;
    let mut notes = entry.of_lens(&KNOWN, options)?;
    notes.extend(entry.key("timeshift_cam_imu")?.map(|_| left_out("timeshift_cam_imu")));
    Ok(NamedCamera { notes, ..NamedCamera::new(name, camera) })
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut out = String::new();
    for (index, named) in cameras.iter().enumerate() {
        let (model, intrinsics, distortion, d) = parts(&named.camera)
            .ok_or_else(|| FORMAT.other_model("cameras of pinhole, omni, eucm and ds, with four coefficients at most"))?;
        let ImageSize { width, height } = named.camera.size();
        out.push_str(&format!("cam{index}:\n  camera_model: {model}\n  intrinsics: [{}]\n", row(&intrinsics)));
        out.push_str(&format!("  distortion_model: {distortion}\n  distortion_coeffs: [{}]\n  resolution: [{width}, {height}]\n", row(&d)));
        if !named.name.is_empty() && named.name != format!("cam{index}") {
            out.push_str(&format!("  rostopic: {}\n", quoted(&named.name)));
        }
        if let Some(pose) = named.pose.filter(|_| named.pose_frame == PoseFrame::Imu) {
            out.push_str(&transformation("T_cam_imu", &pose));
        }
        let origin = (named.pose_frame == PoseFrame::Rig).then_some(Pose::IDENTITY);
        let before = index.checked_sub(1).map_or(origin, |i| cameras[i].pose);
        if let Some((pose, before)) = named.pose.zip(before) {
            out.push_str(&transformation("T_cn_cnm1", &pose.seen_from(&before)));
        }
    }
    Ok(out)
}

fn transformation(name: &str, pose: &Pose) -> String {
    let t = pose.t();
    let rows = (0..3).map(|i| {
        let [a, b, c] = pose.camera_from_world[i];
        format!("    - [{}]\n", row(&[a, b, c, t[i]]))
    });
    format!("  {name}:\n{}    - [0.0, 0.0, 0.0, 1.0]\n", rows.collect::<String>())
}

/// Camera model, its numbers, distortion model, its numbers.
fn parts(camera: &Camera) -> Option<(&'static str, Vec<f64>, &'static str, Vec<f64>)> {
    Some(match *camera {
        Camera::OpenCvFisheye(OpenCvFisheye { fx, fy, cx, cy, skew: 0.0, k, .. }) => {
            ("pinhole", vec![fx, fy, cx, cy], "equidistant", k.to_vec())
        }
        Camera::Fov(Fov { fx, fy, cx, cy, w, .. }) => ("pinhole", vec![fx, fy, cx, cy], "fov", vec![w]),
        Camera::Omni(Omni { fx, fy, cx, cy, xi, k, p, .. }) if k == [0.0; 2] && p == [0.0; 2] => {
            ("omni", vec![xi, fx, fy, cx, cy], "none", Vec::new())
        }
        Camera::Omni(Omni { fx, fy, cx, cy, xi, k, p, .. }) => ("omni", vec![xi, fx, fy, cx, cy], "radtan", vec![k[0], k[1], p[0], p[1]]),
        Camera::Eucm(Eucm { fx, fy, cx, cy, alpha, beta, .. }) => ("eucm", vec![alpha, beta, fx, fy, cx, cy], "none", Vec::new()),
        Camera::DoubleSphere(DoubleSphere { fx, fy, cx, cy, xi, alpha, .. }) => ("ds", vec![xi, alpha, fx, fy, cx, cy], "none", Vec::new()),
        Camera::OpenCv(OpenCv { .. }) | Camera::Agisoft(_) | Camera::Pix4d(_) => {
            let Brown { fx, fy, cx, cy, k, p1, p2, .. } = Brown::of(camera).filter(|b| b.skew == 0.0 && b.radial() <= 2)?;
            ("pinhole", vec![fx, fy, cx, cy], "radtan", vec![k[0], k[1], p1, p2])
        }
        _ => return None,
    })
}
