//! What DJI's cameras write into their pictures to take the distortion out: `drone-dji:DewarpData`, in XMP or as ExifTool prints it.

use calibench_model::NamedCamera;
use calibench_model::camera::{ImageSize, tool_conventions};

use super::PLAIN;
use crate::brown::{Brown, positive};
use crate::number::{finite, pixels, shortened};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "dji",
    tool: "DJI",
    versions: "DewarpData of XMP, as `exiftool -xmp -b` or `exiftool` gives it",
    extension: "xmp",
    words: "DewarpData DewarpFlag CalibratedFocalLength CalibratedOpticalCenterX CalibratedOpticalCenterY GimbalYawDegree drone_dji",
    states_size: false,
    recognise: |source| match value(source.text, &DATA) {
        Some(_) => Ok(()),
        None => Err("no `DewarpData`".into()),
    },
    read,
    convention: Some(&tool_conventions::DJI),
    origin_is_open: true,
    ..PLAIN
};

/// In XMP and as ExifTool calls it.
const DATA: [&str; 2] = ["DewarpData", "Dewarp Data"];
const FLAG: [&str; 2] = ["DewarpFlag", "Dewarp Flag"];
const CENTRE: [[&str; 2]; 2] =
    [["CalibratedOpticalCenterX", "Calibrated Optical Center X"], ["CalibratedOpticalCenterY", "Calibrated Optical Center Y"]];
const SIDES: [[&str; 2]; 2] = [["ImageWidth", "Image Width"], ["ImageHeight", "Image Height"]];
const NUMBERS: usize = 9;

/// The line and the text that follow the first of `names`, whatever stands between them: `name="text"`, `<name>text<`, `name : text`.
fn value<'a>(text: &'a str, names: &[&str]) -> Option<(usize, &'a str)> {
    let (at, name) = names.iter().filter_map(|name| Some((find(text, name)?, name))).min()?;
    let rest = text[at + name.len()..].trim_start_matches([' ', '\t', '=', ':', '>', '"', '\'']);
    let end = rest.find(['"', '\'', '<', '\n', '\r']).unwrap_or(rest.len());
    Some((1 + text[..at].matches('\n').count(), rest[..end].trim().trim_end_matches(',')))
}

/// Where a name stands that is not the end or the beginning of a longer one.
fn find(text: &str, name: &str) -> Option<usize> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(name).map(|(at, _)| at).find(|&at| !text[..at].ends_with(is_part) && !text[at + name.len()..].starts_with(is_part))
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let stated = |names: &[&str]| value(source.text, names);
    let side =
        |names: &[&str]| stated(names).map(|(line, text)| pixels(text).map_err(|error| error.on_line(line).of(names[0]))).transpose();
    let sides = side(&SIDES[0])?.zip(side(&SIDES[1])?);
    let size = options.size_or(sides.map(|(width, height)| ImageSize { width, height }))?;
    let (line, data) = stated(&DATA).ok_or_else(|| CameraFileError::new("has none").of(DATA[0]))?;
    let at = |error: CameraFileError| error.on_line(line).of(DATA[0]);
    let (date, numbers) = data.split_once(';').unwrap_or(("", data));
    let found: Vec<f64> = numbers.split(',').map(finite).collect::<Result<_, _>>().map_err(at)?;
    let [fx, fy, dx, dy, k1, k2, p1, p2, k3] = found[..] else {
        let problem =
            format!("expected a date, `;` and {NUMBERS} numbers (fx, fy, cx, cy, k1, k2, p1, p2, k3), found `{}`", shortened(data));
        return Err(at(CameraFileError::new(problem)));
    };
    let centre = |names: &[&str], side: u32| match stated(names) {
        Some((line, text)) => finite(text).map_err(|error| error.on_line(line).of(names[0])),
        None => Ok(0.5 * f64::from(side)),
    };
    let [cx, cy] = [centre(&CENTRE[0], size.width)? + dx, centre(&CENTRE[1], size.height)? + dy];
    let plain = Brown::plain(size, [positive(DATA[0], fx).map_err(at)?, positive(DATA[0], fy).map_err(at)?, cx, cy]);
    let mut notes = Vec::new();
    if !date.is_empty() {
        notes.push(format!("calibrated {}", shortened(date)));
    }
    if stated(&FLAG).is_some_and(|(_, flag)| flag == "1") {
        notes.push("`DewarpFlag` is 1: the distortion has been taken out of this picture; the camera is that of the picture before".into());
    }
    let camera = Brown { k: [k1, k2, k3, 0.0], p1, p2, ..plain }.camera();
    Ok(vec![NamedCamera { notes, ..NamedCamera::new("", camera) }])
}
