//! VisualSFM's NVM: focal length, one radial coefficient and a pose for each image.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, ImageSize, Photogrammetric, tool_conventions};
use calibench_model::named_camera::Pose;

use super::PLAIN;
use crate::brown::{Brown, middle, positive};
use crate::format::{Keeps, KeptPose};
use crate::number::{finite, numbers, shortened};
use crate::pose::of_quaternion;
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions, noted};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "nvm",
    tool: "VisualSFM",
    versions: "NVM_V3",
    extension: "nvm",
    words: "NVM_V3 FixedK",
    many: true,
    states_size: false,
    recognise: |source| {
        let first = source.lines().next().map_or("", |(_, line)| line);
        if first.split_whitespace().next() == Some(HEADER) { Ok(()) } else { Err(format!("no `{HEADER}`")) }
    },
    read,
    convention: Some(&tool_conventions::NVM),
    keeps: Keeps { name: true, pose: KeptPose::InWorld, ..PLAIN.keeps },
    ..PLAIN
};

const HEADER: &str = "NVM_V3";
/// Numbers of a camera after its name: f, quaternion w x y z, centre, radial coefficient, zero.
const NUMBERS: usize = 10;
/// A pixel pitch, um, by which a millimetre is a pixel.
const ONE: f64 = 1000.0;

/// fx, fy and the principal point, px.
type Focal = [f64; 4];

/// The camera of a coefficient that corrects measured coordinates in units of the focal length.
fn camera(size: ImageSize, [fx, fy, cx, cy]: Focal, radial: f64) -> Result<Camera, CameraFileError> {
    if radial == 0.0 {
        return Ok(Brown::plain(size, [fx, fy, cx, cy]).camera());
    }
    if fx != fy {
        return Err(CameraFileError::new(format!(
            "has the radial coefficient {radial} beside two focal lengths, {fx} and {fy}: in units of which is not known"
        )));
    }
    let centre = middle(size);
    let k = [-radial / (fx * fx), 0.0, 0.0];
    Ok(Photogrammetric { size, pitch_um: ONE, c: fx, x0: cx - centre.x, y0: centre.y - cy, k, p: [0.0; 2], b: [0.0; 2] }.into())
}

/// fx, cx, fy, cy and r of `FixedK`, which hold for every image.
fn fixed(line: &str, number: usize) -> Result<Option<(Focal, f64)>, CameraFileError> {
    let rest = line.trim_start_matches(HEADER).trim();
    let Some(values) = rest.strip_prefix("FixedK") else { return Ok(None) };
    let at = |error: CameraFileError| error.on_line(number).of("FixedK");
    let [fx, cx, fy, cy, radial]: [f64; 5] = numbers(values).map_err(at)?;
    positive("FixedK", fx.min(fy)).map_err(|error| error.on_line(number))?;
    Ok(Some(([fx, fy, cx, cy], radial)))
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let size = options.size_or(None)?;
    let mut lines = source.lines();
    let (number, header) = lines.next().ok_or_else(|| CameraFileError::new("is empty"))?;
    let fixed = fixed(header, number)?;
    let mut next = |what: &str| {
        lines.next().ok_or_else(|| CameraFileError::new(format!("ends before {what}; it was cut off or its counts are wrong")))
    };
    let count = |(line, text): (usize, &str), what: &str| {
        text.parse::<usize>().map_err(|_| CameraFileError::new(format!("expected {what}, found `{}`", shortened(text))).on_line(line))
    };
    let many = count(next("the number of cameras")?, "the number of cameras")?;
    let mut cameras = Vec::new();
    for index in 0..many {
        let (line, text) = next(&format!("camera {} of {many}", index + 1))?;
        cameras.push(one(text, size, fixed).map_err(|error| error.on_line(line))?);
    }
    // Images that were not joined to this model follow as others, each after its points.
    let points = next("the number of points").and_then(|found| count(found, "the number of points")).unwrap_or(0);
    let others = lines.nth(points).and_then(|(_, text)| text.parse::<usize>().ok()).filter(|others| *others > 0);
    let note = others.map(|_| "holds more models than the first, which were left out".to_owned());
    Ok(noted(cameras, note.as_slice()))
}

fn one(text: &str, size: ImageSize, fixed: Option<(Focal, f64)>) -> Result<NamedCamera, CameraFileError> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let Some(split) = words.len().checked_sub(NUMBERS).filter(|split| *split > 0) else {
        return Err(CameraFileError::new(format!("expected the name of an image and {NUMBERS} numbers, found {} words", words.len())));
    };
    // VisualSFM writes a quotation mark for a blank.
    let name = words[..split].join(" ").replace('"', " ");
    let value = |index: usize| finite(words[split + index]).map_err(|error| error.of(name.as_str()));
    let (f, [w, x, y, z]) = (value(0)?, [value(1)?, value(2)?, value(3)?, value(4)?]);
    let position = [value(5)?, value(6)?, value(7)?];
    let centre = middle(size);
    let (focal, radial) = fixed.unwrap_or(([f, f, centre.x, centre.y], value(8)?));
    positive("f", f).map_err(|error| error.of(name.as_str()))?;
    let camera_from_world = of_quaternion([x, y, z, w]).map_err(|error| error.of(name.as_str()))?;
    let pose = Some(Pose { camera_from_world, position });
    Ok(NamedCamera { pose, ..NamedCamera::new(name.clone(), camera(size, focal, radial).map_err(|error| error.of(name.as_str()))?) })
}
