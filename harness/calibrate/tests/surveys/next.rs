//! What to photograph next.

use calibench_adjust::{Distance, frame_weight, image_information};
use calibench_calibrate::{Calibration, Next};
use calibench_model::camera::CameraModel;
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Matrix3, Point3, Vector3};

use crate::network::{SIZE, Scene, board, lens, settings, wall};

fn noisy(scene: Scene) -> Scene {
    Scene { sigma: 0.1, ..scene }
}

/// The root mean square over the frame, px, of what was adjusted.
fn uncertainty(calibration: &Calibration<'_>) -> f64 {
    let (names, covariance) = calibration.covariances.of_camera(0);
    let weight = frame_weight(calibration.camera(0), &names, (31, 21), Distance::Far).unwrap();
    (weight * covariance).trace().sqrt()
}

#[test]
fn a_proposed_photograph_does_what_was_promised() {
    // So little noise that a further photograph moves the camera, and with it the derivatives, by nothing.
    let mut scene = Scene { sigma: 1e-3, ..board(lens()) };
    let prepared = scene.prepared(&settings("opencv5")).unwrap();
    let found = prepared.adjust().unwrap();
    let next = found.next(0).unwrap();
    assert!(next.whole && next.photographs.len() == 3);
    assert!((next.before - uncertainty(&found)).abs() < 1e-9 * next.before);
    assert!(next.photographs[0].uncertainty < 0.8 * next.usual && next.usual < next.before, "{next:?}");
    for photograph in &next.photographs {
        // Taken and adjusted with all others: another way to its covariance.
        scene.poses.push(photograph.pose);
        let prepared = scene.prepared(&settings("opencv5")).unwrap();
        let taken = prepared.adjust().unwrap();
        let scale = taken.solution.sigma0().unwrap() / found.solution.sigma0().unwrap();
        let reached = uncertainty(&taken) / scale;
        assert!((reached - photograph.uncertainty).abs() < 0.02 * reached, "{reached} {}", photograph.uncertainty);
    }
}

/// Object axes that point away from the camera, as many tools have them.
#[test]
fn a_board_that_is_seen_from_behind_its_axes_is_no_mirror_image() {
    let front = board(lens());
    let about = |pose: &Pose| {
        // A half turn of everything about the board's rows.
        let half = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
        Pose { rotation: pose.rotation * half, centre: Point3::from(half * pose.centre.coords) }
    };
    let targets = front.targets.iter().map(|p| Point3::new(p.x, -p.y, -p.z)).collect();
    let scene = noisy(Scene { poses: front.poses.iter().map(about).collect(), targets, ..board(lens()) });
    assert!(scene.poses.iter().all(|pose| pose.centre.z < 0.0));
    let prepared = scene.prepared(&settings("opencv5")).unwrap();
    let next = prepared.adjust().unwrap().next(0).unwrap();
    for photograph in &next.photographs {
        assert!((photograph.pose.rotation.determinant() - 1.0).abs() < 1e-9, "{}", photograph.pose.rotation);
        assert!(photograph.pose.centre.z < 0.0);
    }
    // What is proposed does not depend on how the axes are called.
    let other = noisy(board(lens()));
    let prepared = other.prepared(&settings("opencv5")).unwrap();
    let known = prepared.adjust().unwrap().next(0).unwrap();
    let values = |next: &Next| next.photographs.iter().map(|one| one.uncertainty).collect::<Vec<_>>();
    for (a, b) in values(&next).iter().zip(values(&known)) {
        assert!((a - b).abs() < 1e-6 * b, "{a} {b}");
    }
}

/// Of many points some are looked at in the search, and all of what is chosen.
#[test]
fn many_points_are_searched_by_some_and_counted_by_all() {
    let fine = |n: i32| {
        let targets = (0..9 * n * 7 * n).map(|i| {
            let (column, row) = (i % (9 * n), i / (9 * n));
            Point3::new(240.0 * f64::from(column) / f64::from(9 * n - 1), 180.0 * f64::from(row) / f64::from(7 * n - 1), 0.0)
        });
        let targets: Vec<_> = targets.collect();
        Scene { sigma: 1e-3, control: targets.len(), targets, ..board(lens()) }
    };
    let mut scene = fine(6);
    let prepared = scene.prepared(&settings("opencv5")).unwrap();
    let found = prepared.adjust().unwrap();
    let next = found.next(0).unwrap();
    assert_eq!(next.photographs[0].points.len(), 2268);
    scene.poses.push(next.photographs[0].pose);
    let prepared = scene.prepared(&settings("opencv5")).unwrap();
    let taken = prepared.adjust().unwrap();
    let reached = uncertainty(&taken) * found.solution.sigma0().unwrap() / taken.solution.sigma0().unwrap();
    assert!((reached - next.photographs[0].uncertainty).abs() < 0.02 * reached, "{reached} {}", next.photographs[0].uncertainty);
    // As good a choice as that from all points of a board of few: which photograph is best does not depend on how dense the points are.
    let few = fine(1);
    let prepared = few.prepared(&settings("opencv5")).unwrap();
    let coarse = prepared.adjust().unwrap().next(0).unwrap();
    let (names, covariance) = found.covariances.of_camera(0);
    let sigma = found.solution.sigma0().unwrap() * found.prepared.settings.sigma();
    let more = image_information(found.camera(0), &names, &coarse.photographs[0].pose, &scene.targets, sigma).unwrap();
    let weight = frame_weight(found.camera(0), &names, (31, 21), Distance::Far).unwrap();
    let other = (weight * (covariance.try_inverse().unwrap() + more).try_inverse().unwrap()).trace().sqrt();
    assert!(next.photographs[0].uncertainty < 1.02 * other, "{} {other}", next.photographs[0].uncertainty);
}

#[test]
fn it_is_a_photograph_that_can_be_taken() {
    let scene = noisy(board(lens()));
    let prepared = scene.prepared(&settings("opencv5")).unwrap();
    let found = prepared.adjust().unwrap();
    let middle = Point3::new(120.0, 90.0, 0.0);
    let depths: Vec<f64> = scene.poses.iter().map(|pose| -pose.ray(&middle).z).collect();
    let [near, far] = [depths.iter().copied().fold(f64::INFINITY, f64::min), depths.iter().copied().fold(0.0, f64::max)];
    for photograph in &found.next(0).unwrap().photographs {
        assert_eq!(photograph.points.len(), 63, "the whole board, as in all photographs");
        let inside = |p: &PixelPoint| p.x > 0.0 && p.y > 0.0 && p.x < f64::from(SIZE.width - 1) && p.y < f64::from(SIZE.height - 1);
        assert!(photograph.points.iter().all(inside));
        assert!(near - 1.0 < photograph.depth && photograph.depth < far + 1.0, "{near} {far} {}", photograph.depth);
        let seen = found.camera(0).project(photograph.pose.ray(&middle)).unwrap();
        assert!(seen.distance(photograph.middle) < 1e-6);
        let normal = photograph.pose.rotation * Vector3::z();
        assert!((normal.z.acos() - photograph.tilt).abs() < 1e-9);
        let Some(towards) = photograph.nearer else { continue };
        // In the direction that is said, control is nearer.
        let nearer = |[x, y]: [f64; 2]| -> f64 {
            let at = PixelPoint::new(photograph.middle.x + 20.0 * x, photograph.middle.y + 20.0 * y);
            let ray = photograph.pose.world_from_ray(found.camera(0).unproject(at).unwrap());
            let on_board = photograph.pose.centre - ray * (photograph.pose.centre.z / ray.z);
            photograph.depth + photograph.pose.ray(&on_board).z
        };
        let (s, c) = towards.sin_cos();
        assert!(nearer([c, -s]) > 3.0 * nearer([s, c]).abs(), "{} {}", nearer([c, -s]), nearer([s, c]));
        let ahead = photograph.pose.rotation * Vector3::x();
        assert!((ahead.y.atan2(ahead.x) - photograph.along).abs() < 1e-9);
    }
}

#[test]
fn a_field_may_be_cut_off_where_it_was_before_and_in_three_dimensions() {
    let mut scene = noisy(wall(lens()));
    let prepared = scene.prepared(&settings("opencv5")).unwrap();
    let found = prepared.adjust().unwrap();
    let next = found.next(0).unwrap();
    assert!(next.photographs[0].uncertainty < next.usual, "{next:?}");
    if !next.whole {
        assert!(next.photographs.iter().any(|photograph| photograph.points.len() < 48));
    }
    // Nearer, no photograph shows all.
    scene.poses.iter_mut().for_each(|pose| pose.centre += (Point3::new(1400.0, 1000.0, 500.0) - pose.centre) * 0.6);
    let prepared = scene.prepared(&settings("opencv5")).unwrap();
    let found = prepared.adjust().unwrap();
    let next = found.next(0).unwrap();
    assert!(!next.whole && next.photographs.iter().all(|photograph| (8..48).contains(&photograph.points.len())), "{next:?}");
}

#[test]
fn where_nothing_can_be_proposed_is_said() {
    let mut scene = noisy(wall(lens()));
    scene.control = 4;
    let prepared = scene.prepared(&settings("opencv5")).unwrap();
    let said = prepared.adjust().unwrap().next(0).unwrap_err();
    assert!(said.contains("4 control points"), "{said}");
}

#[test]
fn photographs_together_tell_what_the_covariance_says() {
    for scene in [board(lens()), wall(lens())] {
        let scene = Scene { sigma: 1e-3, ..scene };
        let prepared = scene.prepared(&settings("opencv5")).unwrap();
        let found = prepared.adjust().unwrap();
        let (names, covariance) = found.covariances.of_camera(0);
        let sigma = found.solution.sigma0().unwrap() * prepared.settings.sigma();
        let network = &prepared.network;
        let sum: nalgebra::DMatrix<f64> = (0..scene.poses.len())
            .map(|image| {
                let seen =
                    network.observations.iter().filter(|o| o.image == image).map(|o| network.points[o.point].position).collect::<Vec<_>>();
                image_information(found.camera(0), &names, &found.solution.poses()[image], &seen, sigma).unwrap()
            })
            .sum();
        let product = sum * &covariance;
        for (i, j) in (0..names.len()).flat_map(|i| (0..names.len()).map(move |j| (i, j))) {
            let scale = (covariance[(j, j)] / covariance[(i, i)]).sqrt();
            let expected = f64::from(u8::from(i == j));
            assert!((product[(i, j)] / scale - expected).abs() < 1e-3, "{i} {j}: {}", product[(i, j)]);
        }
    }
}
