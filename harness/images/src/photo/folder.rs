//! The photographs in a folder.

use std::cmp::Ordering;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use image::ImageFormat;

use super::foreign::{Foreign, TELLING};

/// The formats in which photographs are read.
const READ: [ImageFormat; 6] =
    [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Tiff, ImageFormat::Pnm, ImageFormat::Bmp, ImageFormat::WebP];

/// What a folder holds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PhotoFolder {
    /// Photographs that can be read, whatever they are called: content tells. In natural order: 2 before 10.
    pub photos: Vec<PathBuf>,
    /// Pictures in other formats.
    pub foreign: Vec<(PathBuf, Foreign)>,
    /// Folders in it, which are not searched.
    pub folders: Vec<PathBuf>,
}

impl PhotoFolder {
    /// What the folder `path` holds; what is hidden is passed over.
    ///
    /// # Errors
    /// A folder or a file that cannot be read.
    pub fn of(path: &Path) -> io::Result<Self> {
        let mut entries = path.read_dir()?.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<_>>>()?;
        entries.retain(|entry| entry.file_name().is_some_and(|name| !name.as_encoded_bytes().starts_with(b".")));
        entries.sort_by(|a, b| natural(&a.to_string_lossy(), &b.to_string_lossy()));
        let mut found = Self::default();
        for entry in entries {
            let about = entry.metadata()?;
            if about.is_dir() {
                found.folders.push(entry);
            } else if about.is_file() {
                let mut head = Vec::new();
                File::open(&entry)?.take(TELLING as u64).read_to_end(&mut head)?;
                let is_read = || image::guess_format(&head).is_ok_and(|format| READ.contains(&format));
                match Foreign::of(&head).or_else(|| Foreign::by_ending(&entry)) {
                    Some(kind) => found.foreign.push((entry, kind)),
                    None if is_read() => found.photos.push(entry),
                    None => {}
                }
            }
        }
        Ok(found)
    }
}

/// The order in which people count: runs of digits by their value, everything else by its characters.
pub fn natural(one: &str, other: &str) -> Ordering {
    let (mut a, mut b) = (one, other);
    loop {
        let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
        let (in_a, in_b) = (digits(a), digits(b));
        let order = if in_a > 0 && in_b > 0 {
            let (x, y) = (a[..in_a].trim_start_matches('0'), b[..in_b].trim_start_matches('0'));
            (a, b) = (&a[in_a..], &b[in_b..]);
            x.len().cmp(&y.len()).then_with(|| x.cmp(y))
        } else {
            let (mut of_a, mut of_b) = (a.chars(), b.chars());
            match (of_a.next(), of_b.next()) {
                (Some(x), Some(y)) => {
                    (a, b) = (of_a.as_str(), of_b.as_str());
                    x.cmp(&y)
                }
                // Of names that differ in leading zeros alone the text decides.
                (x, y) => return x.cmp(&y).then_with(|| one.cmp(other)),
            }
        };
        if order.is_ne() {
            return order;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_in_the_order_of_counting() {
        let ordered = ["IMG_2.png", "IMG_9.png", "IMG_010.png", "IMG_10.png", "IMG_10b.png", "IMG_100.png", "a", "a1", "a1.1", "b"];
        let mut names: Vec<&str> = ordered.iter().rev().copied().collect();
        names.sort_by(|a, b| natural(a, b));
        assert_eq!(names, ordered);
        assert_eq!(natural("99999999999999999999999", "100000000000000000000000"), Ordering::Less);
        assert_eq!(natural("x", "x"), Ordering::Equal);
    }

    #[test]
    fn content_tells_photographs_from_the_rest() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let png = |name: &str| {
            let image = calibench_model::Image::from_fn(4, 4, |_, _| 0.5);
            super::super::write_png(&at(name), &image, false).unwrap();
        };
        ["10.png", "9.png", "without", "wrong.txt", ".hidden.png"].iter().for_each(|name| png(name));
        std::fs::write(at("notes.png"), "no picture").unwrap();
        std::fs::write(at("a.heic"), b"\0\0\0\x18ftypheic\0\0\0\0mif1heic").unwrap();
        std::fs::write(at("a.nef"), b"II*\0\x08\0\0\0").unwrap();
        std::fs::create_dir(at("more")).unwrap();
        let found = PhotoFolder::of(folder.path()).unwrap();
        assert_eq!(found.photos, ["9.png", "10.png", "without", "wrong.txt"].map(at));
        assert_eq!(found.foreign, [(at("a.heic"), Foreign::Heic), (at("a.nef"), Foreign::Raw)]);
        assert_eq!(found.folders, [at("more")]);
        assert!(PhotoFolder::of(&at("absent")).is_err());
    }
}
