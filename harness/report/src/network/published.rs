//! Published tables of adjustments beside ours: one run, and the mean of all.

use super::figure::{Ours, ours};
use crate::load::adjustments::Summaries;
use crate::markdown::MarkdownTable;
use crate::published::{Cell, Printed, Table, Verdict};

/// Within so many standard deviations of their mean lie 95 % of single runs, if these are normal.
const SINGLE: f64 = 1.959_964;

/// The section of a table whose figures are adjustments'; `pitch_um` is that of the camera.
pub fn section(table: &Table, found: Option<&Summaries>, pitch_um: f64) -> String {
    let mut text = format!("## {}\n\n{}. Unit: {}.\n\n", table.title, table.source, table.unit);
    match found {
        Some(found) => text.push_str(&comparison(table, found, pitch_um)),
        None => {
            text.push_str(&format!(
                "There are no adjustments of `{}`: run it with `calibench run {}`.\n\n",
                table.scenario, table.scenario
            ));
        }
    }
    if !table.findings.is_empty() {
        text.push_str("### What was found out\n\n");
        for finding in &table.findings {
            text.push_str(&format!("- {}\n", finding.trim().replace('\n', " ")));
        }
        text.push('\n');
    }
    text
}

fn comparison(table: &Table, found: &Summaries, pitch_um: f64) -> String {
    let header = ["row", "column", "printed", "one run", "mean", "95 % of the mean", "single runs, 95 %", "true errors", "verdict", "why"];
    let mut rows = MarkdownTable::new(&header);
    let mut tally = [0; 3];
    for cell in &table.cells {
        let figure = ours(found, cell, &table.method, pitch_um);
        let (verdict, word) = verdict(cell, figure.as_ref());
        tally[verdict] += 1;
        let mut row = vec![cell.row.clone(), cell.column.clone(), cell.printed.clone()];
        row.extend(figure.map_or_else(|| vec!["none".to_owned(); 5], |ours| cells(cell, &ours)));
        row.extend([WORDS[verdict].to_owned(), word]);
        rows.row(row);
    }
    let [reproduces, differs, not_comparable] = tally;
    format!(
        "Printed beside `{}`: its first trial, the mean of {} trials with half its 95 % interval, and where 95 % of single runs lie. The paper is a single run: a cell \
         *reproduces* when it lies in that range, widened by half a unit of its last digit. `true errors` is the same figure of errors against the truth (root mean square, or the ratio of root mean \
         squares) with half its 95 % interval.\n\n{}\nOf {} cells, {reproduces} reproduce, {differs} differ and {not_comparable} are not comparable.\n\n",
        table.scenario,
        found.trials,
        rows.render(),
        table.cells.len()
    )
}

/// The verdict of a printed cell in a word.
pub fn word(table: &Table, cell: &Cell, found: &Summaries, pitch_um: f64) -> &'static str {
    WORDS[verdict(cell, ours(found, cell, &table.method, pitch_um).as_ref()).0]
}

/// The words of verdicts, by their index.
const WORDS: [&str; 3] = ["reproduces", "differs", "not comparable"];

/// Index of the verdict, and why.
fn verdict(cell: &Cell, ours: Option<&Ours>) -> (usize, String) {
    let (Some(printed), Some(ours)) = (Printed::parse(&cell.printed), ours) else {
        return (2, cell.not_comparable.clone().unwrap_or_else(|| "no record of ours".to_owned()));
    };
    let scatter = SINGLE * ours.scatter.unwrap_or(0.0);
    match cell.verdict_within(ours.mean, scatter) {
        Verdict::Reproduces => (0, String::new()),
        Verdict::Differs => (1, format!("ours is {:.2} times as large in the mean", ours.mean / printed.value)),
        Verdict::NotComparable(why) => (2, why),
    }
}

fn cells(cell: &Cell, ours: &Ours) -> Vec<String> {
    let text = |value: f64| like(cell, value);
    let half = |value: Option<f64>| value.map_or_else(|| "none".to_owned(), |half| format!("± {}", spread(cell, ours.mean, half)));
    let truth = ours.truth.map_or_else(String::new, |(value, half)| {
        half.map_or_else(|| text(value), |half| format!("{} ± {}", text(value), spread(cell, value, half)))
    });
    let range = ours.scatter.map_or_else(
        || "none".to_owned(),
        |scatter| {
            let (low, high) = (ours.mean - SINGLE * scatter, ours.mean + SINGLE * scatter);
            format!("{} to {}", text(low), text(high))
        },
    );
    vec![text(ours.one), text(ours.mean), half(ours.half), range, truth]
}

/// In the form of the printed figure, with one digit more.
fn like(cell: &Cell, value: f64) -> String {
    if cell.printed.contains('/') {
        return if value > 0.0 { format!("1/{:.0}", 1.0 / value) } else { "0".to_owned() };
    }
    let digits = Printed::parse(&cell.printed).map_or(4, |printed| (-printed.unit.log10()).round() as usize + 1);
    crate::markdown::fixed(value, digits)
}

/// A half interval: of a fraction, that of its denominator.
fn spread(cell: &Cell, value: f64, half: f64) -> String {
    if cell.printed.contains('/') { format!("{:.0}", half / (value * value)) } else { like(cell, half) }
}
