//! Cameras that measure: whether what is said of their lengths is so.

use calibench_records::figures::Quantity;
use calibench_records::results::{Trial, find};

use super::own::{figures, scenario, there, value};
use super::trials;

const WAYS: [&str; 4] = ["poses stated", "poses from the board", "before a plane", "all"];

fn of(trial: &Trial, quantity: Quantity, way: &str) -> f64 {
    find(figures(trial), quantity.of(&[way])).unwrap_or_else(|| panic!("{quantity:?} {way}")).value
}

fn mean(all: &[Trial], quantity: Quantity, way: &str) -> f64 {
    all.iter().map(|trial| of(trial, quantity, way)).sum::<f64>() / all.len() as f64
}

/// Twelve cameras with twenty lengths each, which share its errors.
#[test]
fn intervals_hold_the_truth() {
    if !there("tasks") {
        return;
    }
    let all = trials(&scenario("tasks/lengths", &[("trials = 40", "trials = 12")]), 12);
    for way in WAYS {
        let (squares, within) = (mean(&all, Quantity::SquareOfTasks, way), mean(&all, Quantity::TasksWithin, way));
        assert!((0.6..1.6).contains(&squares) && within > 0.85, "{way}: {squares} {within}");
    }
    assert!(all.iter().all(|trial| value(trial, Quantity::CostOverRedundancy) < 1.3));
}

/// What errs ten times as much is measured as much worse, and said to be: the draws are those of before.
#[test]
fn what_boards_and_poses_err_is_in_both() {
    if !there("tasks") {
        return;
    }
    let of_change = |change: (&str, &str)| trials(&scenario("tasks/lengths", &[("trials = 40", "trials = 3"), change]), 3);
    let usual = of_change(("length = 60", "length = 60"));
    let length = |all: &[Trial], way: &str| {
        let figure = |trial: &Trial| find(figures(trial), Quantity::TaskLength.of(&[way])).cloned().unwrap();
        let [error, sigma] = [0, 1].map(|k| all.iter().map(figure).map(|one| [one.error, one.sigma][k].unwrap()).sum::<f64>());
        [error, sigma]
    };
    for (change, way) in [
        (("centre_sigma = 0.05", "centre_sigma = 0.5"), "poses stated"),
        (("board_scale = 2e-4", "board_scale = 5e-3"), "poses from the board"),
        (("plane_sigma = 0.05", "plane_sigma = 3"), "before a plane"),
    ] {
        let [before, after] = [length(&usual, way), length(&of_change(change), way)];
        let grown = [0, 1].map(|k| after[k] / before[k]);
        assert!(grown.iter().all(|times| (1.4..30.0).contains(times)), "{change:?}: {grown:?}");
        assert!((0.4..2.5).contains(&(grown[0] / grown[1])), "{change:?}: {grown:?}");
    }
}

/// A camera that is none of the model asked for is said.
#[test]
fn what_cannot_be_calibrated_has_a_reason() {
    if !there("tasks") {
        return;
    }
    for (change, message) in [
        (("opencv5", "opencv4"), "[camera] is none of the model opencv4"),
        // No station has a twin that is far enough from it.
        (
            ("count = 12\ndistance = [350, 550]", "count = 6\ndistance = [900, 910]\nsees = 1"),
            "no length of 60 mm and more was measured (poses stated)",
        ),
    ] {
        let changes = [("trials = 40", "trials = 1"), change, ("tilt = 40", "tilt = 8")];
        let found = trials(&scenario("tasks/lengths", &changes), 1).swap_remove(0);
        let why = found.calibrations[0].outcome.as_ref().unwrap_err();
        assert!(why.contains(message), "{message}: {why}");
    }
}
