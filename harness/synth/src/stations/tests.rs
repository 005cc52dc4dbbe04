use std::f64::consts::{FRAC_PI_2, PI};

use calibench_model::camera::{Camera, CameraModel, ImageSize, Photogrammetric};
use calibench_model::{Pose, Testfield};
use calibench_random::Key;
use nalgebra::{Point3, Vector3};

use super::*;
use crate::testfield::{Chessboard, Levels};

const KEY: Key<'_> = Key { seed: 3, of: "stations", trial: 0, view: "", target: "" };

fn board() -> Testfield {
    let board = Chessboard {
        rows: 6,
        columns: 9,
        square: 30.0,
        margin: 15.0,
        bend: None,
        print_noise: 0.0,
        levels: Levels::default(),
        background: 0.5,
    };
    board.generate(KEY).unwrap()
}

fn camera() -> Camera {
    let size = ImageSize { width: 1000, height: 800 };
    Photogrammetric { size, pitch_um: 5.0, c: 8.0, x0: 0.0, y0: 0.0, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2] }.into()
}

/// The direction in which a camera looks.
fn sight(pose: &Pose) -> Vector3<f64> {
    -pose.rotation.row(2).transpose()
}

fn degrees(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| value.to_radians()).collect()
}

#[test]
fn the_aim_of_a_board_is_its_middle_seen_upright_from_its_front() {
    let aim = Aim::of(&board()).unwrap();
    assert_eq!(aim.middle, Point3::new(120.0, -75.0, 0.0));
    assert_eq!((aim.facing.into_inner(), aim.up.into_inner(), aim.right()), (Vector3::z(), Vector3::y(), Vector3::x()));
    assert!(Aim::new(aim.middle, Vector3::z(), Vector3::z()).is_none());
    assert!(Aim::of(&Testfield { targets: Vec::new(), ..board() }).is_none());
}

#[test]
fn a_view_from_the_front_shows_the_board_upright() {
    let (field, camera) = (board(), camera());
    let aim = Aim::of(&field).unwrap();
    let views = BoardViews { tilts: vec![[0.0, 0.0]], distances: vec![800.0], rolls: vec![0.0] }.generate(&aim).unwrap();
    assert_eq!((views.len(), views[0].name.as_str()), (1, "s01"));
    let at = |id: &str| {
        let target = field.targets.iter().find(|target| target.id == id).unwrap();
        camera.project(views[0].pose.ray(&field.position(target))).unwrap()
    };
    let (first, right, below) = (at("r1c1"), at("r1c2"), at("r2c1"));
    // c / pitch / distance = 2 px per mm.
    assert!((first.x - (499.5 - 240.0)).abs() < 1e-9 && (first.y - (399.5 - 150.0)).abs() < 1e-9, "{first:?}");
    assert!((right.x - first.x - 60.0).abs() < 1e-9 && (below.y - first.y - 60.0).abs() < 1e-9);
    assert_eq!(sees(&camera, &views[0].pose, &field), 1.0);
}

#[test]
fn a_tilt_turns_the_board_before_the_camera() {
    let aim = Aim::of(&board()).unwrap();
    let views = BoardViews { tilts: vec![[0.5, 0.0], [0.0, 0.5], [0.4, 0.3]], distances: vec![800.0, 900.0], rolls: vec![0.0] };
    let views = views.generate(&aim).unwrap();
    assert_eq!(views.len(), 6);
    let seen = |i: usize, x: f64, y: f64| views[i].pose.camera_from_world(&(aim.middle + Vector3::new(x, y, 0.0)));
    // About u: the upper side comes nearer (z grows towards the camera's back), the right side keeps its depth.
    assert!((seen(0, 0.0, 10.0) - Vector3::new(0.0, 10.0 * 0.5_f64.cos(), 10.0 * 0.5_f64.sin() - 800.0)).norm() < 1e-9);
    assert!((seen(0, 10.0, 0.0) - Vector3::new(10.0, 0.0, -800.0)).norm() < 1e-9);
    // About v: the right side goes back.
    assert!((seen(1, 10.0, 0.0) - Vector3::new(10.0 * 0.5_f64.cos(), 0.0, -10.0 * 0.5_f64.sin() - 800.0)).norm() < 1e-9);
    // Both: the normal is R_v R_u z.
    let normal = views[2].pose.rotation * Vector3::z();
    assert!((normal - Vector3::new(0.4_f64.cos() * 0.3_f64.sin(), -0.4_f64.sin(), 0.4_f64.cos() * 0.3_f64.cos())).norm() < 1e-12);
    assert!(views[3..].iter().all(|view| ((view.pose.centre - aim.middle).norm() - 900.0).abs() < 1e-9));
}

#[test]
fn a_ring_stands_around_the_normal_and_rolls_by_right_angles() {
    let aim = Aim::of(&board()).unwrap();
    let ring = Ring { count: 4, angle: 0.6, start: 0.0, distances: vec![700.0, 900.0], rolls: degrees(&[0.0, 90.0, 180.0, 270.0]) };
    let stations = ring.generate(&aim).unwrap();
    assert_eq!((stations.len(), stations[0].name.as_str(), stations[15].name.as_str()), (16, "s01-r1", "s04-r4"));
    for (i, station) in stations.iter().enumerate() {
        let towards = aim.middle - station.pose.centre;
        assert!((towards.norm() - [700.0, 900.0][i / 4 % 2]).abs() < 1e-9);
        assert!((sight(&station.pose) - towards.normalize()).norm() < 1e-12);
        assert!((sight(&station.pose).dot(&-Vector3::z()) - 0.6_f64.cos()).abs() < 1e-12);
    }
    for four in stations.chunks(4) {
        for pair in four.windows(2) {
            let relative = pair[1].pose.rotation * pair[0].pose.rotation.transpose();
            assert!((relative[(0, 1)] - 1.0).abs() < 1e-12 && (relative[(1, 0)] + 1.0).abs() < 1e-12, "{relative}");
        }
    }
    assert!(stations[0].pose.centre.x > aim.middle.x && stations[4].pose.centre.y > aim.middle.y);
    check_names(&stations).unwrap();
}

#[test]
fn an_arc_spans_its_convergence_at_its_heights() {
    let aim = Aim::of(&board()).unwrap();
    let arc = Arc { count: 3, convergence: FRAC_PI_2, distances: vec![800.0], heights: vec![0.0], rolls: vec![0.0] };
    let stations = arc.generate(&aim).unwrap();
    let (first, middle, last) = (&stations[0].pose, &stations[1].pose, &stations[2].pose);
    assert!((sight(first).angle(&sight(last)) - FRAC_PI_2).abs() < 1e-12);
    assert!(first.centre.x < aim.middle.x && last.centre.x > aim.middle.x, "from left to right");
    assert!((middle.centre - Point3::new(120.0, -75.0, 800.0)).norm() < 1e-9);
    let heights = Arc { heights: vec![0.0, 100.0], ..arc.clone() }.generate(&aim).unwrap();
    let above: Vec<f64> = heights.iter().map(|station| (station.pose.centre - aim.middle).dot(&aim.up)).collect();
    assert!(above.iter().zip([0.0, 100.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-9));
    let one = Arc { count: 1, ..arc }.generate(&aim).unwrap();
    assert!((one[0].pose.centre - middle.centre).norm() < 1e-9);
}

#[test]
fn random_stations_keep_their_bounds_and_their_seed() {
    let (field, camera) = (board(), camera());
    let aim = Aim::of(&field).unwrap();
    let views = RandomViews { count: 200, distance: [700.0, 1200.0], tilt: 0.7, roll: PI, aside: [60.0, 40.0] };
    let all = views.generate(&aim, KEY, |_| true).unwrap();
    for station in &all {
        let back = -sight(&station.pose);
        assert!(back.dot(&aim.facing) >= 0.7_f64.cos() - 1e-12);
        // Where the axis meets the board.
        let distance = (station.pose.centre.z - aim.middle.z) / back.z;
        let at = station.pose.centre - back * distance - aim.middle;
        assert!((700.0..=1200.0).contains(&distance) && at.x.abs() <= 60.0 && at.y.abs() <= 40.0);
    }
    assert!(all.iter().any(|s| sees(&camera, &s.pose, &field) < 1.0), "some cut the board off");
    let whole = views.generate(&aim, KEY, |pose| sees(&camera, pose, &field) == 1.0).unwrap();
    check_sight(&camera, &whole, &field, 1.0).unwrap();
    assert!(all.iter().zip(&whole).filter(|(a, b)| a == b).count() > 50, "a pose that is good at once stays");
    let fewer = RandomViews { count: 10, ..views }.generate(&aim, KEY, |_| true).unwrap();
    assert_eq!(fewer[..], all[..10]);
    assert_ne!(all, views.generate(&aim, Key { seed: 4, ..KEY }, |_| true).unwrap());
    let none = views.generate(&aim, KEY, |_| false);
    assert_eq!(none, Err(StationError::NoneSees { name: "s01".into(), tries: 1000 }));
}

#[test]
fn a_station_that_does_not_see_the_field_is_named() {
    let (field, camera) = (board(), camera());
    let aim = Aim::of(&field).unwrap();
    let good = BoardViews { tilts: vec![[0.2, 0.1]], distances: vec![800.0], rolls: vec![0.0] }.generate(&aim).unwrap().remove(0);
    let away = |name: &str, centre: Point3<f64>, target: Point3<f64>| {
        Station::new(name.into(), Pose::looking_at(centre, target, Vector3::y(), 0.0).unwrap())
    };
    let front = aim.middle + Vector3::z() * 800.0;
    let bad = [
        away("turned away", front, front + Vector3::z()),
        away("outside the frame", front, front + Vector3::new(1.0, 0.0, -0.2)),
        away("from the back", aim.middle - Vector3::z() * 800.0, aim.middle),
    ];
    for station in bad {
        assert_eq!(sees(&camera, &station.pose, &field), 0.0, "{}", station.name);
        match check_sight(&camera, &[good.clone(), station.clone()], &field, 0.0) {
            Err(StationError::Unseen { name, seen: 0, all: 54, least: 1 }) => assert_eq!(name, station.name),
            other => panic!("{}: {other:?}", station.name),
        }
    }
    let near = away("near", aim.middle + Vector3::z() * 300.0, aim.middle);
    let part = sees(&camera, &near.pose, &field);
    assert!(part > 0.1 && part < 0.9, "{part}");
    assert!(check_sight(&camera, std::slice::from_ref(&near), &field, 0.1).is_ok());
    assert!(check_sight(&camera, &[near], &field, 0.95).is_err());
    assert_eq!(check_names(&[good.clone(), good]), Err(StationError::Twice("s01".into())));
}

#[test]
fn bad_parameters_are_named() {
    let aim = Aim::of(&board()).unwrap();
    let ring = Ring { count: 4, angle: 0.6, start: 0.0, distances: vec![700.0], rolls: vec![0.0] };
    let arc = Arc { count: 3, convergence: 1.0, distances: vec![800.0], heights: vec![0.0], rolls: vec![0.0] };
    let views = BoardViews { tilts: vec![[0.5, 0.0]], distances: vec![800.0], rolls: vec![0.0] };
    let random = RandomViews { count: 2, distance: [700.0, 1200.0], tilt: 0.7, roll: PI, aside: [0.0, 0.0] };
    let made = |views: RandomViews| views.generate(&aim, KEY, |_| true);
    let bad = [
        ("count", Ring { count: 0, ..ring.clone() }.generate(&aim)),
        ("angle", Ring { angle: 1.6, ..ring.clone() }.generate(&aim)),
        ("start", Ring { start: f64::NAN, ..ring.clone() }.generate(&aim)),
        ("distances", Ring { distances: vec![0.0], ..ring.clone() }.generate(&aim)),
        ("rolls", Ring { rolls: vec![99.0], ..ring.clone() }.generate(&aim)),
        ("count", Arc { count: 1001, ..arc.clone() }.generate(&aim)),
        ("convergence", Arc { convergence: -0.1, ..arc.clone() }.generate(&aim)),
        ("distances", Arc { distances: vec![f64::NAN], ..arc.clone() }.generate(&aim)),
        ("heights", Arc { heights: vec![f64::INFINITY], ..arc.clone() }.generate(&aim)),
        ("tilts", BoardViews { tilts: vec![[1.6, 0.0]], ..views.clone() }.generate(&aim)),
        ("distances", BoardViews { distances: vec![-1.0], ..views.clone() }.generate(&aim)),
        ("rolls", BoardViews { rolls: vec![f64::NAN], ..views.clone() }.generate(&aim)),
        ("count", made(RandomViews { count: 0, ..random })),
        ("distance", made(RandomViews { distance: [0.0, 1.0], ..random })),
        ("distance", made(RandomViews { distance: [3.0, 1.0], ..random })),
        ("tilt", made(RandomViews { tilt: 2.0, ..random })),
        ("roll", made(RandomViews { roll: 4.0, ..random })),
        ("aside", made(RandomViews { aside: [0.0, -1.0], ..random })),
    ];
    for (name, result) in bad {
        assert!(matches!(&result, Err(StationError::Parameter { parameter, .. }) if *parameter == name), "{name}: {result:?}");
    }
    let empty = [
        ("distances", Ring { distances: vec![], ..ring.clone() }.generate(&aim)),
        ("rolls", Ring { rolls: vec![], ..ring }.generate(&aim)),
        ("heights", Arc { heights: vec![], ..arc }.generate(&aim)),
        ("tilts", BoardViews { tilts: vec![], ..views.clone() }.generate(&aim)),
        ("distances", BoardViews { distances: vec![], ..views }.generate(&aim)),
    ];
    for (name, result) in empty {
        assert_eq!(result, Err(StationError::Empty(name)));
    }
}
