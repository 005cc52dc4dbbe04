//! A swept scenario in a report: the table of its cells, and its curves.

use super::curves::curves;
use super::layout::{Choice, Layout};
use super::metric::Metric;
use crate::canvas::Canvas;
use crate::load::sweep::LoadedSweep;
use crate::markdown::{MarkdownTable, fixed};

/// In what a run was not the scenario of the file.
pub fn deviations(loaded: &LoadedSweep) -> String {
    let most = loaded.cells.iter().map(|cell| cell.trials).max().unwrap_or(0);
    let mut found = Vec::new();
    if most != loaded.scenario.trials && most > 1 {
        found.push(format!("{most} trials in place of {}", loaded.scenario.trials));
    }
    if loaded.seed != loaded.scenario.seed {
        found.push(format!("seed {} in place of {}", loaded.seed, loaded.scenario.seed));
    }
    let has = |label: &str| loaded.methods.iter().any(|method| method.name == loaded.sweep.method(label));
    if loaded.scenario.methods.len() != loaded.methods.len() || !loaded.scenario.methods.iter().all(|label| has(label)) {
        found.push("other methods".to_owned());
    }
    if found.is_empty() { String::new() } else { format!("**Not the scenario as its file says: {}.**\n\n", found.join(", ")) }
}

/// The section's text, and its picture, which it calls `stem.png`.
pub fn section(loaded: &LoadedSweep, stem: &str) -> (String, Option<Canvas>) {
    if loaded.is_unavailable() {
        let why = loaded.methods.iter().find_map(|method| method.unavailable.clone()).unwrap_or_default();
        return (format!("**unavailable**: {why}.\n\n"), None);
    }
    if mostly_lost(loaded) {
        let why = "More than half of all measured points lie more than 1 px from the truth: the RMSE of the others would say little";
        return (format!("{why}. `calibench plot {} --y mean-x` draws the mean error of all.\n\n", loaded.name), None);
    }
    let mut text = table(loaded);
    for method in &loaded.methods {
        if let Some(why) = &method.unavailable {
            text.push_str(&format!("- `{}` is unavailable: {why}.\n", method.name));
        }
    }
    text.push('\n');
    // The first two keys are drawn, the others held at their first values.
    let at = loaded.sweep.axes.iter().skip(2).map(|axis| (axis.path.clone(), axis.values[0].text.clone())).collect();
    let layout = Layout::new(loaded, &Choice { at, ..Choice::default() }, Metric::Rmse, false);
    let picture = layout.ok().map(|layout| curves(loaded, &layout));
    if picture.is_some() {
        let x = &loaded.sweep.axes[0].path;
        text.push_str(&format!("RMSE over `{x}`, bars at 95 %:\n\n![RMSE over {x} by method]({stem}.png)\n\n"));
    }
    (text, picture)
}

fn mostly_lost(loaded: &LoadedSweep) -> bool {
    let cells = (0..loaded.cells.len()).flat_map(|cell| (0..loaded.methods.len()).map(move |method| (cell, method)));
    let counts = cells.filter_map(|(cell, method)| loaded.score(cell, method)).map(|score| (score.measured, score.lost));
    let (kept, lost) = counts.fold((0, 0), |sum, (kept, lost)| (sum.0 + kept, sum.1 + lost));
    lost > kept
}

/// RMSE by cell and method, with its standard error and the share of points that were lost or rejected.
fn table(loaded: &LoadedSweep) -> String {
    let shown: Vec<usize> = (0..loaded.methods.len()).filter(|&method| loaded.methods[method].unavailable.is_none()).collect();
    let axes = loaded.sweep.axes.iter().map(|axis| format!("`{}`", axis.name));
    let header: Vec<String> = axes.chain(shown.iter().map(|&method| format!("`{}`", loaded.methods[method].name))).collect();
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for cell in 0..loaded.cells.len() {
        let values = loaded.sweep.values(cell).into_iter().map(|value| value.text.clone());
        rows.row(values.chain(shown.iter().map(|&method| figure(loaded, cell, method))).collect::<Vec<_>>());
    }
    let trials = loaded.cells.iter().map(|cell| cell.trials).max().unwrap_or(0);
    format!(
        "{}\nRMSE `sqrt(mean(dx^2 + dy^2))` in px, \u{b1} its standard error from the scatter between the {trials} trials of a cell (seed {}), over points measured \
         within 1 px of the truth; in brackets the share of points that were lost or rejected. `calibench plot {}` draws other figures. \
         The gate does not compare sweeps.\n\n",
        rows.render(),
        loaded.seed,
        loaded.name
    )
}

fn figure(loaded: &LoadedSweep, cell: usize, method: usize) -> String {
    let Some(score) = loaded.score(cell, method) else { return "none".into() };
    let rmse = match (score.kept.rmse(), score.kept.square.standard_error()) {
        (Some(rmse), Some(error)) if rmse > 0.0 => format!("{} \u{b1} {}", fixed(rmse, 4), fixed(error / (2.0 * rmse), 4)),
        (Some(rmse), _) => fixed(rmse, 4),
        _ => "none".into(),
    };
    let failed = score.points() - score.measured;
    if failed == 0 { rmse } else { format!("{rmse} ({:.1} %)", 100.0 * failed as f64 / score.points() as f64) }
}
