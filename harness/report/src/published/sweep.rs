//! A published table whose cells are cells of a sweep.

use calibench_records::score::Score;

use super::notes::Notes;
use super::one::{gravest, like};
use super::section::{Section, findings, head, no_method};
use super::{Cell, Metric, Table, Tally, Verdict};
use crate::markdown::{MarkdownTable, fixed};
use crate::sweep::LoadedSweep;

/// The section of a table: printed beside ours, with intervals, and what was found out.
pub fn section(table: &Table, loaded: &LoadedSweep) -> Section {
    let compared = loaded.methods.iter().position(|method| method.name == table.method).map(|method| comparison(table, loaded, method));
    let (text, tally) = compared.unwrap_or_else(|| (no_method(table), Tally::default()));
    Section { text: head(table) + &text + &findings(table), tally }
}

/// The verdict of each cell of `table`; `None` where the sweep lacks its method.
pub fn verdicts(table: &Table, loaded: &LoadedSweep) -> Option<Vec<Verdict>> {
    let method = loaded.methods.iter().position(|method| method.name == table.method)?;
    Some(table.cells.iter().map(|cell| cell.verdict(ours(loaded, method, cell))).collect())
}

fn comparison(table: &Table, loaded: &LoadedSweep, method: usize) -> (String, Tally) {
    let mut header = vec!["row".to_owned()];
    header.extend(
        table.columns.iter().flat_map(|column| ["printed", "ours", "95 %", "missed or lost"].map(|part| format!("{column}: {part}"))),
    );
    header.push("verdict".to_owned());
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    let (mut tally, mut notes) = (Tally::default(), Notes::default());
    for label in table.rows() {
        let (mut cells, mut verdicts) = (vec![label.to_owned()], Vec::new());
        for column in &table.columns {
            let Some(cell) = table.cells.iter().find(|cell| cell.row == label && cell.column == *column) else {
                cells.extend([const { String::new() }; 4]);
                continue;
            };
            let score = score(loaded, method, cell);
            let ours = ours(loaded, method, cell);
            let interval = score.filter(|_| cell.metric == Metric::RmseXy).and_then(|score| score.whole.rmse_interval());
            let verdict = cell.verdict(ours);
            tally.count(&verdict);
            verdicts.push(verdict);
            cells.extend([
                cell.printed.clone(),
                ours.map_or("none".into(), |ours| like(cell, ours)),
                interval.map_or(String::new(), |(low, high)| format!("{} to {}", fixed(low, 3), fixed(high, 3))),
                score.map_or(String::new(), |s| format!("{:.1} %", 100.0 * (s.points() - s.measured) as f64 / s.points() as f64)),
            ]);
        }
        rows.row(cells.into_iter().chain([gravest(verdicts, &mut notes)]));
    }
    let trials = loaded.cells.iter().map(|cell| cell.trials).max().unwrap_or(0);
    let text = format!(
        "Printed beside ours (`{}`, `{}`), {trials} trials a cell. Ours is over all points that the detector found and the method measured, those more than 1 px off among them, as the \
         paper's is; missed or lost is the share of points that were not found, rejected or more than 1 px off. A figure *reproduces* when ours is within one unit of the last printed \
         digit.\n\n{}\n{}{}\n\n",
        table.method,
        table.scenario,
        rows.render(),
        notes.render(),
        tally.sentence()
    );
    (text, tally)
}

/// The figures of the cell of the sweep that `cell` names.
fn score<'a>(loaded: &'a LoadedSweep, method: usize, cell: &Cell) -> Option<&'a Score> {
    let meant = |index: &usize| {
        let mut pairs = loaded.sweep.axes.iter().zip(loaded.sweep.values(*index));
        pairs.all(|(axis, value)| cell.at.iter().any(|(key, at)| axis.is_called(key) && value.number == Some(*at)))
    };
    loaded.score((0..loaded.sweep.cells.len()).find(meant)?, method)
}

/// Our figure for a printed cell, px.
fn ours(loaded: &LoadedSweep, method: usize, cell: &Cell) -> Option<f64> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::small::row;
    use crate::tests::swept::loaded;

    fn cell(label: &str, column: &str, printed: &str, metric: Metric, at: [f64; 2]) -> Cell {
        Cell {
            row: label.into(),
            column: column.into(),
            printed: printed.into(),
            metric,
            target: None,
            except: Vec::new(),
            plus: 0.0,
            at: [("blur".to_owned(), at[0]), ("noise".to_owned(), at[1])].into(),
            misprint: None,
            method: None,
            of: None,
            set: None,
            group: None,
            times: None,
            over: None,
            predicted: None,
            units: None,
            consistent_within: None,
            not_comparable: None,
        }
    }

    fn table(method: &str) -> Table {
        let first = [0.5, 0.0];
        Table {
            title: "T".into(),
            source: "S".into(),
            unit: "px".into(),
            scenario: "s".into(),
            method: method.into(),
            columns: vec!["C".into(), "D".into()],
            findings: Vec::new(),
            beside: Vec::new(),
            sets: Vec::new(),
            ensemble: None,
            experiments: None,
            cells: vec![
                cell("1", "C", "2.0", Metric::MeanDx, first),
                cell("1", "D", "3.9", Metric::RmseXy, first),
                Cell { plus: 0.5, ..cell("2", "C", "3.5", Metric::MeanDy, first) },
                cell("3", "C", "0.5", Metric::MeanDx, [0.5, 0.1]),
                cell("3", "D", "0.7", Metric::MeanDy, [2.0, 0.0]),
                cell("4", "C", "0.7", Metric::MeanDy, [2.0, 0.1]),
                cell("5", "C", "0.7", Metric::MeanDistance, first),
                cell("6", "C", "0.7", Metric::MeanDy, [2.0, 0.2]),
            ],
        }
    }

    /// Errors (1, 2) and (3, 4): means 2 and 3, squares 5 and 25 with mean 15 and half 10 t = 127; six of eight points were lost.
    #[test]
    fn each_printed_cell_is_compared_with_its_cell_of_the_sweep() {
        let (table, loaded) = (table("m"), loaded());
        let words: Vec<&str> = verdicts(&table, &loaded).unwrap().iter().map(Verdict::word).collect();
        let (yes, no, none) = ("reproduces", "differs", "not comparable");
        assert_eq!(words, [yes, yes, yes, yes, no, none, none, none]);
        let Section { text, tally } = section(&table, &loaded);
        let end = format!("0.000 to {:.3}", (15.0 + 10.0 * 12.706_204_736_f64).sqrt());
        assert_eq!(row(&text, &["1"]), ["1", "2.0", "2.00", "", "75.0 %", "3.9", "3.87", &end, "75.0 %", yes]);
        assert_eq!(row(&text, &["2"]), ["2", "3.5", "3.50", "", "75.0 %", "", "", "", "", yes]);
        assert_eq!(row(&text, &["3"]), ["3", "0.5", "0.50", "", "0.0 %", "0.7", "-0.25", "", "50.0 %", no]);
        assert_eq!(row(&text, &["4"]), ["4", "0.7", "none", "", "", "", "", "", "", "not comparable (a)"]);
        assert_eq!(tally, Tally { reproduce: 4, differ: 1, not_comparable: 3, ..Tally::default() });
        assert!(text.starts_with("## T\n\nS. Unit: px.\n\n") && text.contains(", 2 trials a cell."), "{text}");
    }

    #[test]
    fn a_method_without_records_is_compared_with_nothing() {
        assert_eq!(verdicts(&table("absent"), &loaded()), None);
        let Section { text, tally } = section(&table("absent"), &loaded());
        assert!(text.contains("hold no method `absent`") && tally == Tally::default(), "{text}");
    }
}
