//! Networks that must keep something.

use calibench_records::figures::Quantity;
use calibench_records::results::Trial;

use super::own::{scenario, there, value};
use super::trials;

const DECIDED: [Quantity; 3] = [Quantity::AcceptancePass, Quantity::AcceptanceFail, Quantity::AcceptanceCannotTell];

fn network(changes: &[(&str, &str)]) -> Trial {
    trials(&scenario("networks/acceptance", &[&[("trials = 10", "trials = 1")], changes].concat()), 1).swap_remove(0)
}

fn decided(trial: &Trial) -> [f64; 3] {
    DECIDED.map(|quantity| value(trial, quantity))
}

/// Limits are twice as wide, and the quotients half as large; what is beyond fails; what the reference does not tell, or a test that lacks a line, is not decided.
#[test]
fn lengths_are_decided_as_accept_decides_them() {
    if !there("networks") {
        return;
    }
    let wide = network(&[("limit = [0.15, 2e-4]", "limit = [2]")]);
    assert_eq!(decided(&wide), [1.0, 0.0, 0.0]);
    let (largest, rms) = (value(&wide, Quantity::LargestLengthError), value(&wide, Quantity::RmsOfLengthErrors));
    assert!(0.0 < rms && rms < largest && largest < 2.0, "{rms} {largest}");
    assert!((value(&wide, Quantity::LargestOverLimit) - largest / 2.0).abs() < 1e-12);
    // A twentieth of the largest error, a fifth of the reference's sigma beyond it.
    let narrow = network(&[("limit = [0.15, 2e-4]", &format!("limit = [{}]", largest / 20.0))]);
    assert_eq!(decided(&narrow), [0.0, 1.0, 0.0]);
    assert_eq!(value(&narrow, Quantity::LargestLengthError), largest);
    let vague = network(&[("limit = [0.15, 2e-4]", "limit = [2]"), ("sigma = 0.005", "sigma = 1.5")]);
    assert_eq!(decided(&vague), [0.0, 0.0, 1.0]);
    let short = network(&[
        ("limit = [0.15, 2e-4]", "limit = [2]"),
        ("    [\"mid/2\", \"mid/5\", \"mid/8\", \"mid/11\", \"mid/14\", \"mid/17\"],\n", ""),
    ]);
    assert_eq!(decided(&short), [0.0, 0.0, 1.0]);
    // Longer than two thirds of the diagonal there is none.
    let small = network(&[("limit = [0.15, 2e-4]", "limit = [2]\nvolume = [2000, 2000, 2000]")]);
    assert_eq!(decided(&small), [0.0, 0.0, 1.0]);
}

/// A length that gave the scale is no test: the line that loses it is not whole.
#[test]
fn what_gave_the_scale_is_no_test() {
    if !there("networks") {
        return;
    }
    let scale =
        network(&[("limit = [0.15, 2e-4]", "limit = [2]"), ("between = [\"left/16\", \"right/3\"]", "between = [\"left/3\", \"left/1\"]")]);
    assert_eq!(decided(&scale), [0.0, 0.0, 1.0]);
}
