//! Scenarios to results: truth-blind measuring, scored against the truth at the end.

mod bounds;
pub mod judgement;
pub mod network;
mod photographs;
mod scene;
pub mod store;
pub mod truth;
pub mod views;

use std::path::{Path, PathBuf};

use calibench_exchange::PhotoError;
use calibench_measure::{BoardDetector, Configured};
use calibench_model::{Image, Rejection, Start, Unknowns};
use calibench_records::results::{MethodInfo, Trial};
use calibench_scenario::{Scenario, Subject};
use calibench_synth::optics::OpticsError;
use calibench_synth::sensor::SensorError;
use calibench_synth::stations::StationError;
use calibench_synth::view::ViewError;
use rayon::prelude::*;
use thiserror::Error;

pub use photographs::measured as measured_board;
pub use scene::{VIEW, trial_picture, trial_truth};

/// Trials that are computed side by side before they are handed on: bounds the memory, whatever the number of trials.
const BATCH: u64 = 32;

/// How a scenario is run.
pub struct Plan<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// The methods: the scenario's or others.
    pub methods: &'a [Configured],
    /// The seed: the scenario's or another.
    pub seed: u64,
    /// How many trials: the scenario's number or another.
    pub trials: u64,
    /// Finds chessboards, where this build can.
    pub detector: Option<&'a dyn BoardDetector>,
    /// Where photographs are.
    pub data: PathBuf,
    /// Is the Cramér-Rao bound of each target wanted?
    pub bounds: bool,
    /// Where the images of the first trial are written, if anywhere.
    pub images: Option<&'a Path>,
}

/// A run that cannot be completed.
#[derive(Debug, Error)]
pub enum RunError {
    /// A photograph that is there and cannot be read, or an image that cannot be written.
    #[error(transparent)]
    Photo(#[from] PhotoError),
    /// Photographs are not rendered.
    #[error("the scenario is of photographs: there is nothing to render; expected one with [scene] or [testfield]")]
    NothingToRender,
    /// A station that the scenario does not have.
    #[error("no station is called `{name}`; expected one of {known}")]
    NoStation {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// A view that cannot be pictured.
    #[error("station `{station}`: {source}")]
    View {
        /// From where.
        station: String,
        /// Why.
        source: ViewError,
    },
    /// Stations of a trial that see too little.
    #[error(transparent)]
    Station(#[from] StationError),
    /// A lens that cannot be.
    #[error(transparent)]
    Optics(#[from] OpticsError),
    /// An image that the sensor cannot write.
    #[error(transparent)]
    Sensor(#[from] SensorError),
    /// Results that cannot be written.
    #[error("{0}")]
    Output(#[from] std::io::Error),
}

impl<'a> Plan<'a> {
    /// The scenario as its file says, with no images kept.
    pub fn new(scenario: &'a Scenario, detector: Option<&'a dyn BoardDetector>, data: PathBuf) -> Self {
        Self {
            scenario,
            methods: &scenario.methods,
            seed: scenario.seed,
            trials: scenario.trials,
            detector,
            data,
            bounds: true,
            images: None,
        }
    }

    /// The methods as results list them.
    pub fn method_infos(&self) -> Vec<MethodInfo> {
        let missing = self.missing();
        let info = |method: &Configured| MethodInfo {
            label: method.label.as_str().into(),
            version: method.version.as_str().into(),
            unavailable: missing.clone().or_else(|| method.operator.as_ref().err().map(|why| (*why).to_owned())),
        };
        self.methods.iter().map(info).collect()
    }

    /// How many steps [`Plan::run`] reports.
    pub fn steps(&self) -> u64 {
        match &self.scenario.subject {
            Subject::Scene(_) | Subject::Views(_) => self.trials,
            Subject::Photographs(photographs) => photographs.files.len() as u64,
        }
    }

    /// Name and version of the detector that gives the approximate positions, if one does.
    pub fn detector_used(&self) -> Option<(String, String)> {
        let used = matches!(self.scenario.subject, Subject::Photographs(_)) && self.missing().is_none();
        self.detector.filter(|_| used).map(|detector| (detector.name().to_owned(), detector.version()))
    }

    /// Why nothing at all can be measured, if so.
    pub fn missing(&self) -> Option<String> {
        match &self.scenario.subject {
            Subject::Scene(_) | Subject::Views(_) => None,
            Subject::Photographs(subject) => photographs::missing(self, subject),
        }
    }

    /// Runs all trials and hands them to `sink` in their order; `step` is called after each step, on any thread.
    ///
    /// # Errors
    /// Photographs that cannot be read, or what `sink` returns.
    pub fn run(&self, step: &(dyn Fn() + Sync), sink: &mut dyn FnMut(Trial) -> Result<(), RunError>) -> Result<(), RunError> {
        match &self.scenario.subject {
            Subject::Photographs(subject) => sink(photographs::run(self, subject, step)?),
            Subject::Scene(subject) => {
                let prepared = scene::Prepared::new(self, subject)?;
                self.trials(step, sink, &|number| scene::run_trial(self, &prepared, number))
            }
            Subject::Views(subject) => {
                // Drawn coordinates are those of no image.
                let drawn = subject.calibration.as_ref().is_some_and(|calibration| calibration.drawn.is_some());
                let bounds = if self.bounds && !drawn { views::bounds(self, subject)? } else { None };
                // Stations that are drawn anew have their bounds in each trial.
                let fixed = bounds.as_ref().filter(|_| subject.redraw.is_none());
                let prepared = views::Prepared::with_bounds(subject, fixed)?;
                self.trials(step, sink, &|number| views::run_trial(self, &prepared, bounds.as_ref(), number))
            }
        }
    }

    /// Runs trials in batches and hands them on in their order.
    fn trials(
        &self,
        step: &(dyn Fn() + Sync),
        sink: &mut dyn FnMut(Trial) -> Result<(), RunError>,
        trial: &(dyn Fn(u64) -> Result<Trial, RunError> + Sync),
    ) -> Result<(), RunError> {
        for first in (0..self.trials).step_by(BATCH as usize) {
            let batch = first..(first + BATCH).min(self.trials);
            let counted = |number| {
                let trial = trial(number);
                step();
                trial
            };
            for trial in batch.into_par_iter().map(counted).collect::<Result<Vec<_>, _>>()? {
                sink(trial)?;
            }
        }
        Ok(())
    }

    /// What method `index` estimates beside the position.
    fn unknowns(&self, index: usize) -> Unknowns {
        self.methods[index].operator.as_ref().map_or_else(|_| Unknowns::default(), |operator| operator.unknowns())
    }

    fn all_unknowns(&self) -> impl Iterator<Item = Unknowns> {
        (0..self.methods.len()).map(|index| self.unknowns(index))
    }

    /// As [`Self::measure`], with targets that nobody found: where there is no start, no operator is asked.
    fn measure_found(&self, image: &Image, starts: &[Option<Start>]) -> Vec<(usize, Vec<Result<calibench_model::Measurement, Rejection>>)> {
        let found: Vec<Start> = starts.iter().copied().flatten().collect();
        let whole = |(method, results): (usize, Vec<_>)| {
            let mut results = results.into_iter();
            let of = |start: &Option<Start>| start.and_then(|_| results.next()).unwrap_or(Err(Rejection::NotDetected));
            (method, starts.iter().map(of).collect())
        };
        self.measure(image, &found).into_iter().map(whole).collect()
    }

    /// Every available method on one image: (method, results in the order of `starts`).
    fn measure(&self, image: &Image, starts: &[Start]) -> Vec<(usize, Vec<Result<calibench_model::Measurement, Rejection>>)> {
        let available = self.methods.iter().enumerate().filter_map(|(i, method)| Some((i, method.operator.as_deref().ok()?)));
        available.map(|(index, operator)| (index, operator.measure_all(image, starts))).collect()
    }
}
