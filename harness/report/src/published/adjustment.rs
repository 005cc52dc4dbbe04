//! Our figures of adjustments behind a printed cell.

use calibench_records::results::Group;

use super::figure::Ours;
use super::{Cell, Metric};
use crate::load::adjustments::{Summaries, Summary};

/// Our figure for `cell`; `default` is the table's method, `pitch_um` that of the camera.
pub fn ours(found: &Summaries, cell: &Cell, default: &str, pitch_um: f64) -> Option<Ours> {
    let method = cell.method.as_deref().unwrap_or(default);
    let of = cell.of.as_deref().unwrap_or("c");
    let reference = found.methods.first()?;
    let iop = |name: &str| found.get(method, Group::Iop, name);
    let check = |name: &str| Some((found.get(method, Group::Check, name)?, found.get(method, Group::Check, "distance")?.value.mean()?));
    match cell.metric {
        Metric::IopValue => Ours::of(iop(of)?.first.map(|n| n.value), &iop(of)?.value),
        Metric::IopSigma => sigma(iop(of)?),
        Metric::IopSigmaPx => Some(sigma(iop(of)?)?.scaled(1e3 / pitch_um)),
        Metric::SigmaRatio => {
            let (own, other) = (iop(of)?, found.get(reference, Group::Iop, of)?);
            let one = own.first?.sigma? / other.first?.sigma?;
            Some(Ours { truth: own.errors.ratio(), ..Ours::of(Some(one), &own.sigma_ratio)? })
        }
        Metric::MeanSigmaRatio => mean_ratio(found, method, reference),
        Metric::RelativeXy | Metric::RelativeZ => {
            let (rmse, distance) = check(name_of(cell.metric))?;
            let ours = Ours::of(rmse.first.map(|n| n.value), &rmse.value)?;
            Some(ours.scaled(1.0 / distance))
        }
        Metric::RelativeXyRatio | Metric::RelativeZRatio => {
            let name = name_of(cell.metric);
            let (own, other) = (found.get(method, Group::Check, name)?, found.get(reference, Group::Check, name)?);
            let one = own.first?.value / other.first?.value;
            let against_truth = found.get(method, Group::Check, name.trim_end_matches("_survey"));
            Some(Ours { truth: against_truth.and_then(|s| s.values.ratio()), ..Ours::of(Some(one), &own.value_ratio)? })
        }
        Metric::Figure => figure(found, [method, cell.set.as_deref()?, cell.of.as_deref()?], cell),
        Metric::FigureRatio => {
            let over = cell.over.as_ref()?;
            let (set, name) = (cell.set.as_deref()?, cell.of.as_deref()?);
            let below = [over.method.as_deref().unwrap_or(method), over.set.as_deref().unwrap_or(set), over.of.as_deref().unwrap_or(name)];
            Some(figure(found, [method, set, name], cell)?.over(&figure(found, below, cell)?))
        }
        _ => None,
    }
}

/// A figure by method, set and name, in the group of `cell`.
fn figure(found: &Summaries, [method, set, name]: [&str; 3], cell: &Cell) -> Option<Ours> {
    let group = match &cell.group {
        Some(wanted) => Group::ALL.iter().find(|(_, name)| name == wanted)?.0,
        None => Group::Network,
    };
    let summary = found.of_set(method, set, group, name)?;
    Some(Ours::of(summary.first.map(|numbers| numbers.value), &summary.value)?.scaled(cell.times.unwrap_or(1.0)))
}

/// The paper's check coordinates are surveyed ones.
fn name_of(metric: Metric) -> &'static str {
    if matches!(metric, Metric::RelativeXy | Metric::RelativeXyRatio) { "rmse_xy_survey" } else { "rmse_z_survey" }
}

fn sigma(summary: &Summary) -> Option<Ours> {
    let error = summary.square.mean().map(f64::sqrt);
    let truth = error.map(|rms| (rms, summary.square.half().map(|half| 0.5 * half / rms)));
    Some(Ours { truth, ..Ours::of(summary.first?.sigma, &summary.sigma)? })
}

/// The mean over the scored parameters. They move together from trial to trial, so the scatter is taken as that of one of them; the interval likewise.
fn mean_ratio(found: &Summaries, method: &str, reference: &str) -> Option<Ours> {
    let names = found.scored();
    let all: Vec<Ours> = names
        .iter()
        .filter_map(|name| {
            let (own, other) = (found.get(method, Group::Iop, name)?, found.get(reference, Group::Iop, name)?);
            let one = own.first?.sigma? / other.first?.sigma?;
            Some(Ours { truth: own.errors.ratio(), ..Ours::of(Some(one), &own.sigma_ratio)? })
        })
        .collect();
    let count = all.len() as f64;
    let mean = |of: &dyn Fn(&Ours) -> Option<f64>| Some(all.iter().map(of).sum::<Option<f64>>()? / count);
    if all.is_empty() {
        return None;
    }
    let truth = mean(&|o| Some(o.truth?.0)).map(|value| (value, mean(&|o| o.truth?.1)));
    Some(Ours {
        one: mean(&|o| Some(o.one))?,
        mean: mean(&|o| Some(o.mean))?,
        half: mean(&|o| o.half),
        scatter: mean(&|o| o.scatter),
        truth,
    })
}

#[cfg(test)]
mod tests {
    use calibench_records::adjustments::Numbers;

    use super::*;

    /// Two trials of sigma0 of `small` (2, 4) and `large` (1, 2) by `lsm`, of `large` (3, 3) by `centroid`; a height of another group.
    fn summaries() -> Summaries {
        let mut found = Summaries { methods: vec!["lsm".into(), "centroid".into()], trials: 2, ..Summaries::default() };
        let mut add = |method: &str, set: &str, group: Group, values: [f64; 2]| {
            let numbers = values.map(|value| Numbers { value, sigma: None, error: None });
            let mut summary = Summary { first: Some(numbers[0]), ..Summary::default() };
            values.into_iter().for_each(|value| summary.value.add(value));
            found.figures.insert((method.into(), set.into(), group, "sigma0".into()), summary);
        };
        add("lsm", "small", Group::Network, [2.0, 4.0]);
        add("lsm", "large", Group::Network, [1.0, 2.0]);
        add("centroid", "large", Group::Network, [3.0, 3.0]);
        add("lsm", "small", Group::Object, [70.0, 90.0]);
        found
    }

    /// First trial and mean behind a cell with `keys`, by `lsm` unless they say otherwise.
    fn of(keys: &str) -> Option<(f64, f64)> {
        let text = format!("row = \"a\"\ncolumn = \"b\"\nprinted = \"1\"\nof = \"sigma0\"\n{keys}");
        let cell: Cell = toml::from_str(&text).unwrap();
        ours(&summaries(), &cell, "lsm", 27.0).map(|ours| (ours.one, ours.mean))
    }

    #[test]
    fn a_figure_is_that_of_its_set_group_and_method() {
        let object = Group::ALL.iter().find(|(group, _)| *group == Group::Object).unwrap().1;
        assert_eq!(of("metric = \"figure\"\nset = \"small\""), Some((2.0, 3.0)));
        assert_eq!(of("metric = \"figure\"\nset = \"large\"\ntimes = 10"), Some((10.0, 15.0)));
        assert_eq!(of("metric = \"figure\"\nset = \"large\"\nmethod = \"centroid\""), Some((3.0, 3.0)));
        assert_eq!(of(&format!("metric = \"figure\"\nset = \"small\"\ngroup = \"{object}\"")), Some((70.0, 80.0)));
    }

    #[test]
    fn a_ratio_is_over_what_it_names_and_has_the_rest_in_common() {
        assert_eq!(of("metric = \"figure_ratio\"\nset = \"small\"\nover = { set = \"large\" }"), Some((2.0, 2.0)));
        let methods = "metric = \"figure_ratio\"\nset = \"large\"\nmethod = \"centroid\"\nover = { method = \"lsm\" }";
        assert_eq!(of(methods), Some((3.0, 2.0)));
    }

    #[test]
    fn what_is_missing_has_no_figure() {
        for keys in [
            "metric = \"figure\"\nset = \"absent\"",
            "metric = \"figure\"\nset = \"small\"\nmethod = \"centroid\"",
            "metric = \"figure_ratio\"\nset = \"small\"\nover = { set = \"absent\" }",
            "metric = \"figure_ratio\"\nset = \"small\"\nover = { method = \"centroid\" }",
        ] {
            assert_eq!(of(keys), None, "{keys}");
        }
    }
}
