//! The board of a trial: as its file has it, and as it is.

use calibench_model::camera::CameraModel;
use calibench_model::observation::Start;
use calibench_model::{ControlRow, PixelPoint, Points, Testfield};
use calibench_random::{Key, Purpose, stream};
use calibench_scenario::studies::tasks::BoardErrors;
use nalgebra::{Point3, Vector3};
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::studies::told::Trial;

/// A board in the plane Z = 0.
pub(super) struct Board {
    /// Its corners as its file has them.
    pub(super) nominal: Vec<ControlRow>,
    /// Where they are, object units, in the same order.
    pub(super) real: Vec<Point3<f64>>,
    /// Its middle, object units.
    pub(super) middle: [f64; 2],
    /// Half of its width and height, object units.
    pub(super) half: [f64; 2],
}

impl Board {
    /// The board of the trial of `key`: `field`'s, with errors of its own.
    pub(super) fn draw(errors: BoardErrors, field: &Testfield, key: Key<'_>) -> Self {
        let points: Vec<Point3<f64>> = field.targets.iter().map(|target| field.position(target)).collect();
        let range = |axis: usize| {
            let [low, high] =
                [f64::min as fn(f64, f64) -> f64, f64::max].map(|of| points.iter().map(|point| point[axis]).reduce(of).unwrap_or(0.0));
            (0.5 * (low + high), 0.5 * (high - low))
        };
        let [(x, half_x), (y, half_y)] = [0, 1].map(range);
        let mut rng = stream(Key { view: "", target: "", ..key }, Purpose::PrintNoise);
        let scale = 1.0 + errors.scale * normal(&mut rng);
        let bends = errors.flatness * Vector3::from_fn(|_, _| normal(&mut rng));
        let real = points.iter().map(|point| {
            let (u, v) = ((point.x - x) / half_x, (point.y - y) / half_y);
            let lift = bends.dot(&shapes(u, v));
            let printed = errors.print * Vector3::from_fn(|_, _| normal(&mut rng));
            point * scale + Vector3::z() * lift + printed
        });
        let real = real.collect();
        let nominal = field.targets.iter().zip(&points).map(|(target, at)| ControlRow::new(&target.id, at.coords.into())).collect();
        Self { nominal, real, middle: [x, y], half: [half_x, half_y] }
    }

    /// Its corners with what is told of them: each as its own errors have it, though those across the board are not independent of each other.
    pub(super) fn told(&self, errors: BoardErrors) -> Vec<ControlRow> {
        let row = |row: &ControlRow| {
            let [u, v] = [0, 1].map(|axis| (row.position[axis] - self.middle[axis]) / self.half[axis]);
            let across = errors.print.hypot(errors.flatness * shapes(u, v).norm());
            let sigmas = [errors.print, errors.print, across];
            ControlRow { sigmas: Some(sigmas).filter(|sigmas| sigmas.iter().all(|sigma| *sigma > 0.0)), ..row.clone() }
        };
        self.nominal.iter().map(row).collect()
    }

    /// The image points of `trial`, which are those of the board as its file has it, moved to where the board is.
    ///
    /// # Errors
    /// In words: a station that is none of the trial's.
    pub(super) fn pictured(&self, trial: &Trial<'_>) -> Result<Points, String> {
        let (field, camera) = (&trial.subject.field, &trial.subject.camera);
        let mut moved = Points::default();
        for row in trial.points.rows() {
            let (image, target) = (row.image, row.target);
            let pose = trial.pose(image).ok_or_else(|| format!("no station is called {image}"))?;
            let place =
                field.targets.iter().position(|known| *known.id == *target).ok_or_else(|| format!("no target is called {target}"))?;
            let project = |object: &Point3<f64>| camera.project(pose.ray(object)).map_err(|error| error.to_string());
            let (was, is) = (project(&field.position(&field.targets[place]))?, project(&self.real[place])?);
            let at = PixelPoint::new(row.start.position.x + is.x - was.x, row.start.position.y + is.y - was.y);
            moved.push(image, target, Start::at(at));
        }
        Ok(moved)
    }
}

/// The heights of the three bends of size one, u and v from -1 to 1 over the board.
fn shapes(u: f64, v: f64) -> Vector3<f64> {
    Vector3::new(1.0 - u * u, 1.0 - v * v, u * v)
}

pub(super) fn normal(rng: &mut impl Rng) -> f64 {
    StandardNormal.sample(rng)
}
