//! images.txt and images.bin, an image at a time, with the list of cameras beside them.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Seek};
use std::path::{Path, PathBuf};

use calibench_model::NamedCamera;

use super::lines::Lines;
use super::{Records, Stop, cameras, head, opened};
use crate::colmap_images::{self, Image, in_text, of_image, without_cameras};
use crate::formats::{colmap, colmap_bin};
use crate::little_endian::Bytes;
use crate::{CameraFileError, CameraFormat, ReadOptions};

/// Cameras that are kept as they are.
const KEPT: usize = 4096;

/// The list of cameras beside a list of images.
pub(super) struct Beside {
    path: PathBuf,
    options: ReadOptions,
    is_text: bool,
    /// Ids and the bytes at which their cameras begin, sorted.
    places: Vec<(u32, u64)>,
}

impl Beside {
    /// That of the list of images at `images`.
    pub fn of(images: &Path, options: &ReadOptions) -> Result<Self, Stop> {
        let path = colmap_images::beside(images).ok_or_else(without_cameras)?;
        let mut places = Vec::new();
        let looked_at = head(&path).and_then(|head| cameras::looked_at(&path, &head, options, |id, at| places.push((id, at))));
        let (is_text, _) = looked_at.map_err(|stop| match stop {
            Stop::Wrong(error) => Stop::Wrong(error.in_file(&path.display().to_string())),
            Stop::Whole(why) => Stop::Whole(format!("{}: {why}", path.display())),
        })?;
        places.sort_unstable();
        Ok(Self { path, options: options.clone(), is_text, places })
    }

    pub fn format(&self) -> &'static CameraFormat {
        if self.is_text { &colmap::FORMAT } else { &colmap_bin::FORMAT }
    }

    /// The byte at which a camera begins.
    fn place(&self, id: u32) -> Option<u64> {
        let found = self.places.binary_search_by_key(&id, |(id, _)| *id).ok()?;
        Some(self.places[found].1)
    }
}

/// The cameras of that list, of which the last that were asked for are kept.
struct Cameras<'l> {
    beside: &'l Beside,
    list: String,
    bytes: Bytes<BufReader<File>>,
    kept: HashMap<u32, NamedCamera>,
}

impl<'l> Cameras<'l> {
    fn open(beside: &'l Beside) -> Result<Self, Stop> {
        let (source, length) = opened(&beside.path)?;
        Ok(Self { beside, list: beside.path.display().to_string(), bytes: Bytes::of(source, length), kept: HashMap::new() })
    }

    /// The image with its camera and pose.
    fn posed(&mut self, image: Image) -> Result<NamedCamera, CameraFileError> {
        let id = image.camera;
        if let Some(at) = self.beside.place(id).filter(|_| !self.kept.contains_key(&id)) {
            if self.kept.len() >= KEPT {
                self.kept.clear();
            }
            let camera = self.read(at).map_err(|error| error.in_file(&self.list))?;
            self.kept.insert(id, camera);
        }
        image.posed(self.kept.get(&id), &self.list)
    }

    /// The camera that begins at a byte.
    fn read(&mut self, at: u64) -> Result<NamedCamera, CameraFileError> {
        let wrong = |error: std::io::Error| CameraFileError::new(error.to_string());
        let source = self.bytes.source();
        let before = source.stream_position().map_err(wrong)?;
        // What is buffered stays, where it lies in that.
        source.seek_relative(at.cast_signed() - before.cast_signed()).map_err(wrong)?;
        if !self.beside.is_text {
            self.bytes.stands_at(at);
            return colmap_bin::camera(&mut self.bytes, &self.beside.options);
        }
        let mut line = String::new();
        source.read_line(&mut line).map_err(wrong)?;
        colmap::camera(line.trim_start_matches('\u{feff}').trim(), &self.beside.options)
    }
}

/// The images of a list.
pub(super) struct Images<'l> {
    cameras: Cameras<'l>,
    source: ImageSource,
}

enum ImageSource {
    Text(Lines<BufReader<File>>),
    Bytes { bytes: Bytes<BufReader<File>>, count: u64, index: u64 },
}

impl<'l> Images<'l> {
    pub fn open(path: &Path, beside: &'l Beside, is_text: bool) -> Result<Self, Stop> {
        let (file, length) = opened(path)?;
        let source = if is_text {
            ImageSource::Text(Lines::new(file))
        } else {
            let mut bytes = Bytes::of(file, length);
            ImageSource::Bytes { count: bytes.u64()?, bytes, index: 0 }
        };
        Ok(Self { cameras: Cameras::open(beside)?, source })
    }

    /// The next image; the inner error is of its camera or its pose.
    pub fn next(&mut self) -> Result<Option<Result<NamedCamera, CameraFileError>>, Stop> {
        let image = match &mut self.source {
            ImageSource::Text(lines) => line_of_image(lines)?,
            ImageSource::Bytes { count, index, .. } if index == count => None,
            ImageSource::Bytes { bytes, count, index } => {
                *index += 1;
                Some(colmap_images::in_bytes(bytes).map_err(|error| of_image(*index, *count, error))?)
            }
        };
        Ok(image.map(|image| self.cameras.posed(image)))
    }
}

/// The next image of a text, whose points are passed over.
fn line_of_image(lines: &mut Lines<BufReader<File>>) -> Result<Option<Image>, Stop> {
    loop {
        let number = lines.number() + 1;
        // What is no text may be the other kind.
        let text = lines.next().map_err(|stop| match stop {
            Stop::Wrong(error) => Stop::Whole(error.problem),
            whole @ Stop::Whole(_) => whole,
        })?;
        let Some(text) = text.map(str::trim) else { return Ok(None) };
        if !text.is_empty() && !text.starts_with('#') {
            let image = in_text(text).map_err(|error| error.on_line(number))?;
            lines.pass()?;
            return Ok(Some(image));
        }
    }
}

impl Records for Images<'_> {
    fn next(&mut self) -> Result<Option<NamedCamera>, Stop> {
        Ok(Images::next(self)?.transpose()?)
    }
}
