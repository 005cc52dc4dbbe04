//! Photographs, band by band.

use std::ops::Range;
use std::path::{Path, PathBuf};

use calibench_files::{NewFolder, OutputFolder};
use calibench_images::picture::{About, Opened, PictureForm, PictureKind, PictureLevels, WriteOptions, write_picture};
use calibench_model::camera::ImageSize;
use calibench_undistort::{Kernel, Level, Map, Picture, reach, resample};
use rayon::prelude::*;

use super::Undistort;
use super::views::Views;
use crate::deliver::print;
use crate::failure::Failure;
use crate::progress::Progress;
use crate::reading::shown;

/// Rows that are made at a time: a multiple of the map's bands.
const ROWS: usize = 8 * Map::BAND;
/// Bytes of a photograph up to which several are made side by side.
const SMALL: usize = 1 << 28;

/// What is made of every photograph.
struct Job<'a> {
    map: &'a Map,
    kernel: Kernel,
    kind: Option<PictureKind>,
    quality: u8,
    as_stored: bool,
    /// Rows of the source for each part of the new picture, and the first that this part or a later one needs.
    needed: Vec<(Range<usize>, usize)>,
}

impl Undistort {
    pub(super) fn photographs(&self, folder: &OutputFolder, quiet: bool) -> Result<(), Failure> {
        let views = self.views()?;
        let camera = views.camera_file(&self.camera_format, self.pitch)?;
        let sizes = self.files.iter().map(|path| self.form(path, views.given.size())).collect::<Result<Vec<_>, _>>()?;
        let map = views.map()?;
        if !quiet {
            views.say(&map, self.kernel == Kernel::Area);
        }
        let kind = self.kind.map(super::Kind::of);
        let needed = needed(&map, reach(self.kernel, &map));
        let job = Job { map: &map, kernel: self.kernel, kind, quality: self.quality, as_stored: self.ignore_orientation, needed };
        let progress = Progress::start("undistort", self.files.len() as u64, quiet);
        folder.replace::<Failure>(|folder| {
            let one = |path: &PathBuf| {
                let made = job.made(path, folder);
                progress.step();
                made
            };
            if sizes.iter().all(|bytes| *bytes <= SMALL) {
                // The first that fails is named, on any number of threads.
                self.files.par_iter().map(one).collect::<Vec<_>>().into_iter().collect::<Result<(), _>>()?;
            } else {
                self.files.iter().try_for_each(one)?;
            }
            if self.mask {
                write_mask(&map, folder)?;
            }
            Views::write_camera(camera.as_ref(), folder)
        })?;
        progress.finish(&format!("{} pictures", self.files.len()));
        print(&format!("{}\n", self.output.display()))
    }

    /// Bytes of a photograph, which must be of the camera's size, and be held by the kind of file that is wanted.
    fn form(&self, path: &Path, size: ImageSize) -> Result<usize, Failure> {
        let opened = Opened::new(path, self.ignore_orientation)?;
        let form = opened.form();
        if form.size != size {
            let ImageSize { width, height } = form.size;
            let help = match opened.turn() {
                Some(turn) if (height, width) == (size.width, size.height) => {
                    format!("; it was turned ({turn}): --ignore-orientation leaves it")
                }
                None if (height, width) == (size.width, size.height) => "; turn the photograph, or the camera".to_owned(),
                _ => String::new(),
            };
            let expected = format!("{} x {} px", size.width, size.height);
            return Err(Failure::input(format!("{}: has {width} x {height} px, expected {expected} of the camera{help}", shown(path))));
        }
        let kind = self.kind.map_or(opened.kind(), super::Kind::of);
        if let Some(why) = kind.refuses(form) {
            return Err(Failure::input(format!("{}: {why}", shown(path))));
        }
        Ok(form.stride() * form.size.height as usize * if form.is_deep { 2 } else { 1 })
    }
}

/// See [`Job::needed`].
fn needed(map: &Map, reach: usize) -> Vec<(Range<usize>, usize)> {
    let height = map.size().height as usize;
    let parts = (0..height).step_by(ROWS).map(|first| map.rows_for(first..(first + ROWS).min(height), reach));
    let mut parts: Vec<(Range<usize>, usize)> = parts.map(|rows| (rows, 0)).collect();
    let mut first = map.source().height as usize;
    for (rows, keep) in parts.iter_mut().rev() {
        first = if rows.start < rows.end { first.min(rows.start) } else { first };
        *keep = first;
    }
    parts
}

impl Job<'_> {
    fn made(&self, path: &Path, folder: &NewFolder) -> Result<(), Failure> {
        let mut opened = Opened::new(path, self.as_stored)?;
        let (given, kind) = (opened.form(), self.kind.unwrap_or(opened.kind()));
        let form = PictureForm { size: self.map.size(), ..given };
        if let Some(why) = kind.refuses(form) {
            return Err(Failure::input(format!("{}: {why}", shown(path))));
        }
        let stem = path.file_stem().map_or_else(|| "picture".into(), |stem| stem.to_string_lossy());
        let (name, about) = (format!("{stem}.{}", kind.ending()), opened.about().clone());
        let options = WriteOptions { kind, quality: self.quality };
        folder.write(&name, |file| {
            write_picture(file, form, &about, options, |put| {
                let (mut window, mut first) = (PictureLevels::new(given.is_deep), 0);
                let (height, stride) = (form.size.height as usize, given.stride());
                for (part, (rows, keep)) in self.needed.iter().enumerate() {
                    let there = first + window.len() / stride;
                    if rows.end > there {
                        // What no part needs any more is forgotten once it is half of what is there.
                        let old = keep.saturating_sub(first).min(there - first);
                        if 2 * old > there - first {
                            window.forget(old * stride);
                            first += old;
                        }
                        opened.read(rows.end - there, &mut window)?;
                    }
                    let made = part * ROWS..((part + 1) * ROWS).min(height);
                    put(&self.part(&window, (given, first), made)?)?;
                }
                // To the end, whether it is needed or not: damage is told wherever it is.
                let left = given.size.height as usize - (first + window.len() / stride);
                for _ in 0..left.div_ceil(ROWS) {
                    let mut rest = PictureLevels::new(given.is_deep);
                    opened.read(ROWS, &mut rest)?;
                }
                Ok::<(), Failure>(())
            })
        })
    }

    /// Rows of the new picture, from those rows of the photograph that are there.
    fn part(&self, window: &PictureLevels, given: (PictureForm, usize), rows: Range<usize>) -> Result<PictureLevels, Failure> {
        Ok(match window {
            PictureLevels::Bytes(levels) => PictureLevels::Bytes(self.levels(levels, given, rows)?),
            PictureLevels::Words(levels) => PictureLevels::Words(self.levels(levels, given, rows)?),
        })
    }

    fn levels<T: Level>(&self, levels: &[T], (form, first): (PictureForm, usize), rows: Range<usize>) -> Result<Vec<T>, Failure> {
        let mut into = vec![T::default(); rows.len() * self.map.size().width as usize * form.channels];
        if !levels.is_empty() {
            let picture = Picture::new(form.size, form.channels, first, levels)?;
            resample(self.map, self.kernel, &picture, rows, &mut into)?;
        }
        Ok(into)
    }
}

fn write_mask(map: &Map, folder: &NewFolder) -> Result<(), Failure> {
    let form = PictureForm { size: map.size(), channels: 1, is_deep: false };
    let options = WriteOptions { kind: PictureKind::Png, quality: 100 };
    let height = form.size.height as usize;
    folder.write("mask.png", |file| {
        write_picture(file, form, &About::default(), options, |put| {
            (0..height).step_by(ROWS).try_for_each(|first| put(&PictureLevels::Bytes(map.mask(first..(first + ROWS).min(height)))))?;
            Ok::<(), Failure>(())
        })
    })
}
