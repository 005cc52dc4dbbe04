//! Reports: Markdown and PNG, a pure function of records and published tables.

pub mod atlas;
pub mod calibration;
mod canvas;
pub mod conventions;
pub(crate) mod field;
mod figures;
pub mod judgement;
mod load;
pub(crate) mod markdown;
mod network;
mod photographs;
pub mod published;
mod published_section;
mod published_sweep;
mod scene_figures;
mod scores_section;
pub mod speeds;
pub mod sweep;
pub(crate) mod ticks;
mod zhu;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use calibench_exchange::FolderWriter;
use calibench_measure::Registry;
use calibench_scenario::{Scenario, Subject};
use thiserror::Error;

use crate::published::PublishedError;
pub use canvas::Canvas;
pub use field::{Field, plain};
pub use load::{LoadError, Loaded, load, recorded};
pub use scene_figures::preview;

/// The file name of a report's page.
const PAGE: &str = "README.md";

/// Where a report's material is and where reports go.
#[derive(Clone, Debug)]
pub struct Places {
    /// Records, one folder a scenario.
    pub records: PathBuf,
    /// Published tables, one folder a paper.
    pub published: PathBuf,
    /// Published cameras.
    pub cameras: PathBuf,
    /// Reports, one folder a family of scenarios.
    pub reports: PathBuf,
}

/// A report that cannot be made.
#[derive(Debug, Error)]
pub enum ReportError {
    /// Its records.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// Its published tables.
    #[error(transparent)]
    Published(#[from] PublishedError),
    /// Its published cameras.
    #[error(transparent)]
    Cameras(calibench_diagnostics::Problems),
    /// Its conversions.
    #[error(transparent)]
    Convert(#[from] calibench_model::convert::ConvertError),
    /// Its measured speeds.
    #[error(transparent)]
    Speeds(#[from] speeds::SpeedsError),
    /// Its files.
    #[error("{0}")]
    Output(#[from] io::Error),
}

/// What became of a report, and the path of its page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Written {
    /// It was made anew.
    New(PathBuf),
    /// Nothing of it could be measured here; the older one was left as it is.
    Kept(PathBuf),
}

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
    let writer = FolderWriter::new(&places.reports)?;
    writer.replace(family, |folder| page.write(folder))?;
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
/// What the file system refuses.
pub fn write_index(reports: &Path) -> io::Result<()> {
    let mut names: Vec<String> = Vec::new();
    for entry in fs::read_dir(reports)? {
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
    calibench_exchange::atomic::write_atomically(&reports.join(PAGE), |file| io::Write::write_all(file, text.as_bytes()))
}

/// In what a run was not the scenario of the file: other trials, seed or methods.
fn deviations(loaded: &Loaded) -> String {
    let (scenario, head) = (&loaded.scenario, &loaded.head);
    if loaded.unavailable().is_some() {
        return String::new();
    }
    let mut found = Vec::new();
    let trials = loaded.calibrations.as_ref().map_or(loaded.scores.trials, |found| found.trials);
    if trials != scenario.trials {
        found.push(format!("{trials} trials in place of {}", scenario.trials));
    }
    if head.run.seed != scenario.seed {
        found.push(format!("seed {} in place of {}", head.run.seed, scenario.seed));
    }
    let has = |label: &str| head.methods.iter().any(|method| &*method.label == label);
    let methods = scenario.methods.iter().filter(|method| !has(&method.label)).count();
    if methods > 0 || head.methods.len() != scenario.methods.len() {
        found.push("other methods".to_owned());
    }
    if found.is_empty() { String::new() } else { format!("**Not the scenario as its file says: {}.**\n\n", found.join(", ")) }
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

struct Page {
    /// Scenarios that a published table of adjustments stands on: they are shown in pictures.
    illustrated: Vec<String>,
    text: String,
    /// Are there tables of scores?
    scored: bool,
    pictures: Vec<(String, Canvas)>,
}

impl Page {
    fn new(family: &str) -> Self {
        let text = format!(
            "# {family}\n\nMade by `calibench report {family}` from records and published tables. Pixel centres are whole numbers, x points right, y down. \
             Some of the methods compared here are our own, `forstner` and `harris_paraboloid` among them: each gets the same images, the same starts and the same score.\n\n"
        );
        Self { illustrated: Vec::new(), text, scored: false, pictures: Vec::new() }
    }

    /// The heading of a scenario; the stem of its pictures' names.
    fn head(&mut self, scenario: &Scenario, deviations: &str) -> String {
        self.text.push_str(&format!(
            "## Scenario `{}`\n\n{}\n\nSource: {}.\n\n",
            scenario.name,
            scenario.why.trim(),
            scenario.source.trim_end_matches('.')
        ));
        self.text.push_str(deviations);
        for note in &scenario.notes {
            self.text.push_str(&format!("- {}\n", note.split_whitespace().collect::<Vec<_>>().join(" ")));
        }
        if !scenario.notes.is_empty() {
            self.text.push('\n');
        }
        scenario.name.split_once('/').map_or(scenario.name.as_str(), |(_, rest)| rest).replace('/', "-")
    }

    fn sweep(&mut self, loaded: &sweep::LoadedSweep, printed: &[(String, f64)]) -> Result<(), LoadError> {
        // The points of adjusted scenarios are those of the first trial: how many there were is in their tables.
        let deviations = if loaded.scenario.is_adjusted() { String::new() } else { sweep::deviations(loaded) };
        let stem = self.head(&loaded.scenario, &deviations);
        if let Some((text, pictures)) = network::sweep(loaded, &stem, printed)? {
            self.text.push_str(&text);
            self.pictures.extend(pictures);
            return Ok(());
        }
        let (text, picture) = sweep::section(loaded, &stem);
        self.text.push_str(&text);
        self.pictures.extend(picture.map(|picture| (format!("{stem}.png"), picture)));
        Ok(())
    }

    fn scenario(&mut self, loaded: &Loaded) {
        let scenario = &loaded.scenario;
        let stem = self.head(scenario, &deviations(loaded));
        if let Some((text, pictures)) = network::section(loaded, &stem, self.illustrated.contains(&scenario.name)) {
            self.text.push_str(&text);
            self.pictures.extend(pictures);
            return;
        }
        match &scenario.subject {
            Subject::Photographs(_) => {
                let (text, pictures) = photographs::section(loaded);
                self.text.push_str(&text);
                self.pictures.extend(pictures);
            }
            Subject::Scene(_) | Subject::Views(_) => {
                self.scored = true;
                self.text.push_str(&scores_section::section(loaded));
                self.text.push('\n');
                if let Some((overview, panels)) = scene_figures::figures(loaded) {
                    self.text.push_str(&format!(
                        "The image of the first trial with truth, approximate positions and the results of one method, and 11 x 11 px around each target, enlarged 28 times, with all results:\n\n\
                         ![Image, approximations and truth]({stem}.png)\n\n![Each target with all results]({stem}-targets.png)\n\n"
                    ));
                    self.pictures.push((format!("{stem}.png"), overview));
                    self.pictures.push((format!("{stem}-targets.png"), panels));
                }
            }
        }
    }

    fn write(&self, folder: &Path) -> io::Result<()> {
        for (name, picture) in &self.pictures {
            picture.write(&folder.join(name))?;
        }
        let legend = if self.scored { format!("\n\n{}", scores_section::legend()) } else { "\n".to_owned() };
        let text = self.text.trim_end().to_owned() + &legend;
        fs::write(folder.join(PAGE), text)
    }
}
