//! Frames of a board that a camera without distortion takes while it moves.

use calibench_adjust::image_information;
use calibench_model::camera::{CameraModel, OpenCv};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Point3, Vector3};

use super::*;
use crate::Seen;
use crate::information::PARAMETERS;

const SIZE: ImageSize = ImageSize { width: 640, height: 480 };

fn control() -> Vec<ControlRow> {
    let row = |k: usize| ControlRow::new(k.to_string(), [25.0 * (k % 9) as f64 - 100.0, 62.5 - 25.0 * (k / 9) as f64, 0.0]);
    (0..54).map(row).collect()
}

fn camera() -> OpenCv {
    OpenCv { size: SIZE, fx: 600.0, fy: 600.0, cx: 325.0, cy: 235.0, distortion: [0.0; 14], coefficients: 5 }
}

/// The pose of a camera at `centre`, mm, that looks at `target` on the board.
fn pose(centre: [f64; 3], target: [f64; 2]) -> Pose {
    Pose::looking_at(centre.into(), Point3::new(target[0], target[1], 0.0), Vector3::y(), 0.0).unwrap()
}

/// What is seen from there.
fn frame(number: usize, centre: [f64; 3], target: [f64; 2], width: f64) -> Frame {
    let (camera, pose) = (camera(), pose(centre, target));
    let at = |row: &ControlRow| camera.project(pose.ray(&row.position.into())).unwrap();
    let seen = |(target, row): (usize, &ControlRow)| Seen { board: 0, target, at: at(row) };
    Frame { number, seen: control().iter().enumerate().map(seen).collect(), width }
}

/// Two hundred frames before the middle of the board that hardly move, and one of a hundred more that goes around it, tilted and aside.
fn scene() -> Vec<Frame> {
    let still = (0..200).map(|k| frame(k, [0.002 * k as f64, 0.0, 400.0], [0.0, 0.0], 2.5));
    let moving = (200..300).map(|k| {
        let (t, far) = (0.1 * (k - 200) as f64, 300.0 + 2.0 * (k - 200) as f64);
        let aside = [0.7 * far * t.sin(), 0.7 * far * (1.7 * t).cos(), far];
        frame(k, aside, [60.0 * (2.3 * t).sin(), 40.0 * (0.7 * t).sin()], 2.5 + (k % 7) as f64)
    });
    still.chain(moving).collect()
}

/// What is known from some frames.
fn told(frames: &[Frame], places: &[usize]) -> f64 {
    let chosen: Vec<&Frame> = places.iter().map(|&place| &frames[place]).collect();
    let (before, each) = information(&chosen, &control(), SIZE);
    log_determinant(each.into_iter().fold(before, |sum, one| sum + one))
}

#[test]
fn frames_are_sharp_unlike_and_few() {
    let frames = scene();
    let choice = choose(&frames, &control(), SIZE, 12);
    // Edges of 2.5 and 3.5 px are left, of those that move two of seven.
    assert_eq!((choice.limit_px, choice.blurred), (3.75, (200..300).filter(|k| k % 7 > 1).count()));
    assert!(choice.chosen.len() == 12 && choice.chosen.is_sorted_by(|a, b| a < b), "{choice:?}");
    assert!(choice.chosen.iter().all(|&place| frames[place].width < 3.75), "{choice:?}");
    assert!(choice.chosen.iter().filter(|&&place| place < 200).count() <= 1, "the still ones are one: {choice:?}");
    assert_eq!(choice.chosen.len() + choice.blurred + choice.alike + choice.spare, frames.len());
    for (k, &one) in choice.chosen.iter().enumerate() {
        assert!(choice.chosen[..k].iter().all(|&other| apart(&frames[one], &frames[other]).unwrap() > 8.0), "{choice:?}");
    }
    // What is wanted is more than there is.
    let all = choose(&frames, &control(), SIZE, 1000);
    assert!(all.spare == 0 && all.chosen.len() < 40 && all.alike >= 199, "{all:?}");
    assert_eq!(choose(&[], &control(), SIZE, 9), Choice { limit_px: SHARP_PX, ..Choice::default() });
}

#[test]
fn what_is_chosen_tells_more_than_what_is_drawn() {
    let frames = scene();
    let chosen = choose(&frames, &control(), SIZE, 6);
    let best = told(&frames, &chosen.chosen);
    let moving: Vec<usize> = (200..300).filter(|&place| frames[place].width < 3.75).collect();
    // Those that tell most each by itself tell less together.
    let mut alone: Vec<(usize, f64)> = moving.iter().map(|&place| (place, told(&frames, &[place]))).collect();
    alone.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut unlike: Vec<usize> = Vec::new();
    for (place, _) in alone {
        if unlike.len() < 6 && unlike.iter().all(|&other| apart(&frames[other], &frames[place]).unwrap() > 8.0) {
            unlike.push(place);
        }
    }
    assert!(told(&frames, &unlike) < best - 0.1, "{unlike:?} tells as much as {:?}", chosen.chosen);
    // Every place of a multiplicative generator counts once.
    let mut state = 1_usize;
    for _ in 0..200 {
        let drawn: Vec<usize> = (0..6)
            .map(|_| {
                state = state * 48271 % 2_147_483_647;
                moving[state % moving.len()]
            })
            .collect();
        assert!(told(&frames, &drawn) < best, "{drawn:?} tells more than {:?}", chosen.chosen);
    }
}

#[test]
fn what_a_frame_tells_is_that_of_the_camera_that_took_it() {
    let mut frames = scene();
    let (centre, target) = ([150.0, -80.0, 320.0], [20.0, 10.0]);
    frames.push(frame(300, centre, target, 2.5));
    let (_, each) = information(&frames.iter().collect::<Vec<_>>(), &control(), SIZE);
    let points: Vec<Point3<f64>> = control().iter().map(|row| row.position.into()).collect();
    let expected = image_information(&camera().into(), &PARAMETERS, &pose(centre, target), &points, 0.1).unwrap();
    let found = each.last().unwrap();
    assert!((found - &expected).norm() < 1e-3 * expected.norm(), "{found} and {expected}");
}

#[test]
fn boards_that_share_little_are_not_compared() {
    let whole = frame(0, [0.0, 0.0, 400.0], [0.0, 0.0], 2.5);
    let part = |from: usize| Frame { seen: whole.seen[from..].to_vec(), ..whole.clone() };
    assert_eq!(apart(&whole, &part(27)), Some(0.0));
    assert_eq!(apart(&whole, &part(28)), None);
    let mut moved = whole.clone();
    moved.seen.iter_mut().for_each(|seen| seen.at = PixelPoint::new(seen.at.x + 3.0, seen.at.y - 4.0));
    assert!((apart(&whole, &moved).unwrap() - 5.0).abs() < 1e-12);
    moved.seen.iter_mut().for_each(|seen| seen.board = 1);
    assert_eq!(apart(&whole, &moved), None);
}
