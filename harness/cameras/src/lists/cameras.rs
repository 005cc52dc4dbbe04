//! cameras.txt and cameras.bin, a camera at a time.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use calibench_model::NamedCamera;

use super::lines::Lines;
use super::numbers::Numbers;
use super::{Records, Stop, opened, whole_lines};
use crate::formats::{FORMATS, colmap, colmap_bin};
use crate::ids;
use crate::little_endian::Bytes;
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions};

/// Bytes of lines that are no cameras, at most.
const OTHERS: usize = 1 << 20;

/// A line of cameras.txt.
#[expect(clippy::large_enum_variant, reason = "one at a time")]
enum Line<'a> {
    /// A camera and its id.
    Camera(u32, NamedCamera),
    /// Nothing.
    Empty,
    /// What is no camera: a comment, or a mistake.
    Other(&'a str, Option<CameraFileError>),
}

/// What a line says.
fn line<'a>(text: &'a str, number: usize, options: &ReadOptions) -> Result<Line<'a>, Stop> {
    let line = text.trim();
    if line.is_empty() {
        return Ok(Line::Empty);
    }
    if line.starts_with('#') {
        return Ok(Line::Other(text, None));
    }
    let camera = match colmap::camera(line, options) {
        Ok(camera) => camera,
        Err(error) => return Ok(Line::Other(text, Some(error.on_line(number)))),
    };
    // As COLMAP counts; other names could be words of another format.
    let id = camera.name.parse::<u32>().ok().filter(|_| camera.name.bytes().all(|b| b.is_ascii_digit()));
    let id = id.filter(|_| camera.name == "0" || !camera.name.starts_with('0'));
    let id = id.ok_or_else(|| Stop::Whole(format!("the id on line {number} is no whole number of COLMAP's")))?;
    Ok(Line::Camera(id, camera))
}

/// Looks at all of a list of cameras that begins with `head`: each camera's id and the byte at which it begins go to `seen`. Returns whether it is text, and how many
/// cameras there are.
pub(super) fn looked_at(path: &Path, head: &[u8], options: &ReadOptions, seen: impl FnMut(u32, u64)) -> Result<(bool, usize), Stop> {
    let may_be = |format: &CameraFormat| options.from.is_none_or(|from| from == format);
    // Four of the eight bytes of a count are zero, which no text has.
    if may_be(&colmap_bin::FORMAT) && colmap_bin::recognise(head).is_ok() {
        colmap_bin::has_least_byte_first(head)?;
        return Ok((false, in_bytes(path, options, seen)?));
    }
    let source = whole_lines(head).and_then(|text| Source::new(text.as_bytes()).ok());
    match source.filter(|source| may_be(&colmap::FORMAT) && colmap::recognise(source).is_ok()) {
        Some(source) => Ok((true, in_text(path, options, source.text, seen)?)),
        None => Err(Stop::Whole("it is none of these".into())),
    }
}

/// The same of cameras.txt, of which `head` are the first lines.
///
/// Whose file it is, is asked of every format by the first lines and by all later ones that are no cameras: what is left out are a number of a camera,
/// the name of one of COLMAP's models and numbers, by which no other format knows its files.
fn in_text(path: &Path, options: &ReadOptions, head: &str, mut seen: impl FnMut(u32, u64)) -> Result<usize, Stop> {
    let mut lines = Lines::new(opened(path)?.0);
    let (mut others, mut numbers, mut count, mut wrong) = (head.to_owned(), Numbers::default(), 0, None);
    loop {
        let (number, begins) = (lines.number() + 1, lines.at());
        let Some(text) = lines.next()? else { break };
        match line(text, number, options)? {
            Line::Empty => {}
            Line::Camera(id, _) => {
                count += 1;
                numbers.push(id, number);
                seen(id, begins);
            }
            Line::Other(text, error) => {
                if begins >= head.len() as u64 {
                    others.push_str(text);
                }
                if wrong.is_none() {
                    wrong = error;
                }
            }
        }
        if others.len() > OTHERS + head.len() {
            return wrong.map_or(Err(Stop::Whole(format!("more than {OTHERS} bytes of comments"))), |error| Err(error.into()));
        }
    }
    is_colmap_s(&others, options)?;
    let twice = numbers.twice().map(|(id, first, line)| ids::twice(&id.to_string(), first, line));
    let first = [wrong, twice].into_iter().flatten().min_by_key(|error| error.line);
    first.map_or(Ok(count), |error| Err(error.into()))
}

/// Whether COLMAP's is the only format that claims a text, or the one that was asked for.
fn is_colmap_s(text: &str, options: &ReadOptions) -> Result<(), Stop> {
    let source = Source::new(text.as_bytes())?;
    let claims = |format: &&&CameraFormat| format.binary.is_none() && (format.recognise)(&source).is_ok();
    let others: Vec<&str> = FORMATS.iter().filter(claims).map(|format| format.name).filter(|name| *name != colmap::FORMAT.name).collect();
    if others.is_empty() || options.from.is_some() {
        return Ok(());
    }
    Err(Stop::Whole(format!("it may also be a file of {}; --from colmap says that it is not", others.join(" or "))))
}

/// The same of cameras.bin.
fn in_bytes(path: &Path, options: &ReadOptions, mut seen: impl FnMut(u32, u64)) -> Result<usize, Stop> {
    let mut file = Binary::open(path, options)?;
    let mut numbers = Numbers::default();
    let all = loop {
        let begins = file.records.at();
        match file.records.next(options) {
            Ok(None) => break Ok(()),
            Err(error) => break Err(error),
            Ok(Some(camera)) => {
                let id = camera.name.parse().unwrap_or_default();
                numbers.push(id, file.records.index as usize);
                seen(id, begins);
            }
        }
    };
    // One that stands twice stands before what is wrong.
    if let Some((id, _, index)) = numbers.twice() {
        return Err(colmap_bin::twice(index as u64, file.records.count, &id.to_string()).into());
    }
    all?;
    Ok(file.records.count as usize)
}

/// The cameras of cameras.txt.
pub(super) struct Text<'o> {
    lines: Lines<BufReader<File>>,
    options: &'o ReadOptions,
}

impl<'o> Text<'o> {
    pub fn open(path: &Path, options: &'o ReadOptions) -> Result<Self, Stop> {
        Ok(Self { lines: Lines::new(opened(path)?.0), options })
    }
}

impl Records for Text<'_> {
    fn next(&mut self) -> Result<Option<NamedCamera>, Stop> {
        loop {
            let number = self.lines.number() + 1;
            let Some(text) = self.lines.next()? else { return Ok(None) };
            match line(text, number, self.options)? {
                Line::Camera(_, camera) => return Ok(Some(camera)),
                Line::Other(_, Some(error)) => return Err(error.into()),
                Line::Empty | Line::Other(_, None) => {}
            }
        }
    }
}

/// The cameras of cameras.bin.
pub(super) struct Binary<'o> {
    records: colmap_bin::Records<BufReader<File>>,
    options: &'o ReadOptions,
}

impl<'o> Binary<'o> {
    pub fn open(path: &Path, options: &'o ReadOptions) -> Result<Self, Stop> {
        let (source, length) = opened(path)?;
        Ok(Self { records: colmap_bin::Records::new(Bytes::of(source, length))?, options })
    }
}

impl Records for Binary<'_> {
    fn next(&mut self) -> Result<Option<NamedCamera>, Stop> {
        Ok(self.records.next(self.options)?)
    }
}
