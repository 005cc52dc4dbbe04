//! What other tools adjusted, adjusted anew.

use calibench_calibrate::{Behind, GrossErrors, Reconstructed, Settings, Solved, calibrate, prepare_reconstruction};
use calibench_model::camera::{Agisoft, AgisoftVersion, Camera, CameraModel};
use calibench_model::reconstruction::{OrientedImage, ReconstructedCamera, TiePoint, TieSight};
use calibench_model::{NamedCamera, PixelPoint, Pose, Reconstruction};
use nalgebra::{Point3, Rotation3, Vector3};

use crate::network::SIZE;

fn lens(f: f64, k1: f64) -> Camera {
    Agisoft { size: SIZE, version: AgisoftVersion::Metashape, f, cx: 0.0, cy: 0.0, b1: 0.0, b2: 0.0, k: [k1, 0.02, 0.0, 0.0], p: [0.0; 4] }
        .into()
}

/// Numbers from -1 to 1 that are scattered and the same everywhere.
fn scattered(k: usize) -> f64 {
    2.0 * ((k as f64 + 1.0) * 0.569_840_291 + ((k * k) as f64) * 0.321).fract() - 1.0
}

/// A ring of images around points, each with a camera of its own, as Bundler has it; start values are off by a few pixels, sights by `noise` px.
fn ring(noise: f64) -> (Reconstruction, Vec<Camera>) {
    let count = 10;
    let truth: Vec<Camera> = (0..count).map(|i| lens(1500.0 + 20.0 * scattered(i), -0.1 + 0.02 * scattered(40 + i))).collect();
    let station = |i: usize| {
        let turn = std::f64::consts::TAU * i as f64 / count as f64;
        let centre = Point3::new(8.0 * turn.cos(), 8.0 * turn.sin(), 3.0 + scattered(90 + i));
        Pose::looking_at(centre, Point3::new(0.2 * scattered(i), 0.0, 0.0), Vector3::z(), 0.5 * i as f64).unwrap()
    };
    let poses: Vec<Pose> = (0..count).map(station).collect();
    let points: Vec<Point3<f64>> =
        (0..60).map(|j| Point3::new(2.4 * scattered(3 * j + 500), 2.4 * scattered(3 * j + 501), 1.5 * scattered(3 * j + 502))).collect();
    let mut sights = Vec::new();
    for (image, (pose, camera)) in poses.iter().zip(&truth).enumerate() {
        for (point, position) in points.iter().enumerate() {
            let at = camera.project(pose.ray(position)).unwrap();
            let off = |k: usize| noise * (scattered(7 * (image * 60 + point) + k) + scattered(11 * (image * 60 + point) + k + 3));
            sights.push(TieSight { image, point, position: PixelPoint::new(at.x + off(0), at.y + off(1)) });
        }
    }
    let camera = |i: usize| ReconstructedCamera {
        named: NamedCamera::new(format!("c{i}"), lens(1490.0, -0.08)),
        lens: vec!["f", "k1", "k2"],
        principal_point: Vec::new(),
    };
    let image = |(i, pose): (usize, &Pose)| {
        let turn = Rotation3::new(Vector3::new(scattered(i), scattered(i + 9), scattered(i + 17)) * 2e-3);
        let centre = pose.centre + Vector3::new(scattered(i + 30), scattered(i + 31), scattered(i + 33)) * 0.01;
        OrientedImage { name: format!("i{i}"), camera: i, pose: Pose { rotation: turn * pose.rotation, centre } }
    };
    let point = |(j, p): (usize, &Point3<f64>)| {
        let off = Vector3::new(scattered(j), scattered(j + 70), scattered(j + 71)) * 0.01;
        TiePoint { name: format!("{j}"), position: p + off }
    };
    let reconstruction = Reconstruction {
        cameras: (0..count).map(camera).collect(),
        images: poses.iter().enumerate().map(image).collect(),
        points: points.iter().enumerate().map(point).collect(),
        sights,
        notes: Vec::new(),
    };
    (reconstruction, truth)
}

fn settings() -> Settings {
    Settings { sigma_px: Some(0.5), gross: GrossErrors::Kept, ..Settings::new(Vec::new()) }
}

fn prepared(reconstruction: &Reconstruction, behind: Behind) -> Reconstructed {
    prepare_reconstruction(reconstruction, (&Solved::Lens, behind), &settings()).unwrap()
}

#[test]
fn exact_sights_give_the_cameras_that_took_them() {
    let (reconstruction, truth) = ring(0.0);
    let found = prepared(&reconstruction, Behind::Count);
    assert!(found.doubts(Behind::Count).is_empty());
    let adjusted = found.prepared.adjust().unwrap();
    assert!(adjusted.solution.cost() < 1e-12, "{}", adjusted.solution.cost());
    for (camera, truth) in adjusted.solution.cameras().iter().zip(&truth) {
        let differ =
            camera.parameters().iter().zip(truth.parameters()).any(|(a, b)| (a.value - b.value).abs() > 1e-6 * b.value.abs().max(1.0));
        assert!(!differ, "{camera:?} {truth:?}");
    }
    let counts = adjusted.solution.counts();
    // Ten poses and lenses of three parameters, sixty points; seven of the frame are held.
    assert_eq!((counts.observations(), counts.unknowns, counts.constraints), (1200 + 7, 90 + 180, 7));
}

/// Each image has a pose of its own, and that is said of cameras that the tool took as a rig.
#[test]
fn cameras_of_a_rig_are_named_as_no_rig() {
    let (mut reconstruction, _) = ring(0.0);
    // Camera 1 has no image that takes part: camera 3 is then alone.
    reconstruction.sights.retain(|sight| sight.image != 1);
    let mut found = prepared(&reconstruction, Behind::Count);
    assert!(found.prepared.notes.is_empty());
    found.note_rigs(&reconstruction, &[vec![3, 1], vec![0, 2, 4]]);
    let notes = &found.prepared.notes;
    assert!(notes.len() == 1 && notes[0].starts_with("the file has cameras c0, c2, c4 as a rig; here they are not"), "{notes:?}");
}

/// A sight whose point is on the other side of the camera: the mirrored ray gives the same pixel, and the adjustment is the one of a camera that looks the other way.
#[test]
fn points_behind_cameras_count_by_the_line_through_the_centre() {
    let (mut reconstruction, _) = ring(0.3);
    // A point far behind the first image, seen by two others in front of them and where the first shows it through its centre.
    let pose = reconstruction.images[0].pose;
    let centre = pose.centre;
    let behind = centre + pose.rotation.transpose() * Vector3::new(0.3, -0.2, 6.0);
    let index = reconstruction.points.len();
    reconstruction.points.push(TiePoint { name: "ghost".into(), position: behind });
    let mut pictured = 0;
    for image in 0..reconstruction.images.len() {
        let (camera, ray) = (reconstruction.cameras[image].named.camera, reconstruction.images[image].pose.ray(&behind));
        let mirrored = calibench_model::camera::Ray { x: -ray.x, y: -ray.y, z: -ray.z };
        let Ok(position) = camera.project(ray).or_else(|_| camera.project(mirrored)) else { continue };
        pictured += 1;
        reconstruction.sights.push(TieSight { image, point: index, position });
    }
    assert!(pictured > 3);
    let counted = prepared(&reconstruction, Behind::Count);
    let left = prepared(&reconstruction, Behind::LeaveOut);
    assert!(counted.behind.contains(&["i0".into(), "ghost".into()]), "{:?}", counted.behind);
    assert_eq!(counted.behind, left.behind);
    let flags = |found: &Reconstructed| found.prepared.network.observations.iter().filter(|o| o.behind).count();
    assert_eq!((flags(&counted), flags(&left)), (counted.behind.len(), 0));
    assert_eq!(left.prepared.network.observations.len() + left.behind.len(), reconstruction.sights.len());
    assert!(counted.doubts(Behind::Count)[0].contains("ghost in i0") && counted.doubts(Behind::Count)[0].contains("they count"));
    let adjusted = counted.prepared.adjust().unwrap();
    let sum: f64 = adjusted.solution.each_residual().filter_map(|r| r.v).map(|[x, y]| (x * x + y * y) / 0.25).sum();
    assert!((sum / adjusted.solution.cost() - 1.0).abs() < 1e-9);
    // At the minimum the sum changes by the square of a step: derivatives of what lies behind are right too.
    let position = adjusted.solution.points()[index];
    let of = |position: Point3<f64>| -> f64 {
        let one = |o: &calibench_adjust::ImageObservation| {
            let ray = adjusted.solution.poses()[o.image].ray(&position);
            let ray = if o.behind { calibench_model::camera::Ray { x: -ray.x, y: -ray.y, z: -ray.z } } else { ray };
            let at = adjusted.solution.cameras()[o.image].project(ray).unwrap();
            (at.x - o.position.x).powi(2) + (at.y - o.position.y).powi(2)
        };
        counted.prepared.network.observations.iter().filter(|o| o.point == index).map(one).sum()
    };
    for axis in 0..3 {
        let step = Vector3::ith(axis, 1e-4);
        let (up, down, at) = (of(position + step), of(position - step), of(position));
        assert!((up - down).abs() < 1e-3 * (up + down - 2.0 * at), "{axis}: {up} {down} {at}");
    }
}

#[test]
fn what_is_too_little_is_left_out_by_name() {
    let (mut reconstruction, _) = ring(0.3);
    // An image of three points, and a point of one image.
    reconstruction.images.push(OrientedImage { name: "lonely".into(), ..reconstruction.images[0].clone() });
    let last = reconstruction.images.len() - 1;
    let three: Vec<TieSight> = reconstruction.sights[..3].iter().map(|sight| TieSight { image: last, ..*sight }).collect();
    reconstruction.sights.extend(three);
    reconstruction.points.push(TiePoint { name: "once".into(), position: Point3::origin() });
    let once = reconstruction.points.len() - 1;
    reconstruction.sights.push(TieSight { image: 4, point: once, position: PixelPoint::new(800.0, 600.0) });
    let found = prepared(&reconstruction, Behind::Count);
    assert_eq!(found.left_out_images, ["lonely"]);
    assert_eq!(found.prepared.left_out.len(), 1);
    assert!(found.prepared.left_out[0].why.contains("one image alone"), "{:?}", found.prepared.left_out);
    let adjusted = found.prepared.adjust().unwrap();
    let (after, errors) = adjusted.reconstruction(&reconstruction);
    assert_eq!((after.images.len(), after.points.len(), after.sights.len(), errors.len()), (10, 60, 600, 60));
    assert!(errors.iter().all(|error| (0.0..2.0).contains(error)));
}

/// Of a point with two rays that do not meet either may be wrong: it takes no part, by name; a wrong ray of many is left out alone.
#[test]
fn a_point_whose_last_two_rays_do_not_meet_is_left_out_by_name() {
    let (mut reconstruction, truth) = ring(0.3);
    let others = reconstruction.points.len();
    let place = Point3::new(0.2, -0.1, 0.3);
    reconstruction.points.push(TiePoint { name: "disputed".into(), position: place });
    for (image, off) in [(2, 0.0), (5, 40.0)] {
        let position = truth[image].project(reconstruction.images[image].pose.ray(&place)).unwrap();
        let position = PixelPoint::new(position.x + 0.7 * off, position.y + off);
        reconstruction.sights.push(TieSight { image, point: others, position });
    }
    reconstruction.sights[17].position.x += 30.0;
    let sought = Settings { gross: GrossErrors::Sought, ..settings() };
    let found = prepare_reconstruction(&reconstruction, (&Solved::Lens, Behind::Count), &sought).unwrap();
    calibrate(&found.prepared, &[], |calibration| {
        assert_eq!(calibration.prepared.disputed, ["disputed"]);
        assert_eq!((calibration.prepared.left_out.len(), calibration.solution.points().len()), (2, others));
        assert_eq!(calibration.found.iter().filter(|found| found.left_out).count(), 1, "{:?}", calibration.found);
        let sigma0 = calibration.solution.sigma0().unwrap();
        assert!((0.3..0.7).contains(&sigma0), "{sigma0}");
    })
    .unwrap();
}

/// Rays that part as they go have no point, however far off: the adjustment would chase it for ever.
#[test]
fn a_point_that_runs_away_is_left_out_by_name() {
    let (mut reconstruction, truth) = ring(0.3);
    let others = reconstruction.points.len();
    let ahead = Vector3::new(-1.0, 0.1, -0.2).normalize();
    // The first of all, and seen first, so that those that stay have other places than before.
    reconstruction.points.insert(0, TiePoint { name: "sun".into(), position: Point3::from(80.0 * ahead) });
    reconstruction.sights.iter_mut().for_each(|sight| sight.point += 1);
    for image in [9, 0, 1] {
        let pose = reconstruction.images[image].pose;
        let parting = ahead + 2e-3 * (pose.centre.coords - Vector3::new(7.0, 0.0, 3.0));
        let ray = pose.ray(&(pose.centre + parting));
        let position = truth[image].project(ray).unwrap();
        reconstruction.sights.insert(0, TieSight { image, point: 0, position });
    }
    let found = prepared(&reconstruction, Behind::Count);
    assert!(found.behind.is_empty() && found.prepared.left_out.is_empty());
    calibrate(&found.prepared, &[], |calibration| {
        assert_eq!(calibration.prepared.far, ["sun"]);
        assert_eq!((calibration.prepared.left_out.len(), calibration.solution.points().len()), (3, others));
        assert!(calibration.prepared.left_out.iter().all(|left_out| left_out.why.contains("very far away")));
        let sigma0 = calibration.solution.sigma0().unwrap();
        assert!((0.3..0.7).contains(&sigma0), "{sigma0}");
    })
    .unwrap();
    // Where a length to it is asked for it stays, and is named.
    let asked = Settings { lengths: vec![["3".into(), "sun".into()]], ..settings() };
    let found = prepare_reconstruction(&reconstruction, (&Solved::Lens, Behind::Count), &asked).unwrap();
    let error = calibrate(&found.prepared, &[], |_| ()).unwrap_err().to_string();
    assert!(error.contains("sun"), "{error}");
}

#[test]
fn mistakes_are_named() {
    let (reconstruction, _) = ring(0.3);
    let refused = |reconstruction: &Reconstruction, solved: &Solved| {
        prepare_reconstruction(reconstruction, (solved, Behind::Count), &settings()).map(|_| ()).unwrap_err().to_string()
    };
    let error = refused(&reconstruction, &Solved::Named(vec!["f".into(), "kk1".into()]));
    assert!(error.contains("camera c0 has no parameter `kk1`; it has f, cx, cy"), "{error}");
    let mut twice = reconstruction.clone();
    twice.sights.push(twice.sights[5]);
    let error = refused(&twice, &Solved::Lens);
    assert!(error.contains("image i0 shows point 5 twice"), "{error}");
    let mut named_alike = reconstruction.clone();
    named_alike.images[3].name = "i1".into();
    assert!(refused(&named_alike, &Solved::Lens).contains("two images are called `i1`"));
    let none = Reconstruction { sights: Vec::new(), ..reconstruction };
    assert!(refused(&none, &Solved::Lens).contains("no image shows 4 points or more"));
}
