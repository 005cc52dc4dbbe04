//! Standard deviations mean what they say: many trials with noise on everything that is observed.

use calibench_adjust::{Centre, Covariances, ImageObservation, Network, Options, Status, Variance, adjust};
use calibench_model::camera::CameraModel;
use nalgebra::{DMatrix, DVector, Rotation3, Vector3};
use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor, Normal};

use crate::networks;

const TRIALS: usize = 4000;
const SIGMA: f64 = 0.05;
const ALPHA: f64 = 0.01;
const FREE: [&str; 4] = ["c", "x0", "y0", "k1"];

/// Six images of fourteen points: five of them weighted control, the others tie points; c and one centre observed.
fn truth() -> Network {
    let mut network = networks::ring_from(networks::photogrammetric(), 4.2, 6, 14, 21);
    networks::free(&mut network, &FREE);
    networks::control(&mut network, 3, 1e-3);
    network.cameras[0] = network.cameras[0].clone().observed("c", 24.3, 0.01).unwrap();
    network.images[1].centre = Centre::Observed { value: network.images[1].pose.centre, sigma: [2e-3; 3] };
    network.observations.iter_mut().for_each(|o| *o = ImageObservation::new(o.image, o.point, o.position, SIGMA));
    network
}

/// Everything that is observed, drawn anew around the truth.
fn drawn(truth: &Network, seed: u64) -> Network {
    let (mut random, mut network) = (networks::random(seed), truth.clone());
    networks::shake_pixels(&mut network, SIGMA, &mut random);
    let mut draw = |status: &mut Status| {
        if let Status::Observed { value, sigma } = status {
            *value += *sigma * networks::normal(&mut random);
        }
    };
    network.cameras[0].parameters.iter_mut().for_each(&mut draw);
    network.points.iter_mut().for_each(|point| point.coordinates.iter_mut().for_each(&mut draw));
    if let Centre::Observed { value, sigma } = &mut network.images[1].centre {
        (0..3).for_each(|i| value[i] += sigma[i] * networks::normal(&mut random));
    }
    network
}

/// Errors and their covariance.
type Group = (DVector<f64>, DMatrix<f64>);

/// Errors and covariances of one trial, group by group: interior orientation, images, points.
struct Trial {
    groups: Vec<Group>,
    factor: f64,
}

fn trial(truth: &Network, seed: u64) -> (Trial, i64) {
    let network = drawn(truth, seed);
    let solution = adjust(&network, &Options::default()).unwrap_or_else(|error| panic!("{seed}: {error}"));
    let Covariances { interior, poses, points, .. } = solution.covariances(Variance::Apriori).unwrap();
    let values = |camera: &calibench_model::camera::Camera| camera.parameters().iter().map(|p| p.value).take(4).collect::<Vec<_>>();
    let (found, real) = (values(&solution.cameras()[0]), values(&truth.cameras[0].camera));
    let mut groups = vec![(DVector::from_fn(4, |i, _| found[i] - real[i]), interior)];
    for ((pose, image), covariance) in solution.poses().iter().zip(&truth.images).zip(poses) {
        let shift: Vector3<f64> = pose.centre - image.pose.centre;
        let turn = Rotation3::from_matrix_unchecked(pose.rotation * image.pose.rotation.transpose());
        let m = turn.matrix();
        let turn = Vector3::new(m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]) * 0.5;
        let error = DVector::from_iterator(6, shift.iter().chain(turn.iter()).copied());
        groups.push((error, DMatrix::from_iterator(6, 6, covariance.iter().copied())));
    }
    for ((found, real), covariance) in solution.points().iter().zip(&truth.points).zip(points) {
        let error: Vector3<f64> = found - real.position;
        groups.push((DVector::from_iterator(3, error.iter().copied()), DMatrix::from_iterator(3, 3, covariance.iter().copied())));
    }
    (Trial { groups, factor: solution.variance_factor(Variance::Estimated).unwrap() }, solution.counts().redundancy())
}

/// Kolmogorov and Smirnov's probability of values further from `cdf`.
fn from_distribution(mut values: Vec<f64>, cdf: impl Fn(f64) -> f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len() as f64;
    let gap = |(i, x): (usize, &f64)| (cdf(*x) - i as f64 / n).max((i + 1) as f64 / n - cdf(*x));
    let largest = values.iter().enumerate().map(gap).fold(0.0, f64::max);
    let lambda = largest * (n.sqrt() + 0.12 + 0.11 / n.sqrt());
    let term = |k: i32| if k % 2 == 1 { 2.0 } else { -2.0 } * (-2.0 * f64::from(k * k) * lambda * lambda).exp();
    (1..=100).map(term).sum::<f64>().clamp(0.0, 1.0)
}

/// The smallest p-value of all tests, times their number: below `ALPHA`, Holm rejects. Covariances are scaled by `factor`.
fn holm(trials: &[Trial], redundancy: f64, factor: f64) -> f64 {
    let mut all = Vec::new();
    for group in 0..trials[0].groups.len() {
        let size = trials[0].groups[group].0.len();
        let distance = |trial: &Trial| {
            let (error, covariance) = &trial.groups[group];
            error.dot(&covariance.clone().cholesky().expect("a covariance").solve(error)) / factor
        };
        let squares: Vec<f64> = trials.iter().map(distance).collect();
        let (chi, fisher) = (ChiSquared::new(size as f64).unwrap(), FisherSnedecor::new(size as f64, redundancy).unwrap());
        let estimated = squares.iter().zip(trials).map(|(square, trial)| square / (trial.factor * size as f64)).collect();
        all.push(from_distribution(squares, |x| chi.cdf(x)));
        all.push(from_distribution(estimated, |x| fisher.cdf(x)));
        for i in 0..size {
            let sum: f64 = trials.iter().map(|t| t.groups[group].0[i] / (factor * t.groups[group].1[(i, i)]).sqrt()).sum();
            all.push(2.0 * Normal::standard().sf((sum / (trials.len() as f64).sqrt()).abs()));
        }
    }
    all.iter().fold(1.0, |a: f64, b| a.min(*b)) * all.len() as f64
}

#[test]
fn sigmas_are_honest() {
    let truth = truth();
    let (trials, redundancy): (Vec<Trial>, Vec<i64>) = (0..TRIALS).map(|i| trial(&truth, 1_000_000 + i as u64)).unzip();
    let redundancy = redundancy[0] as f64;
    let p = holm(&trials, redundancy, 1.0);
    assert!(p > ALPHA, "smallest p-value times tests: {p}");
    for factor in [1.1 * 1.1, 1.0 / (1.1 * 1.1)] {
        let p = holm(&trials, redundancy, factor);
        assert!(p < ALPHA, "sigmas off by 1.1 pass: {p}");
    }
    for group in 0..trials[0].groups.len() {
        for i in 0..trials[0].groups[group].0.len() {
            let of = |value: &dyn Fn(&Group) -> f64| {
                (trials.iter().map(|trial| value(&trial.groups[group])).sum::<f64>() / trials.len() as f64).sqrt()
            };
            let (empirical, predicted) = (of(&|(error, _)| error[i] * error[i]), of(&|(_, covariance)| covariance[(i, i)]));
            assert!((empirical / predicted - 1.0).abs() < 0.05, "group {group}, {i}: {empirical:e} for {predicted:e}");
        }
    }
}
