//! Which camera model: by the expected loss of its predictions.

use std::collections::BTreeMap;
use std::sync::Arc;

use calibench_random::{Key, Purpose, stream};
use rand::RngExt;

use super::{Cell, Summary};

/// Photographs drawn again.
const DRAWS: u64 = 2000;
/// A model that predicts best in fewer draws (0 to 1) is not chosen for lying between others.
const LEAST_SHARE: f64 = 0.1;
/// Cameras that differ by no more over the whole frame (RMS after the best rotation, px) are taken for one, and the simplest model for both.
pub const MARGIN_PX: f64 = 0.02;

/// A model beside the others, in the hands of the same operator.
#[derive(Clone, Debug, PartialEq)]
pub struct Standing<'a> {
    /// Its camera.
    pub cell: &'a Cell,
    /// How often it predicts best when photographs are drawn again, 0 to 1.
    pub share: f64,
    /// How far its camera is expected to be from the one that predicts best: RMS over the frame and the draws, px. `None` where cameras cannot be compared.
    pub loss: Option<f64>,
    /// The same where parameters are not allowed for: how far a richer model might be right, px.
    pub doubt: Option<f64>,
}

/// The models of an operator that predict every photograph that any of them predicts, by what is lost with them, and those that do not.
///
/// Photographs are drawn again with replacement; in each draw that model is best whose mean squared prediction of photographs that it has not seen, times
/// `exp(p ln(n) / n)` for p parameters and n coordinates, is least: Schwarz's allowance for what a parameter gains by chance.
///
/// Source: Schwarz 1978; the loss after the weighting of models by predictions drawn again of Yao, Vehtari, Simpson & Gelman 2018.
pub(super) fn standings<'a>(summary: &'a Summary, method: &str, seed: u64) -> (Vec<Standing<'a>>, Vec<&'a Cell>) {
    let cells: Vec<&Cell> = summary.cells.iter().filter(|cell| &*cell.method == method).collect();
    let views: BTreeMap<&Arc<str>, usize> = cells.iter().flat_map(|cell| &cell.held_out).map(|(view, (_, count))| (view, *count)).collect();
    let (compared, left_out): (Vec<&Cell>, Vec<&Cell>) =
        cells.into_iter().partition(|cell| !cell.held_out.is_empty() && cell.held_out.len() == views.len());
    let shares = shares(&compared, seed);
    let loss = |cell: &Cell, of: fn(&Share) -> f64| {
        let apart = |other: &Cell| {
            if other.model == cell.model { Some(0.0) } else { Some(summary.beside(method, [&cell.model, &other.model])?.frame) }
        };
        let drawn = compared.iter().zip(&shares).filter(|(_, share)| of(share) > 0.0);
        drawn.map(|(other, share)| Some(of(share) * apart(other)?.powi(2))).sum::<Option<f64>>().map(f64::sqrt)
    };
    let standing = |(cell, share): (&&'a Cell, &Share)| {
        let (loss, doubt) = (loss(cell, |share| share.allowed), loss(cell, |share| share.plain));
        Standing { cell, share: share.allowed, loss, doubt }
    };
    let mut found: Vec<Standing<'a>> = compared.iter().zip(&shares).map(standing).collect();
    found.sort_by(|a, b| far(a).total_cmp(&far(b)).then(b.share.total_cmp(&a.share)));
    (found, left_out)
}

fn far(standing: &Standing<'_>) -> f64 {
    standing.loss.unwrap_or(f64::INFINITY)
}

/// How often a camera predicts best, 0 to 1.
#[derive(Clone, Copy, Debug, Default)]
struct Share {
    /// Parameters allowed for.
    allowed: f64,
    /// As predicted.
    plain: f64,
}

/// How often each of some cameras predicts best.
fn shares(cells: &[&Cell], seed: u64) -> Vec<Share> {
    let Some(first) = cells.first() else { return Vec::new() };
    let views: Vec<&Arc<str>> = first.held_out.keys().collect();
    let squares = |cell: &Cell| -> Vec<(f64, f64)> {
        views
            .iter()
            .map(|view| cell.held_out.get(*view).map_or((0.0, 0.0), |(rms, count)| (rms * rms * *count as f64, *count as f64)))
            .collect()
    };
    let squares: Vec<Vec<(f64, f64)>> = cells.iter().map(|cell| squares(cell)).collect();
    let allowance = |cell: &Cell| {
        // Each of its corners is predicted once.
        let n = 2.0 * cell.held_out.values().map(|(_, count)| *count as f64).sum::<f64>();
        (cell.parameters as f64 * n.ln() / n).exp()
    };
    let allowances: Vec<f64> = cells.iter().map(|cell| allowance(cell)).collect();
    let mut rng = stream(Key { seed, of: "models by views", trial: 0, view: "", target: "" }, Purpose::Split);
    let mut found = vec![Share::default(); cells.len()];
    for _ in 0..DRAWS {
        let drawn: Vec<usize> = (0..views.len()).map(|_| rng.random_range(0..views.len())).collect();
        let mean = |model: usize| {
            let (sum, count) = drawn.iter().map(|&view| squares[model][view]).fold((0.0, 0.0), |(s, n), (square, k)| (s + square, n + k));
            sum / count
        };
        let means: Vec<f64> = (0..cells.len()).map(mean).collect();
        let best = |loss: &dyn Fn(usize) -> f64| {
            (0..cells.len()).min_by(|&a, &b| loss(a).total_cmp(&loss(b)).then(cells[a].parameters.cmp(&cells[b].parameters)))
        };
        best(&|model| allowances[model] * means[model]).into_iter().for_each(|best| found[best].allowed += 1.0 / DRAWS as f64);
        best(&|model| means[model]).into_iter().for_each(|best| found[best].plain += 1.0 / DRAWS as f64);
    }
    found
}

/// The model to trust: of those that predict best often enough the one with which least is lost, or a simpler one whose camera is the same within
/// [`MARGIN_PX`].
pub(super) fn trusted<'a>(summary: &Summary, standings: &[Standing<'a>]) -> Option<Standing<'a>> {
    let often = |standing: &&Standing<'_>| standing.share >= LEAST_SHARE;
    let most = || standings.iter().max_by(|a, b| a.share.total_cmp(&b.share));
    let least = standings.iter().find(often).filter(|found| found.loss.is_some()).or_else(most)?;
    let is_same = |other: &&Standing<'_>| {
        let apart = summary.beside(&least.cell.method, [&least.cell.model, &other.cell.model]);
        other.cell.model == least.cell.model || apart.is_some_and(|apart| apart.frame <= MARGIN_PX)
    };
    standings.iter().filter(is_same).min_by_key(|standing| standing.cell.parameters).cloned()
}

#[cfg(test)]
mod tests {
    use super::super::super::{Row, measure};
    use super::*;

    /// A model of an operator: its parameters and its RMS in two views, px, of 50 corners each.
    fn model(name: &str, parameters: u8, rms: &[f64]) -> Vec<Row> {
        let mut rows = vec![Row::plain(measure::PARAMETERS, "", f64::from(parameters))];
        rows.extend(rms.iter().zip(1..).map(|(rms, view)| Row::px(measure::HOLDOUT, &format!("v{view}"), *rms).of(50)));
        rows.into_iter().map(|row| row.by(&"m".into(), &name.into())).collect()
    }

    fn beside(one: &str, other: &str, frame: f64) -> Row {
        Row::px(measure::BESIDE, other, frame).beside(2.0 * frame).by(&"m".into(), &one.into())
    }

    fn summary(rows: &[Vec<Row>]) -> Summary {
        Summary::new(&rows.concat(), 7)
    }

    /// Of two views drawn twice, `a` is best where the first is drawn twice: in a quarter of the draws.
    #[test]
    fn what_is_lost_is_the_distance_from_the_best_model_of_each_draw() {
        let with_distance = [model("a", 9, &[0.1, 0.3]), vec![beside("a", "b", 0.5)]].concat();
        let summary = summary(&[with_distance, model("b", 9, &[0.2, 0.2])]);
        let (found, left_out) = standings(&summary, "m", 7);
        assert_eq!(found.iter().map(|standing| &*standing.cell.model).collect::<Vec<_>>(), ["b", "a"]);
        assert!((found[0].share - 0.75).abs() < 0.04 && (found[0].share + found[1].share - 1.0).abs() < 1e-12, "{found:?}");
        for (own, other) in [(0, 1), (1, 0)] {
            let expected = 0.5 * found[other].share.sqrt();
            assert!((found[own].loss.unwrap() - expected).abs() < 1e-12, "{found:?}");
            assert_eq!(found[own].doubt, found[own].loss, "of as many parameters nothing is to be allowed for");
        }
        assert!(left_out.is_empty() && &*trusted(&summary, &found).unwrap().cell.model == "b");
    }

    /// 200 coordinates: four parameters more must gain exp(4 ln 200 / 200) = 1.1118 in the mean square.
    #[test]
    fn a_parameter_must_pay_for_itself() {
        for (gain, best) in [(1.10_f64, "a"), (1.12, "b")] {
            let a = [model("a", 5, &[0.1, 0.1]), vec![beside("a", "b", 0.5)]].concat();
            let summary = summary(&[a, model("b", 9, &[0.1 / gain.sqrt(), 0.1 / gain.sqrt()])]);
            let (found, _) = standings(&summary, "m", 7);
            assert!(&*found[0].cell.model == best && (found[0].share - 1.0).abs() < 1e-9, "{gain}: {found:?}");
            let simple = found.iter().find(|standing| &*standing.cell.model == "a").unwrap();
            assert!((simple.doubt.unwrap() - 0.5).abs() < 1e-9, "without allowance the richer one is best: {found:?}");
        }
    }

    #[test]
    fn what_lies_between_is_not_chosen_and_what_is_simpler_and_the_same_is() {
        let all = |near: f64| {
            let a = [model("a", 9, &[0.1, 0.3]), vec![beside("a", "b", 0.5), beside("a", "c", 0.1), beside("a", "d", 0.5)]].concat();
            let b = [model("b", 9, &[0.2, 0.2]), vec![beside("b", "c", 0.1), beside("b", "d", near)]].concat();
            summary(&[a, b, model("c", 9, &[0.9, 0.9]), model("d", 4, &[0.5, 0.5])])
        };
        for (near, expected) in [(0.021, "b"), (MARGIN_PX, "d")] {
            let summary = all(near);
            let (found, _) = standings(&summary, "m", 7);
            assert_eq!(&*found[0].cell.model, "c", "nearest to both, and never the best");
            assert_eq!(&*trusted(&summary, &found).unwrap().cell.model, expected);
        }
    }

    #[test]
    fn a_model_that_does_not_predict_every_photograph_is_left_out() {
        let mut failed = model("b", 9, &[0.01]);
        failed.push(Row::without(measure::HOLDOUT, "v2", "failed", "no pose").by(&"m".into(), &"b".into()));
        let summary = summary(&[model("a", 4, &[0.2, 0.2]), failed]);
        let (found, left_out) = standings(&summary, "m", 7);
        assert_eq!((found.len(), &*found[0].cell.model, found[0].loss, found[0].doubt), (1, "a", Some(0.0), Some(0.0)));
        assert_eq!(left_out.iter().map(|cell| cell.trouble.as_deref()).collect::<Vec<_>>(), [Some("no pose")]);
        let nothing = Summary::new(&[], 7);
        assert!(trusted(&nothing, &standings(&nothing, "m", 7).0).is_none());
    }
}
