//! Arithmetic against numbers by hand, and intersections against a second implementation.

use calibench_measure::Registry;
use calibench_model::camera::{Camera, Photogrammetric};
use calibench_model::convert::{Tangential, Target, from_naive};
use calibench_model::{Frame, Pose};
use calibench_records::figures::Group;
use calibench_records::results::Figure;
use calibench_scenario::Turned;
use calibench_scenario::{Printed, StudyPlan, Subject, parse};
use nalgebra::{Matrix3, Point3, Vector3};

use super::errors::root_mean_squares;
use super::fit::least_squares;
use super::network::{NUMBERS, Pictures, Site};
use super::run;

/// Twelve points on a wall as of the paper, fewer columns and starts.
const SCENARIO: &str = include_str!("tests.toml");

fn printed() -> Printed {
    let scenario = parse("family/test", "test.toml", SCENARIO, &Registry::builtin()).unwrap_or_else(|problems| panic!("{problems}"));
    match scenario.subject {
        Subject::Printed(printed) => *printed,
        _ => panic!("printed figures"),
    }
}

/// A figure by set and name.
fn value(all: &[Vec<Figure>], printed: &Printed, set: &str, group: Group, name: &str) -> f64 {
    let place = printed.sets().iter().position(|other| other == set).unwrap();
    let found = all[place].iter().find(|figure| figure.name.group() == group && figure.name.text() == name);
    found.unwrap_or_else(|| panic!("no `{name}` in {set}: {:?}", all[place].iter().map(|f| &f.name).collect::<Vec<_>>())).value
}

fn near(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within, "{found} is not {expected}");
}

/// Errors (3, 4, 0) and (0, 0, 12): means of squares 4.5, 8, 72.
#[test]
fn root_mean_squares_are_those_by_hand() {
    let found = root_mean_squares(&[Vector3::new(3.0, -4.0, 0.0), Vector3::new(0.0, 0.0, 12.0)]);
    let expected = [4.5, 8.0, 72.0, 12.5, 84.5].map(f64::sqrt);
    for (value, expected) in found.into_iter().zip(expected) {
        assert!((value - expected).abs() < 1e-14, "{value} is not {expected}");
    }
}

#[test]
fn figures_of_sensor_conversion_and_errors_are_those_by_hand() {
    let printed = printed();
    let all: Vec<Vec<Figure>> = run(&printed).calibrations.into_iter().map(|one| one.outcome.unwrap()).collect();
    let of = |set: &str, name: &str| value(&all, &printed, set, Group::Network, name);
    near(of("sensor", "resolution, um"), 25.4 * 0.905 / 4272.0 * 1e3, 1e-9);
    near(of("sensor", "width, um"), 5.149_813, 1e-6);
    near(of("sensor", "million pixels"), 12.166_656, 1e-9);
    near(of("sensor", "check points"), 12.0, 0.0);
    near(of("PhotoScan", "c less that of the first column, mm"), 1.213, 1e-12);
    for set in ["PhotoScan", "OpenCV"] {
        for (i, power) in [2.0, 4.0, 6.0].into_iter().enumerate() {
            near(of(set, &format!("k{}: power of c", i + 1)), power, 1e-9);
        }
    }
    // p1 = P1 / c and p2 = -P2 / c; of OpenCV p1 = kc4 / c and p2 = -kc3 / c.
    for (set, expected) in [("PhotoScan", [1.0, 0.0, 0.0, -1.0]), ("OpenCV", [0.0, -1.0, 1.0, 0.0])] {
        let names = ["p1: of the first", "p2: of the first", "p1: of the second", "p2: of the second"];
        names.into_iter().zip(expected).for_each(|(name, expected)| near(of(set, name), expected, 1e-9));
    }
    // Sums of squares of the twelve printed errors of PhotoScan: X 1367, Y 408, Z 529 square mm.
    let check = |name: &str| value(&all, &printed, "PhotoScan", Group::Check, name);
    near(check("RMSE X, m"), (1367e-6_f64 / 12.0).sqrt(), 1e-12);
    near(check("RMSE Y, m"), (408e-6_f64 / 12.0).sqrt(), 1e-12);
    near(check("RMSE Z, m"), (529e-6_f64 / 12.0).sqrt(), 1e-12);
    near(check("planimetric RMSE, m"), (1775e-6_f64 / 12.0).sqrt(), 1e-12);
}

/// Changing c moves pixels by its ratio, to be seen in the largest difference; the same camera costs nothing.
#[test]
fn a_changed_camera_costs_what_is_changed() {
    let printed = printed();
    let all: Vec<Vec<Figure>> = run(&printed).calibrations.into_iter().map(|one| one.outcome.unwrap()).collect();
    let of = |set: &str, name: &str| value(&all, &printed, set, Group::Network, name);
    near(of("the same", "difference, rms after rotation, px"), 0.0, 1e-6);
    near(of("the same", "misfit, m"), of("PhotoScan", "misfit, m"), 1e-12);
    // 1 % of the half diagonal of 4272 x 2848 px.
    near(of("c of 18.18", "difference, most after rotation, px"), 25.66, 0.05);
}

/// The network of a few numbers, with the pictures of a camera.
fn network(camera: &Camera) -> (Site, Pictures) {
    let printed = printed();
    let frame = Frame::new(4272, 2848, 5.38085).unwrap();
    let site = Site::new(printed.network.as_ref().unwrap(), &printed.points, frame);
    let poses = site.poses(&[14.0, -3.0, 6.0, 0.3, -2.0, 0.7, 0.1, 1.0, 0.2]).unwrap();
    let pictures = site.pictured(poses, camera);
    (site, pictures)
}

fn truth(printed: &Printed) -> Camera {
    from_naive(&printed.cameras[1].camera, Target::metashape(), Tangential::Converted).unwrap()
}

/// Collinearity written out, and the point by normal equations whose derivatives are differences: nothing of this crate's or the library's.
fn second(seen: &[(Matrix3<f64>, Vector3<f64>, [f64; 2])], start: Vector3<f64>, c: f64) -> Vector3<f64> {
    let misclosures = |at: &Vector3<f64>| -> Vec<f64> {
        let of = |(m, centre, [x, y]): &(Matrix3<f64>, Vector3<f64>, [f64; 2])| {
            let n = m * (at - centre);
            [-c * n[0] / n[2] - x, -c * n[1] / n[2] - y]
        };
        seen.iter().flat_map(of).collect()
    };
    let mut at = start;
    for _ in 0..20 {
        let v = misclosures(&at);
        let slope = |axis: usize| {
            let mut ends = [at, at];
            ends[0][axis] += 1e-4;
            ends[1][axis] -= 1e-4;
            let [up, down] = ends.map(|end| misclosures(&end));
            up.iter().zip(&down).map(|(u, d)| (u - d) / 2e-4).collect::<Vec<f64>>()
        };
        let columns = [slope(0), slope(1), slope(2)];
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let normal = Matrix3::from_fn(|i, k| dot(&columns[i], &columns[k]));
        let right = Vector3::from_fn(|i, _| -dot(&columns[i], &v));
        at += normal.try_inverse().unwrap() * right;
    }
    at
}

/// Brown's correction, written out a second time.
fn corrected(camera: &Photogrammetric, [column, row]: [f64; 2]) -> [f64; 2] {
    let mm = camera.pitch_um * 1e-3;
    let x = (column - 0.5 * 4271.0) * mm - camera.x0;
    let y = (0.5 * 2847.0 - row) * mm - camera.y0;
    let r = x.hypot(y);
    let radial = camera.k[0] * r.powi(2) + camera.k[1] * r.powi(4) + camera.k[2] * r.powi(6);
    let dx = x * radial + camera.p[0] * (r * r + 2.0 * x * x) + 2.0 * camera.p[1] * x * y;
    let dy = y * radial + 2.0 * camera.p[0] * x * y + camera.p[1] * (r * r + 2.0 * y * y);
    [x - dx, y - dy]
}

#[test]
fn intersections_agree_with_a_second_implementation() {
    let printed = printed();
    let (site, pictures) = network(&truth(&printed));
    for column in &printed.cameras {
        let errors = site.errors(&pictures, &column.camera).unwrap();
        let nearly = site.nearly(&pictures, &column.camera).unwrap();
        for (index, point) in printed.points.iter().enumerate() {
            let seen: Vec<_> = pictures
                .iter()
                .filter_map(|(pose, seen)| {
                    let at = seen[index]?;
                    Some((pose.rotation, pose.centre.coords, corrected(&column.camera, [at.x, at.y])))
                })
                .collect();
            assert!(seen.len() >= 8, "{} is seen {} times", point.name, seen.len());
            let true_place = point.at - site.middle();
            let found = second(&seen, true_place, column.camera.c) - true_place;
            let apart = (found - errors[index]).norm();
            assert!(apart < 1e-7, "{} by {}: {found} and {}, {apart} m apart", point.name, column.name, errors[index]);
            let apart = (nearly[index] - errors[index]).norm();
            assert!(apart < 2e-4, "{} by {}: two steps end {apart} m off", point.name, column.name);
        }
    }
}

/// The exact conversion of the true camera finds every point.
#[test]
fn the_true_camera_without_distortion_makes_no_error() {
    let printed = printed();
    let plain = printed.cameras[0].camera;
    let (site, pictures) = network(&plain.into());
    let errors = site.errors(&pictures, &plain).unwrap();
    assert!(errors.iter().all(|error| error.norm() < 1e-9), "{errors:?}");
}

/// Errors that a network of known numbers makes lead back to it.
#[test]
fn a_network_is_found_again_from_its_own_errors() {
    let mut printed = printed();
    let (site, pictures) = network(&truth(&printed));
    for column in 0..printed.cameras.len() {
        let errors = site.errors(&pictures, &printed.cameras[column].camera).unwrap();
        for (point, error) in printed.points.iter_mut().zip(errors) {
            point.errors[column] = error.abs().into();
        }
    }
    let all: Vec<Vec<Figure>> = run(&printed).calibrations.into_iter().map(|one| one.outcome.unwrap()).collect();
    let of = |group, name: &str| value(&all, &printed, "network", group, name);
    near(of(Group::Network, "misfit of what is fitted, m"), 0.0, 2e-5);
    for (name, expected) in [("distance, m", 14.0), ("curve, m", -3.0), ("half base, m", 6.0), ("height, m", -2.0)] {
        near(of(Group::Eop, name), expected, 0.05);
    }
    near(value(&all, &printed, "OpenCV", Group::Network, "misfit, m"), 0.0, 2e-4);
    for (index, (pose, _)) in pictures.iter().enumerate() {
        let get = |name: &str| of(Group::Eop, &format!("{}/{name}", index + 1));
        let centre = Point3::new(get("X"), get("Y"), get("Z"));
        let found = Pose::from_angles(centre, ["omega", "phi", "kappa"].map(|name| get(name).to_radians()));
        let apart = (found.rotation - pose.rotation).norm();
        assert!(apart < 0.01, "station {}: {apart} rad", index + 1);
        // The points are before the camera, on its -z.
        let middle = printed.points.iter().map(|point| point.at.coords).sum::<Vector3<f64>>() / printed.points.len() as f64;
        assert!(found.camera_from_world(&middle.into()).z < -5.0);
    }
}

/// Errors of a true camera whose p2 has the other sign than its column: of the readings that one leaves no misfit, and predicts every error.
#[test]
fn the_reading_that_made_the_errors_explains_them() {
    let mut printed = printed();
    let turned = Turned { p: [false, true], ..Turned::default() };
    let own = from_naive(&turned.of(&printed.cameras[1].camera), Target::metashape(), Tangential::Converted).unwrap();
    let (site, pictures) = network(&own);
    for column in 0..printed.cameras.len() {
        let errors = site.errors(&pictures, &printed.cameras[column].camera).unwrap();
        for (point, error) in printed.points.iter_mut().zip(errors) {
            point.errors[column] = error.abs().into();
        }
    }
    let all: Vec<Vec<Figure>> = run(&printed).calibrations.into_iter().map(|one| one.outcome.unwrap()).collect();
    let of = |set: &str, name: &str| value(&all, &printed, set, Group::Network, name);
    near(of("true p2 turned", "misfit of what is fitted, m"), 0.0, 2e-5);
    near(of("true p2 turned", "errors predicted nearly"), 36.0, 0.0);
    near(of("true p2 turned", "OpenCV: misfit, m"), 0.0, 2e-4);
    for other in ["network", "applied p2 turned"] {
        assert!(of(other, "misfit of what is fitted, m") > 2e-4, "{other}");
    }
    near(of("true p2 turned", "starts"), 4.0, 0.0);
    // As the network's own reading it stands there.
    printed.network.as_mut().unwrap().turned_truth = turned;
    let again: Vec<Vec<Figure>> = run(&printed).calibrations.into_iter().map(|one| one.outcome.unwrap()).collect();
    near(value(&again, &printed, "network", Group::Network, "misfit of what is fitted, m"), 0.0, 2e-5);
}

/// Rosenbrock's valley, as residuals 10 (y - x^2) and 1 - x: the least is at (1, 1).
#[test]
fn least_squares_finds_the_end_of_a_valley() {
    let residuals = |at: &[f64; 2]| Some(vec![10.0 * (at[1] - at[0] * at[0]), 1.0 - at[0]]);
    let (found, cost) = least_squares([-1.2, 1.0], (1e-7, 1e-12), residuals).unwrap();
    assert!((found[0] - 1.0).abs() < 1e-5 && (found[1] - 1.0).abs() < 1e-5 && cost < 1e-10, "{found:?} {cost}");
    assert_eq!(least_squares([0.0; NUMBERS], (1e-3, 1e-3), |_: &[f64; NUMBERS]| None), None);
}

#[test]
fn the_same_figures_come_of_one_thread_and_of_many() {
    let printed = printed();
    let of = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| run(&printed));
    assert_eq!(of(1), of(4));
}
