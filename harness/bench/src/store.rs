//! Where records lie, and how a run replaces them.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use calibench_exchange::FolderWriter;

use crate::records::{RecordWriter, RunInfo};
use crate::run::{Plan, RunError};
use crate::scenario::camera::KEPT;
use crate::scenario::{Scenario, Subject};

/// The records' file in a scenario's folder.
pub const RECORDS: &str = "records.csv";
/// The scenario as it was run, in the same folder.
pub const SCENARIO: &str = "scenario.toml";

/// Copies the scenario's camera file to where the scenario as it was run looks for it.
fn keep_camera(scenario: &Scenario, folder: &Path) -> Result<(), RunError> {
    let Subject::Views(views) = &scenario.subject else { return Ok(()) };
    let Some((path, name)) = views.camera_file.as_deref().and_then(|path| Some((path, path.file_name()?))) else { return Ok(()) };
    let kept = folder.join(KEPT);
    std::fs::create_dir(&kept)?;
    std::fs::copy(path, kept.join(name))?;
    Ok(())
}

/// Runs `plan` and puts its records, its scenario and the first trial's images in the place of older ones, all at once, when it is done.
///
/// # Errors
/// What the run or the file system refuses; older records are then as they were.
pub fn run(writer: &FolderWriter, plan: &mut Plan<'_>, revision: &str, step: &(dyn Fn() + Sync)) -> Result<(), RunError> {
    let name = plan.scenario.name.clone();
    writer.replace(&name, |folder: &Path| {
        let info = RunInfo { scenario: name.clone(), seed: plan.seed, revision: revision.to_owned(), detector: plan.detector_used() };
        let file = BufWriter::new(File::create(folder.join(RECORDS))?);
        let mut records = RecordWriter::new(file, info, plan.method_infos()).map_err(std::io::Error::other)?;
        let plan = Plan { images: Some(folder), data: plan.data.clone(), ..*plan };
        plan.run(step, &mut |trial| Ok(records.trial(&trial).map_err(std::io::Error::other)?))?;
        records.finish().map_err(std::io::Error::other)?;
        std::fs::write(folder.join(SCENARIO), &plan.scenario.text)?;
        keep_camera(plan.scenario, folder)?;
        Ok(())
    })
}
