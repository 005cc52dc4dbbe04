//! The text of a camera file, within limits.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use roxmltree::Document;

use super::{CameraFileError, xml};

/// The largest file that is read, bytes. Camera files of thousands of images have a few megabytes.
pub const LARGEST_FILE: u64 = 64 << 20;

/// A camera file's text; if it begins as XML does, its tree too.
pub(super) struct Source<'a> {
    /// All of it, without a byte order mark.
    pub text: &'a str,
    /// Its tree, if it is XML.
    pub xml: Option<Document<'a>>,
}

impl<'a> Source<'a> {
    /// Checks that `bytes` are text, and reads its tree if it is XML.
    ///
    /// # Errors
    /// Bytes that are not UTF-8, a zero byte, a text without a camera, XML that cannot be parsed; with the line where there is one.
    pub fn new(bytes: &'a [u8]) -> Result<Self, CameraFileError> {
        let text = std::str::from_utf8(bytes).map_err(|error| {
            let line = 1 + String::from_utf8_lossy(&bytes[..error.valid_up_to()]).matches('\n').count();
            CameraFileError::new("expected text in UTF-8, found other bytes").on_line(line)
        })?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if let Some(nul) = text.find('\0') {
            return Err(CameraFileError::new("expected text, found a zero byte").on_line(1 + text[..nul].matches('\n').count()));
        }
        if text.trim().is_empty() {
            return Err(CameraFileError::new("is empty; expected a camera"));
        }
        let xml = text.trim_start().starts_with('<').then(|| xml::parse(text)).transpose()?;
        Ok(Self { text, xml })
    }

    /// The lines that hold something, with their numbers, counted from 1.
    pub fn lines(&self) -> impl Iterator<Item = (usize, &'a str)> {
        self.text.lines().enumerate().map(|(index, line)| (index + 1, line.trim())).filter(|(_, line)| !line.is_empty())
    }
}

/// All bytes of a file that is no larger than [`LARGEST_FILE`].
pub(super) fn read(path: &Path) -> Result<Vec<u8>, CameraFileError> {
    bytes_of(path, LARGEST_FILE)?.ok_or_else(|| too_large(None))
}

/// All bytes of a file that is no larger than `most` bytes.
pub(super) fn read_up_to(path: &Path, most: u64) -> Result<Vec<u8>, CameraFileError> {
    bytes_of(path, most)?.ok_or_else(|| CameraFileError::new(format!("is larger than {} MB, the largest that is read", most >> 20)))
}

/// All bytes of a file, `None` if they are more than `most`.
fn bytes_of(path: &Path, most: u64) -> Result<Option<Vec<u8>>, CameraFileError> {
    let unreadable = |error: std::io::Error| CameraFileError::new(error.to_string());
    if path.is_dir() {
        return Err(CameraFileError::new("is a folder; expected a camera file"));
    }
    let file = File::open(path).map_err(unreadable)?;
    let length = file.metadata().map_err(unreadable)?.len();
    if length > most {
        return Ok(None);
    }
    // What is no ordinary file has no length: it is read up to the limit.
    let mut bytes = Vec::with_capacity(length as usize);
    file.take(most + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    Ok((bytes.len() as u64 <= most).then_some(bytes))
}

/// The error of a file that is larger than [`LARGEST_FILE`], with why it is not read in pieces where that was tried.
pub(super) fn too_large(why: Option<&str>) -> CameraFileError {
    let why = why.map_or(String::new(), |why| format!(": {why}"));
    CameraFileError::new(format!(
        "is larger than {} MB; expected a camera file. Longer ones are lists of COLMAP's alone (cameras.txt, cameras.bin, images.txt, images.bin), which `camera` \
         and `convert` read in pieces{why}; split this one",
        LARGEST_FILE >> 20
    ))
}
