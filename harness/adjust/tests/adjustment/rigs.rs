//! Cameras that are mounted rigidly: truth, statistics, tests, and what is refused.

use calibench_adjust::{
    AdjustError, Defect, Exterior, ImageObservation, Interior, Options, Rig, Snooping, Station, Test, Variance, adjust, adjust_rig,
    relative, snoop_rig,
};
use calibench_model::Pose;
use calibench_model::camera::CameraModel;
use nalgebra::{Matrix3, Point3, Rotation3, Vector3, Vector6};

use super::networks::{FIVE, normal, opencv, random, seen};

fn turned(pose: &Pose, turn: [f64; 3]) -> Pose {
    Pose { rotation: *Rotation3::new(Vector3::from(turn)).matrix() * pose.rotation, ..*pose }
}

/// Three cameras side by side before a bent plate of 6 x 5 points, 60 mm apart; `free` of the interiors is unknown.
fn rig(stations: usize, free: &[&str], seed: u64) -> Rig {
    let mut random = random(seed);
    let mount = |x: f64, turn: f64| Pose {
        rotation: *Rotation3::new(Vector3::new(0.02, turn, -0.03)).matrix(),
        centre: Point3::new(x, 0.01 * x, 0.02),
    };
    let first = Pose { rotation: Matrix3::identity(), centre: Point3::origin() };
    let mut rig = Rig { mounts: vec![first, mount(0.2, -0.15), mount(-0.25, 0.2)], ..Rig::default() };
    for name in ["left", "middle", "right"] {
        rig.network.cameras.push(Interior::fixed(name, opencv()).free(free).unwrap());
    }
    for i in 0..30 {
        let (x, y) = (f64::from(i % 6) * 0.06, f64::from(i / 6) * 0.06);
        rig.network.points.push(calibench_adjust::ObjectPoint::fixed(format!("P{i}"), Point3::new(x, y, 0.5 * (x - 0.15).powi(2))));
    }
    for station in 0..stations {
        let mut three = |size: f64| Vector3::from_fn(|_, _| size * normal(&mut random));
        let centre = Point3::new(0.15, 0.12, 1.0) + three(0.15).component_mul(&Vector3::new(1.0, 1.0, 0.3));
        let back = Pose::looking_at(centre, Point3::new(0.15, 0.12, 0.0) + three(0.03), Vector3::y(), three(0.5).x).unwrap();
        rig.stations.push(Station { name: format!("S{station}"), pose: back });
        for camera in 0..3 {
            let image = rig.network.images.len();
            rig.network.images.push(Exterior::free(format!("{camera}/{station}"), camera, back));
            rig.station_of.push(station);
            rig.network.images[image].pose = rig.pose(image);
        }
    }
    for (i, image) in rig.network.images.iter().enumerate() {
        for (k, point) in rig.network.points.iter().enumerate() {
            if let Some(pixel) = seen(&rig.network.cameras[image.camera].camera, &image.pose, &point.position) {
                rig.network.observations.push(ImageObservation::new(i, k, pixel, 0.2));
            }
        }
    }
    rig
}

fn shaken(truth: &Rig, pixels: f64, seed: u64) -> Rig {
    let (mut rig, mut random) = (truth.clone(), random(seed));
    for o in &mut rig.network.observations {
        o.position.x += pixels * normal(&mut random);
        o.position.y += pixels * normal(&mut random);
    }
    rig
}

/// Start values off the truth.
fn moved(mut rig: Rig) -> Rig {
    let off = |pose: &mut Pose, k: f64| {
        *pose = turned(pose, [0.01 * k, -0.01, 0.02]);
        pose.centre += Vector3::new(0.01, -0.02 * k, 0.01);
    };
    rig.mounts.iter_mut().skip(1).for_each(|mount| off(mount, 0.7));
    rig.stations.iter_mut().enumerate().for_each(|(i, station)| off(&mut station.pose, (i as f64).sin()));
    rig
}

fn apart(a: &Pose, b: &Pose) -> f64 {
    (a.rotation - b.rotation).amax().max((a.centre - b.centre).amax())
}

#[test]
fn a_rig_without_noise_gives_the_truth() {
    for free in [&[][..], &FIVE] {
        let truth = rig(8, free, 1);
        let start = moved(truth.clone());
        let solution = adjust_rig(&start, &Options::default()).unwrap();
        for (found, truth) in solution.mounts().iter().zip(&truth.mounts) {
            assert!(apart(found, truth) < 1e-9, "{free:?}: {found:?} {truth:?}");
        }
        for (found, truth) in solution.stations().iter().zip(&truth.stations) {
            assert!(apart(found, &truth.pose) < 1e-9, "{found:?} {truth:?}");
        }
        for (found, truth) in solution.cameras().iter().zip(&truth.network.cameras) {
            for (a, b) in found.parameters().iter().zip(truth.camera.parameters()) {
                assert!((a.value - b.value).abs() < 1e-8 * b.value.abs().max(1.0), "{a:?} {b:?}");
            }
        }
        assert_eq!(solution.counts().unknowns, 3 * free.len() + 12 + 48);
    }
}

/// With another origin the rig is the same one, seen from another camera, to the same covariance.
#[test]
fn the_origin_is_no_matter() {
    let first = shaken(&rig(8, &["fx", "fy", "cx", "cy"], 2), 0.2, 3);
    let mut other = first.clone();
    other.origin = 2;
    let [a, b] = [&first, &other].map(|rig| adjust_rig(rig, &Options::default()).unwrap());
    assert!((a.cost() / b.cost() - 1.0).abs() < 1e-10);
    let [qa, qb] = [&a, &b].map(|solution| solution.covariances(Variance::Estimated).unwrap());
    for (from, to) in [(0, 1), (0, 2), (1, 2), (2, 1)] {
        let (x, y) = (qa.relative(from, to), qb.relative(from, to));
        assert!(apart(&x.pose, &y.pose) < 1e-8, "{x:?} {y:?}");
        assert!((x.covariance - y.covariance).amax() < 1e-6 * x.covariance.amax(), "{} {}", x.covariance, y.covariance);
        let (distance, sigma) = x.distance();
        assert!((distance - (a.mounts()[to].centre - a.mounts()[from].centre).norm()).abs() < 1e-12 && sigma > 0.0);
    }
}

/// A rig whose stations see the board with one camera each is that camera alone: an adjustment of its images.
#[test]
fn a_camera_alone_is_adjusted_as_always() {
    let mut alone = shaken(&rig(10, &FIVE, 4), 0.2, 5);
    let network = &mut alone.network;
    network.cameras.truncate(1);
    let kept: Vec<usize> = (0..30).filter(|image| image % 3 == 0).collect();
    network.images = kept.iter().map(|&image| network.images[image].clone()).collect();
    network.observations.retain(|o| o.image % 3 == 0);
    network.observations.iter_mut().for_each(|o| o.image /= 3);
    alone.mounts.truncate(1);
    alone.station_of = (0..10).collect();
    let (own, other) = (adjust_rig(&alone, &Options::default()).unwrap(), adjust(&alone.network, &Options::default()).unwrap());
    assert!((own.cost() / other.cost() - 1.0).abs() < 1e-11 && own.counts() == other.counts());
    let (a, b) = (own.covariances(Variance::Apriori).unwrap(), other.covariances(Variance::Apriori).unwrap());
    assert_eq!(a.parameters, b.parameters);
    for k in 0..9 {
        assert!((a.kept[(k, k)] / b.interior[(k, k)] - 1.0).abs() < 1e-6, "{k}");
    }
    let [own, other] = [own.reliability(Test::default()).unwrap(), other.reliability(Test::default()).unwrap()];
    for (a, b) in own.points.iter().zip(&other.points) {
        assert!(a.observation == b.observation && (a.w[0] - b.w[0]).abs() < 1e-5 && (a.redundancy[1] - b.redundancy[1]).abs() < 1e-6);
    }
}

/// Chi-square by redundancy, regions of the relative pose, and of a parameter.
#[test]
fn cost_and_regions_are_as_predicted() {
    let truth = rig(5, &["fx", "fy", "cx", "cy", "k1"], 6);
    let (runs, mut ratio, mut inside, mut sigmas) = (400, 0.0, [0, 0], 0.0);
    for run in 0..runs {
        let noisy = shaken(&truth, 0.2, 100 + run);
        let solution = adjust_rig(&noisy, &Options::default()).unwrap();
        ratio += solution.cost() / solution.counts().redundancy() as f64 / runs as f64;
        let covariances = solution.covariances(Variance::Apriori).unwrap();
        for (k, (from, to)) in [(0, 1), (1, 2)].into_iter().enumerate() {
            let (found, right) = (covariances.relative(from, to), relative(&truth.mounts[from], &truth.mounts[to]));
            let turn = Rotation3::from_matrix_unchecked(right.rotation * found.pose.rotation.transpose()).scaled_axis();
            let shift = -(found.pose.rotation * (right.centre - found.pose.centre));
            let off = Vector6::new(turn.x, turn.y, turn.z, shift.x, shift.y, shift.z);
            // 95 % of chi-square with six degrees of freedom.
            inside[k] += usize::from(off.dot(&(found.covariance.try_inverse().unwrap() * off)) < 12.5916);
        }
        let fx = solution.cameras()[2].parameters()[0].value - truth.network.cameras[2].camera.parameters()[0].value;
        sigmas += (fx / covariances.kept[(10, 10)].sqrt()).powi(2) / runs as f64;
    }
    assert!((0.985..1.015).contains(&ratio), "{ratio}");
    assert!(inside.iter().all(|inside| (367..=393).contains(inside)), "{inside:?}");
    assert!((0.8..1.2).contains(&sigmas), "{sigmas}");
}

#[test]
fn redundancy_numbers_add_up_and_a_gross_error_is_found() {
    let mut noisy = shaken(&rig(6, &["fx", "fy", "cx", "cy"], 7), 0.2, 8);
    let solution = adjust_rig(&noisy, &Options::default()).unwrap();
    let reliability = solution.reliability(Test::default()).unwrap();
    assert!((reliability.redundancy() - solution.counts().redundancy() as f64).abs() < 1e-6, "{}", reliability.redundancy());
    noisy.network.observations[100].position.x += 3.0;
    noisy.network.observations[211].position.y -= 2.0;
    let test = Snooping { test: Test { alpha: 1e-5, ..Test::default() }, most: 20 };
    let (cleaned, found) = snoop_rig(&noisy, &Options::default(), test).unwrap();
    let mut names: Vec<usize> = found.iter().filter(|found| found.left_out).map(|found| found.observation).collect();
    names.sort_unstable();
    assert_eq!(names, [100, 211], "{found:?}");
    assert_eq!(cleaned.counts().image_coordinates, 2 * (noisy.network.observations.len() - 2));
    // Many at once, which hide one another.
    (0..60).for_each(|k| noisy.network.observations[7 * k].position.x += 25.0 + k as f64);
    let (_, found) = snoop_rig(&noisy, &Options::default(), test).unwrap();
    assert!((0..60).all(|k| found.iter().any(|found| found.observation == 7 * k)), "{}", found.len());
    assert!(found.len() < 70, "{}", found.len());
}

#[test]
fn what_is_no_rig_is_refused_by_name() {
    let whole = rig(6, &["fx"], 9);
    let mut apart = whole.clone();
    // The right camera sees the board where the others do not.
    let is_kept = |image: usize| (image % 3 == 2) == (image / 3 >= 3);
    apart.network.observations.retain(|o| is_kept(o.image));
    match adjust_rig(&apart, &Options::default()).unwrap_err() {
        AdjustError::Undetermined(defect) => {
            let expected = Defect::Unconnected { sets: vec![vec!["left".into(), "middle".into()], vec!["right".into()]] };
            assert_eq!(*defect, expected);
            assert!(defect.to_string().contains("(left, middle) with right"), "{defect}");
        }
        other => panic!("{other}"),
    }
    let mut few = whole.clone();
    few.network.observations.retain(|o| o.image / 3 != 4 || (o.image == 12 && o.point < 2));
    let error = adjust_rig(&few, &Options::default()).unwrap_err().to_string();
    assert!(error.contains("the pose of station S4"), "{error}");
    let mut twice = whole.clone();
    twice.station_of[3] = 0;
    let error = adjust_rig(&twice, &Options::default()).unwrap_err().to_string();
    assert!(error.contains("0/0 and 0/1 are both of left"), "{error}");
    let mut unknown = whole;
    unknown.network.points[3].coordinates[2] = calibench_adjust::Status::Free;
    assert!(adjust_rig(&unknown, &Options::default()).is_err());
}
