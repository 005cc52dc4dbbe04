//! The report of a family of scenarios, and the page that lists all reports.

use std::fs;
use std::io;
use std::path::Path;

use calibench_exchange::OutputFolder;
use calibench_exchange::folder::write_beside;
use calibench_measure::Registry;

use crate::page::Page;
use crate::places::PAGE;
use crate::{
    LoadError, Loaded, Places, ReportError, Written, atlas, load, network, published, published_section, published_sweep, sweep, zhu,
};

/// Writes the report of `family` from the records of `scenarios`, in place of the older one. One that could not be measured here at all does
/// not replace one that was measured elsewhere.
///
/// # Errors
/// Records or tables that cannot be read; the older report is then as it was.
pub fn write(places: &Places, family: &str, scenarios: &[String], registry: &Registry) -> Result<Written, ReportError> {
    if family == atlas::FAMILY {
        return atlas::write(places, scenarios, registry);
    }
    let of = |name: &String| {
        Ok::<_, LoadError>(match sweep::load(&places.records, name, registry)? {
            Some(sweep) => Either::Sweep(Box::new(sweep)),
            None => Either::Plain(Box::new(load(&places.records, name, registry)?)),
        })
    };
    let all = scenarios.iter().map(of).collect::<Result<Vec<_>, _>>()?;
    let loaded: Vec<&Loaded> = all.iter().filter_map(Either::plain).collect();
    let page_path = places.reports.join(family).join(PAGE);
    if page_path.is_file() && all.iter().all(Either::is_unavailable) {
        return Ok(Written::Kept(page_path));
    }
    let tables = published::tables(&places.published, family)?;
    let mut page = Page::new(family);
    let by_name = |name: &String| loaded.iter().find(|l| l.scenario.name == *name).copied().ok_or_else(|| LoadError::None(name.clone()));
    for (_, table) in &tables {
        if table.is_of_adjustments() {
            let main = by_name(&table.scenario).ok();
            let pitch = main.and_then(|loaded| loaded.scenario.pitch_um()).unwrap_or(f64::NAN);
            page.text.push_str(&network::published(table, main.and_then(|loaded| loaded.calibrations.as_ref()), pitch));
            page.illustrated.push(table.scenario.clone());
            continue;
        }
        if let Some(swept) = all.iter().filter_map(Either::sweep).find(|swept| swept.scenario.name == table.scenario) {
            page.text.push_str(&published_sweep::section(table, swept));
            continue;
        }
        let beside = table.beside.iter().map(by_name).collect::<Result<Vec<_>, _>>()?;
        page.text.push_str(&published_section::section(table, by_name(&table.scenario)?, &beside));
    }
    if family == zhu::FAMILY {
        let (text, pictures) = zhu::section(&loaded, &all.iter().filter_map(Either::sweep).collect::<Vec<_>>());
        page.text.push_str(&text);
        page.pictures.extend(pictures);
    }
    for one in &all {
        match one {
            Either::Plain(loaded) => page.scenario(loaded),
            Either::Sweep(loaded) => page.sweep(loaded, &printed_factors(&tables))?,
        }
    }
    OutputFolder::open(&places.reports.join(family))?.replace(|folder| page.write(folder))?;
    Ok(Written::New(page_path))
}

/// What the records of a scenario are.
enum Either {
    Plain(Box<Loaded>),
    Sweep(Box<sweep::LoadedSweep>),
}

impl Either {
    fn plain(&self) -> Option<&Loaded> {
        match self {
            Self::Plain(loaded) => Some(loaded),
            Self::Sweep(_) => None,
        }
    }

    fn sweep(&self) -> Option<&sweep::LoadedSweep> {
        match self {
            Self::Plain(_) => None,
            Self::Sweep(sweep) => Some(sweep),
        }
    }

    fn is_unavailable(&self) -> bool {
        match self {
            Self::Plain(loaded) => loaded.unavailable().is_some(),
            Self::Sweep(loaded) => loaded.is_unavailable(),
        }
    }
}

/// Writes the page that lists the reports that are there.
///
/// # Errors
/// A page of this name that calibench did not write or that was changed since, and what the file system refuses.
pub fn write_index(reports: &Path) -> io::Result<()> {
    let mut names: Vec<String> = Vec::new();
    for entry in fs::read_dir(reports).map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", reports.display())))? {
        let entry = entry?;
        if entry.path().join(PAGE).is_file() {
            names.extend(entry.file_name().into_string());
        }
    }
    names.sort();
    let lines: String = names.iter().map(|name| format!("- [{name}]({name}/{PAGE})\n")).collect();
    let text = format!(
        "# Reports\n\nMade by `calibench report` from the records of `calibench run` and the published tables; nothing here is written by hand.\n\n{lines}"
    );
    write_beside(reports, PAGE, text.as_bytes())
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
