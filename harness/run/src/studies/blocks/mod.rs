//! Free networks within a run: what each method measured in a trial is adjusted block by block, without control and without truth.
//!
//! Start values are the surveyed places on the flat field, and resections from them. What is reported are the blocks' own figures: the truth has no part.

mod figures;
mod held;
mod location;
mod network;
mod residuals;
mod sights;

use calibench_model::Testfield;
use calibench_model::camera::Camera;
use calibench_random::Key;
use calibench_records::results::{Calibrated, Figure, PointResult};
use calibench_scenario::{Block, Blocks, ResidualPairs, Unit, ViewsSubject};
use calibench_synth::stations::Station;

use network::Solved;
use residuals::Residuals;
use sights::Sights;

use super::adjust::Adjust;

/// What blocks are made of.
#[derive(Clone, Copy)]
pub struct Job<'a> {
    /// What the scenario says.
    pub blocks: &'a Blocks,
    /// The field, with its coordinates as surveyed.
    pub field: &'a Testfield,
    /// The object unit.
    pub unit: Unit,
    /// The stations: their names alone.
    pub stations: &'a [Station],
    /// The trial's.
    pub key: Key<'a>,
}

impl Adjust for Blocks {
    fn adjust(&self, subject: &ViewsSubject, points: &[PointResult], methods: &[usize], key: Key<'_>) -> Vec<Calibrated> {
        let ViewsSubject { field, unit, stations, .. } = subject;
        adjust_blocks(&Job { blocks: self, field, unit: *unit, stations, key }, points, methods, key.trial == 0)
    }
}

/// Adjusts what each of `methods` measured in a trial. `first`: with every residual, and with heights where the bend is asked for.
pub fn adjust_blocks(job: &Job<'_>, points: &[PointResult], methods: &[usize], first: bool) -> Vec<Calibrated> {
    methods.iter().flat_map(|&method| of_method(job, points, method, first)).collect()
}

fn of_method(job: &Job<'_>, points: &[PointResult], method: usize, first: bool) -> Vec<Calibrated> {
    let sights = Sights::of(job, points, method);
    let mut all = Vec::new();
    // Of each block, the cameras of its groups, and its residuals.
    let mut cameras: Vec<Option<Vec<Camera>>> = Vec::new();
    let mut left: Vec<Residuals> = Vec::new();
    for (set, block) in job.blocks.list.iter().enumerate() {
        if !block.methods.contains(&method) {
            cameras.push(None);
            left.push(Residuals::default());
            continue;
        }
        let corrected = match block.corrected_by.map(|by| (by, cameras[by].clone())) {
            Some((by, None)) => Err(format!("`{}`, which corrects the coordinates, has no result", job.blocks.list[by].name)),
            Some((_, found)) => Ok(found),
            None => Ok(None),
        };
        let outcome = corrected.and_then(|corrected| {
            let groups = block.corrected_by.map_or(&block.groups, |by| &job.blocks.list[by].groups);
            network::adjusted(job, block, &sights, corrected.as_deref().map(|cameras| (groups.as_slice(), cameras)))
        });
        cameras.push(outcome.as_ref().ok().filter(|_| !block.several).map(|solved| solved[0].cameras.clone()));
        left.push(outcome.as_ref().map(|solved| residuals::of(solved)).unwrap_or_default());
        let outcome = outcome.and_then(|solved| {
            let mut found = told(job, block, &solved, first)?;
            if let ([one], true) = (&solved[..], block.corrected_by.is_some()) {
                found.extend(location::figures(job, block, one, points, method));
            }
            Ok(found)
        });
        all.push(Calibrated { method, set, outcome, check_failed: None });
    }
    let compared = job.blocks.residuals.as_ref().filter(|plan| plan.blocks.iter().all(|&b| job.blocks.list[b].methods.contains(&method)));
    if let Some(plan) = compared {
        let outcome = residuals::compared(plan, &left);
        all.push(Calibrated { method, set: job.blocks.list.len(), outcome, check_failed: None });
    }
    all
}

fn told(job: &Job<'_>, block: &Block, solved: &[Solved], first: bool) -> Result<Vec<Figure>, String> {
    let mut found = figures::counted(job, block, solved);
    if let [one] = solved
        && !block.several
    {
        found.extend(figures::parameters(one));
        found.extend(figures::by_image(job, one));
        let is_compared = |plan: &ResidualPairs| plan.blocks.iter().any(|&other| job.blocks.list[other].name == block.name);
        if first && job.blocks.residuals.as_ref().is_some_and(is_compared) {
            found.extend(figures::every_residual(job, one));
        }
        if let Some(over) = block.bend_over {
            found.extend(figures::bend(job, one, over)?);
            if first {
                found.extend(figures::heights(job, one));
            }
        }
    }
    Ok(found)
}
