//! Photographs of a camera, all read alike.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use calibench_images::photo::{DeepLevels, Depth, read_with_levels};
use calibench_images::{Head, PhotoError, Reading, head_of, read_photo_as};
use calibench_model::Image;
use calibench_model::camera::ImageSize;
use rayon::prelude::*;

use crate::names::{once, same_size};
use crate::{PhotographsError, turns};

/// What is asked of how photographs are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Asked {
    /// No photograph is turned as it asks for.
    pub ignore_orientation: bool,
    /// Bits of a level in files of 16; by their levels if not said.
    pub bits: Option<u8>,
    /// Photographs of other sizes are left out.
    pub only_size: Option<ImageSize>,
    /// They are of one camera and make one interior orientation: where not all ask for the same turn, none is turned, because the sensor was not.
    pub one_camera: bool,
}

/// Photographs of a camera, and how they are read.
#[derive(Debug)]
pub struct Reader {
    photos: Vec<PathBuf>,
    reading: Reading,
    /// By photograph.
    sizes: Vec<ImageSize>,
    notes: Vec<String>,
    /// One that was read for its levels.
    kept: Mutex<Option<(PathBuf, Image<'static>)>>,
}

impl Reader {
    /// How these photographs are read: from their heads, and of those with 16 bits from the levels of as many as it takes.
    ///
    /// # Errors
    /// A photograph that cannot be read, or that is given twice; of one camera photographs of several sizes.
    pub fn of(photos: &[PathBuf], asked: Asked) -> Result<Self, PhotographsError> {
        once(photos)?;
        let heads = photos.par_iter().map(|path| head_of(path)).collect::<Result<Vec<_>, PhotoError>>()?;
        let mut all: Vec<(&PathBuf, Head)> = photos.iter().zip(heads).collect();
        let mut notes = Vec::new();
        let is_mixed = all.iter().any(|(_, head)| head.turn != all[0].1.turn);
        let as_stored = asked.ignore_orientation || (is_mixed && asked.one_camera);
        let mut reading = Reading { as_stored, ..Reading::default() };
        if let Some(only) = asked.only_size {
            let before = all.len();
            all.retain(|(_, head)| head.size(reading) == only);
            if all.is_empty() {
                return Err(PhotographsError::NoneOfSize(only));
            }
            notes.extend(
                (all.len() < before)
                    .then(|| format!("--only-size: {} of {before} photographs have another size and are left out", before - all.len())),
            );
        }
        let turned: Vec<_> = all.iter().map(|(path, head)| (path.as_path(), head.turn)).collect();
        notes.extend(turns::said(&turned, (asked.ignore_orientation, as_stored)));
        let sizes: Vec<ImageSize> = all.iter().map(|(_, head)| head.size(reading)).collect();
        if asked.one_camera {
            same_size(all.iter().map(|(path, _)| *path).zip(sizes.iter().copied()))?;
        }
        let deep: Vec<&Path> = all.iter().filter(|(_, head)| head.is_deep).map(|(path, _)| path.as_path()).collect();
        let mut kept = None;
        match asked.bits {
            Some(bits) => reading.bits = bits,
            None => {
                let (depth, largest, first) = depth(&deep, reading)?;
                (reading.bits, kept) =
                    (if let Depth::Bits(bits) = depth { bits } else { 16 }, first.filter(|_| !matches!(depth, Depth::Bits(_))));
                notes.extend(words(depth, largest, &deep));
            }
        }
        let photos = all.into_iter().map(|(path, _)| path.clone()).collect();
        Ok(Self { photos, reading, sizes, notes, kept: Mutex::new(kept) })
    }

    /// The photographs that are read.
    pub fn photos(&self) -> &[PathBuf] {
        &self.photos
    }

    /// How they are read.
    pub const fn reading(&self) -> Reading {
        self.reading
    }

    /// Their sizes, by photograph.
    pub fn sizes(&self) -> &[ImageSize] {
        &self.sizes
    }

    /// What is to be said of how they are read.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// A photograph.
    ///
    /// # Errors
    /// One that cannot be read.
    pub fn read(&self, path: &Path) -> Result<Image<'static>, PhotoError> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner).take_if(|(of, _)| of.as_path() == path);
        if let Some((_, image)) = kept { Ok(image) } else { Ok(read_photo_as(path, self.reading)?.image) }
    }
}

/// The first of the photographs that were read for their levels.
type First = Option<(PathBuf, Image<'static>)>;

/// The depth of the levels of all, the largest of them, and the first photograph. Reading ends with one that is bright enough to settle it.
fn depth(deep: &[&Path], reading: Reading) -> Result<(Depth, u16, First), PhotoError> {
    let (mut all, mut first): (Option<DeepLevels>, First) = (None, None);
    for path in deep {
        let (photo, levels) = read_with_levels(path, reading)?;
        first.get_or_insert_with(|| ((*path).to_owned(), photo.image));
        all = match (all, levels) {
            (Some(all), Some(levels)) => Some(all.with(levels)),
            (all, levels) => all.or(levels),
        };
        if all.is_none_or(DeepLevels::is_whole) {
            break;
        }
    }
    Ok((all.map_or(Depth::Whole, DeepLevels::depth), all.map_or(0, |all| all.largest), first))
}

/// What is said of levels that do not reach far.
fn words(depth: Depth, largest: u16, deep: &[&Path]) -> Option<String> {
    let first = deep.first()?.display();
    let which = if deep.len() > 1 { format!("{first} and {} more", deep.len() - 1) } else { first.to_string() };
    // What a method with 8 bits a pixel would be given of levels up to 65535.
    let grey = u32::from(largest) / 256 + 1;
    match depth {
        Depth::Whole => None,
        Depth::Bits(bits) => Some(format!(
            "{which}: the largest level is {largest} of 65535: read as {bits} bits, so that {} is white (methods with 8 bits a pixel would be given {grey} grey levels); \
             --bits 16 reads them as they are",
            (1_u32 << bits) - 1
        )),
        Depth::Unsure(bits) => Some(format!(
            "{which}: the largest level is {largest} of 65535: methods with 8 bits a pixel are given {grey} grey levels; if these are the levels of a camera with {bits} \
             bits, and not dark photographs, --bits {bits} says so"
        )),
    }
}

#[cfg(test)]
mod tests {
    use calibench_images::photo::encode_png;

    use super::*;

    /// Photographs of 16 bits whose levels are all below `most`.
    fn written(folder: &Path, most: &[u16]) -> Vec<PathBuf> {
        let one = |(index, most): (usize, &u16)| {
            let path = folder.join(format!("{index}.png"));
            let image = Image::from_fn(16, 16, |x, y| f32::from(most - (x * 16 + y) as u16) / 65535.0);
            encode_png(&mut std::fs::File::create(&path).unwrap(), &image, true).unwrap();
            path
        };
        most.iter().enumerate().map(one).collect()
    }

    #[test]
    fn a_set_has_one_scale_and_dark_photographs_keep_theirs() {
        let folder = tempfile::tempdir().unwrap();
        for (most, asked, bits, said) in [
            (&[900, 3665, 700][..], None, 12, "read as 12 bits"),
            (&[900, 800], None, 10, "read as 10 bits"),
            (&[900, 40_000], None, 16, ""),
            (&[14_661, 3000], None, 16, "given 58 grey levels"),
            (&[14_661, 3000], Some(14), 14, ""),
            (&[900, 800], Some(16), 16, ""),
        ] {
            let photos = written(folder.path(), most);
            let reader = Reader::of(&photos, Asked { bits: asked, ..Asked::default() }).unwrap();
            assert_eq!(reader.reading().bits, bits, "{most:?}");
            assert!(
                if said.is_empty() { reader.notes().is_empty() } else { reader.notes()[0].contains(said) },
                "{most:?}: {:?}",
                reader.notes()
            );
            for (path, most) in photos.iter().zip(most) {
                // Twice: what was kept is not kept for ever.
                for _ in 0..2 {
                    let white = reader.read(path).unwrap().at(0, 0);
                    let expected = f32::from(*most) / ((1_u32 << bits) - 1) as f32;
                    assert!((white / expected - 1.0).abs() < 1e-6, "{most}: {white}, {expected}");
                }
            }
        }
    }

    #[test]
    fn sizes_are_all_named_before_anything_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, width| {
            let path = folder.path().join(name);
            encode_png(&mut std::fs::File::create(&path).unwrap(), &Image::from_fn(width, 16, |_, _| 0.5), false).unwrap();
            path
        };
        let photos: Vec<PathBuf> =
            [("a", 32), ("b", 32), ("c", 48), ("d", 16), ("e", 48), ("f", 32)].map(|(name, width)| write(name, width)).into();
        let asked = Asked { one_camera: true, ..Asked::default() };
        let error = Reader::of(&photos, asked).unwrap_err().to_string();
        for part in ["32 x 16 px (3", "48 x 16 px (2", "16 x 16 px (1", "/c", "/d", "/e", "--only-size 32x16"] {
            assert!(error.contains(part), "{part}: {error}");
        }
        let only = Asked { only_size: Some(ImageSize { width: 48, height: 16 }), ..asked };
        let reader = Reader::of(&photos, only).unwrap();
        assert_eq!(reader.photos(), [photos[2].clone(), photos[4].clone()]);
        assert!(reader.notes()[0].contains("4 of 6"));
        let none = Asked { only_size: Some(ImageSize { width: 1, height: 1 }), ..asked };
        assert!(matches!(Reader::of(&photos, none), Err(PhotographsError::NoneOfSize(_))));
    }
}
