//! How photographs are turned before they are measured, in words.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use calibench_exchange::{Turn, turn_of};
use rayon::prelude::*;

use crate::PhotographsError;

/// A line for each orientation that photographs ask for and that reading them applies; and a warning if they are not all turned alike, because the rows of
/// the sensor are then not the rows of every image. Nothing for photographs that stand upright.
///
/// # Errors
/// A photograph that cannot be read.
pub fn turns(photos: &[PathBuf]) -> Result<Vec<String>, PhotographsError> {
    let found = photos.par_iter().map(|path| turn_of(path)).collect::<Result<Vec<_>, _>>()?;
    let mut by_turn: BTreeMap<u8, (Option<Turn>, Vec<&Path>)> = BTreeMap::new();
    for (path, turn) in photos.iter().zip(found) {
        by_turn.entry(turn.map_or(1, Turn::exif)).or_insert((turn, Vec::new())).1.push(path);
    }
    let line = |(turn, paths): &(Option<Turn>, Vec<&Path>)| {
        let others = if paths.len() > 1 { format!(" and {} more", paths.len() - 1) } else { String::new() };
        turn.map(|turn| format!("{}{others}: {turn}, as OpenCV's imread does", paths[0].display()))
    };
    let mut words: Vec<String> = by_turn.values().filter_map(line).collect();
    if by_turn.len() > 1 {
        words.push(
            "warning: not all photographs are turned alike; a camera has one interior orientation in one orientation alone".to_owned(),
        );
    }
    Ok(words)
}

#[cfg(test)]
mod tests {
    use image::ImageEncoder;
    use image::codecs::png::PngEncoder;

    use super::*;

    #[test]
    fn orientations_are_said_once_each() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, orientation: u8| {
            let exif = [77, 77, 0, 42, 0, 0, 0, 8, 0, 1, 1, 18, 0, 3, 0, 0, 0, 1, 0, orientation, 0, 0, 0, 0, 0, 0];
            let mut bytes = Vec::new();
            let mut encoder = PngEncoder::new(&mut bytes);
            encoder.set_exif_metadata(exif.to_vec()).unwrap();
            encoder.write_image(&[0; 6], 3, 2, image::ExtendedColorType::L8).unwrap();
            std::fs::write(folder.path().join(name), bytes).unwrap();
            folder.path().join(name)
        };
        let [a, b, c] = [("a.png", 6), ("b.png", 6), ("c.png", 1)].map(|(name, orientation)| write(name, orientation));
        assert!(turns(std::slice::from_ref(&c)).unwrap().is_empty());
        let said = turns(&[a.clone(), b.clone()]).unwrap();
        assert_eq!(said.len(), 1);
        assert!(said[0].ends_with("a.png and 1 more: EXIF orientation 6, turned by 90 degrees clockwise, as OpenCV's imread does"));
        assert!(turns(&[a, b, c]).unwrap()[1].starts_with("warning: not all photographs are turned alike"));
        assert!(turns(&[folder.path().join("none.png")]).is_err());
    }
}
