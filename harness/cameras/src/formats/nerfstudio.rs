//! nerfstudio's and instant-ngp's transforms.json: one camera for all images, or one for each; poses in OpenGL's axes.

use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCvFisheye, tool_conventions};
use calibench_model::convert::Target;
use calibench_model::named_camera::Pose;
use calibench_model::{CornerPoint, NamedCamera, PixelPoint};

use super::PLAIN;
use crate::brown::{Brown, positive};
use crate::format::{Keeps, KeptPose, Model};
use crate::json::{self, quoted};
use crate::number::{row, shortened, shortest};
use crate::pose::{of_camera_to_world, rigid};
use crate::source::Source;
use crate::tree::Entry;
use crate::{CameraFileError, CameraFormat, ReadOptions, noted};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "nerfstudio",
    tool: "nerfstudio, instant-ngp",
    versions: "transforms.json",
    extension: "json",
    words: "camera_model fl_x fl_y cx cy w h k1 k2 p1 p2 camera_angle_x aabb_scale frames file_path transform_matrix",
    many: true,
    recognise: |source| {
        let text = source.text;
        let found = text.trim_start().starts_with('{') && (text.contains("\"fl_x\"") || text.contains("\"camera_angle_x\""));
        if found { Ok(()) } else { Err("no JSON with `fl_x`".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::NERFSTUDIO),
    models: |_| {
        vec![
            Model { name: "OPENCV", target: Target::OpenCv { coefficients: 4 } },
            Model { name: "OPENCV", target: Target::OpenCv { coefficients: 5 } },
            Model { name: "OPENCV_FISHEYE", target: Target::OpenCvFisheye },
        ]
    },
    keeps: Keeps { name: true, pose: KeptPose::InWorld, ..PLAIN.keeps },
    half_space: true,
    ..PLAIN
};

const INTRINSICS: [&str; 16] = [
    "camera_model",
    "is_fisheye",
    "fl_x",
    "fl_y",
    "cx",
    "cy",
    "w",
    "h",
    "k1",
    "k2",
    "k3",
    "k4",
    "p1",
    "p2",
    "camera_angle_x",
    "camera_angle_y",
];

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let root = json::json(source.text)?;
    let frames = root.key("frames")?.map_or(Ok(&[][..]), Entry::items)?;
    let unknown = root.of_file(&[&INTRINSICS[..], &["frames"]].concat(), options)?;
    if frames.is_empty() {
        let camera = camera(&[&root], options)?;
        return Ok(vec![NamedCamera { notes: unknown, ..NamedCamera::new("", camera) }]);
    }
    let mut cameras = Vec::new();
    for (index, frame) in frames.iter().enumerate() {
        let at = |error: CameraFileError| error.in_key(&format!("frames[{index}]"));
        let camera = camera(&[frame, &root], options).map_err(at)?;
        let name = frame.key("file_path")?.map_or(Ok(""), Entry::text).map_err(at)?;
        let pose = frame.key("transform_matrix")?.map(pose).transpose().map_err(at)?;
        cameras.push(NamedCamera { pose, ..NamedCamera::new(name, camera) });
    }
    let known = [&INTRINSICS[..], &["file_path", "transform_matrix"]].concat();
    let mut others: Vec<(&str, usize)> = Vec::new();
    for frame in frames {
        let names = frame.entries()?.iter().map(|(name, entry)| (name.as_str(), entry.line));
        others.extend(names.filter(|(name, _)| !known.contains(name)));
    }
    others.sort_unstable();
    others.dedup_by_key(|(name, _)| *name);
    let more = options.of_file(others.into_iter(), |line, error| error.on_line(line))?;
    let more: Vec<String> = more.into_iter().map(|note| format!("of frames, {note}")).collect();
    Ok(noted(noted(cameras, &unknown), &more))
}

/// From the camera to the world, the camera with y up and z backwards.
fn pose(entry: &Entry) -> Result<Pose, CameraFileError> {
    let found = entry.rows().and_then(|rows| rigid(&rows)).and_then(|(r, position)| of_camera_to_world(r, position));
    let found = found.map_err(|error| if error.line.is_some() { error } else { error.on_line(entry.line) }.of("transform_matrix"))?;
    Ok(found.with_y_and_z_reversed())
}

/// The camera of what a frame says, or else the file for all frames.
fn camera(places: &[&Entry], options: &ReadOptions) -> Result<Camera, CameraFileError> {
    let find = |name: &str| -> Result<Option<&Entry>, CameraFileError> {
        for place in places {
            if let Some(found) = place.key(name)? {
                return Ok(Some(found));
            }
        }
        Ok(None)
    };
    let v = |name: &str| find(name)?.map(|entry| entry.number().map_err(|error| error.of(name))).transpose();
    let or_zero = |name: &str| Ok::<f64, CameraFileError>(v(name)?.unwrap_or(0.0));
    let whole = |name: &str| {
        let side = |entry: &Entry| crate::number::pixels(entry.text()?).map_err(|error| error.on_line(entry.line).of(name));
        find(name)?.map(side).transpose()
    };
    let stated = whole("w")?.zip(whole("h")?).map(|(width, height)| ImageSize { width, height });
    let size = options.size_or(stated)?;
    let of_angle = |name: &str, length: u32| Ok::<_, CameraFileError>(v(name)?.map(|angle| f64::from(length) / 2.0 / (0.5 * angle).tan()));
    let Some(fx) = v("fl_x")?.or(of_angle("camera_angle_x", size.width)?) else { return Err(places[0].wrong("has no `fl_x`")) };
    let fx = positive("fl_x", fx).map_err(|error| error.on_line(places[0].line))?;
    let fy = v("fl_y")?.or(of_angle("camera_angle_y", size.height)?).unwrap_or(fx);
    let fy = positive("fl_y", fy).map_err(|error| error.on_line(places[0].line))?;
    let corner = CornerPoint { x: v("cx")?.unwrap_or(f64::from(size.width) / 2.0), y: v("cy")?.unwrap_or(f64::from(size.height) / 2.0) };
    let PixelPoint { x: cx, y: cy } = corner.to_pixel();
    let k = [or_zero("k1")?, or_zero("k2")?, or_zero("k3")?, or_zero("k4")?];
    let model = find("camera_model")?;
    // instant-ngp's word for the same.
    let fisheye = find("is_fisheye")?.map(|entry| is_fisheye(entry).map(|fisheye| (fisheye, entry))).transpose()?;
    let name = match (model, fisheye) {
        (None, Some((true, _))) => "OPENCV_FISHEYE",
        (None, _) => "OPENCV",
        (Some(model), _) => model.text()?,
    };
    if let Some((_, entry)) = fisheye.filter(|(fisheye, _)| *fisheye != (name == "OPENCV_FISHEYE")) {
        return Err(entry.wrong(&format!("contradicts `camera_model`, {}", shortened(name))).of("is_fisheye"));
    }
    match name {
        "OPENCV_FISHEYE" => Ok(OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k }.into()),
        "OPENCV" | "PINHOLE" | "SIMPLE_PINHOLE" | "SIMPLE_RADIAL" | "RADIAL" => {
            Ok(Brown { k, p1: or_zero("p1")?, p2: or_zero("p2")?, ..Brown::plain(size, [fx, fy, cx, cy]) }.camera())
        }
        other => {
            let problem = format!("`{}` is not known; expected OPENCV, OPENCV_FISHEYE or PINHOLE", shortened(other));
            Err(model.unwrap_or(places[0]).wrong(&problem).of("camera_model"))
        }
    }
}

fn is_fisheye(entry: &Entry) -> Result<bool, CameraFileError> {
    match entry.text()? {
        "true" | "1" => Ok(true),
        "false" | "0" => Ok(false),
        _ => Err(entry.wrong("expected true or false").of("is_fisheye")),
    }
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let parts = cameras.iter().map(|named| parts(&named.camera)).collect::<Option<Vec<_>>>();
    let parts = parts.ok_or_else(|| FORMAT.other_model("cameras of OPENCV and OPENCV_FISHEYE"))?;
    let model = parts[0].0;
    if parts.iter().any(|(other, _)| *other != model) {
        return Err(CameraFileError::new("holds cameras of one model only, found OPENCV and OPENCV_FISHEYE").of("camera_model"));
    }
    if let ([named], None) = (cameras, cameras[0].pose) {
        // The name has its place in a frame alone.
        if named.name.is_empty() {
            return Ok(format!("{{\n  \"camera_model\": \"{model}\",\n  {},\n  \"frames\": []\n}}\n", parts[0].1.join(",\n  ")));
        }
    }
    let frames = cameras.iter().zip(&parts).map(|(named, (_, lines))| {
        let mut lines = lines.clone();
        lines.insert(0, format!("\"file_path\": {}", quoted(&named.name)));
        if let Some(pose) = &named.pose {
            lines.push(format!("\"transform_matrix\": {}", transformation(pose)));
        }
        format!("    {{\n      {}\n    }}", lines.join(",\n      "))
    });
    let frames: Vec<String> = frames.collect();
    Ok(format!("{{\n  \"camera_model\": \"{model}\",\n  \"frames\": [\n{}\n  ]\n}}\n", frames.join(",\n")))
}

fn transformation(pose: &Pose) -> String {
    let (r, position) = (pose.with_y_and_z_reversed().world_from_camera(), pose.position);
    let rows = (0..3).map(|i| format!("[{}]", row(&[r[i][0], r[i][1], r[i][2], position[i]])));
    format!("[{}, [0.0, 0.0, 0.0, 1.0]]", rows.collect::<Vec<_>>().join(", "))
}

/// The model and its lines.
fn parts(camera: &Camera) -> Option<(&'static str, Vec<String>)> {
    let (model, [fx, fy, cx, cy], d) = match *camera {
        Camera::OpenCvFisheye(OpenCvFisheye { fx, fy, cx, cy, skew: 0.0, k, .. }) => {
            ("OPENCV_FISHEYE", [fx, fy, cx, cy], [k[0], k[1], k[2], k[3], 0.0, 0.0])
        }
        _ => {
            let Brown { fx, fy, cx, cy, k, p1, p2, .. } = Brown::of(camera).filter(|brown| brown.skew == 0.0)?;
            ("OPENCV", [fx, fy, cx, cy], [k[0], k[1], k[2], k[3], p1, p2])
        }
    };
    let (size, corner) = (camera.size(), PixelPoint::new(cx, cy).to_corner());
    let mut lines = vec![format!("\"w\": {}", size.width), format!("\"h\": {}", size.height)];
    let named = ["fl_x", "fl_y", "cx", "cy"].into_iter().zip([fx, fy, corner.x, corner.y]);
    let distortion = ["k1", "k2", "k3", "k4", "p1", "p2"].into_iter().zip(d).filter(|(_, value)| *value != 0.0);
    lines.extend(named.chain(distortion).map(|(name, value)| format!("\"{name}\": {}", shortest(value))));
    Some((model, lines))
}
