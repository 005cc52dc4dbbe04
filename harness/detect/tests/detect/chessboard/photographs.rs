//! Photographs that others made. They are no part of the project; where they are missing a test says so and ends.

use std::path::{Path, PathBuf};

use calibench_model::Image;

use super::chessboard;

fn photographs(folder: &str, extension: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data").join(folder);
    let Ok(files) = std::fs::read_dir(&folder) else {
        eprintln!("skipped: there is no {}", folder.display());
        return Vec::new();
    };
    let mut all: Vec<PathBuf> =
        files.map(|file| file.unwrap().path()).filter(|path| path.extension().is_some_and(|own| own == extension)).collect();
    all.sort();
    all
}

fn read(path: &Path) -> Image<'static> {
    let read = image::open(path).unwrap().to_luma32f();
    Image::new(read.width() as usize, read.height() as usize, read.into_raw())
}

/// Finds the board in all photographs, and none that has other counts.
fn check(folder: &str, extension: &str, columns: usize, rows: usize) {
    for path in photographs(folder, extension) {
        let image = read(&path);
        let found = chessboard(&image, columns, rows).unwrap_or_else(|| panic!("{}: not found", path.display()));
        // Pictures of the board on a screen are smaller.
        let (least, greatest) = found.iter().fold((f64::INFINITY, 0.0), |(l, g), at| (at.x.min(l), at.x.max(g)));
        assert!(greatest - least > 90.0, "{}: {least} to {greatest}", path.display());
        for (columns, rows) in [(columns - 1, rows), (columns, rows - 1), (columns + 1, rows)] {
            assert_eq!(chessboard(&image, columns, rows), None, "{}: {columns} x {rows}", path.display());
        }
    }
}

#[test]
fn the_board_of_the_left_camera_is_found() {
    check("opencv-left", "jpg", 9, 6);
}

#[test]
fn the_board_of_the_webcam_is_found() {
    check("webcam", "png", 10, 10);
}
