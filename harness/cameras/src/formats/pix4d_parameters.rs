//! Pix4D's calibrated_camera_parameters.txt: for each image its size, K, R1 to R3, T1, T2, position and rotation.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, ImageSize, Pix4d, TangentialOrder};
use calibench_model::named_camera::Pose;

use super::PLAIN;
use super::pix4d_cam::camera;
use crate::format::{Keeps, KeptCovariance, KeptPose};
use crate::number::{fixed, numbers, pixels};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "pix4d-parameters",
    tool: "Pix4D",
    versions: "calibrated_camera_parameters.txt, perspective lens",
    extension: "txt",
    words: "fileName imageWidth imageHeight matrix radial tangential position rotation",
    verified: Some(
        "K [R, -R t] gives Pix4D's P-matrices of all 168 images, to their printed digits (order and signs of T1, T2: unverified)",
    ),
    many: true,
    states_size: true,
    recognise: |source| {
        let first = source.lines().next().map_or("", |(_, line)| line);
        let found = first.split_whitespace().eq(HEADER[0].split_whitespace());
        if found { Ok(()) } else { Err(format!("the first line is not `{}`", HEADER[0])) }
    },
    read,
    write: Some(write),
    keeps: Keeps { splines: false, name: true, pitch: false, pose: KeptPose::InWorld, covariance: KeptCovariance::None },
    ..PLAIN
};

const HEADER: [&str; 7] = [
    "fileName imageWidth imageHeight",
    "camera matrix K [3x3]",
    "radial distortion [3x1]",
    "tangential distortion [2x1]",
    "camera position t [3x1]",
    "camera rotation R [3x3]",
    "camera model m = K [R|-Rt] X",
];
/// What an image's lines hold; the first is its name and size.
const LINES: [&str; 9] = ["K", "K", "K", "radial distortion", "tangential distortion", "position", "rotation", "rotation", "rotation"];

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let mut lines = source.lines();
    for expected in HEADER {
        let (line, text) = lines.next().ok_or_else(|| CameraFileError::new(format!("ends before `{expected}`")))?;
        if !text.split_whitespace().eq(expected.split_whitespace()) {
            return Err(CameraFileError::new(format!("expected `{expected}`")).on_line(line));
        }
    }
    let mut cameras = Vec::new();
    while let Some(first) = lines.next() {
        cameras.push(image(first, &mut lines, options)?);
    }
    if cameras.is_empty() { Err(CameraFileError::new("holds no image below its header")) } else { Ok(cameras) }
}

fn image<'a>(
    (first, heading): (usize, &'a str),
    lines: &mut impl Iterator<Item = (usize, &'a str)>,
    options: &ReadOptions,
) -> Result<NamedCamera, CameraFileError> {
    let mut parts = heading.rsplitn(3, char::is_whitespace);
    let (height, width, name) = (parts.next(), parts.next(), parts.next().unwrap_or("").trim());
    let side = |text: Option<&str>| pixels(text.unwrap_or("")).map_err(|error| error.on_line(first).of("fileName imageWidth imageHeight"));
    let size = options.size_or(Some(ImageSize { width: side(width)?, height: side(height)? })).map_err(|error| error.on_line(first))?;
    let mut next = |index: usize| lines.next().ok_or_else(|| CameraFileError::new("ends inside an image").on_line(first).of(LINES[index]));
    let mut row = |index: usize| next(index).and_then(|at| values::<3>(at, LINES[index]));
    let k = [row(0)?, row(1)?, row(2)?];
    let r = row(3)?;
    let t = next(4).and_then(|at| values::<2>(at, LINES[4]))?;
    let mut row = |index: usize| next(index).and_then(|at| values::<3>(at, LINES[index]));
    let (position, camera_from_world) = (row(5)?, [row(6)?, row(7)?, row(8)?]);
    let [[f_px, s, px], [zero, fy, py], last] = k;
    if f_px <= 0.0 || f_px != fy || s != 0.0 || zero != 0.0 || last != [0.0, 0.0, 1.0] {
        return Err(CameraFileError::new("expected f, 0, cx; 0, f, cy; 0, 0, 1 with f above zero").on_line(first + 1).of("K"));
    }
    // Zero says that the file does not state the sensor's width.
    let camera = Pix4d { size, sensor_width_mm: 0.0, f_px, px, py, r, t, order: TangentialOrder::OpenCv };
    let pose = Some(Pose { camera_from_world, position });
    let notes = vec!["the width of the sensor is not stated: no mm without it".to_owned()];
    Ok(NamedCamera { pose, notes, ..NamedCamera::new(name, Camera::Pix4d(camera)) })
}

fn values<const N: usize>((line, text): (usize, &str), what: &str) -> Result<[f64; N], CameraFileError> {
    numbers(text).map_err(|error| error.on_line(line).of(what))
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut out = HEADER.join("\n") + "\n\n";
    for named in cameras {
        let camera = camera(named, &FORMAT)?;
        let Some(pose) = &named.pose else { return Err(CameraFileError::new("needs a position and a rotation for each image")) };
        let row = |values: &[f64]| values.iter().map(|&value| fixed(value)).collect::<Vec<_>>().join(" ") + "\n";
        let name = if named.name.trim().is_empty() { "camera".to_owned() } else { named.name.replace(['\n', '\r'], " ") };
        out.push_str(&format!("{name} {} {}\n", camera.size.width, camera.size.height));
        out.push_str(&format!("{} 0 {}\n0 {} {}\n0 0 1\n", fixed(camera.f_px), fixed(camera.px), fixed(camera.f_px), fixed(camera.py)));
        out.push_str(&(row(&camera.r) + &row(&camera.t) + &row(&pose.position)));
        pose.camera_from_world.iter().for_each(|line| out.push_str(&row(line)));
    }
    Ok(out)
}
