//! Ceilings: absolute bounds, written by hand, that blessing cannot move.

use std::io;
use std::path::{Path, PathBuf};

use calibench_diagnostics::{Problem, Problems};
use serde::Deserialize;
use thiserror::Error;
use toml::Spanned;

use super::finding::{Finding, Verdict};
use super::point_entry::{Coordinates, Entry};
use super::table::{MethodTable, Table};

/// What a ceiling bounds.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum CeilingMetric {
    /// `sqrt(mean(dx^2 + dy^2))` over the points that were measured and not lost, px. Lost points have their own metric.
    RmseXy,
    /// Lost points as a fraction of all, 0 to 1.
    LostShare,
    /// Rejected points as a fraction of all, 0 to 1.
    RejectedShare,
    /// The largest `sqrt(dx^2 + dy^2)` of all measured points, lost ones too, px.
    MaxError,
}

/// One ceiling.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Ceiling {
    /// The scenario's name.
    pub scenario: String,
    /// The method's label.
    #[serde(deserialize_with = "calibench_records::spelling::label")]
    pub method: String,
    /// What is bounded.
    pub metric: CeilingMetric,
    /// The bound, in the metric's unit.
    pub at_most: f64,
    /// Why the bound is this one.
    pub why: String,
}

/// The file of ceilings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ceilings {
    /// In the order of the file.
    pub list: Vec<Ceiling>,
}

/// A file of ceilings that is none.
#[derive(Debug, Error)]
pub enum CeilingError {
    /// It is not there: what was deleted must not pass for what was never written.
    #[error("{}: there is no such file; expected the project's ceilings, or an empty file if it has none", .0.display())]
    Missing(PathBuf),
    /// It cannot be read.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// It has mistakes, each with its place.
    #[error(transparent)]
    Problems(#[from] Problems),
}

/// The file's name in the folder of baselines.
pub const CEILINGS: &str = "ceilings.toml";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Wire {
    #[serde(default)]
    ceiling: Vec<Spanned<Ceiling>>,
}

impl CeilingMetric {
    /// The name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::RmseXy => "rmse_xy",
            Self::LostShare => "lost_share",
            Self::RejectedShare => "rejected_share",
            Self::MaxError => "max_error",
        }
    }

    /// The figure of a method, in the metric's unit; `None` when there is none: no point, or no truth.
    pub fn figure(self, coordinates: Coordinates, method: &MethodTable) -> Option<f64> {
        let points = method.points.len();
        let share = |count: usize| (points > 0).then(|| count as f64 / points as f64);
        let [_, lost, rejected] = method.counts();
        match (self, coordinates) {
            (Self::RejectedShare, _) => share(rejected),
            (_, Coordinates::Positions) => None,
            (Self::LostShare, _) => share(lost),
            (Self::RmseXy, _) => {
                let squares: Vec<f64> = method.points.values().filter_map(Entry::kept).map(|[x, y]| x * x + y * y).collect();
                (!squares.is_empty()).then(|| calibench_records::statistics::paired::mean(&squares).sqrt())
            }
            (Self::MaxError, _) => {
                let errors = method.points.values().filter_map(Entry::coordinates).map(|[x, y]| x.hypot(y));
                // An error that is not a number is larger than any.
                errors.map(|e| if e.is_nan() { f64::INFINITY } else { e }).reduce(f64::max)
            }
        }
    }
}

impl Ceilings {
    /// Reads the file. A project without ceilings has one that says so: an empty one.
    ///
    /// # Errors
    /// A file that is not there or cannot be read; every mistake in it with line and column, unknown keys among them.
    pub fn read(path: &Path) -> Result<Self, CeilingError> {
        match calibench_files::bounded::text(path) {
            Ok(text) => Ok(Self::parse(&path.display().to_string(), &text)?),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Err(CeilingError::Missing(path.to_owned())),
            Err(source) => Err(CeilingError::File { path: path.to_owned(), source }),
        }
    }

    /// Reads the `text` of `file`.
    ///
    /// # Errors
    /// Every mistake with its place in the text.
    pub fn parse(file: &str, text: &str) -> Result<Self, Problems> {
        let refused = |problems| Problems { file: file.to_owned(), text: text.to_owned(), problems };
        let wire: Wire =
            toml::from_str(text).map_err(|error| refused(vec![Problem::new(error.span().unwrap_or(0..0), error.message())]))?;
        let problems: Vec<Problem> = wire.ceiling.iter().filter_map(mistake).collect();
        if problems.is_empty() {
            Ok(Self { list: wire.ceiling.into_iter().map(Spanned::into_inner).collect() })
        } else {
            Err(refused(problems))
        }
    }

    /// A finding for each ceiling that a run exceeds or that cannot be held against any run.
    pub fn check(&self, runs: &[&Table]) -> Vec<Finding> {
        self.list.iter().filter_map(|ceiling| ceiling.check(runs)).collect()
    }
}

fn mistake(ceiling: &Spanned<Ceiling>) -> Option<Problem> {
    let Ceiling { at_most, why, .. } = ceiling.get_ref();
    if !(at_most.is_finite() && *at_most >= 0.0) {
        return Some(Problem::new(ceiling.span(), format!("`at_most` is {at_most}: expected a number that is not negative")));
    }
    why.trim().is_empty().then(|| Problem::new(ceiling.span(), "`why` is empty: expected a sentence"))
}

impl Ceiling {
    fn check(&self, runs: &[&Table]) -> Option<Finding> {
        let finding = |message: String| Finding::new(Verdict::Fails, &self.scenario, &self.method, self.metric.name(), message);
        let unheld =
            |why: &str| Some(Finding { baseline: Some(self.at_most), ..finding(format!("ceiling not held against anything: {why}")) });
        let Some(run) = runs.iter().find(|run| run.scenario == self.scenario) else { return unheld("the scenario was not run") };
        let Some(method) = run.method(&self.method) else { return unheld("the method was not run") };
        if let Some(why) = &method.unavailable {
            return unheld(&format!("the method is unavailable: {why}"));
        }
        let Some(now) = self.metric.figure(run.coordinates, method) else {
            return unheld("there is no such figure, for want of points or truth");
        };
        (now > self.at_most).then(|| finding(format!("above its ceiling ({})", self.why.trim())).figures(self.at_most, now))
    }
}
