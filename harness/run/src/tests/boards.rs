//! Boards that their detectors find, and what a calibration makes of what is missed.

use calibench_measure::Registry;
use calibench_records::figures::Group;
use calibench_records::results::{Calibrated, Outcome, Trial};
use calibench_scenario::{Scenario, parse};

use super::trials;

/// A board before eight stations; `BOARD` and what stands behind it are replaced.
pub(super) const BOARD: &str = r#"
why = "A board."
source = "ours"
seed = 5
trials = 1

[camera]
size = [640, 480]
pitch = 5.0
c = 4.0

[testfield]
kind = "board"
board = "WORD"
margin = 10

[stations]
kind = "board"
tilts = [[0, 0], [30, 0], [0, -35], [-25, 25]]
distances = [420]
rolls = [0, 80]

[optics]
blur = 0.7

[sensor]
grey_noise = 0.002

[pointing]
detector = "board"

[calibration]
sets = ["c,x0,y0"]
start_c = 4.1
sigma_px = 0.02

[[method]]
name = "METHOD"
"#;

pub(super) fn board(word: &str, method: &str, changes: &[(&str, &str)]) -> Scenario {
    let mut text = BOARD.replace("WORD", word).replace("METHOD", method);
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    parse("small/board", "board.toml", &text, &Registry::builtin()).unwrap_or_else(|problems| panic!("{problems}"))
}

fn first(scenario: &Scenario) -> Trial {
    trials(scenario, 5).swap_remove(0)
}

fn value(calibrated: &Calibrated, group: Group, name: &str) -> Option<f64> {
    let figures = calibrated.outcome.as_ref().unwrap_or_else(|why| panic!("{why}"));
    figures.iter().find(|figure| figure.name.group() == group && figure.name.text() == name).map(|figure| figure.value)
}

/// How far the camera is from the true one over the frame, px, and what is predicted of that.
fn frame(trial: &Trial) -> (f64, f64) {
    let figures = trial.calibrations[0].outcome.as_ref().unwrap();
    let rms = figures.iter().find(|figure| figure.name.group() == Group::Frame).unwrap();
    (rms.value, rms.sigma.unwrap())
}

/// What every kind of board must hold: whole in view it is found whole, measured where it is, and gives the camera.
#[test]
fn every_board_is_pointed_at_by_its_detector() {
    for (word, method) in [
        ("chessboard:7x6:30", "parametric_corner"),
        ("charuco:8x6:30:21:DICT_4X4_50", "parametric_corner"),
        ("aprilgrid:4x3:40:0.3", "parametric_corner"),
        ("gridboard:4x3:40:14:DICT_4X4_50", "parametric_junction"),
        ("circles:8x6:26", "ellipse_edges"),
        ("acircles:4x7:26", "ellipse_edges"),
        ("rings:12:5x4:40:12", "ellipse_edges"),
        ("puzzle:9x7:30:50,100", "parametric_corner"),
        ("dotted:8x6:30", "parametric_corner"),
    ] {
        let found = first(&board(
            word,
            method,
            &[("seed = 5", "seed = 5\nbound_window_discs = 61"), ("sigma_px = 0.02", "sigma_px = 0.02\neccentricity = true")],
        ));
        assert!(found.points.len() >= 8 * 20, "{word}: {}", found.points.len());
        for point in &found.points {
            let Outcome::Measured { error: Some((dx, dy)), .. } = point.outcome else { panic!("{word}: {point:?}") };
            // Of discs it holds the eccentricity.
            assert!(dx.hypot(dy) < 0.25, "{word}: {point:?}");
            // 0.002 of noise on edges of 0.8; a bound about anything but a disc's own middle is some times as large, and so is that of a window that cuts it.
            // Of two half edges in place of four the bound is some five times that of a chess corner (README: 0.0651 and 0.0134 px at the same noise).
            let most = if method == "parametric_junction" { 5.0 * 0.0013 } else { 0.003 };
            assert!(point.bound.is_none_or(|bound| bound < most), "{word}: {point:?}");
        }
        assert!(frame(&found).0 < 0.1, "{word}: {:?}", frame(&found));
        assert_eq!(value(&found.calibrations[0], Group::Network, "images left out"), None, "{word}");
    }
}

#[test]
fn of_a_coded_board_a_part_is_enough_and_of_others_nothing_is_found() {
    // The camera looks past the middle: a part is out of the image.
    let past = [
        (
            "kind = \"board\"\ntilts = [[0, 0], [30, 0], [0, -35], [-25, 25]]\ndistances = [420]\nrolls = [0, 80]",
            "kind = \"random\"\ncount = 6\ndistance = [300, 330]\ntilt = 30\naside = [120, 90]\nsees = 0.3",
        ),
        ("[calibration]\nsets = [\"c,x0,y0\"]\nstart_c = 4.1\nsigma_px = 0.02\n", ""),
    ];
    let counts = |word: &str| {
        let found = first(&board(word, "parametric_corner", &past));
        let measured = found.points.iter().filter(|point| matches!(point.outcome, Outcome::Measured { .. })).count();
        (measured, found.points.len())
    };
    let (of_squares, of_markers) = (counts("chessboard:7x6:30"), counts("charuco:8x7:30:21:DICT_4X4_50"));
    assert!(of_squares.1 > 50 && of_markers.1 > 50, "{of_squares:?} {of_markers:?}");
    assert!(of_squares.0 < of_squares.1 * 9 / 10, "{of_squares:?}");
    assert!(10 * of_markers.0 > 9 * of_markers.1, "{of_markers:?}");
}

/// The centres of discs' pictures move the camera; taken out they do not.
#[test]
fn the_eccentricity_of_discs_is_taken_out_if_asked() {
    let with = |asked: &str| {
        let asked = format!("sigma_px = 0.02\neccentricity = {asked}");
        frame(&first(&board("circles:6x5:45:36", "ellipse_edges", &[("sigma_px = 0.02", &asked)])))
    };
    let (left, taken) = (with("false"), with("true"));
    assert!(left.0 > 10.0 * taken.0 && taken.0 < 4.0 * taken.1, "{left:?} {taken:?}");
}

#[test]
fn images_without_the_board_are_left_out_and_counted() {
    // At 200 mm the board is larger than the image.
    let far = board("chessboard:7x6:30", "parametric_corner", &[("distances = [420]", "distances = [420, 150]")]);
    let found = first(&far);
    assert_eq!(value(&found.calibrations[0], Group::Network, "images left out"), Some(8.0));
    assert!(frame(&found).0 < 0.1);
    let none = board("chessboard:7x6:30", "parametric_corner", &[("distances = [420]", "distances = [150]")]);
    assert_eq!(first(&none).calibrations[0].outcome.as_ref().unwrap_err(), "no image has 6 points or more");
}

/// What the covariance predicts of the camera over the frame is what trials scatter by.
#[test]
fn the_predicted_error_over_the_frame_is_the_one_that_trials_have() {
    let many = [
        ("trials = 1", "trials = 240"),
        ("detector = \"board\"", "sigma = 0\nwhole_pixels = false"),
        ("grey_noise = 0.002", "grey_noise = 0.02"),
    ];
    let drawn = ("sigma_px = 0.02", "sigma_px = 0.1\ndrawn = { \"parametric_corner:window=15\" = 0.1 }");
    let changes: Vec<_> = many.into_iter().chain([drawn]).collect();
    let all = trials(&board("chessboard:7x6:30", "parametric_corner", &changes), 5);
    let (mut error, mut predicted) = (0.0, 0.0);
    for trial in &all {
        let (rms, sigma) = frame(trial);
        error += rms * rms;
        predicted += sigma * sigma;
    }
    let ratio = (error / predicted).sqrt();
    assert!((0.85..1.15).contains(&ratio), "{ratio}");
}
