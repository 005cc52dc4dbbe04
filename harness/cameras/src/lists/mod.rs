//! COLMAP's lists in pieces: memory does not grow with their cameras.
//!
//! A list is read twice: once to look at every camera and at every word that might make it another tool's file ([`CameraList::open`]), and once piece by piece
//! ([`CameraList::pieces`]). What grows is an id and its place, 8 bytes a camera, so that none stands twice; of the cameras to which a list of images
//! refers also where each stands, 16 bytes.

mod cameras;
mod images;
mod lines;
mod numbers;
mod writer;

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use calibench_files::Inputs;

use super::formats::{colmap, colmap_bin};
use super::source::{self, LARGEST_FILE};
use super::{CameraFileError, CameraFormat, NamedCamera, ReadOptions, colmap_images, recognised};
use images::{Beside, Images};
pub use writer::ListWriter;

/// Bytes at the beginning of a file by which it is known.
const HEAD: usize = 1 << 16;

/// Why a list is not read in pieces.
enum Stop {
    /// It is wrong.
    Wrong(CameraFileError),
    /// It may be right or another tool's, which only all of it shows; with the reason.
    Whole(String),
}

impl From<CameraFileError> for Stop {
    fn from(error: CameraFileError) -> Self {
        Self::Wrong(error)
    }
}

impl From<io::Error> for Stop {
    fn from(error: io::Error) -> Self {
        Self::Wrong(CameraFileError::new(error.to_string()))
    }
}

/// The kinds of lists.
enum Kind {
    /// cameras.txt.
    Text,
    /// cameras.bin.
    Bytes,
    /// images.txt.
    ImagesText(Beside),
    /// images.bin.
    ImagesBytes(Beside),
}

/// A list of cameras that was looked at and holds no mistake.
pub struct CameraList {
    path: PathBuf,
    options: ReadOptions,
    kind: Kind,
    count: usize,
    own_numbers: bool,
}

impl CameraList {
    /// Looks at all of a list: COLMAP's cameras.txt, cameras.bin, images.txt or images.bin. `None` for a file that is none of these, and for what only the whole
    /// of a file decides: read that with [`super::read_camera_with`], which finds the same cameras in all that is read here, and the same mistakes.
    ///
    /// # Errors
    /// The first mistake, with file and line or place; a file that is no such list and too large to be read whole.
    pub fn open(path: &Path, options: &ReadOptions) -> Result<Option<Self>, CameraFileError> {
        // A pipe is read once; what cannot be read is said where it is read whole.
        let Ok(about) = std::fs::metadata(path) else { return Ok(None) };
        if !about.is_file() {
            return Ok(None);
        }
        let in_file = |error: CameraFileError| if error.file.is_empty() { error.in_file(&path.display().to_string()) } else { error };
        match Self::looked_at(path, options) {
            Ok(list) => Ok(Some(list)),
            Err(Stop::Wrong(error)) => Err(in_file(error)),
            Err(Stop::Whole(why)) if about.len() > LARGEST_FILE => Err(in_file(source::too_large(Some(&why)))),
            Err(Stop::Whole(_)) => Ok(None),
        }
    }

    fn looked_at(path: &Path, options: &ReadOptions) -> Result<Self, Stop> {
        let head = head(path)?;
        let list = |kind, count| Self { path: path.to_owned(), options: options.clone(), kind, count, own_numbers: true };
        // Images are known before cameras, as where all is read.
        if colmap_images::are_in_bytes(&head) {
            return list(Kind::ImagesBytes(Beside::of(path, options)?), 0).with_images();
        }
        if whole_lines(&head).is_some_and(colmap_images::are_in_text) {
            return list(Kind::ImagesText(Beside::of(path, options)?), 0).with_images();
        }
        let (is_text, count) = cameras::looked_at(path, &head, options, |_, _| ())?;
        Ok(list(if is_text { Kind::Text } else { Kind::Bytes }, count))
    }

    fn with_images(mut self) -> Result<Self, Stop> {
        let mut images = match &self.kind {
            Kind::ImagesText(beside) => Images::open(&self.path, beside, true)?,
            Kind::ImagesBytes(beside) => Images::open(&self.path, beside, false)?,
            Kind::Text | Kind::Bytes => return Ok(self),
        };
        // A line that is wrong stands before an image without a camera, as where all is read.
        let (mut names, mut without) = (numbers::Names::default(), None);
        loop {
            match images.next()? {
                None => break,
                Some(Ok(image)) => names.push(&image.name),
                Some(Err(error)) => drop(without.get_or_insert(error)),
            }
            self.count += 1;
        }
        drop(images);
        self.own_numbers = names.are_numbers();
        without.map_or(Ok(self), |error| Err(error.into()))
    }

    /// The format of its cameras: of the list beside it for a list of images.
    pub fn format(&self) -> &'static CameraFormat {
        match &self.kind {
            Kind::Text => &colmap::FORMAT,
            Kind::Bytes => &colmap_bin::FORMAT,
            Kind::ImagesText(beside) | Kind::ImagesBytes(beside) => beside.format(),
        }
    }

    /// How many cameras it holds; at least one.
    #[expect(clippy::len_without_is_empty, reason = "a list without a camera is none")]
    pub fn len(&self) -> usize {
        self.count
    }

    /// Its cameras in their order, at most `most` at a time; as much of it is in memory.
    ///
    /// # Errors
    /// A file that cannot be read any more.
    pub fn pieces(&self, most: usize) -> Result<Pieces<'_>, CameraFileError> {
        let records = self.records().map_err(|stop| self.changed(stop))?;
        Ok(Pieces { list: self, records, most: most.max(1), left: self.count, ended: false })
    }

    fn records(&self) -> Result<Box<dyn Records + '_>, Stop> {
        Ok(match &self.kind {
            Kind::Text => Box::new(cameras::Text::open(&self.path, &self.options)?),
            Kind::Bytes => Box::new(cameras::Binary::open(&self.path, &self.options)?),
            Kind::ImagesText(beside) => Box::new(Images::open(&self.path, beside, true)?),
            Kind::ImagesBytes(beside) => Box::new(Images::open(&self.path, beside, false)?),
        })
    }

    /// The error of what was right before.
    fn changed(&self, stop: Stop) -> CameraFileError {
        let error = match stop {
            Stop::Wrong(error) => error,
            Stop::Whole(why) => CameraFileError::new(format!("is not the list any more that it was: {why}")),
        };
        if error.file.is_empty() { error.in_file(&self.path.display().to_string()) } else { error }
    }
}

/// Cameras one after the other.
trait Records {
    /// The next one.
    fn next(&mut self) -> Result<Option<NamedCamera>, Stop>;
}

/// The cameras of a list, some at a time.
pub struct Pieces<'l> {
    list: &'l CameraList,
    records: Box<dyn Records + 'l>,
    most: usize,
    left: usize,
    ended: bool,
}

impl Iterator for Pieces<'_> {
    type Item = Result<Vec<NamedCamera>, CameraFileError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ended {
            return None;
        }
        let piece = self.piece();
        self.ended = piece.as_ref().map_or(true, |piece| piece.len() < self.most);
        piece.map(|piece| (!piece.is_empty()).then_some(piece)).transpose()
    }
}

impl Pieces<'_> {
    /// The next cameras; fewer at the end.
    fn piece(&mut self) -> Result<Vec<NamedCamera>, CameraFileError> {
        let other = |what: &str| self.list.changed(Stop::Whole(format!("it has {what} cameras than the {} that it had", self.list.count)));
        let mut piece = Vec::with_capacity(self.most.min(self.left));
        while piece.len() < self.most {
            match self.records.next().map_err(|stop| self.list.changed(stop))? {
                Some(_) if self.left == 0 => return Err(other("more")),
                Some(mut camera) => {
                    recognised::doubt(self.list.count - self.left, &mut camera);
                    self.left -= 1;
                    piece.push(camera);
                }
                None if self.left > 0 => return Err(other("fewer")),
                None => break,
            }
        }
        Ok(piece)
    }
}

/// What a command reads: the files and folders of `paths`, and the lists of cameras that are read with COLMAP's lists of images.
pub fn inputs_of<P: AsRef<Path>>(paths: impl IntoIterator<Item = P>) -> Inputs {
    let with_beside = |path: P| [Some(path.as_ref().to_owned()), read_beside(path.as_ref())];
    Inputs::new(paths.into_iter().flat_map(with_beside).flatten())
}

/// The list of cameras that is read with the file at `path`, if that is one of COLMAP's lists of images.
fn read_beside(path: &Path) -> Option<PathBuf> {
    // A pipe is read once.
    std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file)?;
    let head = head(path).ok()?;
    let are_images = colmap_images::are_in_bytes(&head) || whole_lines(&head).is_some_and(colmap_images::are_in_text);
    are_images.then(|| colmap_images::beside(path)).flatten()
}

/// The beginning of a file.
fn head(path: &Path) -> Result<Vec<u8>, Stop> {
    let mut head = Vec::new();
    File::open(path)?.take(HEAD as u64).read_to_end(&mut head)?;
    Ok(head)
}

/// The lines of `head` that end in it, or all of a file that is no longer; `None` for what is no text.
fn whole_lines(head: &[u8]) -> Option<&str> {
    let end = if head.len() < HEAD { head.len() } else { head.iter().rposition(|byte| *byte == b'\n')? + 1 };
    std::str::from_utf8(&head[..end]).ok()
}

/// A file and its length.
fn opened(path: &Path) -> Result<(BufReader<File>, u64), Stop> {
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    Ok((BufReader::with_capacity(HEAD, file), length))
}

#[cfg(test)]
mod tests;
