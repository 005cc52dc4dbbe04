//! Which operator and which model.

use std::sync::Arc;

use super::{Cell, Summary};
use crate::gate::holm;
use crate::gate::statistics::paired_t;

/// The chance that any of the operators (or models) that are as good is called worse.
pub const ALPHA: f64 = 0.05;
/// Sigmas are called too small if chance explains the differences of halves in fewer cases than this.
pub const HONEST: f64 = 0.01;

/// The verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct Trusted<'a> {
    /// The operator and the model to be trusted.
    pub cell: &'a Cell,
    /// The cell with the least hold-out RMS of all: the same operator, and its model.
    pub least: &'a Cell,
    /// The other operators with that model: Holm's p-value of their being no worse; by hold-out RMS.
    pub operators: Vec<(&'a Cell, f64)>,
    /// The other models with that operator, likewise.
    pub models: Vec<(&'a Cell, f64)>,
}

impl Summary {
    /// The operator with the least hold-out RMS, and of the models that cannot be told from its best one the simplest. `None` if nothing could be judged.
    pub fn trusted(&self) -> Option<Trusted<'_>> {
        let rms = |cell: &Cell| cell.holdout.map_or(f64::INFINITY, |holdout| holdout.value);
        let compared = |cell: &&Cell| cell.holdout.is_some() && self.is_compared(&cell.method);
        let least = self.cells.iter().filter(compared).min_by(|a, b| rms(a).total_cmp(&rms(b)))?;
        let ranked = |others: &dyn Fn(&Cell) -> bool| {
            let others = self.cells.iter().filter(compared).filter(|cell| others(cell) && *cell != least).collect();
            no_worse(least, others)
        };
        let operators = ranked(&|cell| cell.model == least.model);
        let models = ranked(&|cell| cell.method == least.method);
        let alike = models.iter().filter(|(_, p)| *p > ALPHA).map(|(cell, _)| *cell).chain([least]);
        let cell = alike.min_by(|a, b| a.parameters.cmp(&b.parameters).then(rms(a).total_cmp(&rms(b))))?;
        Some(Trusted { cell, least, operators, models })
    }

    /// Did the operator measure enough to be compared?
    pub fn is_compared(&self, method: &str) -> bool {
        let found = self.methods.iter().find(|measured| &*measured.method == method);
        found.is_some_and(|measured| measured.measured as f64 >= super::super::COMPARABLE * measured.of as f64)
    }
}

/// Holm's p-values of cells being no worse than the least one: t-tests of the paired differences of the logarithms of the views' hold-out RMS, one-sided.
fn no_worse<'a>(least: &Cell, mut others: Vec<&'a Cell>) -> Vec<(&'a Cell, f64)> {
    let rms = |cell: &Cell| cell.holdout.map_or(f64::INFINITY, |holdout| holdout.value);
    others.sort_by(|a, b| rms(a).total_cmp(&rms(b)));
    let growth = |cell: &&Cell| {
        let pair = |(view, (own, _)): (&Arc<str>, &(f64, usize))| {
            let (best, _) = least.held_out.get(view)?;
            (*own > 0.0 && *best > 0.0).then(|| (own / best).ln())
        };
        paired_t(&cell.held_out.iter().filter_map(pair).collect::<Vec<_>>()).growth
    };
    let p = holm(&others.iter().map(growth).collect::<Vec<_>>());
    others.into_iter().zip(p).collect()
}

impl Trusted<'_> {
    /// By how much the predicted sigmas must be enlarged: 1 where halves do not say that they are too small.
    pub fn inflation(&self) -> f64 {
        self.cell.split.filter(|split| split.p < HONEST).map_or(1.0, |split| split.modes.max(split.ratio()).max(1.0))
    }

    /// The operators that cannot be told from the trusted one.
    pub fn equal_operators(&self) -> impl Iterator<Item = &Cell> {
        self.operators.iter().filter(|(_, p)| *p > ALPHA).map(|(cell, _)| *cell)
    }

    /// The models that cannot be told from the one with the least hold-out RMS.
    pub fn equal_models(&self) -> impl Iterator<Item = &Cell> {
        self.models.iter().filter(|(_, p)| *p > ALPHA).map(|(cell, _)| *cell)
    }
}
