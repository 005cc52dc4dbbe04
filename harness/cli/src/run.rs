//! `calibench run`.

use std::time::Instant;

use calibench_measure::Configured;
use calibench_run::Plan;
use calibench_run::store::{self, RecordsFolder, SweepPlan};
use calibench_scenario::{Scenario, Subject, Sweep, Transfer};
use clap::Args;

use super::context::{Context, Pictured, origin};
use super::lanes::{lanes, side_by_side};
use super::notes::say_notes;
use super::output;
use super::photos::say_turns;
use super::progress::Progress;
use crate::failure::Failure;

#[derive(Args)]
pub struct Run {
    /// Names of scenarios, or TOML files
    #[arg(required_unless_present = "all", value_name = "SCENARIO")]
    scenarios: Vec<String>,
    /// Every scenario that `list scenarios` lists
    #[arg(long, conflicts_with = "scenarios")]
    all: bool,
    #[command(flatten)]
    changes: Changes,
}

/// What differs from the scenario's file.
#[derive(Args)]
pub struct Changes {
    /// Methods in place of the scenario's, as in forstner:window=15; kinds of targets before it limit one, as in disc+square=centroid
    #[arg(short, long = "method", value_name = "METHOD")]
    methods: Vec<String>,
    /// Number of trials in place of the scenario's
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    trials: Option<u64>,
    /// Seed in place of the scenario's
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    seed: Option<u64>,
}

impl Changes {
    /// The methods that are asked for; none if the scenario's own are meant.
    pub fn methods(&self, context: &Context<'_>) -> Result<Vec<Configured>, Failure> {
        context.methods(&self.methods, Pictured::Renders)
    }
}

/// A scenario that is run.
struct Task<'a> {
    scenario: &'a Scenario,
    folder: &'a RecordsFolder,
    /// In place of its own, if there are any.
    methods: &'a [Configured],
    revision: &'a str,
    /// Whether another one is run beside it.
    beside: bool,
}

impl Task<'_> {
    /// What it took; beside another it waits for processors, too.
    fn time(&self, started: Instant) -> String {
        let beside = if self.beside { " beside another" } else { "" };
        format!("in {:.1} s{beside}", started.elapsed().as_secs_f64())
    }
}

impl Run {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let names = if self.all { context.catalogue()?.names()? } else { self.scenarios.clone() };
        // All are checked before the first is run.
        let scenarios = context.scenarios(&names)?;
        let methods = self.changes.methods(context)?;
        let records = context.places()?.records;
        let folder = |(name, scenario): (&String, &Scenario)| -> Result<RecordsFolder, Failure> {
            let path = records.join(&scenario.name);
            output::apart(&path, &context.inputs(name, scenario))?;
            Ok(RecordsFolder::open(&records, &scenario.name, origin(name, scenario))?)
        };
        let folders = names.iter().zip(&scenarios).map(folder).collect::<Result<Vec<_>, Failure>>()?;
        let revision = context.revision()?;
        let beside = scenarios.len() > 1 && lanes() > 1;
        let task = |(scenario, folder)| Task { scenario, folder, methods: &methods, revision: &revision, beside };
        let tasks: Vec<Task<'_>> = scenarios.iter().zip(&folders).map(task).collect();
        let measured = side_by_side(&tasks, lanes(), |task| match &task.scenario.sweep {
            Some(sweep) => self.sweep(context, task, sweep),
            None => self.one(context, task),
        })?;
        let nothing: Vec<&str> = scenarios.iter().zip(measured).filter(|(_, points)| *points == 0).map(|(s, _)| s.name.as_str()).collect();
        // Of all that there is, some may be unavailable here; what was asked for by name may not.
        if nothing.is_empty() || (self.all && nothing.len() < scenarios.len()) {
            return Ok(());
        }
        Err(Failure::input(format!("{}: nothing was measured", nothing.join(", "))))
    }

    /// How many points were measured.
    fn one(&self, context: &Context<'_>, task: &Task<'_>) -> Result<u64, Failure> {
        let Task { scenario, folder, methods, revision, .. } = *task;
        let mut plan = Plan::new(scenario, context.toolbox.tools(), context.data()?);
        if !methods.is_empty() {
            plan.methods = methods;
        }
        own_methods(scenario, methods)?;
        if let Some(warning) = plan.transfer().and_then(Transfer::warning) {
            say!("{}: {warning}", scenario.name);
        }
        plan.seed = self.changes.seed.unwrap_or(scenario.seed);
        plan.trials = trials(scenario, self.changes.trials)?;
        if let (Subject::Photographs(subject), None) = (&scenario.subject, plan.missing()) {
            let photos = plan.data.join(&subject.folder);
            say_turns(&subject.files.iter().map(|file| photos.join(file)).collect::<Vec<_>>())?;
        }
        let started = Instant::now();
        let progress = Progress::start(&scenario.name, plan.steps(), context.quiet);
        let measured = store::run(folder, &mut plan, revision, &|| progress.step())?;
        progress.finish(&summary(&plan, &task.time(started)));
        say_notes(plan.methods);
        Ok(measured)
    }

    fn sweep(&self, context: &Context<'_>, task: &Task<'_>, sweep: &Sweep) -> Result<u64, Failure> {
        let Task { scenario, folder, methods, revision, .. } = *task;
        if sweep.changes_methods() && !methods.is_empty() {
            return Err(Failure::input(format!("-m: `{}` sweeps the parameters of its own methods; leave out -m", scenario.name)));
        }
        own_methods(scenario, methods)?;
        if let Some(method) = scenario.methods.iter().chain(methods).find(|method| method.recorded().is_some()) {
            let (label, name) = (&method.label, &scenario.name);
            return Err(Failure::input(format!(
                "`{label}` is a file of positions, and `{name}` is a sweep, of which `render` makes the first cell alone; expected a scenario without [sweep]"
            )));
        }
        let Changes { seed, trials, .. } = self.changes;
        let (registry, tools) = (context.registry()?, context.toolbox.tools());
        let plan = SweepPlan { scenario, sweep, methods, seed, trials, tools, data: context.data()?, registry };
        let (started, cells) = (Instant::now(), sweep.cells());
        let progress = Progress::start(&scenario.name, cells as u64, context.quiet);
        let measured = store::run_sweep(folder, &plan, revision, &|| progress.step())?;
        let trials = trials.unwrap_or(scenario.trials);
        progress.finish(&format!("{cells} cells of {trials} trials {}", task.time(started)));
        say_notes(if methods.is_empty() { &scenario.methods } else { methods });
        Ok(measured)
    }
}

/// Calibrations that are applied, and printed figures, are a scenario's own: none of the methods that measure takes their place.
fn own_methods(scenario: &Scenario, methods: &[Configured]) -> Result<(), Failure> {
    let own = match &scenario.subject {
        Subject::Views(views) => views.transfer.is_some(),
        subject => matches!(subject, Subject::Printed(_)),
    };
    let message = || format!("-m: `{}` measures nothing: its calibrations or printed figures are its own; leave out -m", scenario.name);
    if own && !methods.is_empty() { Err(Failure::input(message())) } else { Ok(()) }
}

fn trials(scenario: &Scenario, asked: Option<u64>) -> Result<u64, Failure> {
    match asked {
        Some(trials) if trials > 1 && scenario.is_deterministic() => Err(Failure::input(format!(
            "--trials {trials}: nothing is random in `{}`, every trial would be the same; expected 1",
            scenario.name
        ))),
        asked => Ok(asked.unwrap_or(scenario.trials)),
    }
}

fn summary(plan: &Plan<'_>, time: &str) -> String {
    if let Some(why) = plan.missing() {
        return format!("unavailable: {why}");
    }
    let missing = plan.method_infos().into_iter().filter_map(|m| m.unavailable.map(|why| format!("; {} unavailable: {why}", m.label)));
    let (count, steps) = (plan.method_infos().len(), plan.steps());
    let unit = if matches!(plan.scenario.subject, Subject::Photographs(_)) { "photograph" } else { "trial" };
    let plural = |n: u64, noun: &str| if n == 1 { format!("1 {noun}") } else { format!("{n} {noun}s") };
    format!("{} of {} {time}{}", plural(steps, unit), plural(count as u64, "method"), missing.collect::<String>())
}
