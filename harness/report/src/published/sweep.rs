//! A published table whose cells are cells of a sweep.

use calibench_records::score::Score;

use super::many::SINGLE;
use super::notes::Notes;
use super::one::{gravest, like};
use super::section::{Section, findings, head, no_method};
use super::{Cell, Metric, Table, Tally, Verdict};
use crate::markdown::{MarkdownTable, fixed};
use crate::sweep::LoadedSweep;

/// The section of a table: printed beside ours, with intervals, and what was found out.
pub fn section(table: &Table, loaded: &LoadedSweep) -> Section {
    let is_there = method(table, loaded, None).is_some();
    let (text, tally) = if is_there { comparison(table, loaded) } else { (no_method(table), Tally::default()) };
    Section { text: head(table) + &text + &findings(table), tally }
}

/// The verdict of each cell of `table`; `None` where the sweep lacks its method.
pub fn verdicts(table: &Table, loaded: &LoadedSweep) -> Option<Vec<Verdict>> {
    method(table, loaded, None)?;
    Some(table.cells.iter().map(|cell| verdict(table, loaded, cell)).collect())
}

/// The place of the method behind `cell`, or of the table's, without what is swept of it.
fn method(table: &Table, loaded: &LoadedSweep, cell: Option<&Cell>) -> Option<usize> {
    let label = cell.and_then(|cell| cell.method.as_ref()).unwrap_or(&table.method);
    let name = loaded.sweep.method(label);
    loaded.methods.iter().position(|method| method.name == name)
}

/// What is printed is a single run, also beside a cell of many trials.
fn verdict(table: &Table, loaded: &LoadedSweep, cell: &Cell) -> Verdict {
    let ours = ours(table, loaded, cell);
    let single = score(table, loaded, cell).and_then(|score| single(score, cell.metric));
    match (ours, single) {
        (Some(ours), Some(scatter)) => cell.verdict_within(ours, SINGLE * scatter),
        _ => cell.verdict(ours),
    }
}

fn comparison(table: &Table, loaded: &LoadedSweep) -> (String, Tally) {
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
            let score = score(table, loaded, cell);
            let ours = ours(table, loaded, cell);
            let interval = score.filter(|_| cell.metric == Metric::RmseXy).and_then(|score| score.whole.rmse_interval());
            let verdict = verdict(table, loaded, cell);
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
         paper's is; missed or lost is the share of points that were not found, rejected or more than 1 px off. The paper is a single run: a figure *reproduces* when it lies where 95 % of our single runs lie, widened by half a \
         unit of its last digit; of one trial, when ours is within one unit of that.\n\n{}\n{}{}\n\n",
        table.method,
        table.scenario,
        rows.render(),
        notes.render(),
        tally.sentence()
    );
    (text, tally)
}

/// The figures of the cell of the sweep that `cell` names.
fn score<'a>(table: &Table, loaded: &'a LoadedSweep, cell: &Cell) -> Option<&'a Score> {
    let meant = |index: &usize| {
        let mut pairs = loaded.sweep.axes.iter().zip(loaded.sweep.values(*index));
        pairs.all(|(axis, value)| cell.at.iter().any(|(key, at)| axis.is_called(key) && value.number == Some(*at)))
    };
    loaded.score((0..loaded.sweep.cells.len()).find(meant)?, method(table, loaded, Some(cell))?)
}

/// Our figure for a printed cell, px. Which targets are left out is not kept by cell of a sweep.
fn ours(table: &Table, loaded: &LoadedSweep, cell: &Cell) -> Option<f64> {
    let score = score(table, loaded, cell).filter(|_| cell.except.is_empty())?;
    figure(score, cell.metric).map(|ours| ours + cell.plus)
}

/// The standard deviation of the figure of a single trial, px.
fn single(score: &Score, metric: Metric) -> Option<f64> {
    match metric {
        Metric::MeanDx => score.whole.dx.single(),
        Metric::MeanDy => score.whole.dy.single(),
        // That of a root is that of the square over twice the root.
        Metric::RmseXy => Some(score.whole.square.single()? / (2.0 * score.whole.rmse().filter(|rmse| *rmse > 0.0)?)),
        _ => None,
    }
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

    /// Errors (1, 2) and (3, 4): single runs of mean dx scatter by sqrt(2) about 2, of the root mean square by sqrt(200) / (2 sqrt(15)) about sqrt(15). Beside one
    /// trial there is no scatter.
    #[test]
    fn print_is_a_single_run_beside_a_cell_of_many() {
        let loaded = loaded();
        for (printed, metric, at, expected) in [
            ("4.7", Metric::MeanDx, [0.5, 0.0], "reproduces"),
            ("4.9", Metric::MeanDx, [0.5, 0.0], "differs"),
            ("-0.9", Metric::MeanDx, [0.5, 0.0], "differs"),
            ("7.4", Metric::RmseXy, [0.5, 0.0], "reproduces"),
            ("7.6", Metric::RmseXy, [0.5, 0.0], "differs"),
            ("0.7", Metric::MeanDx, [0.5, 0.1], "differs"),
        ] {
            let mut table = table("m");
            table.cells = vec![cell("1", "C", printed, metric, at)];
            assert_eq!(verdicts(&table, &loaded).unwrap()[0].word(), expected, "{printed} {metric:?}");
        }
    }

    /// A cell has the method that it names, if it names one; targets cannot be left out of it.
    #[test]
    fn a_cell_is_compared_with_what_it_asks_for() {
        let (mut table, loaded) = (table("m"), loaded());
        let others: Vec<String> = loaded.methods.iter().map(|method| method.name.clone()).filter(|name| name != "m").collect();
        let first = verdicts(&table, &loaded).unwrap()[0].clone();
        table.cells[0].method = Some("m".into());
        assert_eq!(verdicts(&table, &loaded).unwrap()[0], first);
        for other in others.into_iter().chain(["absent".into()]) {
            table.cells[0].method = Some(other.clone());
            let found = &verdicts(&table, &loaded).unwrap()[0];
            assert_ne!(*found, first, "{other}");
            assert!(section(&table, &loaded).text.contains(found.word()), "{other}");
        }
        table.cells[0].method = None;
        table.cells[0].except = vec!["a".into()];
        assert_eq!(verdicts(&table, &loaded).unwrap()[0].word(), "not comparable");
    }

    #[test]
    fn a_method_without_records_is_compared_with_nothing() {
        assert_eq!(verdicts(&table("absent"), &loaded()), None);
        let Section { text, tally } = section(&table("absent"), &loaded());
        assert!(text.contains("hold no method `absent`") && tally == Tally::default(), "{text}");
    }
}
