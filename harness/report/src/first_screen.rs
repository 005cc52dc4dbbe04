//! The first screen of a paper's page, and what was found out about its tables: words from files, figures from tables and records.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range as Bytes;
use std::path::{Path, PathBuf};

use calibench_diagnostics::{Problem, Problems};
use calibench_records::figures::{FigureName, Group};
use calibench_records::names::cell_folder;
use calibench_records::stored::read_points;

use crate::load::{LoadError, Loaded, LoadedSweep};
use crate::markdown::{fixed, plain};
use crate::published::{Metric, Printed, PublishedError, Range, Table, Trials, errors_of, of_points, ratio};

/// The file beside the tables of a paper.
const FILE: &str = "first-screen.md";
/// What stands for a figure whose scenario has no records.
pub const NOT_RUN: &str = "(not run here)";
/// Between a sweep and its cell.
const AT: &str = " @ ";

/// Where the figures of a first screen come from.
pub struct Sources<'a> {
    /// Tables by their files' names, with our figure for each cell.
    pub tables: Vec<(&'a str, &'a Table, Vec<Option<f64>>)>,
    /// Runs.
    pub runs: Vec<&'a Loaded>,
    /// Sweeps.
    pub sweeps: Vec<&'a LoadedSweep>,
}

impl Sources<'_> {
    /// The first screen in `folder`, its figures filled in; `None` where there is none.
    ///
    /// # Errors
    /// A file that cannot be read, asks for a figure that is not there, or has one that was typed.
    pub fn first_screen(&self, folder: &Path) -> Result<Option<String>, PublishedError> {
        let path = folder.join(FILE);
        let text = match calibench_files::bounded::text(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            text => text.map_err(|source| PublishedError::File { path: path.clone(), source })?,
        };
        let filled = filled(&text, &|asked| self.figure(asked), &untyped);
        filled.map(Some).map_err(|problem| Problems { file: path.display().to_string(), text, problems: vec![problem] }.into())
    }

    /// What was found out about the table in the file `path`, as its section says it, its figures filled in.
    ///
    /// # Errors
    /// A figure that is not there.
    pub fn findings(&self, path: &Path, said: &str) -> Result<String, PublishedError> {
        filled(said, &|asked| self.figure(asked), &|text, part| Ok(&text[part])).map_err(|problem| {
            // In the file lines may break within it.
            let text = calibench_files::bounded::text(path).unwrap_or_default();
            let start = said[problem.span.clone()].split(['|', '\n']).next().and_then(|first| text.find(first.trim())).unwrap_or(0);
            let problems = vec![Problem::new(start..(start + 1).min(text.len()), problem.message)];
            Problems { file: path.display().to_string(), text, problems }.into()
        })
    }

    /// What is asked for: `printed` or `ours` of a cell, `figure` of an adjustment, `error` of measured points; `mean`, `median` and `range` of either over the trials,
    /// `ratio` of two.
    fn figure(&self, asked: &str) -> Option<String> {
        let (kind, rest) = asked.split_once(' ')?;
        if let "mean" | "median" | "range" | "ratio" = kind {
            let (above, below) = divided(rest);
            if self.asks_for_absent(above) || below.is_some_and(|below| self.asks_for_absent(below)) {
                return Some(NOT_RUN.to_owned());
            }
            let runs: Vec<f64> = self.all_runs(rest)?.into_values().collect();
            let range = Range::of(&runs)?;
            return Some(match kind {
                "median" => plain(range.median),
                "range" => format!("{} to {}", plain(range.low), plain(range.high)),
                _ => plain(runs.iter().sum::<f64>() / runs.len() as f64),
            });
        }
        let parts: Vec<&str> = rest.split('|').map(str::trim).collect();
        match (kind, &parts[..]) {
            ("printed", [table, row, column]) => Some(self.cell(table, row, column)?.0),
            ("ours", [table, row, column]) => Some(self.cell(table, row, column)?.1.unwrap_or_else(|| NOT_RUN.to_owned())),
            ("figure" | "error", _) if self.is_not_run(&parts) => Some(NOT_RUN.to_owned()),
            ("figure", [run, method, set, group, name]) => self.adjusted([run, method, set, group, name], 1.0),
            ("figure", [run, method, set, group, name, times]) => self.adjusted([run, method, set, group, name], times.parse().ok()?),
            ("error", [run, method]) => {
                let run = self.runs.iter().find(|loaded| loaded.name == *run)?;
                run.scores.methods.get(run.method(method)?)?.whole.rmse().map(plain)
            }
            ("error", [sweep, method, cell]) => {
                let loaded = self.sweeps.iter().find(|loaded| loaded.name == *sweep)?;
                let cell = loaded.sweep.cells.iter().position(|one| one.label == *cell)?;
                let method = loaded.methods.iter().position(|one| one.name == *method)?;
                loaded.score(cell, method)?.whole.rmse().map(plain)
            }
            ("error", [sweep, method, cell, without]) => {
                let (loaded, index) = self.cell_of(sweep, cell)?;
                let (folder, run) = (cell_folder(&loaded.folder, index), loaded.sweep.run(&loaded.name, index));
                let except = [without.strip_prefix("without ")?.to_owned()];
                pooled(&folder, &run, &|label| loaded.sweep.method(label) == *method, &except).ok().flatten().map(plain)
            }
            _ => None,
        }
    }

    /// Whether the scenario of a figure has no records, or a sweep not those of its cell.
    fn is_not_run(&self, parts: &[&str]) -> bool {
        let Some(name) = parts.first() else { return false };
        if let Some((name, cell)) = name.split_once(AT) {
            return self.cell_of(name, cell).is_none();
        }
        match (self.sweeps.iter().find(|loaded| loaded.name == **name), parts) {
            (Some(loaded), [_, _, cell, ..]) => !loaded.sweep.cells.iter().any(|one| one.label == *cell),
            (Some(_), _) => false,
            (None, _) => !self.runs.iter().any(|loaded| loaded.name == **name),
        }
    }

    /// Whether `asked` asks for a figure of a scenario or a cell that has no records.
    pub fn asks_for_absent(&self, asked: &str) -> bool {
        let run = asked.strip_prefix("figure ").or_else(|| asked.strip_prefix("error "));
        run.is_some_and(|rest| self.is_not_run(&rest.split('|').map(str::trim).collect::<Vec<_>>()))
    }

    /// The number that `printed ...` asks for.
    pub fn printed(&self, asked: &str) -> Option<f64> {
        if asked.starts_with("printed ") { Some(Printed::parse(&self.figure(asked)?)?.value) } else { None }
    }

    /// The sweep `name` and the place of its `cell`.
    fn cell_of(&self, name: &str, cell: &str) -> Option<(&LoadedSweep, usize)> {
        let loaded = self.sweeps.iter().find(|loaded| loaded.name == name)?;
        Some((loaded, loaded.sweep.cells.iter().position(|one| one.label == cell)?))
    }

    /// The folder and the name of the records of a scenario, or of a cell of a sweep.
    fn records(&self, of: &str) -> Option<(PathBuf, String)> {
        if let Some((name, cell)) = of.split_once(AT) {
            let (loaded, index) = self.cell_of(name, cell)?;
            return Some((cell_folder(&loaded.folder, index), loaded.sweep.run(&loaded.name, index)));
        }
        self.runs.iter().find(|loaded| loaded.name == of).map(|loaded| (loaded.folder.clone(), loaded.name.clone()))
    }

    /// As [`Self::runs_of`], or the ratio of two of them in every trial, where one stands ` over ` another.
    fn all_runs(&self, asked: &str) -> Option<BTreeMap<u64, f64>> {
        let of = |asked: &str| self.runs_of(asked).ok().flatten();
        match divided(asked) {
            (above, Some(below)) => Some(ratio(&of(above)?, &of(below)?)),
            (asked, None) => of(asked),
        }
    }

    /// A `figure` or an `error`, as [`Self::figure`] has them, in every trial; `None` for what is not there.
    pub fn runs_of(&self, asked: &str) -> Result<Option<BTreeMap<u64, f64>>, LoadError> {
        let Some((kind, rest)) = asked.split_once(' ') else { return Ok(None) };
        let parts: Vec<&str> = rest.split('|').map(str::trim).collect();
        match (kind, &parts[..]) {
            ("figure", [run, method, set, group, name, times @ ..]) => {
                let times: f64 = times.first().map_or(Some(1.0), |times| times.parse().ok()).unwrap_or(f64::NAN);
                let name = Group::named(group).and_then(|group| FigureName::parse(group, name).ok());
                let Some(((folder, run), name)) = self.records(run).zip(name) else { return Ok(None) };
                let key = ((*method).to_owned(), (*set).to_owned(), name);
                let trials = Trials::of_folder(&folder, &run, Some(&BTreeSet::from([key.clone()])))?;
                let found = trials.of(&key, |numbers| Some(numbers.value * times));
                Ok((!found.is_empty()).then_some(found))
            }
            ("error", [run, method]) => {
                let Some(loaded) = self.runs.iter().find(|loaded| loaded.name == *run) else { return Ok(None) };
                errors(&loaded.folder, &loaded.name, &|label| label == *method)
            }
            ("error", [sweep, method, cell]) => {
                let Some((loaded, index)) = self.cell_of(sweep, cell) else { return Ok(None) };
                errors(&cell_folder(&loaded.folder, index), &loaded.sweep.run(&loaded.name, index), &|label| {
                    loaded.sweep.method(label) == *method
                })
            }
            _ => Ok(None),
        }
    }

    /// What is printed in a cell, and ours with one digit more.
    fn cell(&self, table: &str, row: &str, column: &str) -> Option<(String, Option<String>)> {
        let (_, table, figures) = self.tables.iter().find(|(name, ..)| *name == table)?;
        let place = table.cells.iter().position(|cell| cell.row == row && cell.column == column)?;
        let cell = &table.cells[place];
        let digits = Printed::parse(&cell.printed).map_or(3, |printed| (-printed.unit.log10()).round().max(0.0) as usize + 1);
        let like = |ours: f64| {
            if cell.printed.contains('/') && ours > 0.0 {
                return format!("1/{:.0}", 1.0 / ours);
            }
            // A count has no decimals.
            fixed(ours, if digits == 1 && ours.fract() == 0.0 { 0 } else { digits })
        };
        Some((cell.printed.clone(), figures.get(place).copied().flatten().map(like)))
    }

    /// The mean over all trials, with half its 95 % interval where there are several.
    fn adjusted(&self, [run, method, set, group, name]: [&str; 5], times: f64) -> Option<String> {
        let found = self.runs.iter().find(|loaded| loaded.name == run)?.calibrations.as_ref()?;
        let name = FigureName::parse(Group::named(group)?, name).ok()?;
        let value = found.of_set(method, set, name)?.value;
        let mean = plain(value.mean()? * times);
        let decimals = mean.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        Some(
            value
                .half()
                .filter(|half| *half > 0.0)
                .map_or_else(|| mean.clone(), |half| format!("{mean} \u{b1} {:.decimals$}", half * times)),
        )
    }
}

/// The RMSE of the points of the method that `is_it` in every trial of a run, px.
fn errors(folder: &Path, name: &str, is_it: &dyn Fn(&str) -> bool) -> Result<Option<BTreeMap<u64, f64>>, LoadError> {
    let mut found = BTreeMap::new();
    read_points(folder, name, |trial, methods| {
        let method = methods.iter().position(|info| is_it(&info.label));
        let error = method.and_then(|method| of_points(&trial.points, method, Metric::RmseXy, None, &[]));
        found.extend(error.map(|error| (trial.number, error)));
    })?;
    Ok((!found.is_empty()).then_some(found))
}

/// What is asked for, and what it is divided by; names of figures have an "over" too.
fn divided(asked: &str) -> (&str, Option<&str>) {
    const OVER: &str = " over ";
    let second = ["figure", "error"].into_iter().find_map(|kind| asked.find(&format!("{OVER}{kind} ")));
    second.map_or((asked, None), |at| (&asked[..at], Some(&asked[at + OVER.len()..])))
}

/// The RMSE of all points of the method that `is_it` in all trials of a run, px, without the targets `except`.
fn pooled(folder: &Path, name: &str, is_it: &dyn Fn(&str) -> bool, except: &[String]) -> Result<Option<f64>, LoadError> {
    let (mut squares, mut count) = (0.0, 0_usize);
    read_points(folder, name, |trial, methods| {
        let Some(method) = methods.iter().position(|info| is_it(&info.label)) else { return };
        for (dx, dy) in errors_of(&trial.points, method, except) {
            squares += dx * dx + dy * dy;
            count += 1;
        }
    })?;
    Ok((count > 0).then(|| (squares / count as f64).sqrt()))
}

/// What of the words between figures may stand on a page.
type Words = dyn Fn(&str, Bytes<usize>) -> Result<&str, Problem>;

/// `text` with each `{...}` in place of which `figure` stands, and what `words` makes of the rest.
///
/// # Errors
/// What `figure` does not know; those of `words`.
fn filled(text: &str, figure: &dyn Fn(&str) -> Option<String>, words: &Words) -> Result<String, Problem> {
    let (mut out, mut at) = (String::new(), 0);
    while let Some(start) = text[at..].find('{').map(|start| at + start) {
        let end = start + text[start..].find('}').ok_or_else(|| Problem::new(start..start + 1, "`{` without `}`"))?;
        out.push_str(words(text, at..start)?);
        let asked = &text[start + 1..end];
        let unknown = || Problem::new(start..end + 1, format!("`{asked}`: no such figure in the tables and records of this paper"));
        out.push_str(&figure(asked).ok_or_else(unknown)?);
        at = end + 1;
    }
    out.push_str(words(text, at..text.len())?);
    Ok(out)
}

/// A part of `text`, if it has no decimal point between digits: such a figure would not change with the records.
fn untyped(text: &str, part: Bytes<usize>) -> Result<&str, Problem> {
    let bytes = text.as_bytes();
    let is_typed =
        |at: &usize| bytes[*at] == b'.' && *at > 0 && bytes[at - 1].is_ascii_digit() && bytes.get(at + 1).is_some_and(u8::is_ascii_digit);
    match part.clone().find(is_typed) {
        Some(at) => Err(Problem::new(
            at..at + 1,
            "a figure that is typed: figures come from tables and records, as in `{ours table-1 | row | column}`",
        )),
        None => Ok(&text[part]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::published::{Cell, Metric};

    fn said(text: &str) -> Result<String, String> {
        let cell = |row: &str, printed: &str| Cell { row: row.into(), column: "c".into(), ..Cell::bare(printed, Metric::Figure) };
        let table = Table { cells: vec![cell("a", "0.5"), cell("count", "7"), cell("part", "1/20")], ..Table::bare() };
        let sources =
            Sources { tables: vec![("table-1", &table, vec![Some(0.5123), Some(8.0), Some(0.04)])], runs: Vec::new(), sweeps: Vec::new() };
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(FILE), text).unwrap();
        sources.first_screen(folder.path()).map(Option::unwrap).map_err(|error| error.to_string())
    }

    #[test]
    fn figures_are_those_of_tables_and_records() {
        let text = "Printed {printed table-1 | a | c}, ours {ours table-1 | a | c}.\n";
        assert_eq!(said(text).unwrap(), "Printed 0.5, ours 0.51.\n");
        assert_eq!(said("{ours table-1 | count | c} and {ours table-1 | part | c}").unwrap(), "8 and 1/25");
        assert_eq!(said("Of 12 points in 1988.\n").unwrap(), "Of 12 points in 1988.\n");
        assert_eq!(said("One {figure s | m | set | check | rmse_xy}.\n").unwrap(), format!("One {NOT_RUN}.\n"));
    }

    /// Words of tables may have printed figures; what is asked for is filled in, over broken lines too.
    #[test]
    fn findings_are_filled_in() {
        let table = Table { cells: vec![Cell { row: "a".into(), ..Cell::bare("0.5", Metric::Figure) }], ..Table::bare() };
        let sources = Sources { tables: vec![("table-1", &table, vec![Some(0.5123)])], runs: Vec::new(), sweeps: Vec::new() };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table-1.toml");
        std::fs::write(&path, "title = 't'\nfindings = ['{ours table-1 | b | c}']\n").unwrap();
        let said = |text: &str| sources.findings(&path, text).map_err(|error| error.to_string());
        assert_eq!(said("Printed 0.5, ours {ours table-1 | a | c}.").unwrap(), "Printed 0.5, ours 0.51.");
        assert_eq!(said("{median error s | m} and {ratio figure s | m over figure s | n}").unwrap(), format!("{NOT_RUN} and {NOT_RUN}"));
        assert_eq!(divided("figure s | rows over columns over figure t | m"), ("figure s | rows over columns", Some("figure t | m")));
        assert_eq!(divided("figure s | rows over columns"), ("figure s | rows over columns", None));
        let unknown = said("Ours {ours table-1 | b | c}.").unwrap_err();
        assert!(unknown.contains("table-1.toml:2:14: `ours table-1 | b | c`: no such figure"), "{unknown}");
    }

    #[test]
    fn figures_that_are_typed_or_unknown_are_mistakes() {
        for (text, expected) in [
            ("One.\nOurs is 0.51 px.\n", "first-screen.md:2:10: a figure that is typed"),
            ("One {ours table-1 | b | c}.\n", "first-screen.md:1:5: `ours table-1 | b | c`: no such figure"),
            ("One {ours table-1", "first-screen.md:1:5: `{` without `}`"),
        ] {
            let found = said(text).unwrap_err();
            assert!(found.contains(expected), "{found}");
        }
        assert!(Sources { tables: Vec::new(), runs: Vec::new(), sweeps: Vec::new() }.first_screen(Path::new("/absent")).unwrap().is_none());
    }

    /// A sweep may be run in part: what a page asks of the rest is no mistake. A method that is not in it is one.
    #[test]
    fn a_cell_that_was_not_run_is_said_so() {
        let mut loaded = crate::tests::swept::loaded();
        loaded.sweep.cells[0].label = "blur=0.5, noise=0".into();
        let sources = Sources { tables: Vec::new(), runs: Vec::new(), sweeps: vec![&loaded] };
        let asked = |text: &str| sources.figure(text);
        assert_eq!(asked("error s | m | blur=1, noise=0").as_deref(), Some(NOT_RUN));
        assert!(sources.asks_for_absent("error s | m | blur=1, noise=0") && sources.asks_for_absent("error t | m"));
        // Of (1, 2) and (3, 4) px in two dimensions: the root of (5 + 25) / 2.
        assert_eq!(asked("error s | m | blur=0.5, noise=0"), Some(plain(15.0_f64.sqrt())));
        assert!(!sources.asks_for_absent("error s | m | blur=0.5, noise=0"));
        assert_eq!(asked("error s | n | blur=0.5, noise=0"), None);
    }
}
