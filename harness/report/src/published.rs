//! What papers printed, and which of our figures stands behind each cell.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use calibench_diagnostics::{Problem, Problems};
use serde::Deserialize;
use thiserror::Error;

/// A published table: `reference/published/<paper>/table-N.toml`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Its number and title.
    pub title: String,
    /// Paper, section, page.
    pub source: String,
    /// The unit of its figures.
    pub unit: String,
    /// The scenario whose records stand behind the cells.
    pub scenario: String,
    /// The method whose records stand behind the cells.
    pub method: String,
    /// The columns, in their order.
    pub columns: Vec<String>,
    /// What was found out about the table, as paragraphs of Markdown.
    #[serde(default)]
    pub findings: Vec<String>,
    /// Other scenarios that are shown beside it.
    #[serde(default)]
    pub beside: Vec<String>,
    /// The sets of targets over which statistics are shown for every method.
    #[serde(default, rename = "set")]
    pub sets: Vec<TargetSet>,
    /// The printed cells.
    #[serde(rename = "cell")]
    pub cells: Vec<Cell>,
}

/// A named choice of targets.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TargetSet {
    /// Its name in the report.
    pub name: String,
    /// The targets that are left out.
    #[serde(default)]
    pub except: Vec<String>,
}

/// A printed figure.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cell {
    /// Its row.
    pub row: String,
    /// Its column.
    pub column: String,
    /// As printed, to the letter: `22.520`, `1/18.9`.
    pub printed: String,
    /// Which of our figures is meant.
    pub metric: Metric,
    /// The one target, for coordinates; otherwise all.
    #[serde(default)]
    pub target: Option<String>,
    /// Targets left out of a statistic.
    #[serde(default)]
    pub except: Vec<String>,
    /// Added to our error to give what was printed: the true coordinate in the paper's own image.
    #[serde(default)]
    pub plus: f64,
    /// Which cell of a sweep is meant: the value of each key that is swept.
    #[serde(default)]
    pub at: BTreeMap<String, f64>,
    /// What is wrong in print, if anything is: what it must have been.
    #[serde(default)]
    pub misprint: Option<String>,
    /// The method, where it is not the table's: for figures of adjustments.
    #[serde(default)]
    pub method: Option<String>,
    /// The parameter, for figures of adjustments.
    #[serde(default)]
    pub of: Option<String>,
    /// Why the two cannot be compared, if so.
    #[serde(default)]
    pub not_comparable: Option<String>,
}

/// A figure of ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Metric {
    /// Measured x of one target.
    X,
    /// Measured y of one target.
    Y,
    /// Error in x of one target.
    Dx,
    /// Error in y of one target.
    Dy,
    /// Distance of one target from its true position.
    Distance,
    /// Mean error in x.
    MeanDx,
    /// Mean error in y.
    MeanDy,
    /// Root mean square error in x.
    RmseX,
    /// Root mean square error in y.
    RmseY,
    /// Mean distance from the truth.
    MeanDistance,
    /// Root mean square distance from the truth.
    RmseXy,
    /// None of ours: what is printed stands alone.
    Unscored,
    /// Of an adjustment: a parameter of the interior orientation.
    IopValue,
    /// Of an adjustment: its reported standard deviation.
    IopSigma,
    /// The same, in pixels.
    IopSigmaPx,
    /// Its reported standard deviation over that of the reference method.
    SigmaRatio,
    /// The mean of these over all parameters.
    MeanSigmaRatio,
    /// Planimetric RMSE of check points over their mean distance.
    RelativeXy,
    /// Altimetric RMSE of check points over their mean distance.
    RelativeZ,
    /// Planimetric RMSE over that of the reference method.
    RelativeXyRatio,
    /// Altimetric RMSE over that of the reference method.
    RelativeZRatio,
}

impl Metric {
    /// Is it a figure of one target?
    pub fn is_of_one_target(self) -> bool {
        matches!(self, Self::X | Self::Y | Self::Dx | Self::Dy | Self::Distance)
    }

    /// Is it a figure of adjustments?
    pub fn is_of_adjustment(self) -> bool {
        use Metric::{IopSigma, IopSigmaPx, IopValue, MeanSigmaRatio, RelativeXy, RelativeXyRatio, RelativeZ, RelativeZRatio, SigmaRatio};
        matches!(
            self,
            IopValue | IopSigma | IopSigmaPx | SigmaRatio | MeanSigmaRatio | RelativeXy | RelativeZ | RelativeXyRatio | RelativeZRatio
        )
    }

    /// By how many units of the last digit ours may differ: a coordinate is rounded once; what is computed from rounded figures, once more.
    pub fn units(self) -> f64 {
        if matches!(self, Self::X | Self::Y) { 0.5 } else { 1.0 }
    }
}

/// A printed number: its value and one unit of its last digit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Printed {
    /// Its value.
    pub value: f64,
    /// One unit of the last digit.
    pub unit: f64,
}

impl Printed {
    /// Reads `22.520` or a fraction `1/18.9`; `None` for anything else.
    pub fn parse(text: &str) -> Option<Self> {
        let decimal = |text: &str| {
            let value: f64 = text.parse().ok().filter(|v: &f64| v.is_finite())?;
            let digits = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
            Some((value, 10_f64.powi(-(digits as i32))))
        };
        match text.split_once('/') {
            None => decimal(text).map(|(value, unit)| Self { value, unit }),
            Some((one, below)) => {
                let ((numerator, _), (denominator, unit)) = (decimal(one)?, decimal(below)?);
                let value = numerator / denominator;
                (denominator > unit).then(|| Self { value, unit: (numerator / (denominator - unit) - value).abs() })
            }
        }
    }
}

/// How ours compares with a printed cell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Within half a unit of the last printed digit for a coordinate, within one for what is computed from rounded figures.
    Reproduces,
    /// Further off.
    Differs,
    /// Not the same thing, and why.
    NotComparable(String),
}

impl Cell {
    /// Compares `ours` with this cell.
    pub fn verdict(&self, ours: Option<f64>) -> Verdict {
        if let Some(why) = &self.not_comparable {
            return Verdict::NotComparable(why.clone());
        }
        match (Printed::parse(&self.printed), ours) {
            (None, _) => Verdict::NotComparable("the printed figure cannot be read".into()),
            (_, None) => Verdict::NotComparable("no record of ours".into()),
            // Rounding of the decimal text itself must not decide.
            (Some(printed), Some(ours)) if (ours - printed.value).abs() <= printed.unit * self.metric.units() * (1.0 + 1e-6) => {
                Verdict::Reproduces
            }
            _ => Verdict::Differs,
        }
    }
}

impl Cell {
    /// Compares a printed figure of a single run with the mean of many: it reproduces within `range` of `mean`, widened by half a unit of its last digit.
    pub fn verdict_within(&self, mean: f64, range: f64) -> Verdict {
        match (&self.not_comparable, Printed::parse(&self.printed)) {
            (Some(why), _) => Verdict::NotComparable(why.clone()),
            (None, None) => Verdict::NotComparable("the printed figure cannot be read".into()),
            (None, Some(printed)) if (mean - printed.value).abs() <= range + 0.5 * printed.unit => Verdict::Reproduces,
            _ => Verdict::Differs,
        }
    }
}

impl Table {
    /// Are its figures those of adjustments?
    pub fn is_of_adjustments(&self) -> bool {
        self.cells.iter().any(|cell| cell.metric.is_of_adjustment())
    }
}

/// A table that cannot be read.
#[derive(Debug, Error)]
pub enum PublishedError {
    /// The file or its folder.
    #[error("{}: {source}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Its text.
    #[error(transparent)]
    Problems(#[from] Problems),
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
        let text = fs::read_to_string(&path).map_err(|source| PublishedError::File { path: path.clone(), source })?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok((name, parse(&path.display().to_string(), &text)?))
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
        if cell.metric.is_of_one_target() != cell.target.is_some() {
            let message = format!("row `{}`: figures of one target have a `target`, statistics have none", cell.row);
            return Err(fail(Problem::new(place..place, message)));
        }
    }
    Ok(table)
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
            row: "1".into(),
            column: "x".into(),
            printed: printed.into(),
            metric: Metric::X,
            target: Some("1".into()),
            except: Vec::new(),
            plus: 0.0,
            at: BTreeMap::new(),
            misprint: None,
            method: None,
            of: None,
            not_comparable: why.map(str::to_owned),
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
}
