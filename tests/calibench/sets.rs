//! Photographs as a set: copies, orientations, sizes, levels.

use std::path::Path;

use calibench_images::{encode_png, read_photo};
use image::ImageEncoder;

use crate::judge::{board, judge};
use crate::project::{run, stderr, stdout};

fn calibrated(folder: &Path, images: &[String], more: &[&str]) -> std::process::Output {
    // The model of the rendered camera: it folds nowhere in the frame.
    let arguments: Vec<&str> = ["calibrate", "-q", "--chessboard", "9x6:25", "--model", "photogrammetric", "--pitch", "7"]
        .into_iter()
        .chain(images.iter().map(String::as_str))
        .chain(more.iter().copied())
        .collect();
    run(folder, &arguments)
}

/// The row of a parameter: its value and its standard deviations.
fn row(text: &str) -> String {
    text.lines().find(|line| line.starts_with("| x0")).unwrap_or_else(|| panic!("{text}")).to_owned()
}

/// The level, less what `change` does, of a photograph that is written anew with 16 bits and an orientation.
fn rewritten(folder: &Path, from: &str, to: &str, orientation: u8, change: impl Fn(f32) -> f32) -> String {
    let image = read_photo(&folder.join(from)).unwrap().image;
    let bytes: Vec<u8> = image.grey().iter().flat_map(|grey| ((change(*grey) * 65535.0).round() as u16).to_ne_bytes()).collect();
    let exif = [77, 77, 0, 42, 0, 0, 0, 8, 0, 1, 1, 18, 0, 3, 0, 0, 0, 1, 0, orientation, 0, 0, 0, 0, 0, 0];
    let mut file = Vec::new();
    let mut encoder = image::codecs::png::PngEncoder::new(&mut file);
    encoder.set_exif_metadata(exif.to_vec()).unwrap();
    encoder.write_image(&bytes, image.width() as u32, image.height() as u32, image::ExtendedColorType::L16).unwrap();
    std::fs::write(folder.join(to), file).unwrap();
    to.to_owned()
}

#[test]
fn a_photograph_and_its_copies_are_one() {
    let folder = tempfile::tempdir().unwrap();
    let images = board(folder.path());
    let once = calibrated(folder.path(), &images, &[]);
    // The same bytes under another name, and the same picture with 8 bits.
    let mut copies = images.clone();
    for (index, name) in images.iter().enumerate() {
        let copy = format!("copy{index}.png");
        if index.is_multiple_of(2) {
            std::fs::copy(folder.path().join(name), folder.path().join(&copy)).unwrap();
        } else {
            let image = read_photo(&folder.path().join(name)).unwrap().image;
            encode_png(&mut std::fs::File::create(folder.path().join(&copy)).unwrap(), &image, false).unwrap();
        }
        copies.push(copy);
    }
    let twice = calibrated(folder.path(), &copies, &[]);
    assert_eq!((once.status.code(), twice.status.code()), (Some(0), Some(3)), "{}", stderr(&twice));
    assert_eq!(row(&stdout(&once)), row(&stdout(&twice)));
    for index in 0..images.len() {
        assert!(stderr(&twice).contains(&format!("copy{index}.png shows the board where")), "{}", stderr(&twice));
    }
    let more = ["-m", "parametric_corner", "--model", "opencv4", "--splits", "3"];
    let (once, twice) = (judge(folder.path(), &images, &more), judge(folder.path(), &copies, &more));
    assert_eq!((stdout(&once), twice.status.code()), (stdout(&twice), Some(3)), "{}", stderr(&twice));
}

#[test]
fn a_sensor_does_not_turn() {
    let folder = tempfile::tempdir().unwrap();
    let images = board(folder.path());
    let all = |orientations: [u8; 2]| -> Vec<String> {
        let one =
            |(index, name): (usize, &String)| rewritten(folder.path(), name, &format!("{index}.png"), orientations[index % 2], |grey| grey);
        images.iter().enumerate().map(one).collect()
    };
    let upright = row(&stdout(&calibrated(folder.path(), &images, &[])));
    for (orientations, more, is_same) in
        [([1, 6], &[][..], true), ([1, 3], &[], true), ([3, 6], &[], true), ([3, 3], &["--ignore-orientation"], true), ([3, 3], &[], false)]
    {
        let found = calibrated(folder.path(), &all(orientations), more);
        assert_eq!(found.status.code(), Some(0), "{orientations:?}: {}", stderr(&found));
        assert_eq!(row(&stdout(&found)) == upright, is_same, "{orientations:?}: {}", stdout(&found));
    }
}

/// Methods with 8 bits a pixel are given what a camera with 12 bits saw, whatever the file is made for.
#[test]
fn levels_of_twelve_bits_are_those_of_sixteen() {
    let folder = tempfile::tempdir().unwrap();
    let images = board(folder.path());
    let of = |share: f32| -> Vec<String> {
        let one = |(index, name): (usize, &String)| rewritten(folder.path(), name, &format!("{index}.png"), 1, |grey| grey * share);
        images.iter().enumerate().map(one).collect()
    };
    let more = ["-m", "chess_corners", "--model", "opencv4", "--splits", "3"];
    let judged = |share: f32| judge(folder.path(), &of(share), &more);
    let holdout = |text: &str| -> f64 {
        let (_, after) = text.split_once("took no part in the calibration to ").unwrap_or_else(|| panic!("{text}"));
        after.split_whitespace().next().unwrap().parse().unwrap()
    };
    let (whole, twelve) = (judged(1.0), judged(4095.0 / 65535.0));
    assert!(stderr(&twelve).contains("read as 12 bits") && !stderr(&whole).contains("bits"), "{}", stderr(&twelve));
    let (whole, twelve) = (holdout(&stdout(&whole)), holdout(&stdout(&twelve)));
    assert!((twelve / whole - 1.0).abs() < 0.1, "{twelve}, {whole}");
}
