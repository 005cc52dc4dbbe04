//! Where records lie, and how a run replaces them.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use calibench_exchange::OutputFolder;
use calibench_measure::{BoardDetector, Configured, Registry};
use calibench_records::adjustments::{CALIBRATIONS, CalibrationWriter};
use calibench_records::names::{RECORDS, SCENARIO, cell_folder};
use calibench_records::points::{RecordWriter, RunInfo};
use calibench_scenario::camera::KEPT;
use calibench_scenario::{Scenario, Subject, Sweep, parse_cell};

use crate::judgement::write_judgement;
use crate::{Plan, RunError};

/// Copies the scenario's camera file to where the scenario as it was run looks for it.
fn keep_camera(scenario: &Scenario, folder: &Path) -> Result<(), RunError> {
    let Subject::Views(views) = &scenario.subject else { return Ok(()) };
    let Some((path, name)) = views.camera_file.as_deref().and_then(|path| Some((path, path.file_name()?))) else { return Ok(()) };
    let kept = folder.join(KEPT);
    std::fs::create_dir(&kept)?;
    std::fs::copy(path, kept.join(name))?;
    Ok(())
}

/// The folder of the records of scenario `name` below the records' folder.
///
/// # Errors
/// As [`OutputFolder::open`].
pub fn folder(records: &Path, name: &str) -> std::io::Result<OutputFolder> {
    OutputFolder::open(&records.join(name))
}

/// Runs `plan` and puts its records, its scenario and the first trial's images in the place of older ones, all at once, when it is done.
///
/// # Errors
/// What the run or the file system refuses; older records are then as they were.
pub fn run(output: &OutputFolder, plan: &mut Plan<'_>, revision: &str, step: &(dyn Fn() + Sync)) -> Result<(), RunError> {
    let name = plan.scenario.name.clone();
    output.replace(|folder: &Path| {
        let plan = Plan { images: Some(folder), data: plan.data.clone(), ..*plan };
        write_records(folder, &name, &plan, revision, step)?;
        std::fs::write(folder.join(SCENARIO), &plan.scenario.text)?;
        keep_camera(plan.scenario, folder)
    })
}

/// Runs `plan` and writes its records into `folder`, under the name `name`.
fn write_records(folder: &Path, name: &str, plan: &Plan<'_>, revision: &str, step: &(dyn Fn() + Sync)) -> Result<(), RunError> {
    let info = RunInfo { scenario: name.to_owned(), seed: plan.seed, revision: revision.to_owned(), detector: plan.detector_used() };
    let file = BufWriter::new(File::create(folder.join(RECORDS))?);
    let mut records = RecordWriter::new(file, info.clone(), plan.method_infos()).map_err(std::io::Error::other)?;
    let mut calibrations = calibrations(folder, name, plan, revision)?;
    plan.run(step, &mut |trial| {
        if let Some(writer) = &mut calibrations {
            writer.trial(trial.number, &trial.calibrations).map_err(std::io::Error::other)?;
        }
        records.trial(&trial).map_err(std::io::Error::other)?;
        write_judgement(folder, plan, &info, &trial)
    })?;
    calibrations.map_or(Ok(()), CalibrationWriter::finish).map_err(std::io::Error::other)?;
    Ok(records.finish().map_err(std::io::Error::other)?)
}

/// What writes the adjustments of `plan`, if it makes any.
fn calibrations(
    folder: &Path,
    name: &str,
    plan: &Plan<'_>,
    revision: &str,
) -> Result<Option<CalibrationWriter<BufWriter<File>>>, RunError> {
    let Subject::Views(views) = &plan.scenario.subject else { return Ok(None) };
    let Some(calibration) = &views.calibration else { return Ok(None) };
    let info = RunInfo { scenario: name.to_owned(), seed: plan.seed, revision: revision.to_owned(), detector: None };
    let file = BufWriter::new(File::create(folder.join(CALIBRATIONS))?);
    let sets = calibration.sets.iter().map(|set| set.name.clone()).collect();
    let writer = CalibrationWriter::new(file, info, plan.method_infos(), sets).map_err(std::io::Error::other)?;
    Ok(Some(writer))
}

/// How a swept scenario is run: what of its cells differs from the file, and with what they are measured.
pub struct SweepPlan<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// Its sweep.
    pub sweep: &'a Sweep,
    /// The methods; those of each cell if there are none here.
    pub methods: &'a [Configured],
    /// The seed in place of the scenario's.
    pub seed: Option<u64>,
    /// The number of trials in place of the scenario's; a cell in which nothing is random has one.
    pub trials: Option<u64>,
    /// Finds chessboards, where this build can.
    pub detector: Option<&'a dyn BoardDetector>,
    /// Where photographs are.
    pub data: PathBuf,
    /// All methods that there are.
    pub registry: &'a Registry,
}

/// Runs the cells of `plan` one after the other and puts their records, each in a folder of its own, in the place of older ones, all at once.
///
/// The random numbers of a cell are those of the scenario without its sweep: cells share phase, noise and stations, so that curves differ by what
/// is swept, and none depends on which others there are. `step` is called after each cell.
///
/// # Errors
/// What a run or the file system refuses; older records are then as they were.
pub fn run_sweep(output: &OutputFolder, plan: &SweepPlan<'_>, revision: &str, step: &(dyn Fn() + Sync)) -> Result<(), RunError> {
    let scenario = plan.scenario;
    output.replace(|folder: &Path| {
        for index in 0..plan.sweep.cells() {
            let cell = parse_cell(scenario, plan.sweep, index, plan.registry).map_err(std::io::Error::other)?;
            let mut run = Plan::new(&cell, plan.detector, plan.data.clone());
            if !plan.methods.is_empty() {
                run.methods = plan.methods;
            }
            run.seed = plan.seed.unwrap_or(cell.seed);
            run.trials = plan.trials.filter(|_| !cell.is_deterministic()).unwrap_or(cell.trials);
            let folder = cell_folder(folder, index);
            std::fs::create_dir_all(&folder)?;
            write_records(&folder, &format!("{}@{}", scenario.name, plan.sweep.label(index)), &run, revision, &|| ())?;
            step();
        }
        std::fs::write(folder.join(SCENARIO), &scenario.text)?;
        keep_camera(scenario, folder)
    })
}
