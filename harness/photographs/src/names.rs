//! What photographs are called, and how large they are.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};

use calibench_model::camera::ImageSize;
use calibench_model::views::photo_of;

use crate::PhotographsError;

/// File names; those of the same name in several folders with their folders, as they were given.
pub fn names(photos: &[PathBuf]) -> Vec<String> {
    let mut count: BTreeMap<String, usize> = BTreeMap::new();
    photos.iter().for_each(|path| *count.entry(short(path)).or_default() += 1);
    photos.iter().map(|path| if count[&short(path)] > 1 { path.display().to_string() } else { short(path) }).collect()
}

fn short(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// The first of `wanted` that two photographs may mean, and both.
pub fn ambiguous<'p, 'n>(photos: &'p [PathBuf], mut wanted: impl Iterator<Item = &'n str>) -> Option<(&'n str, [&'p Path; 2])> {
    let mut called: HashMap<String, Vec<&Path>> = HashMap::new();
    photos.iter().for_each(|path| called.entry(short(path)).or_default().push(path));
    let of = |name: &str| called.get(name).or_else(|| called.get(photo_of(name)?));
    wanted.find_map(|name| match of(name)?.as_slice() {
        [first, second, ..] => Some((name, [*first, *second])),
        _ => None,
    })
}

/// Each photograph must be given once.
///
/// # Errors
/// [`PhotographsError::Twice`].
pub fn once(photos: &[PathBuf]) -> Result<(), PhotographsError> {
    let mut seen = HashSet::new();
    let twice = photos.iter().find(|photo| !seen.insert(photo.as_path()));
    twice.map_or(Ok(()), |twice| Err(PhotographsError::Twice(twice.clone())))
}

/// The size that all photographs have.
///
/// # Errors
/// [`PhotographsError::None`], [`PhotographsError::Sizes`].
pub fn same_size<'p>(photos: impl IntoIterator<Item = (&'p PathBuf, ImageSize)>) -> Result<ImageSize, PhotographsError> {
    let mut by_size: Vec<(ImageSize, Vec<PathBuf>)> = Vec::new();
    for (path, size) in photos {
        match by_size.iter_mut().find(|(known, _)| *known == size) {
            Some((_, own)) => own.push(path.clone()),
            None => by_size.push((size, vec![path.clone()])),
        }
    }
    by_size.sort_by_key(|(_, own)| std::cmp::Reverse(own.len()));
    match by_size.as_slice() {
        [] => Err(PhotographsError::None),
        [(size, _)] => Ok(*size),
        _ => Err(PhotographsError::Sizes(by_size.into_iter().map(|(size, own)| ((size.width, size.height), own)).collect())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn photographs_of_one_name_are_told_apart_by_their_folders() {
        let photos = ["a/left/1.png", "a/right/1.png", "a/right/2.png"].map(PathBuf::from);
        assert_eq!(names(&photos), ["a/left/1.png", "a/right/1.png", "2.png"]);
        assert!(once(&photos).is_ok() && once(&[photos.as_slice(), &photos[..1]].concat()).is_err());
    }

    #[test]
    fn photographs_of_one_camera_have_one_size() {
        let paths = ["a.png", "b.png"].map(PathBuf::from);
        let size = |width| ImageSize { width, height: 480 };
        assert_eq!(same_size([(&paths[0], size(640)), (&paths[1], size(640))]).ok(), Some(size(640)));
        let error = same_size([(&paths[0], size(640)), (&paths[1], size(480))]).unwrap_err();
        assert!(error.to_string().contains("640 x 480 px (1: a.png); 480 x 480 px (1: b.png)"), "{error}");
    }
}
