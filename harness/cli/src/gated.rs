//! Scenarios run in memory, or read from records, for the gate.

use std::path::{Path, PathBuf};

use calibench_gate::{
    Access, Cells, Coordinates, FigureSums, ImageSums, Kept, Lock, Measured, PointSums, Results, Table, Verdicts, fingerprint, library,
    recorded,
};
use calibench_project::ProjectError;
use calibench_records::names::cell_run;
use calibench_report::verdicts;
use calibench_run::reuse::{self, Reuse, Tally};
use calibench_run::store::{self, RecordsFolder, SweepPlan};
use calibench_run::{Order, Plan};
use calibench_scenario::{Scenario, Subject, Sweep, parse_cell};

use super::context::Context;
use super::notes::say_absent_calibrators;
use super::progress::Progress;
use super::stored::{Stored, is_current};
use crate::failure::{Failure, project_failure};

/// Gets a table with its scenario and the cell of its sweep.
pub type Seen<'a> = dyn FnMut(&Scenario, Option<usize>, &Table) -> Result<(), Failure> + 'a;

/// Where results come from, and who else sees them.
pub struct Source<'a> {
    /// What has been run before, in place of running now.
    pub records: Option<PathBuf>,
    /// Where the records of the scenarios that published tables stand on are kept for their verdicts.
    pub kept: Option<Keep>,
    /// Gets every table with the scenario and the cell of its sweep.
    pub each: &'a mut Seen<'a>,
    /// The store of results.
    pub stored: &'a Stored,
}

/// A temporary folder of records, and whose.
pub struct Keep {
    folder: tempfile::TempDir,
    scenarios: Vec<String>,
}

impl Keep {
    /// An empty folder for the records behind the project's published tables.
    pub fn new(context: &Context<'_>) -> Result<Self, Failure> {
        let scenarios = verdicts::scenarios(&context.root()?.join(PUBLISHED))?;
        Ok(Self { folder: tempfile::tempdir()?, scenarios })
    }

    /// Whether published tables stand on this scenario.
    pub fn has(&self, scenario: &str) -> bool {
        self.scenarios.iter().any(|name| name == scenario)
    }
}

/// The folder of published tables in a project.
const PUBLISHED: &str = "reference/published";

/// The verdicts of all published cells whose records are there.
pub fn cell_verdicts(context: &Context<'_>, source: &Source<'_>) -> Result<Verdicts, Failure> {
    let kept = source.kept.as_ref().map(|keep| keep.folder.path());
    let Some(records) = source.records.as_deref().or(kept) else { return Ok(Verdicts::default()) };
    let all = verdicts::verdicts(records, &context.root()?.join(PUBLISHED))?;
    Ok(Verdicts(all.into_iter().collect()))
}

/// The named scenarios, or all.
///
/// # Errors
/// A scenario that cannot be loaded, and none at all.
pub fn scenarios(context: &Context<'_>, names: &[String]) -> Result<Vec<Scenario>, Failure> {
    let names = if names.is_empty() { context.catalogue()?.names()? } else { names.to_vec() };
    if names.is_empty() {
        let folder = context.root()?.join("scenarios");
        return Err(Failure::input(format!("{}: there is no scenario, so there is nothing to check", folder.display())));
    }
    names.iter().map(|name| context.scenario(name)).collect()
}

/// The lock on the folder of baselines; whom it waits for is said.
///
/// # Errors
/// A wait that the system ends.
pub fn locked(folder: &Path, access: Access) -> Result<Lock, Failure> {
    let waiting = || say!("{}: another `calibench` blesses or compares; waiting for it to end", folder.display());
    Ok(Lock::take(folder, access, waiting)?)
}

/// Results of scenarios.
///
/// # Errors
/// A scenario that cannot be run.
pub fn gated(context: &Context<'_>, scenarios: &[Scenario], source: &mut Source<'_>) -> Result<Vec<Results>, Failure> {
    let tallies: Vec<Tally> = scenarios.iter().map(|_| Tally::default()).collect();
    let all = scenarios.iter().zip(&tallies).map(|(scenario, tally)| one(context, scenario, source, tally)).collect();
    if source.records.is_none() {
        source.stored.close(context.quiet, &tallies);
    }
    all
}

fn one(context: &Context<'_>, scenario: &Scenario, source: &mut Source<'_>, tally: &Tally) -> Result<Results, Failure> {
    let reuse = source.stored.reuse(tally);
    let plan = plan(context, scenario, reuse)?;
    let results = |measured: Measured, beside: Option<Beside>| Results {
        scenario: scenario.name.clone(),
        deterministic: scenario.is_deterministic(),
        measured,
        figures: beside.as_ref().and_then(|beside| kept(&beside.figures)),
        images: beside.as_ref().and_then(|beside| kept(&beside.images)),
    };
    let missing = plan.missing();
    if source.records.is_none() {
        say_absent_calibrators(&plan);
    }
    if let Some(why) = missing.filter(|_| source.records.is_none()) {
        return Ok(results(Measured::NotCompared(format!("unavailable: {why}")), None));
    }
    let keep = source.kept.as_ref().filter(|keep| source.records.is_none() && keep.has(&scenario.name));
    let records = match keep {
        Some(keep) => {
            run_into(context, scenario, keep.folder.path(), reuse)?;
            Some(keep.folder.path().to_owned())
        }
        None => source.records.clone(),
    };
    if let Some(sweep) = &scenario.sweep {
        let (sums, beside) = swept(context, scenario, sweep, (records.as_deref(), source), tally)?;
        return Ok(results(Measured::Sums(sums), Some(beside)));
    }
    let table = match &records {
        Some(folder) => described(recorded(&folder.join(&scenario.name), &scenario.name, unit(scenario))?, &plan, keep.is_some()),
        None => {
            let progress = Progress::start(&scenario.name, plan.steps(), context.quiet);
            let table = run(&plan, &scenario.name, &|| progress.step())?;
            progress.finish(done(tally));
            table
        }
    };
    (source.each)(scenario, None, &table)?;
    let mut beside = Beside::new(scenario, &table.text, table.seed);
    beside.add("", &table);
    Ok(results(Measured::Points(table), Some(beside)))
}

/// What stands beside points: the figures of adjustments, and the image points behind them.
struct Beside {
    figures: Cells<FigureSums>,
    images: Cells<ImageSums>,
}

impl Beside {
    fn new(scenario: &Scenario, text: &str, seed: u64) -> Self {
        Self { figures: empty(scenario, text, seed), images: empty(scenario, text, seed) }
    }

    fn add(&mut self, label: &str, table: &Table) {
        self.figures.add(label, table);
        self.images.add(label, table);
    }
}

/// All cells of a sweep, one after the other.
fn swept(
    context: &Context<'_>,
    scenario: &Scenario,
    sweep: &Sweep,
    (records, source): (Option<&Path>, &mut Source<'_>),
    tally: &Tally,
) -> Result<(Cells<PointSums>, Beside), Failure> {
    let mut all: Option<(u64, Cells<PointSums>, Beside)> = None;
    let progress = Progress::start(&scenario.name, sweep.cells() as u64, context.quiet);
    for index in 0..sweep.cells() {
        let label = sweep.label(index);
        let name = cell_run(&scenario.name, &label);
        let cell = parse_cell(scenario, sweep, index, context.registry()?)
            .map_err(|problems| project_failure(ProjectError::Problems(problems)))?;
        let plan = plan(context, &cell, source.stored.reuse(tally))?;
        let table = match records {
            Some(records) => {
                described(recorded(&folder_of(records, scenario, Some(index)), &name, unit(scenario))?, &plan, source.records.is_none())
            }
            None => run(&plan, &name, &|| ())?,
        };
        (source.each)(scenario, Some(index), &table)?;
        // The seed of the scenario, unless these records are of a run with another one.
        let seed = if table.seed == cell.seed { scenario.seed } else { table.seed };
        let (first, sums, beside) =
            all.get_or_insert_with(|| (seed, empty(scenario, &table.text, seed), Beside::new(scenario, &table.text, seed)));
        if seed != *first {
            return Err(Failure::input(format!("{name}: was run with another seed than the cells before it; run the scenario again")));
        }
        sums.add(&label, &table);
        beside.add(&label, &table);
        progress.step();
    }
    progress.finish(done(tally));
    all.map(|(_, sums, beside)| (sums, beside)).ok_or_else(|| Failure::input(format!("{}: its sweep has no cell", scenario.name)))
}

/// What was done.
fn done(tally: &Tally) -> &'static str {
    if is_current(tally) { "up to date" } else { "measured" }
}

fn plan<'a>(context: &'a Context<'_>, scenario: &'a Scenario, reuse: Option<Reuse<'a>>) -> Result<Plan<'a>, Failure> {
    // The gate compares errors with errors.
    Ok(Plan { bounds: false, reuse, ..Plan::new(scenario, context.tools()?, context.data()?) })
}

fn empty<T: Kept>(scenario: &Scenario, text: &str, seed: u64) -> Cells<T> {
    Cells::new(&scenario.name, text, seed, Coordinates::of(scenario.has_truth()))
}

fn kept<T: Kept + Clone>(cells: &Cells<T>) -> Option<Cells<T>> {
    (!cells.is_empty()).then(|| cells.clone())
}

/// Runs `plan` into a table called `name`.
fn run(plan: &Plan<'_>, name: &str, step: &(dyn Fn() + Sync)) -> Result<Table, Failure> {
    let scenario = plan.scenario;
    let mut table = Table::new(name, plan.seed, Coordinates::of(scenario.has_truth()), &plan.method_infos());
    table = described(table, plan, true);
    reuse::run(plan, step, &mut |trial| {
        table.add(&trial);
        Ok(())
    })?;
    Ok(table)
}

/// Runs a scenario into `records`: its figures are then those of the records, as reports have them.
fn run_into(context: &Context<'_>, scenario: &Scenario, records: &Path, reuse: Option<Reuse<'_>>) -> Result<(), Failure> {
    let (output, revision) = (RecordsFolder::open(records, &scenario.name, None)?, context.revision()?);
    let Some(sweep) = &scenario.sweep else {
        let plan = plan(context, scenario, reuse)?;
        let progress = Progress::start(&scenario.name, plan.steps(), context.quiet);
        store::run(&output, &plan, &revision, &|| progress.step())?;
        progress.finish(reuse.map_or("measured", |reuse| done(reuse.tally)));
        return Ok(());
    };
    let (registry, tools) = (context.registry()?, context.tools()?);
    let order = Order { scenario, methods: &[], seed: None, trials: None, tools, data: context.data()?, reuse, registry, stop: None };
    store::run_sweep(&output, &SweepPlan { order: &order, sweep }, &revision, &|| ())?;
    Ok(())
}

/// The table with what its plan knows of it: if it was made `now`, the scenario's text, all parameters and libraries.
fn described(mut table: Table, plan: &Plan<'_>, now: bool) -> Table {
    if !now {
        return table;
    }
    table.text = fingerprint(&plan.scenario.text);
    let detector = plan.detector_used();
    for method in plan.methods {
        table.describe(&method.label, method.all_settings(), library(&method.label, &method.version, detector.as_ref()));
    }
    table
}

/// The folder of the records of a scenario, or of a cell of its sweep, below `records`.
pub fn folder_of(records: &Path, scenario: &Scenario, cell: Option<usize>) -> PathBuf {
    let folder = records.join(&scenario.name);
    cell.map_or_else(|| folder.clone(), |index| calibench_records::names::cell_folder(&folder, index))
}

/// The object unit, in which the errors of check points are.
pub fn unit(scenario: &Scenario) -> &'static str {
    match &scenario.subject {
        Subject::Views(views) => views.unit.name(),
        Subject::Printed(printed) => printed.unit.name(),
        Subject::Scene(_) | Subject::Photographs(_) => "",
    }
}
