//! The uncertainty of what is measured, by its sources.

use calibench_model::ControlRow;
use nalgebra::{DMatrix, RowDVector};

use crate::scene::Scene;
use crate::{Exact, KnownCamera, Named, Source, Task, TaskError};

/// Half of a 95 % interval in standard deviations.
pub const HALF_95: f64 = 1.959_963_985;
/// Of the half interval, by which the measurement itself may depart from its derivatives.
const MOST_BENT: f64 = 0.1;

/// What a task costs.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// The numbers of what is measured.
    pub components: Vec<Component>,
    /// What is taken as exact.
    pub exact: Vec<Exact>,
    /// Whether the camera's file has standard deviations without correlations.
    pub uncorrelated: bool,
    /// By how much of half an interval the ends of one are elsewhere than the derivatives say, the largest; `None` where the measurement fails there.
    pub bent: Option<f64>,
}

/// A number that is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// What it is.
    pub named: Named,
    /// Its standard uncertainty, object units or degrees.
    pub sigma: f64,
    /// What makes it up, in the order of [`Source::ALL`].
    pub parts: Vec<Part>,
}

/// What a source makes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// The source.
    pub source: Source,
    /// The standard uncertainty that it makes alone, object units or degrees: the squares of all sum up to that of the whole.
    pub sigma: f64,
    /// Its share of the variance, 0 to 1.
    pub share: f64,
}

impl Component {
    /// Half of its 95 % interval, object units or degrees.
    pub fn half(&self) -> f64 {
        HALF_95 * self.sigma
    }

    /// Its 95 % interval about its value; `None` where only its error has a meaning.
    pub fn interval(&self) -> Option<[f64; 2]> {
        self.named.value.map(|value| [value - self.half(), value + self.half()])
    }

    /// The source that makes the most.
    pub fn largest(&self) -> Option<Source> {
        self.parts.iter().max_by(|a, b| a.sigma.total_cmp(&b.sigma)).map(|part| part.source)
    }
}

impl Budget {
    /// Of a task with a camera; with `control` poses are those that its points in each image give, with the same camera, and else as they are stated.
    ///
    /// To first order (GUM, JCGM 100:2008, 5.1.2): errors of the camera that poses make up for cost nothing.
    ///
    /// # Errors
    /// See [`TaskError`].
    pub fn of(task: &Task, camera: &KnownCamera<'_>, control: Option<&[ControlRow]>) -> Result<Self, TaskError> {
        let scene = Scene::new(task, camera, control)?;
        let rows = scene.rows()?;
        let components = scene.components(&rows);
        let bent = scene.bent(&rows, &components);
        Ok(Self { components, exact: Exact::of(task, camera, control), uncorrelated: camera.is_uncorrelated(), bent })
    }

    /// Whether the measurement is so far from linear that its intervals are not to be relied on.
    pub fn is_bent(&self) -> bool {
        self.bent.is_none_or(|bent| bent > MOST_BENT)
    }
}

impl Scene<'_> {
    /// Derivatives of what is measured by all numbers that err.
    pub(crate) fn rows(&self) -> Result<DMatrix<f64>, TaskError> {
        Ok(self.task.quantity.gradient()? * self.of_points()?)
    }

    pub(crate) fn components(&self, rows: &DMatrix<f64>) -> Vec<Component> {
        let named = self.task.quantity.named();
        let component = |(place, named): (usize, Named)| {
            let row: RowDVector<f64> = rows.row(place).into();
            let sigma = row.norm();
            let part = |(source, range): &(Source, std::ops::Range<usize>)| {
                let own = row.columns(range.start, range.len()).norm();
                Part { source: *source, sigma: own, share: if sigma > 0.0 { (own / sigma).powi(2) } else { 0.0 } }
            };
            Component { named, sigma, parts: self.sources().iter().map(part).collect() }
        };
        named.into_iter().enumerate().map(component).collect()
    }

    /// The measurement itself at both ends of each interval, in the direction that changes it most, beside its derivatives.
    fn bent(&self, rows: &DMatrix<f64>, components: &[Component]) -> Option<f64> {
        let mut most = 0.0_f64;
        for (place, component) in components.iter().enumerate().filter(|(_, component)| component.sigma > 0.0) {
            for side in [-HALF_95, HALF_95] {
                let z: Vec<f64> = rows.row(place).iter().map(|by| side * by / component.sigma).collect();
                let found = self.simulated(&z).ok()?[place];
                most = most.max((found - side * component.sigma).abs() / component.half());
            }
        }
        Some(most).filter(|most| most.is_finite())
    }
}
