use std::path::{Path, PathBuf};

use calibench_model::camera::ImageSize;

use super::exif::Directories;
use super::*;

fn chance(i: usize) -> u32 {
    let mixed = (i as u32).wrapping_mul(0x9e37_79b9) ^ 0x85eb_ca6b;
    (mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d) >> 8
}

fn levels(form: PictureForm) -> PictureLevels {
    let count = form.stride() * form.size.height as usize;
    if form.is_deep {
        PictureLevels::Words((0..count).map(|i| chance(i) as u16).collect())
    } else {
        PictureLevels::Bytes((0..count).map(|i| chance(i) as u8).collect())
    }
}

/// An EXIF block with an orientation, a maker and columns.
fn block(orientation: u16) -> Vec<u8> {
    let maker = exif::Entry { tag: 0x10f, kind: 2, value: b"Maker\0".to_vec() };
    let own = Directories { main: vec![maker], exif: vec![exif::Entry::long(0xa002, &[9])], gps: Vec::new() };
    own.file(vec![exif::Entry::short(0x112, &[orientation])])
}

/// Of a colour profile the part that is looked at.
fn profile(channels: usize) -> Vec<u8> {
    let mut profile = vec![7; 200];
    profile[16..20].copy_from_slice(if channels < 3 { b"GRAY" } else { b"RGB " });
    profile
}

fn written(folder: &Path, form: PictureForm, kind: PictureKind, about: &About) -> PathBuf {
    let path = folder.join(format!("{}-{}-{}.{}", form.channels, form.is_deep, form.size.width, kind.ending()));
    let mut file = Vec::new();
    // In two parts.
    let all = levels(form);
    write_picture::<std::io::Error>(&mut file, form, about, WriteOptions { kind, quality: 95 }, |put| {
        let half = form.size.height as usize / 2 * form.stride();
        let (mut first, mut second) = (all.clone(), all.clone());
        second.forget(half);
        match &mut first {
            PictureLevels::Bytes(levels) => levels.truncate(half),
            PictureLevels::Words(levels) => levels.truncate(half),
        }
        put(&first)?;
        put(&second)
    })
    .unwrap();
    std::fs::write(&path, file).unwrap();
    path
}

fn read(path: &Path, rows: usize) -> (PictureForm, About, PictureLevels) {
    let mut opened = Opened::new(path, false).unwrap();
    let form = opened.form();
    let mut all = PictureLevels::new(form.is_deep);
    for _ in 0..(form.size.height as usize).div_ceil(rows) {
        opened.read(rows, &mut all).unwrap();
    }
    (form, opened.about().clone(), all)
}

#[test]
fn what_is_written_is_read_again_with_what_it_says() {
    let folder = tempfile::tempdir().unwrap();
    for size in [ImageSize { width: 37, height: 23 }, ImageSize { width: 700, height: 402 }] {
        for (channels, is_deep) in (1..=4).flat_map(|channels| [(channels, false), (channels, true)]) {
            let form = PictureForm { size, channels, is_deep };
            let about = About { exif: Some(block(6)), profile: Some(profile(channels)) };
            for kind in [PictureKind::Png, PictureKind::Tiff] {
                // Grey TIFFs with alpha are written and not read.
                let path = written(folder.path(), form, kind, &about);
                if (kind, channels) == (PictureKind::Tiff, 2) {
                    continue;
                }
                let (found_form, found, found_levels) = read(&path, 10);
                assert_eq!(found_form, form, "{kind:?}");
                assert!(found_levels == levels(form), "{kind:?} {form:?}");
                assert_eq!(found.profile, about.profile, "{kind:?} {form:?}");
                let said = Directories::read(&mut std::io::Cursor::new(found.exif.unwrap())).unwrap();
                assert!(said.main[0].value == b"Maker\0" && said.exif == [exif::Entry::long(0xa002, &[size.width])], "{said:?}");
                // Another reader, which looks at the orientation too.
                let other = image::open(&path).unwrap();
                assert_eq!((other.width(), other.height()), (size.width, size.height));
                assert!(crate::photo::head_of(&path).unwrap().turn.is_none());
                if let PictureLevels::Bytes(levels) = levels(form) {
                    assert!(other.as_bytes() == levels, "{kind:?}");
                }
                assert!(Opened::new(&path, false).unwrap().is_in_rows(), "{kind:?} {form:?}");
            }
        }
    }
}

#[test]
fn a_jpeg_keeps_what_it_says() {
    let folder = tempfile::tempdir().unwrap();
    for channels in [1, 3] {
        let form = PictureForm { size: ImageSize { width: 37, height: 23 }, channels, is_deep: false };
        let path = written(folder.path(), form, PictureKind::Jpeg, &About { exif: Some(block(3)), profile: Some(profile(channels)) });
        let (found, about, _) = read(&path, 23);
        assert_eq!((found, about.profile), (form, Some(profile(channels))));
        assert_eq!(Directories::read(&mut std::io::Cursor::new(about.exif.unwrap())).unwrap().main[0].value, b"Maker\0");
        // A profile of other colours is not kept.
        let path = written(folder.path(), form, PictureKind::Jpeg, &About { exif: None, profile: Some(profile(4 - channels)) });
        assert_eq!(read(&path, 23).1, About::default());
    }
    let deep = PictureForm { size: ImageSize { width: 3, height: 3 }, channels: 3, is_deep: true };
    assert!(
        PictureKind::Jpeg.refuses(deep).is_some()
            && PictureKind::Jpeg.refuses(PictureForm { channels: 4, is_deep: false, ..deep }).is_some()
    );
}

#[test]
fn orientations_are_applied_or_left() {
    let folder = tempfile::tempdir().unwrap();
    let form = PictureForm { size: ImageSize { width: 5, height: 3 }, channels: 3, is_deep: false };
    // What `write_picture` makes upright is laid on its side again.
    let path = written(folder.path(), form, PictureKind::Png, &About { exif: Some(block(1)), profile: None });
    let mut file = std::fs::read(&path).unwrap();
    let place = file.windows(4).position(|bytes| bytes == b"eXIf").unwrap();
    let length = u32::from_be_bytes(*file[place - 4..].first_chunk().unwrap()) as usize;
    let turned = block(6);
    assert_eq!(turned.len(), length);
    file[place + 4..place + 4 + length].copy_from_slice(&turned);
    let of_bit = |sum: u32, _: u32| sum >> 1 ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 };
    let sum = !file[place..place + 4 + length].iter().fold(!0, |sum, byte| (0..8).fold(sum ^ u32::from(*byte), of_bit));
    file[place + 4 + length..place + 8 + length].copy_from_slice(&sum.to_be_bytes());
    std::fs::write(&path, file).unwrap();
    let upright = Opened::new(&path, false).unwrap();
    assert_eq!((upright.form().size, upright.turn().is_some()), (ImageSize { width: 3, height: 5 }, true));
    let stored = Opened::new(&path, true).unwrap();
    assert_eq!((stored.form().size, stored.turn().is_some()), (form.size, false));
}

#[test]
fn what_is_cut_short_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let form = PictureForm { size: ImageSize { width: 300, height: 200 }, channels: 3, is_deep: false };
    for kind in [PictureKind::Png, PictureKind::Tiff, PictureKind::Jpeg] {
        let path = written(folder.path(), form, kind, &About::default());
        let whole = std::fs::read(&path).unwrap();
        std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
        let read = Opened::new(&path, false).and_then(|mut opened| opened.read(200, &mut PictureLevels::new(false)));
        assert!(read.is_err(), "{kind:?}");
    }
}
