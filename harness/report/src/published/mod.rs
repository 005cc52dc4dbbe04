//! What papers printed, and which of our figures stands behind each cell.

pub(crate) mod adjustment;
mod asked;
mod count;
mod ensemble;
mod error;
mod every_method;
mod figure;
mod kind;
mod many;
mod metric;
mod notes;
mod one;
mod range;
mod read;
mod rules;
mod schema;
mod section;
mod sweep;
mod trials;
mod verdict;

pub use count::{Counts, Figures};
pub use ensemble::{Ensemble, EnsembleError};
pub use error::PublishedError;
pub(crate) use figure::{errors as errors_of, of_points};
pub use kind::Kind;
pub use metric::Metric;
pub(crate) use range::Range;
pub(crate) use read::PREDICTIONS;
pub use read::{papers, tables};
pub use schema::schema;
pub(crate) use section::{findings, not_run, section, verdicts, without_records};
pub(crate) use sweep::{section as swept, verdicts as swept_verdicts};
pub(crate) use trials::{Trials, ratio};
pub use verdict::{Printed, Tally, Verdict};

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

/// A published table: `reference/published/<paper>/table-N.toml`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Number and title, as printed.
    pub title: String,
    /// Paper, section, page.
    pub source: String,
    /// Unit of the printed figures.
    pub unit: String,
    /// The scenario whose records stand behind the cells, as in `galo-2011/corners`.
    pub scenario: String,
    /// The method behind the cells, by its label, as in `forstner:window=11`.
    #[serde(deserialize_with = "calibench_records::spelling::label")]
    #[schemars(with = "String")]
    pub method: String,
    /// The columns, in their order.
    pub columns: Vec<String>,
    /// What was found out about the table: paragraphs of Markdown.
    #[serde(default)]
    pub findings: Vec<String>,
    /// Other scenarios that are shown beside it.
    #[serde(default)]
    pub beside: Vec<String>,
    /// Sets of targets over which statistics are shown for every method. Default: all targets.
    #[serde(default, rename = "set")]
    pub sets: Vec<TargetSet>,
    /// A CSV file beside the table with the figures of many plausible experiments, where the paper does not tell which was its own; see `predicted` of cells.
    #[serde(default)]
    pub ensemble: Option<String>,
    /// What of the experiment was fitted to figures of this table, or is free: every figure that it touches is not comparable.
    #[serde(default, rename = "fitted")]
    pub causes: Vec<FittedCause>,
    /// The printed cells.
    #[serde(rename = "cell")]
    pub cells: Vec<Cell>,
    /// What `ensemble` holds.
    #[serde(skip)]
    pub experiments: Option<Ensemble>,
}

/// A named choice of targets.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TargetSet {
    /// Its name in the report.
    pub name: String,
    /// The targets that are left out.
    #[serde(default)]
    pub except: Vec<String>,
}

/// What was fitted to some figures of a table, or is free to make them anything.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FittedCause {
    /// What it is, as the reason that stands below the table.
    pub cause: String,
    /// How the figures `of` begin that it touches: cells with them are not comparable, whatever they print.
    pub figures: Vec<String>,
}

/// A cell, by its place.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// The table's file without its ending, as in `table-4`.
    pub table: String,
    /// Its row.
    pub row: String,
    /// Its column.
    pub column: String,
}

/// A printed figure.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cell {
    /// Its row.
    pub row: String,
    /// Its column.
    pub column: String,
    /// The figure as printed, to the letter: `22.520`, `-7`, `1/18.9`; any text where `not_comparable` says why.
    pub printed: String,
    /// Which of our figures is meant.
    pub metric: Metric,
    /// How our figure is obtained; needed unless there is none (`unscored`).
    #[serde(default)]
    pub kind: Option<Kind>,
    /// The cell of the same paper that stands for this printed figure, where several compare it or ratios are made of it: it is counted once.
    #[serde(default)]
    pub same_as: Option<Place>,
    /// The target, for figures of one target: in the first image that shows it.
    #[serde(default)]
    pub target: Option<String>,
    /// Targets left out of a statistic.
    #[serde(default)]
    pub except: Vec<String>,
    /// Added to our figure to give what was printed, in its unit: a true coordinate, where the paper prints positions in an image of its own.
    #[serde(default)]
    pub plus: f64,
    /// Which cell of a sweep is meant: the value of each key that is swept.
    #[serde(default)]
    pub at: BTreeMap<String, f64>,
    /// What is wrong in print, and what it must have been.
    #[serde(default)]
    pub misprint: Option<String>,
    /// The method by its label, where it is not the table's.
    #[serde(default, deserialize_with = "calibench_records::spelling::optional_label")]
    #[schemars(with = "Option<String>")]
    pub method: Option<String>,
    /// The parameter of the interior orientation, for figures of adjustments; `c` by default.
    #[serde(default)]
    pub of: Option<String>,
    /// The set of parameters or the block, for `figure`.
    #[serde(default)]
    pub set: Option<String>,
    /// The group of figures, for `figure`: `network` by default.
    #[serde(default)]
    pub group: Option<String>,
    /// What our `figure` is multiplied by: a length that was printed, where the figure is a scale. 1 by default.
    #[serde(default)]
    pub times: Option<f64>,
    /// What a `figure_ratio` is divided by.
    #[serde(default)]
    pub over: Option<Divisor>,
    /// The column of the table's `ensemble` that stands for the cell: what is printed must lie where 95 % of the experiments lie.
    #[serde(default)]
    pub predicted: Option<String>,
    /// By how many units of the last digit ours may differ, where the usual rule does not hold: 0.5 for counts.
    #[serde(default)]
    pub units: Option<f64>,
    /// How far ours may be from print, in its unit, where ours is predicted by a model that was fitted to other printed figures. The verdict is then
    /// *consistent* or *inconsistent*.
    #[serde(default)]
    pub consistent_within: Option<f64>,
    /// The bound that is printed, in its unit, where the print is one, as in "0.1 or better": it reproduces where runs of ours keep it, too. `printed` may then be any text.
    #[serde(default)]
    pub at_most: Option<f64>,
    /// Why the two cannot be compared, if so.
    #[serde(default)]
    pub not_comparable: Option<String>,
}

/// The figure below a ratio; what is not given is that of the cell.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Divisor {
    /// The method by its label.
    #[serde(default, deserialize_with = "calibench_records::spelling::optional_label")]
    #[schemars(with = "Option<String>")]
    pub method: Option<String>,
    /// The set of parameters or the block.
    #[serde(default)]
    pub set: Option<String>,
    /// The figure's name.
    #[serde(default)]
    pub of: Option<String>,
}

impl Table {
    /// What was fitted to the figure of `cell` or is free to make it anything, if so.
    fn cause(&self, cell: &Cell) -> Option<&FittedCause> {
        let of = cell.of.as_deref()?;
        self.causes.iter().find(|fitted| fitted.figures.iter().any(|figure| of.starts_with(figure.as_str())))
    }

    /// Whether its figures are those of adjustments.
    pub fn is_of_adjustments(&self) -> bool {
        self.cells.iter().any(|cell| cell.metric.is_of_adjustment())
    }

    /// Whether any of its figures is one of measured points.
    pub fn is_of_points(&self) -> bool {
        self.cells.iter().any(|cell| !cell.metric.is_of_adjustment() && cell.metric != Metric::Unscored)
    }

    /// The labels of its rows, in their order, once each.
    fn rows(&self) -> Vec<&str> {
        let mut labels: Vec<&str> = Vec::new();
        for cell in &self.cells {
            if !labels.contains(&cell.row.as_str()) {
                labels.push(&cell.row);
            }
        }
        labels
    }

    /// Its sets of targets, or all targets where it names none.
    fn sets_or_all(&self) -> Vec<TargetSet> {
        if self.sets.is_empty() { vec![TargetSet { name: "all".to_owned(), except: Vec::new() }] } else { self.sets.clone() }
    }
}

#[cfg(test)]
impl Table {
    /// A table of no cell.
    pub(crate) fn bare() -> Self {
        Self {
            title: "T".into(),
            source: "S".into(),
            unit: "px".into(),
            scenario: "s".into(),
            method: "m".into(),
            columns: vec!["c".into()],
            findings: Vec::new(),
            beside: Vec::new(),
            sets: Vec::new(),
            ensemble: None,
            causes: Vec::new(),
            cells: Vec::new(),
            experiments: None,
        }
    }
}

#[cfg(test)]
impl Cell {
    /// A cell of nothing but what is printed and what of ours it is compared with.
    pub(crate) fn bare(printed: &str, metric: Metric) -> Self {
        Self {
            row: "r".into(),
            column: "c".into(),
            printed: printed.into(),
            metric,
            kind: (metric != Metric::Unscored).then_some(Kind::Prediction),
            same_as: None,
            target: None,
            except: Vec::new(),
            plus: 0.0,
            at: BTreeMap::new(),
            misprint: None,
            method: None,
            of: None,
            set: None,
            group: None,
            over: None,
            times: None,
            predicted: None,
            units: None,
            consistent_within: None,
            at_most: None,
            not_comparable: None,
        }
    }
}
