//! Photographs that others made. They are no part of the project; where they are missing a test says so and ends.

use std::path::{Path, PathBuf};

use calibench_detect::{NotFound, detect};
use calibench_model::Image;

use crate::picture::board;

fn photograph(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/targets").join(name);
    if !path.is_file() {
        eprintln!("skipped: there is no {}", path.display());
        return None;
    }
    Some(path)
}

fn read(path: &Path) -> Image<'static> {
    let read = image::open(path).unwrap().to_luma32f();
    Image::new(read.width() as usize, read.height() as usize, read.into_raw())
}

/// A PuzzleBoard with other codes than those that were published: of its sides along one direction the dots repeat after three across, in all 46 pairs, where the
/// published ones repeat along, and those along the other direction repeat in neither (27 of 47, 27 of 46). It is no part of the pattern in any turn or mirror, nor does
/// another reader know it.
#[test]
fn the_puzzle_board_of_a_photograph_has_other_codes() {
    let Some(path) = photograph("puzzleboard_example0.png") else { return };
    let error = detect(&read(&path), &board("puzzle:501x501:1").0).unwrap_err();
    let NotFound::OtherDots { dots, agreeing } = error else { panic!("{error}") };
    assert!(dots > 50 && 6 * agreeing < 5 * dots, "{error}");
}

#[test]
fn the_aprilgrid_of_a_photograph_is_found_upside_down() {
    let Some(path) = photograph("aprilgrid-rs_EuRoC.png") else { return };
    let (board, layout) = board("aprilgrid:6x6:0.088:0.3");
    let found = detect(&read(&path), &board).unwrap();
    assert!(found.markers >= 35 && found.points.len() == 4 * found.markers, "{} markers", found.markers);
    assert_eq!(found.doubts, []);
    // Places along the board's axes run against those of the image.
    for pair in found.points.windows(2) {
        let [a, b] = [pair[0], pair[1]].map(|point| (layout.points[point.index].at, point.position));
        let (du, dx) = (b.0[0] - a.0[0], b.1.x - a.1.x);
        assert!(du.abs() < 1e-9 || du * dx < 0.0, "{a:?} {b:?}");
    }
}
