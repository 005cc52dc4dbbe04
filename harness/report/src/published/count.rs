//! How many printed figures of a paper come out, by kind: each counted once, however many cells compare it.

use std::collections::BTreeMap;

use super::{Kind, Place, Table, Verdict};

/// Printed figures, each with the verdict that counts.
#[derive(Debug, Default)]
pub struct Figures(BTreeMap<Place, (Option<Kind>, bool)>);

/// How many figures come out, and how many do not, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// In the order of [`Kind::COUNTED`]: those that reproduce or are consistent, and those that are not.
    pub judged: [(usize, usize); 4],
    /// Those that nothing of ours can be compared with.
    pub not_comparable: usize,
}

impl Figures {
    /// Adds the verdicts of the cells of the table in the file `name`. Of the verdicts on one figure that of the kind with most evidence counts, and of these the gravest.
    pub fn add(&mut self, name: &str, table: &Table, verdicts: &[Verdict]) {
        // Words are no figures.
        let figures = table.cells.iter().zip(verdicts).filter(|(cell, _)| cell.printed.contains(|c: char| c.is_ascii_digit()));
        for (cell, verdict) in figures {
            let own = || Place { table: name.to_owned(), row: cell.row.clone(), column: cell.column.clone() };
            let place = cell.same_as.clone().unwrap_or_else(own);
            let kind = cell.kind.filter(|_| !matches!(verdict, Verdict::NotComparable(_)));
            let fails = matches!(verdict, Verdict::Differs | Verdict::Inconsistent);
            let known = self.0.entry(place).or_insert((kind, fails));
            *known = (*known).max((kind, fails));
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Of all tables, or of the one in the file `name`.
    pub fn counts(&self, name: Option<&str>) -> Counts {
        let mut counts = Counts::default();
        for (place, (kind, fails)) in &self.0 {
            if name.is_some_and(|name| name != place.table) {
                continue;
            }
            match kind.and_then(|kind| Kind::COUNTED.iter().position(|counted| *counted == kind)) {
                None => counts.not_comparable += 1,
                Some(index) if *fails => counts.judged[index].1 += 1,
                Some(index) => counts.judged[index].0 += 1,
            }
        }
        counts
    }
}

impl Counts {
    /// All figures.
    pub fn all(&self) -> usize {
        self.not_comparable + self.judged.iter().map(|(comes, fails)| comes + fails).sum::<usize>()
    }

    /// Predictions first, the others beside them, as in "Of 9 printed figures none is a prediction. Of 4 consequences of fitted figures 3 come out; 5 are not comparable."
    pub fn sentence(&self) -> String {
        let [(comes, fails), others @ ..] = self.judged;
        let predicted = match comes + fails {
            0 => "none is a prediction".to_owned(),
            1 => format!("one is a prediction, and {}", if comes == 1 { "comes out" } else { "does not come out" }),
            all => format!("{all} are predictions, of which {comes} come out"),
        };
        let names = ["consequences of fitted figures", "reconstructions", "definitions and arithmetic"];
        let told = names.iter().zip(others).filter(|(_, (comes, fails))| comes + fails > 0);
        let mut told = told.map(|(name, (comes, fails))| format!("of {} {name} {comes}", comes + fails));
        let first = told.next().map_or_else(String::new, |first| format!(". O{} come out", &first[1..]));
        let rest: String = told.map(|more| format!(", {more}")).collect();
        format!("Of {} printed figures {predicted}{first}{rest}; {} are not comparable.", self.all(), self.not_comparable)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Cell, Metric};
    use super::*;
    use Verdict::{Consistent, Differs, NotComparable, Reproduces};

    fn cell(row: &str, kind: Kind, same_as: Option<&str>) -> Cell {
        let place = |row: &str| Place { table: "t".into(), row: row.into(), column: "c".into() };
        Cell { row: row.into(), kind: Some(kind), same_as: same_as.map(place), ..Cell::bare("1", Metric::Figure) }
    }

    fn counts(cells: Vec<(Cell, Verdict)>) -> Counts {
        let (cells, verdicts): (Vec<Cell>, Vec<Verdict>) = cells.into_iter().unzip();
        let mut figures = Figures::default();
        figures.add("t", &Table { cells, ..Table::bare() }, &verdicts);
        figures.counts(None)
    }

    /// The referee's case: one printed figure, five verdicts.
    #[test]
    fn a_printed_figure_is_counted_once() {
        let once = counts(vec![
            (cell("a", Kind::Definition, None), Differs),
            (cell("b", Kind::Reconstruction, Some("a")), Reproduces),
            (cell("c", Kind::Reconstruction, Some("a")), Consistent),
            (cell("d", Kind::Input, Some("a")), NotComparable("put in".into())),
            (cell("e", Kind::Definition, Some("a")), Reproduces),
        ]);
        assert_eq!((once.all(), once.judged), (1, [(0, 0), (0, 0), (1, 0), (0, 0)]));
        let gravest = counts(vec![(cell("a", Kind::Definition, None), Reproduces), (cell("b", Kind::Definition, Some("a")), Differs)]);
        assert_eq!(gravest.judged[3], (0, 1), "of one kind the gravest counts");
    }

    #[test]
    fn what_cannot_be_compared_counts_for_no_kind() {
        let why = || NotComparable("free".into());
        let found = counts(vec![
            (cell("a", Kind::Prediction, None), why()),
            (cell("b", Kind::Prediction, None), Reproduces),
            (cell("c", Kind::Consequence, None), Differs),
            (cell("d", Kind::Prediction, None), Differs),
            (Cell { printed: "large resemblances".into(), ..cell("e", Kind::Prediction, None) }, why()),
        ]);
        assert_eq!((found.judged, found.not_comparable), ([(1, 1), (0, 1), (0, 0), (0, 0)], 1));
        let said = "Of 4 printed figures 2 are predictions, of which 1 come out. Of 1 consequences of fitted figures 0 come out; 1 are not comparable.";
        assert_eq!(found.sentence(), said);
        assert!(
            counts(vec![(cell("a", Kind::Definition, None), Reproduces)])
                .sentence()
                .contains("none is a prediction. Of 1 definitions and arithmetic 1 come out; 0 are")
        );
    }
}
