//! A published table, its cells beside ours.

use std::fmt::Write;

use calibench_records::results::{Outcome, PointResult};

use super::load::Loaded;
use super::markdown::{MarkdownTable, fixed, fraction, signed};
use crate::published::{Cell, Metric, Printed, Table, Verdict};

/// The errors (dx, dy) of one method's points in the first trial, px, by target; rejected points are left out.
fn errors<'a>(loaded: &'a Loaded, method: usize, except: &'a [String]) -> impl Iterator<Item = (f64, f64)> + 'a {
    points(loaded, method).filter(|p| !except.iter().any(|id| **id == *p.target)).filter_map(|p| match p.outcome {
        Outcome::Measured { error, .. } => error,
        Outcome::Rejected(_) => None,
    })
}

fn points(loaded: &Loaded, method: usize) -> impl Iterator<Item = &PointResult> {
    loaded.first.points.iter().filter(move |point| point.method == method)
}

/// Our figure for `metric`, px.
fn figure(loaded: &Loaded, method: usize, metric: Metric, target: Option<&str>, except: &[String]) -> Option<f64> {
    let position = || points(loaded, method).find(|point| Some(&*point.target) == target)?.outcome.position();
    let mean = |value: fn((f64, f64)) -> f64| {
        let values: Vec<f64> = errors(loaded, method, except).map(value).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    let error = || match points(loaded, method).find(|point| Some(&*point.target) == target)?.outcome {
        Outcome::Measured { error, .. } => error,
        Outcome::Rejected(_) => None,
    };
    match metric {
        Metric::Dx => error().map(|e| e.0),
        Metric::Dy => error().map(|e| e.1),
        Metric::Distance => error().map(|e| e.0.hypot(e.1)),
        Metric::X => position().map(|p| p.x),
        Metric::Y => position().map(|p| p.y),
        Metric::MeanDx => mean(|e| e.0),
        Metric::MeanDy => mean(|e| e.1),
        Metric::RmseX => mean(|e| e.0 * e.0).map(f64::sqrt),
        Metric::RmseY => mean(|e| e.1 * e.1).map(f64::sqrt),
        Metric::MeanDistance => mean(|e| e.0.hypot(e.1)),
        Metric::RmseXy => mean(|e| e.0 * e.0 + e.1 * e.1).map(f64::sqrt),
        // None of ours, or in tables that have sections of their own.
        _ => None,
    }
}

/// Our figure for a printed cell, px.
pub(super) fn ours(main: &Loaded, method: usize, cell: &Cell) -> Option<f64> {
    figure(main, method, cell.metric, cell.target.as_deref(), &cell.except).map(|ours| ours + cell.plus)
}

/// The section of a table: printed beside ours, what was found out, and every method on the same points.
pub fn section(table: &Table, main: &Loaded, beside: &[&Loaded]) -> String {
    let mut text = format!("## {}\n\n{}. Unit: {}.\n\n", table.title, table.source, table.unit);
    match main.method(&table.method) {
        Some(method) => text.push_str(&comparison(table, main, method)),
        None => {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "The records of `{}` hold no method `{}`: nothing to compare.\n", table.scenario, table.method);
        }
    }
    text.push_str(&findings(table));
    text.push_str("### Every method on the same points\n\n");
    let images = match main.scenario.trials {
        1 => "One image without noise: the figures have no scatter.".to_owned(),
        trials => format!("The first of {trials} trials: the scenario's own section has them all."),
    };
    let _ = writeln!(
        text,
        "Distances from the truth in px, and as fractions of a pixel. {images} `dx` is positive to the right, `dy` downwards.\n"
    );
    for loaded in std::iter::once(main).chain(beside.iter().copied()) {
        let _ = writeln!(text, "**`{}`**\n\n{}", loaded.scenario.name, every_method(table, loaded));
    }
    text
}

/// What was found out about a table.
pub(super) fn findings(table: &Table) -> String {
    if table.findings.is_empty() {
        return String::new();
    }
    let lines: String = table.findings.iter().map(|finding| format!("- {}\n", finding.trim().replace('\n', " "))).collect();
    format!("### What was found out\n\n{lines}\n")
}

fn comparison(table: &Table, main: &Loaded, method: usize) -> String {
    let mut header = vec!["row".to_owned()];
    for column in &table.columns {
        header.extend([format!("{column} printed"), format!("{column} ours")]);
    }
    header.extend(["verdict".to_owned(), "why".to_owned()]);
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    let mut tally = [0, 0, 0];
    let mut labels: Vec<&str> = Vec::new();
    for cell in &table.cells {
        if !labels.contains(&cell.row.as_str()) {
            labels.push(&cell.row);
        }
    }
    for label in labels {
        let mut cells = vec![label.to_owned()];
        let (mut verdicts, mut misprints) = (Vec::new(), Vec::new());
        for column in &table.columns {
            let Some(cell) = table.cells.iter().find(|cell| cell.row == label && cell.column == *column) else {
                cells.extend([String::new(), String::new()]);
                continue;
            };
            let ours = ours(main, method, cell);
            let verdict = cell.verdict(ours);
            tally[place(&verdict)] += 1;
            cells.extend([cell.printed.clone(), ours.map_or("none".to_owned(), |value| like(cell, value))]);
            verdicts.push(verdict);
            misprints.extend(cell.misprint.as_ref().map(|misprint| format!("misprint in {column}: {misprint}")));
        }
        // A row is as good as its worst cell.
        let worst = verdicts.into_iter().max_by_key(|verdict| [0, 2, 1][place(verdict)]);
        let (word, why) = worst.map_or((String::new(), String::new()), |verdict| words(&verdict));
        misprints.insert(0, why);
        misprints.retain(|why| !why.is_empty());
        cells.extend([word, misprints.join("; ")]);
        rows.row(cells);
    }
    let [reproduces, differs, not_comparable] = tally;
    format!(
        "Printed beside ours (`{}`, `{}`). A coordinate *reproduces* when ours is within half a unit of the last printed digit; what the paper computed from rounded \
         figures, within one unit.\n\n{}\nOf {} cells, {reproduces} reproduce, {differs} differ and {not_comparable} are not comparable.\n\n",
        table.method,
        table.scenario,
        rows.render(),
        reproduces + differs + not_comparable
    )
}

/// Ours with one digit more than printed, in the form of the printed figure.
pub(super) fn like(cell: &Cell, value: f64) -> String {
    if cell.printed.contains('/') {
        return fraction(value);
    }
    let digits = Printed::parse(&cell.printed).map_or(4, |printed| (-printed.unit.log10()).round() as usize + 1);
    fixed(value, digits)
}

pub(super) fn place(verdict: &Verdict) -> usize {
    match verdict {
        Verdict::Reproduces => 0,
        Verdict::Differs => 1,
        Verdict::NotComparable(_) => 2,
    }
}

pub(super) fn words(verdict: &Verdict) -> (String, String) {
    match verdict {
        Verdict::Reproduces => ("reproduces".into(), String::new()),
        Verdict::Differs => ("differs".into(), "further off than rounding explains".into()),
        Verdict::NotComparable(why) => ("not comparable".into(), why.clone()),
    }
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
    for (method, info) in loaded.head.methods.iter().enumerate() {
        if let Some(why) = &info.unavailable {
            statistics.row([format!("`{}`", info.label), "unavailable".into(), why.clone()]);
            continue;
        }
        for set in &table.sets {
            let of = |metric| figure(loaded, method, metric, None, &set.except);
            let px = |metric| of(metric).map_or("none".into(), |value| fixed(value, 4));
            let part = |metric| of(metric).map_or(String::new(), fraction);
            let (count, all) = (errors(loaded, method, &set.except).count(), targets(loaded).filter(|id| !set.except.contains(id)).count());
            let mean = |metric| of(metric).map_or("none".into(), |value| signed(value, 4));
            let common = (!missed.is_empty()).then(|| {
                let except: Vec<String> = set.except.iter().chain(&missed).cloned().collect();
                let common = figure(loaded, method, Metric::RmseXy, None, &except).map_or("none".into(), |value| fixed(value, 4));
                format!("{common} ({})", errors(loaded, method, &except).count())
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
        let cell = |&method: &usize| match points(loaded, method).find(|p| *p.target == *target).map(|p| p.outcome) {
            Some(Outcome::Measured { error: Some((dx, dy)), .. }) => format!("{}, {}", signed(dx, 3), signed(dy, 3)),
            Some(Outcome::Rejected(why)) => why.to_string(),
            _ => String::new(),
        };
        rows.row(std::iter::once(target.clone()).chain(available.iter().map(cell)));
    }
    rows.render()
}
