//! An example: a camera in four lines, `size W H`, `focal FX FY`, `centre CX CY`, `distortion K1 K2 P1 P2`.

use calibench_model::NamedCamera;
use calibench_model::camera::{CameraModel, ImageSize};
use calibench_model::convert::Target;

use super::PLAIN;
use crate::brown::{Brown, positive};
use crate::format::{Keeps, Model};
use crate::number::{numbers, pixels, shortest};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "four-lines",
    tool: "an example",
    versions: "the one in CONTRIBUTING",
    extension: "cam4",
    recognise: |source| {
        let found = source.lines().next().is_some_and(|(_, line)| line.starts_with("size "));
        if found { Ok(()) } else { Err("no line `size W H`".into()) }
    },
    read,
    write: Some(write),
    models: |_| vec![Model { name: "k1, k2, p1, p2", target: Target::OpenCv { coefficients: 4 } }],
    keeps: Keeps { ..PLAIN.keeps },
    ..PLAIN
};

/// The line that begins with `key`: its number, and what follows.
fn line<'a>(source: &Source<'a>, key: &str) -> Result<(usize, &'a str), CameraFileError> {
    let found = source.lines().find_map(|(number, line)| line.strip_prefix(key)?.strip_prefix(' ').map(|rest| (number, rest)));
    found.ok_or_else(|| CameraFileError::new("expected a line of this name").of(key))
}

fn row<const N: usize>(source: &Source<'_>, key: &str) -> Result<[f64; N], CameraFileError> {
    let (number, text) = line(source, key)?;
    numbers(text).map_err(|error| error.on_line(number).of(key))
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let (number, sides) = line(source, "size")?;
    let mut sides = sides.split_whitespace().map(|side| pixels(side).map_err(|error| error.on_line(number).of("size")));
    let (Some(width), Some(height), None) = (sides.next(), sides.next(), sides.next()) else {
        return Err(CameraFileError::new("expected two numbers").on_line(number).of("size"));
    };
    let size = options.size_or(Some(ImageSize { width: width?, height: height? }))?;
    let ([fx, fy], [cx, cy], [k1, k2, p1, p2]) = (row(source, "focal")?, row(source, "centre")?, row(source, "distortion")?);
    let camera = Brown { k: [k1, k2, 0.0, 0.0], p1, p2, ..Brown::plain(size, [positive("focal", fx)?, positive("focal", fy)?, cx, cy]) };
    Ok(vec![NamedCamera::new("", camera.camera())])
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let wrong = || FORMAT.other_model("OpenCV's camera with k1, k2, p1, p2");
    let [named] = cameras else { return Err(CameraFileError::new("holds one camera")) };
    let brown = Brown::of(&named.camera).filter(|b| b.skew == 0.0 && b.radial() <= 2).ok_or_else(wrong)?;
    let ImageSize { width, height } = named.camera.size();
    let two = |a: f64, b: f64| format!("{} {}", shortest(a), shortest(b));
    let (focal, centre) = (two(brown.fx, brown.fy), two(brown.cx, brown.cy));
    let (radial, tangential) = (two(brown.k[0], brown.k[1]), two(brown.p1, brown.p2));
    Ok(format!("size {width} {height}\nfocal {focal}\ncentre {centre}\ndistortion {radial} {tangential}\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "size 640 480\nfocal 533.0 533.5\ncentre 342.25 233.875\ndistortion -0.28 0.055 0.001 -0.002\n";

    #[test]
    fn what_is_written_is_read_again() {
        let source = Source::new(TEXT.as_bytes()).unwrap();
        (FORMAT.recognise)(&source).unwrap();
        let cameras = read(&source, &ReadOptions::default()).unwrap();
        assert_eq!(write(&cameras).unwrap(), TEXT);
    }

    #[test]
    fn mistakes_have_a_place() {
        let bad = TEXT.replace("533.5", "x");
        let error = read(&Source::new(bad.as_bytes()).unwrap(), &ReadOptions::default()).unwrap_err();
        assert_eq!((error.line, error.element.as_deref()), (Some(2), Some("focal")));
    }
}
