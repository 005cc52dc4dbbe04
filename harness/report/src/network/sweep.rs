//! A sweep of a calibrated scenario: how the reduction factor depends on what is swept.

use calibench_records::results::Group;
use rayon::prelude::*;

use super::pictures::floor::{Curve, floor};
use super::sweep_orientation;
use crate::LoadError;
use crate::canvas::Pictures;
use crate::load::adjustments::{Summaries, Summary, load_cell};
use crate::markdown::{MarkdownTable, fixed, with_half};
use crate::sweep::LoadedSweep;

/// What the paper prints in its Table 3, to be seen beside the curves.
type Printed = [(String, f64)];

/// The text of a swept scenario with adjustments and its picture; `None` for one without.
///
/// # Errors
/// Records that cannot be read.
pub fn section(loaded: &LoadedSweep, stem: &str, printed: &Printed) -> Result<Option<(String, Pictures)>, LoadError> {
    if loaded.scenario.adjusted().is_none() {
        return Ok(None);
    }
    let mut cells = Vec::new();
    let read: Vec<_> =
        (0..loaded.cells.len()).into_par_iter().map(|index| load_cell(&loaded.folder, (&loaded.name, &loaded.sweep, index))).collect();
    for (index, found) in read.into_iter().enumerate() {
        if let Some(found) = found? {
            cells.push((loaded.sweep.values(index)[0].clone(), found));
        }
    }
    let Some((_, first)) = cells.first() else { return Ok(None) };
    let axis = loaded.sweep.axes[0].name.clone();
    let mut header = vec![format!("`{axis}`"), "sigma0 of pixel, px".to_owned()];
    let methods: Vec<String> = first.methods.iter().skip(1).cloned().collect();
    for method in &methods {
        header.extend([format!("`{method}`, reported"), format!("`{method}`, true errors")]);
    }
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    let mut curves: Vec<Curve> = methods
        .iter()
        .flat_map(|method| {
            ["reported standard deviations", "true errors"].map(|what| Curve {
                method: method.clone(),
                name: format!("{method}, {what}"),
                points: Vec::new(),
            })
        })
        .collect();
    for (value, found) in &cells {
        let sigma0 = found.methods.first().and_then(|m| found.get(m, Group::Network, "sigma0")?.value.mean());
        let mut row = vec![value.text.clone(), sigma0.map_or_else(String::new, |s| fixed(s, 3))];
        for (i, method) in methods.iter().enumerate() {
            for (k, factor) in [reported(found, method), truth(found, method)].into_iter().enumerate() {
                row.push(factor.map_or_else(String::new, |(ratio, half)| with_half(ratio, Some(half), 3)));
                if let (Some((ratio, half)), Some(x)) = (factor, value.number) {
                    curves[2 * i + k].points.push((x, ratio, half));
                }
            }
        }
        rows.row(row);
    }
    let picture = floor(&curves, &format!("{axis}: standard deviation per axis of the common error, px"), printed);
    let caption = "The reduction factor over the noise floor";
    let file = format!("{stem}.png");
    let with_names: Vec<(String, &Summaries)> = cells.iter().map(|(value, found)| (value.text.clone(), found)).collect();
    let mut text = sweep_orientation::table(&axis, &with_names);
    if !methods.is_empty() {
        text.push_str(&format!(
            "Reduction factors against `{}`, mean over the parameters of `{}`, ± half their 95 % interval over {} trials.\n\n{}\n",
            first.methods.first().map_or("", String::as_str),
            first.sets.first().map_or("", String::as_str),
            first.trials,
            rows.render()
        ));
    }
    if picture.is_some() {
        text.push_str(&format!("![{caption}]({file})\n\n"));
    }
    Ok(Some((text, picture.map(|picture| (file, picture)).into_iter().collect())))
}

fn averaged(found: &Summaries, method: &str, of: impl Fn(&Summary) -> Option<(f64, f64)>) -> Option<(f64, f64)> {
    let all: Vec<(f64, f64)> = found.scored().iter().map(|name| of(found.get(method, Group::Iop, name)?)).collect::<Option<_>>()?;
    let n = all.len() as f64;
    (n > 0.0).then(|| (all.iter().map(|v| v.0).sum::<f64>() / n, all.iter().map(|v| v.1).sum::<f64>() / n))
}

fn reported(found: &Summaries, method: &str) -> Option<(f64, f64)> {
    averaged(found, method, |summary| Some((summary.sigma_ratio.mean()?, summary.sigma_ratio.half().unwrap_or(0.0))))
}

fn truth(found: &Summaries, method: &str) -> Option<(f64, f64)> {
    averaged(found, method, |summary| {
        let (ratio, half) = summary.errors.ratio()?;
        Some((ratio, half.unwrap_or(0.0)))
    })
}
