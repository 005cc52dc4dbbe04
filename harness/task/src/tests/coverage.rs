//! Whether the intervals hold the truth, from calibration to measurement: cameras are calibrated from drawn image coordinates of a board that errs in print, bend and scale, and then measure.
//!
//! Nothing of it is the budget's own: what is measured comes from resections and intersections, with the camera that was estimated, of what the true camera sees.

use calibench_adjust::approximate::{Control, Sight, fit_pose, intersect};
use calibench_adjust::{Exterior, ImageObservation, Interior, Network, ObjectPoint, Options, Variance, adjust};
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv};
use calibench_model::named_camera::ParameterCovariance;
use calibench_model::{ControlRow, NamedCamera, PixelPoint, Pose};
use nalgebra::{Point3, Rotation3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::scene::in_frame;
use crate::{Budget, ControlErrors, HALF_95, KnownCamera, KnownPlane, Quantity, Station, Task};

const FREE: [&str; 8] = ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"];
const PHOTOS: usize = 12;
const TASKS: usize = 20;
/// Of an image coordinate, px.
const PX: f64 = 0.1;
/// Of the print of a corner, of each bend (object units), of the scale (a number).
const PRINT: f64 = 0.03;
const BEND: f64 = 0.08;
const SCALE: f64 = 2e-4;
/// Of a stated pose: object units, rad.
const CENTRE: f64 = 0.05;
const ANGLE: f64 = 3e-5;

struct Draw(ChaCha8Rng);

impl Draw {
    fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    fn vector(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.normal())
    }

    /// A camera that looks at the middle of the board from 350 to 550, up to 40 degrees off.
    fn pose(&mut self) -> Pose {
        let (far, around, off) = (self.between(350.0, 550.0), self.between(0.0, std::f64::consts::TAU), self.between(0.1, 0.7));
        let from = Vector3::new(off.sin() * around.cos(), off.sin() * around.sin(), off.cos()) * far;
        let at = Point3::new(self.between(-50.0, 50.0), self.between(-40.0, 40.0), 0.0);
        Pose::looking_at(at + from, at, Vector3::y(), self.between(-0.5, 0.5)).unwrap()
    }

    fn seen(&mut self, camera: &Camera, pose: &Pose, object: &Point3<f64>) -> Option<PixelPoint> {
        let at = in_frame(camera, pose, object)?;
        Some(PixelPoint::new(at.x + PX * self.normal(), at.y + PX * self.normal()))
    }
}

/// A board of 9 x 7 corners, 30 apart, as its file has it and as it is.
struct Board {
    nominal: Vec<Point3<f64>>,
    real: Vec<Point3<f64>>,
}

impl Board {
    fn draw(draw: &mut Draw) -> Self {
        let nominal: Vec<Point3<f64>> =
            (0..63).map(|k| Point3::new(30.0 * f64::from(k % 9) - 120.0, 30.0 * f64::from(k / 9) - 90.0, 0.0)).collect();
        let (scale, bend) = (1.0 + SCALE * draw.normal(), BEND * draw.vector());
        let real = nominal.iter().map(|point| {
            let (u, v) = (point.x / 120.0, point.y / 90.0);
            let lift = bend.dot(&Vector3::new(1.0 - u * u, 1.0 - v * v, u * v));
            point * scale + Vector3::z() * lift + PRINT * draw.vector()
        });
        Self { real: real.collect(), nominal }
    }

    fn rows(&self) -> Vec<ControlRow> {
        self.nominal.iter().enumerate().map(|(k, point)| ControlRow::new(k.to_string(), point.coords.into())).collect()
    }
}

fn truth() -> Camera {
    let mut camera = OpenCv {
        size: ImageSize { width: 1600, height: 1200 },
        fx: 1500.0,
        fy: 1502.0,
        cx: 805.0,
        cy: 596.0,
        distortion: [0.0; 14],
        coefficients: 5,
    };
    camera.distortion[..4].copy_from_slice(&[-0.12, 0.08, 4e-4, -3e-4]);
    camera.into()
}

/// The camera as it is found from photographs of the board, with the covariance of the adjustment.
fn calibrated(draw: &mut Draw, camera: &Camera, board: &Board) -> NamedCamera {
    let sigmas = [PRINT.hypot(120.0 * SCALE), PRINT.hypot(90.0 * SCALE), PRINT.hypot(1.3 * BEND)];
    let poses: Vec<Pose> = (0..PHOTOS).map(|_| draw.pose()).collect();
    let mut observations = Vec::new();
    for (image, pose) in poses.iter().enumerate() {
        for (point, object) in board.real.iter().enumerate() {
            observations.extend(draw.seen(camera, pose, object).map(|at| ImageObservation::new(image, point, at, PX)));
        }
    }
    let network = Network {
        cameras: vec![Interior::fixed("camera", *camera).free(&FREE).unwrap()],
        images: poses.iter().map(|pose| Exterior::free("", 0, *pose)).collect(),
        points: board.nominal.iter().map(|point| ObjectPoint::observed("", *point, sigmas)).collect(),
        observations,
        ..Network::default()
    };
    let solution = adjust(&network, &Options::default()).unwrap();
    let covariances = solution.covariances(Variance::Estimated).unwrap();
    let (names, covariance) = covariances.of_camera(0);
    let covariance = ParameterCovariance::named(names.iter().map(|name| (*name).to_owned()).collect(), &covariance).unwrap();
    NamedCamera { covariance: Some(covariance), ..NamedCamera::new("", solution.cameras()[0]) }
}

/// A length somewhere, in two images of stated poses, in two with the board, or in one before the plane Z = 0.
fn length(draw: &mut Draw, kind: usize) -> [Point3<f64>; 2] {
    let height = if kind == 2 { 0.0 } else { 40.0 };
    let mut end = || Point3::new(draw.between(-110.0, 110.0), draw.between(-80.0, 80.0), draw.between(-height, height));
    let from = end();
    loop {
        let to = end();
        if (to - from).norm() > 60.0 {
            return [from, to];
        }
    }
}

/// The error of one measurement over its standard uncertainty.
fn measured(draw: &mut Draw, kind: usize, camera: &Camera, found: &NamedCamera, board: &Board) -> f64 {
    loop {
        let ends = length(draw, kind);
        let poses: Vec<Pose> = (0..if kind == 2 { 1 } else { 2 }).map(|_| draw.pose()).collect();
        let apart = poses.len() == 1 || (poses[0].centre - poses[1].centre).norm() > 150.0;
        let images: Vec<[Option<PixelPoint>; 2]> = poses.iter().map(|pose| ends.map(|end| draw.seen(camera, pose, &end))).collect();
        if !apart || images.iter().flatten().any(Option::is_none) {
            continue;
        }
        let (sigma_centre, sigma_angles) = if kind == 1 { (0.0, 0.0) } else { (CENTRE, ANGLE) };
        let plane = (kind == 2).then(|| KnownPlane { point: Point3::origin(), normal: Vector3::z(), sigma: 0.05, sigma_tilt: 2e-4 });
        let task = Task {
            unit: None,
            quantity: Quantity::Length(ends),
            images: poses.iter().map(|pose| Station { pose: *pose, sigma_centre, sigma_angles }).collect(),
            plane,
            sigma_px: PX,
            control: ControlErrors { sigma_px: PX, print_sigma: PRINT, flatness_sigma: BEND },
            scale_sigma: if kind == 1 { SCALE } else { 0.0 },
            temperature: None,
        };
        let rows = board.rows();
        let Ok(budget) = Budget::of(&task, &KnownCamera::of(found), (kind == 1).then_some(&rows[..])) else { continue };
        // The user's poses: of a resection on the board as its file has it, or stated.
        let known: Vec<Pose> = poses
            .iter()
            .map(|pose| {
                if kind == 1 {
                    let seen = board.nominal.iter().zip(&board.real);
                    let control: Vec<Control> = seen
                        .filter_map(|(nominal, real)| Some(Control { object: *nominal, image: draw.seen(camera, pose, real)? }))
                        .collect();
                    fit_pose(&found.camera, pose, &control).unwrap().pose
                } else {
                    let turn = Rotation3::new(ANGLE * draw.vector());
                    Pose { rotation: turn * pose.rotation, centre: pose.centre + CENTRE * draw.vector() }
                }
            })
            .collect();
        let (lift, tilt) = (0.05 * draw.normal(), [2e-4 * draw.normal(), 2e-4 * draw.normal()]);
        let points = [0, 1].map(|end| {
            let at: Vec<PixelPoint> = images.iter().map(|image| image[end].unwrap()).collect();
            if kind < 2 {
                let sights: Vec<Sight<'_>> =
                    known.iter().zip(&at).map(|(pose, at)| Sight { camera: &found.camera, pose, image: *at }).collect();
                return intersect(&sights, 0.0, None).unwrap().point;
            }
            let ray = known[0].world_from_ray(found.camera.unproject(at[0]).unwrap());
            let normal = Vector3::new(tilt[0], tilt[1], 1.0);
            let way = (Point3::new(0.0, 0.0, lift) - known[0].centre).dot(&normal) / ray.dot(&normal);
            known[0].centre + way * ray
        });
        let error = (points[1] - points[0]).norm() - (ends[1] - ends[0]).norm();
        return error / budget.components[0].sigma;
    }
}

/// The parts of intervals that hold the truth: of each calibration, and the root mean square of errors over standard uncertainties.
fn study(calibrations: u64) -> (Vec<f64>, f64) {
    let camera = truth();
    let (mut held, mut squares) = (Vec::new(), 0.0);
    for trial in 0..calibrations {
        let mut draw = Draw(ChaCha8Rng::seed_from_u64(6700 + trial));
        let board = Board::draw(&mut draw);
        let found = calibrated(&mut draw, &camera, &board);
        let errors: Vec<f64> = (0..TASKS).map(|task| measured(&mut draw, task % 3, &camera, &found, &board)).collect();
        held.push(errors.iter().filter(|error| error.abs() <= HALF_95).count() as f64 / TASKS as f64);
        squares += errors.iter().map(|error| error * error).sum::<f64>();
    }
    (held, (squares / (calibrations as f64 * TASKS as f64)).sqrt())
}

/// The tasks of one calibration share its errors: what is drawn anew is the calibration, and the parts that hold of these are the independent numbers.
fn hold_95(calibrations: u64) {
    let (held, spread) = study(calibrations);
    let count = held.len() as f64;
    let mean = held.iter().sum::<f64>() / count;
    let deviation = (held.iter().map(|part| (part - mean).powi(2)).sum::<f64>() / (count - 1.0) / count).sqrt();
    println!(
        "{:.2} % of {} intervals hold the truth, standard deviation {:.2} %; errors are {spread:.3} of their standard uncertainties",
        100.0 * mean,
        held.len() * TASKS,
        100.0 * deviation
    );
    assert!((mean - 0.95).abs() < 0.01_f64.max(3.0 * deviation), "{mean} {deviation}");
    // An interval that is too long holds too much: at most 1.2 times 3.92 standard deviations of the errors.
    assert!(spread > 1.0 / 1.2 && spread < 1.1, "{spread}");
}

#[test]
fn intervals_hold_the_truth_in_95_of_100() {
    hold_95(300);
}
