//! How photographs are turned before they are measured, in words.

use std::collections::BTreeMap;
use std::path::Path;

use calibench_images::Turn;

/// A line for each orientation that photographs ask for: whether they are turned as they ask, or, if `ignored` was asked for or they are taken `as_stored` because
/// not all ask for the same, that they are not; and a warning where the rows of the sensor are not the rows of every image. Nothing for photographs that stand
/// upright.
pub(crate) fn said(photos: &[(&Path, Option<Turn>)], (ignored, as_stored): (bool, bool)) -> Vec<String> {
    let mut by_turn: BTreeMap<u8, (Option<Turn>, Vec<&Path>)> = BTreeMap::new();
    for (path, turn) in photos {
        by_turn.entry(turn.map_or(1, Turn::exif)).or_insert((*turn, Vec::new())).1.push(path);
    }
    let how = if as_stored { "not turned: pixels are taken as the file has them" } else { "as OpenCV's imread does" };
    let line = |(turn, paths): &(Option<Turn>, Vec<&Path>)| {
        let others = if paths.len() > 1 { format!(" and {} more", paths.len() - 1) } else { String::new() };
        turn.map(|turn| format!("{}{others}: {turn}, {how}", paths[0].display()))
    };
    let mut words: Vec<String> = by_turn.values().filter_map(line).collect();
    if by_turn.len() > 1 && !ignored {
        words.push(if as_stored {
            "not all photographs ask to be turned alike, and the sensor was not turned: the camera is that of the pixels as the files have them, as OpenCV's imread \
             gives them with IMREAD_IGNORE_ORIENTATION"
                .to_owned()
        } else {
            "warning: not all photographs are turned alike; a camera has one interior orientation in one orientation alone: for a calibration, --ignore-orientation \
             here and wherever they are read"
                .to_owned()
        });
    }
    words
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use calibench_model::camera::ImageSize;
    use image::ImageEncoder;
    use image::codecs::png::PngEncoder;

    use crate::reader::{Asked, Reader};

    /// 3 x 2 pixels of levels 10 to 60, row by row.
    fn written(folder: &std::path::Path, name: &str, orientation: u8) -> PathBuf {
        let exif = [77, 77, 0, 42, 0, 0, 0, 8, 0, 1, 1, 18, 0, 3, 0, 0, 0, 1, 0, orientation, 0, 0, 0, 0, 0, 0];
        let mut bytes = Vec::new();
        let mut encoder = PngEncoder::new(&mut bytes);
        encoder.set_exif_metadata(exif.to_vec()).unwrap();
        encoder.write_image(&[10, 20, 30, 40, 50, 60], 3, 2, image::ExtendedColorType::L8).unwrap();
        std::fs::write(folder.join(name), bytes).unwrap();
        folder.join(name)
    }

    #[test]
    fn orientations_are_said_once_each() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b, c] = [("a.png", 6), ("b.png", 6), ("c.png", 1)].map(|(name, orientation)| written(folder.path(), name, orientation));
        let said = |photos: &[PathBuf]| Reader::of(photos, Asked::default()).unwrap().notes().to_vec();
        assert!(said(std::slice::from_ref(&c)).is_empty());
        let alike = said(&[a.clone(), b.clone()]);
        assert_eq!(alike.len(), 1);
        assert!(alike[0].ends_with("a.png and 1 more: EXIF orientation 6, turned by 90 degrees clockwise, as OpenCV's imread does"));
        assert!(said(&[a, b, c])[1].starts_with("warning: not all photographs are turned alike"));
        assert!(Reader::of(&[folder.path().join("none.png")], Asked::default()).is_err());
    }

    /// A sensor does not turn: what its first pixel saw is the first pixel of every image, unless all are turned alike.
    #[test]
    fn photographs_of_one_camera_are_turned_alike_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        for (orientations, ignore, size, first) in [
            ([1, 1], false, (3, 2), [10, 10]),
            ([6, 6], false, (2, 3), [40, 40]),
            ([6, 6], true, (3, 2), [10, 10]),
            ([3, 3], false, (3, 2), [60, 60]),
            ([1, 3], false, (3, 2), [10, 10]),
            ([1, 6], false, (3, 2), [10, 10]),
            ([6, 8], false, (3, 2), [10, 10]),
        ] {
            let photos = [("a.png", orientations[0]), ("b.png", orientations[1])]
                .map(|(name, orientation)| written(folder.path(), name, orientation));
            let reader = Reader::of(&photos, Asked { one_camera: true, ignore_orientation: ignore, ..Asked::default() }).unwrap();
            let found = photos.each_ref().map(|path| reader.read(path).unwrap());
            assert_eq!(reader.sizes(), [ImageSize { width: size.0, height: size.1 }; 2], "{orientations:?}");
            assert_eq!(found.map(|image| image.to_u8()[0]), first, "{orientations:?}");
            let is_mixed = orientations[0] != orientations[1];
            assert_eq!(reader.notes().iter().any(|note| note.contains("the sensor was not turned")), is_mixed, "{:?}", reader.notes());
        }
    }
}
