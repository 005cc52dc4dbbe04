//! Which operator and which model.

use std::collections::BTreeMap;
use std::sync::Arc;

use calibench_diagnostics::plain;

use super::models::{Standing, standings, trusted};
use super::{Cell, Summary};
use crate::statistics::holm;
use crate::statistics::paired::paired_t;

/// The chance (0 to 1) that any of the operators that are as good is called worse.
pub const ALPHA: f64 = 0.05;
/// Sigmas are called too small if chance explains the differences of halves in fewer cases than this (0 to 1).
pub const HONEST: f64 = 0.01;

/// The verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct Trusted<'a> {
    /// The operator and the model to be trusted.
    pub cell: &'a Cell,
    /// The same operator with the model with which operators are compared.
    pub least: &'a Cell,
    /// The other operators with that model: Holm's p-value of their being no worse; by hold-out RMS.
    pub operators: Vec<(&'a Cell, f64)>,
    /// Operators that measured enough and of which that model cannot be judged.
    pub unjudged: Vec<&'a Cell>,
    /// The models with the operator to be trusted, by what is lost with them.
    pub models: Vec<Standing<'a>>,
    /// Models that do not predict every photograph.
    pub left_out: Vec<&'a Cell>,
    /// Below which the error of the camera over the whole frame, RMS after the best rotation, is in 95 of 100 cases, px; `None` where its corners are not pictured.
    pub limit: Option<f64>,
    /// How well the camera must be known, px, as in [`Summary::limit_px`].
    pub limit_px: Option<f64>,
}

impl Summary {
    /// The operator with the least hold-out RMS, and the model with which least is lost. `None` if nothing could be judged.
    ///
    /// Operators are compared with the model that can be judged of most of them, of several the one that predicts best.
    pub fn trusted(&self) -> Option<Trusted<'_>> {
        let rms = |cell: &Cell| cell.holdout.map_or(f64::INFINITY, |holdout| holdout.value);
        let compared = || self.cells.iter().filter(|cell| self.is_compared(&cell.method));
        let judged = || compared().filter(|cell| cell.holdout.is_some());
        let by_most = |model: &Arc<str>| judged().filter(|cell| cell.model == *model).count();
        let most = self.models.iter().map(by_most).max()?;
        let least = judged().filter(|cell| by_most(&cell.model) == most).min_by(|a, b| rms(a).total_cmp(&rms(b)))?;
        let with = || compared().filter(|cell| cell.model == least.model && *cell != least);
        let operators = no_worse(least, with().filter(|cell| cell.holdout.is_some()).collect(), rms, |cell| &cell.held_out);
        let unjudged = with().filter(|cell| cell.holdout.is_none()).collect();
        let (models, left_out) = standings(self, &least.method, self.seed);
        let chosen = trusted(self, &models)?;
        let limit = chosen.cell.predicted.and_then(|predicted| predicted.limit(chosen.doubt?));
        Some(Trusted { cell: chosen.cell, least, operators, unjudged, models, left_out, limit, limit_px: self.limit_px })
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

    /// Why the verdict is in doubt, in words.
    pub fn doubt(&self) -> Option<String> {
        if self.cell.split.is_some_and(|split| split.p < HONEST) {
            return Some("halves of the photographs differ by more than its standard deviations say".into());
        }
        if self.board().is_some_and(|share| share.file_misfits()) {
            return Some("the board file does not fit: unseen corners are predicted better with nominal ones".into());
        }
        if self.limit.is_none() {
            return Some("its camera has no rays for parts of the frame".into());
        }
        let (known, limit) = (self.cell.predicted?.px(), self.limit_px?);
        (known > limit).then(|| {
            format!(
                "its camera is known to {} px over the frame (standard deviation, RMS), beyond the limit of {} px: photographs from other directions, tilted and with \
                 points near the borders, would tell more",
                plain(known),
                plain(limit)
            )
        })
    }

    /// The other models with which the predictions of some draws are best.
    pub fn rivals(&self) -> impl Iterator<Item = &Standing<'_>> {
        self.models.iter().filter(|standing| standing.cell != self.cell && standing.share > 0.0)
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

    /// t = mean / (deviation / sqrt(3)) of the logarithms of three ratios: 0.1 and 0.2, 2 and 1. With `b` three operators can be judged, with others fewer.
    #[test]
    fn operators_are_told_apart_by_paired_tests() {
        let summary = judged();
        let trusted = summary.trusted().unwrap();
        let name = |cell: &Cell| format!("{} {}", cell.method, cell.model);
        assert_eq!([trusted.least, trusted.cell].map(name), ["m b", "m b"]);
        let root = 3.0_f64.sqrt();
        assert_eq!(of(&trusted.operators), [("q", "b"), ("n", "b")], "by their RMS, without the one that measured 7 of 10");
        close(&trusted.operators, &[tail(0.5 * root), 2.0 * tail(2.0 * root)]);
        assert_eq!((trusted.unjudged.len(), trusted.left_out.len(), trusted.models.len()), (0, 0, 4));
    }

    #[test]
    fn operators_are_compared_with_the_model_that_can_be_judged_of_most() {
        // `a` predicts better in the hands of `n` than anything else, but of `q` it says nothing.
        let mut rows: Vec<Row> = ["m", "n", "q"].map(|method| corners(method, 9.0)).to_vec();
        rows.extend(camera("m", "b", 9, &[0.0; 5], &[]));
        rows.extend(camera("n", "a", 4, &[-9.0; 5], &[]));
        rows.extend(camera("n", "b", 9, &[1.0; 5], &[]));
        rows.push(Row::without(measure::RESIDUALS, "", "failed", "no start").by(&"q".into(), &"b".into()));
        let summary = Summary::new(&rows, 1);
        let trusted = summary.trusted().unwrap();
        assert_eq!((&*trusted.least.method, &*trusted.least.model), ("m", "b"));
        assert_eq!(
            trusted.unjudged.iter().map(|cell| (&*cell.method, cell.trouble.as_deref())).collect::<Vec<_>>(),
            [("q", Some("no start"))]
        );
    }

    #[test]
    fn a_verdict_is_in_doubt_where_halves_contradict_it_or_the_frame_is_not_pictured() {
        let summary = judged();
        let mut cell = summary.cell("m", "b").unwrap().clone();
        let doubt = |cell: &Cell, limit| Trusted { cell, limit, ..summary.trusted().unwrap() }.doubt();
        assert!(doubt(&cell, None).unwrap().contains("no rays") && doubt(&cell, Some(0.1)).is_none());
        for (p, expected) in [(0.009, true), (HONEST, false)] {
            cell.split = Some(Split { difference: 0.3, predicted: 0.2, modes: 1.5, p, count: 9 });
            assert_eq!(doubt(&cell, Some(0.1)).is_some(), expected);
        }
    }

    #[test]
    fn a_verdict_is_in_doubt_where_the_camera_is_hardly_known() {
        let summary = judged();
        let mut cell = summary.cell("m", "b").unwrap().clone();
        let doubt = |cell: &Cell, limit_px| Trusted { cell, limit: Some(0.1), limit_px, ..summary.trusted().unwrap() }.doubt();
        for (formal, by_views, expected) in [(4.9, Some(5.1), true), (5.1, Some(1.0), true), (5.1, None, true), (4.9, Some(4.9), false)] {
            cell.predicted = Some(super::super::Predicted { formal, by_views, modes: 2.0 });
            assert_eq!(doubt(&cell, Some(5.0)).is_some(), expected, "{formal} {by_views:?}");
            assert_eq!(doubt(&cell, None), None);
        }
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
