//! A test by check points in words.

use calibench_accept::basis::OF_POINTS;
use calibench_accept::points::{AXES, Accuracy, PointResult};
use calibench_accept::{Decision, PointAcceptance};

use calibench_calibrate::few;

use super::{basis_words, with_unit};
use crate::markdown::{MarkdownTable, plain};

/// The decision and why, the accuracies and the errors of coordinates as tables; `unit` is that of the points.
pub fn of_points(found: &PointAcceptance, unit: Option<&str>) -> String {
    let mut text = format!("{}\n", headline(found, unit));
    if !found.missing.is_empty() {
        text.push_str(&format!("not measured: {}\n", few(&found.missing)));
    }
    for remark in &found.remarks {
        text.push_str(&format!("note: {remark}\n"));
    }
    text.push_str(&format!("\n{}\n{}\n{}", accuracies(found), axes(found), basis_words(&OF_POINTS)));
    text
}

fn headline(found: &PointAcceptance, unit: Option<&str>) -> String {
    let (word, count) = (found.decision.words(), found.results.len());
    if let Some(too_few) = found.too_few {
        return format!("{word}: {too_few}");
    }
    let beside = |accuracy: &Accuracy| {
        let class = accuracy.class?;
        Some(format!("{} {} (class {class})", accuracy.what, with_unit(&plain(accuracy.total), unit)))
    };
    let asked: Vec<String> = found.accuracies.iter().filter_map(beside).collect();
    match (found.decision, asked.is_empty()) {
        (Decision::CannotTell, true) => format!("{word}: no class was asked for; {count} check points"),
        _ => format!("{word}: {}; {count} check points", asked.join(", ")),
    }
}

fn accuracies(found: &PointAcceptance) -> String {
    let mut table =
        MarkdownTable::new(&["RMSE", "of the check points", "of the survey", "with both", "95 % from", "to", "class", "decision"]);
    for one in &found.accuracies {
        let numbers = [one.of_points, one.of_survey, one.total, one.interval[0], one.interval[1]].map(plain);
        let class = one.class.map_or_else(String::new, |class| class.to_string());
        let decision = one.decision.map_or("", Decision::words).to_owned();
        table.row(std::iter::once(one.what.to_owned()).chain(numbers).chain([class, decision]));
    }
    table.render()
}

fn axes(found: &PointAcceptance) -> String {
    let mut table = MarkdownTable::new(&["error", "mean", "standard deviation", "RMSE", "largest", "at"]);
    for (place, axis) in found.axes.iter().enumerate() {
        let size = |point: &&PointResult| point.error[place].abs();
        let largest = found.results.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
        table.row([
            AXES[place].to_owned(),
            plain(axis.mean),
            axis.deviation.map_or_else(String::new, plain),
            plain(axis.rmse),
            largest.map_or_else(String::new, |point| plain(point.error[place])),
            largest.map_or_else(String::new, |point| point.target.clone()),
        ]);
    }
    table.render()
}
