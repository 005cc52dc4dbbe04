//! Inputs that are something else than they say, and whether what they are is named.

use calibench_calibrate::{Settings, Suspected};
use calibench_model::PixelPoint;
use rayon::prelude::*;

use crate::network::{SIZE, board, lens, settings};
use crate::planted::{Input, MISTAKEN, SOUND, among_control, asked, dense, examined, filled, moved, noisy, of_size, of_tags, suspects};

/// Draws of each mistake, and of each kind that is none; `benches/doubts.rs` has 100 and 1000.
const DRAWS: [u64; 2] = [6, 3];

#[test]
fn planted_mistakes_are_named_first() {
    for (kind, (what, draw)) in MISTAKEN {
        let found: Vec<Vec<Suspected>> = (0..DRAWS[0]).into_par_iter().map(|seed| suspects(&draw(seed))).collect();
        let is_first = |found: &&Vec<Suspected>| found.first().is_some_and(|first| first.kind == kind);
        assert!(found.iter().all(|found| is_first(&found)), "{what}: {:?}", found.iter().find(|found| !is_first(found)));
    }
}

#[test]
fn of_what_is_as_it_says_nothing_is_suspected() {
    for (what, draw) in SOUND {
        let found: Vec<_> = (0..DRAWS[1]).into_par_iter().map(|seed| examined(&draw(seed))).collect();
        assert!(
            found.iter().all(|found| found.as_ref().is_ok_and(|(doubts, suspects)| *doubts == 0 && suspects.is_empty())),
            "{what}: {found:?}"
        );
    }
}

/// A lens whose axes have two scales, for a model with one, is no fisheye.
#[test]
fn a_model_with_too_few_parameters_is_no_fisheye() {
    let scene = noisy(board(lens()), 5);
    let input = (scene.points(), scene.known(), settings("photogrammetric"));
    let (doubts, suspects) = asked(&input).unwrap();
    assert!(doubts > 0 && suspects.is_empty(), "{suspects:?}");
}

fn first(input: &Input) -> Suspected {
    suspects(input).swap_remove(0)
}

#[test]
fn what_is_named_has_its_estimate() {
    let spacing = first(&(of_tags(18.0, 3).points(), of_tags(15.0, 3).known(), settings("opencv5")));
    assert!(spacing.what.contains("is 0.300 of a tag's side, and 0.250 is stated"), "{spacing:?}");
    assert!(spacing.rms_px.unwrap() < 0.2 && spacing.words().contains("px RMS then"), "{spacing:?}");
    let crop = first(&of_size(&noisy(filled(), 1), [2000, 1500]));
    assert!(crop.what.contains("of about 16") && crop.what.contains("2000 x 1500 px is stated"), "{crop:?}");
    let scale = first(&(among_control(97.0, 3).0, among_control(100.0, 3).1, settings("opencv5")));
    assert!(scale.what.contains("0.970 times as large") && scale.what.contains("97.0 from one corner"), "{scale:?}");
}

#[test]
fn where_pixels_are_counted_from_is_named_where_points_lie_at_the_border() {
    let input = of_size(&noisy(dense(), 1), [SIZE.width - 1, SIZE.height - 1]);
    // Points between 0 and the width are those of the outer corner, points between a half and a half more those from 1.
    for (by, word) in [(0.0, "from the outer corner of the first pixel:"), (0.5, "counted from 1:")] {
        let (points, control, settings): (_, _, &Settings) =
            (moved(&input.0, |at| PixelPoint::new(at.x + by, at.y + by)), &input.1, &input.2);
        let found = suspects(&(points, control.clone(), settings.clone()));
        assert!(found.len() == 1 && found[0].kind == "origin" && found[0].what.contains(word), "{by}: {found:?}");
    }
}

#[test]
fn a_board_that_stands_elsewhere_is_none_of_another_size() {
    // So small a board that its size is hardly seen.
    for seed in 0..8 {
        let (points, mut control) = among_control(6.0, seed);
        control.iter_mut().filter(|row| row.target.starts_with('r')).for_each(|row| row.position[0] += 8.0);
        let (doubts, suspects) = asked(&(points, control, settings("opencv5"))).unwrap();
        assert!(doubts > 0 && suspects.iter().all(|found| found.kind != "scale"), "{seed}: {suspects:?}");
    }
}

#[test]
fn a_principal_point_that_is_held_tells_of_no_crop() {
    let (points, control, free) = of_size(&noisy(filled(), 1), [2000, 1500]);
    let calibench_model::camera::Camera::OpenCv(truth) = lens() else { panic!("a pinhole") };
    let start = calibench_model::camera::OpenCv { size: free.cameras[0].size, ..truth };
    let mut held = free.clone();
    held.cameras[0].solve = Some(["fx", "fy", "k1", "k2", "k3", "p1", "p2"].map(String::from).to_vec());
    held.cameras[0].start = Some(start.into());
    let doubts = |settings| examined(&(points.clone(), control.clone(), settings)).unwrap().0;
    assert_eq!((doubts(free), doubts(held)), (1, 0));
}
