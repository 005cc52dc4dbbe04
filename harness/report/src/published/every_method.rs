//! Every method on the points of a published table.

use calibench_records::results::Outcome;

use super::figure::{errors, of_method, of_points};
use super::{Metric, Table};
use crate::load::Loaded;
use crate::markdown::{MarkdownTable, fixed, fraction, signed};

/// The statistics of all methods by set of targets, and their errors by target.
pub fn section(table: &Table, main: &Loaded, beside: &[&Loaded]) -> String {
    let images = match main.scenario.trials {
        1 => "One image without noise: the figures have no scatter.".to_owned(),
        trials => format!("The first of {trials} trials: the scenario's own section has them all."),
    };
    let mut text = format!(
        "### Every method on the same points\n\nDistances from the truth in px, and as fractions of a pixel. {images} `dx` is positive to the right, `dy` downwards.\n\n"
    );
    for loaded in std::iter::once(main).chain(beside.iter().copied()) {
        text.push_str(&format!("**`{}`**\n\n{}\n", loaded.name, every_method(table, loaded)));
    }
    text
}

fn every_method(table: &Table, loaded: &Loaded) -> String {
    if let Some(why) = loaded.unavailable() {
        return format!("unavailable: {why}\n");
    }
    let mut header = vec!["method", "points", "set", "mean dx", "mean dy", "mean distance", "", "RMSE", ""];
    let missed = missed(loaded);
    if !missed.is_empty() {
        header.push("RMSE, common points");
    }
    let mut statistics = MarkdownTable::new(&header);
    let sets = table.sets_or_all();
    for (method, info) in loaded.head.methods.iter().enumerate() {
        if let Some(why) = &info.unavailable {
            statistics.row([format!("`{}`", info.label), "unavailable".into(), why.clone()]);
            continue;
        }
        for set in &sets {
            let of = |metric| of_points(&loaded.first.points, method, metric, None, &set.except);
            let px = |metric| of(metric).map_or("none".into(), |value| fixed(value, 4));
            let part = |metric| of(metric).map_or(String::new(), fraction);
            let (count, all) = (
                errors(&loaded.first.points, method, &set.except).count(),
                of_method(&loaded.first.points, method).filter(|p| !set.except.iter().any(|id| **id == *p.target)).count(),
            );
            let mean = |metric| of(metric).map_or("none".into(), |value| signed(value, 4));
            let common = (!missed.is_empty()).then(|| {
                let except: Vec<String> = set.except.iter().chain(&missed).cloned().collect();
                let common =
                    of_points(&loaded.first.points, method, Metric::RmseXy, None, &except).map_or("none".into(), |value| fixed(value, 4));
                format!("{common} ({})", errors(&loaded.first.points, method, &except).count())
            });
            let cells = [
                format!("`{}`", info.label),
                format!("{count} of {all}"),
                set.name.clone(),
                mean(Metric::MeanDx),
                mean(Metric::MeanDy),
                px(Metric::MeanDistance),
                part(Metric::MeanDistance),
                px(Metric::RmseXy),
                part(Metric::RmseXy),
            ];
            statistics.row(cells.into_iter().chain(common));
        }
    }
    let mut text = statistics.render();
    text.push('\n');
    if !missed.is_empty() {
        text.push_str("Means are over the points that each method measured; *common points* are those of the set that all methods measured, their number in brackets.\n\n");
    }
    text.push_str(&by_target(loaded));
    text
}

/// The targets of the first trial, once each.
fn targets(loaded: &Loaded) -> impl Iterator<Item = String> {
    let mut targets: Vec<String> = Vec::new();
    for point in &loaded.first.points {
        if !targets.iter().any(|known| **known == *point.target) {
            targets.push(point.target.to_string());
        }
    }
    targets.into_iter()
}

/// The targets that some available method did not measure.
fn missed(loaded: &Loaded) -> Vec<String> {
    let rejected = |id: &String| loaded.first.points.iter().any(|p| *p.target == **id && p.outcome.position().is_none());
    targets(loaded).filter(rejected).collect()
}

/// One row a target: each method's error, or why there is none.
fn by_target(loaded: &Loaded) -> String {
    let available: Vec<usize> = (0..loaded.head.methods.len()).filter(|&m| loaded.head.methods[m].unavailable.is_none()).collect();
    let mut header = vec!["target: (dx, dy)".to_owned()];
    header.extend(available.iter().map(|&m| format!("`{}`", loaded.head.methods[m].label)));
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for target in targets(loaded) {
        let cell = |&method: &usize| match of_method(&loaded.first.points, method).find(|p| *p.target == *target).map(|p| p.outcome) {
            Some(Outcome::Measured { error: Some((dx, dy)), .. }) => format!("{}, {}", signed(dx, 3), signed(dy, 3)),
            Some(Outcome::Rejected(why)) => why.to_string(),
            _ => String::new(),
        };
        rows.row(std::iter::once(target.clone()).chain(available.iter().map(cell)));
    }
    rows.render()
}
