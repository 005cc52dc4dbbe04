//! Our figures of adjustments behind a printed cell.

use calibench_records::figures::{FigureName, Group, Quantity};

use super::figure::Ours;
use super::{Cell, Metric};
use crate::load::adjustments::{Summaries, Summary};

/// Our figure for `cell`; `default` is the table's method, `pitch_um` that of the camera.
pub fn ours(found: &Summaries, cell: &Cell, default: &str, pitch_um: f64) -> Option<Ours> {
    let method = cell.method.as_deref().unwrap_or(default);
    let of = cell.of.as_deref().unwrap_or("c");
    let reference = found.methods.first()?;
    let iop = |name: &str| found.parameter(method, name);
    let check = |error: Quantity| Some((found.get(method, error)?, found.get(method, Quantity::Distance)?.value.mean()?));
    match cell.metric {
        Metric::IopValue => Ours::of(iop(of)?.first.map(|n| n.value), &iop(of)?.value),
        Metric::IopSigma => sigma(iop(of)?),
        Metric::IopSigmaPx => Some(sigma(iop(of)?)?.scaled(1e3 / pitch_um)),
        Metric::SigmaRatio => {
            let (own, other) = (iop(of)?, found.parameter(reference, of)?);
            let one = own.first?.sigma? / other.first?.sigma?;
            Some(Ours { truth: own.errors.ratio(), ..Ours::of(Some(one), &own.sigma_ratio)? })
        }
        Metric::MeanSigmaRatio => mean_ratio(found, method, reference),
        Metric::RelativeXy | Metric::RelativeZ => {
            let (rmse, distance) = check(surveyed(cell.metric)[0])?;
            let ours = Ours::of(rmse.first.map(|n| n.value), &rmse.value)?;
            Some(ours.scaled(1.0 / distance))
        }
        Metric::RelativeXyRatio | Metric::RelativeZRatio => {
            let [survey, truth] = surveyed(cell.metric);
            let (own, other) = (found.get(method, survey)?, found.get(reference, survey)?);
            let one = own.first?.value / other.first?.value;
            let against_truth = found.get(method, truth);
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

/// The figure called `name` in the group of `cell`.
fn figure_of(cell: &Cell, name: &str) -> Result<FigureName, String> {
    let group = match &cell.group {
        Some(wanted) => Group::named(wanted).ok_or_else(|| {
            let known: Vec<String> = Group::ALL.iter().map(|(_, name)| format!("`{name}`")).collect();
            format!("`{wanted}` is no group of figures: expected {}", known.join(", "))
        })?,
        None => Group::Network,
    };
    FigureName::parse(group, name).map_err(|unknown| unknown.to_string())
}

/// What is wrong with the figures that `cell` names: such as no adjustment has.
pub fn unknown(cell: &Cell) -> Option<String> {
    let names = match cell.metric {
        Metric::Figure => vec![cell.of.as_deref()],
        Metric::FigureRatio => vec![cell.of.as_deref(), cell.over.as_ref().and_then(|over| over.of.as_deref())],
        _ => return None,
    };
    names.into_iter().flatten().find_map(|name| figure_of(cell, name).err())
}

/// A figure by method, set and name, in the group of `cell`.
fn figure(found: &Summaries, [method, set, name]: [&str; 3], cell: &Cell) -> Option<Ours> {
    let summary = found.of_set(method, set, figure_of(cell, name).ok()?)?;
    Some(Ours::of(summary.first.map(|numbers| numbers.value), &summary.value)?.scaled(cell.times.unwrap_or(1.0)))
}

/// The paper's check coordinates are surveyed ones: the error against these, and that against the truth.
const fn surveyed(metric: Metric) -> [Quantity; 2] {
    if matches!(metric, Metric::RelativeXy | Metric::RelativeXyRatio) {
        [Quantity::RmseXySurvey, Quantity::RmseXy]
    } else {
        [Quantity::RmseZSurvey, Quantity::RmseZ]
    }
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
            let (own, other) = (found.parameter(method, name)?, found.parameter(reference, name)?);
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
            let figure = if group == Group::Object { Quantity::ObjectZ.of(&["left"]) } else { Quantity::Sigma0.into() };
            found.figures.insert((method.into(), set.into(), figure), summary);
        };
        add("lsm", "small", Group::Network, [2.0, 4.0]);
        add("lsm", "large", Group::Network, [1.0, 2.0]);
        add("centroid", "large", Group::Network, [3.0, 3.0]);
        add("lsm", "small", Group::Object, [70.0, 90.0]);
        found
    }

    /// First trial and mean behind a cell with `keys`, by `lsm` unless they say otherwise.
    fn of(keys: &str) -> Option<(f64, f64)> {
        let text = format!("row = \"a\"\ncolumn = \"b\"\nprinted = \"1\"\n{keys}");
        let text = if keys.contains("of = ") { text } else { text + "\nof = \"sigma0\"" };
        let cell: Cell = toml::from_str(&text).unwrap();
        ours(&summaries(), &cell, "lsm", 27.0).map(|ours| (ours.one, ours.mean))
    }

    #[test]
    fn a_figure_is_that_of_its_set_group_and_method() {
        let object = Group::ALL.iter().find(|(group, _)| *group == Group::Object).unwrap().1;
        assert_eq!(of("metric = \"figure\"\nset = \"small\""), Some((2.0, 3.0)));
        assert_eq!(of("metric = \"figure\"\nset = \"large\"\ntimes = 10"), Some((10.0, 15.0)));
        assert_eq!(of("metric = \"figure\"\nset = \"large\"\nmethod = \"centroid\""), Some((3.0, 3.0)));
        assert_eq!(of(&format!("metric = \"figure\"\nset = \"small\"\nof = \"left/Z\"\ngroup = \"{object}\"")), Some((70.0, 80.0)));
    }

    #[test]
    fn a_ratio_is_over_what_it_names_and_has_the_rest_in_common() {
        assert_eq!(of("metric = \"figure_ratio\"\nset = \"small\"\nover = { set = \"large\" }"), Some((2.0, 2.0)));
        let methods = "metric = \"figure_ratio\"\nset = \"large\"\nmethod = \"centroid\"\nover = { method = \"lsm\" }";
        assert_eq!(of(methods), Some((3.0, 2.0)));
    }

    #[test]
    fn a_figure_that_no_adjustment_has_is_a_mistake() {
        let said = |keys: &str| unknown(&toml::from_str(&format!("row = \"a\"\ncolumn = \"b\"\nprinted = \"1\"\n{keys}")).unwrap());
        assert_eq!(said("metric = \"figure\"\nof = \"sigma0\""), None);
        assert_eq!(said("metric = \"iop_value\"\nof = \"any\""), None);
        let near = Some("no figure of `network` is called `sigma 0`: is `sigma0` meant?");
        assert_eq!(said("metric = \"figure\"\nof = \"sigma 0\"").as_deref(), near);
        assert_eq!(said("metric = \"figure_ratio\"\nof = \"sigma0\"\nover = { of = \"sigma 0\" }").as_deref(), near);
        let group = said("metric = \"figure\"\nof = \"rmse_xy\"\ngroup = \"chek\"").unwrap();
        assert!(group.contains("`chek` is no group of figures: expected `iop`, `eop`"), "{group}");
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
