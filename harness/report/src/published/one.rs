//! A published table beside one run of ours.

use super::figure::of_points;
use super::notes::Notes;
use super::{Cell, Kind, Printed, Table, Tally, Verdict};
use crate::load::Loaded;
use crate::markdown::{MarkdownTable, fixed, fraction};

/// What is told where a model predicts.
const CONSISTENT: &str = " Where ours is predicted by a model that was fitted to other printed figures, a cell is *consistent* within what its table allows for the model's own \
                          misfit, and *inconsistent* beyond.";

/// The table beside the first trial, one row of print a row; `ours` holds our figure for every cell or none.
///
/// Where `named`, a verdict names the columns that it holds for, unless it holds for all of its row.
pub fn comparison(table: &Table, ours: &[Option<f64>], named: bool) -> (String, Tally) {
    let mut header = vec!["row".to_owned()];
    for column in &table.columns {
        header.extend([format!("{column} printed"), format!("{column} ours")]);
    }
    header.extend(["kind", "verdict"].map(str::to_owned));
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    let (mut tally, mut notes) = (Tally::default(), Notes::default());
    for label in table.rows() {
        let mut cells = vec![label.to_owned()];
        let (mut verdicts, mut misprints, mut kinds) = (Vec::new(), String::new(), Vec::new());
        for column in &table.columns {
            let of = |(cell, _): &(&Cell, &Option<f64>)| cell.row == label && cell.column == *column;
            let Some((cell, &ours)) = table.cells.iter().zip(ours).find(of) else {
                cells.extend([String::new(), String::new()]);
                continue;
            };
            let verdict = cell.verdict(ours);
            tally.count(&verdict);
            kinds.push(cell.kind);
            cells.extend([cell.printed.clone(), ours.map_or("none".to_owned(), |value| like(cell, value))]);
            verdicts.push((column.as_str(), verdict));
            if let Some(misprint) = &cell.misprint {
                misprints.push_str(&notes.mark(&format!("misprint in {column}: {misprint}")));
            }
        }
        let columns = if named { columns_of_gravest(&verdicts) } else { String::new() };
        let verdicts = verdicts.into_iter().map(|(_, verdict)| verdict).collect();
        cells.extend([words(&kinds), gravest(verdicts, &mut notes) + &columns + &misprints]);
        rows.row(cells);
    }
    let text = format!(
        "Printed beside ours (`{}`, `{}`). A coordinate *reproduces* when ours is within half a unit of the last printed digit; what the paper computed from rounded \
         figures, within one unit.{} A row has the verdict of its gravest cell.\n\n{}\n{}{}\n\n",
        table.method,
        table.scenario,
        if tally.consistent + tally.inconsistent > 0 { CONSISTENT } else { "" },
        rows.render(),
        notes.render(),
        tally.sentence()
    );
    (text, tally)
}

/// Our figure for `cell` in the first trial.
pub fn figure(table: &Table, main: &Loaded, cell: &Cell) -> Option<f64> {
    let method = main.method(cell.method.as_deref().unwrap_or(&table.method))?;
    of_points(&main.first.points, method, cell.metric, cell.target.as_deref(), &cell.except).map(|ours| ours + cell.plus)
}

/// The kinds of a row's cells, each once.
pub fn words(kinds: &[Option<Kind>]) -> String {
    let mut words: Vec<&str> = Vec::new();
    for word in kinds.iter().flatten().map(|kind| kind.word()) {
        if !words.contains(&word) {
            words.push(word);
        }
    }
    words.join(", ")
}

/// The columns of the gravest verdicts of a row, as in ": x, y"; nothing where all are as grave.
fn columns_of_gravest(verdicts: &[(&str, Verdict)]) -> String {
    let gravest = verdicts.iter().map(|(_, verdict)| verdict.gravity()).max();
    let of: Vec<&str> = verdicts.iter().filter(|(_, verdict)| Some(verdict.gravity()) == gravest).map(|(column, _)| *column).collect();
    if of.len() == verdicts.len() { String::new() } else { format!(": {}", of.join(", ")) }
}

/// The gravest of some cells' verdicts in words; its reason goes below the table.
pub fn gravest(verdicts: Vec<Verdict>, notes: &mut Notes) -> String {
    let Some(gravest) = verdicts.into_iter().max_by_key(Verdict::gravity) else { return String::new() };
    let why = if let Verdict::NotComparable(why) = &gravest { notes.mark(why) } else { String::new() };
    gravest.word().to_owned() + &why
}

/// Ours with one digit more than printed, in the form of the printed figure.
pub fn like(cell: &Cell, value: f64) -> String {
    if cell.printed.contains('/') {
        return fraction(value);
    }
    let digits = Printed::parse(&cell.printed).map_or(4, |printed| (-printed.unit.log10()).round() as usize + 1);
    fixed(value, digits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_judged_by_its_gravest_cell() {
        use Verdict::{Differs, NotComparable, Reproduces};
        let of = |verdicts: &[Verdict]| gravest(verdicts.to_vec(), &mut Notes::default());
        let why = || NotComparable("another axis".into());
        assert_eq!(of(&[]), "");
        assert_eq!(of(&[Reproduces, Reproduces]), "reproduces");
        assert_eq!(of(&[Reproduces, Differs, Reproduces]), "differs");
        assert_eq!(of(&[why(), Differs, Reproduces]), "differs");
        assert_eq!(of(&[Reproduces, why()]), "not comparable (a)");
    }

    #[test]
    fn a_row_names_the_columns_of_its_gravest_verdicts_unless_all_are_as_grave() {
        use Verdict::{Consistent, Differs, Inconsistent, Reproduces};
        let of = |verdicts: &[(&str, Verdict)]| columns_of_gravest(verdicts);
        assert_eq!(of(&[("x", Reproduces), ("y", Differs), ("z", Inconsistent)]), ": y, z");
        assert_eq!(of(&[("x", Reproduces), ("y", Consistent)]) + &of(&[("x", Differs)]) + &of(&[]), "");
    }

    #[test]
    fn ours_has_one_digit_more_than_print() {
        let cell = |printed: &str| Cell::bare(printed, super::super::Metric::X);
        let found = ["22.52", "-7", "1/18.9", "?"].map(|printed| like(&cell(printed), 0.25));
        assert_eq!(found, ["0.250", "0.2", "1/4.0", "0.2500"]);
    }
}
