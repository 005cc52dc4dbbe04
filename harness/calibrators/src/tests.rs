//! The check of calibrators finds what is wrong with one, and nothing with a sound one.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv, Ray};
use nalgebra::{Rotation3, Vector3};

use crate::{Answer, Calibrated, Calibrator, Grid, Lens, Listed, Score, Status, Task, Truth, check, own};

/// A change of what is asked, and of what ours answers.
struct Changed {
    told: fn(&mut Task),
    said: fn(&mut Answer, &Task),
}

impl Calibrator for Changed {
    fn version(&self) -> Result<String, String> {
        Ok("1".to_owned())
    }

    fn calibrate(&self, task: &Task) -> Result<Calibrated, String> {
        let mut told = task.clone();
        (self.told)(&mut told);
        let mut found = ours().calibrate(&told)?;
        (self.said)(&mut found.answer, task);
        Ok(found)
    }
}

fn ours() -> Listed {
    own().into_iter().find(|own| own.name == "ours").unwrap()
}

/// What the check says of ours so changed: what is wrong, by what was tried.
fn wrong(told: fn(&mut Task), said: fn(&mut Answer, &Task)) -> Vec<(&'static str, String)> {
    let listed = Listed { calibrator: Box::new(Changed { told, said }), ..ours() };
    check(&listed).into_iter().filter_map(|finding| Some((finding.what, finding.wrong?))).collect()
}

fn each_point(task: &mut Task, change: impl Fn(&mut PixelPoint)) {
    task.images.iter_mut().flat_map(|image| &mut image.points).for_each(|(_, at)| change(at));
}

fn scale(answer: &mut Answer, factor: f64) {
    if let Some((_, matrix)) = &mut answer.precision.covariance {
        *matrix *= factor * factor;
    }
}

#[test]
fn ours_passes() {
    assert_eq!(wrong(|_| (), |_, _| ()), []);
}

#[test]
fn models_that_nobody_can_ask_for_are_found() {
    let of = |models: &[&str]| {
        let listed = Listed { models: models.iter().map(|model| (*model).to_owned()).collect(), ..ours() };
        check(&listed).into_iter().filter_map(|finding| finding.wrong).collect::<Vec<_>>()
    };
    let wrong = of(&["opencv5", "opencv6"]);
    assert!(
        wrong[0].starts_with("no camera model is called opencv6; known are ") && wrong[0].contains("; did you mean `opencv"),
        "{wrong:?}"
    );
    assert_eq!(of(&["opencv5", "opencv5"]), ["`opencv5` is named twice"]);
}

#[test]
fn pixels_from_the_corner_are_found() {
    let found = wrong(|task| each_point(task, |at| *at = PixelPoint::new(at.x + 0.5, at.y + 0.5)), |_, _| ());
    assert!(found.iter().any(|(_, why)| why.contains("(0.50, 0.50) px: as where (0, 0) is the corner of the first pixel")), "{found:?}");
}

#[test]
fn exchanged_axes_are_found() {
    let exchange = |answer: &mut Answer, _: &Task| {
        let Some(Lens::Camera(named)) = &mut answer.lens else { return };
        if let Camera::OpenCv(own) = named.camera {
            named.camera = OpenCv { fx: own.fy, fy: own.fx, cx: own.cy, cy: own.cx, ..own }.into();
        }
    };
    let found = wrong(|_| (), exchange);
    assert!(found.iter().any(|(_, why)| why.contains("with x and y exchanged it would be nearer")), "{found:?}");
}

#[test]
fn standard_deviations_of_another_scale_are_found() {
    type Said = fn(&mut Answer, &Task);
    let cases: [(Said, &str); 2] =
        [(|answer, _| scale(answer, 0.1), "times too small"), (|answer, _| scale(answer, 10.0), "times too large")];
    for (said, words) in cases {
        let found = wrong(|_| (), said);
        assert!(found.len() == 1 && found[0].0 == "noise makes no more than noise" && found[0].1.ends_with(words), "{found:?}");
    }
}

/// The camera follows the first image: as where a system starts from it and does not get away.
#[test]
fn an_answer_that_depends_on_the_order_is_found() {
    let said = |answer: &mut Answer, task: &Task| {
        let (Some(Lens::Camera(named)), Some(first)) = (&mut answer.lens, task.images.first()) else { return };
        if let Camera::OpenCv(own) = named.camera {
            named.camera = OpenCv { distortion: own.distortion.map(|k| if first.name == "view-0" { k } else { 1.3 * k }), ..own }.into();
        }
    };
    let found = wrong(|_| (), said);
    assert!(found.iter().any(|(what, _)| *what == "images in another order give the same camera"), "{found:?}");
}

#[test]
fn a_camera_from_nothing_is_found() {
    let said = |answer: &mut Answer, task: &Task| {
        if task.images.is_empty() {
            answer.status = Status::Calibrated;
        }
    };
    assert_eq!(wrong(|_| (), said), [("a set without points is no camera", "it is `calibrated`: expected refused or failed".to_owned())]);
}

const SIZE: ImageSize = ImageSize { width: 640, height: 480 };

fn camera() -> Camera {
    OpenCv { size: SIZE, fx: 500.0, fy: 500.0, cx: 325.0, cy: 236.0, distortion: [0.0; 14], coefficients: 4 }.into()
}

/// Rays of `camera` where a grid has places, each `turned`.
fn rays(camera: &Camera, grid: &Grid, turned: &Rotation3<f64>) -> Lens {
    let turn = |ray: Ray| {
        let ray = turned * Vector3::new(ray.x, ray.y, ray.z);
        Ray { x: ray.x, y: ray.y, z: ray.z }
    };
    Lens::Rays(grid.places.iter().map(|at| camera.unproject(*at).ok().map(turn)).collect())
}

fn answer(lens: Lens) -> Answer {
    Answer { status: Status::Calibrated, lens: Some(lens), messages: Vec::new(), ..Answer::without(Status::Calibrated, "") }
}

/// A camera that is given by rays has the frame that it states turned: that is no error, what remains is.
#[test]
fn rays_are_compared_after_the_best_rotation() {
    let (camera, grid) = (camera(), Grid::new(SIZE));
    let truth = Truth { camera: &camera, in_model: None, distance: 400.0 };
    let turned = Rotation3::from_euler_angles(0.004, -0.003, 0.002);
    let score = Score::of(&answer(rays(&camera, &grid, &turned)), &grid, &truth, &[]).unwrap().unwrap();
    assert!(score.frame_px < 1e-6, "{}", score.frame_px);
    // 500 px to a radian, about two axes across the line of sight; the third one turns the middle, too, as it is not at the principal point.
    assert!((score.rotation_px - 500.0 * turned.angle()).abs() < 0.1 * score.rotation_px, "{}", score.rotation_px);
    assert!(score.length_mm.unwrap() < 1e-6 && score.covered_px.is_none());
    let Camera::OpenCv(own) = camera else { unreachable!() };
    let longer: Camera = OpenCv { fx: 505.0, fy: 505.0, ..own }.into();
    let score = Score::of(&answer(rays(&longer, &grid, &turned)), &grid, &truth, &[]).unwrap().unwrap();
    // A focal length that is 1 % longer moves a point by 1 % of its distance from the axis, and lengths by about 1 %.
    let mean_square = (640.0_f64.powi(2) + 480.0_f64.powi(2)) / 12.0 / 100.0_f64.powi(2);
    assert!((score.frame_px / mean_square.sqrt() - 1.0).abs() < 0.1, "{} {}", score.frame_px, mean_square.sqrt());
    assert!((score.length_mm.unwrap() - 1.0).abs() < 0.1, "{:?}", score.length_mm);
}

#[test]
fn what_is_not_pictured_cannot_be_compared() {
    let (camera, grid) = (camera(), Grid::new(SIZE));
    let truth = Truth { camera: &camera, in_model: None, distance: 400.0 };
    let Lens::Rays(mut rays) = rays(&camera, &grid, &Rotation3::identity()) else { unreachable!() };
    rays.iter_mut().take(60).for_each(|ray| *ray = None);
    let why = Score::of(&answer(Lens::Rays(rays)), &grid, &truth, &[]).unwrap_err();
    assert!(why.starts_with("it does not picture ") && why.ends_with(" % of the frame"), "{why}");
}

/// What is wrong outside of where points were measured is no error of the covered part.
#[test]
fn the_covered_part_is_where_points_are() {
    let (camera, grid) = (camera(), Grid::new(SIZE));
    let truth = Truth { camera: &camera, in_model: None, distance: 400.0 };
    let Lens::Rays(mut rays) = rays(&camera, &grid, &Rotation3::identity()) else { unreachable!() };
    for (at, ray) in grid.places.iter().zip(&mut rays) {
        if at.x > 500.0 {
            *ray = camera.unproject(PixelPoint::new(at.x - 3.0, at.y)).ok();
        }
    }
    let measured: Vec<PixelPoint> =
        (0..40).map(|i| PixelPoint::new(100.0 + 50.0 * f64::from(i % 7), 60.0 + 60.0 * f64::from(i / 7))).collect();
    let score = Score::of(&answer(Lens::Rays(rays)), &grid, &truth, &measured).unwrap().unwrap();
    assert!(score.covered_px.unwrap() < 1e-6 && score.frame_px > 0.5, "{score:?}");
}
