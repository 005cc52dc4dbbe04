//! Gross errors of image points: what is left out, what is held back, and what standard deviations say then.

use std::collections::BTreeSet;

use calibench_adjust::{Network, Options, Snooping, Solution, Test, Variance, adjust, adjust_robustly, scale_of, snoop};
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

/// A free block whose points are seen from two images up, with noise and what is stated of it; a share of the image points off by 4 to 20 px.
fn block(seed: u64, share: f64, stated: f64) -> (Network, BTreeSet<usize>) {
    let mut network = networks::block(networks::opencv(), [5, 3], [22, 12], seed);
    networks::control(&mut network, 60, 0.05);
    let mut seen = vec![0; network.points.len()];
    network.observations.retain(|o| {
        seen[o.point] += 1;
        o.point % 3 > 0 || seen[o.point] <= 2
    });
    let mut random = networks::random(seed);
    networks::shake_pixels(&mut network, 0.5, &mut random);
    let mut wrong = BTreeSet::new();
    for (index, o) in network.observations.iter_mut().enumerate() {
        o.precision = calibench_adjust::Precision::Sigma(stated);
        let [chosen, length, angle] = [0; 3].map(|_| random.random::<f64>());
        if chosen < share {
            let (length, angle) = (4.0 + 16.0 * length, std::f64::consts::TAU * angle);
            (o.position.x, o.position.y) = (o.position.x + length * angle.cos(), o.position.y + length * angle.sin());
            wrong.insert(index);
        }
    }
    (network, wrong)
}

/// Of points in two images up to ten: by their own covariances residuals have the lengths of two normal numbers, by the noise alone more are long.
#[test]
fn normalised_lengths_are_those_of_two_normal_numbers_however_little_checks() {
    let (mut by_own, mut by_noise) = (Vec::new(), Vec::new());
    for seed in 0..12 {
        let (network, _) = block(seed, 0.0, 0.5);
        let solution = adjust(&network, &Options::default()).unwrap();
        let points = solution.reliability(Test::default()).unwrap().points;
        let one_direction = points.iter().filter(|point| point.redundancy[0] + point.redundancy[1] < 0.51).count();
        assert!(one_direction > 10, "points in two images: {one_direction}");
        by_own.extend(points.iter().filter_map(|point| point.length));
        by_noise.extend(solution.each_white_residual().map(|[x, y]| x.hypot(y)));
    }
    let scale = |lengths: &[f64]| scale_of(lengths.iter().map(|length| [*length, 0.0])).unwrap();
    let beyond = |lengths: &[f64], limit: f64| lengths.iter().filter(|length| **length > limit * scale(lengths)).count() as f64;
    for limit in [1.0, 2.0, 3.0, 3.5] {
        let expected = by_own.len() as f64 * (-0.5_f64 * limit * limit).exp();
        let found = beyond(&by_own, limit);
        assert!((found - expected).abs() < 4.0 * expected.sqrt(), "beyond {limit}: {found} of {}, {expected} expected", by_own.len());
    }
    assert!((scale(&by_own) - 1.0).abs() < 0.02, "{}", scale(&by_own));
    let expected = by_noise.len() as f64 * (-0.5_f64 * 3.5 * 3.5).exp();
    assert!(beyond(&by_noise, 3.5) > expected + 3.0 * expected.sqrt(), "{} {expected}", beyond(&by_noise, 3.5));
}

/// Gross errors are found whatever was said of the precision: a fifth of the truth, or five times as much.
#[test]
fn what_is_gross_together_is_found_under_wrong_standard_deviations() {
    for stated in [0.1, 0.5, 2.5] {
        let (network, wrong) = block(3, 0.03, stated);
        let test = Test { alpha: 1e-3 / network.observations.len() as f64, variance: Variance::Estimated, ..Test::default() };
        let (_, found) = snoop(&network, &Options::default(), Snooping { test, most: 300 }).unwrap();
        let together = found.iter().filter(|found| found.critical == 10.0).count();
        assert!(together > wrong.len() / 3, "{stated}: {together} of {} together", wrong.len());
        // A point of two rays needs both of them.
        let rays = |point: usize| network.observations.iter().filter(|o| o.point == point).count();
        let left_out: BTreeSet<usize> = found.iter().filter(|found| found.left_out).map(|found| found.observation).collect();
        let checked: BTreeSet<usize> = wrong.iter().copied().filter(|&index| rays(network.observations[index].point) >= 4).collect();
        let (missed, lost) = (checked.difference(&left_out).count(), left_out.difference(&wrong).count());
        assert!(checked.len() > 40 && missed <= checked.len() / 20, "{stated}: {missed} of {} missed", checked.len());
        assert!(lost <= wrong.len() / 20, "{stated}: {lost} good points lost");
    }
}
