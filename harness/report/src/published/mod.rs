//! What papers printed, and which of our figures stands behind each cell.

pub(crate) mod adjustment;
mod ensemble;
mod every_method;
mod figure;
mod many;
mod metric;
mod notes;
mod one;
mod schema;
mod section;
mod sweep;
mod verdict;

pub use ensemble::{Ensemble, EnsembleError};
pub use metric::Metric;
pub use schema::schema;
pub(crate) use section::{section, verdicts, without_records};
pub(crate) use sweep::{section as swept, verdicts as swept_verdicts};
pub use verdict::{Printed, Tally, Verdict};

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use calibench_diagnostics::{Problem, Problems};
use schemars::JsonSchema;
use serde::Deserialize;
use thiserror::Error;

/// A published table: `reference/published/<paper>/table-N.toml`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Number and title, as printed.
    pub title: String,
    /// Paper, section, page.
    pub source: String,
    /// Unit of the printed figures.
    pub unit: String,
    /// The scenario whose records stand behind the cells, as in `galo-2011/corners`.
    pub scenario: String,
    /// The method behind the cells, by its label, as in `forstner:window=11`.
    pub method: String,
    /// The columns, in their order.
    pub columns: Vec<String>,
    /// What was found out about the table: paragraphs of Markdown.
    #[serde(default)]
    pub findings: Vec<String>,
    /// Other scenarios that are shown beside it.
    #[serde(default)]
    pub beside: Vec<String>,
    /// Sets of targets over which statistics are shown for every method. Default: all targets.
    #[serde(default, rename = "set")]
    pub sets: Vec<TargetSet>,
    /// A CSV file beside the table with the figures of many plausible experiments, where the paper does not tell which was its own; see `predicted` of cells.
    #[serde(default)]
    pub ensemble: Option<String>,
    /// The printed cells.
    #[serde(rename = "cell")]
    pub cells: Vec<Cell>,
    /// What `ensemble` holds.
    #[serde(skip)]
    pub experiments: Option<Ensemble>,
}

/// A named choice of targets.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TargetSet {
    /// Its name in the report.
    pub name: String,
    /// The targets that are left out.
    #[serde(default)]
    pub except: Vec<String>,
}

/// A printed figure.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cell {
    /// Its row.
    pub row: String,
    /// Its column.
    pub column: String,
    /// The figure as printed, to the letter: `22.520`, `-7`, `1/18.9`; any text where `not_comparable` says why.
    pub printed: String,
    /// Which of our figures is meant.
    pub metric: Metric,
    /// The target, for figures of one target: in the first image that shows it.
    #[serde(default)]
    pub target: Option<String>,
    /// Targets left out of a statistic.
    #[serde(default)]
    pub except: Vec<String>,
    /// Added to our figure to give what was printed, in its unit: a true coordinate, where the paper prints positions in an image of its own.
    #[serde(default)]
    pub plus: f64,
    /// Which cell of a sweep is meant: the value of each key that is swept.
    #[serde(default)]
    pub at: BTreeMap<String, f64>,
    /// What is wrong in print, and what it must have been.
    #[serde(default)]
    pub misprint: Option<String>,
    /// The method by its label, where it is not the table's.
    #[serde(default)]
    pub method: Option<String>,
    /// The parameter of the interior orientation, for figures of adjustments; `c` by default.
    #[serde(default)]
    pub of: Option<String>,
    /// The set of parameters or the block, for `figure`.
    #[serde(default)]
    pub set: Option<String>,
    /// The group of figures, for `figure`: `network` by default.
    #[serde(default)]
    pub group: Option<String>,
    /// What our `figure` is multiplied by: a length that was printed, where the figure is a scale. 1 by default.
    #[serde(default)]
    pub times: Option<f64>,
    /// What a `figure_ratio` is divided by.
    #[serde(default)]
    pub over: Option<Divisor>,
    /// The column of the table's `ensemble` that stands for the cell: what is printed must lie where 95 % of the experiments lie.
    #[serde(default)]
    pub predicted: Option<String>,
    /// By how many units of the last digit ours may differ, where the usual rule does not hold: 0.5 for counts.
    #[serde(default)]
    pub units: Option<f64>,
    /// How far ours may be from print, in its unit, where ours is predicted by a model that was fitted to other printed figures. The verdict is then
    /// *consistent* or *inconsistent*.
    #[serde(default)]
    pub consistent_within: Option<f64>,
    /// Why the two cannot be compared, if so.
    #[serde(default)]
    pub not_comparable: Option<String>,
}

/// The figure below a ratio; what is not given is that of the cell.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Divisor {
    /// The method by its label.
    #[serde(default)]
    pub method: Option<String>,
    /// The set of parameters or the block.
    #[serde(default)]
    pub set: Option<String>,
    /// The figure's name.
    #[serde(default)]
    pub of: Option<String>,
}

impl Table {
    /// Whether its figures are those of adjustments.
    pub fn is_of_adjustments(&self) -> bool {
        self.cells.iter().any(|cell| cell.metric.is_of_adjustment())
    }

    /// Whether any of its figures is one of measured points.
    pub fn is_of_points(&self) -> bool {
        self.cells.iter().any(|cell| !cell.metric.is_of_adjustment() && cell.metric != Metric::Unscored)
    }

    /// The labels of its rows, in their order, once each.
    fn rows(&self) -> Vec<&str> {
        let mut labels: Vec<&str> = Vec::new();
        for cell in &self.cells {
            if !labels.contains(&cell.row.as_str()) {
                labels.push(&cell.row);
            }
        }
        labels
    }

    /// Its sets of targets, or all targets where it names none.
    fn sets_or_all(&self) -> Vec<TargetSet> {
        if self.sets.is_empty() { vec![TargetSet { name: "all".to_owned(), except: Vec::new() }] } else { self.sets.clone() }
    }
}

/// A table that cannot be read.
#[derive(Debug, Error)]
pub enum PublishedError {
    /// The file or its folder.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Its text.
    #[error(transparent)]
    Problems(#[from] Problems),
    /// Its experiments.
    #[error(transparent)]
    Ensemble(#[from] EnsembleError),
}

/// All tables of `paper` below `folder` (`reference/published`), in the order of their file names, with these.
///
/// # Errors
/// A file that cannot be read or has a mistake.
pub fn tables(folder: &Path, paper: &str) -> Result<Vec<(String, Table)>, PublishedError> {
    let folder = folder.join(paper);
    let mut names: Vec<PathBuf> = match fs::read_dir(&folder) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Vec::new(),
        Err(source) => return Err(PublishedError::File { path: folder, source }),
        Ok(entries) => {
            entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|p| p.extension().is_some_and(|e| e == "toml")).collect()
        }
    };
    names.sort();
    let read = |path: PathBuf| {
        let text = calibench_files::bounded::text(&path).map_err(|source| PublishedError::File { path: path.clone(), source })?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut table = parse(&path.display().to_string(), &text)?;
        if let Some(file) = &table.ensemble {
            table.experiments = Some(Ensemble::read(&folder.join(file))?);
        }
        without_column(&table)
            .map_or(Ok(()), |problem| Err(Problems { file: path.display().to_string(), text: text.clone(), problems: vec![problem] }))?;
        Ok((name, table))
    };
    names.into_iter().map(read).collect()
}

/// The papers below `folder` that have tables, sorted.
pub fn papers(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    let mut names: Vec<String> = entries.filter(|e| e.path().is_dir()).filter_map(|e| e.file_name().into_string().ok()).collect();
    names.sort();
    names
}

fn parse(file: &str, text: &str) -> Result<Table, Problems> {
    let fail = |problem| Problems { file: file.to_owned(), text: text.to_owned(), problems: vec![problem] };
    let table: Table = toml::from_str(text).map_err(|e| fail(Problem::new(e.span().unwrap_or(0..0), e.message())))?;
    for (index, cell) in table.cells.iter().enumerate() {
        if table.cells[..index].iter().any(|other| (&other.row, &other.column) == (&cell.row, &cell.column)) {
            return Err(fail(Problem::new(0..0, format!("row `{}`, column `{}` is given twice", cell.row, cell.column))));
        }
        let place = text.find(&cell.printed).unwrap_or(0);
        if !table.columns.contains(&cell.column) {
            let message =
                format!("row `{}` has a cell in column `{}`, which is none of {}", cell.row, cell.column, table.columns.join(", "));
            return Err(fail(Problem::new(place..place, message).nearest(&cell.column, table.columns.iter().map(String::as_str))));
        }
        if Printed::parse(&cell.printed).is_none() && cell.not_comparable.is_none() {
            let message = format!("`{}` is no number: expected digits as in 22.520 or 1/18.9, or `not_comparable`", cell.printed);
            return Err(fail(Problem::new(place..place + cell.printed.len(), message)));
        }
        if let Some(message) = adjustment::unknown(cell) {
            return Err(fail(Problem::new(place..place, format!("row `{}`: {message}", cell.row))));
        }
        if cell.metric.is_of_one_target() != cell.target.is_some() {
            let message = format!("row `{}`: figures of one target have a `target`, statistics have none", cell.row);
            return Err(fail(Problem::new(place..place, message)));
        }
    }
    Ok(table)
}

/// The first cell that names a column which its table's experiments have not.
fn without_column(table: &Table) -> Option<Problem> {
    let named = |cell: &Cell| Some((cell.predicted.clone()?, format!("row `{}`, column `{}`", cell.row, cell.column)));
    let experiments = table.experiments.as_ref();
    let (column, cell) = table
        .cells
        .iter()
        .filter_map(named)
        .find(|(column, _)| experiments.is_none_or(|experiments| experiments.range(column).is_none()))?;
    let Some(experiments) = experiments else {
        return Some(Problem::new(0..0, format!("{cell}: `predicted` needs a table with an `ensemble`")));
    };
    let message = format!("{cell}: the `ensemble` has no column `{column}`");
    Some(Problem::new(0..0, message).nearest(&column, experiments.names()))
}

#[cfg(test)]
impl Cell {
    /// A cell of nothing but what is printed and what of ours it is compared with.
    pub(crate) fn bare(printed: &str, metric: Metric) -> Self {
        Self {
            row: "r".into(),
            column: "c".into(),
            printed: printed.into(),
            metric,
            target: None,
            except: Vec::new(),
            plus: 0.0,
            at: BTreeMap::new(),
            misprint: None,
            method: None,
            of: None,
            set: None,
            group: None,
            over: None,
            times: None,
            predicted: None,
            units: None,
            consistent_within: None,
            not_comparable: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_figures_carry_their_digits() {
        assert_eq!(Printed::parse("22.520"), Some(Printed { value: 22.52, unit: 0.001 }));
        assert_eq!(Printed::parse("-7"), Some(Printed { value: -7.0, unit: 1.0 }));
        let fraction = Printed::parse("1/18.9").unwrap();
        assert!((fraction.value - 1.0 / 18.9).abs() < 1e-15 && (fraction.unit - (1.0 / 18.8 - 1.0 / 18.9)).abs() < 1e-15);
        for bad in ["", "x", "1/0", "1/0.1", "NaN", "1/2/3"] {
            assert_eq!(Printed::parse(bad), None, "{bad}");
        }
    }

    #[test]
    fn a_coordinate_reproduces_within_half_a_unit_of_its_last_digit() {
        let cell = |printed: &str, why: Option<&str>| Cell {
            target: Some("1".into()),
            units: None,
            consistent_within: None,
            not_comparable: why.map(str::to_owned),
            ..Cell::bare(printed, Metric::X)
        };
        assert_eq!(cell("22.520", None).verdict(Some(22.5205)), Verdict::Reproduces);
        assert_eq!(cell("22.520", None).verdict(Some(22.520_51)), Verdict::Differs);
        let computed = Cell { metric: Metric::Dx, ..cell("0.020", None) };
        assert_eq!(computed.verdict(Some(0.021)), Verdict::Reproduces);
        assert_eq!(computed.verdict(Some(0.0211)), Verdict::Differs);
        assert!(matches!(cell("22.520", None).verdict(None), Verdict::NotComparable(_)));
        assert_eq!(cell("22.520", Some("other scale")).verdict(Some(22.52)), Verdict::NotComparable("other scale".into()));
    }

    #[test]
    fn mistakes_have_a_place() {
        let text = "title='t'\nsource='s'\nunit='px'\nscenario='a'\nmethod='m'\ncolumns=['C']\n[[cell]]\nrow='1'\ncolumn='D'\nprinted='2.5'\nmetric='x'\ntarget='1'\n";
        assert!(parse("t.toml", text).unwrap_err().to_string().contains("t.toml:10"));
        let text = text.replace("column='D'", "colum='C'");
        assert!(parse("t.toml", &text).unwrap_err().to_string().starts_with("t.toml:9:1: unknown field `colum`"));
    }

    #[test]
    fn tables_are_read_in_the_order_of_their_files() {
        let folder = tempfile::tempdir().unwrap();
        let paper = folder.path().join("paper");
        fs::create_dir(&paper).unwrap();
        let head = |title: &str| format!("title='{title}'\nsource='s'\nunit='px'\nscenario='a'\nmethod='m'\ncolumns=['C']\n");
        let text = |title: &str| head(title) + "[[cell]]\nrow='1'\ncolumn='C'\nprinted='2.5'\nmetric='mean_dx'\n";
        for (name, title) in [("table-2.toml", "second"), ("table-1.toml", "first"), ("notes.txt", "none")] {
            fs::write(paper.join(name), text(title)).unwrap();
        }
        let found = tables(folder.path(), "paper").unwrap();
        let names: Vec<(&str, &str)> = found.iter().map(|(name, table)| (name.as_str(), table.title.as_str())).collect();
        assert_eq!(names, [("table-1", "first"), ("table-2", "second")]);
        assert_eq!(papers(folder.path()), ["paper"]);
        assert!(tables(folder.path(), "absent").unwrap().is_empty() && papers(&folder.path().join("absent")).is_empty());
        fs::write(folder.path().join("file"), "").unwrap();
        assert!(matches!(tables(folder.path(), "file"), Err(PublishedError::File { .. })), "a folder that cannot be read is no empty one");
        assert_eq!(papers(folder.path()), ["paper"]);
    }

    #[test]
    fn cells_that_contradict_their_table_are_refused() {
        let head = "title='t'\nsource='s'\nunit='px'\nscenario='a'\nmethod='m'\ncolumns=['C', 'D']\n";
        let cell = |column: &str, printed: &str, rest: &str| format!("[[cell]]\nrow='1'\ncolumn='{column}'\nprinted='{printed}'\n{rest}\n");
        let read = |cells: &[String]| parse("t.toml", &(head.to_owned() + &cells.concat())).map_err(|problems| problems.to_string());
        let (mean, one) = ("metric='mean_dx'", "metric='x'\ntarget='7'");
        let table = read(&[
            cell("C", "2.5", mean),
            cell("D", "2.5", one),
            cell("D", "no", "metric='mean_dx'\nnot_comparable='text'").replace("row='1'", "row='2'"),
        ]);
        let table = table.unwrap();
        assert_eq!((table.rows(), table.is_of_adjustments()), (vec!["1", "2"], false));
        for (cells, expected) in [
            (vec![cell("C", "2.5", mean), cell("C", "2.5", mean)], "row `1`, column `C` is given twice"),
            (vec![cell("E", "2.5", mean)], "which is none of C, D"),
            (vec![cell("C", "many", mean)], "t.toml:10:10: `many` is no number"),
            (vec![cell("C", "2.5", "metric='x'")], "figures of one target have a `target`"),
            (vec![cell("C", "2.5", "metric='mean_dx'\ntarget='7'")], "statistics have none"),
        ] {
            let found = read(&cells).unwrap_err();
            assert!(found.contains(expected), "{found}");
        }
        let adjusted = read(&[cell("C", "2.5", mean), cell("D", "1", "metric='iop_value'")]).unwrap();
        assert!(adjusted.is_of_adjustments());
    }
}
