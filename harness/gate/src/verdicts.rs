//! The verdicts of published cells: what reproduced a printed figure when it was blessed, reproduces it now.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::baseline_file::{self, BaselineError, Head, HeadMethod, Kind};
use super::finding::{Finding, Verdict};

/// The name under which the verdicts of all tables stand in the head of their file.
const NAME: &str = "published tables";
/// How the verdict of a cell begins that reproduces what is printed.
const REPRODUCES: &str = "reproduces";
const COLUMNS: [&str; 4] = ["table", "row", "column", "verdict"];

/// The verdicts of all published cells: `reproduces`, `differs` or `not comparable`, the first two with their kind as in `reproduces (prediction)`, by table (`paper/table-1`), row and column.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Verdicts(pub BTreeMap<[String; 3], String>);

impl Verdicts {
    /// Where they are kept in the folder of baselines.
    pub fn path(folder: &Path) -> PathBuf {
        folder.join("published.verdicts.csv")
    }

    /// Writes the file, whole or not at all, and returns its checksum.
    ///
    /// # Errors
    /// What the file system refuses.
    pub fn write(&self, path: &Path) -> Result<String, BaselineError> {
        let mut head = Head::new(Kind::Verdicts, NAME, "", 0, "", Vec::new());
        let [label, version, settings, library] = [NAME, "", "", ""].map(str::to_owned);
        head.method = vec![HeadMethod { label, version, settings, library, rows: self.0.len() as u64 }];
        baseline_file::write(path, &head, &COLUMNS, self.0.iter().map(|(cell, verdict)| cell.iter().chain([verdict]).cloned().collect()))
    }

    /// Reads the file with its checksum; `None` when there is none.
    ///
    /// # Errors
    /// A file that is not to the letter what was written.
    pub fn read(path: &Path) -> Result<Option<(Self, String)>, BaselineError> {
        let Some(sheet) = baseline_file::read(path, Kind::Verdicts, &COLUMNS)? else { return Ok(None) };
        let mut all = Self::default();
        for row in sheet.rows() {
            let cell = [0, 1, 2].map(|column| row.text(column).to_owned());
            if all.0.insert(cell, row.text(3).to_owned()).is_some() {
                return Err(row.wrong(2, "the cell is there twice"));
            }
        }
        sheet.verify()?;
        Ok(Some((all, sheet.checksum)))
    }

    /// A cell that reproduces no more, or is not judged any more, fails; any other change is one, that of a kind too.
    pub fn compare(&self, now: &Self) -> Vec<Finding> {
        let mut findings = Vec::new();
        let new = |verdict, cell: &[String; 3], message: String| {
            Finding::new(verdict, &cell[0], "", "published cell", message).at(format!("{}, {}", cell[1], cell[2]))
        };
        for (cell, old) in &self.0 {
            match now.0.get(cell) {
                None => findings.push(new(Verdict::Fails, cell, format!("the cell is missing; it was: {old}"))),
                Some(word) if word != old => {
                    let falls = |word: &str| !word.starts_with(REPRODUCES);
                    let worse = (falls(word) && !falls(old)) || word.starts_with("not");
                    let verdict = if worse { Verdict::Fails } else { Verdict::Changed };
                    findings.push(new(verdict, cell, format!("was: {old}, is: {word}")));
                }
                Some(_) => {}
            }
        }
        for cell in now.0.keys().filter(|cell| !self.0.contains_key(*cell)) {
            findings.push(new(Verdict::Unblessed, cell, "not blessed yet".into()));
        }
        findings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdicts(words: &[&str]) -> Verdicts {
        let cell = |(row, word): (usize, &&str)| (["p/table-1".to_owned(), row.to_string(), "x".to_owned()], (*word).to_owned());
        Verdicts(words.iter().enumerate().map(cell).collect())
    }

    #[test]
    fn verdicts_are_read_as_they_were_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = Verdicts::path(folder.path());
        assert_eq!(Verdicts::read(&path).unwrap(), None);
        let all = verdicts(&[REPRODUCES, "differs"]);
        let sum = all.write(&path).unwrap();
        assert_eq!(Verdicts::read(&path).unwrap(), Some((all, sum)));
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text.replace("differs", REPRODUCES)).unwrap();
        assert!(Verdicts::read(&path).unwrap_err().to_string().contains("was edited"));
    }

    #[test]
    fn a_cell_that_reproduces_no_more_fails() {
        let of = |old: &str, new: &[&str]| verdicts(&[old]).compare(&verdicts(new)).iter().map(|f| f.verdict).collect::<Vec<_>>();
        assert_eq!(of(REPRODUCES, &[REPRODUCES]), []);
        assert_eq!(of(REPRODUCES, &["differs"]), [Verdict::Fails]);
        assert_eq!(of("differs", &["not comparable"]), [Verdict::Fails]);
        assert_eq!(of("differs", &[REPRODUCES]), [Verdict::Changed]);
        assert_eq!(of(REPRODUCES, &[]), [Verdict::Fails]);
        let [searched, predicted] = ["reproduces (reconstruction)", "reproduces (prediction)"];
        assert_eq!(of(searched, &[predicted]), [Verdict::Changed], "what is called a prediction from now on is blessed as one");
        assert_eq!(of(searched, &["differs (reconstruction)"]), [Verdict::Fails]);
        assert_eq!(of(REPRODUCES, &[REPRODUCES, "differs"]), [Verdict::Unblessed]);
    }
}
