//! Where a calibration starts, and that it arrives from there.

use calibench_calibrate::{CalibrationError, Optics, Settings};
use calibench_model::camera::{Camera, CameraModel, DoubleSphere, Eucm, OpenCvFisheye};
use calibench_model::{ObservedStation, StationRow};

use crate::network::{SIZE, agrees, board, lens, optics, settings, wall};

#[test]
fn a_board_starts_from_zhangs_closed_form_and_arrives_at_the_truth() {
    let scene = board(lens());
    let prepared = scene.prepared(&settings("opencv5")).unwrap();
    // The seventh looks at the board square on: it says nothing of the principal distance.
    assert_eq!(prepared.origins, ["Zhang's closed form from 6 views of the plane"]);
    let found = prepared.adjust().unwrap();
    agrees(&found, &scene.camera, 1e-9);
    assert!(found.rms_px() < 1e-9 && found.cameras() == 1 && found.reliability.is_some());
    assert!(prepared.left_out.is_empty() && prepared.sights.len() == 7 * 63);
}

#[test]
fn control_with_depth_starts_from_the_direct_linear_transformation() {
    let scene = wall(lens());
    let prepared = scene.prepared(&settings("opencv5")).unwrap();
    assert_eq!(prepared.origins, ["the direct linear transformation (median of the images)"]);
    agrees(&prepared.adjust().unwrap(), &scene.camera, 1e-8);
}

/// Five points of an image are too few for eleven unknowns: focal lengths are tried.
#[test]
fn few_points_an_image_start_from_usual_focal_lengths() {
    let mut scene = wall(lens());
    scene.targets = [0, 5, 18, 23, 44].map(|target| scene.targets[target]).into();
    scene.control = scene.targets.len();
    let prepared = scene.prepared(&settings("opencv5")).unwrap();
    assert_eq!(prepared.origins, ["the best of some usual focal lengths"]);
    // Of 0.6, 1.2, 2.4 and 4.8 longer sides the one that is nearest to 1450 px of 1600.
    let Camera::OpenCv(start) = prepared.network.cameras[0].camera else { panic!("not OpenCV's model") };
    assert!((start.fx - 0.6 * 1600.0).abs() < 1e-6 || (start.fx - 1.2 * 1600.0).abs() < 1e-6, "{}", start.fx);
}

fn fisheye() -> Camera {
    OpenCvFisheye { size: SIZE, fx: 520.0, fy: 521.0, cx: 806.0, cy: 594.0, skew: 0.0, k: [0.02, -0.01, 3e-3, -5e-4] }.into()
}

/// The models of wide lenses, each from its own truth, by way of the equidistant one.
#[test]
fn wide_lenses_arrive_by_stages() {
    let sphere = DoubleSphere { size: SIZE, fx: 500.0, fy: 501.0, cx: 806.0, cy: 594.0, xi: -0.2, alpha: 0.6 };
    let eucm = Eucm { size: SIZE, fx: 530.0, fy: 531.0, cx: 806.0, cy: 594.0, alpha: 0.63, beta: 1.1 };
    for (model, camera) in [("opencv-fisheye", fisheye()), ("double-sphere", sphere.into()), ("eucm", eucm.into())] {
        let mut scene = board(camera);
        scene.poses.iter_mut().for_each(|pose| pose.centre.z *= 0.5);
        let prepared = scene.prepared(&settings(model)).unwrap();
        let staged = prepared.origins[0].ends_with(", then an adjustment with opencv-fisheye, converted");
        assert_eq!(staged, model != "opencv-fisheye", "{model}: {:?}", prepared.origins);
        agrees(&prepared.adjust().unwrap(), &scene.camera, 1e-7);
    }
}

#[test]
fn rational_models_start_by_way_of_five_coefficients() {
    let prepared = board(lens()).prepared(&settings("opencv8")).unwrap();
    assert!(prepared.origins[0].ends_with(", then an adjustment with opencv5, converted"), "{:?}", prepared.origins);
    // The lens is one that five coefficients hold but for k3: the start is all but the truth.
    let (start, truth) = (prepared.network.cameras[0].camera, lens());
    let place = calibench_model::PixelPoint { x: 300.0, y: 200.0 };
    let seen = start.project(truth.unproject(place).unwrap()).unwrap();
    assert!(seen.distance(place) < 0.01, "{seen:?}");
}

/// What is not solved for must stay what it is: no stage, no other lens.
#[test]
fn parameters_that_are_not_solved_for_stay_zero() {
    let scene = board(lens());
    let solve: Vec<String> = ["fx", "fy", "cx", "cy", "k1"].map(str::to_owned).into();
    let prepared = scene.prepared(&Settings::new(vec![Optics { solve: Some(solve), ..optics("opencv8") }])).unwrap();
    assert_eq!(prepared.origins, ["Zhang's closed form from 6 views of the plane"]);
    let found = prepared.adjust().unwrap();
    let rest = found.camera(0).parameters();
    assert!(rest.iter().skip(5).all(|parameter| parameter.value == 0.0), "{rest:?}");
    assert!(rest[4].value < -0.05 && found.rms_px() > 1e-3);
}

#[test]
fn a_camera_file_is_where_it_starts() {
    let scene = board(lens());
    let prepared = scene.prepared(&Settings::new(vec![Optics { start: Some(lens()), ..optics("opencv5") }])).unwrap();
    assert_eq!(prepared.origins, ["the camera file given"]);
    assert_eq!(prepared.network.cameras[0].camera, lens());
}

/// Tie points in rounds: the control is seen in all images, the others are intersected.
#[test]
fn tie_points_are_intersected_from_oriented_images() {
    let mut scene = wall(lens());
    scene.control = 20;
    let prepared = scene.prepared(&settings("opencv5")).unwrap();
    assert_eq!((prepared.survey.control_points(), prepared.network.points.len()), (20, 48));
    let found = prepared.adjust().unwrap();
    agrees(&found, &scene.camera, 1e-7);
    for (place, point) in found.solution.points().iter().enumerate() {
        let target: usize = prepared.network.points[place].name[1..].parse().unwrap();
        assert!((point - scene.targets[target]).norm() < 1e-4, "t{target}");
    }
}

/// A target of one image has no point; the sight is left out with the reason.
#[test]
fn a_tie_point_of_one_image_is_left_out() {
    let mut scene = wall(lens());
    scene.control = 47;
    let whole = scene.points();
    let last = "t47";
    let mut points = calibench_model::Points::default();
    let mut seen = 0;
    for row in whole.rows() {
        seen += usize::from(row.target == last);
        if row.target != last || seen == 1 {
            points.push(row.image, row.target, row.start);
        }
    }
    let prepared = calibench_calibrate::prepare(points, &scene.known(), &settings("opencv5")).unwrap();
    assert_eq!(prepared.left_out.len(), 1);
    assert_eq!(prepared.survey.target(prepared.survey.sight(prepared.left_out[0].sight).target), last);
    assert!(prepared.left_out[0].why.contains("not seen in two oriented images"), "{:?}", prepared.left_out);
    assert_eq!(prepared.sights.len() + 1, prepared.survey.sights());
}

fn station(scene: &crate::network::Scene, image: usize, name: &str) -> ObservedStation {
    ObservedStation {
        station: StationRow { image: name.into(), pose: scene.poses[image] },
        centre: Some([1.0; 3]),
        rotation: Some([0.01; 3]),
    }
}

/// An image with three control points has no resection: its pose must be observed, by its name with or without ending.
#[test]
fn an_observed_pose_stands_in_for_a_resection() {
    let scene = wall(lens());
    let whole = scene.points();
    let mut points = calibench_model::Points::default();
    for row in whole.rows() {
        let few = ["t0", "t9", "t20"].contains(&row.target);
        if row.image != "image_2.png" || few {
            points.push(row.image, row.target, row.start);
        }
    }
    let without = calibench_calibrate::prepare(points.clone(), &scene.known(), &settings("opencv5"));
    let Err(CalibrationError::NoPose { images }) = without else { panic!("{without:?}") };
    assert!(images.len() == 1 && images[0].0 == "image_2.png" && images[0].1.contains("3 known points"), "{images:?}");
    for name in ["image_2", "image_2.png"] {
        let settings = Settings { stations: vec![station(&scene, 2, name)], ..settings("opencv5") };
        let prepared = calibench_calibrate::prepare(points.clone(), &scene.known(), &settings).unwrap();
        agrees(&prepared.adjust().unwrap(), &scene.camera, 1e-7);
    }
    let settings = Settings { stations: vec![station(&scene, 2, "image_3x")], ..settings("opencv5") };
    let error = calibench_calibrate::prepare(points, &scene.known(), &settings).unwrap_err();
    assert!(matches!(&error, CalibrationError::StationOfNone { image, .. } if image == "image_3x"), "{error}");
}
