//! Bundle Adjustment in the Large: Bundler's camera, its pose as a rotation vector, after the observations.

use calibench_model::NamedCamera;
use calibench_model::camera::tool_conventions;
use calibench_model::convert::Target;
use calibench_model::named_camera::Pose;

use super::PLAIN;
use super::bundler::{camera, parts};
use crate::format::{Keeps, KeptPose, Model};
use crate::number::shortest;
use crate::pose::{of_rotation_vector, of_rt, rotation_vector};
use crate::source::Source;
use crate::words::Words;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "bal",
    tool: "Bundle Adjustment in the Large",
    versions: "problem files",
    extension: "txt",
    many: true,
    states_size: false,
    recognise,
    read,
    write: Some(write),
    convention: Some(&tool_conventions::BUNDLER),
    models: |_| vec![Model { name: "f, k1, k2", target: Target::Centred { radial: 2 } }],
    keeps: Keeps { pose: KeptPose::InWorld, ..PLAIN.keeps },
    ..PLAIN
};

fn recognise(source: &Source<'_>) -> Result<(), String> {
    let whole = |word: &&str| word.bytes().all(|byte| byte.is_ascii_digit());
    let mut lines = source.lines().map(|(_, line)| line.split_whitespace().collect::<Vec<_>>());
    let (first, second) = (lines.next().unwrap_or_default(), lines.next().unwrap_or_default());
    let header = first.len() == 3 && first.iter().all(whole);
    if header && matches!(second.len(), 1 | 4) { Ok(()) } else { Err("no line of three counts".into()) }
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let size = options.size_or(None)?;
    let mut words = Words::new(source.text);
    let count = words.whole("the number of cameras")?;
    words.whole("the number of points")?;
    for _ in 0..words.whole("the number of observations")? {
        words.numbers::<4>("the observations' end")?;
    }
    let mut cameras = Vec::new();
    for index in 0..count {
        let [a, b, c, x, y, z, f, k1, k2] = words.numbers(&format!("the nine numbers of camera {index}"))?;
        let camera = camera([f, k1, k2], size).map_err(|error| error.of(format!("camera {index}")))?;
        let pose = of_rt(of_rotation_vector([a, b, c]), [x, y, z])?.with_y_and_z_reversed();
        cameras.push(NamedCamera { pose: Some(pose), ..NamedCamera::new(index.to_string(), camera) });
    }
    Ok(cameras)
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut out = format!("{} 0 0\n", cameras.len());
    for named in cameras {
        let pose = named.pose.unwrap_or(Pose::IDENTITY).with_y_and_z_reversed();
        let values = [rotation_vector(pose.camera_from_world), pose.t(), parts(&named.camera, &FORMAT)?].concat();
        values.into_iter().for_each(|value| out.push_str(&(shortest(value) + "\n")));
    }
    Ok(out)
}
