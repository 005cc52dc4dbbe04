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

#[cfg(test)]
mod tests {
    use super::super::super::{Row, measure};
    use super::super::Split;
    use super::*;

    /// The upper tail of Student's distribution with two degrees of freedom, in closed form.
    fn tail(t: f64) -> f64 {
        0.5 - t / (2.0 * (2.0 + t * t).sqrt())
    }

    fn corners(method: &str, found: f64) -> Row {
        Row::plain(measure::CORNERS, "v1", found).beside(1.0).of(10).by(&method.into(), &"".into())
    }

    /// One camera: its parameters, its RMS by view held out and from side to side as logarithms of tenths of a pixel.
    fn camera(method: &str, model: &str, parameters: u8, held_out: &[f64], across: &[f64]) -> Vec<Row> {
        let mut rows = vec![Row::plain(measure::PARAMETERS, "", f64::from(parameters))];
        for (name, logs) in [(measure::HOLDOUT, held_out), (measure::ACROSS, across)] {
            rows.extend(logs.iter().zip(1..).map(|(log, view)| Row::px(name, &format!("v{view}"), 0.1 * log.exp()).of(10)));
        }
        rows.into_iter().map(|row| row.by(&method.into(), &model.into())).collect()
    }

    const ZERO: f64 = f64::NEG_INFINITY;

    /// The fourth view is exact in the hands of the best camera, the fifth in those of the others: their logarithms say nothing.
    fn judged() -> Summary {
        let mut rows: Vec<Row> = [("m", 9.0), ("n", 8.0), ("q", 10.0), ("o", 7.0)].map(|(method, found)| corners(method, found)).to_vec();
        rows.extend(camera("m", "a", 4, &[0.7; 5], &[1.0, 1.1, 0.9]));
        rows.extend(camera("m", "b", 9, &[0.0, 0.0, 0.0, ZERO, 0.0], &[0.1, 0.3, -0.1]));
        rows.extend(camera("m", "c", 12, &[0.8; 5], &[0.0; 3]));
        rows.extend(camera("m", "d", 9, &[0.9; 5], &[0.2, 0.4, 0.0]));
        rows.extend(camera("n", "a", 4, &[2.0; 5], &[-1.0; 3]));
        rows.extend(camera("n", "b", 9, &[1.0, 2.0, 3.0, 1.6, ZERO, 1.6], &[-1.0; 3]));
        rows.extend(camera("q", "b", 9, &[0.1, 0.3, -0.1, 1.6, ZERO], &[]));
        rows.extend(camera("o", "b", 9, &[-3.0; 5], &[-3.0; 3]));
        Summary::new(&rows, 1)
    }

    fn of<'a>(found: &[(&'a Cell, f64)]) -> Vec<(&'a str, &'a str)> {
        found.iter().map(|(cell, _)| (&*cell.method, &*cell.model)).collect()
    }

    fn close(found: &[(&Cell, f64)], expected: &[f64]) {
        assert_eq!(found.len(), expected.len());
        for ((_, p), expected) in found.iter().zip(expected) {
            assert!((p - expected).abs() < 1e-9, "{p} is not {expected}");
        }
    }

    /// t = mean / (deviation / sqrt(3)) of the logarithms of three ratios: 2 and 1, 0.1 and 0.2, 0.2 and 0.2, 1 and 0.1.
    #[test]
    fn operators_and_models_are_told_apart_by_paired_tests() {
        let summary = judged();
        let trusted = summary.trusted().unwrap();
        let name = |cell: &Cell| format!("{} {}", cell.method, cell.model);
        assert_eq!([trusted.least, trusted.farthest, trusted.cell].map(name), ["m b", "m c", "m b"]);
        let root = 3.0_f64.sqrt();
        assert_eq!(of(&trusted.operators), [("q", "b"), ("n", "b")], "by their RMS, without the one that measured 7 of 10");
        close(&trusted.operators, &[tail(0.5 * root), 2.0 * tail(2.0 * root)]);
        assert_eq!(of(&trusted.models), [("m", "b"), ("m", "d"), ("m", "a")]);
        close(&trusted.models, &[tail(0.5 * root).max(2.0 * tail(root)), 2.0 * tail(root), 3.0 * tail(10.0 * root)]);
        assert_eq!(trusted.equal_models().map(|cell| &*cell.model).collect::<Vec<_>>(), ["b", "d"]);
    }

    #[test]
    fn a_model_at_the_level_of_the_test_is_not_as_good() {
        let summary = judged();
        let mut trusted = summary.trusted().unwrap();
        for (model, p) in trusted.models.iter_mut().zip([0.06, ALPHA, 0.04]) {
            model.1 = p;
        }
        assert_eq!(trusted.equal_models().map(|cell| &*cell.model).collect::<Vec<_>>(), ["b"]);
    }

    #[test]
    fn four_corners_in_five_are_enough_to_be_compared() {
        let summary = judged();
        assert_eq!(["m", "n", "q", "o", "x"].map(|method| summary.is_compared(method)), [true, true, true, false, false]);
        let nothing = Summary::new(&[corners("m", 9.0)], 1);
        assert_eq!(nothing.trusted(), None);
        let few: Vec<Row> = [vec![corners("o", 7.0)], camera("o", "b", 9, &[0.0; 3], &[0.0; 3])].concat();
        assert_eq!(Summary::new(&few, 1).trusted(), None);
    }

    #[test]
    fn sigmas_are_enlarged_by_the_larger_of_two_ratios_where_halves_say_so() {
        let summary = judged();
        let mut cell = summary.cell("m", "b").unwrap().clone();
        assert_eq!(Trusted { cell: &cell, ..summary.trusted().unwrap() }.inflation(), 1.0, "no halves");
        for (p, modes, difference, expected) in
            [(0.001, 1.5, 0.5, 2.5), (0.001, 3.0, 0.5, 3.0), (0.001, 0.5, 0.1, 1.0), (HONEST, 3.0, 0.5, 1.0), (0.5, 3.0, 0.5, 1.0)]
        {
            cell.split = Some(Split { difference, predicted: 0.2, modes, p, count: 9 });
            let found = Trusted { cell: &cell, ..summary.trusted().unwrap() }.inflation();
            assert!((found - expected).abs() < 1e-12, "{found} is not {expected}");
        }
    }
}
