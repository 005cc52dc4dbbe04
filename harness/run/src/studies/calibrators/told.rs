//! What calibrators are told of a trial, and what is true.

use calibench_calibrators::{Grid, Start, Task, TaskImage, Truth};
use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, OpenCv};
use calibench_model::convert::{ConvertOptions, Target, convert};
use calibench_random::Key;
use calibench_records::results::{Outcome, PointResult};
use calibench_scenario::ViewsSubject;
use calibench_scenario::studies::calibrators::Calibrators;
use nalgebra::Point3;

use super::disturbed::disturb;
use super::grid;

/// A camera that is nearer than this in the model asked for is the same one, px.
const SAME_PX: f64 = 1e-6;

/// What is asked, and what is true.
pub struct Asked<'a> {
    /// What calibrators are told.
    pub task: Task,
    /// Where cameras are compared.
    pub grid: Grid,
    /// The truth.
    pub truth: Truth<'a>,
    /// All image points, px.
    pub measured: Vec<PixelPoint>,
}

impl Asked<'_> {
    /// How many image points there are.
    pub fn image_points(&self) -> usize {
        self.measured.len()
    }
}

/// What is asked about the points of `method` among `points` of the trial of `key`.
///
/// # Errors
/// In words: stations that cannot be drawn, no point at all.
pub fn asked<'a>(
    plan: &Calibrators,
    subject: &'a ViewsSubject,
    (points, method): (&[PointResult], usize),
    key: Key<'_>,
) -> Result<Asked<'a>, String> {
    let stations = subject.stations_of(key).map_err(|error| error.to_string())?;
    let field = &subject.field;
    let mut images: Vec<TaskImage> = Vec::new();
    for station in stations.iter() {
        let mine = points.iter().filter(|point| point.method == method && *point.view == *station.name);
        let seen = mine.filter_map(|point| {
            let Outcome::Measured { position, .. } = point.outcome else { return None };
            Some((field.targets.iter().position(|target| *target.id == *point.target)?, position))
        });
        images.push(TaskImage { name: station.name.clone(), points: seen.collect() });
    }
    disturb(&plan.faults, subject, &stations, &mut images, key);
    images.retain(|image| !image.points.is_empty());
    let measured: Vec<PixelPoint> = images.iter().flat_map(|image| image.points.iter().map(|(_, at)| *at)).collect();
    if measured.is_empty() {
        return Err("no image point was measured".to_owned());
    }
    let told = |at: Point3<f64>| Point3::from(at.coords * plan.faults.told_scale);
    let (size, grid) = (subject.camera.size(), grid(subject));
    let middle = PixelPoint::new(0.5 * f64::from(size.width - 1), 0.5 * f64::from(size.height - 1));
    let task = Task {
        model: plan.model.clone(),
        size,
        sigma_px: plan.sigma_px,
        unit: subject.unit.name().to_owned(),
        board: subject.sheet.map(|board| board.to_string()),
        points: field.targets.iter().map(|target| (target.id.clone(), told(target.surveyed))).collect(),
        points_sigma: 0.0,
        images,
        start: Some(Start { f: plan.start_f, centre: middle }),
        grid: grid.places.clone(),
        seconds: 0.0,
    };
    let distance = plan.distance * if subject.unit.name() == "m" { 1000.0 } else { 1.0 };
    let truth = Truth { camera: &subject.camera, in_model: in_model(&subject.camera, &plan.model), distance };
    Ok(Asked { task, grid, truth, measured })
}

/// `camera` in the model that is asked for, where it is one and the same.
pub(in crate::studies) fn in_model(camera: &Camera, model: &str) -> Option<Camera> {
    let target = match model {
        "opencv4" => Target::OpenCv { coefficients: 4 },
        "opencv5" => Target::OpenCv { coefficients: 5 },
        "opencv8" => Target::OpenCv { coefficients: 8 },
        "opencv-fisheye" => Target::OpenCvFisheye,
        _ => return None,
    };
    // The same model: more coefficients than are asked for would be another camera.
    if let (Camera::OpenCv(OpenCv { distortion, .. }), Target::OpenCv { coefficients }) = (camera, &target)
        && distortion.iter().skip(*coefficients).all(|coefficient| *coefficient == 0.0)
    {
        return Some(*camera);
    }
    let found = convert(camera, target, &ConvertOptions { accept: true, ..ConvertOptions::default() }).ok()?;
    (found.residual.max_px < SAME_PX).then_some(found.camera)
}
