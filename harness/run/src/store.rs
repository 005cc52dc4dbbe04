//! Where records lie, and how a run replaces them.

use std::fs;
use std::io;
use std::path::Path;

use calibench_files::{NewFile, NewFolder, OutputFolder, at};
use calibench_measure::Configured;
use calibench_measure::registry::told;
use calibench_model::Told;
use calibench_records::adjustments::CalibrationWriter;
use calibench_records::compressor::Compressor;
use calibench_records::description::write as write_description;
use calibench_records::names::{DESCRIPTION, ORIGIN, PART, SCENARIO, cell_name, cell_run};
use calibench_records::parts::Span;
use calibench_records::points::{RecordWriter, RunInfo};
use calibench_records::results::Outcome;
use calibench_records::stored::Table;
use calibench_scenario::camera::KEPT;
use calibench_scenario::{Scenario, Subject, Sweep, parse_cell};

use crate::description::{description, told_notes};
use crate::judgement::write_judgement;
use crate::reuse::{self, Reuse, Stamp};
use crate::theory::write_theory;
use crate::{Order, Plan, RunError};

/// Copies the scenario's files, of camera and board, to where the scenario as it was run looks for them.
fn keep_files(scenario: &Scenario, folder: &NewFolder) -> Result<(), RunError> {
    let Subject::Views(views) = &scenario.subject else { return Ok(()) };
    let named: Vec<(&Path, &str)> = views.files().filter_map(|path| Some((path, path.file_name()?.to_str()?))).collect();
    if named.is_empty() {
        return Ok(());
    }
    let kept = folder.folder(KEPT)?;
    for (path, name) in named {
        let bytes = fs::read(path).map_err(|error| at(path, &error))?;
        kept.write::<io::Error>(name, |file| file.write_all(&bytes))?;
    }
    Ok(())
}

/// The path of a scenario's file as records keep it.
fn kept(origin: Option<&Path>) -> io::Result<Option<String>> {
    let whole = |file: &Path| file.canonicalize().map_err(|error| at(file, &error));
    origin.map(|file| Ok(whole(file)?.to_string_lossy().into_owned())).transpose()
}

/// The folder of a scenario's records.
pub struct RecordsFolder {
    output: OutputFolder,
    /// The scenario's file, if it is not one of the project's.
    origin: Option<String>,
}

impl RecordsFolder {
    /// That of scenario `name` below the folder of all records. `origin` is the scenario's file, if it is not one of the project's: files in several
    /// folders may give their scenarios one name.
    ///
    /// # Errors
    /// As [`OutputFolder::open`]; records of another file that is still there; a part of a run.
    pub fn open(records: &Path, name: &str, origin: Option<&Path>) -> io::Result<Self> {
        Self::whole(records, name, kept(origin)?)
    }

    /// As [`Self::open`]; `origin` is as it is kept.
    pub(crate) fn whole(records: &Path, name: &str, origin: Option<String>) -> io::Result<Self> {
        let path = records.join(name);
        if path.join(PART).is_file() {
            let why = "holds a part of a run, which a whole one does not replace: move it elsewhere, or delete it";
            return Err(io::Error::new(io::ErrorKind::AlreadyExists, format!("{}: {why}", path.display())));
        }
        Self::of(records, name, origin)
    }

    /// That of a part of a run of scenario `name`, below a folder of such parts.
    pub(crate) fn of_part(parts: &Path, name: &str, origin: Option<&Path>) -> io::Result<Self> {
        Self::of(parts, name, kept(origin)?)
    }

    fn of(records: &Path, name: &str, origin: Option<String>) -> io::Result<Self> {
        let path = records.join(name);
        // Of the project's own records alone is known whose they are: parts are put together elsewhere.
        let project = records.file_name().filter(|name| *name == "records").and_then(|_| records.parent());
        let output = OutputFolder::open(&path)?.owned_by("run", project)?;
        let there = match fs::read_to_string(path.join(ORIGIN)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            other => Some(other?.trim_end().to_owned()),
        };
        let other = match &there {
            Some(file) if there != origin && Path::new(file).exists() => Some(file.as_str()),
            None if origin.is_some() && path.join(SCENARIO).exists() => Some("a scenario of the project"),
            _ => None,
        };
        let Some(other) = other else { return Ok(Self { output, origin }) };
        let why = "whose name is the same; nothing was written: rename one of them, or delete these records";
        Err(io::Error::new(io::ErrorKind::AlreadyExists, format!("{}: holds the records of {other}, {why}", path.display())))
    }

    /// What the records of a run of `plans` depend on.
    fn stamp<'a>(&self, scenario: &Scenario, reuse: Option<Reuse<'a>>, plans: &[Plan<'_>]) -> Option<Stamp<'a>> {
        Stamp::of(self.output.path(), (&scenario.text, self.origin.as_deref()), reuse, plans)
    }

    /// Puts what `fill` writes in the place of what is there, unless that is the same already; how many points were measured.
    fn unless_unchanged(
        &self,
        stamp: Option<Stamp<'_>>,
        reuse: Option<Reuse<'_>>,
        fill: impl FnOnce(&NewFolder) -> Result<u64, RunError>,
    ) -> Result<u64, RunError> {
        let folder = self.output.path();
        if let (Some(stamp), Some(reuse)) = (&stamp, reuse)
            && let Some(measured) = stamp.measured(folder)
        {
            reuse.tally.leave();
            return Ok(measured);
        }
        let mut measured = 0;
        self.replace(|folder| {
            measured = fill(folder)?;
            Ok::<_, RunError>(())
        })?;
        if let Some(stamp) = stamp {
            stamp.put(folder, measured);
        }
        Ok(measured)
    }

    /// Puts what `fill` writes in the place of what is there, at once.
    pub(crate) fn replace<E: From<io::Error>>(&self, fill: impl FnOnce(&NewFolder) -> Result<(), E>) -> Result<(), E> {
        self.output.replace(fill)
    }

    /// Keeps what tells the scenario, which was run with `methods`, and what they told: after measuring, not before.
    pub(crate) fn keep(
        &self,
        scenario: &Scenario,
        methods: &[Configured],
        told: Vec<(&str, Told)>,
        folder: &NewFolder,
    ) -> Result<(), RunError> {
        folder.write(SCENARIO, |file| file.write_all(scenario.text.as_bytes()))?;
        let mut description = description(scenario, methods);
        description.notes.extend(told_notes(told));
        folder.write(DESCRIPTION, |file| write_description(file, &description))?;
        if let Some(origin) = &self.origin {
            folder.write(ORIGIN, |file| writeln!(file, "{origin}"))?;
        }
        keep_files(scenario, folder)
    }
}

/// Runs `plan` and puts its records, its scenario and the first trial's images in the place of older ones, all at once, when it is done. Returns how many
/// points were measured, by all methods in all trials, or how often a calibration was applied, or how many sets of printed figures were recomputed.
///
/// # Errors
/// What the run or the file system refuses; older records are then as they were.
pub fn run(records: &RecordsFolder, plan: &Plan<'_>, revision: &str, step: &(dyn Fn() + Sync)) -> Result<u64, RunError> {
    let stamp = records.stamp(plan.scenario, plan.reuse, std::slice::from_ref(plan));
    records.unless_unchanged(stamp, plan.reuse, |folder| {
        let measured = fill(folder, plan, revision, step)?;
        records.keep(plan.scenario, plan.methods, told(plan.methods), folder)?;
        Ok(measured)
    })
}

/// Runs the trials of `plan` that are wanted and writes what there is of them into `folder`; how many points were measured.
pub(crate) fn fill(folder: &NewFolder, plan: &Plan<'_>, revision: &str, step: &(dyn Fn() + Sync)) -> Result<u64, RunError> {
    if plan.span().count() == 0 {
        return Ok(0);
    }
    let plan = Plan { images: Some(folder), data: plan.data.clone(), ..*plan };
    write_records(folder, &plan.scenario.name, &plan, revision, step)
}

/// Runs `plan` and writes its records into `folder`, under the name `name`; how many points were measured.
fn write_records(folder: &NewFolder, name: &str, plan: &Plan<'_>, revision: &str, step: &(dyn Fn() + Sync)) -> Result<u64, RunError> {
    let info = RunInfo { scenario: name.to_owned(), seed: plan.seed, revision: revision.to_owned(), detector: plan.detector_used() };
    let mut records = RecordWriter::new(table(folder, Table::Points)?, info.clone(), plan.method_infos()).map_err(io::Error::other)?;
    let (mut calibrations, mut measured) = (calibrations(folder, name, plan, revision)?, 0);
    let adjusted_alone = !plan.scenario.subject.is_measured();
    if adjusted_alone {
        records.adjusted_alone().map_err(io::Error::other)?;
    }
    reuse::run(plan, step, &mut |trial| {
        if let Some(writer) = &mut calibrations {
            writer.trial(trial.number, &trial.calibrations).map_err(io::Error::other)?;
        }
        measured += trial.calibrations.iter().filter(|one| adjusted_alone && one.outcome.is_ok()).count() as u64;
        measured += trial.points.iter().filter(|point| matches!(point.outcome, Outcome::Measured { .. })).count() as u64;
        records.trial(&trial).map_err(io::Error::other)?;
        write_judgement(folder, plan, &info, &trial)
    })?;
    if let Some(writer) = calibrations {
        writer.finish().map_err(io::Error::other)?.finish()?;
    }
    write_theory(plan, &info)?;
    records.finish().map_err(io::Error::other)?.finish()?;
    Ok(measured)
}

/// A new table in `folder`.
fn table(folder: &NewFolder, table: Table) -> io::Result<Compressor<NewFile>> {
    Ok(Compressor::new(folder.create(table.file())?))
}

type Adjustments = CalibrationWriter<Compressor<NewFile>>;

/// What writes the adjustments of `plan`, if it makes any.
fn calibrations(folder: &NewFolder, name: &str, plan: &Plan<'_>, revision: &str) -> Result<Option<Adjustments>, RunError> {
    let sets = plan.sets();
    if sets.is_empty() {
        return Ok(None);
    }
    let info = RunInfo { scenario: name.to_owned(), seed: plan.seed, revision: revision.to_owned(), detector: None };
    let writer = CalibrationWriter::new(table(folder, Table::Adjustments)?, info, plan.method_infos(), sets).map_err(io::Error::other)?;
    Ok(Some(writer))
}

/// How a swept scenario is run.
pub struct SweepPlan<'a> {
    /// What is asked for: methods in place of those of each cell, if there are any; of trials a cell in which nothing is random has one.
    pub order: &'a Order<'a>,
    /// The scenario's sweep.
    pub sweep: &'a Sweep,
}

impl SweepPlan<'_> {
    /// The cell of place `index`.
    fn cell(&self, index: usize) -> Result<Scenario, RunError> {
        Ok(parse_cell(self.order.scenario, self.sweep, index, self.order.registry).map_err(io::Error::other)?)
    }

    /// How `cell` is run.
    fn plan<'c>(&'c self, cell: &'c Scenario) -> Plan<'c> {
        let trials = self.order.trials.filter(|_| !cell.is_deterministic());
        Plan { trials: trials.unwrap_or(cell.trials), ..self.order.plan_of(cell) }
    }

    /// How many trials each cell has.
    ///
    /// # Errors
    /// A cell whose files have changed since the scenario was read.
    pub fn trials_of_cells(&self) -> Result<Vec<u64>, RunError> {
        (0..self.sweep.cells()).map(|index| Ok(self.plan(&self.cell(index)?).all_trials())).collect()
    }
}

/// Runs the cells of `plan` one after the other and puts their records, each in a folder of its own, in the place of older ones, all at once.
///
/// The random numbers of a cell are those of the scenario without its sweep: cells share phase, noise and stations, so that curves differ by what
/// is swept, and none depends on which others there are. `step` is called after each cell. Returns how many points were measured.
///
/// # Errors
/// What a run or the file system refuses; older records are then as they were.
pub fn run_sweep(records: &RecordsFolder, plan: &SweepPlan<'_>, revision: &str, step: &(dyn Fn() + Sync)) -> Result<u64, RunError> {
    let (scenario, reuse) = (plan.order.scenario, plan.order.reuse);
    let stamp = if reuse.is_some() {
        let cells = (0..plan.sweep.cells()).map(|index| plan.cell(index)).collect::<Result<Vec<_>, RunError>>()?;
        records.stamp(scenario, reuse, &cells.iter().map(|cell| plan.plan(cell)).collect::<Vec<_>>())
    } else {
        None
    };
    records.unless_unchanged(stamp, reuse, |folder| {
        let measured = fill_sweep(folder, plan, (0..plan.sweep.cells()).map(|cell| (cell, None)), revision, step)?;
        records.keep(scenario, plan.order.methods, told(plan.order.measuring()), folder)?;
        Ok(measured)
    })
}

/// Runs `cells` of `plan`, of each all trials or those that are wanted, and writes what there is of them into `folder`; how many points were measured.
pub(crate) fn fill_sweep(
    folder: &NewFolder,
    plan: &SweepPlan<'_>,
    cells: impl Iterator<Item = (usize, Option<Span>)>,
    revision: &str,
    step: &(dyn Fn() + Sync),
) -> Result<u64, RunError> {
    let mut measured = 0;
    for (index, only) in cells {
        let cell = plan.cell(index)?;
        let run = Plan { only, ..plan.plan(&cell) };
        let (folder, label) = (folder.folder(&cell_name(index))?, plan.sweep.label(index));
        measured += write_records(&folder, &cell_run(&plan.order.scenario.name, &label), &run, revision, &|| ())?;
        step();
    }
    Ok(measured)
}
