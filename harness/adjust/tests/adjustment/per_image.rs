//! Numbers of each image's own beside what its camera shares: the same least squares with all unknowns side by side, trials with truth, and what is refused.

use calibench_adjust::{
    AdjustError, Network, ObjectPoint, OnSurface, Options, PerImage, Solution, Status, Surface, Test, Variance, adjust,
};
use calibench_model::camera::{Camera, CameraModel};
use nalgebra::{DMatrix, DVector, Matrix3, Point3, Rotation3, Vector3};

use super::networks;

const SIGMA: f64 = 0.2;
/// How far principal distance and point of an image are off, px.
const OWN: [f64; 3] = [4.0, 1.5, 0.8];
/// Networks of the trials.
const TRIALS: u64 = 60;
/// Steps of Gauss and Newton from true poses and parameters, at most.
const ITERATIONS: usize = 5;
/// Parameters of [`networks::FIVE`] along which they change the camera.
fn per_image() -> Vec<PerImage> {
    let own = |name: &str, along: &[(usize, f64)], sigma| PerImage { name: name.into(), camera: 0, along: along.to_vec(), sigma };
    vec![own("c", &[(0, 1.0), (1, 1072.0 / 1070.0)], OWN[0]), own("x0", &[(2, 1.0)], OWN[1]), own("y0", &[(3, 1.0)], OWN[2])]
}

fn with_own(camera: &Camera, own: &[f64]) -> Camera {
    let mut values: Vec<f64> = camera.parameters().iter().map(|parameter| parameter.value).collect();
    for (of, value) in per_image().iter().zip(own) {
        of.along.iter().for_each(|(parameter, share)| values[*parameter] += share * value);
    }
    camera.with_parameters(&values)
}

fn bend(point: &Point3<f64>) -> Matrix3<f64> {
    let (u, v) = (point.x / 100.0 - 1.0, point.y / 62.5 - 1.0);
    Matrix3::from_rows(&[[0.0; 3], [0.0; 3], [1.0 - u * u, 1.0 - v * v, u * v]].map(|row| Vector3::from(row).transpose()))
}

/// A board before a camera of which every image has its own principal distance and point; and these.
fn trial(seed: u64, views: usize, bent: bool) -> (Network, Vec<[f64; 3]>) {
    let mut network = networks::board(networks::opencv(), views, 11);
    let mut random = networks::random(seed);
    let own: Vec<[f64; 3]> = network.images.iter().map(|_| OWN.map(|sigma| sigma * networks::normal(&mut random))).collect();
    let flat = network.points.clone();
    let shape = if bent { [0.5, -0.3, 0.2] } else { [0.0; 3] };
    network.points.iter_mut().for_each(|point| point.position += bend(&point.position) * Vector3::from(shape));
    networks::observe(&mut network, SIGMA);
    let truth = network.clone();
    network.observations.iter_mut().for_each(|o| {
        let camera = with_own(&truth.cameras[0].camera, &own[o.image]);
        o.position = camera.project(truth.images[o.image].pose.ray(&truth.points[o.point].position)).expect("pictured");
    });
    networks::shake_pixels(&mut network, SIGMA, &mut random);
    network.points = flat;
    if bent {
        let points = network.points.iter().enumerate().map(|(i, point)| OnSurface { point: i, basis: bend(&point.position) }).collect();
        network.surfaces = vec![Surface { name: "shape".into(), coefficients: [0.0; 3], statuses: [Status::Free; 3], points }];
    }
    networks::free(&mut network, &networks::FIVE);
    network.per_image = per_image();
    (network, own)
}

fn solved(network: &Network) -> Solution<'_> {
    adjust(network, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// White residuals of the image points, then of the own numbers, after a change of all unknowns: parameters, six for each image, its own three, three of the surface.
fn residuals(solution: &Solution<'_>, own: &[[f64; 3]], change: &DVector<f64>) -> DVector<f64> {
    let (network, n) = (solution.network(), networks::FIVE.len());
    let values: Vec<f64> = solution.cameras()[0].parameters().iter().zip(change.iter()).map(|(p, change)| p.value + change).collect();
    let own_of = |image: usize| -> [f64; 3] { std::array::from_fn(|k| own[image][k] + change[n + 9 * image + 6 + k]) };
    let bent = (!network.surfaces.is_empty()).then(|| Vector3::from_fn(|k, _| change[n + 9 * network.images.len() + k]));
    let mut white = Vec::new();
    for o in &network.observations {
        let six = &change.as_slice()[n + 9 * o.image..];
        let pose = &solution.poses()[o.image];
        let turn = Rotation3::new(Vector3::new(six[0], six[1], six[2])) * Rotation3::from_matrix_unchecked(pose.rotation);
        let mut point = solution.points()[o.point];
        if let Some(change) = &bent {
            point += bend(&network.points[o.point].position) * change;
        }
        let along = turn * (point - pose.centre) + Vector3::new(six[3], six[4], six[5]);
        let camera = with_own(&solution.cameras()[0].with_parameters(&values), &own_of(o.image));
        let pixel = camera.project(calibench_model::camera::Ray { x: along.x, y: along.y, z: along.z }).expect("pictured");
        white.extend([(pixel.x - o.position.x) / SIGMA, (pixel.y - o.position.y) / SIGMA]);
    }
    (0..network.images.len()).for_each(|image| (0..3).for_each(|k| white.push(own_of(image)[k] / OWN[k])));
    DVector::from_vec(white)
}

#[test]
fn all_unknowns_side_by_side_say_the_same() {
    for bent in [false, true] {
        let (network, _) = trial(3, 7, bent);
        let solution = solved(&network);
        let numbers = solution.own_numbers(Variance::Apriori).expect("redundant");
        let own: Vec<[f64; 3]> = numbers.chunks(3).map(|of| std::array::from_fn(|k| of[k].value)).collect();
        let size = networks::FIVE.len() + 9 * 7 + if bent { 3 } else { 0 };
        // What a parameter must change by to move a pixel by some thousandths.
        let steps: Vec<f64> = (0..size).map(|k| if k < 4 || (k >= 9 && (k - 9) % 9 >= 3) { 1e-3 } else { 1e-6 }).collect();
        let at = |k: usize, h: f64| residuals(&solution, &own, &DVector::from_fn(size, |i, _| if i == k { h } else { 0.0 }));
        let columns: Vec<DVector<f64>> = (0..size).map(|k| (at(k, steps[k]) - at(k, -steps[k])) / (2.0 * steps[k])).collect();
        let matrix = DMatrix::from_columns(&columns);
        let here = residuals(&solution, &own, &DVector::zeros(size));
        assert!((here.norm_squared() - solution.cost()).abs() < 1e-9 * solution.cost(), "{} {}", here.norm_squared(), solution.cost());
        let cofactors = matrix.tr_mul(&matrix).try_inverse().expect("regular");
        let step = &cofactors * matrix.tr_mul(&here);
        for k in 0..size {
            let sigma = cofactors[(k, k)].sqrt();
            assert!(step[k].abs() < 1e-4 * sigma, "unknown {k} is not at its minimum: {:.1e} of {sigma:.1e}", step[k]);
        }
        let same = |what: &str, a: f64, b: f64| assert!((a / b - 1.0).abs() < 2e-4, "{what}, bent {bent}: {a} {b}");
        let covariances = solution.covariances(Variance::Apriori).expect("redundant");
        (0..9).for_each(|k| same(networks::FIVE[k], covariances.interior[(k, k)], cofactors[(k, k)]));
        for image in 0..7 {
            let rotation = |k: usize| (covariances.poses[image][(3 + k, 3 + k)], cofactors[(9 + 9 * image + k, 9 + 9 * image + k)]);
            (0..3).map(rotation).for_each(|(a, b)| same("rotation", a, b));
        }
        numbers.iter().enumerate().for_each(|(k, number)| {
            let place = 9 + 9 * number.image + 6 + number.of;
            assert_eq!((number.image, number.of), (k / 3, k % 3));
            same("own number", number.sigma.powi(2), cofactors[(place, place)]);
        });
        if bent {
            (0..3).for_each(|k| same("shape", covariances.surfaces[0][(k, k)], cofactors[(size - 3 + k, size - 3 + k)]));
        }
        let reliability = solution.reliability(Test::default()).expect("a test");
        let hat = &matrix * &cofactors * matrix.transpose();
        for (i, point) in reliability.points.iter().enumerate() {
            (0..2).for_each(|axis| same("redundancy", point.redundancy[axis], 1.0 - hat[(2 * i + axis, 2 * i + axis)]));
        }
        assert_eq!(reliability.observed.len(), numbers.len());
        for (k, observed) in reliability.observed.iter().enumerate() {
            let row = 2 * network.observations.len() + k;
            assert!((observed.redundancy - (1.0 - hat[(row, row)])).abs() < 1e-4, "{observed:?}");
        }
        let redundancy = solution.counts().redundancy() as f64;
        assert!((reliability.redundancy() - redundancy).abs() < 1e-6 * redundancy, "{} {redundancy}", reliability.redundancy());
    }
}

#[test]
fn residuals_are_those_of_each_image_and_the_way_is_short() {
    for seed in 0..20 {
        let (network, _) = trial(seed, 7, seed % 2 == 1);
        let solution = solved(&network);
        let numbers = solution.own_numbers(Variance::Apriori).expect("redundant");
        let own: Vec<[f64; 3]> = numbers.chunks(3).map(|of| std::array::from_fn(|k| of[k].value)).collect();
        let size = networks::FIVE.len() + 9 * 7 + 3;
        let white = residuals(&solution, &own, &DVector::zeros(size));
        for residual in solution.residuals() {
            let found = residual.v.expect("in use").map(|v| v / SIGMA);
            let of = [0, 1].map(|axis| white[2 * residual.observation + axis]);
            assert!((0..2).all(|axis| (found[axis] - of[axis]).abs() < 1e-6), "{seed}: {found:?} {of:?}");
        }
        assert!(solution.iterations() <= ITERATIONS, "{seed}: {}", solution.iterations());
    }
}

#[test]
fn errors_are_as_large_as_stated() {
    let truth = networks::opencv();
    let (mut of_camera, mut of_images, mut of_weight, mut of_plain) = ([0.0; 9], [0.0; 3], 0.0, 0.0);
    for seed in 0..TRIALS {
        let (network, own) = trial(100 + seed, 10, false);
        let solution = solved(&network);
        of_weight += solution.cost() / solution.counts().redundancy() as f64;
        let interior = solution.covariances(Variance::Apriori).expect("redundant").interior;
        let errors = solution.cameras()[0].parameters().into_iter().zip(truth.parameters()).map(|(a, b)| a.value - b.value);
        errors.take(9).enumerate().for_each(|(k, error)| of_camera[k] += error * error / interior[(k, k)]);
        for number in solution.own_numbers(Variance::Apriori).expect("redundant") {
            of_images[number.of] += ((number.value - own[number.image][number.of]) / number.sigma).powi(2) / 10.0;
        }
        // One camera for all: poses take up most of it, so that residuals hardly tell, and the camera is worse than it says.
        let shared = Network { per_image: Vec::new(), ..network.clone() };
        let plain = solved(&shared);
        let interior = plain.covariances(Variance::Estimated).expect("redundant").interior;
        let errors = plain.cameras()[0].parameters().into_iter().zip(truth.parameters()).map(|(a, b)| a.value - b.value);
        of_plain += errors.take(4).enumerate().map(|(k, error)| error * error / interior[(k, k)]).sum::<f64>() / 4.0;
    }
    let mean = |sum: f64| sum / TRIALS as f64;
    // Four standard deviations of a mean of 60 squares; own numbers of an image are not independent of each other.
    of_camera
        .into_iter()
        .zip(networks::FIVE)
        .for_each(|(sum, name)| assert!((mean(sum) - 1.0).abs() < 4.0 * (2.0 / 60.0_f64).sqrt(), "{name}: {}", mean(sum)));
    of_images.into_iter().for_each(|sum| assert!((mean(sum) - 1.0).abs() < 0.25, "{}", mean(sum)));
    assert!((mean(of_weight) - 1.0).abs() < 0.03, "{}", mean(of_weight));
    assert!(mean(of_plain) > 2.0, "one camera for all is as good: {}", mean(of_plain));
}

#[test]
fn without_own_numbers_worth_the_name_all_is_as_ever() {
    let (mut network, _) = trial(3, 7, false);
    network.per_image.iter_mut().for_each(|own| own.sigma = 1e-7);
    let shared = Network { per_image: Vec::new(), ..network.clone() };
    let (a, b) = (solved(&network), solved(&shared));
    assert!((a.cost() / b.cost() - 1.0).abs() < 1e-9, "{} {}", a.cost(), b.cost());
    a.own_numbers(Variance::Apriori)
        .unwrap()
        .iter()
        .for_each(|number| assert!(number.share < 1e-6 && number.value.abs() < 1e-9, "{number:?}"));
}

#[test]
fn a_point_that_is_wrong_is_found_beside_them() {
    let (mut network, _) = trial(5, 10, false);
    network.observations[77].position.x += 3.0;
    let reliability = solved(&network).reliability(Test::default()).unwrap();
    let worst = reliability.points.iter().max_by(|a, b| a.w[0].abs().total_cmp(&b.w[0].abs())).unwrap();
    assert!(worst.observation == 77 && worst.w[0].abs() > 10.0, "{worst:?}");
}

#[test]
fn what_would_couple_all_points_is_refused() {
    let (network, _) = trial(3, 7, false);
    let refused = |change: &dyn Fn(&mut Network)| {
        let mut network = network.clone();
        change(&mut network);
        adjust(&network, &Options::default()).map(|_| ()).unwrap_err()
    };
    let free = refused(&|network| network.points[5] = ObjectPoint::free("free", network.points[5].position));
    assert!(matches!(free, AdjustError::NotAvailable(_)), "{free}");
    let held = refused(&|network| network.cameras[0].parameters[2] = Status::Fixed);
    assert_eq!(held.to_string(), "x0 of each image needs cx to be solved for, and it is held");
    let none = refused(&|network| network.per_image[1].along.clear());
    assert_eq!(none.to_string(), "x0 of each image: it changes no parameter");
    let nothing = refused(&|network| network.per_image[2].sigma = 0.0);
    assert_eq!(nothing.to_string(), "y0 of each image: a standard deviation is not a positive number");
    let camera = refused(&|network| network.per_image[0].camera = 4);
    assert_eq!(camera.to_string(), "c of each image refers to camera 4, of which there are 1");
}
