//! A task as its camera sees it without errors, and what of it errs: independent standard normal numbers, all 0 for none.

use std::ops::Range;

use calibench_adjust::approximate::Shape;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{ControlRow, PixelPoint, Pose};
use nalgebra::{DMatrix, Point3, Vector3};

use crate::{KnownCamera, Source, Station, Task, TaskError};

/// Control points of an image, at least.
const LEAST_CONTROL: usize = 4;
/// A point may be so far off its plane, of the distance to its camera.
const ROUNDING: f64 = 1e-9;
/// Height of control over its plane, of its extent, up to which it is a board.
const FLAT: f64 = 5e-3;

/// A control point.
pub(crate) struct ControlPoint {
    pub(crate) object: Point3<f64>,
    /// Standard deviations of X, Y, Z, object units.
    pub(crate) sigmas: Vector3<f64>,
    /// What each of the three bends does to it, in standard deviations of a bend, object units.
    pub(crate) bends: [Vector3<f64>; 3],
}

/// Something seen in an image.
#[derive(Clone, Copy)]
pub(crate) struct Seen {
    /// Which point or control point.
    pub(crate) of: usize,
    /// Which of all image points, of measured points and of control apart.
    pub(crate) number: usize,
    /// Without errors.
    pub(crate) at: PixelPoint,
}

/// A task as its camera sees it.
pub(crate) struct Scene<'a> {
    pub(crate) task: &'a Task,
    pub(crate) camera: &'a Camera,
    /// Parameters by standard normal numbers.
    pub(crate) factor: DMatrix<f64>,
    /// The standard deviation of the model's error in those of the camera's.
    pub(crate) excess: f64,
    pub(crate) control: Vec<ControlPoint>,
    /// Of each image, the measured points.
    pub(crate) points: Vec<Vec<Seen>>,
    /// Of each image, the control points; empty without control.
    pub(crate) marks: Vec<Vec<Seen>>,
    /// Which numbers are whose.
    parts: Vec<(Source, Range<usize>)>,
}

impl<'a> Scene<'a> {
    pub(crate) fn new(task: &'a Task, known: &KnownCamera<'a>, rows: Option<&[ControlRow]>) -> Result<Self, TaskError> {
        let camera = known.camera;
        let control = rows.map_or(Ok(Vec::new()), |rows| control_points(task, rows))?;
        let objects = task.quantity.points();
        let points = all_seen(camera, &task.images, || objects.iter().copied());
        let marks = all_seen(camera, &task.images, || control.iter().map(|point| point.object));
        let expected = if task.plane.is_some() { 1 } else { 2 };
        for point in 0..objects.len() {
            let found = points.iter().flatten().filter(|seen| seen.of == point).count();
            if found < expected {
                return Err(TaskError::NotSeen { point: point + 1, found, expected });
            }
        }
        if let Some(plane) = &task.plane {
            for (point, at) in objects.iter().enumerate() {
                let off = (at - plane.point).dot(&plane.normal).abs();
                let far = task.images.iter().map(|station| (at - station.pose.centre).norm()).fold(0.0, f64::max);
                if off > ROUNDING * far {
                    return Err(TaskError::OffPlane { point: point + 1, off });
                }
            }
        }
        if rows.is_some()
            && let Some(image) = marks.iter().position(|marks| marks.len() < LEAST_CONTROL)
        {
            return Err(TaskError::Control { image: image + 1, found: marks[image].len() });
        }
        let (factor, excess) = (known.factor()?, known.excess());
        let mut scene = Self { task, camera, factor, excess, control, points, marks, parts: Vec::new() };
        scene.parts = scene.parts(rows.is_some());
        Ok(scene)
    }

    /// The numbers of each source that errs at all.
    fn parts(&self, has_control: bool) -> Vec<(Source, Range<usize>)> {
        let (task, control) = (self.task, self.task.control);
        let stated = |of: fn(&Station) -> f64| !has_control && task.images.iter().any(|station| of(station) > 0.0);
        let when = |errs: bool, count: usize| if errs { count } else { 0 };
        let all = |seen: &[Vec<Seen>]| seen.iter().map(Vec::len).sum::<usize>();
        let is_printed = self.control.iter().any(|point| point.sigmas != Vector3::zeros());
        let (plane, tilt) = task.plane.map_or((0.0, 0.0), |plane| (plane.sigma, plane.sigma_tilt));
        let has_scale = task.quantity.has_scale();
        let counts = Source::ALL.map(|source| match source {
            Source::Image => 2 * all(&self.points),
            Source::Camera => self.factor.ncols(),
            Source::Model => when(self.excess > 0.0, self.factor.ncols()),
            Source::Centres => when(stated(|station| station.sigma_centre), 3 * task.images.len()),
            Source::Angles => when(stated(|station| station.sigma_angles), 3 * task.images.len()),
            Source::ControlImage => when(has_control && control.sigma_px > 0.0, 2 * all(&self.marks)),
            Source::ControlPoints => when(is_printed, 3 * self.control.len()),
            Source::Flatness => when(has_control && control.flatness_sigma > 0.0, 3),
            Source::Plane => when(plane > 0.0, 1),
            Source::PlaneTilt => when(tilt > 0.0, 2),
            Source::Scale => when(has_scale && task.scale_sigma > 0.0, 1),
            Source::Temperature => when(has_scale && task.temperature.is_some_and(|found| found.relative_sigma() > 0.0), 1),
        });
        let mut from = 0;
        let range = |(source, count): (Source, usize)| {
            from += count;
            (source, from - count..from)
        };
        Source::ALL.into_iter().zip(counts).map(range).filter(|(_, range)| !range.is_empty()).collect()
    }

    /// Which numbers are of which source, in their order.
    pub(crate) fn sources(&self) -> &[(Source, Range<usize>)] {
        &self.parts
    }

    /// How many numbers err.
    pub(crate) fn count(&self) -> usize {
        self.parts.last().map_or(0, |(_, range)| range.end)
    }

    /// Where the numbers of a source begin; `None` where it does not err.
    pub(crate) fn first(&self, source: Source) -> Option<usize> {
        self.parts.iter().find(|(one, _)| *one == source).map(|(_, range)| range.start)
    }

    /// Relative standard uncertainties of scale and temperature, with the place of their numbers.
    pub(crate) fn scales(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let temperature = self.task.temperature.map_or(0.0, |found| found.relative_sigma());
        let all = [(Source::Scale, self.task.scale_sigma), (Source::Temperature, temperature)];
        all.into_iter().filter_map(|(source, sigma)| Some((self.first(source)?, sigma)))
    }
}

/// What of `objects` lies in the frame of each image.
fn all_seen<I: Iterator<Item = Point3<f64>>>(camera: &Camera, images: &[Station], objects: impl Fn() -> I) -> Vec<Vec<Seen>> {
    let mut number = 0;
    let mut of_image = |station: &Station| {
        let one = |(of, object): (usize, Point3<f64>)| {
            let at = in_frame(camera, &station.pose, &object)?;
            number += 1;
            Some(Seen { of, number: number - 1, at })
        };
        objects().enumerate().filter_map(one).collect()
    };
    images.iter().map(&mut of_image).collect()
}

/// Where an object point is in the frame of an image; `None` outside.
pub(crate) fn in_frame(camera: &Camera, pose: &Pose, object: &Point3<f64>) -> Option<PixelPoint> {
    let size = camera.size();
    let at = camera.project(pose.ray(object)).ok()?;
    let within = |value: f64, side: u32| value >= -0.5 && value <= f64::from(side) - 0.5;
    (within(at.x, size.width) && within(at.y, size.height)).then_some(at)
}

fn control_points(task: &Task, rows: &[ControlRow]) -> Result<Vec<ControlPoint>, TaskError> {
    let errors = task.control;
    let objects = || rows.iter().map(|row| Point3::from(row.position));
    let shape = Shape::of(objects());
    let mut low_high = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for place in objects().map(|object| shape.in_plane(&object)) {
        for (ends, value) in low_high.iter_mut().zip(place) {
            *ends = [ends[0].min(value), ends[1].max(value)];
        }
    }
    if errors.flatness_sigma > 0.0 && (shape.extents[2] > FLAT * shape.extents[0] || shape.extents[1] <= FLAT * shape.extents[0]) {
        return Err(TaskError::NoBoard);
    }
    let normal: Vector3<f64> = shape.axes.column(2).into();
    let one = |row: &ControlRow| {
        let object = Point3::from(row.position);
        let place = shape.in_plane(&object);
        let [u, v] = [0, 1].map(|axis| {
            let [low, high] = low_high[axis];
            (place[axis] - f64::midpoint(low, high)) / (0.5 * (high - low)).max(f64::MIN_POSITIVE)
        });
        // The shapes of `calibrate`'s bend.
        let bends = [1.0 - u * u, 1.0 - v * v, u * v]
            .map(|lift| if errors.flatness_sigma > 0.0 { normal * (lift * errors.flatness_sigma) } else { Vector3::zeros() });
        ControlPoint { object, sigmas: Vector3::from(row.sigmas.unwrap_or([errors.print_sigma; 3])), bends }
    };
    Ok(rows.iter().map(one).collect())
}
