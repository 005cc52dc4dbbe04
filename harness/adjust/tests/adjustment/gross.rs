//! Gross errors of image points: what is left out, what is held back, and what standard deviations say then.

use std::collections::BTreeSet;

use calibench_adjust::{Network, Options, Snooping, Solution, Test, Variance, adjust, adjust_robustly, snoop};
use calibench_model::camera::CameraModel;
use rand::RngExt;

use crate::networks;

const SIGMA: f64 = 0.1;
const TRIALS: u64 = 200;

/// A board before a camera, its image points with noise; a share of them off by 3 to 30 px, and which.
fn spoilt(seed: u64, share: f64) -> (Network, BTreeSet<usize>) {
    let mut network = networks::board(networks::opencv(), 9, 7);
    networks::free(&mut network, &networks::FIVE);
    let mut random = networks::random(seed);
    networks::shake_pixels(&mut network, SIGMA, &mut random);
    let mut wrong = BTreeSet::new();
    for (index, o) in network.observations.iter_mut().enumerate() {
        let [chosen, length, angle] = [0; 3].map(|_| random.random::<f64>());
        if chosen < share {
            let (length, angle) = (3.0 + 27.0 * length, std::f64::consts::TAU * angle);
            (o.position.x, o.position.y) = (o.position.x + length * angle.cos(), o.position.y + length * angle.sin());
            wrong.insert(index);
        }
        o.precision = calibench_adjust::Precision::Sigma(SIGMA);
    }
    (network, wrong)
}

/// Mean square of the errors of the camera's parameters by their standard deviations.
fn square(solution: &Solution<'_>) -> f64 {
    let covariances = solution.covariances(Variance::Estimated).unwrap();
    let (found, truth) = (solution.cameras()[0].parameters(), networks::opencv().parameters());
    let of = |(row, (_, name)): (usize, &(usize, &str))| {
        let place = truth.iter().position(|parameter| parameter.name == *name).unwrap();
        (found[place].value - truth[place].value).powi(2) / covariances.interior[(row, row)]
    };
    covariances.parameters.iter().enumerate().map(of).sum::<f64>() / covariances.parameters.len() as f64
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// The points that others check little: left out, they are predicted to no better than their own standard deviation times the root of two.
fn unchecked() -> BTreeSet<usize> {
    let (network, _) = spoilt(0, 0.0);
    let reliability = adjust(&network, &Options::default()).unwrap().reliability(Test::default()).unwrap();
    let little = |redundancy: [f64; 2]| redundancy.into_iter().any(|number| number < 1.0 / 3.0);
    reliability.points.iter().filter(|point| little(point.redundancy)).map(|point| point.observation).collect()
}

/// The league's bounds, where others check the gross points: Huber's weights bound what a residual counts as, and not how far that moves what hangs on it alone.
#[test]
fn standard_deviations_are_honest_under_huber_s_weights() {
    let unchecked = unchecked();
    for share in [0.0, 0.02, 0.1] {
        let one = |seed| {
            let (network, wrong) = spoilt(seed, share);
            wrong.is_disjoint(&unchecked).then(|| square(&adjust_robustly(&network, &Options::default(), 2.0).unwrap().0))
        };
        let checked: Vec<f64> = (0..TRIALS).filter_map(one).collect();
        let found = mean(checked.iter().copied());
        assert!(checked.len() > 40 && (0.85..1.18).contains(&found), "{share} gross: mean square {found} of {}", checked.len());
    }
}

/// What is wrong is left out, what is right stays, and the result is that of the right points alone.
#[test]
fn what_is_left_out_is_what_is_wrong() {
    for share in [0.0, 0.004, 0.02, 0.1, 0.3] {
        let one = |seed| {
            let (network, wrong) = spoilt(seed, share);
            let tests = 2 * network.observations.len();
            let test = Test { alpha: 1e-3 / tests as f64, variance: Variance::Estimated, ..Test::default() };
            let (solution, found) = snoop(&network, &Options::default(), Snooping { test, most: tests }).unwrap();
            let left_out: BTreeSet<usize> = found.iter().filter(|found| found.left_out).map(|found| found.observation).collect();
            assert!(wrong.is_subset(&left_out), "{share} {seed}: {wrong:?} {left_out:?}");
            let without = Options { left_out: wrong.iter().copied().collect(), ..Options::default() };
            let right = square(&adjust(&network, &without).unwrap());
            [(left_out.len() - wrong.len()) as f64, square(&solution), right]
        };
        let all: Vec<[f64; 3]> = (0..60).map(one).collect();
        let [lost, found, right] = [0, 1, 2].map(|k| mean(all.iter().map(|values| values[k])));
        // One of a thousand sets loses a good point.
        assert!(lost < 0.05 && (found / right - 1.0).abs() < 0.02, "{share}: {lost} good points lost, {found} for {right}");
    }
}
