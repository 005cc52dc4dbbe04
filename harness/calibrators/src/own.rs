//! Our own calibration, in the configurations that users choose among.

use calibench_adjust::Use;
use calibench_calibrate::{BoardShape, Calibration, GrossErrors, MODELS, Optics, Risk, Settings, calibrate, prepare};
use calibench_model::camera::{Camera, OpenCv};
use calibench_model::{ControlRow, Points, Start as Point};

use crate::answer::{Lens, Precision, Scaled};
use crate::{Answer, Calibrated, Calibrator, Listed, Status, Task};

/// What our own system is called.
pub const OURS: &str = "calibench";

/// One of our configurations.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Own {
    shape: BoardShape,
    gross: GrossErrors,
}

/// Name, what is special, and the configuration.
const OWN: [(&str, &str, Own); 5] = [
    ("ours", "as `calibench calibrate` does by default", Own { shape: BoardShape::Tested, gross: GrossErrors::Sought }),
    ("ours_plain", "all points count alike: `--plain`", Own { shape: BoardShape::Tested, gross: GrossErrors::Kept }),
    (
        "ours_snoop",
        "what a test rejects is left out: `--snoop`",
        Own { shape: BoardShape::Tested, gross: GrossErrors::Rejected(Risk::EachPoint) },
    ),
    ("ours_huber", "Huber's weights: `--huber 2`", Own { shape: BoardShape::Tested, gross: GrossErrors::Weighted(2.0) }),
    ("ours_bent", "the board's bend is adjusted: `--board-shape bent`", Own { shape: BoardShape::Bent, gross: GrossErrors::Sought }),
];

/// Ours.
pub fn own() -> Vec<Listed> {
    let listed = |(name, about, own): (&str, &str, Own)| Listed {
        name: name.to_owned(),
        system: OURS.to_owned(),
        about: about.to_owned(),
        source: "this project".to_owned(),
        identity: String::new(),
        models: MODELS.map(str::to_owned).to_vec(),
        start: false,
        calibrator: Box::new(own),
    };
    OWN.into_iter().map(listed).collect()
}

impl Own {
    fn settings(&self, task: &Task) -> Settings {
        let camera = |start: crate::Start| {
            let (f, c) = (start.f, start.centre);
            Camera::from(OpenCv { size: task.size, fx: f, fy: f, cx: c.x, cy: c.y, distortion: [0.0; 14], coefficients: 4 })
        };
        let optics = Optics { model: Some(task.model.clone()), start: task.start.map(camera), ..Optics::new(task.size) };
        Settings { shape: self.shape, gross: self.gross, sigma_px: task.sigma_px, ..Settings::new(vec![optics]) }
    }

    fn answer(&self, task: &Task) -> Answer {
        let mut points = Points::default();
        for image in &task.images {
            image.points.iter().for_each(|(place, at)| points.push(&image.name, &task.points[*place].0, Point::at(*at)));
        }
        if points.is_empty() {
            return Answer::without(Status::Refused, "no image points");
        }
        let sigmas = (task.points_sigma > 0.0).then_some([task.points_sigma; 3]);
        let control: Vec<ControlRow> =
            task.points.iter().map(|(name, at)| ControlRow { sigmas, ..ControlRow::new(name, [at.x, at.y, at.z]) }).collect();
        let settings = self.settings(task);
        let solved = prepare(points, &control, &settings).and_then(|prepared| calibrate(&prepared, &[], |found| read(task, found)));
        // Each of its errors says what cannot be had from this.
        solved.unwrap_or_else(|error| Answer::without(Status::Refused, error.to_string()))
    }
}

fn read(task: &Task, found: &Calibration<'_>) -> Answer {
    let doubts: Vec<String> = found.doubts().iter().map(|doubt| doubt.words.clone()).collect();
    let named = match found.named_camera(0) {
        Ok(named) => named,
        Err(why) => return Answer::without(Status::Failed, why),
    };
    let (names, matrix) = found.covariances.of_camera(0);
    let place_of = |residual: &calibench_adjust::Residual| {
        let sight = found.prepared.survey.sight(found.prepared.sights[residual.observation] as usize);
        let image = task.images.iter().position(|image| image.name == found.prepared.survey.images[sight.image])?;
        let target = found.prepared.survey.target(sight.target);
        let point = task.images[image].points.iter().position(|(place, _)| task.points[*place].0 == target)?;
        Some((image, point))
    };
    let outliers =
        found.solution.each_residual().filter(|residual| residual.used == Use::LeftOut).filter_map(|residual| place_of(&residual));
    Answer {
        status: if doubts.is_empty() { Status::Calibrated } else { Status::Doubtful },
        messages: doubts,
        lens: Some(Lens::Camera(Box::new(named))),
        precision: Precision {
            covariance: Some((names.iter().map(|name| (*name).to_owned()).collect(), matrix)),
            scaled: Some(Scaled::Sigma0),
            ..Precision::default()
        },
        rms_px: Some(found.rms_px()),
        iterations: None,
        shape: Vec::new(),
        outliers: outliers.collect(),
    }
}

impl Calibrator for Own {
    fn version(&self) -> Result<String, String> {
        Ok(env!("CARGO_PKG_VERSION").to_owned())
    }

    fn calibrate(&self, task: &Task) -> Result<Calibrated, String> {
        // Every system has one thread, whose time is that of the calibration.
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|error| error.to_string())?;
        let timed = || {
            let begun = thread_seconds();
            (self.answer(task), thread_seconds() - begun)
        };
        let done = std::thread::scope(|scope| scope.spawn(|| alone.install(timed)).join());
        let (answer, seconds) = done.map_err(|_| "it panicked".to_owned())?;
        Ok(Calibrated { answer, seconds, peak_mb: None })
    }
}

/// The processor's time of this thread so far, s.
fn thread_seconds() -> f64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}
