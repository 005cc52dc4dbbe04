//! The report of a family of scenarios.

use std::path::Path;

use calibench_records::description::Sweep;
use rayon::prelude::*;

use crate::composed::Composed;
use crate::detectors::Detectors;
use crate::first_screen::Sources;
use crate::load::adjustments::{self, Summaries};
use crate::load::description;
use crate::page::Page;
use crate::places::PAGE;
use crate::speeds::Speeds;
use crate::targets::Comparison;
use crate::{LoadError, Loaded, Places, ReportError, detectors, load, papers, predictions, published, sweep, targets};

/// The records of those `scenarios` that were run, and the names of the others.
fn read<'s>(places: &Places, scenarios: &'s [String]) -> Result<(Vec<Either>, Vec<&'s str>), LoadError> {
    let of = |name: &'s String| {
        if let Some(boards) = boards(&places.records, name)? {
            return Ok(boards);
        }
        Ok::<_, LoadError>(match sweep::load(&places.records, name)? {
            Some(sweep) => Either::Sweep(Box::new(sweep)),
            None => Either::Plain(Box::new(load(&places.records, name)?)),
        })
    };
    let read: Vec<_> = scenarios.par_iter().map(|name| (name.as_str(), of(name))).collect();
    let (mut all, mut not_run) = (Vec::new(), Vec::new());
    for (name, one) in read {
        match one {
            Err(LoadError::None(_)) => not_run.push(name),
            one => all.push(one?),
        }
    }
    Ok((all, not_run))
}

/// The report of `family` from the records of those `scenarios` that were run, which names the others; `None` where nothing of it could be measured here and one that
/// was measured elsewhere is there.
///
/// # Errors
/// Records or tables that cannot be read; no records at all.
pub(crate) fn compose(places: &Places, family: &str, scenarios: &[String]) -> Result<Option<Composed>, ReportError> {
    let (all, not_run) = read(places, scenarios)?;
    if all.is_empty() && !not_run.is_empty() {
        return Err(LoadError::NotRun { family: family.to_owned(), scenarios: scenarios.to_vec() }.into());
    }
    let loaded: Vec<&Loaded> = all.iter().filter_map(Either::plain).collect();
    if places.reports.join(family).join(PAGE).is_file() && all.iter().all(Either::is_unavailable) {
        return Ok(None);
    }
    let tables = published::tables(&places.published, family)?;
    let mut page = Page::new(family);
    let sweeps: Vec<_> = all.iter().filter_map(Either::sweep).collect();
    let mut sources = Sources { tables: Vec::new(), runs: loaded.clone(), sweeps: sweeps.clone() };
    let by_name = |name: &String| loaded.iter().find(|l| l.name == *name).copied().ok_or_else(|| LoadError::None(name.clone()));
    let mut texts = Vec::new();
    for (name, table) in &tables {
        let swept = sweeps.iter().copied().find(|swept| swept.name == table.scenario);
        let missing = table.beside.iter().chain([&table.scenario]).find(|name| not_run.contains(&name.as_str()));
        let section = match swept {
            _ if missing.is_some() && !table.is_of_adjustments() => published::not_run(table, missing.map_or("", String::as_str)),
            Some(swept) if !table.is_of_adjustments() => published::swept(table, swept)?,
            _ if table.is_of_adjustments() && by_name(&table.scenario).is_err() => published::without_records(table),
            _ => {
                let beside = table.beside.iter().map(by_name).collect::<Result<Vec<_>, _>>()?;
                published::section(table, by_name(&table.scenario)?, &beside)?
            }
        };
        texts.push((name, table, section.text, section.after));
        page.answers.table(name, table, &section.verdicts);
        sources.tables.push((name, table, section.figures));
        if table.is_of_adjustments() {
            page.illustrated.push(table.scenario.clone());
        }
    }
    for (name, table, text, after) in texts {
        let file = places.published.join(family).join(format!("{name}.toml"));
        // What was found out takes its figures from all that was run for it.
        let findings = if not_run.is_empty() { sources.findings(&file, &published::findings(table))? } else { String::new() };
        page.printed.push_str(&(text + &findings + &after));
    }
    if not_run.is_empty() {
        page.first_screen = sources.first_screen(&places.published.join(family))?;
        page.predictions = predictions::page(family, &places.published.join(family), &sources)?;
        let (text, pictures) = papers::section(family, &loaded, &sweeps)?;
        page.text.push_str(&text);
        page.pictures.extend(pictures);
    }
    page.not_run = not_run.iter().map(|name| (*name).to_owned()).collect();
    let (mut compared, mut detecting) = (Vec::new(), Vec::new());
    for one in &all {
        match one {
            Either::Plain(loaded) => page.scenario(loaded),
            Either::Boards(comparison) => compared.push(&**comparison),
            Either::Detectors(found) => detecting.push(&**found),
            Either::Sweep(loaded) => page.sweep(loaded, &printed_factors(&tables))?,
        }
    }
    if let Some((text, pictures)) = targets::page(&compared) {
        page.answers.say(format!("[Which target, when]({}).", targets::FILE));
        page.pictures.extend(pictures);
        page.beside.push((targets::FILE, text));
    }
    let speeds = if detecting.is_empty() { Speeds::default() } else { Speeds::read(&places.published.with_file_name("speeds.csv"))? };
    if let Some(text) = detectors::page(&detecting, &speeds) {
        page.answers.say(format!("[Detectors of boards]({}).", detectors::FILE));
        page.beside.push((detectors::FILE, text));
    }
    Ok(Some(page.composed()))
}

/// The records of `name` if they are a sweep over boards: one of detectors, or of boards and at least one more key.
fn boards(records: &Path, name: &str) -> Result<Option<Either>, LoadError> {
    let folder = records.join(name);
    let of_boards = |sweep: &Sweep| sweep.axes.first().is_some_and(|axis| axis.path == targets::BOARD);
    let Some(sweep) = description(&folder, name)?.and_then(|scenario| scenario.sweep).filter(of_boards) else { return Ok(None) };
    let read: Vec<_> = (0..sweep.cells.len()).into_par_iter().map(|cell| adjustments::load_cell(&folder, (name, &sweep, cell))).collect();
    let figures = read.into_iter().collect::<Result<Vec<_>, _>>()?;
    Ok(match shown_as(sweep.axes.len(), &figures) {
        Shown::Detectors => Detectors::load(records, name, figures)?.map(|found| Either::Detectors(Box::new(found))),
        Shown::Comparison => Comparison::load(records, name, figures)?.map(|comparison| Either::Boards(Box::new(comparison))),
        Shown::Sweep => None,
    })
}

/// As what a sweep over boards is shown.
#[derive(Debug, PartialEq)]
enum Shown {
    Detectors,
    Comparison,
    Sweep,
}

/// By how many keys are swept, boards among them, and the figures of its cells.
fn shown_as(keys: usize, figures: &[Option<Summaries>]) -> Shown {
    match keys {
        1 | 2 if Detectors::are_in(figures) => Shown::Detectors,
        1 => Shown::Sweep,
        _ => Shown::Comparison,
    }
}

/// What the records of a scenario are.
enum Either {
    Plain(Box<Loaded>),
    Sweep(Box<sweep::LoadedSweep>),
    Boards(Box<Comparison>),
    Detectors(Box<Detectors>),
}

impl Either {
    fn plain(&self) -> Option<&Loaded> {
        match self {
            Self::Plain(loaded) => Some(loaded),
            Self::Sweep(_) | Self::Boards(_) | Self::Detectors(_) => None,
        }
    }

    fn sweep(&self) -> Option<&sweep::LoadedSweep> {
        match self {
            Self::Plain(_) => None,
            Self::Sweep(sweep) => Some(sweep),
            Self::Boards(comparison) => Some(&comparison.sweep),
            Self::Detectors(found) => Some(&found.sweep),
        }
    }

    fn is_unavailable(&self) -> bool {
        match self {
            Self::Plain(loaded) => loaded.unavailable().is_some(),
            Self::Sweep(_) | Self::Boards(_) | Self::Detectors(_) => self.sweep().is_some_and(sweep::LoadedSweep::is_unavailable),
        }
    }
}

/// The paper's mean reduction factors, to be drawn beside a sweep of adjustments.
fn printed_factors(tables: &[(String, published::Table)]) -> Vec<(String, f64)> {
    let cells = tables.iter().flat_map(|(_, table)| &table.cells).filter(|cell| cell.metric == published::Metric::MeanSigmaRatio);
    let factor = |cell: &published::Cell| {
        let printed = published::Printed::parse(&cell.printed)?;
        Some((format!("printed, {}: {}", cell.column, cell.printed), printed.value))
    };
    cells.filter_map(factor).collect()
}

#[cfg(test)]
mod tests {
    use calibench_records::names::DETECTION;

    use super::*;

    #[test]
    fn a_sweep_over_boards_is_of_detectors_where_they_are_counted() {
        let cells = |set: &str| vec![None, Some(Summaries { sets: vec![set.to_owned()], ..Summaries::default() })];
        let shown = |set: &str| [1, 2, 3].map(|keys| shown_as(keys, &cells(set)));
        assert_eq!(shown(DETECTION), [Shown::Detectors, Shown::Detectors, Shown::Comparison]);
        assert_eq!(shown("camera"), [Shown::Sweep, Shown::Comparison, Shown::Comparison]);
        assert_eq!(shown_as(2, &[None]), Shown::Comparison);
    }
}
