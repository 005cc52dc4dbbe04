//! What calibrators are told, and what is made of their answers.

use std::path::PathBuf;

use calibench_calibrators::{Answer, Calibrated, Calibrator, Lens, Listed, Precision, Status, Task, own};
use calibench_measure::Registry;
use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, OpenCv, OpenCvFisheye};
use calibench_records::figures::Quantity;
use calibench_records::results::{Figure, find};
use calibench_scenario::{Scenario, parse};
use nalgebra::DMatrix;

use super::{Answered, answer, figures};
use crate::league::Trials;
use crate::{Plan, Tools};

const BOARD: &str = r#"why = "A board."
source = "ours"
seed = 3
trials = 2
[camera]
size = [1280, 960]
pitch = 5.0
c = 4.6
x0 = 0.03
y0 = -0.02
[testfield]
kind = "chessboard"
rows = 6
columns = 9
square = 25
[stations]
kind = "random"
count = 8
distance = [300, 450]
tilt = 40
roll = 180
aside = [80, 60]
each_trial = true
[pointing]
sigma = 0
whole_pixels = false
[[method]]
name = "pixel"
[calibrators]
model = "opencv4"
start_f = 900
distance = 400
sigma_px = 0.1
noise_px = 0
[[calibrator]]
name = "ours"
"#;

fn scenario(faults: &str) -> Scenario {
    let text = BOARD.replace("[[calibrator]]", &format!("[calibrators.faults]\n{faults}\n[[calibrator]]"));
    parse("s", "s.toml", &text, &Registry::builtin()).unwrap_or_else(|problems| panic!("{problems}"))
}

/// What is asked in a trial with faults.
fn task(faults: &str, trial: u64) -> Task {
    let scenario = scenario(faults);
    let plan = Plan::new(&scenario, Tools::default(), PathBuf::new());
    Trials::new(&plan).unwrap().unwrap().asked(trial).unwrap().task
}

/// How far points of the same names are moved, px.
fn moved(task: &Task, other: &Task) -> Vec<f64> {
    let points = |task: &Task| task.images.iter().flat_map(|image| image.points.clone()).collect::<Vec<_>>();
    let (one, other) = (points(task), points(other));
    assert_eq!(one.len(), other.len());
    one.iter().zip(&other).map(|((a, at), (b, beside))| if a == b { at.distance(*beside) } else { panic!("other points") }).collect()
}

#[test]
fn trials_have_stations_of_their_own_and_the_same_points_again() {
    let [one, again, other] = [task("", 0), task("", 0), task("", 1)];
    assert_eq!(one, again);
    assert!(one.images.iter().zip(&other.images).all(|(a, b)| a.points != b.points));
    assert_eq!((one.images.len(), one.points.len(), one.board.as_deref()), (8, 54, Some("chessboard:9x6:25")));
    // A corner of which a part is out of view is not pointed at.
    assert!(one.images.iter().all(|image| (50..=54).contains(&image.points.len())));
}

#[test]
fn faults_are_as_large_and_as_many_as_they_are_said_to_be() {
    let plain = task("", 0);
    let off = |faults: &str| moved(&task(faults, 0), &plain);
    let gross: Vec<f64> = off("gross = 0.25\ngross_px = [4, 9]");
    let many = gross.iter().filter(|px| **px > 0.0).count();
    assert!((75..142).contains(&many), "{many} of 432, 108 +- 9 are meant");
    assert!(gross.iter().all(|px| *px == 0.0 || (4.0..=9.0).contains(px)));
    let exchanged = task("exchanged = 0.1", 0);
    for (image, own) in exchanged.images.iter().zip(&plain.images) {
        let positions = |points: &[(usize, calibench_model::PixelPoint)]| {
            let mut all: Vec<_> = points.iter().map(|(_, at)| (at.x.to_bits(), at.y.to_bits())).collect();
            all.sort_unstable();
            all
        };
        assert_eq!(positions(&image.points), positions(&own.points), "the same places under other names");
        let others = image.points.iter().zip(&own.points).filter(|(a, b)| a.1 != b.1).count();
        assert!((2..=6).contains(&others), "{others} of 54 by three exchanges");
    }
    let scaled = task("told_scale = 1.02", 0);
    assert_eq!(scaled.images, plain.images);
    assert!(scaled.points.iter().zip(&plain.points).all(|(a, b)| (a.1 - b.1 * 1.02).norm() < 1e-12));
}

/// Every second image is larger about the principal point.
#[test]
fn two_cameras_are_told_as_one() {
    let (plain, mixed) = (task("", 0), task("other_c = 1.05", 0));
    let centre = [639.5 + 0.03 / 0.005, 479.5 + 0.02 / 0.005];
    for (place, (image, own)) in mixed.images.iter().zip(&plain.images).enumerate() {
        for ((_, a), (_, b)) in image.points.iter().zip(&own.points) {
            let factor = if place % 2 == 1 { 1.05 } else { 1.0 };
            assert!(
                (a.x - centre[0] - factor * (b.x - centre[0])).abs() < 1e-9 && (a.y - centre[1] - factor * (b.y - centre[1])).abs() < 1e-9
            );
        }
    }
}

/// A camera that moves along its rows moves every point along its row, by the share of the path at which that is read out, times c over the depth.
#[test]
fn a_rolling_shutter_moves_points_by_when_their_rows_are_read() {
    let (plain, moved) = (task("", 0), task("shutter = 2", 0));
    for (image, own) in moved.images.iter().zip(&plain.images) {
        for ((_, a), (_, b)) in image.points.iter().zip(&own.points) {
            assert!((a.y - b.y).abs() < 1e-9, "no distortion: rows stay");
            let share = b.y / 959.0 - 0.5;
            // At depths between 180 and 600, with c of 920 px.
            let by = (b.x - a.x) / share;
            assert!((2.0 * 920.0 / 600.0..2.0 * 920.0 / 180.0).contains(&by), "{by}");
        }
    }
}

/// Answers one camera, whatever it is asked.
struct Stubborn(Camera, Status, f64);

impl Calibrator for Stubborn {
    fn version(&self) -> Result<String, String> {
        Ok("1".to_owned())
    }

    fn calibrate(&self, _: &Task) -> Result<Calibrated, String> {
        let names: Vec<String> = ["fx", "fy", "cx", "cy"].map(str::to_owned).to_vec();
        let covariance = Some((names, DMatrix::identity(4, 4) * self.2 * self.2));
        let answer = Answer {
            lens: Some(Lens::Camera(Box::new(NamedCamera::new("", self.0)))),
            precision: Precision { covariance, ..Precision::default() },
            ..Answer::without(self.1, "")
        };
        Ok(Calibrated { answer, seconds: 0.0, peak_mb: None })
    }
}

fn answered(scenario: &Scenario, camera: Camera, status: Status, sigma: f64) -> Answered {
    let plan = Plan::new(scenario, Tools::default(), PathBuf::new());
    let trials = Trials::new(&plan).unwrap().unwrap();
    let listed = Listed {
        name: "stubborn".into(),
        system: "stubborn".into(),
        about: String::new(),
        source: String::new(),
        identity: String::new(),
        models: vec!["opencv4".into()],
        start: false,
        calibrator: Box::new(Stubborn(camera, status, sigma)),
    };
    answer(&trials.asked(0).unwrap(), &listed).unwrap()
}

fn value(figures: &[Figure], quantity: Quantity) -> Option<f64> {
    find(figures, quantity).map(|figure| figure.value)
}

#[test]
fn the_true_camera_is_no_way_off_and_a_longer_one_by_what_it_is_longer() {
    let scenario = scenario("");
    let camera = |f: f64| -> Camera {
        let size = calibench_model::camera::ImageSize { width: 1280, height: 960 };
        OpenCv { size, fx: f, fy: f, cx: 645.5, cy: 483.5, distortion: [0.0; 14], coefficients: 4 }.into()
    };
    let exact = answered(&scenario, camera(920.0), Status::Calibrated, 1.0);
    let found = figures::of(&exact, 432);
    assert!(value(&found, Quantity::OverFrame).unwrap() < 1e-9 && value(&found, Quantity::LengthError).unwrap() < 1e-9);
    assert_eq!(value(&found, Quantity::IsWrongAndSilent), Some(0.0));
    assert!(value(&found, Quantity::SquareOverStatedParameters).unwrap() < 1e-12);

    // 1 % longer: by 9.2 px in one of four parameters, and a length on a plane by 1 %.
    let longer = answered(&scenario, camera(929.2), Status::Calibrated, 1.0);
    let found = figures::of(&longer, 432);
    let z2 = value(&found, Quantity::SquareOverStatedParameters).unwrap();
    assert!((z2 - 2.0 * 9.2 * 9.2 / 4.0).abs() < 1e-6, "{z2}");
    let px = value(&found, Quantity::OverFrame).unwrap();
    // The RMS distance from the middle is that of a rectangle, and a share of 1 % of it is left.
    let expected = 0.01 / 1.01 * (1279.0_f64.powi(2) + 959.0_f64.powi(2)).sqrt() / 12.0_f64.sqrt();
    assert!((px - expected).abs() < 0.1 * expected, "{px} {expected}");
    let mm = value(&found, Quantity::LengthError).unwrap();
    assert!((mm - 100.0 * 0.01 / 1.01).abs() < 0.15, "{mm}");
    assert!(!answered(&scenario, camera(929.2), Status::Calibrated, 3.0).is_wrong_and_silent(), "it states 3 px of each parameter");

    let sure = answered(&scenario, camera(929.2), Status::Calibrated, 0.1);
    assert!(sure.is_wrong_and_silent());
    assert!(!answered(&scenario, camera(929.2), Status::Doubtful, 0.1).is_wrong_and_silent(), "it said so");
}

#[test]
fn a_camera_that_pictures_another_frame_cannot_be_compared() {
    let scenario = scenario("");
    let size = calibench_model::camera::ImageSize { width: 1280, height: 960 };
    let narrow = OpenCvFisheye { size, fx: 150.0, fy: 150.0, cx: 639.5, cy: 479.5, k: [-0.3, 0.0, 0.0, 0.0], skew: 0.0 };
    let found = answered(&scenario, narrow.into(), Status::Calibrated, 0.1);
    assert!(found.score.is_err() && found.is_wrong_and_silent(), "{:?}", found.score);
}

/// A second method: ours calibrates from exact points, and knows the camera.
#[test]
fn ours_finds_the_camera_from_exact_points() {
    let scenario = scenario("");
    let all = own();
    let plan = Plan::new(&scenario, Tools { calibrators: &all, ..Tools::default() }, PathBuf::new());
    let trials = Trials::new(&plan).unwrap().unwrap();
    let found = answer(&trials.asked(1).unwrap(), super::found(&all, "ours").unwrap()).unwrap();
    let score = found.score.unwrap().expect("a camera");
    assert!(score.frame_px < 1e-3, "{score:?}");
    let why = super::found(&all, "our").err().unwrap();
    assert_eq!(why, "no calibrator is called `our`: is `ours` meant?");
}
