//! Bundler's bundle.out: focal length, two radial coefficients and a pose for each image; y up, the principal point in the middle.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, ImageSize, tool_conventions};
use calibench_model::convert::Target;
use calibench_model::named_camera::Pose;

use super::PLAIN;
use crate::brown::{Brown, middle};
use crate::format::{Keeps, KeptPose, Model};
use crate::number::{numbers, shortest};
use crate::pose::of_rt;
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions, noted};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "bundler",
    tool: "Bundler",
    versions: "bundle.out v0.3",
    extension: "out",
    words: "Bundle file",
    many: true,
    states_size: false,
    recognise: |source| {
        let first = source.lines().next().map_or("", |(_, line)| line);
        if first.starts_with(HEADER) { Ok(()) } else { Err(format!("no `{HEADER}`")) }
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::BUNDLER),
    models: |_| vec![Model { name: "f, k1, k2", target: Target::Centred { radial: 2 } }],
    keeps: Keeps { pose: KeptPose::InWorld, ..PLAIN.keeps },
    ..PLAIN
};

const HEADER: &str = "# Bundle file";

/// The camera of f, k1, k2: the plane is Bundler's with y reversed, which does not change a radial polynomial.
pub(super) fn camera([f, k1, k2]: [f64; 3], size: ImageSize) -> Result<Camera, CameraFileError> {
    if f <= 0.0 {
        return Err(CameraFileError::new(format!("expected a focal length above zero, found {f}")));
    }
    let centre = middle(size);
    Ok(Brown { k: [k1, k2, 0.0, 0.0], ..Brown::plain(size, [f, f, centre.x, centre.y]) }.camera())
}

/// f, k1, k2 of a camera.
pub(super) fn parts(camera: &Camera, format: &CameraFormat) -> Result<[f64; 3], CameraFileError> {
    let brown = Brown::of(camera).filter(|brown| {
        let centre = middle(brown.size);
        let centred = (brown.cx - centre.x).abs() <= 1e-9 && (brown.cy - centre.y).abs() <= 1e-9;
        centred && brown.skew == 0.0 && brown.has_one_focal() && brown.radial() <= 2 && !brown.has_tangential()
    });
    brown
        .map(|brown| [brown.fx, brown.k[0], brown.k[1]])
        .ok_or_else(|| format.other_model("cameras of one focal length, k1 and k2, with the principal point in the middle of the frame"))
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let mut lines = source.lines().filter(|(_, line)| !line.starts_with('#'));
    let (line, counts) = lines.next().ok_or_else(|| CameraFileError::new("ends before the number of cameras"))?;
    let [count, _points]: [f64; 2] = numbers(counts).map_err(|error| error.on_line(line))?;
    let (mut cameras, mut unused) = (Vec::new(), 0);
    for index in 0..count as usize {
        let mut next = || -> Result<(usize, [f64; 3]), CameraFileError> {
            let (line, text) = lines.next().ok_or_else(|| CameraFileError::new(format!("ends inside camera {index} of {count}")))?;
            numbers(text).map(|values| (line, values)).map_err(|error| error.on_line(line))
        };
        let ((line, inner), rows, (_, t)) = (next()?, [next()?.1, next()?.1, next()?.1], next()?);
        if inner == [0.0; 3] {
            // An image that Bundler did not orient.
            unused += 1;
            continue;
        }
        let camera = camera(inner, options.size_or(None)?).map_err(|error| error.on_line(line))?;
        let pose = of_rt(rows, t).map_err(|error| error.on_line(line))?.with_y_and_z_reversed();
        cameras.push(NamedCamera { pose: Some(pose), ..NamedCamera::new(index.to_string(), camera) });
    }
    let note = (unused > 0).then(|| format!("{unused} images that are not oriented were left out"));
    Ok(noted(cameras, note.as_slice()))
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut out = format!("{HEADER} v0.3\n{} 0\n", cameras.len());
    for named in cameras {
        let pose = named.pose.unwrap_or(Pose::IDENTITY).with_y_and_z_reversed();
        let mut line = |values: [f64; 3]| out.push_str(&(values.map(shortest).join(" ") + "\n"));
        line(parts(&named.camera, &FORMAT)?);
        pose.camera_from_world.into_iter().for_each(&mut line);
        line(pose.t());
    }
    Ok(out)
}
