//! What every calibrator must do: one check for all, for those who write one.

use calibench_calibrate::{CalibrationError, Optics, parameters};
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv, OpenCvFisheye};
use calibench_model::{PixelPoint, Pose};
use calibench_plugins::Finding;
use calibench_random::{Key, Purpose, stream};
use nalgebra::{Point3, Vector3};
use rand_distr::{Distribution, StandardNormal};

use crate::{Answer, Grid, Lens, Listed, Score, Status, Task, TaskImage, Truth};

const SIZE: ImageSize = ImageSize { width: 1280, height: 960 };
/// Standard deviation of an image coordinate in the noisy sets, px.
const NOISE: f64 = 0.2;
/// Noisy sets.
const DRAWS: u64 = 8;
/// From perfect points a camera is known better than this over its frame, px.
const PERFECT: f64 = 0.05;
/// What a shift of all pixels or exchanged axes leave at least, px.
const SHIFTED: f64 = 0.3;
/// How far the mean square of errors in stated standard deviations may be from 1, as a factor either way.
const HONEST: f64 = 3.0;

/// Models of the usual lenses, of which the true camera of the checks can be one.
const BROWN: [&str; 4] = ["opencv5", "opencv8", "opencv4", "metashape"];

/// What is wrong with a calibrator, if anything is.
type Tried = fn(&Try<'_>) -> Result<(), String>;

/// Tries a calibrator on a perfect set of points, on noisy ones, on images in another order, on views that determine nothing and on none at all.
pub fn check(listed: &Listed) -> Vec<Finding> {
    let version = listed.calibrator.version();
    let mut findings = vec![Finding { what: "it starts and says its version", wrong: version.as_ref().err().cloned() }];
    if version.is_err() {
        return findings;
    }
    let tries: [(&'static str, Tried); 6] = [
        ("from perfect points it finds the camera", perfect),
        ("pixels are counted from the centre of the first, x along the row, y down", frame),
        ("noise makes no more than noise", noisy),
        ("images in another order give the same camera", order),
        ("views that determine nothing are answered", impossible),
        ("a set without points is no camera", empty),
    ];
    findings.push(Finding { what: "its models are models of calibench", wrong: models(listed).err() });
    match Try::new(listed) {
        Ok(tried) => findings.extend(tries.into_iter().map(|(what, check)| Finding { what, wrong: check(&tried).err() })),
        Err(why) => findings.push(Finding { what: "it has a model that can be tried", wrong: Some(why) }),
    }
    findings
}

/// Each is named once, as scenarios name it.
fn models(listed: &Listed) -> Result<(), String> {
    for (place, model) in listed.models.iter().enumerate() {
        let optics = Optics { model: Some(model.clone()), ..Optics::new(SIZE) };
        if let Err(unknown @ CalibrationError::UnknownModel { .. }) = parameters(&optics) {
            return Err(unknown.to_string());
        }
        if listed.models[..place].contains(model) {
            return Err(format!("`{model}` is named twice"));
        }
    }
    Ok(())
}

/// What is tried, and with what.
struct Try<'a> {
    listed: &'a Listed,
    model: String,
    camera: Camera,
    grid: Grid,
}

impl<'a> Try<'a> {
    fn new(listed: &'a Listed) -> Result<Self, String> {
        let grid = Grid::new(SIZE);
        let brown = BROWN.iter().find(|model| listed.models.iter().any(|own| own == *model));
        if let Some(model) = brown {
            // Every coefficient that the model has is not zero: one that is left out is seen.
            let k3 = if *model == "opencv4" { 0.0 } else { -0.04 };
            let mut distortion = [0.0; 14];
            distortion[..5].copy_from_slice(&[-0.2, 0.05, 4e-4, -3e-4, k3]);
            let camera = OpenCv { size: SIZE, fx: 930.0, fy: 932.0, cx: 651.0, cy: 470.0, distortion, coefficients: 5 };
            return Ok(Self { listed, model: (*model).to_owned(), camera: camera.into(), grid });
        }
        let Some(model) = listed.models.first() else { return Err("it names no model".to_owned()) };
        let camera = OpenCvFisheye { size: SIZE, fx: 420.0, fy: 421.0, cx: 645.0, cy: 474.0, k: [-0.02, 0.004, 0.0, 0.0], skew: 0.0 };
        Ok(Self { listed, model: model.clone(), camera: camera.into(), grid })
    }

    /// Views of a chessboard from all sides with errors of `noise`; with `frontal` each is the same.
    fn task(&self, noise: f64, draw: u64, frontal: bool) -> Task {
        let points: Vec<(String, Point3<f64>)> = (0..6)
            .flat_map(|row| (0..9).map(move |column| (row, column)))
            .map(|(row, column)| {
                (format!("r{}c{}", row + 1, column + 1), Point3::new(f64::from(column) * 25.0, f64::from(row) * -25.0, 0.0))
            })
            .collect();
        let middle = Point3::new(100.0, -62.5, 0.0);
        let image = |view: u32| {
            let name = format!("view-{view}");
            let (sin, cos) = (f64::from(view) * 1.1).sin_cos();
            let tilted = middle + Vector3::new(150.0 * cos, 150.0 * sin, 210.0 + 12.0 * f64::from(view % 5));
            let (centre, roll) = if frontal { (middle + Vector3::new(0.0, 0.0, 240.0), 0.0) } else { (tilted, 0.9 * f64::from(view)) };
            let aside = if frontal {
                Vector3::zeros()
            } else {
                Vector3::new(60.0 * (f64::from(view) * 2.3).sin(), 45.0 * (f64::from(view) * 1.7).cos(), 0.0)
            };
            let pose =
                Pose::looking_at(centre, middle + aside, Vector3::y(), roll).unwrap_or_else(|| unreachable!("it looks along no axis"));
            let mut rng = stream(Key { seed: 63, of: "calibrator", trial: draw, view: &name, target: "" }, Purpose::DrawnPoint);
            let mut error = || -> f64 { noise * Distribution::<f64>::sample(&StandardNormal, &mut rng) };
            let seen = points.iter().enumerate().filter_map(|(place, (_, at))| {
                let found = self.camera.project(pose.ray(at)).ok()?;
                let inside = found.x > 0.0 && found.y > 0.0 && found.x < f64::from(SIZE.width - 1) && found.y < f64::from(SIZE.height - 1);
                inside.then_some((place, found))
            });
            let seen: Vec<(usize, PixelPoint)> = seen.map(|(place, at)| (place, PixelPoint::new(at.x + error(), at.y + error()))).collect();
            TaskImage { name, points: seen }
        };
        Task {
            model: self.model.clone(),
            size: SIZE,
            sigma_px: (noise > 0.0).then_some(noise),
            unit: "mm".to_owned(),
            board: Some("chessboard:9x6:25".to_owned()),
            images: (0..14).map(image).collect(),
            points,
            points_sigma: 0.0,
            start: self.listed.start.then_some(crate::Start { f: 800.0, centre: PixelPoint::new(639.5, 479.5) }),
            grid: self.grid.places.clone(),
            seconds: 0.0,
        }
    }

    fn ask(&self, task: &Task) -> Result<Answer, String> {
        self.listed.calibrate(task).map(|found| found.answer)
    }

    /// A camera, whether the system doubts it or not.
    fn camera_of(&self, task: &Task) -> Result<Answer, String> {
        let answer = self.ask(task)?;
        if answer.lens.is_some() { Ok(answer) } else { Err(format!("{}: {}", answer.status.name(), answer.messages.join("; "))) }
    }

    fn score(&self, answer: &Answer, task: &Task) -> Result<Score, String> {
        let truth = Truth { camera: &self.camera, in_model: (self.model == "opencv5").then_some(self.camera), distance: 500.0 };
        let measured: Vec<PixelPoint> = task.images.iter().flat_map(|image| image.points.iter().map(|(_, at)| *at)).collect();
        Score::of(answer, &self.grid, &truth, &measured)?.ok_or_else(|| "no camera".to_owned())
    }
}

fn perfect(tried: &Try<'_>) -> Result<(), String> {
    let task = tried.task(0.0, 0, false);
    let answer = tried.camera_of(&task)?;
    let score = tried.score(&answer, &task);
    if score.as_ref().is_ok_and(|score| score.covered_px.unwrap_or(score.frame_px) < PERFECT) {
        return Ok(());
    }
    let exchanged = Try { camera: exchanged(&tried.camera), grid: tried.grid.clone(), model: tried.model.clone(), listed: tried.listed };
    let off = |score: &Result<Score, String>| score.as_ref().map_or(f64::INFINITY, |score| score.frame_px);
    let may_be = if off(&exchanged.score(&answer, &task)) < off(&score) { "; with x and y exchanged it would be nearer" } else { "" };
    Err(match score {
        Ok(score) => {
            format!("it is {:.3} px off over the frame after the best rotation, expected less than {PERFECT}{may_be}", score.frame_px)
        }
        Err(why) => format!("{why}{may_be}"),
    })
}

/// The camera that another order of the axes would make of `camera`.
fn exchanged(camera: &Camera) -> Camera {
    match camera {
        Camera::OpenCv(own) => OpenCv { fx: own.fy, fy: own.fx, cx: own.cy, cy: own.cx, ..*own }.into(),
        other => *other,
    }
}

/// Perfect points leave no rotation: what moves all pixels is seen by the principal point.
fn frame(tried: &Try<'_>) -> Result<(), String> {
    let task = tried.task(0.0, 0, false);
    let answer = tried.camera_of(&task)?;
    let (Some(Lens::Camera(named)), Ok(axis)) = (&answer.lens, centre(&tried.camera)) else { return Ok(()) };
    let found = centre(&named.camera)?;
    let [dx, dy] = [found.x - axis.x, found.y - axis.y];
    if dx.hypot(dy) < SHIFTED {
        return Ok(());
    }
    let half = |offset: f64| (offset.abs() - 0.5).abs() < 0.1;
    let may_be = if half(dx) && half(dy) { ": as where (0, 0) is the corner of the first pixel" } else { "" };
    Err(format!("the principal point is off by ({dx:.2}, {dy:.2}) px{may_be}"))
}

fn centre(camera: &Camera) -> Result<PixelPoint, String> {
    camera.project(calibench_model::camera::Ray::from_tangent(0.0, 0.0)).map_err(|error| error.to_string())
}

/// Errors against those of ours from the same points, and against what is stated.
fn noisy(tried: &Try<'_>) -> Result<(), String> {
    let ours = crate::own().into_iter().find(|own| own.name == "ours").ok_or("ours is not there")?;
    let (mut own, mut theirs, mut z2) = (0.0, 0.0, Vec::new());
    for draw in 0..DRAWS {
        let task = tried.task(NOISE, draw, false);
        let score = tried.score(&tried.camera_of(&task)?, &task)?;
        let beside = ours.calibrate(&task)?.answer;
        theirs += score.covered_px.unwrap_or(score.frame_px).powi(2);
        own += tried.score(&beside, &task).map_or(f64::INFINITY, |score| score.covered_px.unwrap_or(score.frame_px).powi(2));
        z2.extend(score.z2_frame.or(score.z2_parameters));
    }
    let ratio = (theirs / own).sqrt();
    if ratio > 2.0 {
        return Err(format!("its error is {ratio:.1} times that of calibench from the same points"));
    }
    let mean = z2.iter().sum::<f64>() / z2.len() as f64;
    if z2.is_empty() || (1.0 / HONEST..HONEST).contains(&mean) {
        return Ok(());
    }
    let factor = mean.sqrt();
    let amiss = if factor > 1.0 { format!("{factor:.2} times too small") } else { format!("{:.2} times too large", 1.0 / factor) };
    Err(format!("errors are {factor:.2} times what is stated (points have {NOISE} px): what it states is {amiss}"))
}

fn order(tried: &Try<'_>) -> Result<(), String> {
    let task = tried.task(NOISE, 0, false);
    let mut turned = task.clone();
    turned.images.reverse();
    turned.images.iter_mut().for_each(|image| image.points.reverse());
    let of = |task: &Task| tried.score(&tried.camera_of(task)?, task);
    let near = |score: Score| score.covered_px.unwrap_or(score.frame_px);
    let [one, other] = [near(of(&task)?), near(of(&turned)?)];
    let apart = (one - other).abs();
    if apart <= 0.02 {
        Ok(())
    } else {
        Err(format!("{one:.3} and {other:.3} px off where something is measured: expected the same within 0.02 px"))
    }
}

fn impossible(tried: &Try<'_>) -> Result<(), String> {
    tried.ask(&tried.task(NOISE, 0, true)).and_then(|answer| is_an_answer(&answer))
}

fn empty(tried: &Try<'_>) -> Result<(), String> {
    let task = Task { images: Vec::new(), ..tried.task(NOISE, 0, false) };
    let answer = tried.ask(&task)?;
    if answer.status == Status::Calibrated {
        return Err("it is `calibrated`: expected refused or failed".to_owned());
    }
    is_an_answer(&answer)
}

/// Whatever a system makes of it: its program lives on and says so.
fn is_an_answer(answer: &Answer) -> Result<(), String> {
    let is_broken = |message: &&String| {
        ["malformed: ", "it ended", "no answer within", "it closed its output"].iter().any(|start| message.starts_with(start))
    };
    match answer.messages.iter().find(is_broken).filter(|_| answer.status == Status::Failed) {
        Some(message) => Err(message.clone()),
        None => Ok(()),
    }
}
