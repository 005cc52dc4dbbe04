//! COLMAP's cameras.txt.

use calibench_model::NamedCamera;
use calibench_model::camera::{CameraModel, ImageSize, tool_conventions};

use super::PLAIN;
use crate::format::{Keeps, Parts};
use crate::ids::Ids;
use crate::number::{finite, pixels, shortest};
use crate::numbering::Numbering;
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions, colmap_models};

pub(crate) static FORMAT: CameraFormat = CameraFormat {
    name: "colmap",
    tool: "COLMAP",
    versions: "cameras.txt of 3.x and 4.x",
    extension: "txt",
    words: "PINHOLE SIMPLE_PINHOLE SIMPLE_RADIAL RADIAL OPENCV OPENCV_FISHEYE FULL_OPENCV",
    verified: Some("pycolmap 4.2.1 reads what is written and projects alike in every model, to 1e-8 px"),
    many: true,
    recognise,
    read,
    write: Some(write),
    parts: Some(Parts { head, body }),
    convention: Some(&tool_conventions::COLMAP),
    models: colmap_models::models,
    keeps: Keeps { name: true, ..PLAIN.keeps },
    half_space: true,
    ..PLAIN
};

/// Lines that hold something, without comments.
fn lines<'a>(source: &Source<'a>) -> impl Iterator<Item = (usize, &'a str)> + use<'a> {
    let text = source.text;
    let numbered = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    numbered.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
}

pub(crate) fn recognise(source: &Source<'_>) -> Result<(), String> {
    let first: Vec<&str> = lines(source).next().map_or(Vec::new(), |(_, line)| line.split_whitespace().collect());
    let is_name = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_uppercase() || b == b'_');
    let is_number = |text: &&str| text.bytes().all(|b| b.is_ascii_digit());
    match first[..] {
        [id, model, width, height, _, ..] if is_name(model) && [id, width, height].iter().all(is_number) => Ok(()),
        _ => Err("no line `ID MODEL W H ...`".into()),
    }
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let mut ids = Ids::default();
    let one = |(line, text)| {
        let named = camera(text, options).map_err(|error| error.on_line(line))?;
        ids.take(&named.name, line)?;
        Ok(named)
    };
    lines(source).map(one).collect()
}

/// The camera of a line.
pub(crate) fn camera(text: &str, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let mut words = text.split_whitespace();
    let (Some(id), Some(model), Some(width), Some(height)) = (words.next(), words.next(), words.next(), words.next()) else {
        return Err(CameraFileError::new("expected CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]"));
    };
    let side = |text, name| pixels(text).map_err(|error| error.of(name));
    let size = options.size_or(Some(ImageSize { width: side(width, "WIDTH")?, height: side(height, "HEIGHT")? }))?;
    let values = words.map(finite).collect::<Result<Vec<_>, _>>().map_err(|error| error.of("PARAMS[]"))?;
    let camera = colmap_models::camera(model, size, &values).map_err(|error| error.of(model))?;
    Ok(NamedCamera::new(id, camera))
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let bytes = [head(cameras.len()), body(cameras, Numbering::of(cameras))?].concat();
    String::from_utf8(bytes).map_err(|_| CameraFileError::new("is no text"))
}

fn head(count: usize) -> Vec<u8> {
    let columns = "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]";
    format!("# Camera list with one line of data per camera:\n{columns}\n# Number of cameras: {count}\n").into_bytes()
}

fn body(cameras: &[NamedCamera], numbering: Numbering) -> Result<Vec<u8>, CameraFileError> {
    let mut out = String::new();
    for (index, named) in cameras.iter().enumerate() {
        let (model, values) = colmap_models::written(&named.camera, &FORMAT)?;
        let ImageSize { width, height } = named.camera.size();
        let values: Vec<String> = values.into_iter().map(shortest).collect();
        out.push_str(&format!("{} {model} {width} {height} {}\n", numbering.id(index, named)?, values.join(" ")));
    }
    Ok(out.into_bytes())
}
