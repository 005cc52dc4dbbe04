//! kapture's sensors.txt: COLMAP's models between commas, beside sensors of other kinds.

use calibench_model::NamedCamera;
use calibench_model::camera::{CameraModel, ImageSize, tool_conventions};

use super::PLAIN;
use crate::format::{Keeps, Parts};
use crate::ids::Ids;
use crate::number::{finite, pixels, shortest};
use crate::numbering::Numbering;
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions, colmap_models, noted};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "kapture",
    tool: "kapture",
    versions: "sensors.txt of 1.0 and 1.1",
    extension: "txt",
    words: "kapture sensors camera SIMPLE_PINHOLE PINHOLE SIMPLE_RADIAL RADIAL OPENCV",
    verified: Some("kapture 1.1.12 reads what is written, and pycolmap projects alike, to 1e-8 px"),
    many: true,
    recognise,
    read,
    write: Some(write),
    parts: Some(Parts { head, body }),
    convention: Some(&tool_conventions::KAPTURE),
    models: colmap_models::classic_models,
    keeps: Keeps { name: true, ..PLAIN.keeps },
    half_space: true,
    ..PLAIN
};

const KINDS: [&str; 9] = ["camera", "depth", "lidar", "gnss", "wifi", "bluetooth", "magnetic", "accelerometer", "gyroscope"];

fn recognise(source: &Source<'_>) -> Result<(), String> {
    let mut data = source.lines().filter(|(_, line)| !line.starts_with('#'));
    let kind = data.next().and_then(|(_, line)| line.split(',').nth(2)).map_or("", str::trim);
    if source.xml.is_none() && KINDS.contains(&kind) { Ok(()) } else { Err("no line `id, name, camera, ...`".into()) }
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let (mut cameras, mut others, mut ids) = (Vec::new(), Vec::new(), Ids::default());
    for (line, text) in source.lines().filter(|(_, line)| !line.starts_with('#')) {
        let words: Vec<&str> = text.split(',').map(str::trim).collect();
        match words[..] {
            [id, name, "camera", model, width, height, ref values @ ..] => {
                let at = |error: CameraFileError| error.on_line(line);
                ids.take(id, line)?;
                let size = ImageSize { width: pixels(width).map_err(at)?, height: pixels(height).map_err(at)? };
                let size = options.size_or(Some(size)).map_err(at)?;
                let values = values.iter().map(|word| finite(word)).collect::<Result<Vec<_>, _>>().map_err(at)?;
                let camera = colmap_models::camera(model, size, &values).map_err(|error| at(error).of(model))?;
                cameras.push(NamedCamera::new(if name.is_empty() { id } else { name }, camera));
            }
            [_, _, "camera", ..] | [] | [_] | [_, _] => {
                return Err(CameraFileError::new("expected id, name, camera, model, columns, rows, numbers").on_line(line));
            }
            [id, _, kind, ..] => others.push(format!("`{id}`, a sensor of kind {kind}, was left out")),
        }
    }
    Ok(noted(cameras, &others))
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let bytes = [head(cameras.len()), body(cameras, Numbering::of(cameras))?].concat();
    String::from_utf8(bytes).map_err(|_| CameraFileError::new("is no text"))
}

fn head(_: usize) -> Vec<u8> {
    b"# kapture format: 1.1\n# sensor_id, name, sensor_type, [sensor_params]+\n".to_vec()
}

fn body(cameras: &[NamedCamera], numbering: Numbering) -> Result<Vec<u8>, CameraFileError> {
    let mut out = String::new();
    for (index, named) in cameras.iter().enumerate() {
        let (model, values) = colmap_models::written_classic(&named.camera, &FORMAT)?;
        let ImageSize { width, height } = named.camera.size();
        let values: Vec<String> = values.into_iter().map(shortest).collect();
        let (id, name) = (numbering.first + index, named.name.replace([',', '\n', '\r'], "_"));
        out.push_str(&format!("cam{id}, {name}, camera, {model}, {width}, {height}, {}\n", values.join(", ")));
    }
    Ok(out.into_bytes())
}
