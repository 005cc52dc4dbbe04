//! The page of what stands in the window beside the target.

use super::Parts;
use super::load::{Part, WRONG};
use crate::markdown::{MarkdownTable, contents};
use crate::plain;
use crate::sweep::Metric;

/// A share of wrong points up to which an operator is said to be sound.
const SOUND: f64 = 0.01;

/// The scenarios of the page: the axis that is the distance, px, and its name.
const SECTIONS: [(&str, &str, &str, &str); 6] = [
    ("atlas/corners-small", "Small squares", "testfield.square", "square, px"),
    ("atlas/corners-beside", "Chess corners beside a bar", "testfield.plate.1.middle.0", "bar from the corner, px"),
    ("atlas/corners-hidden", "Chess corners half hidden", "testfield.plate.1.middle.0", "in view on that side, px"),
    ("atlas/discs-beside", "Discs beside a bar", "testfield.plate.1.middle.0", "bar from the border, px"),
    ("atlas/discs-hidden", "Discs half hidden", "testfield.plate.1.middle.0", "border from the centre, px"),
    ("atlas/wedges-beside", "Corners of one area beside a bar", "testfield.plate.1.middle.0", "bar from the corner, px"),
];

/// The page; `None` without records of any of its scenarios.
pub fn page(parts: &Parts) -> Option<String> {
    let mut body = String::new();
    let mut answers = Vec::new();
    for (scenario, title, axis, distance) in SECTIONS {
        let Some(part) = parts.get(scenario) else { continue };
        let (table, sound) = table(part, axis, distance);
        let names =
            if sound.is_empty() { "none".to_owned() } else { sound.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ") };
        answers.push(format!("- {title}: {names}"));
        let notes: String = part.sweep.scenario.notes.iter().map(|note| format!("- {note}\n")).collect();
        let trials = part.sweep.cells.iter().map(|cell| cell.trials).max().unwrap_or(0);
        body.push_str(&format!(
            "## {title}\n\n{} `{scenario}`, {trials} trials a row, seed {}.\n\n{notes}\n{}\n",
            part.sweep.scenario.why.trim(),
            part.sweep.seed,
            table.render()
        ));
    }
    if body.is_empty() {
        return None;
    }
    Some(format!(
        "# What stands beside the target\n\nAt most {} % of the points wrong without a word in every row (what is rejected is not wrong: the tables say how much it is):\n\n{}\n\n{}Each cell: RMSE of the points measured within 1 px, px (rejected, %; wrong without a word, %: measured, \
         and more than {WRONG} px off). Blur 0.7 px, 2 % of noise. Made by `calibench report atlas` from records.\n\n{}\n",
        100.0 * SOUND,
        answers.join("\n"),
        contents(&body),
        body.trim_end()
    ))
}

/// The table of a scenario, nearest first, and the methods that are sound in all of its rows.
fn table(part: &Part, axis: &str, distance: &str) -> (MarkdownTable, Vec<String>) {
    let methods: Vec<usize> = (0..part.sweep.methods.len()).filter(|&method| part.sweep.methods[method].unavailable.is_none()).collect();
    let names: Vec<String> = methods.iter().map(|&method| format!("`{}`", part.sweep.methods[method].name)).collect();
    let header: Vec<&str> = std::iter::once(distance).chain(names.iter().map(String::as_str)).collect();
    let mut table = MarkdownTable::new(&header);
    let place = part.sweep.sweep.axes.iter().position(|known| known.path == axis);
    let at = |cell: usize| place.and_then(|place| part.sweep.sweep.values(cell)[place].number).unwrap_or(f64::NAN);
    let mut cells: Vec<usize> = (0..part.sweep.cells.len()).collect();
    cells.sort_by(|&a, &b| at(a).total_cmp(&at(b)));
    for &cell in &cells {
        table.row(std::iter::once(at(cell).to_string()).chain(methods.iter().map(|&method| figures(part, cell, method))));
    }
    let sound = |method: &&usize| cells.iter().all(|&cell| share(part, cell, **method).is_some_and(|wrong| wrong <= SOUND));
    let sound = methods.iter().filter(sound).map(|&method| part.sweep.methods[method].name.clone()).collect();
    (table, sound)
}

/// The share of a cell's points that are wrong.
fn share(part: &Part, cell: usize, method: usize) -> Option<f64> {
    let points = part.sweep.score(cell, method)?.points();
    (points > 0).then(|| part.wrong(cell, method) as f64 / points as f64)
}

fn figures(part: &Part, cell: usize, method: usize) -> String {
    let (Some(score), Some(wrong)) = (part.sweep.score(cell, method), share(part, cell, method)) else { return String::new() };
    let rejected = Metric::Rejected.of(score).map_or(0.0, |found| found.value);
    let rmse = Metric::Rmse.of(score).map_or_else(|| "none measured".to_owned(), |found| plain(found.value));
    let brief = |percent: f64| if percent == 0.0 { "0".to_owned() } else { format!("{percent:.1}") };
    if rejected == 0.0 && wrong == 0.0 { rmse } else { format!("{rmse} ({}; {})", brief(rejected), brief(100.0 * wrong)) }
}
