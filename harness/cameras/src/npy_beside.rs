//! A camera matrix in a .npy of its own, with the coefficients in another one beside it.

use std::path::{Path, PathBuf};

use super::opencv_names::NO_DISTORTION;
use super::tree::Entry;
use super::{CameraFile, CameraFileError, CameraFormat, ReadOptions, npy, opencv, recognised, source};

/// Files beside it that an error names at most.
const MOST_NAMED: usize = 10;

/// The camera of the matrix in `bytes`, the file at `path`, and of the coefficients that `options` names; `format` is that of NumPy's archives.
///
/// # Errors
/// No file of coefficients, what is no matrix or no coefficients, another format that was asked for.
pub(super) fn read(path: &Path, bytes: &[u8], options: &ReadOptions, format: &'static CameraFormat) -> Result<CameraFile, CameraFileError> {
    let own = path.display().to_string();
    if let Some(from) = options.from.filter(|from| *from != format) {
        return Err(CameraFileError::new(format!("is no file of {}: it is an array of NumPy's", from.name)).in_file(&own));
    }
    let matrix = named(path);
    let mut arrays = vec![(matrix.clone(), npy::entry(bytes).map_err(|error| error.in_file(&own))?)];
    let distortion = options.distortion.as_deref().ok_or_else(|| unnamed(path).in_file(&own))?;
    let distortion = if distortion == NO_DISTORTION {
        distortion.to_owned()
    } else {
        let (name, entry) = coefficients(path, distortion)?;
        arrays.push((name.clone(), entry));
        name
    };
    let options = ReadOptions { matrix: Some(matrix), distortion: Some(distortion), ..options.clone() };
    let read = npy::named(arrays).and_then(|root| opencv::read(&root, &options));
    let mut cameras = read.map_err(|error| CameraFileError { line: None, ..error }.in_file(&own))?;
    cameras.iter_mut().enumerate().for_each(|(place, named)| recognised::doubt(place, named));
    Ok(CameraFile { format, cameras })
}

/// The name of an array is that of its file.
fn named(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The array in the file called `name` beside `path`, with .npy or without.
fn coefficients(path: &Path, name: &str) -> Result<(String, Entry), CameraFileError> {
    let beside = path.with_file_name(name);
    let with_ending = PathBuf::from(format!("{}.npy", beside.display()));
    let file = [beside, with_ending, PathBuf::from(name)].into_iter().find(|file| file.is_file());
    let file = file.ok_or_else(|| CameraFileError::new("no such file beside the camera matrix").in_file(name))?;
    let read = source::read(&file).and_then(|bytes| npy::entry(&bytes));
    Ok((named(&file), read.map_err(|error| error.in_file(&file.display().to_string()))?))
}

fn unnamed(path: &Path) -> CameraFileError {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let others = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok).map(|entry| entry.path());
    let of_numpy = |other: &PathBuf| other.extension().is_some_and(|ending| ending == "npy") && other.file_name() != path.file_name();
    let mut names: Vec<String> = others.filter(of_numpy).map(|other| format!("`{}.npy`", named(&other))).collect();
    names.sort();
    names.truncate(MOST_NAMED);
    let there = if names.is_empty() { "no other .npy".to_owned() } else { names.join(", ") };
    CameraFileError::new(format!(
        "is one array: name the file of the coefficients with --distortion FILE.npy, or --distortion {NO_DISTORTION}; beside it is {there}"
    ))
}
