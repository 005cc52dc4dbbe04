//! Tables of a calibrated scenario: every method, and the sets of parameters.

use calibench_records::description::is_limited;
use calibench_records::figures::Quantity;

use crate::load::adjustments::{Summaries, Summary};
use crate::markdown::plain;
use crate::markdown::{MarkdownTable, fixed, with_half};

/// What is to be known where methods measure different targets.
const KINDS: &str = "Methods with `kinds` adjust targets of these kinds alone: their figures, reduction factors too, tell of fewer points as well as of the operator.\n\n";

/// Every method: reported standard deviations, true errors and their reduction factors.
pub fn methods(found: &Summaries) -> String {
    let parameters = found.scored();
    let mut header = vec!["method".to_owned(), "sigma0, px".to_owned(), "over the frame, px".to_owned()];
    header.extend(parameters.iter().map(|name| format!("error / sigma of {name}")));
    header.extend(["RF, reported", "RF, true errors", "RMSE_XY", "RMSE_Z", "RF of RMSE_XY", "RF of RMSE_Z", "failed"].map(str::to_owned));
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for method in &found.methods {
        let mut row =
            vec![format!("`{method}`"), mean(found.get(method, Quantity::Sigma0), 3), mean(found.get(method, Quantity::OverFrame), 2)];
        row.extend(parameters.iter().map(|name| found.parameter(method, name).and_then(honesty).unwrap_or_default()));
        row.push(average(found, method, |summary| summary.sigma_ratio.mean().zip(summary.sigma_ratio.half())));
        row.push(average(found, method, |summary| summary.errors.ratio().and_then(|(ratio, half)| Some((ratio, half?)))));
        let errors = [Quantity::RmseXy, Quantity::RmseZ];
        row.extend(errors.map(|error| mean(found.get(method, error), 6)));
        for error in errors {
            let ratio = found.get(method, error).and_then(|summary| summary.values.ratio());
            row.push(ratio.map_or_else(String::new, |(ratio, half)| with_half(ratio, half, 2)));
        }
        row.push(found.failures(method, found.sets.first().map(String::as_str)).to_string());
        rows.row(row);
    }
    let trials = found.trials;
    let failures: String = found
        .failed
        .iter()
        .filter(|((_, set, _), _)| found.sets.first() == Some(set))
        .map(|((method, _, group), (count, why))| {
            format!("- `{method}`, {}: {count} of {trials} failed, the first because {why}.\n", group.name())
        })
        .collect();
    let left_out: String = found.methods.iter().filter_map(|method| left_out(found, method)).collect();
    let kinds = if found.methods.iter().any(|label| is_limited(label)) { KINDS } else { "" };
    format!(
        "{kinds}Means of {trials} trials ± half their 95 % interval, set `{}`. *Over the frame*: distance of the estimated camera from the true one after the best rotation. *Error / sigma*: root mean square error over the mean \
         reported standard deviation, 1 if it is honest. *RF*: against `{}`, mean over the parameters. RMSE of check points against the truth, object units; their RF is the ratio of root mean squares.\n\n{}\n{failures}{left_out}\n",
        found.sets.first().map_or("", String::as_str),
        found.methods.first().map_or("", String::as_str),
        rows.render()
    )
}

/// What is said of a method in whose images too few points were measured.
fn left_out(found: &Summaries, method: &str) -> Option<String> {
    let images = found.left_out(method);
    (images > 0.0).then(|| {
        format!("- `{method}`: {} images a trial were left out, in which it measured fewer points than a pose takes.\n", fixed(images, 1))
    })
}

/// Root mean square error over mean reported sigma.
fn honesty(summary: &Summary) -> Option<String> {
    let (square, sigma) = (summary.square.mean()?, summary.sigma.mean()?);
    let ratio = square.sqrt() / sigma;
    let half = summary.square.half().map(|half| 0.5 * half / square * ratio);
    Some(with_half(ratio, half, 2))
}

fn average(found: &Summaries, method: &str, of: impl Fn(&Summary) -> Option<(f64, f64)>) -> String {
    let all: Option<Vec<(f64, f64)>> = found.scored().iter().map(|name| of(found.parameter(method, name)?)).collect();
    let Some(all) = all.filter(|all| !all.is_empty()) else { return String::new() };
    let n = all.len() as f64;
    with_half(all.iter().map(|v| v.0).sum::<f64>() / n, Some(all.iter().map(|v| v.1).sum::<f64>() / n), 3)
}

pub(super) fn mean(summary: Option<&Summary>, digits: usize) -> String {
    summary.and_then(|s| Some(with_half(s.value.mean()?, s.value.half(), digits))).unwrap_or_default()
}

/// The sets of parameters, of every method.
pub fn sets(found: &Summaries) -> String {
    let mut rows = MarkdownTable::new(&[
        "set",
        "method",
        "sigma0, px",
        "sigma of c, um",
        "true error of c, um",
        "the weakest parameter: |value| / sigma",
        "failed",
    ]);
    for set in &found.sets {
        for method in &found.methods {
            let c = found.of_set(method, set, Quantity::Parameter.of(&["c"]));
            let sigma0 = found.of_set(method, set, Quantity::Sigma0);
            let um = |value: Option<f64>| value.map_or_else(String::new, |value| fixed(1e3 * value, 1));
            rows.row([
                format!("`{set}`"),
                format!("`{method}`"),
                mean(sigma0, 3),
                um(c.and_then(|c| c.sigma.mean())),
                um(c.and_then(|c| c.square.mean()).map(f64::sqrt)),
                weakest(found, method, set),
                found.failures(method, Some(set)).to_string(),
            ]);
        }
    }
    let lowest = |method: &String| {
        let sigma = |set: &&String| found.of_set(method, set, Quantity::Parameter.of(&["c"])).and_then(|c| c.first?.sigma);
        let best = found.sets.iter().filter_map(|set| Some((sigma(&set)?, set))).min_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, set)| format!("`{method}` chooses `{set}`"))
    };
    let chosen: Vec<String> = found.methods.iter().filter_map(lowest).collect();
    format!(
        "### Sets of interior parameters\n\nBy the least variance of c, in the first trial, {}. \
         That rule asks how well c is determined, not whether the model is right: beside it stand sigma0, whether the weakest parameter differs from zero (mean over the trials), and the true error of c.\n\n{}\n",
        chosen.join(", "),
        rows.render()
    )
}

/// The additional parameter with the least mean ratio of value and sigma; c, x0 and y0 are not asked for.
fn weakest(found: &Summaries, method: &str, set: &str) -> String {
    let of = |name: &str| {
        let summary = found.of_set(method, set, Quantity::Parameter.of(&[name]))?;
        Some((summary.value.mean()?.abs() / summary.sigma.mean()?, name.to_owned()))
    };
    let additional = Summaries::parameters(set).filter(|name| !["c", "x0", "y0"].contains(name));
    let found = additional.filter_map(of).min_by(|a, b| a.0.total_cmp(&b.0));
    found.map_or_else(|| "no additional parameter".to_owned(), |(ratio, name)| format!("{name}: {}", plain(ratio)))
}

#[cfg(test)]
mod tests {
    use calibench_records::figures::Group;

    use super::*;
    use crate::load::adjustments::FigureKey;
    use crate::tests::small::row;

    fn figure(method: &str, set: &str, name: &str, trials: &[(f64, f64, f64)]) -> (FigureKey, Summary) {
        let mut summary = Summary::default();
        for (value, sigma, error) in trials {
            summary.value.add(*value);
            summary.sigma.add(*sigma);
            summary.square.add(error * error);
        }
        ((method.to_owned(), set.to_owned(), Quantity::Parameter.of(&[name])), summary)
    }

    const FULL: &str = "c,x0,k1,k2";

    fn summaries() -> Summaries {
        let failed = |method: &str, set: &str, group, count| ((method.to_owned(), set.to_owned(), group), (count, "no start".to_owned()));
        Summaries {
            methods: vec!["pixel".into(), "good".into()],
            sets: vec![FULL.into(), "c".into()],
            trials: 9,
            figures: [
                figure("pixel", FULL, "c", &[(16.0, 0.025, 0.003), (16.0, 0.05, 0.004)]),
                figure("pixel", FULL, "x0", &[(0.001, 1.0, 0.0)]),
                figure("pixel", FULL, "k1", &[(-3.0, 1.0, 0.0), (-5.0, 3.0, 0.0)]),
                figure("pixel", FULL, "k2", &[(6.0, 2.0, 0.0)]),
            ]
            .into(),
            failed: [
                failed("pixel", FULL, Group::Network, 2),
                failed("pixel", FULL, Group::Check, 3),
                failed("pixel", "c", Group::Network, 4),
                failed("good", FULL, Group::Network, 6),
            ]
            .into(),
            ..Summaries::default()
        }
    }

    /// c: sigmas 25 and 50 um, errors 3 and 4 um. k1 is -4 over 2, k2 6 over 2; c and x0 are not asked for.
    #[test]
    fn the_weakest_parameter_is_the_one_nearest_to_nothing() {
        let found = summaries();
        let text = sets(&found);
        let full = format!("`{FULL}`");
        assert_eq!(row(&text, &[&full, "`pixel`"])[3..], ["37.5", "3.5", "k1: 2.00", "5"]);
        assert_eq!(row(&text, &["`c`", "`pixel`"])[3..], ["", "", "no additional parameter", "4"]);
        assert_eq!(row(&text, &[&full, "`good`"])[3..], ["", "", "no additional parameter", "6"]);
        assert_eq!(row(&text, &["`c`", "`good`"])[6], "0");
    }

    #[test]
    fn failures_are_counted_in_the_set_that_is_scored() {
        let text = methods(&summaries());
        assert_eq!(row(&text, &["`pixel`"]).last().unwrap(), "5");
        assert_eq!(row(&text, &["`good`"]).last().unwrap(), "6");
        let listed: Vec<&str> = text.lines().filter(|line| line.starts_with("- ")).collect();
        assert_eq!(listed.len(), 3, "{listed:?}");
        assert!(listed.contains(&"- `pixel`, check: 3 of 9 failed, the first because no start."), "{listed:?}");
    }

    /// Squares 9 and 16: mean 12.5, half 3.5 t; sigma 2.5: the ratio is sqrt(12.5) / 2.5, its half interval 3.5 t / (2 * 12.5) of it.
    #[test]
    fn errors_over_sigmas_have_half_the_relative_interval_of_their_squares() {
        let (_, summary) = figure("m", "c", "c", &[(1.0, 2.0, 3.0), (1.0, 3.0, 4.0)]);
        let ratio = 12.5_f64.sqrt() / 2.5;
        assert_eq!(honesty(&summary), Some(format!("{ratio:.2} ± {:.2}", 3.5 * 12.706_204_736 / 25.0 * ratio)));
        assert_eq!(honesty(&Summary::default()), None);
        assert_eq!((with_half(1.0, None, 1), mean(None, 2)), ("1.0".into(), String::new()));
    }

    #[test]
    fn a_factor_is_the_mean_over_all_parameters_or_nothing() {
        let mut found = summaries();
        found.sets = vec!["k1,k2".into()];
        for (name, value) in [("k1", 1.0), ("k2", 4.0)] {
            found.figures.extend([figure("pixel", "k1,k2", name, &[(value, 3.0, 0.0)])]);
        }
        let of = |summary: &Summary| Some((summary.value.mean()?, 2.0 * summary.value.mean()?));
        assert_eq!(average(&found, "pixel", of), "2.500 ± 5.000");
        assert_eq!(average(&found, "good", of), "");
        assert_eq!(average(&Summaries::default(), "pixel", of), "");
    }
}
