//! Tables of records as a person reads them: columns side by side, and once above them what is the same in every row.

use std::borrow::Cow;
use std::io::Read;

use calibench_model::escape;
use csv::StringRecord;

use crate::cells::RecordError;
use crate::errors::Errors;

/// The columns of one or more tables that are shown as one.
#[derive(Debug, Default)]
pub struct Layout {
    columns: Vec<Column>,
    rows: u64,
}

#[derive(Debug)]
struct Column {
    name: String,
    /// Of its widest cell, characters.
    width: usize,
    /// What stands in every row so far.
    same: Option<String>,
    /// Whether every cell is empty or begins as a number does.
    numeric: bool,
}

impl Column {
    fn new(name: &str) -> Self {
        Self { name: name.to_owned(), width: name.chars().count(), same: None, numeric: true }
    }

    fn add(&mut self, cell: &str, is_first: bool) {
        self.width = self.width.max(escape::name(cell).chars().count());
        let begins = cell.strip_prefix('-').unwrap_or(cell);
        self.numeric &= cell.is_empty() || begins.starts_with(|c: char| c.is_ascii_digit());
        if is_first {
            self.same = Some(cell.to_owned());
        } else if self.same.as_deref() != Some(cell) {
            self.same = None;
        }
    }

    fn padded(&self, cell: &str) -> String {
        let (cell, width) = (escape::name(cell), self.width);
        if self.numeric { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
    }
}

impl Layout {
    /// Takes a table's rows into account.
    ///
    /// # Errors
    /// What is no table, or has other columns than those before it.
    pub fn add(&mut self, table: impl Read) -> Result<(), RecordError> {
        let mut csv = csv::Reader::from_reader(table);
        let errors = Errors::of(csv.headers()?);
        let header = errors.header(csv.headers()?);
        if self.columns.is_empty() {
            self.columns = header.iter().map(Column::new).collect();
        }
        if header.iter().ne(self.columns.iter().map(|column| column.name.as_str())) {
            return Err(RecordError::Row { line: 1, problem: "other columns than in the cell before it".to_owned() });
        }
        let mut record = StringRecord::new();
        while csv.read_record(&mut record)? {
            for (column, cell) in self.columns.iter_mut().zip(errors.cells(&record)) {
                column.add(&cell, self.rows == 0);
            }
            self.rows += 1;
        }
        Ok(())
    }

    /// How many rows the tables have.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// What is the same in every row, a line each, and the names of the columns that are not.
    pub fn head(&self) -> Vec<String> {
        let same = |column: &Column| {
            let cell = column.same.as_deref().filter(|cell| !cell.is_empty())?;
            Some(format!("{}: {}", column.name, escape::name(cell)))
        };
        let mut lines: Vec<String> = self.columns.iter().filter_map(same).collect();
        if !lines.is_empty() {
            lines.push(String::new());
        }
        lines.push(self.line(self.columns.iter().map(|column| Cow::Borrowed(column.name.as_str()))));
        lines
    }

    /// The rows of one of the tables, a line each.
    ///
    /// # Errors
    /// What is no table.
    pub fn lines<R: Read>(&self, table: R) -> impl Iterator<Item = Result<String, RecordError>> + use<'_, R> {
        let mut csv = csv::Reader::from_reader(table);
        let errors = csv.headers().map(Errors::of).unwrap_or_default();
        csv.into_records().map(move |record| Ok(self.line(errors.cells(&record?))))
    }

    fn line<'a>(&self, cells: impl IntoIterator<Item = Cow<'a, str>>) -> String {
        let shown = self.columns.iter().zip(cells).filter(|(column, _)| column.same.is_none());
        let cells: Vec<String> = shown.map(|(column, cell)| column.padded(&cell)).collect();
        cells.join("  ").trim_end().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIRST: &str = "scenario,trial,target,x,unit,reason\ns,0,a,1.25,px,\ns,0,\"b, c\",-12.5,px,\ns,10,-,,px,\n";

    fn shown(tables: &[&str]) -> Vec<String> {
        let mut layout = Layout::default();
        tables.iter().for_each(|table| layout.add(table.as_bytes()).unwrap());
        let rows = tables.iter().flat_map(|table| layout.lines(table.as_bytes()).map(Result::unwrap).collect::<Vec<_>>());
        layout.head().into_iter().chain(rows).collect()
    }

    #[test]
    fn what_is_the_same_in_every_row_stands_above() {
        let expected = ["scenario: s", "unit: px", "", "trial  target      x", "    0  a        1.25", "    0  b, c    -12.5", "   10  -"];
        assert_eq!(shown(&[FIRST]), expected);
    }

    #[test]
    fn a_person_reads_errors_in_place_of_true_positions() {
        let points = "target,x,y,x_true,y_true,status\na,10.3,20.5,10.1,21.5,measured\nb,1.5,2.5,,,measured\nc,,,,,rejected\n";
        let expected = [
            "target     x     y   dx  dy  status",
            "a       10.3  20.5  0.2  -1  measured",
            "b        1.5   2.5           measured",
            "c                            rejected",
        ];
        assert_eq!(shown(&[points]), expected);
    }

    #[test]
    fn several_tables_are_one() {
        let second = FIRST.replace("s,0,a,1.25", "other,0,a,100.125");
        let lines = shown(&[FIRST, &second]);
        assert_eq!(lines[..3], ["unit: px", "", "scenario  trial  target        x"]);
        assert_eq!((lines.len(), lines[6].as_str()), (9, "other         0  a       100.125"));
        let mut layout = Layout::default();
        layout.add(FIRST.as_bytes()).unwrap();
        assert_eq!(layout.rows(), 3);
        let problem = layout.add(&b"scenario,trial\ns,0\n"[..]).unwrap_err().to_string();
        assert!(problem.contains("other columns"), "{problem}");
    }

    #[test]
    fn a_name_does_not_command_the_terminal() {
        let lines = shown(&["a,b\n1,\u{1b}[2J\n2,plain\n"]);
        assert_eq!(lines[1], "1  \\u{1b}[2J");
        assert_eq!(shown(&["a,b\n"]), ["a  b"]);
    }
}
