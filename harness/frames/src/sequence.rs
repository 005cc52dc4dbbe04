//! Photographs and videos, one after the other, as one sequence of frames.

use std::collections::{BTreeSet, VecDeque};
use std::path::{Path, PathBuf};

use calibench_model::Image;
use calibench_photographs::Reader;

use crate::pgm::Still;
use crate::{FramesError, Heard, Video};

/// A photograph or a video.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// A photograph: one frame.
    Photo(PathBuf),
    /// A video.
    Video(PathBuf),
}

/// A frame that was not made an image of yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Raw {
    /// A file.
    Photo(PathBuf),
    /// Grey levels.
    Still(Still),
}

impl Raw {
    /// Its grey values; photographs are read by `reader`.
    ///
    /// # Errors
    /// A photograph that cannot be read.
    pub fn image(self, reader: Option<&Reader>) -> Result<Image<'static>, FramesError> {
        match (self, reader) {
            (Self::Still(still), _) => Ok(still.image()),
            (Self::Photo(path), Some(reader)) => Ok(reader.read(&path)?),
            (Self::Photo(path), None) => Ok(calibench_images::read_photo(&path)?.image),
        }
    }
}

/// A frame of a sequence by its source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place<'s> {
    /// Where it is from.
    pub source: &'s Source,
    /// Its number in it, counted from 0.
    pub frame: usize,
    /// When it is shown, s from the beginning of the video; `None` of photographs, and where the video does not say it.
    pub time: Option<f64>,
}

/// Frames of photographs and videos as they come: as an iterator each with its name.
#[derive(Debug)]
pub struct Sequence {
    left: VecDeque<Source>,
    as_stored: bool,
    /// The video that is being read, and how many frames of it were.
    video: Option<(PathBuf, Video, usize)>,
    /// What was read to its end, with its frames.
    done: Vec<(Source, usize, Heard)>,
}

impl Sequence {
    /// The frames of `sources`; those of videos turned as they are to be seen, or with `as_stored` as the sensor had them.
    pub fn of(sources: impl IntoIterator<Item = Source>, as_stored: bool) -> Self {
        Self { left: sources.into_iter().collect(), as_stored, video: None, done: Vec::new() }
    }

    /// The frame of that number, counted from 0 over all, of what was read.
    pub fn place(&self, mut number: usize) -> Option<Place<'_>> {
        for (source, frames, heard) in &self.done {
            if number < *frames {
                let time = heard.times.get(number).copied().filter(|time| time.is_finite());
                return Some(Place { source, frame: number, time });
            }
            number -= frames;
        }
        None
    }

    /// What was read to its end, how many frames it has, and what was said of it.
    pub fn read(&self) -> impl Iterator<Item = (&Source, usize, &Heard)> {
        self.done.iter().map(|(source, frames, heard)| (source, *frames, heard))
    }

    /// The next frame of the video that is being read; of one that has ended, none.
    fn of_video(&mut self) -> Result<Option<(String, Raw)>, FramesError> {
        let Some((path, video, read)) = &mut self.video else { return Ok(None) };
        if let Some(still) = video.next().transpose()? {
            *read += 1;
            return Ok(Some((format!("{}: frame {}", path.display(), *read - 1), Raw::Still(still))));
        }
        if let Some((path, video, read)) = self.video.take() {
            self.done.push((Source::Video(path), read, video.finish()?));
        }
        Ok(None)
    }

    fn following(&mut self) -> Result<Option<(String, Raw)>, FramesError> {
        loop {
            if let Some(frame) = self.of_video()? {
                return Ok(Some(frame));
            }
            match self.left.pop_front() {
                None => return Ok(None),
                Some(Source::Video(path)) => self.video = Some((path.clone(), Video::open(&path, self.as_stored)?, 0)),
                Some(Source::Photo(path)) => {
                    self.done.push((Source::Photo(path.clone()), 1, Heard::default()));
                    return Ok(Some((path.display().to_string(), Raw::Photo(path))));
                }
            }
        }
    }
}

impl Iterator for Sequence {
    type Item = Result<(String, Raw), FramesError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.following().transpose()
    }
}

/// Reads a video again, up to the last of the frames `wanted` (numbers from 0), and hands these to `take`, in their order.
///
/// # Errors
/// As those of [`Video`], and the first of `take`.
pub fn extract<E: From<FramesError>>(
    path: &Path,
    as_stored: bool,
    wanted: &BTreeSet<usize>,
    mut take: impl FnMut(usize, Still) -> Result<(), E>,
) -> Result<(), E> {
    let Some(last) = wanted.last() else { return Ok(()) };
    for (number, still) in Video::open(path, as_stored)?.enumerate().take(last + 1) {
        let still = still?;
        if wanted.contains(&number) {
            take(number, still)?;
        }
    }
    Ok(())
}
