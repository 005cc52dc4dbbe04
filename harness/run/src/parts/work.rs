//! Computing a part.

use std::io;
use std::path::{Path, PathBuf};

use calibench_files::NewFolder;
use calibench_files::folder::intact;
use calibench_measure::Configured;
use calibench_measure::registry::told;
use calibench_records::names::PART;
use calibench_records::parts::{FORMAT, Manifest, Method, Part, Span, ToldBy, pieces, write};
use calibench_scenario::Scenario;

use crate::store::{RecordsFolder, SweepPlan, fill, fill_sweep};
use crate::{Plan, RunError};

/// A part that is wanted.
#[derive(Clone, Copy)]
pub struct Wanted<'a> {
    /// The folder of parts. The part lies in it as in `3-of-8/family/name`.
    pub folder: &'a Path,
    /// Which one.
    pub part: Part,
    /// The scenario's file, if it is not one of the project's.
    pub origin: Option<&'a Path>,
    /// Whether it is computed again if it is there, and may replace a part of another run.
    pub again: bool,
    /// The code's revision.
    pub revision: &'a str,
}

/// A part that is there now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Done {
    /// Where.
    pub folder: PathBuf,
    /// What it is.
    pub manifest: Manifest,
    /// Whether it was there before, whole, so that nothing was run.
    pub there: bool,
}

/// Runs the trials of `plan` that belong to the part and writes them into its folder, all at once. What cannot be cut (one trial, photographs, printed figures)
/// is part 1; the other parts are then empty, and belong to the run all the same. `step` is called after each step, on any thread.
///
/// # Errors
/// What the run or the file system refuses, and a part of another run in its place; what is there is then as it was.
pub fn run(wanted: &Wanted<'_>, plan: &Plan<'_>, step: &(dyn Fn() + Sync)) -> Result<Done, RunError> {
    let labels = plan.method_infos().into_iter().map(|info| Method { label: info.label.to_string(), version: info.version.to_string() });
    let manifest = wanted.manifest(plan.scenario, plan.seed, vec![plan.all_trials()], labels.collect());
    let plan = Plan { only: Some(trials(plan, wanted.part)), data: plan.data.clone(), ..*plan };
    wanted.put(manifest, plan.methods, |records, folder| {
        let measured = fill(folder, &plan, wanted.revision, step)?;
        records.keep(plan.scenario, plan.methods, Vec::new(), folder)?;
        Ok(measured)
    })
}

/// As [`run`], of a sweep: all trials of all cells stand in one row, which is cut. `step` is called after each cell.
///
/// # Errors
/// As [`run`].
pub fn run_sweep(wanted: &Wanted<'_>, plan: &SweepPlan<'_>, step: &(dyn Fn() + Sync)) -> Result<Done, RunError> {
    let labels = plan.order.measuring().iter().map(|method| Method { label: method.label.clone(), version: method.version.clone() });
    let manifest = wanted.manifest(plan.order.scenario, plan.order.seed(), plan.trials_of_cells()?, labels.collect());
    let cells: Vec<_> = manifest.pieces.iter().map(|piece| (piece.cell, Some(piece.trials))).collect();
    wanted.put(manifest, plan.order.measuring(), |records, folder| {
        let measured = fill_sweep(folder, plan, cells.into_iter(), wanted.revision, step)?;
        records.keep(plan.order.scenario, plan.order.methods, Vec::new(), folder)?;
        Ok(measured)
    })
}

/// The trials of `plan` that belong to `part`.
pub fn trials(plan: &Plan<'_>, part: Part) -> Span {
    pieces(&[plan.all_trials()], part).first().map(|piece| piece.trials).unwrap_or_default()
}

impl Wanted<'_> {
    fn manifest(&self, scenario: &Scenario, seed: u64, cells: Vec<u64>, methods: Vec<Method>) -> Manifest {
        Manifest {
            format: FORMAT,
            scenario: scenario.name.clone(),
            text: blake3::hash(scenario.text.as_bytes()).to_hex().to_string(),
            seed,
            swept: scenario.sweep.is_some(),
            methods,
            program: env!("CARGO_PKG_VERSION").to_owned(),
            revision: self.revision.to_owned(),
            part: self.part.number(),
            of: self.part.of(),
            pieces: pieces(&cells, self.part),
            cells,
            measured: 0,
            told: Vec::new(),
        }
    }

    /// Fills the part's folder through `fill`, unless the part is there. What `methods` then tell stands beside the part's numbers, and not in its description:
    /// that is the same in all parts.
    fn put(
        &self,
        mut manifest: Manifest,
        methods: &[Configured],
        fill: impl FnOnce(&RecordsFolder, &NewFolder) -> Result<u64, RunError>,
    ) -> Result<Done, RunError> {
        let parts = self.folder.join(self.part.folder());
        let folder = parts.join(&manifest.scenario);
        let records = RecordsFolder::of_part(&parts, &manifest.scenario, self.origin)?;
        if let Some(there) = self.there(&folder, &manifest)? {
            return Ok(Done { folder, manifest: there, there: true });
        }
        records.replace(|new| {
            manifest.measured = fill(&records, new)?;
            manifest.told = told(methods).into_iter().map(|(method, told)| ToldBy { method: method.to_owned(), told }).collect();
            Ok::<_, RunError>(new.write(PART, |file| write(file, &manifest))?)
        })?;
        Ok(Done { folder, manifest, there: false })
    }

    /// The part that is in `folder`, if it is whole, the wanted one, and not to be computed again.
    fn there(&self, folder: &Path, wanted: &Manifest) -> Result<Option<Manifest>, RunError> {
        if self.again {
            return Ok(None);
        }
        let Some(there) = Manifest::read(folder).map_err(io::Error::other)? else { return Ok(None) };
        if let Some(difference) = wanted.difference(&there) {
            let why = format!("holds part {} of another run ({difference}); expected another folder, or --again to replace it", self.part);
            return Err(io::Error::new(io::ErrorKind::AlreadyExists, format!("{}: {why}", folder.display())).into());
        }
        // One that lacks a file is computed again.
        Ok(intact(folder).is_ok().then_some(there))
    }
}
