//! A published table whose cells are cells of a sweep.

use calibench_records::score::Score;

use super::markdown::{MarkdownTable, fixed};
use super::published_section::{findings, like, place, words};
use super::sweep::LoadedSweep;
use crate::published::{Cell, Metric, Table};

/// The section of a table: printed beside ours, with intervals, and what was found out.
pub fn section(table: &Table, loaded: &LoadedSweep) -> String {
    let mut text = format!("## {}\n\n{}. Unit: {}.\n\n", table.title, table.source, table.unit);
    let Some(method) = loaded.methods.iter().position(|method| method.name == table.method) else {
        text.push_str(&format!("The records of `{}` hold no method `{}`: nothing to compare.\n\n", table.scenario, table.method));
        return text + &findings(table);
    };
    text.push_str(&comparison(table, loaded, method));
    text + &findings(table)
}

fn comparison(table: &Table, loaded: &LoadedSweep, method: usize) -> String {
    let mut header = vec!["row".to_owned()];
    header.extend(
        table.columns.iter().flat_map(|column| ["printed", "ours", "95 %", "missed or lost"].map(|part| format!("{column}: {part}"))),
    );
    header.extend(["verdict".to_owned(), "why".to_owned()]);
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    let mut tally = [0, 0, 0];
    let mut labels: Vec<&str> = table.cells.iter().map(|cell| cell.row.as_str()).collect();
    labels.dedup();
    for label in labels {
        let (mut cells, mut worst) = (vec![label.to_owned()], None);
        for column in &table.columns {
            let Some(cell) = table.cells.iter().find(|cell| cell.row == label && cell.column == *column) else {
                cells.extend([const { String::new() }; 4]);
                continue;
            };
            let score = score(loaded, method, cell);
            let ours = ours(loaded, method, cell);
            let interval = score.filter(|_| cell.metric == Metric::RmseXy).and_then(|score| score.whole.rmse_interval());
            let verdict = cell.verdict(ours);
            tally[place(&verdict)] += 1;
            cells.extend([
                cell.printed.clone(),
                ours.map_or("none".into(), |ours| like(cell, ours)),
                interval.map_or(String::new(), |(low, high)| format!("{} to {}", fixed(low, 3), fixed(high, 3))),
                score.map_or(String::new(), |s| format!("{:.1} %", 100.0 * (s.points() - s.measured) as f64 / s.points() as f64)),
            ]);
            let rank = [0, 2, 1][place(&verdict)];
            worst = worst.filter(|(other, _)| *other >= rank).or(Some((rank, verdict)));
        }
        let (word, why) = worst.map_or((String::new(), String::new()), |(_, verdict)| words(&verdict));
        rows.row(cells.into_iter().chain([word, why]));
    }
    let [reproduces, differs, not_comparable] = tally;
    let trials = loaded.cells.iter().map(|cell| cell.trials).max().unwrap_or(0);
    format!(
        "Printed beside ours (`{}`, `{}`), {trials} trials a cell. Ours is over all points that the detector found and the method measured, those more than 1 px off among them, as the \
         paper's is; missed or lost is the share of points that were not found, rejected or more than 1 px off. A figure *reproduces* when ours is within one unit of the last printed \
         digit.\n\n{}\nOf {} cells, {reproduces} reproduce, {differs} differ and {not_comparable} are not comparable.\n\n",
        table.method,
        table.scenario,
        rows.render(),
        reproduces + differs + not_comparable
    )
}

/// The figures of the cell of the sweep that `cell` names.
pub(super) fn score<'a>(loaded: &'a LoadedSweep, method: usize, cell: &Cell) -> Option<&'a Score> {
    let meant = |index: &usize| {
        let mut pairs = loaded.sweep.axes.iter().zip(loaded.sweep.values(*index));
        pairs.all(|(axis, value)| cell.at.iter().any(|(key, at)| axis.is_called(key) && value.number == Some(*at)))
    };
    loaded.score((0..loaded.sweep.cells()).find(meant)?, method)
}

/// Our figure for a printed cell, px.
pub(super) fn ours(loaded: &LoadedSweep, method: usize, cell: &Cell) -> Option<f64> {
    score(loaded, method, cell).and_then(|score| figure(score, cell.metric)).map(|ours| ours + cell.plus)
}

/// Statistics over all points of a cell; figures of one target are not kept by trial.
fn figure(score: &Score, metric: Metric) -> Option<f64> {
    let root = |value: Option<f64>| value.map(f64::sqrt);
    match metric {
        Metric::MeanDx => score.whole.dx.mean(),
        Metric::MeanDy => score.whole.dy.mean(),
        Metric::RmseXy => root(score.whole.square.mean()),
        _ => None,
    }
}
