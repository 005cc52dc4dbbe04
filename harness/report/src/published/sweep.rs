//! A published table whose cells are cells of a sweep.

use calibench_records::names::cell_folder;
use calibench_records::score::Score;
use calibench_records::stored::read_points;

use super::figure::of_points;
use super::many::SINGLE;
use super::notes::Notes;
use super::one::{gravest, like, words};
use super::range::Range;
use super::section::{Section, head, no_method};
use super::{Cell, Metric, Printed, Table, Tally, Verdict};
use crate::LoadError;
use crate::markdown::MarkdownTable;
use crate::sweep::LoadedSweep;

/// The section of a table: printed beside ours, with where single runs lie, and what was found out.
///
/// # Errors
/// Records that cannot be read.
pub fn section(table: &Table, loaded: &LoadedSweep) -> Result<Section, LoadError> {
    if method(table, loaded, None).is_none() {
        return Ok(Section::of_nothing(head(table) + &no_method(table)));
    }
    let runs = runs(table, loaded)?;
    let figures = table.cells.iter().map(|cell| ours(table, loaded, cell)).collect();
    Ok(Section {
        text: head(table) + &comparison(table, loaded, &runs),
        after: String::new(),
        verdicts: judged(table, loaded, &runs),
        figures,
    })
}

/// The verdict of each cell of `table`; `None` where the sweep lacks its method.
///
/// # Errors
/// Records that cannot be read.
pub fn verdicts(table: &Table, loaded: &LoadedSweep) -> Result<Option<Vec<Verdict>>, LoadError> {
    if method(table, loaded, None).is_none() {
        return Ok(None);
    }
    Ok(Some(judged(table, loaded, &runs(table, loaded)?)))
}

/// The figure behind each cell of `table` in every trial of its cell of the sweep.
fn runs(table: &Table, loaded: &LoadedSweep) -> Result<Vec<Vec<f64>>, LoadError> {
    let of_cell = |cell: &Cell| {
        let (mut figures, method) = (Vec::new(), method(table, loaded, Some(cell)));
        let (Some(index), Some(name)) = (place(loaded, cell), method.map(|method| &loaded.methods[method].name)) else {
            return Ok(figures);
        };
        read_points(&cell_folder(&loaded.folder, index), &loaded.sweep.run(&loaded.name, index), |trial, methods| {
            let method = methods.iter().position(|info| loaded.sweep.method(&info.label) == *name);
            figures.extend(method.and_then(|method| of_points(&trial.points, method, cell.metric, None, &[])));
        })?;
        Ok(figures)
    };
    table.cells.iter().map(of_cell).collect()
}

fn judged(table: &Table, loaded: &LoadedSweep, runs: &[Vec<f64>]) -> Vec<Verdict> {
    table.cells.iter().zip(runs).map(|(cell, runs)| verdict(cell, ours(table, loaded, cell), runs)).collect()
}

/// The place of the method behind `cell`, or of the table's, without what is swept of it.
fn method(table: &Table, loaded: &LoadedSweep, cell: Option<&Cell>) -> Option<usize> {
    let label = cell.and_then(|cell| cell.method.as_ref()).unwrap_or(&table.method);
    let name = loaded.sweep.method(label);
    loaded.methods.iter().position(|method| method.name == name)
}

/// What is printed is a single run, also beside a cell of many trials.
fn verdict(cell: &Cell, ours: Option<f64>, runs: &[f64]) -> Verdict {
    match (ours, single(cell, runs)) {
        (Some(_), Some(range)) => cell.verdict_between(range.low, range.high),
        _ => cell.verdict(ours),
    }
}

/// Where single runs lie, in the unit of the printed figure; `None` where there is one.
fn single(cell: &Cell, runs: &[f64]) -> Option<Range> {
    let range = Range::of(runs).filter(|_| runs.len() > 1)?;
    Some(Range { median: range.median + cell.plus, low: range.low + cell.plus, high: range.high + cell.plus })
}

fn comparison(table: &Table, loaded: &LoadedSweep, runs: &[Vec<f64>]) -> String {
    let mut header = vec!["row".to_owned()];
    header.extend(table.columns.iter().flat_map(|column| {
        ["printed", "ours", "ours / printed", "single runs, 95 %", "missed or lost"].map(|part| format!("{column}: {part}"))
    }));
    header.extend(["kind", "verdict"].map(str::to_owned));
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    let (mut tally, mut notes) = (Tally::default(), Notes::default());
    for label in table.rows() {
        let (mut cells, mut verdicts, mut kinds) = (vec![label.to_owned()], Vec::new(), Vec::new());
        for column in &table.columns {
            let is_it = |(cell, _): &(&Cell, &Vec<f64>)| cell.row == label && cell.column == *column;
            let Some((cell, runs)) = table.cells.iter().zip(runs).find(is_it) else {
                cells.extend([const { String::new() }; 5]);
                continue;
            };
            let score = score(table, loaded, cell);
            let ours = ours(table, loaded, cell);
            let verdict = verdict(cell, ours, runs);
            tally.count(&verdict);
            verdicts.push(verdict);
            kinds.push(cell.kind);
            cells.extend([
                cell.printed.clone(),
                ours.map_or("none".into(), |ours| like(cell, ours)),
                ours.zip(Printed::parse(&cell.printed)).map_or(String::new(), |(ours, printed)| times(ours, printed.value)),
                single(cell, runs).map_or(String::new(), |range| format!("{} to {}", like(cell, range.low), like(cell, range.high))),
                score.map_or(String::new(), |s| format!("{:.1} %", 100.0 * (s.points() - s.measured) as f64 / s.points() as f64)),
            ]);
        }
        rows.row(cells.into_iter().chain([words(&kinds), gravest(verdicts, &mut notes)]));
    }
    let trials = loaded.cells.iter().map(|cell| cell.trials).max().unwrap_or(0);
    format!(
        "Printed beside ours (`{}`, `{}`), {trials} trials a cell. Ours is over all points that the detector found and the method measured, those more than 1 px off among them, as the \
         paper's is; missed or lost is the share of points that were not found, rejected or more than 1 px off. The paper is a single run: a figure *reproduces* when it lies {SINGLE}, widened by half a \
         unit of its last digit; of one trial, when ours is within one unit of that.\n\n{}\n{}{}\n\n",
        table.method,
        table.scenario,
        rows.render(),
        notes.render(),
        tally.sentence()
    )
}

/// So many times as large as printed.
fn times(ours: f64, printed: f64) -> String {
    if printed == 0.0 { String::new() } else { format!("{:.2}", ours / printed) }
}

/// The figures of the cell of the sweep that `cell` names.
fn score<'a>(table: &Table, loaded: &'a LoadedSweep, cell: &Cell) -> Option<&'a Score> {
    loaded.score(place(loaded, cell)?, method(table, loaded, Some(cell))?)
}

/// Which cell of the sweep `cell` names.
fn place(loaded: &LoadedSweep, cell: &Cell) -> Option<usize> {
    let meant = |index: &usize| {
        let mut pairs = loaded.sweep.axes.iter().zip(loaded.sweep.values(*index));
        pairs.all(|(axis, value)| cell.at.iter().any(|(key, at)| axis.is_called(key) && value.number == Some(*at)))
    };
    (0..loaded.sweep.cells.len()).find(meant)
}

/// Our figure for a printed cell, px. Which targets are left out is not kept by cell of a sweep.
fn ours(table: &Table, loaded: &LoadedSweep, cell: &Cell) -> Option<f64> {
    let score = score(table, loaded, cell).filter(|_| cell.except.is_empty())?;
    figure(score, cell.metric).map(|ours| ours + cell.plus)
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
    use calibench_model::PixelPoint;
    use calibench_records::points::{RecordWriter, RunInfo};
    use calibench_records::results::{MethodInfo, Outcome, PointResult, Trial};
    use calibench_records::stored::Table as StoredTable;

    use super::*;
    use crate::tests::small::{new_table, row};
    use crate::tests::swept::loaded;

    fn cell(label: &str, column: &str, printed: &str, metric: Metric, at: [f64; 2]) -> Cell {
        Cell {
            row: label.into(),
            column: column.into(),
            at: [("blur".to_owned(), at[0]), ("noise".to_owned(), at[1])].into(),
            ..Cell::bare(printed, metric)
        }
    }

    fn table(method: &str) -> Table {
        let first = [0.5, 0.0];
        Table {
            method: method.into(),
            columns: vec!["C".into(), "D".into()],
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
            ..Table::bare()
        }
    }

    /// The runs behind the cells of [`table`]: two trials in the first cell of the sweep, one elsewhere.
    fn runs_of(table: &Table) -> Vec<Vec<f64>> {
        let of = |cell: &Cell| match (cell.metric, cell.at["blur"], cell.at["noise"]) {
            (Metric::MeanDx, 0.5, 0.0) => vec![1.0, 3.0],
            (Metric::MeanDy, 0.5, 0.0) => vec![2.0, 4.0],
            (Metric::RmseXy, 0.5, 0.0) => vec![5.0_f64.sqrt(), 5.0],
            _ => Vec::new(),
        };
        table.cells.iter().map(of).collect()
    }

    fn words_of(table: &Table) -> Vec<&'static str> {
        judged(table, &loaded(), &runs_of(table)).iter().map(Verdict::word).collect()
    }

    /// Errors (1, 2) and (3, 4): means 2 and 3, squares 5 and 25 with mean 15; six of eight points were lost.
    #[test]
    fn each_printed_cell_is_compared_with_its_cell_of_the_sweep() {
        let table = table("m");
        let (yes, no, none) = ("reproduces", "differs", "not comparable");
        assert_eq!(words_of(&table), [yes, yes, yes, yes, no, none, none, none]);
        let text = comparison(&table, &loaded(), &runs_of(&table));
        let kind = "prediction";
        assert_eq!(
            row(&text, &["1"]),
            ["1", "2.0", "2.00", "1.00", "1.00 to 3.00", "75.0 %", "3.9", "3.87", "0.99", "2.24 to 5.00", "75.0 %", kind, yes]
        );
        assert_eq!(row(&text, &["2"]), ["2", "3.5", "3.50", "1.00", "2.50 to 4.50", "75.0 %", "", "", "", "", "", kind, yes]);
        assert_eq!(row(&text, &["3"]), ["3", "0.5", "0.50", "1.00", "", "0.0 %", "0.7", "-0.25", "-0.36", "", "50.0 %", kind, no]);
        assert_eq!(row(&text, &["4"]), ["4", "0.7", "none", "", "", "", "", "", "", "", "", kind, "not comparable (a)"]);
        assert!(
            text.contains("Of 8 cells, 4 reproduce, 1 differ and 3 are not comparable.") && text.contains(", 2 trials a cell."),
            "{text}"
        );
    }

    /// Single runs of mean dx are 1 and 3, of the root mean square 2.24 and 5. Beside one trial there is no range.
    #[test]
    fn print_is_a_single_run_beside_a_cell_of_many() {
        for (printed, metric, at, expected) in [
            ("3.0", Metric::MeanDx, [0.5, 0.0], "reproduces"),
            ("3.1", Metric::MeanDx, [0.5, 0.0], "differs"),
            ("0.9", Metric::MeanDx, [0.5, 0.0], "differs"),
            ("5.0", Metric::RmseXy, [0.5, 0.0], "reproduces"),
            ("5.1", Metric::RmseXy, [0.5, 0.0], "differs"),
            ("0.7", Metric::MeanDx, [0.5, 0.1], "differs"),
        ] {
            let mut table = table("m");
            table.cells = vec![cell("1", "C", printed, metric, at)];
            assert_eq!(words_of(&table), [expected], "{printed} {metric:?}");
        }
    }

    /// Every trial by itself, by the method that the cell names, of the cell of the sweep that it names.
    #[test]
    fn single_runs_are_those_of_the_records() {
        let folder = tempfile::tempdir().unwrap();
        let mut loaded = loaded();
        loaded.folder = folder.path().to_owned();
        let of_cell = cell_folder(folder.path(), 0);
        std::fs::create_dir_all(&of_cell).unwrap();
        let info = |label: &str| MethodInfo { label: label.into(), version: "1".into(), unavailable: None };
        let run = RunInfo { scenario: loaded.sweep.run("s", 0), seed: 1, revision: "r".into(), detector: None };
        let mut writer = RecordWriter::new(new_table(&of_cell, StoredTable::Points), run, vec![info("other"), info("m")]).unwrap();
        for (number, error) in (0..).zip([(1.0, 2.0), (3.0, 4.0)]) {
            let point = |method, error: (f64, f64)| {
                PointResult::new(
                    "image",
                    "a",
                    method,
                    Outcome::Measured { position: PixelPoint::new(error.0, error.1), error: Some(error) },
                )
            };
            writer.trial(&Trial { number, points: vec![point(0, (9.0, 9.0)), point(1, error)], ..Trial::default() }).unwrap();
        }
        writer.finish().unwrap().finish().unwrap();
        let mut table = table("m");
        table.cells.truncate(2);
        table.cells.push(cell("7", "C", "0.7", Metric::MeanDx, [0.5, 9.0]));
        assert_eq!(runs(&table, &loaded).unwrap(), [vec![1.0, 3.0], vec![5.0_f64.sqrt(), 5.0], vec![]]);
        assert_eq!(verdicts(&table, &loaded).unwrap().unwrap()[0], Verdict::Reproduces);
    }

    /// A cell has the method that it names, if it names one; targets cannot be left out of it.
    #[test]
    fn a_cell_is_compared_with_what_it_asks_for() {
        let mut table = table("m");
        let first = |table: &Table| words_of(table)[0];
        table.cells[0].method = Some("m".into());
        assert_eq!(first(&table), "reproduces");
        table.cells[0].method = Some("absent".into());
        assert_eq!(first(&table), "not comparable");
        table.cells[0].method = Some("other".into());
        assert_eq!(ours(&table, &loaded(), &table.cells[0]), Some(9.0));
        table.cells[0].method = None;
        table.cells[0].except = vec!["a".into()];
        assert_eq!(first(&table), "not comparable");
    }

    #[test]
    fn a_method_without_records_is_compared_with_nothing() {
        assert_eq!(verdicts(&table("absent"), &loaded()).unwrap(), None);
        let Section { text, verdicts, .. } = section(&table("absent"), &loaded()).unwrap();
        assert!(text.contains("hold no method `absent`") && verdicts.is_empty(), "{text}");
    }
}
