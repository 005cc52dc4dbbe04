//! Networks that do not determine what is asked of them: each gets an answer by name.

use calibench_adjust::{
    AdjustError, Attitude, Datum, Defect, Exterior, Interior, Network, ObjectPoint, Options, Reason, Status, Variance, adjust,
};
use calibench_model::Pose;
use nalgebra::{Point3, Vector3};

use crate::networks;

fn defect(network: &Network) -> Defect {
    match adjust(network, &Options::default()) {
        Err(AdjustError::Undetermined(defect)) => *defect,
        Err(error) => panic!("another answer: {error}"),
        Ok(solution) => panic!("an answer: {:?} {:?}", solution.cameras(), solution.sigma0()),
    }
}

/// The unknowns of all directions in one line, and the reasons.
fn directions(network: &Network) -> (String, Vec<Reason>) {
    match defect(network) {
        Defect::Directions { directions, reasons } => {
            (directions.iter().flat_map(|direction| direction.unknowns.clone()).collect::<Vec<_>>().join("; "), reasons)
        }
        other => panic!("another defect: {other}"),
    }
}

/// Images by a camera without distortion, whose centre would tell the principal point, of `points` straight down from different heights, rolled by `roll` each.
fn frontal(points: Vec<ObjectPoint>, names: &[&str], roll: f64) -> Network {
    let image = |i: usize| {
        let centre = Point3::new([-0.5, 0.6, 0.1, -0.2][i], [0.3, 0.2, -0.6, 0.4][i], [6.0, 6.7, 7.5, 6.3][i]);
        Exterior::free(format!("I{i}"), 0, Pose::from_angles(centre, [0.0, 0.0, roll * i as f64]))
    };
    let interior = Interior::fixed("camera", networks::ideal()).free(names).unwrap();
    let mut network = Network { cameras: vec![interior], images: (0..4).map(image).collect(), points, ..Network::default() };
    networks::observe(&mut network, 1.0);
    network
}

fn plane() -> Vec<ObjectPoint> {
    let point = |i: usize| Point3::new((i % 6) as f64 * 0.6 - 1.5, (i / 6) as f64 * 0.6 - 1.5, 0.0);
    (0..36).map(|i| ObjectPoint::fixed(format!("{i}"), point(i))).collect()
}

#[test]
fn a_plane_seen_frontally() {
    let network = frontal(plane(), &["c"], 1.0);
    let (names, reasons) = directions(&network);
    assert!(names.contains("c of camera") && names.contains("Z0 of all images"), "{names}");
    assert!(
        reasons.contains(&Reason::NoDepth) && reasons.contains(&Reason::NoConvergence) && !reasons.contains(&Reason::NoRoll),
        "{reasons:?}"
    );
    let message = defect(&network).to_string();
    assert!(message.contains("no depth, no convergence"), "{message}");
}

#[test]
fn a_plane_seen_frontally_with_noise_has_an_answer_too() {
    let mut network = frontal(plane(), &["c"], 1.0);
    networks::shake_pixels(&mut network, 0.05, &mut networks::random(3));
    // Noise tilts the images a little, so that c becomes a number; its standard deviation says that it is none.
    match adjust(&network, &Options::default()) {
        Err(AdjustError::Undetermined(defect)) => assert!(defect.to_string().contains("c of camera"), "{defect}"),
        Err(error) => panic!("{error}"),
        Ok(solution) => {
            let sigma = solution.covariances(Variance::Apriori).unwrap().interior[(0, 0)].sqrt();
            assert!(sigma.is_finite() && sigma > 1.0, "c of 24 mm known to {sigma} mm from frontal images with sigma 1 px");
        }
    }
}

/// A property: what is named does not depend on the noise, each direction once. Before a frontal plane c goes with the heights, and the principal point
/// with the projection centres.
#[test]
fn the_names_of_a_frontal_plane_do_not_depend_on_the_noise() {
    let mut named = Vec::new();
    for seed in 0..12 {
        let mut network = frontal(plane(), &["c", "x0", "y0"], 1.0);
        let sigma = [0.0, 1e-4, 0.01, 0.05][seed % 4];
        networks::shake_pixels(&mut network, sigma, &mut networks::random(30 + seed as u64));
        let Defect::Directions { directions, .. } = defect(&network) else { panic!("another defect") };
        let mut interior: Vec<String> = directions.iter().map(|direction| direction.unknowns[0].clone()).collect();
        interior.sort();
        named.push(interior);
    }
    assert!(named.iter().all(|names| *names == ["c of camera", "x0 of camera", "y0 of camera"]), "{named:?}");
}

#[test]
fn one_image_of_a_plane() {
    let mut network = frontal(plane(), &["c", "x0", "y0"], 1.0);
    network.images.truncate(1);
    network.images[0].pose = Pose::looking_at(Point3::new(2.0, -3.0, 5.0), Point3::origin(), Vector3::y(), 0.3).unwrap();
    networks::observe(&mut network, 1.0);
    let (names, reasons) = directions(&network);
    assert!(names.contains("of camera") && names.contains("image I0"), "{names}");
    assert!(reasons.contains(&Reason::OneImage) && reasons.contains(&Reason::NoDepth), "{reasons:?}");
}

#[test]
fn no_roll_and_no_convergence() {
    let mut random = networks::random(4);
    let mut field = |i: usize| Point3::new((i % 6) as f64 * 0.6 - 1.5, (i / 6) as f64 * 0.6 - 1.5, 0.4 * networks::normal(&mut random));
    let points: Vec<ObjectPoint> = (0..36).map(|i| ObjectPoint::free(format!("{i}"), field(i))).collect();
    let datum = Datum::Minimal { horizontal: [0, 35], vertical: [0, 5, 30] };
    let network = Network { datum: datum.clone(), ..frontal(points.clone(), &["c", "x0", "y0"], 0.0) };
    let (names, reasons) = directions(&network);
    assert!(["c", "x0", "y0"].iter().all(|name| names.contains(name)), "{names}");
    assert!(
        reasons.contains(&Reason::NoRoll) && reasons.contains(&Reason::NoConvergence) && !reasons.contains(&Reason::NoDepth),
        "{reasons:?}"
    );
    // Rolled images determine the principal point, not c.
    let rolled = Network { datum, ..frontal(points, &["c", "x0", "y0"], 1.5) };
    let (names, reasons) = directions(&rolled);
    assert!(names.contains("c of camera") && !names.contains("x0"), "{names}");
    assert!(!reasons.contains(&Reason::NoRoll), "{reasons:?}");
}

#[test]
fn two_points() {
    let mut network = networks::board(networks::opencv(), 3, 2);
    network.observations.retain(|o| o.image != 1 || o.point < 2);
    assert_eq!(defect(&network), Defect::Images { images: vec![("1".into(), 2)] });
}

#[test]
fn a_point_seen_once() {
    let mut network = networks::ring(networks::photogrammetric(), 6, 20, 3);
    network.datum = Datum::Inner;
    network.observations.retain(|o| o.point != 4 || o.image == 2);
    assert_eq!(defect(&network), Defect::Points { points: vec![("P4".into(), 1)] });
    // Seen twice from one place: counting does not tell.
    let mut network = networks::ring(networks::photogrammetric(), 6, 20, 3);
    networks::control(&mut network, 4, 1e-3);
    let turned = Pose::from_angles(Point3::origin(), [0.0, 0.0, 0.4]).rotation * network.images[2].pose.rotation;
    network.images[3].pose = Pose { rotation: turned, ..network.images[2].pose };
    networks::observe(&mut network, 1.0);
    network.observations.retain(|o| o.point != 5 || o.image == 2 || o.image == 3);
    let (names, _) = directions(&network);
    assert!(names.contains("of point P5"), "{names}");
}

#[test]
fn all_points_on_a_line() {
    let points = (0..8).map(|i| ObjectPoint::fixed(format!("{i}"), Point3::new(0.4 * f64::from(i) - 1.4, 0.0, 0.0))).collect();
    let mut network = frontal(points, &[], 0.4);
    for image in &mut network.images {
        image.pose = Pose::looking_at(image.pose.centre, Point3::origin(), Vector3::y(), 0.3).unwrap();
    }
    networks::observe(&mut network, 1.0);
    assert_eq!(defect(&network), Defect::Datum { free: vec!["rotation about X"], reasons: vec![Reason::OnALine] });
    // With an observed rotation of each image but one, it is that one's.
    for image in network.images.iter_mut().skip(1) {
        image.attitude = Attitude::Observed { value: image.pose.rotation, sigma: [1e-3; 3] };
    }
    let (names, reasons) = directions(&network);
    assert!(names.contains("of image I0") && !names.contains("I3"), "{names}");
    assert!(reasons.contains(&Reason::OnALine), "{reasons:?}");
}

#[test]
fn too_few_observations_and_nothing_unknown() {
    let mut network = networks::board(networks::opencv(), 1, 2);
    networks::free(&mut network, &networks::FIVE);
    network.observations.retain(|o| [0, 8, 20, 30, 33, 45, 53].contains(&o.point));
    assert!(matches!(defect(&network), Defect::Count { .. }));
    network.observations.clear();
    assert!(matches!(defect(&network), Defect::Images { .. }));
    network.images[0] = Exterior::fixed("0", 0, network.images[0].pose);
    network.cameras[0].parameters.fill(Status::Fixed);
    let error = adjust(&network, &Options::default()).unwrap_err();
    assert!(error.to_string().contains("nothing is unknown"), "{error}");
}

#[test]
fn what_is_no_network_is_refused() {
    let good = networks::board(networks::opencv(), 2, 2);
    let refused = |change: &dyn Fn(&mut Network)| {
        let mut network = good.clone();
        change(&mut network);
        let error = adjust(&network, &Options::default()).unwrap_err();
        assert!(matches!(error, AdjustError::Network(_)), "{error}");
    };
    refused(&|network| network.observations[3].image = 7);
    refused(&|network| network.observations[3].point = 700);
    refused(&|network| network.observations[3].position.x = f64::NAN);
    refused(&|network| network.observations[3].precision = calibench_adjust::Precision::Sigma(0.0));
    refused(&|network| network.observations[3] = network.observations[2]);
    refused(&|network| network.images[1].pose.rotation *= 2.0);
    refused(&|network| network.images[1].camera = 1);
    refused(&|network| network.cameras[0].parameters.truncate(3));
    refused(&|network| network.points[4].position.z = f64::INFINITY);
    for options in [Options { left_out: vec![108], ..Options::default() }, Options { huber: Some(f64::NAN), ..Options::default() }] {
        assert!(matches!(adjust(&good, &options), Err(AdjustError::Network(_))));
    }
    let unknown = good.cameras[0].clone().free(&["c"]).unwrap_err().to_string();
    assert!(unknown.contains("fx, fy"), "{unknown}");
    let mut behind = good.clone();
    behind.images[0].pose.centre.z = -300.0;
    assert!(matches!(adjust(&behind, &Options::default()), Err(AdjustError::NotPictured { .. })));
}
