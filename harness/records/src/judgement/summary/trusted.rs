//! Which operator and which model.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Cell, Summary};
use crate::statistics::holm;
use crate::statistics::paired::paired_t;

/// The chance (0 to 1) that any of the operators (or models) that are as good is called worse.
pub const ALPHA: f64 = 0.05;
/// Sigmas are called too small if chance explains the differences of halves in fewer cases than this (0 to 1).
pub const HONEST: f64 = 0.01;

/// The verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct Trusted<'a> {
    /// The operator and the model to be trusted.
    pub cell: &'a Cell,
    /// The cell with the least hold-out RMS of all: the same operator.
    pub least: &'a Cell,
    /// The model with which that operator predicts one side of the board best from the other.
    pub farthest: &'a Cell,
    /// The other operators with that model: Holm's p-value of their being no worse; by hold-out RMS.
    pub operators: Vec<(&'a Cell, f64)>,
    /// The other models with that operator, likewise, by that prediction.
    pub models: Vec<(&'a Cell, f64)>,
}

impl Summary {
    /// The operator with the least hold-out RMS, and of the models that cannot be told from its best one the simplest. `None` if nothing could be judged.
    ///
    /// Operators are told apart by corners among those that the pose comes from: there their noise shows. Models are told apart by one side of the board
    /// predicted from the other: among its corners a pose makes up for most of what a model lacks.
    pub fn trusted(&self) -> Option<Trusted<'_>> {
        let rms = |cell: &Cell| cell.holdout.map_or(f64::INFINITY, |holdout| holdout.value);
        let compared = |cell: &&Cell| cell.holdout.is_some() && self.is_compared(&cell.method);
        let least = self.cells.iter().filter(compared).min_by(|a, b| rms(a).total_cmp(&rms(b)))?;
        let others = self.cells.iter().filter(compared).filter(|cell| cell.model == least.model && *cell != least).collect();
        let operators = no_worse(least, others, rms, |cell| &cell.held_out);
        let carried = |cell: &Cell| cell.across.map_or(f64::INFINITY, |across| across.value);
        let models = || self.cells.iter().filter(|cell| cell.method == least.method && cell.across.is_some());
        let farthest = models().min_by(|a, b| carried(a).total_cmp(&carried(b)))?;
        let models = no_worse(farthest, models().filter(|cell| *cell != farthest).collect(), carried, |cell| &cell.carried);
        let alike = models.iter().filter(|(_, p)| *p > ALPHA).map(|(cell, _)| *cell).chain([farthest]);
        let cell = alike.min_by(|a, b| a.parameters.cmp(&b.parameters).then(carried(a).total_cmp(&carried(b))))?;
        Some(Trusted { cell, least, farthest, operators, models })
    }

    /// Whether the operator measured enough to be compared.
    pub fn is_compared(&self, method: &str) -> bool {
        let found = self.methods.iter().find(|measured| &*measured.method == method);
        found.is_some_and(|measured| measured.found as f64 >= super::super::COMPARABLE * measured.of as f64)
    }
}

/// Holm's p-values of cells being no worse than the least one: t-tests of the paired differences of the logarithms of the views' RMS, one-sided.
fn no_worse<'a>(
    least: &Cell,
    mut others: Vec<&'a Cell>,
    rms: impl Fn(&Cell) -> f64,
    of: impl Fn(&Cell) -> &BTreeMap<Arc<str>, (f64, usize)>,
) -> Vec<(&'a Cell, f64)> {
    others.sort_by(|a, b| rms(a).total_cmp(&rms(b)));
    let growth = |cell: &&Cell| {
        let pair = |(view, (own, _)): (&Arc<str>, &(f64, usize))| {
            let (best, _) = of(least).get(view)?;
            (*own > 0.0 && *best > 0.0).then(|| (own / best).ln())
        };
        paired_t(&of(cell).iter().filter_map(pair).collect::<Vec<_>>()).growth
    };
    let p = holm(&others.iter().map(growth).collect::<Vec<_>>());
    others.into_iter().zip(p).collect()
}

impl Trusted<'_> {
    /// The factor by which the predicted sigmas must be enlarged: 1 where halves do not say that they are too small.
    pub fn inflation(&self) -> f64 {
        self.cell.split.filter(|split| split.p < HONEST).map_or(1.0, |split| split.modes.max(split.ratio()).max(1.0))
    }

    /// The models that cannot be told from the best one.
    pub fn equal_models(&self) -> impl Iterator<Item = &Cell> {
        self.models.iter().filter(|(_, p)| *p > ALPHA).map(|(cell, _)| *cell)
    }
}
