//! Scenarios run in memory, for the gate.

use calibench_gate::{Coordinates, Table, fingerprint};
use calibench_measure::Configured;
use calibench_run::Plan;
use calibench_scenario::Scenario;

use super::Failure;
use super::context::Context;
use super::progress::Progress;

/// A scenario and what became of it.
pub struct Gated {
    pub scenario: Scenario,
    pub outcome: Outcome,
}

/// The results of a scenario as its file says: its own methods, seed and trials.
pub enum Outcome {
    /// Every point.
    Points(Table),
    /// Nothing that the gate compares, and why.
    NotCompared(String),
}

impl Gated {
    /// The points, if there are any.
    pub fn table(&self) -> Option<&Table> {
        match &self.outcome {
            Outcome::Points(table) => Some(table),
            Outcome::NotCompared(_) => None,
        }
    }
}

/// Runs the named scenarios, or all, in memory.
///
/// # Errors
/// A scenario that cannot be loaded or run, and none at all.
pub fn gated(context: &Context<'_>, names: &[String]) -> Result<Vec<Gated>, Failure> {
    let names = if names.is_empty() { context.catalogue()?.names()? } else { names.to_vec() };
    if names.is_empty() {
        let folder = context.root()?.join("scenarios");
        return Err(Failure::input(format!("{}: there is no scenario, so there is nothing to check", folder.display())));
    }
    let scenarios = names.iter().map(|name| context.scenario(name)).collect::<Result<Vec<_>, _>>()?;
    scenarios.into_iter().map(|scenario| one(context, scenario)).collect()
}

fn one(context: &Context<'_>, scenario: Scenario) -> Result<Gated, Failure> {
    if let Some(sweep) = &scenario.sweep {
        let why = format!("a sweep of {} cells: bless a scenario of the cell that matters", sweep.cells());
        return Ok(Gated { scenario, outcome: Outcome::NotCompared(why) });
    }
    // The gate compares errors with errors.
    let plan = Plan { bounds: false, ..Plan::new(&scenario, context.toolbox.detector.as_deref(), context.data()?) };
    if let Some(why) = plan.missing() {
        return Ok(Gated { outcome: Outcome::NotCompared(format!("unavailable: {why}")), scenario });
    }
    let progress = Progress::start(&scenario.name, plan.steps(), context.quiet);
    let table = table(&plan, &scenario.name, &|| progress.step())?;
    progress.finish("measured");
    Ok(Gated { scenario, outcome: Outcome::Points(table) })
}

/// Runs `plan` into a table called `name`.
fn table(plan: &Plan<'_>, name: &str, step: &(dyn Fn() + Sync)) -> Result<Table, Failure> {
    let scenario = plan.scenario;
    let mut table = Table::new(name, plan.seed, Coordinates::of(scenario.has_truth()), &plan.method_infos());
    table.text = fingerprint(&scenario.text);
    let detector = plan.detector_used().map(|(name, version)| format!("{name} {version}"));
    for method in plan.methods {
        table.describe(&method.label, settings(method), library(method, detector.as_deref()));
    }
    plan.run(step, &mut |trial| {
        table.add(&trial);
        Ok(())
    })?;
    Ok(table)
}

/// All parameters, those at their defaults among them.
fn settings(method: &Configured) -> String {
    method.settings.iter().map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>().join(",")
}

/// The libraries of this machine on which a method's numbers depend.
fn library(method: &Configured, detector: Option<&str>) -> String {
    let own = method.label.starts_with("opencv").then(|| format!("OpenCV {}", method.version));
    own.into_iter().chain(detector.map(str::to_owned)).collect::<Vec<_>>().join(", ")
}
