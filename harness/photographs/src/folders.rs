//! Folders in place of photographs.

use std::path::{Path, PathBuf};

use calibench_images::{Foreign, PhotoError, PhotoFolder};

use crate::PhotographsError;

/// Photographs with those of a folder in its place, in natural order (2 before 10), and what is to be said of pictures in it that are not read.
///
/// # Errors
/// A folder that cannot be read; [`PhotographsError::Folder`] where none of its files is a photograph.
pub fn in_folders(given: &[PathBuf]) -> Result<(Vec<PathBuf>, Vec<String>), PhotographsError> {
    let (mut photos, mut notes) = (Vec::new(), Vec::new());
    for path in given {
        if !path.is_dir() {
            photos.push(path.clone());
            continue;
        }
        let found = PhotoFolder::of(path).map_err(|source| PhotoError::File { path: path.clone(), source })?;
        if found.photos.is_empty() {
            return Err(PhotographsError::Folder { why: why_none(&found), path: path.clone() });
        }
        notes.extend(left_out(path, &found));
        photos.extend(found.photos);
    }
    Ok((photos, notes))
}

/// What a folder holds in place of photographs.
fn why_none(found: &PhotoFolder) -> String {
    match (&found.foreign[..], &found.folders[..]) {
        ([first, rest @ ..], _) => format!("; {}{}", advice(first), more(rest.len())),
        ([], [first, ..]) => format!("; folders in it are not searched, name one of them: {}", first.display()),
        ([], []) => String::new(),
    }
}

/// What is to be said of pictures that are not among the photographs.
fn left_out(path: &Path, found: &PhotoFolder) -> Option<String> {
    let (first, rest) = found.foreign.split_first()?;
    let (advice, more) = (advice(first), more(rest.len()));
    let taken = if found.photos.len() == 1 { "1 photograph is".to_owned() } else { format!("{} photographs are", found.photos.len()) };
    Some(format!("{}: {taken} taken, and not {advice}{more}", path.display()))
}

fn advice((path, what): &(PathBuf, Foreign)) -> String {
    format!("{}, which is {what} ({})", path.display(), what.advice(path))
}

fn more(count: usize) -> String {
    if count == 0 { String::new() } else { format!(", nor {count} more that are not read") }
}

#[cfg(test)]
mod tests {
    use calibench_images::write_png;
    use calibench_model::Image;

    use super::*;

    #[test]
    fn a_folder_is_taken_for_its_photographs() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let said = |given: &[PathBuf]| in_folders(given).unwrap_err().to_string();
        let whole = folder.path().to_owned();
        assert!(said(std::slice::from_ref(&whole)).ends_with("holds no photograph; expected PNG, JPEG, TIFF, PNM, BMP or WebP"));
        std::fs::create_dir(at("left")).unwrap();
        assert!(said(std::slice::from_ref(&whole)).contains("folders in it are not searched, name one of them: "));
        std::fs::write(at("a.heic"), b"\0\0\0\x18ftypheic\0\0\0\0mif1heic").unwrap();
        std::fs::write(at("b.heic"), b"\0\0\0\x18ftypheic\0\0\0\0mif1heic").unwrap();
        let none = said(std::slice::from_ref(&whole));
        assert!(
            none.contains("a.heic, which is a HEIC picture (`heif-convert ") && none.ends_with(", nor 1 more that are not read"),
            "{none}"
        );
        ["10.png", "2.png"].iter().for_each(|name| write_png(&at(name), &Image::from_fn(4, 4, |_, _| 0.5), false).unwrap());
        let (photos, notes) = in_folders(&[at("elsewhere.png"), whole]).unwrap();
        assert_eq!(photos, ["elsewhere.png", "2.png", "10.png"].map(at));
        assert!(notes.len() == 1 && notes[0].contains(": 2 photographs are taken, and not "), "{notes:?}");
    }
}
