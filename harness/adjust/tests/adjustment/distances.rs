//! Observed distances: the scale of a free network, and observations like others.

use calibench_adjust::{AdjustError, Datum, DistanceObservation, Network, Options, Solution, Test, Variance, adjust};
use nalgebra::{DMatrix, DVector, Vector3};

use crate::networks;

/// A ring of images with so many targets; free networks of few targets keep the points, those of many the poses.
fn ring(points: usize) -> Network {
    let mut network = networks::ring(networks::photogrammetric(), 6, points, 6);
    networks::free(&mut network, &["c", "x0", "y0"]);
    networks::shake_pixels(&mut network, 0.3, &mut networks::random(3));
    network
}

/// Measured with so many deviations of `sigma`.
fn distance(network: &Network, points: [usize; 2], sigma: f64, off: f64) -> DistanceObservation {
    let [from, to] = points.map(|point| network.points[point].position);
    DistanceObservation { points, value: (to - from).norm() + off * sigma, sigma }
}

fn with_bars(mut network: Network) -> Network {
    let ends = [[0, 9], [4, 13], [9, 4], [2, 17]];
    network.distances = ends.into_iter().zip([0.4, -1.1, 0.7, 0.2]).map(|(ends, off)| distance(&network, ends, 1e-3, off)).collect();
    network
}

/// White residuals of the whole network where its unknowns have changed.
fn residuals(network: &Network, solution: &Solution<'_>, change: &DVector<f64>) -> DVector<f64> {
    use calibench_model::camera::CameraModel;
    let names = ["c", "x0", "y0"];
    let mut values: Vec<f64> = solution.cameras()[0].parameters().iter().map(|parameter| parameter.value).collect();
    for (k, name) in names.iter().enumerate() {
        let place = solution.cameras()[0].parameters().iter().position(|parameter| parameter.name == *name).unwrap();
        values[place] += change[k];
    }
    let camera = solution.cameras()[0].with_parameters(&values);
    let mut poses = solution.poses().to_vec();
    for (i, pose) in poses.iter_mut().enumerate() {
        let at = |k: usize| change[3 + 6 * i + k];
        pose.centre += Vector3::new(at(0), at(1), at(2));
        pose.rotation = *nalgebra::Rotation3::new(Vector3::new(at(3), at(4), at(5))).matrix() * pose.rotation;
    }
    let first = 3 + 6 * poses.len();
    let point = |i: usize| solution.points()[i] + Vector3::from_fn(|k, _| change[first + 3 * i + k]);
    let mut found = Vec::new();
    for o in &network.observations {
        let pixel = camera.project(poses[o.image].ray(&point(o.point))).unwrap();
        found.extend(o.precision.whitened([pixel.x - o.position.x, pixel.y - o.position.y]));
    }
    for o in &network.distances {
        found.push(((point(o.points[1]) - point(o.points[0])).norm() - o.value) / o.sigma);
    }
    for (i, known) in network.points.iter().enumerate() {
        for (k, status) in known.coordinates.iter().enumerate() {
            if let calibench_adjust::Status::Observed { value, sigma } = status {
                found.push((point(i)[k] - value) / sigma);
            }
        }
    }
    DVector::from_vec(found)
}

/// Sum of squares, gradient and covariances by differences of the whole of it.
#[test]
fn it_is_the_minimum_and_its_inverse_that_differences_find() {
    for points in [18, 40] {
        let mut network = with_bars(ring(points));
        networks::control(&mut network, 3, 1e-2);
        let solution = adjust(&network, &Options::default()).unwrap();
        let size = 3 + 6 * network.images.len() + 3 * points;
        let here = residuals(&network, &solution, &DVector::zeros(size));
        assert!((here.norm_squared() / solution.cost() - 1.0).abs() < 1e-10);
        let column = |k: usize| {
            let step = 1e-5;
            let at = |by: f64| residuals(&network, &solution, &DVector::from_fn(size, |i, _| if i == k { by } else { 0.0 }));
            (at(step) - at(-step)) / (2.0 * step)
        };
        let slopes = DMatrix::from_columns(&(0..size).map(column).collect::<Vec<_>>());
        let gradient = slopes.tr_mul(&here);
        let inverse = slopes.tr_mul(&slopes).try_inverse().unwrap();
        let left = gradient.dot(&(&inverse * &gradient));
        assert!(left < 1e-9, "the sum of squares can still fall by {left:e}");
        let full = solution.full_covariance(Variance::Apriori).unwrap();
        for i in 0..size {
            for j in 0..=i {
                let scale = (inverse[(i, i)] * inverse[(j, j)]).sqrt();
                assert!((full[(i, j)] - inverse[(i, j)]).abs() < 1e-5 * scale, "{i}, {j}");
            }
        }
        let (found, reliability) = solution.quality(Variance::Apriori, Test::default()).unwrap();
        for (i, block) in found.points.iter().enumerate() {
            let first = 3 + 6 * network.images.len() + 3 * i;
            assert!((0..9).all(|k| (block[k] - inverse[(first + k % 3, first + k / 3)]).abs() < 1e-5 * block.amax()));
        }
        let redundancy = solution.counts().redundancy() as f64;
        assert!((reliability.redundancy() - redundancy).abs() < 1e-7 * redundancy, "{} {redundancy}", reliability.redundancy());
        for (bar, checked) in network.distances.iter().zip(&reliability.observed[reliability.observed.len() - 4..]) {
            let length = solution.length(bar.points, Variance::Apriori).unwrap();
            assert!((length.value - bar.value - checked.v).abs() < 1e-9);
            assert!((1.0 - (length.sigma / bar.sigma).powi(2) - checked.redundancy).abs() < 1e-8, "{checked:?}");
        }
    }
}

/// One bar only gives the scale: all else is as in the free network.
#[test]
fn one_distance_is_the_scale_of_a_free_network() {
    for points in [18, 40] {
        let bare = Network { datum: Datum::Inner, ..ring(points) };
        let mut scaled = bare.clone();
        let mut bar = distance(&bare, [3, 11], 0.01, 0.0);
        bar.value *= 1.25;
        scaled.distances = vec![bar];
        let (bare, scaled) = (adjust(&bare, &Options::default()).unwrap(), adjust(&scaled, &Options::default()).unwrap());
        assert_eq!((bare.counts().constraints, scaled.counts().constraints), (7, 6));
        assert!((bare.cost() / scaled.cost() - 1.0).abs() < 1e-9);
        let length = |solution: &Solution, ends| solution.length(ends, Variance::Apriori).unwrap();
        assert!((length(&scaled, [3, 11]).value / bar.value - 1.0).abs() < 1e-10);
        assert!((length(&scaled, [3, 11]).sigma / 0.01 - 1.0).abs() < 1e-6);
        let ratio = length(&scaled, [3, 11]).value / length(&bare, [3, 11]).value;
        for ends in [[0, 5], [7, 16], [3, 2]] {
            assert!((length(&scaled, ends).value / length(&bare, ends).value / ratio - 1.0).abs() < 1e-9);
        }
        let interior = |solution: &Solution| solution.covariances(Variance::Apriori).unwrap().interior;
        assert!((interior(&bare) - interior(&scaled)).amax() < 1e-6 * interior(&bare).amax());
        let observed = &scaled.reliability(Test::default()).unwrap().observed;
        assert!(observed.len() == 1 && observed[0].redundancy < 1e-6 && observed[0].what == "the distance from P3 to P11", "{observed:?}");
    }
}

/// Whatever fixes the frame: lengths, their deviations, cameras and the sum of squares are the same.
#[test]
fn lengths_do_not_depend_on_the_datum() {
    let network = |datum: Datum| Network { datum, ..with_bars(ring(24)) };
    let whole = network(Datum::Inner);
    let some = network(Datum::InnerOver(vec![1, 5, 8, 20]));
    let mut control = network(Datum::Control);
    // Six coordinates and no more.
    for (point, axes) in [(0, 0..3), (9, 0..2), (4, 2..3)] {
        axes.for_each(|axis| control.points[point].coordinates[axis] = calibench_adjust::Status::Fixed);
    }
    let solutions = [&whole, &some, &control].map(|network| adjust(network, &Options::default()).unwrap());
    let [a, b, c] = &solutions;
    for other in [b, c] {
        assert!((a.cost() / other.cost() - 1.0).abs() < 1e-9);
        for ends in [[0, 9], [6, 21], [3, 4]] {
            let (expected, found) = (a.length(ends, Variance::Apriori).unwrap(), other.length(ends, Variance::Apriori).unwrap());
            assert!((found.value / expected.value - 1.0).abs() < 1e-9 && (found.sigma / expected.sigma - 1.0).abs() < 1e-6, "{ends:?}");
        }
        assert_eq!(a.counts().redundancy(), other.counts().redundancy());
    }
    // What the constraints look at does not move, and has the smallest trace.
    let moved: Vector3<f64> = [1, 5, 8, 20].iter().map(|&i| b.points()[i] - some.points[i].position).sum();
    assert!(moved.norm() < 1e-9, "{moved}");
    let trace = |solution: &Solution, over: &[usize]| {
        let points = solution.covariances(Variance::Apriori).unwrap().points;
        over.iter().map(|&i| points[i].trace()).sum::<f64>()
    };
    assert!(trace(b, &[1, 5, 8, 20]) < trace(a, &[1, 5, 8, 20]));
    let all: Vec<usize> = (0..24).collect();
    assert!(trace(a, &all) < trace(b, &all) && trace(a, &all) < trace(c, &all));
    let turned = a.in_datum(&some.datum).unwrap();
    assert!(turned.points().iter().zip(b.points()).all(|(a, b)| (a - b).norm() < 1e-8));
    let blocks = |solution: &Solution| solution.covariances(Variance::Apriori).unwrap().points;
    assert!(blocks(&turned).iter().zip(blocks(b)).all(|(a, b)| (a - b).amax() < 1e-6 * b.amax()));
}

/// Mean square of `w`, and of what is wrong with lengths in their own deviations, over many draws.
#[test]
fn lengths_are_as_uncertain_as_they_say() {
    let truth = Network { datum: Datum::Inner, ..networks::ring(networks::photogrammetric(), 6, 18, 6) };
    let (mut squares, mut tests, mut chi, mut redundancy) = (0.0, 0.0, 0.0, 0.0);
    let draws = 200;
    for seed in 0..draws {
        let (mut network, mut random) = (truth.clone(), networks::random(100 + seed));
        networks::shake_pixels(&mut network, 1.0, &mut random);
        let bar = |ends: [usize; 2], random: &mut _| distance(&truth, ends, 2e-3, networks::normal(random));
        network.distances = vec![bar([0, 9], &mut random), bar([4, 13], &mut random)];
        let solution = adjust(&network, &Options::default()).unwrap();
        let length = solution.length([2, 17], Variance::Apriori).unwrap();
        squares += ((length.value - (truth.points[17].position - truth.points[2].position).norm()) / length.sigma).powi(2);
        tests += solution.reliability(Test::default()).unwrap().observed.iter().map(|bar| bar.w * bar.w).sum::<f64>() / 2.0;
        (chi, redundancy) = (chi + solution.cost(), redundancy + solution.counts().redundancy() as f64);
    }
    let draws = draws as f64;
    // Of the mean of 200 squares the deviation is 0.1.
    assert!((squares / draws - 1.0).abs() < 0.3 && (tests / draws - 1.0).abs() < 0.3, "{} {}", squares / draws, tests / draws);
    assert!((chi / redundancy - 1.0).abs() < 0.03, "{}", chi / redundancy);
}

#[test]
fn a_distance_that_is_none_is_refused() {
    let refused = |change: &dyn Fn(&mut Network)| {
        let mut network = Network { datum: Datum::Inner, ..with_bars(ring(18)) };
        change(&mut network);
        match adjust(&network, &Options::default()) {
            Err(error @ (AdjustError::Network(_) | AdjustError::Undetermined(_))) => error.to_string(),
            other => panic!("{other:?}"),
        }
    };
    assert!(refused(&|n| n.distances[1].points[0] = 99).contains("distance 1 refers to point 99"));
    assert!(refused(&|n| n.distances[1].points = [4, 4]).contains("start at one place"));
    assert!(refused(&|n| n.distances[0].sigma = 0.0).contains("the distance from P0 to P9: a standard deviation"));
    assert!(refused(&|n| n.distances[0].value = -1.0).contains("not a positive number"));
    let minimal = Datum::Minimal { horizontal: [0, 7], vertical: [3, 11, 2] };
    assert!(refused(&|n| n.datum = minimal.clone()).contains("so do the distances"));
    let frame = refused(&|n| n.datum = Datum::Control);
    assert!(frame.contains("rotation about X") && !frame.contains("scale"), "{frame}");
}
