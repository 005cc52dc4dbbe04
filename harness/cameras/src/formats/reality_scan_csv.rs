//! RealityScan's CSV of internal and external camera parameters: a row an image.

use std::collections::HashMap;

use calibench_model::NamedCamera;
use calibench_model::camera::{ImageSize, tool_conventions};
use calibench_model::named_camera::Pose;
use csv::{ReaderBuilder, StringRecord, WriterBuilder};

use super::PLAIN;
use crate::format::{Keeps, KeptPose};
use crate::number::{finite, shortened, shortest};
use crate::pose::of_camera_to_world;
use crate::reality_scan::{self, DIVISION, Lengths};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, Lens, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "reality-scan-csv",
    tool: "RealityCapture, RealityScan",
    versions: "Internal/External camera parameters",
    extension: "csv",
    words: "cameras name alt yaw pitch roll f_35mm px_norm py_norm",
    many: true,
    states_size: false,
    recognise: |source| match header(source.text) {
        Some(_) => Ok(()),
        None => Err("no header `#name,x,y,alt,...,f`".into()),
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::REALITY_CAPTURE),
    models: |_| reality_scan::brown_models(),
    keeps: Keeps { name: true, pose: KeptPose::InWorld, ..PLAIN.keeps },
    lens_is_open: true,
    ..PLAIN
};

/// Columns by the names of the newer and the older header.
const COLUMNS: [[&str; 2]; 16] = [
    ["name", "name"],
    ["x", "x"],
    ["y", "y"],
    ["alt", "z"],
    ["yaw", "heading"],
    ["pitch", "pitch"],
    ["roll", "roll"],
    ["f_35mm", "f"],
    ["px_norm", "px"],
    ["py_norm", "py"],
    ["k1", "k1"],
    ["k2", "k2"],
    ["k3", "k3"],
    ["k4", "k4"],
    ["t1", "t1"],
    ["t2", "t2"],
];
/// Those that make a file one of this format, in [`COLUMNS`].
const NEEDED: [usize; 8] = [0, 1, 2, 3, 4, 5, 6, 7];

/// The line of the header, counted from 1, and its words; it may stand below the number of cameras.
fn header(text: &str) -> Option<(usize, Vec<String>)> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let (index, line) = lines.find(|(_, line)| !line.trim_start().starts_with("#cameras"))?;
    let word = |word: &str| word.trim().trim_start_matches('#').trim().to_ascii_lowercase();
    let words: Vec<String> = line.split(',').map(word).collect();
    let has = |column: &usize| COLUMNS[*column].iter().any(|name| words.iter().any(|word| word == name));
    NEEDED.iter().all(has).then_some((index + 1, words))
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let Some((first, words)) = header(source.text) else { return Ok(Vec::new()) };
    let size = options.size_or(None)?;
    let mut places: HashMap<usize, usize> = HashMap::new();
    let mut notes = Vec::new();
    for (place, word) in words.iter().enumerate() {
        match COLUMNS.iter().position(|names| names.contains(&word.as_str())) {
            Some(column) if places.insert(column, place).is_some() => {
                return Err(CameraFileError::new(format!("column `{}` stands twice; expected once", shortened(word))).on_line(first));
            }
            Some(_) => {}
            None => notes.push(format!("column `{}` is not known and was left out", shortened(word))),
        }
    }
    let body: String = source.text.split_inclusive('\n').skip(first).collect();
    let mut rows = ReaderBuilder::new().has_headers(false).flexible(true).from_reader(body.as_bytes());
    let mut cameras = Vec::new();
    for row in rows.records() {
        let row = row.map_err(|error| CameraFileError::new(format!("no CSV: {error}")))?;
        let line = first + row.position().map_or(0, |at| at.line() as usize);
        if row.iter().all(|word| word.trim().is_empty()) {
            continue;
        }
        if row.len() != words.len() {
            return Err(CameraFileError::new(format!("expected {} columns, found {}", words.len(), row.len())).on_line(line));
        }
        let mut named = camera(&row, &places, size, options.lens).map_err(|error| error.on_line(line))?;
        named.notes.extend(notes.iter().cloned());
        cameras.push(named);
    }
    Ok(cameras)
}

fn camera(row: &StringRecord, places: &HashMap<usize, usize>, size: ImageSize, lens: Option<Lens>) -> Result<NamedCamera, CameraFileError> {
    let word = |column: usize| places.get(&column).and_then(|place| row.get(*place)).map(str::trim);
    let number = |column: usize| match word(column) {
        Some(text) => finite(text).map_err(|error| error.of(COLUMNS[column][0])),
        None => Ok(0.0),
    };
    let [x, y, z, yaw, pitch, roll] = [number(1)?, number(2)?, number(3)?, number(4)?, number(5)?, number(6)?];
    let d = [number(10)?, number(11)?, number(12)?, number(13)?, number(14)?, number(15)?];
    let lengths = Lengths { f35: number(7)?, u: number(8)?, v: number(9)?, skew: 0.0, aspect: 1.0 };
    let k1_alone = d[0] != 0.0 && d[1..] == [0.0; 5];
    let lens = match lens {
        Some(lens) => lens,
        None if k1_alone => {
            let problem =
                "has k1 alone, which is the division model's as likely as Brown's; say which with --lens division or --lens brown";
            return Err(CameraFileError::new(problem).of("k1"));
        }
        None => Lens::Brown,
    };
    // A row without distortion is the same camera in any model.
    let lens = if d == [0.0; 6] { Lens::Brown } else { lens };
    let camera = reality_scan::camera(size, &lengths, &d, lens)?;
    let pose = of_camera_to_world(world_from_camera([yaw, pitch, roll]), [x, y, z])?.with_y_and_z_reversed();
    let notes = if lens == Lens::Division { vec![DIVISION.to_owned()] } else { Vec::new() };
    Ok(NamedCamera { pose: Some(pose), notes, ..NamedCamera::new(word(0).unwrap_or_default(), camera) })
}

/// Rz(-yaw) Rx(pitch) Ry(roll), degrees: from a camera with x right, y up, z backwards; at zero it looks straight down.
fn world_from_camera(degrees: [f64; 3]) -> [[f64; 3]; 3] {
    let [yaw, pitch, roll] = degrees.map(f64::to_radians);
    let ((s, c), (sp, cp), (sr, cr)) = ((-yaw).sin_cos(), pitch.sin_cos(), roll.sin_cos());
    [[c * cr - s * sp * sr, -s * cp, c * sr + s * sp * cr], [s * cr + c * sp * sr, c * cp, s * sr - c * sp * cr], [-cp * sr, sp, cp * cr]]
}

/// Yaw, pitch and roll of that matrix, degrees; roll is zero where the camera looks along the horizon's pole.
fn angles(m: [[f64; 3]; 3]) -> [f64; 3] {
    let cp = m[2][0].hypot(m[2][2]);
    let pitch = m[2][1].atan2(cp);
    let (turn, roll) = if cp > 1e-12 { ((-m[0][1]).atan2(m[1][1]), (-m[2][0]).atan2(m[2][2])) } else { (m[1][0].atan2(m[0][0]), 0.0) };
    [0.0 - turn, pitch, roll].map(f64::to_degrees)
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut out = format!("#cameras {}\n#{}\n", cameras.len(), COLUMNS.map(|[name, _]| name).join(","));
    let mut rows = WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    for named in cameras {
        let (Lengths { f35, u, v, skew, aspect }, d, lens) = reality_scan::parts(&named.camera, &FORMAT)?;
        if lens == Lens::Division || skew != 0.0 || aspect != 1.0 {
            return Err(FORMAT.other_model("cameras of Brown's model with one focal length"));
        }
        let pose = named.pose.unwrap_or(Pose::IDENTITY).with_y_and_z_reversed();
        let numbers = [&pose.position[..], &angles(pose.world_from_camera()), &[f35, u, v], &d].concat();
        let row = std::iter::once(named.name.clone()).chain(numbers.into_iter().map(shortest));
        rows.write_record(row).map_err(|error| CameraFileError::new(error.to_string()))?;
    }
    let rows = rows.into_inner().map_err(|error| CameraFileError::new(error.to_string()))?;
    out.push_str(&String::from_utf8_lossy(&rows));
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_come_back_and_mean_what_is_said() {
        for degrees in [[0.0; 3], [30.0, 80.0, -20.0], [-170.0, 91.0, 5.0], [10.0, -45.0, 170.0], [60.0, 90.0, 0.0]] {
            let m = world_from_camera(degrees);
            let again = world_from_camera(angles(m));
            assert!(m.as_flattened().iter().zip(again.as_flattened()).all(|(a, b)| (a - b).abs() < 1e-14), "{degrees:?}");
        }
        // The camera looks along its -z: down at zero; with a pitch of 90 degrees to the north, and then by its yaw to the east.
        let looks = |degrees| world_from_camera(degrees).map(|row: [f64; 3]| 0.0 - row[2]);
        let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15);
        assert!(near(looks([0.0; 3]), [0.0, 0.0, -1.0]));
        assert!(near(looks([0.0, 90.0, 0.0]), [0.0, 1.0, 0.0]));
        assert!(near(looks([90.0, 90.0, 0.0]), [1.0, 0.0, 0.0]));
    }
}
