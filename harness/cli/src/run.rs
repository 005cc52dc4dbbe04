//! `calibench run`.

use std::collections::BTreeSet;
use std::time::Instant;

use calibench_measure::Configured;
use calibench_run::reuse::Tally;
use calibench_run::{Order, Plan, Ran};
use calibench_scenario::{Scenario, Subject, Sweep, Transfer};
use clap::Args;

use super::context::{Context, Pictured};
use super::lanes::{lanes, side_by_side};
use super::notes::{say_absent_calibrators, say_notes};
use super::pages::Pages;
use super::part::{Parts, Place, told};
use super::photos::say_turns;
use super::progress::Progress;
use super::stored::{self, Reusing, Stored};
use crate::failure::Failure;

#[derive(Args)]
pub struct Run {
    /// Names of scenarios or of families of them, as corners/noise or corners, or TOML files
    #[arg(required_unless_present = "all", value_name = "SCENARIO")]
    scenarios: Vec<String>,
    /// Every scenario that `list scenarios` lists
    #[arg(long, conflicts_with = "scenarios")]
    all: bool,
    /// Write each family's pages as soon as its scenarios are done, those of short families first, and say how long the rest takes
    #[arg(long, requires = "all", conflicts_with = "part")]
    pages: bool,
    #[command(flatten)]
    changes: Changes,
    #[command(flatten)]
    parts: Parts,
    #[command(flatten)]
    reusing: Reusing,
}

/// What is to be run.
struct Asked {
    /// Scenarios and files.
    names: Vec<String>,
    /// Those that nobody named one by one.
    of_families: BTreeSet<String>,
}

impl Asked {
    fn all(context: &Context<'_>) -> Result<Self, Failure> {
        let names = context.catalogue()?.names()?;
        Ok(Self { of_families: names.iter().cloned().collect(), names })
    }

    /// What is named, with the scenarios of a family in its place.
    fn of(context: &Context<'_>, given: &[String]) -> Result<Self, Failure> {
        // Files need no project.
        let known = if context.folder()?.is_some() { Self::all(context)?.names } else { Vec::new() };
        let mut asked = Self { names: Vec::new(), of_families: BTreeSet::new() };
        for name in given {
            let family = format!("{}/", name.trim_end_matches('/'));
            let own: Vec<String> = known.iter().filter(|known| known.starts_with(&family)).cloned().collect();
            if own.is_empty() || known.contains(name) {
                asked.names.push(name.clone());
            } else {
                asked.names.extend(own.iter().cloned());
                asked.of_families.extend(own);
            }
        }
        Ok(asked)
    }
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
    place: &'a Place,
    /// In place of its own, if there are any.
    methods: &'a [Configured],
    revision: &'a str,
    /// Whether another one is run beside it.
    beside: bool,
    stored: &'a Stored,
    tally: &'a Tally,
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
        let Asked { mut names, of_families } = if self.all { Asked::all(context)? } else { Asked::of(context, &self.scenarios)? };
        // All are checked before the first is run.
        let mut scenarios = context.scenarios(&names)?;
        // A command of their own runs the others.
        let is_apart = |scenario: &Scenario| of_families.contains(&scenario.name) && scenario.nightly && scenario.subject.runs_apart();
        let apart: Vec<String> = scenarios.iter().filter(|scenario| is_apart(scenario)).map(|scenario| scenario.name.clone()).collect();
        scenarios.retain(|scenario| !apart.contains(&scenario.name));
        names.retain(|name| !apart.contains(name));
        if scenarios.is_empty() {
            return Err(Failure::input(format!(
                "nothing to run: {} take long and are run by their own names, those of the league by `calibench league`",
                apart.join(", ")
            )));
        }
        let pages = if self.pages { Some(Pages::of(context, &mut names)?) } else { None };
        if self.pages {
            scenarios.sort_by_cached_key(|scenario| names.iter().position(|name| *name == scenario.name));
        }
        let methods = self.changes.methods(context)?;
        let place = |(name, scenario): (&String, &Scenario)| self.parts.place(context, name, scenario);
        let places = names.iter().zip(&scenarios).map(place).collect::<Result<Vec<_>, Failure>>()?;
        let revision = context.revision()?;
        let beside = scenarios.len() > 1 && lanes() > 1;
        // Parts are put together elsewhere: what they take from a store would be of one machine.
        let stored = if self.parts.are_asked_for() { Stored::none() } else { self.reusing.open(context)? };
        let tallies: Vec<Tally> = scenarios.iter().map(|_| Tally::default()).collect();
        let task =
            |((scenario, place), tally)| Task { scenario, place, methods: &methods, revision: &revision, beside, stored: &stored, tally };
        let tasks: Vec<Task<'_>> = scenarios.iter().zip(&places).zip(&tallies).map(task).collect();
        let measured = side_by_side(&tasks, lanes(), |task| {
            let measured = self.one(context, task)?;
            pages.as_ref().map_or(Ok(()), |pages| pages.done(context, &task.scenario.name))?;
            Ok::<_, Failure>(measured)
        });
        stored.close(context.quiet, &tallies);
        let measured = measured?;
        let nothing: Vec<&str> =
            scenarios.iter().zip(measured).filter(|(_, points)| *points == Some(0)).map(|(s, _)| s.name.as_str()).collect();
        // Of all that there is, some may be unavailable here; what was asked for by name may not.
        let is_of_family = |name: &&str| of_families.contains(*name);
        if nothing.iter().all(is_of_family) && nothing.len() < scenarios.len() {
            return Ok(());
        }
        Err(Failure::input(format!("{}: nothing was measured", nothing.join(", "))))
    }

    /// How many points were measured, of all trials; of a part nothing is said here.
    fn one(&self, context: &Context<'_>, task: &Task<'_>) -> Result<Option<u64>, Failure> {
        let Task { scenario, place, methods, revision, stored, tally, .. } = *task;
        let Changes { seed, trials, .. } = self.changes;
        let (registry, tools, data) = (context.registry()?, context.tools()?, context.data()?);
        let order = Order { scenario, methods, trials, seed, tools, data, reuse: stored.reuse(tally), registry, stop: None };
        order.check()?;
        let plan = order.plan();
        plan.as_ref().map_or(Ok(()), say_before)?;
        let place = place.of_run(revision);
        let started = Instant::now();
        let progress = Progress::start(&scenario.name, order.steps(&place), context.quiet);
        let ran = order.run(&place, revision, &|| progress.step())?;
        progress.finish(&match stored::told(tally) {
            Some(kept) if stored::is_current(tally) => kept,
            Some(kept) => format!("{}; {kept}", told_of(&order, plan.as_ref(), &ran, &task.time(started))),
            None => told_of(&order, plan.as_ref(), &ran, &task.time(started)),
        });
        say_notes(order.measuring());
        Ok(match ran {
            Ran::Whole(measured) => Some(measured),
            Ran::Part(_) => None,
        })
    }
}

/// What was run: by its `plan`, if it is no sweep.
fn told_of(order: &Order<'_>, plan: Option<&Plan<'_>>, ran: &Ran, time: &str) -> String {
    match (plan, ran) {
        (Some(plan), Ran::Whole(_)) => summary(plan, time),
        (plan, Ran::Part(done)) => told(done, plan.and_then(Plan::missing), time),
        (None, Ran::Whole(_)) => {
            let trials = order.trials.unwrap_or(order.scenario.trials);
            format!("{} cells of {trials} trials {time}", order.scenario.sweep.as_ref().map_or(0, Sweep::cells))
        }
    }
}

/// Says what is doubtful of a scenario, and how its photographs are turned.
fn say_before(plan: &Plan<'_>) -> Result<(), Failure> {
    if let Some(warning) = plan.transfer().and_then(Transfer::warning) {
        say!("{}: {warning}", plan.scenario.name);
    }
    if let (Subject::Photographs(subject), None) = (&plan.scenario.subject, plan.missing()) {
        let photos = plan.data.join(&subject.folder);
        say_turns(&subject.files.iter().map(|file| photos.join(file)).collect::<Vec<_>>())?;
    }
    say_absent_calibrators(plan);
    Ok(())
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
