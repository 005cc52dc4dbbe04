//! Our figures of adjustments behind a printed cell.

use std::collections::{BTreeMap, BTreeSet};

use calibench_records::adjustments::Numbers;
use calibench_records::figures::{FigureName, Group, Quantity};

use super::figure::Ours;
use super::trials::{Trials, ratio};
use super::{Cell, Metric, Table};
use crate::load::adjustments::{FigureKey, Summaries, Summary};
use crate::load::{LoadError, Loaded};

/// Our figures for all cells of `table`, from the adjustments `found` of the run `main`.
///
/// # Errors
/// Records that cannot be read.
pub fn of_all_cells(table: &Table, main: &Loaded, found: &Summaries) -> Result<Vec<Option<Ours>>, LoadError> {
    let pitch = main.scenario.adjusted().map_or(f64::NAN, |(_, told)| told.pitch_um);
    let wanted: BTreeSet<FigureKey> = table.cells.iter().flat_map(|cell| Asked::new(found, cell, &table.method).keys()).collect();
    let trials = Trials::of_folder(&main.folder, &main.name, Some(&wanted))?;
    Ok(table.cells.iter().map(|cell| ours(found, &trials, cell, &table.method, pitch)).collect())
}

/// Our figure for `cell`; `default` is the table's method, `pitch_um` that of the camera.
pub fn ours(found: &Summaries, trials: &Trials, cell: &Cell, default: &str, pitch_um: f64) -> Option<Ours> {
    let asked = Asked::new(found, cell, default);
    let value = |key: Option<FigureKey>| Some(trials.of(&key?, |numbers| Some(numbers.value)));
    let sigma = |key: Option<FigureKey>| Some(trials.of(&key?, |numbers| numbers.sigma));
    let scaled = |figures: Option<BTreeMap<u64, f64>>, factor: f64| {
        Some(figures?.into_iter().map(|(trial, figure)| (trial, figure * factor)).collect::<BTreeMap<u64, f64>>())
    };
    let over = |[above, below]: [Option<BTreeMap<u64, f64>>; 2]| Some(ratio(&above?, &below?));
    let name = cell.of.as_deref().unwrap_or("c");
    let figures: BTreeMap<u64, f64> = match cell.metric {
        Metric::IopValue => value(asked.parameter(asked.method, name))?,
        Metric::IopSigma => sigma(asked.parameter(asked.method, name))?,
        Metric::IopSigmaPx => scaled(sigma(asked.parameter(asked.method, name)), 1e3 / pitch_um)?,
        Metric::SigmaRatio => over([asked.method, asked.reference?].map(|method| sigma(asked.parameter(method, name))))?,
        Metric::MeanSigmaRatio => asked.mean_sigma_ratio(trials)?,
        Metric::RelativeXy | Metric::RelativeZ => {
            let distance = found.get(asked.method, Quantity::Distance)?.value.mean()?;
            scaled(value(asked.surveyed(asked.method)), 1.0 / distance)?
        }
        Metric::RelativeXyRatio | Metric::RelativeZRatio => {
            over([asked.method, asked.reference?].map(|method| value(asked.surveyed(method))))?
        }
        Metric::Figure => scaled(value(asked.figure()), cell.times.unwrap_or(1.0))?,
        Metric::FigureRatio => over([value(asked.figure()), value(asked.divisor())])?,
        _ => return None,
    };
    Some(Ours { truth: asked.truth(pitch_um), ..Ours::of(&figures.into_values().collect::<Vec<_>>())? })
}

/// What a cell asks of some adjustments.
struct Asked<'a> {
    found: &'a Summaries,
    cell: &'a Cell,
    method: &'a str,
    /// The method that ratios are over.
    reference: Option<&'a str>,
}

impl<'a> Asked<'a> {
    fn new(found: &'a Summaries, cell: &'a Cell, default: &'a str) -> Self {
        let method = cell.method.as_deref().unwrap_or(default);
        Self { found, cell, method, reference: found.methods.first().map(String::as_str) }
    }

    /// Every figure that it may need.
    fn keys(&self) -> Vec<FigureKey> {
        let methods = || std::iter::once(self.method).chain(self.reference);
        let name = self.cell.of.as_deref().unwrap_or("c");
        match self.cell.metric {
            Metric::IopValue | Metric::IopSigma | Metric::IopSigmaPx | Metric::SigmaRatio => {
                methods().filter_map(|method| self.parameter(method, name)).collect()
            }
            Metric::MeanSigmaRatio => {
                let names = self.found.scored();
                methods().flat_map(|method| names.iter().filter_map(move |name| self.parameter(method, name))).collect()
            }
            Metric::RelativeXy | Metric::RelativeZ | Metric::RelativeXyRatio | Metric::RelativeZRatio => {
                methods().filter_map(|method| self.surveyed(method)).collect()
            }
            Metric::Figure => self.figure().into_iter().collect(),
            Metric::FigureRatio => self.figure().into_iter().chain(self.divisor()).collect(),
            _ => Vec::new(),
        }
    }

    fn parameter(&self, method: &str, name: &str) -> Option<FigureKey> {
        Some((method.to_owned(), self.found.sets.first()?.clone(), Quantity::Parameter.of(&[name])))
    }

    /// The paper's check coordinates are surveyed ones: the error against these.
    fn surveyed(&self, method: &str) -> Option<FigureKey> {
        Some((method.to_owned(), self.found.sets.first()?.clone(), surveyed(self.cell.metric)[0].into()))
    }

    fn figure(&self) -> Option<FigureKey> {
        let name = figure_of(self.cell, self.cell.of.as_deref()?).ok()?;
        Some((self.method.to_owned(), self.cell.set.clone()?, name))
    }

    /// What a `figure_ratio` is divided by; what is not given is that of the cell.
    fn divisor(&self) -> Option<FigureKey> {
        let over = self.cell.over.as_ref()?;
        let name = figure_of(self.cell, over.of.as_deref().or(self.cell.of.as_deref())?).ok()?;
        Some((over.method.as_deref().unwrap_or(self.method).to_owned(), over.set.clone().or_else(|| self.cell.set.clone())?, name))
    }

    /// The mean over the scored parameters, trial by trial.
    fn mean_sigma_ratio(&self, trials: &Trials) -> Option<BTreeMap<u64, f64>> {
        let sigma = |method: &str, name: &str| Some(trials.of(&self.parameter(method, name)?, |numbers: &Numbers| numbers.sigma));
        let names = self.found.scored();
        let all: Vec<BTreeMap<u64, f64>> = names
            .iter()
            .filter_map(|name| Some(ratio(&sigma(self.method, name)?, &sigma(self.reference?, name)?)))
            .filter(|r| !r.is_empty())
            .collect();
        let (first, rest) = all.split_first()?;
        let mean = |(trial, value): (&u64, &f64)| {
            let others = rest.iter().map(|ratios| ratios.get(trial).copied()).sum::<Option<f64>>()?;
            Some((*trial, (value + others) / all.len() as f64))
        };
        Some(first.iter().filter_map(mean).collect())
    }

    /// The same figure of true errors, with half its 95 % interval, where it makes sense.
    fn truth(&self, pitch_um: f64) -> Option<(f64, Option<f64>)> {
        let own = |name: &str| self.found.parameter(self.method, name);
        let name = self.cell.of.as_deref().unwrap_or("c");
        match self.cell.metric {
            Metric::IopSigma => rms(own(name)?),
            Metric::IopSigmaPx => rms(own(name)?).map(|(rms, half)| (rms * 1e3 / pitch_um, half.map(|half| half * 1e3 / pitch_um))),
            Metric::SigmaRatio => own(name)?.errors.ratio(),
            Metric::MeanSigmaRatio => {
                let ratios =
                    self.found.scored().iter().filter_map(|name| own(name)).map(|own| own.errors.ratio()).collect::<Option<Vec<_>>>()?;
                let count = ratios.len() as f64;
                // They move together from trial to trial: the interval is taken as that of one of them.
                let half = ratios.iter().map(|ratio| ratio.1).sum::<Option<f64>>().map(|half| half / count);
                (count > 0.0).then(|| (ratios.iter().map(|ratio| ratio.0).sum::<f64>() / count, half))
            }
            Metric::RelativeXyRatio | Metric::RelativeZRatio => self.found.get(self.method, surveyed(self.cell.metric)[1])?.values.ratio(),
            _ => None,
        }
    }
}

/// The root mean square of true errors with half its 95 % interval.
fn rms(summary: &Summary) -> Option<(f64, Option<f64>)> {
    let rms = summary.square.mean()?.sqrt();
    Some((rms, summary.square.half().map(|half| 0.5 * half / rms)))
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

/// The paper's check coordinates are surveyed ones: the error against these, and that against the truth.
const fn surveyed(metric: Metric) -> [Quantity; 2] {
    if matches!(metric, Metric::RelativeXy | Metric::RelativeXyRatio) {
        [Quantity::RmseXySurvey, Quantity::RmseXy]
    } else {
        [Quantity::RmseZSurvey, Quantity::RmseZ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two trials of sigma0 of `small` (2, 4) and `large` (1, 2) by `lsm`, of `large` (3, 3) by `centroid`; a height of another group.
    fn summaries() -> (Summaries, Trials) {
        let mut trials = Trials::default();
        let mut found = Summaries { methods: vec!["lsm".into(), "centroid".into()], trials: 2, ..Summaries::default() };
        let mut add = |method: &str, set: &str, group: Group, values: [f64; 2]| {
            let figure = if group == Group::Object { Quantity::ObjectZ.of(&["left"]) } else { Quantity::Sigma0.into() };
            let key: FigureKey = (method.into(), set.into(), figure);
            for (trial, value) in (0..).zip(values) {
                trials.add(key.clone(), trial, Numbers { value, sigma: None, error: None });
            }
            found.figures.insert(key, Summary::default());
        };
        add("lsm", "small", Group::Network, [2.0, 4.0]);
        add("lsm", "large", Group::Network, [1.0, 2.0]);
        add("centroid", "large", Group::Network, [3.0, 3.0]);
        add("lsm", "small", Group::Object, [70.0, 90.0]);
        (found, trials)
    }

    /// First trial and mean behind a cell with `keys`, by `lsm` unless they say otherwise.
    fn of(keys: &str) -> Option<(f64, f64)> {
        let text = format!("row = \"a\"\ncolumn = \"b\"\nprinted = \"1\"\n{keys}");
        let text = if keys.contains("of = ") { text } else { text + "\nof = \"sigma0\"" };
        let cell: Cell = toml::from_str(&text).unwrap();
        let (found, trials) = summaries();
        ours(&found, &trials, &cell, "lsm", 27.0).map(|ours| (ours.one, ours.mean))
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
    fn a_ratio_is_over_what_it_names_trial_by_trial_and_has_the_rest_in_common() {
        assert_eq!(of("metric = \"figure_ratio\"\nset = \"small\"\nover = { set = \"large\" }"), Some((2.0, 2.0)));
        let methods = "metric = \"figure_ratio\"\nset = \"large\"\nmethod = \"centroid\"\nover = { method = \"lsm\" }";
        assert_eq!(of(methods), Some((3.0, 2.25)));
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
