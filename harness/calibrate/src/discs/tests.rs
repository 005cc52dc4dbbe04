//! Networks of discs whose image points are centroids of polygons: no formula of the correction's own.

use calibench_exchange::points::parse_points;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{ControlDisc, ControlRow, Points};
use nalgebra::{Point3, Vector3};

use crate::scenes::{Scene, agrees, board, lens, settings, wall};
use crate::{CalibrationError, Discs, Settings, calibrate, prepare};

/// Corners of a polygon in place of an outline: its centroid is off by less than 1e-7 px.
const CORNERS: u32 = 20_000;

/// The centroid of a disc's picture.
fn centroid(scene: &Scene, pose: usize, centre: &Point3<f64>, normal: &Vector3<f64>, radius: f64) -> Option<[f64; 2]> {
    let a = normal.cross(&Vector3::new(0.3, 0.9, -0.2)).normalize();
    let b = normal.normalize().cross(&a);
    let at = scene.camera.project(scene.poses[pose].ray(centre)).ok()?;
    let corner = |place: u32| {
        let (sine, cosine) = (f64::from(place) * std::f64::consts::TAU / f64::from(CORNERS)).sin_cos();
        let seen = scene.camera.project(scene.poses[pose].ray(&(centre + (a * cosine + b * sine) * radius))).ok()?;
        Some([seen.x - at.x, seen.y - at.y])
    };
    let (mut twice, mut first) = (0.0, [0.0; 2]);
    for place in 0..CORNERS {
        let ([x, y], [u, v]) = (corner(place)?, corner(place + 1)?);
        let swept = x * v - u * y;
        twice += swept;
        first = [first[0] + swept * (x + u) / 3.0, first[1] + swept * (y + v) / 3.0];
    }
    Some([at.x + first[0] / twice, at.y + first[1] / twice])
}

/// The image points of a scene whose targets are discs, of the kinds of `kind`.
fn points(scene: &Scene, normal: impl Fn(usize) -> Vector3<f64>, radius: f64, kind: impl Fn(usize) -> &'static str) -> Points {
    let mut text = String::from("image,target,x,y,kind\n");
    for image in 0..scene.poses.len() {
        for (target, position) in scene.targets.iter().enumerate() {
            let seen = match kind(target) {
                "disc" => centroid(scene, image, position, &normal(target), radius),
                _ => scene.camera.project(scene.poses[image].ray(position)).ok().map(|at| [at.x, at.y]),
            };
            let size = scene.camera.size();
            let inside =
                |[x, y]: &[f64; 2]| (40.0..f64::from(size.width) - 40.0).contains(x) && (40.0..f64::from(size.height) - 40.0).contains(y);
            if let Some([x, y]) = seen.filter(inside) {
                text += &format!("image_{image}.png,t{target},{x},{y},{}\n", kind(target));
            }
        }
    }
    parse_points("points.csv", text.as_bytes()).unwrap().points
}

fn control(scene: &Scene, disc: impl Fn(usize) -> Option<ControlDisc>) -> Vec<ControlRow> {
    let row = |(index, row): (usize, ControlRow)| ControlRow { disc: disc(index).map(Box::new), ..row };
    scene.known().into_iter().enumerate().map(row).collect()
}

fn of(discs: Option<Discs>) -> Settings {
    Settings { discs, ..settings("opencv5") }
}

/// Root mean square of the residuals, px, and the camera.
fn calibrated(points: &Points, control: &[ControlRow], settings: &Settings, truth: &Camera, within: f64) -> Result<f64, CalibrationError> {
    let prepared = prepare(points.clone(), control, settings)?;
    calibrate(&prepared, &[], |calibration| {
        agrees(calibration, truth, within);
        calibration.rms_px()
    })
}

/// Each disc on a plate of its own, which its neighbours say nothing of.
fn leaning(target: usize) -> Vector3<f64> {
    let t = target as f64;
    Vector3::new(0.3 * (1.3 * t).sin(), 0.3 * (0.7 * t).cos(), 1.0)
}

#[test]
fn a_wall_of_discs_gives_the_camera_without_bias() {
    let scene = wall(lens());
    let points = points(&scene, leaning, 120.0, |_| "disc");
    let control = control(&scene, |target| Some(ControlDisc { radius: 120.0, normal: Some(leaning(target).into()) }));
    let centred = calibrated(&points, &control, &of(Some(Discs::Control)), &scene.camera, 1e-6).unwrap();
    assert!(centred < 1e-5, "{centred} px");
    let prepared = prepare(points, &control, &of(None)).unwrap();
    calibrate(&prepared, &[], |plain| {
        let untaken = plain.untaken().unwrap();
        assert!(plain.rms_px() > 0.03 && untaken.largest() > 0.1, "{} px, {}", plain.rms_px(), untaken.largest());
        let (c, truth) = (plain.camera(0).parameters()[0].value, scene.camera.parameters()[0].value);
        assert!((c - truth).abs() > 0.05, "{c}");
    })
    .unwrap();
}

/// The neighbours on a board tell its plane; squares among them are left as they are.
#[test]
fn planes_come_from_the_neighbours_and_squares_stay() {
    let scene = board(lens());
    let kind = |target: usize| if target.is_multiple_of(3) { "square" } else { "disc" };
    let points = points(&scene, |_| Vector3::z(), 12.0, kind);
    let plain = control(&scene, |_| None);
    for (control, discs) in [
        (&plain, Discs::Radius(12.0)),
        (&control(&scene, |_| Some(ControlDisc { radius: 12.0, normal: None })), Discs::Control),
        // What the file states comes before what is said of all.
        (&control(&scene, |_| Some(ControlDisc { radius: 12.0, normal: Some([0.0, 0.0, -3.0]) })), Discs::Radius(13.0)),
    ] {
        let rms = calibrated(&points, control, &of(Some(discs)), &scene.camera, 1e-6).unwrap();
        assert!(rms < 1e-5, "{discs:?}: {rms} px");
    }
    let prepared = prepare(points, &plain, &of(Some(Discs::Radius(13.0)))).unwrap();
    calibrate(&prepared, &[], |wrong| assert!(wrong.rms_px() > 1e-3, "{} px", wrong.rms_px())).unwrap();
}

#[test]
fn discs_without_a_plane_and_discs_that_are_none_are_said() {
    let scene = wall(lens());
    let discs = points(&scene, leaning, 120.0, |_| "disc");
    let message = |points: &Points, control: &[ControlRow], discs| {
        let prepared = prepare(points.clone(), control, &of(Some(discs))).unwrap();
        calibrate(&prepared, &[], |_| ()).unwrap_err().to_string()
    };
    let plain = control(&scene, |_| None);
    let error = message(&discs, &plain, Discs::Radius(120.0));
    assert!(error.starts_with("no plane for t") && error.contains("more: their nearest neighbours lie in none; give"), "{error}");
    assert!(message(&discs, &plain, Discs::Control).contains("no measured target has a `radius`"));
    let squares = points(&scene, leaning, 120.0, |_| "square");
    assert!(message(&squares, &plain, Discs::Radius(120.0)).contains("all are of other kinds"));
}

#[test]
fn a_text_is_a_radius_or_the_control_file() {
    assert_eq!("control".parse(), Ok(Discs::Control));
    assert_eq!("12.5".parse(), Ok(Discs::Radius(12.5)));
    for wrong in ["", "0", "-3", "inf", "nan", "Control"] {
        assert!(wrong.parse::<Discs>().unwrap_err().to_string().contains("expected a positive number"), "{wrong}");
    }
}
