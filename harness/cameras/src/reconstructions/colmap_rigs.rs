//! COLMAP's rigs, from 3.12 on: which cameras are mounted rigidly to each other.

use std::path::Path;

use super::{LARGEST, place, text_of};
use crate::little_endian::Bytes;
use crate::number::shortened;
use crate::{CameraFileError, source};

/// What COLMAP calls a camera among the sensors, in text and in bytes.
const CAMERA: (&str, u32) = ("CAMERA", 0);
/// Numbers of a pose: a quaternion and a shift.
const POSE: usize = 7;

/// The rigs of rigs.bin or rigs.txt that have several cameras, by the numbers of these; none where there is no such file. Other sensors count for nothing.
///
/// # Errors
/// A file that is no list of rigs, with its name.
pub(super) fn read(folder: &Path) -> Result<Vec<Vec<u32>>, CameraFileError> {
    let Some((path, is_binary)) = place(folder, "rigs") else { return Ok(Vec::new()) };
    let in_file = |error: CameraFileError| error.in_file(&path.display().to_string());
    let bytes = source::read_up_to(&path, LARGEST).map_err(in_file)?;
    let rigs = if is_binary { in_bytes(&bytes) } else { text_of(&bytes).and_then(in_text) }.map_err(in_file)?;
    Ok(rigs.into_iter().filter(|cameras| cameras.len() > 1).collect())
}

fn in_bytes(bytes: &[u8]) -> Result<Vec<Vec<u32>>, CameraFileError> {
    let mut rest = Bytes::new(bytes);
    let count = rest.u64()?;
    let mut rigs = Vec::new();
    for index in 1..=count {
        let mut one = || {
            rest.pass(4)?;
            let (sensors, mut cameras) = (rest.u32()?, Vec::new());
            for sensor in 0..sensors {
                let (kind, id) = (rest.u32()?, rest.u32()?);
                // The first is the one whose frame is the rig's.
                if sensor > 0 && rest.u8()? != 0 {
                    rest.pass(8 * POSE as u64)?;
                }
                cameras.extend((kind == CAMERA.1).then_some(id));
            }
            Ok(cameras)
        };
        rigs.push(one().map_err(|error: CameraFileError| error.of(format!("rig {index} of {count}")))?);
    }
    Ok(rigs)
}

fn in_text(text: &str) -> Result<Vec<Vec<u32>>, CameraFileError> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'));
    lines.map(|(index, line)| of_line(line).map_err(|error| error.on_line(index + 1))).collect()
}

fn of_line(line: &str) -> Result<Vec<u32>, CameraFileError> {
    let mut words = line.split_whitespace();
    let mut next =
        |what: &str| words.next().ok_or_else(|| CameraFileError::new("expected another word, found the end of the line").of(what));
    let whole = |what: &str, word: &str| {
        let wrong = |_| CameraFileError::new(format!("expected a whole number, found `{}`", shortened(word))).of(what);
        word.parse::<u32>().map_err(wrong)
    };
    whole("RIG_ID", next("RIG_ID")?)?;
    let (sensors, mut cameras) = (whole("NUM_SENSORS", next("NUM_SENSORS")?)?, Vec::new());
    for sensor in 0..sensors {
        let is_camera = next("SENSOR_TYPE")? == CAMERA.0;
        let id = whole("SENSOR_ID", next("SENSOR_ID")?)?;
        if sensor > 0 && whole("HAS_POSE", next("HAS_POSE")?)? != 0 {
            for _ in 0..POSE {
                next("QW, QX, QY, QZ, TX, TY, TZ")?;
            }
        }
        cameras.extend(is_camera.then_some(id));
    }
    match words.next() {
        None => Ok(cameras),
        Some(word) => Err(CameraFileError::new(format!("expected the end of the line, found `{}`", shortened(word)))),
    }
}
