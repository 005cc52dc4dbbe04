//! Which files of corners can be judged together.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use calibench_calibrate::choice::HALF;
use calibench_exchange::PointFile;
use calibench_records::judgement::COMPARABLE;
use thiserror::Error;

use super::{Expected, FEWEST, Material};

/// A file of corners and what it is called in the verdict.
#[derive(Clone, Debug)]
pub struct CornerFile {
    /// The name of its operator.
    pub name: Arc<str>,
    /// Where it is.
    pub path: PathBuf,
}

/// Why files of corners cannot be judged, or not together.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum CornerFilesError {
    /// One file stands twice.
    #[error("--points {path}: given twice; expected each file once", path = path.display())]
    Twice {
        /// The file.
        path: PathBuf,
    },
    /// Two files of one name.
    #[error(
        "--points: two files are called `{name}`: {first} and {second}; give them names, as in --points first={first} --points second={second}",
        first = first.display(),
        second = second.display()
    )]
    OneName {
        /// What both are called.
        name: Arc<str>,
        /// The earlier one.
        first: PathBuf,
        /// The later one.
        second: PathBuf,
    },
    /// Files of other images.
    #[error(
        "{path}: has no image in common with {first}: it names `{here}`, the other `{there}`; expected files of the same images, by the same names",
        path = path.display(),
        first = first.display()
    )]
    OtherImages {
        /// The file.
        path: PathBuf,
        /// The first file.
        first: PathBuf,
        /// An image that it names.
        here: String,
        /// An image of the first file.
        there: String,
    },
    /// A row without a position that names no point of the field.
    #[error("{path}: {why}", path = path.display())]
    NoCorner {
        /// The file.
        path: PathBuf,
        /// What was expected.
        why: String,
    },
    /// Too few images for two halves.
    #[error(
        "{path}: judging takes at least {needed} images with {corners} corners or more (each half of them is calibrated by itself), found {found}; measure more images",
        path = path.display()
    )]
    TooFewImages {
        /// The file.
        path: PathBuf,
        /// Images with enough corners.
        found: usize,
        /// How many are needed.
        needed: usize,
        /// Corners that an image needs.
        corners: usize,
    },
    /// Too few corners to be compared with the other files.
    #[error(
        "{path}: has {found} of the {all} corners that the files have together; operators are compared where each has {percent:.0} % of them; give files of the same \
         images and corners, or judge each alone",
        path = path.display(),
        percent = 100.0 * COMPARABLE
    )]
    TooFewCorners {
        /// The file.
        path: PathBuf,
        /// Its corners.
        found: usize,
        /// Those of all files together.
        all: usize,
    },
}

impl CornerFile {
    /// Each file once, and no two of one name.
    ///
    /// # Errors
    /// [`CornerFilesError::Twice`], [`CornerFilesError::OneName`].
    pub fn told_apart(files: &[Self]) -> Result<(), CornerFilesError> {
        for (index, file) in files.iter().enumerate() {
            if files[..index].iter().any(|earlier| same(&earlier.path, &file.path)) {
                return Err(CornerFilesError::Twice { path: file.path.clone() });
            }
            if let Some(earlier) = files[..index].iter().find(|earlier| earlier.name == file.name) {
                let (first, second) = (earlier.path.clone(), file.path.clone());
                return Err(CornerFilesError::OneName { name: file.name.clone(), first, second });
            }
        }
        Ok(())
    }
}

fn same(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}

impl Material {
    /// The corners that `read` holds of each of `files`, whose rows passed [`Expected::check`].
    ///
    /// # Errors
    /// [`CornerFilesError`] for files that cannot be judged, or not together.
    pub fn of_corner_files(files: &[CornerFile], read: &[PointFile], expected: &Expected) -> Result<Self, CornerFilesError> {
        files.iter().zip(read).try_for_each(|(file, read)| of_field(expected, file, read))?;
        same_images(files, read)?;
        let named: Vec<(&Arc<str>, &PointFile)> = files.iter().map(|file| &file.name).zip(read).collect();
        let material = Self::of_files(&named, expected);
        files.iter().enumerate().try_for_each(|(operator, file)| enough(&material, operator, file))?;
        files.iter().enumerate().try_for_each(|(operator, file)| comparable(&material, operator, file))?;
        Ok(material)
    }
}

/// Rows without a position name points of the field as well.
fn of_field(expected: &Expected, file: &CornerFile, read: &PointFile) -> Result<(), CornerFilesError> {
    let named = read.lost.iter().try_for_each(|[_, target, ..]| expected.name(target));
    named.map_err(|why| CornerFilesError::NoCorner { path: file.path.clone(), why })
}

/// Files are compared on the images that they share.
fn same_images(files: &[CornerFile], read: &[PointFile]) -> Result<(), CornerFilesError> {
    let Some((first, others)) = read.split_first() else { return Ok(()) };
    let known = first.points.images();
    for (other, file) in others.iter().zip(&files[1..]) {
        let images = other.points.images();
        if images.iter().all(|image| known.find(image).is_none()) {
            let [here, there] = [images, known].map(|names| names.iter().next().unwrap_or_default().to_owned());
            let (path, first) = (file.path.clone(), files[0].path.clone());
            return Err(CornerFilesError::OtherImages { path, first, here, there });
        }
    }
    Ok(())
}

/// As many images as two halves take.
fn enough(material: &Material, operator: usize, file: &CornerFile) -> Result<(), CornerFilesError> {
    let (found, needed, corners) = (material.usable(operator).len(), 2 * HALF, FEWEST.min(material.field.count()));
    if found >= needed { Ok(()) } else { Err(CornerFilesError::TooFewImages { path: file.path.clone(), found, needed, corners }) }
}

/// As many corners as a comparison with the other files takes.
fn comparable(material: &Material, operator: usize, file: &CornerFile) -> Result<(), CornerFilesError> {
    let (found, all) = (material.measured(operator), material.tried().iter().sum::<usize>());
    let is_comparable = found as f64 >= COMPARABLE * all as f64;
    if is_comparable { Ok(()) } else { Err(CornerFilesError::TooFewCorners { path: file.path.clone(), found, all }) }
}
