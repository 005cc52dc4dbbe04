//! Published tables, read from their files.

use std::fs;
use std::path::{Path, PathBuf};

use calibench_diagnostics::{Problem, Problems};

use super::{Cell, Ensemble, PublishedError, Table, rules};

/// What stands beside tables and is none.
pub const PREDICTIONS: &str = "predictions.toml";

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
            let is_table =
                |path: &PathBuf| path.extension().is_some_and(|e| e == "toml") && path.file_name().is_some_and(|name| name != PREDICTIONS);
            entries.filter_map(|entry| Some(entry.ok()?.path())).filter(is_table).collect()
        }
    };
    names.sort();
    let read = |path: PathBuf| -> Result<(String, Table), PublishedError> {
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
    let tables = names.into_iter().map(read).collect::<Result<Vec<_>, PublishedError>>()?;
    rules::counted_once(&folder, &tables)?;
    Ok(tables)
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
    let mut table: Table = toml::from_str(text).map_err(|e| fail(Problem::new(e.span().unwrap_or(0..0), e.message())))?;
    let touched: Vec<Option<String>> = table.cells.iter().map(|cell| Some(table.cause(cell)?.cause.clone())).collect();
    for (cell, cause) in table.cells.iter_mut().zip(touched) {
        cell.not_comparable = cell.not_comparable.take().or(cause);
    }
    rules::check(&table, text).map_err(fail)?;
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
mod tests {
    use super::super::{Metric, Printed, Verdict};
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
        let text = "title='t'\nsource='s'\nunit='px'\nscenario='a'\nmethod='m'\ncolumns=['C']\n[[cell]]\nrow='1'\ncolumn='D'\nprinted='2.5'\nmetric='x'\nkind='prediction'\ntarget='1'\n";
        assert!(parse("t.toml", text).unwrap_err().to_string().contains("t.toml:9:1: row `1` has a cell in column `D`"));
        let text = text.replace("column='D'", "colum='C'");
        assert!(parse("t.toml", &text).unwrap_err().to_string().starts_with("t.toml:9:1: unknown field `colum`"));
    }

    #[test]
    fn labels_of_older_tables_are_those_of_today() {
        let text = "title='t'\nsource='s'\nunit='px'\nscenario='a'\nmethod='lsm:window=13,neighbours=0'\ncolumns=['C']\n[[cell]]\nrow='1'\ncolumn='C'\nprinted='2.5'\nmetric='mean_dx'\nkind='prediction'\nmethod='lsm:window=15,shape=2'\n";
        let table = parse("t.toml", text).unwrap();
        assert_eq!(table.method, "lsm:window=13,neighbours=counted");
        assert_eq!(table.cells[0].method.as_deref(), Some("lsm:window=15,shape=chess_corner"));
    }

    #[test]
    fn tables_are_read_in_the_order_of_their_files() {
        let folder = tempfile::tempdir().unwrap();
        let paper = folder.path().join("paper");
        fs::create_dir(&paper).unwrap();
        let head = |title: &str| format!("title='{title}'\nsource='s'\nunit='px'\nscenario='a'\nmethod='m'\ncolumns=['C']\n");
        let text = |title: &str| head(title) + "[[cell]]\nrow='1'\ncolumn='C'\nprinted='2.5'\nmetric='mean_dx'\nkind='prediction'\n";
        for (name, title) in [("table-2.toml", "second"), ("table-1.toml", "first"), ("notes.txt", "none"), (PREDICTIONS, "none")] {
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
        let (mean, one) = ("metric='mean_dx'\nkind='definition'", "metric='x'\nkind='definition'\ntarget='7'");
        let table = read(&[
            cell("C", "2.5", mean),
            cell("D", "2.5", one),
            cell("D", "no", "metric='mean_dx'\nkind='definition'\nnot_comparable='text'").replace("row='1'", "row='2'"),
        ]);
        let table = table.unwrap();
        assert_eq!((table.rows(), table.is_of_adjustments()), (vec!["1", "2"], false));
        for (cells, expected) in [
            (vec![cell("C", "2.5", mean), cell("C", "2.5", mean)], "row `1`, column `C` is given twice"),
            (vec![cell("E", "2.5", mean)], "which is none of C, D"),
            (vec![cell("C", "many", mean)], "t.toml:10:1: `many` is no number"),
            (vec![cell("C", "2.5", "metric='x'\nkind='definition'")], "figures of one target have a `target`"),
            (vec![cell("C", "2.5", "metric='mean_dx'\nkind='definition'\ntarget='7'")], "statistics have none"),
        ] {
            let found = read(&cells).unwrap_err();
            assert!(found.contains(expected), "{found}");
        }
        let adjusted =
            read(&[cell("C", "2.5", mean), cell("D", "1", "metric='iop_value'\nkind='input'\nnot_comparable='put in'")]).unwrap();
        assert!(adjusted.is_of_adjustments());
    }

    fn mistake(cells: &str) -> String {
        let head = "title='t'\nsource='s'\nunit='px'\nscenario='a'\nmethod='m'\ncolumns=['C']\n";
        let cell = "\n[[cell]]\nrow='1'\ncolumn='C'\nprinted='0'\n";
        parse("t.toml", &(head.to_owned() + &cells.replace("CELL", cell)))
            .map_or_else(|problems| problems.to_string(), |_| "none".to_owned())
    }

    #[test]
    fn every_verdict_says_its_kind() {
        for (cells, expected) in [
            ("CELLmetric='mean_dx'", "t.toml:8:1: row `1`, column `C`: `kind` is missing"),
            ("CELLmetric='mean_dx'\nkind='guess'", "t.toml:13:6: unknown variant `guess`"),
            (
                "CELLmetric='unscored'\nkind='definition'\nnot_comparable='text'",
                "t.toml:13:1: row `1`, column `C`: there is no figure of ours",
            ),
            ("CELLmetric='unscored'\nnot_comparable='text'", "none"),
            ("CELLmetric='mean_dx'\nkind='input'", "t.toml:13:1: row `1`, column `C`: what is put in does not come out"),
            ("CELLmetric='mean_dx'\nkind='input'\nnot_comparable='put in'", "none"),
        ] {
            let found = mistake(cells);
            assert!(found.starts_with(expected), "{cells}: {found}");
        }
    }

    /// Two zeros that agree under a cause that is free to make them anything agree about nothing.
    #[test]
    fn a_fitted_cause_touches_zeros_too() {
        let fitted = "[[fitted]]\ncause='noise is free'\nfigures=['sigma']\nCELLmetric='figure'\nset='a'\nof='sigma0'\nkind='consequence'";
        let head = "title='t'\nsource='s'\nunit='px'\nscenario='a'\nmethod='m'\ncolumns=['C']\n";
        let text = head.to_owned() + &fitted.replace("CELL", "[[cell]]\nrow='1'\ncolumn='C'\nprinted='0'\n");
        let table = parse("t.toml", &text).unwrap();
        assert_eq!(table.cells[0].verdict(Some(0.0)), Verdict::NotComparable("noise is free".into()));
        let other =
            parse("t.toml", &text.replace("of='sigma0'", "of='redundancy'").replace("['sigma']", "['redundancy, least']")).unwrap_err();
        assert!(other.to_string().contains("no cell has a figure `of` that begins with `redundancy, least`"), "{other}");
    }

    #[test]
    fn the_same_printed_figure_is_named_as_it_stands() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("paper")).unwrap();
        let head = "title='t'\nsource='s'\nunit='px'\nscenario='a'\nmethod='m'\ncolumns=['C']\n";
        let cell = |row: &str, printed: &str, same: &str| {
            format!("[[cell]]\nrow='{row}'\ncolumn='C'\nprinted='{printed}'\nmetric='mean_dx'\nkind='definition'\n{same}\n")
        };
        let same = |row: &str| format!("same_as = {{ table = 'table-1', row = '{row}', column = 'C' }}");
        let said = |other: String| {
            fs::write(folder.path().join("paper/table-1.toml"), head.to_owned() + &cell("1", "2.5", "") + &other).unwrap();
            tables(folder.path(), "paper").map_or_else(|error| error.to_string(), |_| "none".to_owned())
        };
        assert_eq!(said(cell("2", "2.5", &same("1"))), "none");
        let [absent, other] = [said(cell("2", "2.5", &same("3"))), said(cell("2", "2.6", &same("1")))];
        assert!(absent.contains("table-1.toml:20:1: there is no row `3`, column `C` of `table-1`"), "{absent}");
        assert!(other.contains("row `1`, column `C` of `table-1` prints `2.5`, not `2.6`"), "{other}");
        let chain = said(cell("2", "2.5", &same("1")) + &cell("3", "2.5", &same("2")));
        assert!(chain.contains("is itself the same as another"), "{chain}");
    }
}
