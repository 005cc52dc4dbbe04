//! A plug-in that is started for each image, in a folder that holds what it is asked.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;

use calibench_exchange::points::{Check, parse_points_checked};
use calibench_exchange::{PointFile, write_points};
use calibench_files::at;
use calibench_images::{encode_float_tiff, encode_png};
use calibench_measure::Settings;
use calibench_model::{Image, Measurement, PointRef, Rejection, Start};
use rustix::fs::OFlags;
use tempfile::TempDir;

use crate::answer::{Answer, Fault};
use crate::declaration::Grey;
use crate::program::Program;
use crate::request::Wanted;

/// Where its image is.
const IMAGES: &str = "images";
/// Where measuring starts.
const POINTS: &str = "points.csv";
/// What it writes.
const MEASURED: &str = "measured.csv";

/// Starts the program for one image and reads what it wrote about what is `wanted`: of any number of points up to `most` where it has no starts.
pub fn ask(
    program: &Program,
    settings: &Settings,
    image: &Image,
    wanted: Wanted<'_>,
    (most, bytes): (usize, u64),
) -> Result<Answer, Fault> {
    let folder = TempDir::new().map_err(|error| ended(&error))?;
    let name = put(folder.path(), image, program.declaration.grey, wanted.starts()).map_err(|error| ended(&error))?;
    program.run_in(folder.path(), settings, wanted.board())?;
    let text = taken(&folder.path().join(MEASURED), bytes)?;
    read(&text, name, wanted.count(), most)
}

fn ended(error: &io::Error) -> Fault {
    Fault::new(Rejection::Ended, format!("no folder for it: {error}"))
}

/// Puts the image and the points into the folder; the image's name.
fn put(folder: &Path, image: &Image, grey: Grey, starts: Option<&[Start]>) -> io::Result<&'static str> {
    let images = folder.join(IMAGES);
    fs::create_dir(&images).map_err(|error| at(&images, &error))?;
    let name = if grey == Grey::Gray32f { "0001.tif" } else { "0001.png" };
    let mut file = Vec::new();
    match grey {
        Grey::Gray8 => encode_png(&mut file, image, false)?,
        Grey::Gray16le => encode_png(&mut file, image, true)?,
        Grey::Gray32f => file = encode_float_tiff(image)?,
    }
    fs::write(images.join(name), file).map_err(|error| at(&images.join(name), &error))?;
    if let Some(starts) = starts {
        let targets: Vec<String> = (1..=starts.len()).map(|number| number.to_string()).collect();
        let rows = targets.iter().zip(starts).map(|(target, start)| PointRef { image: name, target, start: *start });
        let path = folder.join(POINTS);
        File::create(&path).and_then(|file| write_points(file, rows)).map_err(|error| at(&path, &error))?;
    }
    Ok(name)
}

/// What it wrote: a file of its own and no way to another, which it may not read itself.
fn taken(path: &Path, most: u64) -> Result<Vec<u8>, Fault> {
    let malformed = |message: String| Fault::new(Rejection::Malformed, message);
    let flags = (OFlags::NOFOLLOW | OFlags::NONBLOCK).bits() as i32;
    let file = OpenOptions::new().read(true).custom_flags(flags).open(path).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => malformed(format!("it wrote no {MEASURED}")),
        _ => malformed(format!("{MEASURED}: {error}; expected a file")),
    })?;
    if !file.metadata().is_ok_and(|found| found.is_file()) {
        return Err(malformed(format!("{MEASURED} is no file")));
    }
    let mut text = Vec::new();
    file.take(most + 1).read_to_end(&mut text).map_err(|error| malformed(format!("{MEASURED}: {error}")))?;
    if text.len() as u64 > most { Err(malformed(format!("{MEASURED} is longer than {most} bytes"))) } else { Ok(text) }
}

/// The answer in a file about `asked` points, which are called by their numbers, or about any up to `most`.
pub fn read(text: &[u8], name: &str, asked: Option<usize>, most: usize) -> Result<Answer, Fault> {
    let malformed = |message: String| Fault::new(Rejection::Malformed, message);
    let place = |target: &str| target.parse::<usize>().ok().filter(|number| *number >= 1 && asked.is_some_and(|asked| *number <= asked));
    let check: Check<'_> = &|row| match asked {
        _ if row.image != name => Err(("image", format!("expected `{name}`, found `{}`", row.image))),
        Some(asked) if place(row.target).is_none() => {
            Err(("target", format!("expected one of 1 to {asked} as in {POINTS}, found `{}`", row.target)))
        }
        _ => Ok(()),
    };
    let PointFile { points, lost } = parse_points_checked(MEASURED, text, check).map_err(|error| malformed(error.to_string()))?;
    let measured = |row: PointRef<'_>| Measurement { position: row.start.position, covariance: row.start.covariance };
    let mut answer = Answer::default();
    let Some(asked) = asked else {
        if points.len() > most {
            return Err(malformed(format!("{MEASURED} has {} rows; expected {most} at most", points.len())));
        }
        answer.names = points.rows().map(|row| row.target.to_owned()).collect();
        answer.points = points.rows().map(measured).map(Ok).collect();
        return Ok(answer);
    };
    // What it leaves out it cannot measure.
    answer.points = vec![Err(Rejection::Declined); asked];
    for row in points.rows() {
        let number = place(row.target).unwrap_or(1);
        answer.points[number - 1] = Ok(measured(row));
    }
    for [image, target, _, reason] in lost.iter() {
        match place(target).filter(|_| image == name) {
            Some(number) if answer.points[number - 1].is_err() => answer.told.extend((!reason.is_empty()).then(|| reason.to_owned())),
            _ => {
                return Err(malformed(format!(
                    "{MEASURED}: target `{target}` of image `{image}` was not asked for, or has a position beside"
                )));
            }
        }
    }
    Ok(answer)
}
