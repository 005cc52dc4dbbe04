//! Free networks and rigs of the project's own scenarios: what they say of themselves, held against the truth.

use calibench_records::figures::Quantity;
use calibench_scenario::Scenario;

use super::own::{self, figures, there, value};
use super::trials;

fn network(name: &str, changes: &[(&str, &str)]) -> Scenario {
    own::scenario(&format!("networks/{name}"), changes)
}

/// Errors are within six of their standard deviations, residuals those of the noise, and no minimum is wrong.
#[test]
fn what_networks_say_of_themselves_is_so() {
    if !there("networks") {
        return;
    }
    for name in ["free", "rig"] {
        let mut squares = 0.0;
        for trial in trials(&network(name, &[("trials = 10", "trials = 2")]), 2) {
            let cost = value(&trial, Quantity::CostOverRedundancy);
            assert!((0.8..1.2).contains(&cost), "{name}: {cost}");
            assert_eq!((value(&trial, Quantity::IsWrongMinimum), value(&trial, Quantity::IsDoubtful)), (0.0, 0.0), "{name}");
            squares += value(&trial, Quantity::SquareOverCovariance);
            assert!(value(&trial, Quantity::SquareOfLengths) < 9.0, "{name}");
            let estimated: Vec<_> = figures(&trial).iter().filter_map(|figure| Some((figure.error?, figure.sigma?))).collect();
            assert!(estimated.len() >= 3 && estimated.iter().all(|(error, sigma)| error.abs() < 6.0 * sigma), "{name}: {estimated:?}");
        }
        assert!((0.2..3.0).contains(&(squares / 2.0)), "{name}: {squares}");
    }
}

/// A standard deviation that is told half as large makes twice the residuals of it; the covariance follows the residuals and stays true.
#[test]
fn a_precision_that_is_wrong_shows_in_the_cost_alone() {
    if !there("networks") {
        return;
    }
    let told = |changes: &[(&str, &str)]| trials(&network("rig", &[&[("trials = 10", "trials = 1")], changes].concat()), 1).swap_remove(0);
    let (right, half) = (told(&[]), told(&[("noise_px = 0.1", "noise_px = 0.1\nsigma_px = 0.05")]));
    assert!((value(&half, Quantity::CostOverRedundancy) / value(&right, Quantity::CostOverRedundancy) - 4.0).abs() < 1e-6);
    let squares = [&right, &half].map(|trial| value(trial, Quantity::SquareOverCovariance));
    assert!((squares[0] / squares[1] - 1.0).abs() < 1e-4, "{squares:?}");
}

/// A model that the true camera has no parameters of has no truth.
#[test]
fn a_camera_that_is_none_of_the_model_is_said() {
    if !there("networks") {
        return;
    }
    let scenario = network("rig", &[("trials = 10", "trials = 1"), ("opencv5", "opencv4")]);
    let found = trials(&scenario, 1).swap_remove(0);
    assert!(found.calibrations[0].outcome.as_ref().unwrap_err().contains("[camera] is none of the model opencv4"));
}
