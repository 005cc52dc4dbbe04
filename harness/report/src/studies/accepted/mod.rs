//! How often networks keep what they must, by what is swept.

mod picture;
#[cfg(test)]
mod tests;

use calibench_records::description::{Classes, TestLengths};
use calibench_records::figures::Quantity;

use crate::LoadError;
use crate::load::adjustments::{Summaries, load_cell};
use crate::markdown::{MarkdownTable, fixed};
use crate::studies::shown::{OnPage, Shown};
use crate::sweep::{Estimate, LoadedSweep, share, titled};
use picture::{Curve, picture};

/// What lengths must keep, in a sentence.
pub fn of_lengths(told: &TestLengths, unit: &str) -> String {
    let [constant, rate] = told.limit;
    let [constant, rate] =
        [(constant, format!("{constant}")), (rate, format!("{rate} L"))].map(|(value, text)| Some(text).filter(|_| value > 0.0));
    let limit = [constant, rate].into_iter().flatten().collect::<Vec<_>>().join(" + ");
    let most = told.most.map_or_else(String::new, |most| format!(", at most {most},"));
    let reference = if told.sigma > 0.0 { format!("calibrated to {} {unit}", told.sigma) } else { "taken as exact".to_owned() };
    format!(
        "Every network is tested by {} lengths on {} lines, {reference}, against the limit {limit}{most} {unit} (after VDI/VDE 2634-1 and ISO 14253-1, as `calibench accept` decides it).",
        told.count, told.lines
    )
}

/// What check points must keep, in a sentence.
pub fn of_classes(told: Classes, unit: &str) -> String {
    let classes = [("horizontal", told.horizontal), ("vertical", told.vertical), ("3D", told.spatial)];
    let asked: Vec<String> = classes.into_iter().filter_map(|(what, class)| Some(format!("{what} {} {unit}", class?))).collect();
    format!(
        "The check points of every network are held against the class {}, the survey's error included (after ASPRS 2023, as `calibench accept` decides it; of fewer than 30 nothing is decided).",
        asked.join(", ")
    )
}

/// How many of all trials end so, of a method.
fn ended(found: &Summaries, method: &str, quantity: Quantity) -> Option<Estimate> {
    let value = &found.get(method, quantity)?.value;
    let count = (value.mean()? * value.count as f64).round() as u64;
    share(count, value.count + not_adjusted(found, method))
}

/// Of a method: trials that could not be adjusted, which keep nothing.
fn not_adjusted(found: &Summaries, method: &str) -> u64 {
    found.failed.iter().filter(|((other, ..), _)| other == method).map(|(_, (count, _))| *count).max().unwrap_or(0)
}

const HEADER: [&str; 9] =
    ["method", "trials", "pass, %", "95 % from", "to", "fail, %", "cannot tell, %", "not adjusted", "largest error / limit"];

const MEANING: &str = "*Pass*: the share of all trials whose errors keep their limits with the reference's uncertainty, with its interval after Wilson; a trial that \
     could not be adjusted does not pass. *Largest error / limit*: mean over trials, of lengths.\n\n";

fn cells(found: &Summaries, method: &str) -> Option<Vec<String>> {
    let percent = |quantity: Quantity| ended(found, method, quantity).map_or_else(String::new, |share| fixed(share.value, 1));
    let pass = ended(found, method, Quantity::AcceptancePass)?;
    let (low, high) = pass.interval?;
    let trials = found.get(method, Quantity::AcceptancePass)?.value.count + not_adjusted(found, method);
    let largest = found.get(method, Quantity::LargestOverLimit).and_then(|summary| summary.value.mean());
    Some(vec![
        format!("`{method}`"),
        trials.to_string(),
        fixed(pass.value, 1),
        fixed(low, 1),
        fixed(high, 1),
        percent(Quantity::AcceptanceFail),
        percent(Quantity::AcceptanceCannotTell),
        not_adjusted(found, method).to_string(),
        largest.map_or_else(String::new, |value| fixed(value, 2)),
    ])
}

/// The table of a scenario without a sweep; nothing where nothing is to be kept.
pub fn table(found: &Summaries) -> Option<String> {
    let mut rows = MarkdownTable::new(&HEADER);
    let all: Vec<Vec<String>> = found.methods.iter().filter_map(|method| cells(found, method)).collect();
    if all.is_empty() {
        return None;
    }
    all.into_iter().for_each(|row| rows.row(row));
    Some(format!("{}\n{MEANING}", rows.render()))
}

/// In how many of a hundred trials the best method passes, for the page's first screen.
pub fn answer(found: &Summaries) -> Option<String> {
    let passes = found.methods.iter().filter_map(|method| Some((method, ended(found, method, Quantity::AcceptancePass)?)));
    let (method, share) = passes.max_by(|a, b| a.1.value.total_cmp(&b.1.value))?;
    let (low, high) = share.interval?;
    Some(format!(
        "{} of 100 networks ({} to {}) keep their limits, measured with `{method}`.",
        fixed(share.value, 0),
        fixed(low, 0),
        fixed(high, 0)
    ))
}

/// The section of a sweep; `None` where nothing is to be kept.
///
/// # Errors
/// Records that cannot be read.
pub fn sweep(loaded: &LoadedSweep, OnPage { stem, .. }: OnPage<'_>, introduction: &str) -> Result<Option<Shown>, LoadError> {
    let axes: Vec<String> = loaded.sweep.axes.iter().map(|axis| format!("`{}`", axis.name)).collect();
    let header: Vec<&str> = axes.iter().map(String::as_str).chain(HEADER).collect();
    let mut rows = MarkdownTable::new(&header);
    let mut curves: Vec<Curve> = Vec::new();
    let mut any = false;
    for cell in 0..loaded.cells.len() {
        let Some(found) = load_cell(&loaded.folder, (&loaded.name, &loaded.sweep, cell))? else { continue };
        let values = loaded.sweep.values(cell);
        for method in &found.methods {
            let Some(row) = cells(&found, method) else { continue };
            any = true;
            rows.row(values.iter().map(|value| value.text.clone()).chain(row).collect::<Vec<_>>());
            let (Some(x), Some(share)) = (values[0].number, ended(&found, method, Quantity::AcceptancePass)) else { continue };
            let others: Vec<&str> = values[1..].iter().map(|value| value.text.as_str()).collect();
            let name = std::iter::once(method.as_str()).chain(others).collect::<Vec<_>>().join(", ");
            match curves.iter_mut().find(|curve| curve.name == name) {
                Some(curve) => curve.points.push((x, share)),
                None => curves.push(Curve { method: method.clone(), name, points: vec![(x, share)] }),
            }
        }
    }
    if !any {
        return Ok(None);
    }
    let mut text = format!("{introduction}\n\n{}\n{MEANING}", rows.render());
    let drawn = picture(&curves, &titled(&loaded.sweep.axes[0])).map(|picture| (format!("{stem}.png"), picture));
    if drawn.is_some() {
        text.push_str(&format!(
            "![How many networks of a hundred keep their limits, over `{}`]({stem}.png)\n\n",
            loaded.sweep.axes[0].name
        ));
    }
    Ok(Some(Shown { text, pictures: drawn.into_iter().collect(), ..Shown::default() }))
}
