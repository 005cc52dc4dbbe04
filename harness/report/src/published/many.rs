//! A published table beside many runs of ours: one of them, their mean, and where single runs lie.

use calibench_records::stored::read_points;

use super::figure::{Ours, of_points};
use super::notes::Notes;
use super::range::Range;
use super::{Cell, Printed, Table, Tally, Verdict};
use crate::load::{LoadError, Loaded};
use crate::markdown::{MarkdownTable, fixed};

/// What is said of single runs.
pub const SINGLE: &str = "where 95 % of single runs lie (their quantiles; of fewer than 39 runs the least and the greatest)";
/// The heading of what plausible experiments say.
const PLAUSIBLE: &str = "plausible, 95 %";

/// Our figures of points for every cell of `table`, over all trials in the records of `loaded`.
///
/// # Errors
/// Records that cannot be read.
pub fn of_all_trials(table: &Table, loaded: &Loaded) -> Result<Vec<Option<Ours>>, LoadError> {
    let mut figures = vec![Vec::new(); table.cells.len()];
    read_points(&loaded.folder, &loaded.name, |trial, methods| {
        for (cell, trials) in table.cells.iter().zip(&mut figures) {
            let label = cell.method.as_ref().unwrap_or(&table.method);
            let method = methods.iter().position(|method| *method.label == **label);
            let figure = method.and_then(|method| of_points(&trial.points, method, cell.metric, cell.target.as_deref(), &cell.except));
            trials.extend(figure.map(|figure| figure + cell.plus));
        }
    })?;
    Ok(figures.iter().map(|trials| Ours::of(trials)).collect())
}

/// The table, with a figure of ours for every cell or none, over `trials` trials.
pub fn comparison(table: &Table, figures: &[Option<Ours>], trials: u64) -> (String, Tally) {
    let against_truth = figures.iter().flatten().any(|ours| ours.truth.is_some());
    let mut header = vec!["row", "column", "printed", "one run", "mean", "single runs, 95 %", "true errors", PLAUSIBLE, "kind", "verdict"];
    header.retain(|name| (against_truth || *name != "true errors") && (table.experiments.is_some() || *name != PLAUSIBLE));
    let mut rows = MarkdownTable::new(&header);
    let (mut tally, mut notes) = (Tally::default(), Notes::default());
    for (cell, figure) in table.cells.iter().zip(figures) {
        let verdict = verdict(table, cell, figure.as_ref());
        let range = plausible(table, cell);
        tally.count(&verdict);
        let mut row = vec![cell.row.clone(), cell.column.clone(), cell.printed.clone()];
        row.extend(figure.as_ref().map_or_else(|| vec!["none".to_owned(); 4], |ours| cells(cell, ours)));
        if !against_truth {
            row.pop();
        }
        if table.experiments.is_some() {
            row.push(range.map_or_else(String::new, |range| ranged(cell, range)));
        }
        let misprint = cell.misprint.as_ref().map_or_else(String::new, |misprint| notes.mark(&format!("misprint: {misprint}")));
        let said = match (&verdict, figure, Printed::parse(&cell.printed)) {
            (Verdict::NotComparable(why), _, _) => format!("{}{}", verdict.word(), notes.mark(why)),
            (Verdict::Differs, ours, Some(printed)) if printed.value != 0.0 => {
                let ours = middle(table, cell, ours.as_ref()).unwrap_or(f64::NAN);
                format!("{}: {:.2} times", verdict.word(), ours / printed.value)
            }
            _ => verdict.word().to_owned(),
        };
        row.push(cell.kind.map_or_else(String::new, |kind| kind.word().to_owned()));
        rows.row(row.into_iter().chain([said + &misprint]));
    }
    let truth = if against_truth {
        " *True errors*: the same figure of errors against the truth (root mean square, or the ratio of root mean squares)."
    } else {
        ""
    };
    let experiments = table.experiments.as_ref().map_or_else(String::new, |experiments| {
        format!(
            " *{PLAUSIBLE}*: median, and where 95 % of {} experiments lie that could have been the paper's (see what was found out); where this is given, it decides and not our own network.",
            experiments.count()
        )
    });
    let text = format!(
        "Printed beside `{}`: its first trial, the mean of {trials} trials, and {SINGLE}; after \u{b1} stands half a 95 % interval. The paper is a single run: a cell \
         *reproduces* when it lies in that range, widened by half a unit of its last digit; where it *differs*, ours is so many times as large in the mean.{truth}{experiments}\n\n{}\n{}{}\n\n",
        table.scenario,
        rows.render(),
        notes.render(),
        tally.sentence()
    );
    (text, tally)
}

/// The verdict of `cell`, given our figure or none: plausible experiments come first where the table has them.
pub fn verdict(table: &Table, cell: &Cell, ours: Option<&Ours>) -> Verdict {
    if let Some(range) = plausible(table, cell) {
        return cell.verdict_between(range.low, range.high);
    }
    match (&cell.not_comparable, ours) {
        (Some(why), _) => Verdict::NotComparable(why.clone()),
        (None, None) => Verdict::NotComparable("no record of ours".to_owned()),
        (None, Some(ours)) => {
            ours.range.map_or_else(|| cell.verdict_between(ours.one, ours.one), |range| cell.verdict_between(range.low, range.high))
        }
    }
}

/// Our figure for `cell`: the median of plausible experiments, or the mean of our trials.
pub fn middle(table: &Table, cell: &Cell, ours: Option<&Ours>) -> Option<f64> {
    plausible(table, cell).map(|range| range.median).or(ours.map(|ours| ours.mean))
}

fn plausible(table: &Table, cell: &Cell) -> Option<Range> {
    table.experiments.as_ref()?.range(cell.predicted.as_ref()?)
}

/// A fraction's largest denominator comes first, as its value is the least.
fn ranged(cell: &Cell, Range { median, low, high }: Range) -> String {
    format!("{} ({} to {})", like(cell, median), like(cell, low), like(cell, high))
}

fn cells(cell: &Cell, ours: &Ours) -> Vec<String> {
    let text = |value: f64| like(cell, value);
    let with_half = |value: f64, half: Option<f64>| match half {
        Some(half) => format!("{} \u{b1} {}", text(value), spread(cell, value, half)),
        None => text(value),
    };
    let truth = ours.truth.map_or_else(String::new, |(value, half)| with_half(value, half));
    let range = ours.range.map_or_else(|| "none".to_owned(), |range| format!("{} to {}", text(range.low), text(range.high)));
    vec![text(ours.one), with_half(ours.mean, ours.half), range, truth]
}

/// In the form of the printed figure, with one digit more.
fn like(cell: &Cell, value: f64) -> String {
    if cell.printed.contains('/') {
        return if value > 0.0 { format!("1/{:.0}", 1.0 / value) } else { "0".to_owned() };
    }
    let digits = Printed::parse(&cell.printed).map_or(4, |printed| (-printed.unit.log10()).round() as usize + 1);
    fixed(value, digits)
}

/// A half interval: of a fraction, that of its denominator.
fn spread(cell: &Cell, value: f64, half: f64) -> String {
    if cell.printed.contains('/') { format!("{:.0}", half / (value * value)) } else { like(cell, half) }
}

#[cfg(test)]
mod tests {

    use super::super::Metric;
    use super::*;

    fn cell(printed: &str) -> Cell {
        Cell::bare(printed, Metric::MeanDx)
    }

    fn table(cells: Vec<Cell>) -> Table {
        Table { cells, ..Table::bare() }
    }

    const RANGE: Range = Range { median: 2.4, low: 1.52, high: 3.48 };
    const OURS: Ours = Ours { one: 2.0, mean: 2.5, half: Some(0.25), range: Some(RANGE), truth: Some((3.0, None)) };

    #[test]
    fn print_is_a_single_run() {
        assert_eq!(cells(&cell("1.0"), &OURS), ["2.00", "2.50 \u{b1} 0.25", "1.52 to 3.48", "3.00"]);
        assert_eq!(cells(&cell("4"), &Ours { half: None, range: None, truth: None, ..OURS }), ["2.0", "2.5", "none", ""]);
        for (printed, expected) in
            [("1.5", Verdict::Reproduces), ("1.4", Verdict::Differs), ("3.5", Verdict::Reproduces), ("3.6", Verdict::Differs)]
        {
            assert_eq!(verdict(&table(Vec::new()), &cell(printed), Some(&OURS)), expected, "{printed}");
        }
        assert_eq!(
            verdict(&table(Vec::new()), &cell("2.4"), Some(&Ours { range: None, ..OURS })),
            Verdict::Differs,
            "one run has no range"
        );
        assert_eq!(verdict(&table(Vec::new()), &cell("2.4"), None), Verdict::NotComparable("no record of ours".into()));
    }

    /// Errors of single runs are skewed: 0.01 px in nine of ten, 0.05 in the tenth, with a mean of 0.014 and a deviation of 0.012. Of two deviations either way -0.002 and 0.036 would
    /// reproduce; no run is below 0.01, and one in ten is at 0.05.
    #[test]
    fn single_runs_are_judged_by_their_quantiles() {
        let runs: Vec<f64> = (0..100).map(|run| if run % 10 == 0 { 0.05 } else { 0.01 }).collect();
        let ours = Ours::of(&runs).unwrap();
        let of = |printed: &str| verdict(&table(Vec::new()), &cell(printed), Some(&ours));
        assert_eq!(
            [of("-0.002"), of("0.004"), of("0.010"), of("0.050")].map(|verdict| verdict.word()),
            ["differs", "differs", "reproduces", "reproduces"]
        );
        assert_eq!(cells(&cell("0.010"), &ours)[2], "0.0100 to 0.0500");
    }

    /// 1/4 px within 0.05: of the denominator that is 0.05 / (1/4)^2 = 0.8.
    #[test]
    fn fractions_are_told_by_their_denominators() {
        let of = cell("1/18.9");
        assert_eq!(
            (like(&of, 0.25), like(&of, 0.0), like(&of, -1.0), spread(&of, 0.25, 0.05)),
            ("1/4".into(), "0".into(), "0".into(), "1".into())
        );
        assert_eq!((spread(&of, 0.5, 1.0), spread(&cell("0.30"), 0.5, 0.125)), ("4".into(), "0.125".into()));
        assert_eq!(
            (like(&cell("22.520"), 1.0), like(&cell("7"), 1.0), like(&cell("?"), 1.0)),
            ("1.0000".into(), "1.0".into(), "1.0000".into())
        );
    }

    #[test]
    fn a_cell_that_differs_is_told_how_many_times() {
        let table = table(vec![cell("10"), cell("0.0"), Cell { misprint: Some("read 2".into()), ..cell("2.0") }, cell("9")]);
        let figures = [Some(OURS), Some(OURS), Some(OURS), None];
        let (text, tally) = comparison(&table, &figures, 3);
        let said: Vec<Vec<&str>> = text
            .lines()
            .filter(|line| line.starts_with("| r"))
            .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
            .collect();
        let last: Vec<&str> = said.iter().filter(|row| row[0] == "r").map(|row| *row.last().unwrap()).collect();
        assert_eq!(last, ["differs: 0.25 times", "differs", "reproduces (a)", "not comparable (b)"]);
        assert_eq!((tally, said[1].len()), (Tally { reproduce: 1, differ: 2, not_comparable: 1, ..Tally::default() }, 9));
        assert!(text.contains("- (a) misprint: read 2\n- (b) no record of ours\n") && text.contains("the mean of 3 trials"), "{text}");
        let (text, _) = comparison(&table, &[Some(Ours { truth: None, ..OURS }), None, None, None], 3);
        assert!(!text.to_lowercase().contains("true errors") && text.contains("| none "), "{text}");
    }

    /// Of 0, 1, ..., 78, 95 % lie from 1 to 77: these decide where a cell names their column, and our own runs elsewhere.
    #[test]
    fn plausible_experiments_decide_where_there_are_some() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("e.csv");
        std::fs::write(&path, (0..79).fold("a\n".to_owned(), |text, value| format!("{text}{value}\n"))).unwrap();
        let of = |printed: &str| Cell { predicted: Some("a".into()), ..cell(printed) };
        let cells =
            vec![of("77.0"), of("77.6"), of("0.9"), of("160"), cell("2.5"), Cell { not_comparable: Some("put in".into()), ..of("20") }];
        let table = Table { experiments: Some(super::super::Ensemble::read(&path).unwrap()), ..table(cells) };
        let (text, tally) = comparison(&table, &[Some(OURS); 6], 3);
        let ends: Vec<&str> =
            text.lines().filter(|line| line.starts_with("| r")).skip(1).filter_map(|line| line.split("| ").nth(8)).map(str::trim).collect();
        let expected =
            ["39.00 (1.00 to 77.00)", "39.00 (1.00 to 77.00)", "39.00 (1.00 to 77.00)", "39.0 (1.0 to 77.0)", "", "39.0 (1.0 to 77.0)"];
        assert_eq!(ends, expected, "{text}");
        assert_eq!(tally, Tally { reproduce: 2, differ: 3, not_comparable: 1, ..Tally::default() }, "{text}");
        assert!(text.contains("differs: 0.24 times") && text.contains("95 % of 79 experiments"), "{text}");
    }
}
