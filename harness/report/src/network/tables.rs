//! Tables of a calibrated scenario: every method, and the sets of parameters.

use calibench_records::results::Group;

use crate::field::plain;
use crate::load::adjustments::{Summaries, Summary};
use crate::markdown::{MarkdownTable, fixed};

/// Every method: reported standard deviations, true errors and their reduction factors.
pub fn methods(found: &Summaries) -> String {
    let parameters = found.scored();
    let mut header = vec!["method".to_owned(), "sigma0, px".to_owned(), "over the frame, px".to_owned()];
    header.extend(parameters.iter().map(|name| format!("error / sigma of {name}")));
    header.extend(["RF, reported", "RF, true errors", "RMSE_XY", "RMSE_Z", "RF of RMSE_XY", "RF of RMSE_Z", "failed"].map(str::to_owned));
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for method in &found.methods {
        let mut row = vec![
            format!("`{method}`"),
            mean(found.get(method, Group::Network, "sigma0"), 3),
            mean(found.get(method, Group::Frame, "rms"), 2),
        ];
        row.extend(parameters.iter().map(|name| found.get(method, Group::Iop, name).and_then(honesty).unwrap_or_default()));
        row.push(average(found, method, |summary| summary.sigma_ratio.mean().zip(summary.sigma_ratio.half())));
        row.push(average(found, method, |summary| summary.errors.ratio().and_then(|(ratio, half)| Some((ratio, half?)))));
        for name in ["rmse_xy", "rmse_z"] {
            row.push(mean(found.get(method, Group::Check, name), 6));
        }
        for name in ["rmse_xy", "rmse_z"] {
            let ratio = found.get(method, Group::Check, name).and_then(|summary| summary.values.ratio());
            row.push(ratio.map_or_else(String::new, |(ratio, half)| with_half(ratio, half, 2)));
        }
        let failed: u64 =
            found.failed.iter().filter(|((m, set, _), _)| m == method && found.sets.first() == Some(set)).map(|(_, (n, _))| n).sum();
        row.push(failed.to_string());
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
    format!(
        "Means of {trials} trials ± half their 95 % interval, set `{}`. *Over the frame*: distance of the estimated camera from the true one after the best rotation. *Error / sigma*: root mean square error over the mean \
         reported standard deviation, 1 if it is honest. *RF*: against `{}`, mean over the parameters. RMSE of check points against the truth, object units; their RF is the ratio of root mean squares.\n\n{}\n{failures}\n",
        found.sets.first().map_or("", String::as_str),
        found.methods.first().map_or("", String::as_str),
        rows.render()
    )
}

/// Root mean square error over mean reported sigma.
fn honesty(summary: &Summary) -> Option<String> {
    let (square, sigma) = (summary.square.mean()?, summary.sigma.mean()?);
    let ratio = square.sqrt() / sigma;
    let half = summary.square.half().map(|half| 0.5 * half / square * ratio);
    Some(with_half(ratio, half, 2))
}

fn average(found: &Summaries, method: &str, of: impl Fn(&Summary) -> Option<(f64, f64)>) -> String {
    let all: Option<Vec<(f64, f64)>> = found.scored().iter().map(|name| of(found.get(method, Group::Iop, name)?)).collect();
    let Some(all) = all.filter(|all| !all.is_empty()) else { return String::new() };
    let n = all.len() as f64;
    with_half(all.iter().map(|v| v.0).sum::<f64>() / n, Some(all.iter().map(|v| v.1).sum::<f64>() / n), 3)
}

fn mean(summary: Option<&Summary>, digits: usize) -> String {
    summary.and_then(|s| Some(with_half(s.value.mean()?, s.value.half(), digits))).unwrap_or_default()
}

pub(super) fn with_half(value: f64, half: Option<f64>, digits: usize) -> String {
    half.map_or_else(|| fixed(value, digits), |half| format!("{} ± {}", fixed(value, digits), fixed(half, digits)))
}

/// The sets of parameters, for the reference method and the last.
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
    let shown: Vec<&String> = found.methods.iter().take(3).collect();
    for set in &found.sets {
        for method in &shown {
            let c = found.of_set(method, set, Group::Iop, "c");
            let sigma0 = found.of_set(method, set, Group::Network, "sigma0");
            let um = |value: Option<f64>| value.map_or_else(String::new, |value| fixed(1e3 * value, 1));
            let failed: u64 = found.failed.iter().filter(|((m, s, _), _)| m == *method && s == set).map(|(_, (n, _))| n).sum();
            rows.row([
                format!("`{set}`"),
                format!("`{method}`"),
                mean(sigma0, 3),
                um(c.and_then(|c| c.sigma.mean())),
                um(c.and_then(|c| c.square.mean()).map(f64::sqrt)),
                weakest(found, method, set),
                failed.to_string(),
            ]);
        }
    }
    let lowest = |method: &String| {
        let sigma = |set: &&String| found.of_set(method, set, Group::Iop, "c").and_then(|c| c.first?.sigma);
        let best = found.sets.iter().filter_map(|set| Some((sigma(&set)?, set))).min_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, set)| format!("`{method}` chooses `{set}`"))
    };
    let chosen: Vec<String> = shown.iter().filter_map(|method| lowest(method)).collect();
    format!(
        "### Sets of interior parameters\n\nThe paper took, of seven sets that it does not name here, the one with the least variance of c. These seven are made of the parameters its program had. By that rule, in the first trial, {}. \
         The rule asks how well c is determined, not whether the model is right: beside it stand sigma0, whether the weakest parameter differs from zero (mean over the trials), and the true error of c.\n\n{}\n",
        chosen.join(", "),
        rows.render()
    )
}

/// The additional parameter with the least mean ratio of value and sigma; c, x0 and y0 are not asked for.
fn weakest(found: &Summaries, method: &str, set: &str) -> String {
    let of = |name: &str| {
        let summary = found.of_set(method, set, Group::Iop, name)?;
        Some((summary.value.mean()?.abs() / summary.sigma.mean()?, name.to_owned()))
    };
    let additional = Summaries::parameters(set).filter(|name| !["c", "x0", "y0"].contains(name));
    let found = additional.filter_map(of).min_by(|a, b| a.0.total_cmp(&b.0));
    found.map_or_else(|| "no additional parameter".to_owned(), |(ratio, name)| format!("{name}: {}", plain(ratio)))
}
