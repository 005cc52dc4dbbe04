//! What a photograph says of its camera and lens.

use std::io::{BufReader, Cursor};
use std::path::Path;

use image::{ImageDecoder, ImageFormat};

use super::exif::{Directories, Entry};
use crate::photo::{PhotoError, budget, open, reader};

const MAKER: u16 = 0x10f;
const MODEL: u16 = 0x110;
const F_NUMBER: u16 = 0x829d;
const TAKEN: u16 = 0x9003;
const FOCAL: u16 = 0x920a;
const BODY_SERIAL: u16 = 0xa431;
const LENS_MODEL: u16 = 0xa434;
const LENS_SERIAL: u16 = 0xa435;
/// The longest text that is taken, letters.
const LONGEST: usize = 100;

/// What a photograph says of itself in EXIF; nothing of it is checked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Said {
    /// Who made the camera, and its name.
    pub camera: Option<String>,
    /// The camera's serial number.
    pub serial: Option<String>,
    /// The lens.
    pub lens: Option<String>,
    /// The lens's serial number.
    pub lens_serial: Option<String>,
    /// Focal length, mm.
    pub focal_mm: Option<f64>,
    /// Focal length over aperture.
    pub f_number: Option<f64>,
    /// When it was taken by the camera's clock, `2026-05-01 12:00:00`.
    pub taken: Option<String>,
}

/// What a photograph says of itself; pixels are not read. Nothing, where it has no EXIF or that cannot be understood.
///
/// # Errors
/// A file that is missing or no image.
pub fn said(path: &Path) -> Result<Said, PhotoError> {
    let in_file = |source| PhotoError::File { path: path.to_owned(), source };
    let content = |source| PhotoError::Content { path: path.to_owned(), source };
    let mut input = BufReader::new(open(path)?);
    let mut reader = reader(&mut input).map_err(in_file)?;
    if reader.format() == Some(ImageFormat::Tiff) {
        return Ok(Directories::read(&mut BufReader::new(open(path)?)).map_or_else(|_| Said::default(), |found| Said::of(&found)));
    }
    reader.limits(budget::limits(budget::MOST_BYTES));
    let mut decoder = reader.into_decoder().map_err(content)?;
    let block = decoder.exif_metadata().ok().flatten();
    let found = block.and_then(|block| Directories::read(&mut Cursor::new(block)).ok());
    Ok(found.map_or_else(Said::default, |found| Said::of(&found)))
}

impl Said {
    fn of(found: &Directories) -> Self {
        let entry = |entries: &[Entry], tag: u16| entries.iter().find(|entry| entry.tag == tag).cloned();
        let text = |entries: &[Entry], tag: u16| entry(entries, tag).and_then(|entry| entry.text());
        let ratio = |tag: u16| entry(&found.exif, tag).and_then(|entry| entry.ratio());
        let [maker, model] = [MAKER, MODEL].map(|tag| text(&found.main, tag));
        // Some makers stand in the name of the model once more.
        let camera = match (maker, model) {
            (Some(maker), Some(model)) if !model.to_lowercase().starts_with(&first_word(&maker)) => Some(format!("{maker} {model}")),
            (maker, model) => model.or(maker),
        };
        Self {
            camera,
            serial: text(&found.exif, BODY_SERIAL),
            lens: text(&found.exif, LENS_MODEL),
            lens_serial: text(&found.exif, LENS_SERIAL),
            focal_mm: ratio(FOCAL),
            f_number: ratio(F_NUMBER),
            taken: text(&found.exif, TAKEN).and_then(|text| date(&text)),
        }
    }
}

fn first_word(text: &str) -> String {
    text.split_whitespace().next().unwrap_or_default().to_lowercase()
}

/// `2026:05:01 12:00:00` with the hyphens of a date; `None` of a clock that was never set.
fn date(text: &str) -> Option<String> {
    let (day, time) = text.split_once(' ')?;
    let is_number = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    let [year, month, day] = <[&str; 3]>::try_from(day.split(':').collect::<Vec<_>>()).ok()?;
    ([year, month, day].into_iter().all(is_number) && year != "0000").then(|| format!("{year}-{month}-{day} {time}"))
}

impl Entry {
    /// A text without what fills it up.
    fn text(&self) -> Option<String> {
        let text = (self.kind == 2).then(|| String::from_utf8_lossy(&self.value).into_owned())?;
        let text: String = text.split('\0').next()?.trim().chars().take(LONGEST).collect();
        (!text.is_empty()).then_some(text)
    }

    /// The first of some ratios, positive.
    fn ratio(&self) -> Option<f64> {
        let [a, b] = [0, 4].map(|at| self.value.get(at..)?.first_chunk().map(|bytes| f64::from(u32::from_le_bytes(*bytes))));
        let ratio = a? / b?;
        (self.kind == 5 && ratio.is_finite() && ratio > 0.0).then_some(ratio)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(tag: u16, text: &str) -> Entry {
        Entry { tag, kind: 2, value: text.bytes().chain([0]).collect() }
    }

    fn ratio(tag: u16, [a, b]: [u32; 2]) -> Entry {
        Entry { tag, kind: 5, value: [a.to_le_bytes(), b.to_le_bytes()].concat() }
    }

    #[test]
    fn camera_and_lens_are_those_of_the_entries() {
        let main = vec![text(MAKER, "Canon  "), text(MODEL, "Canon EOS 1100D")];
        let exif = vec![
            ratio(F_NUMBER, [56, 10]),
            text(TAKEN, "2026:05:01 12:00:00"),
            ratio(FOCAL, [18, 1]),
            text(BODY_SERIAL, "123"),
            text(LENS_MODEL, "EF-S18-55mm"),
            text(LENS_SERIAL, ""),
        ];
        let found = Said::of(&Directories { main, exif, gps: Vec::new() });
        assert_eq!(
            [found.camera.as_deref(), found.serial.as_deref(), found.lens.as_deref()],
            [Some("Canon EOS 1100D"), Some("123"), Some("EF-S18-55mm")]
        );
        assert_eq!((found.focal_mm, found.f_number, found.lens_serial), (Some(18.0), Some(5.6), None));
        assert_eq!(found.taken.as_deref(), Some("2026-05-01 12:00:00"));
        let other = Directories { main: vec![text(MAKER, "SONY"), text(MODEL, "ILCE-7")], ..Directories::default() };
        assert_eq!(Said::of(&other).camera.as_deref(), Some("SONY ILCE-7"));
    }

    #[test]
    fn what_says_nothing_is_nothing() {
        let exif = vec![
            ratio(FOCAL, [0, 0]),
            ratio(F_NUMBER, [0, 1]),
            text(TAKEN, "0000:00:00 00:00:00"),
            Entry { tag: BODY_SERIAL, kind: 2, value: vec![] },
        ];
        assert_eq!(Said::of(&Directories { exif, ..Directories::default() }), Said::default());
    }
}
