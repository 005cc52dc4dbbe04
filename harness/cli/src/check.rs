//! `calibench check` and `calibench bless`: the accuracy gate and its baselines.

use std::io::{BufRead, IsTerminal, Write};
use std::path::{Path, PathBuf};

use calibench_gate::{
    Ceilings, Check as Gate, Coordinates, Finding, Table, baseline_path, read_baseline, render, worse_than, write_baseline,
};
use calibench_run::Plan;
use calibench_scenario::Scenario;
use clap::Args;

use super::context::Context;
use super::progress::Progress;
use crate::deliver::print;
use crate::failure::Failure;

#[derive(Args)]
pub struct Check {
    /// Names of scenarios [default: all]
    #[arg(value_name = "SCENARIO")]
    scenarios: Vec<String>,
}

#[derive(Args)]
pub struct Bless {
    /// Names of scenarios [default: all]
    #[arg(value_name = "SCENARIO")]
    scenarios: Vec<String>,
    /// Accept without asking
    #[arg(long)]
    yes: bool,
}

/// A scenario and its results as its file says: its own methods, seed and trials.
struct Measured {
    scenario: Scenario,
    table: Table,
}

impl Check {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let measured = measure(context, &self.scenarios)?;
        let baselines = context.root()?.join("reference/baselines");
        let mut gate = Gate::new();
        for Measured { scenario, table } in &measured {
            match read_baseline(&baseline_path(&baselines, &scenario.name), &scenario.name)? {
                Some(baseline) => gate.compare(&baseline, table, scenario.is_deterministic()),
                None => gate.unblessed(table),
            }
        }
        let mut ceilings = Ceilings::read(&baselines.join("ceilings.toml"))?;
        if self.scenarios.is_empty() {
            vanished(&baselines, &context.catalogue()?.names()?, &mut gate)?;
        } else {
            ceilings.list.retain(|ceiling| measured.iter().any(|m| m.scenario.name == ceiling.scenario));
        }
        let tables: Vec<&Table> = measured.iter().map(|m| &m.table).collect();
        gate.ceilings(&ceilings, &tables);
        let findings = gate.conclude();
        print(&render(&findings))?;
        if findings.iter().any(Finding::fails) { Err(Failure::Gate) } else { Ok(()) }
    }
}

impl Bless {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let folder = context.root()?.join("reference/baselines");
        let mut changed = Vec::new();
        for Measured { scenario, table } in measure(context, &self.scenarios)? {
            all_available(&scenario.name, &table)?;
            let path = baseline_path(&folder, &scenario.name);
            let old = read_baseline(&path, &scenario.name)?;
            if old.as_ref().is_some_and(|old| same(old, &table)) {
                continue;
            }
            print(&news(&scenario.name, old.as_ref(), &table))?;
            changed.push((path, table));
        }
        if changed.is_empty() {
            return print("nothing to bless: every baseline is as today\n");
        }
        if !self.yes && !confirmed(changed.len())? {
            return Err(Failure::input("nothing was blessed"));
        }
        std::fs::create_dir_all(&folder)?;
        for (path, table) in &changed {
            write_baseline(path, table)?;
            print(&format!("blessed {}\n", path.display()))?;
        }
        Ok(())
    }
}

/// Every baseline whose scenario is gone: all its methods are missing.
fn vanished(baselines: &Path, scenarios: &[String], gate: &mut Gate) -> Result<(), Failure> {
    let known: Vec<PathBuf> = scenarios.iter().map(|name| baseline_path(baselines, name)).collect();
    let mut files: Vec<PathBuf> = std::fs::read_dir(baselines)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    files.sort();
    for path in files.into_iter().filter(|path| path.extension().is_some_and(|e| e == "csv") && !known.contains(path)) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().replace("--", "/");
        if let Some(baseline) = read_baseline(&path, &name)? {
            gate.compare(&baseline, &Table::new(name, baseline.seed, baseline.coordinates, &[]), true);
        }
    }
    Ok(())
}

/// Would both be written as the same baseline?
fn same(old: &Table, new: &Table) -> bool {
    let available = |table: &'_ Table| {
        table.methods().filter(|(_, m)| m.unavailable.is_none()).map(|(l, m)| (l.clone(), m.clone())).collect::<Vec<_>>()
    };
    old.seed == new.seed && old.coordinates == new.coordinates && available(old) == available(new)
}

/// A build that lacks a method must not bless its figures away.
fn all_available(scenario: &str, table: &Table) -> Result<(), Failure> {
    let absent = table.methods().find_map(|(label, method)| Some((label, method.unavailable.as_ref()?)));
    absent.map_or(Ok(()), |(label, why)| {
        Err(Failure::input(format!("{scenario}: `{label}` is unavailable ({why}); bless with a build that has it")))
    })
}

fn news(scenario: &str, old: Option<&Table>, new: &Table) -> String {
    let Some(old) = old else {
        let counts = new.methods().map(|(_, method)| method.counts());
        let [measured, lost, rejected] = counts.fold([0; 3], |sum, counts| [0, 1, 2].map(|i| sum[i] + counts[i]));
        return format!("{scenario}: new baseline, {measured} measured, {lost} lost, {rejected} rejected\n");
    };
    let worse = worse_than(old, new);
    let lines: String = worse.iter().map(|line| format!("    {line}\n")).collect();
    let verdict = if worse.is_empty() { "changed, nothing gets worse" } else { "gets worse:" };
    format!("{scenario}: {verdict}\n{lines}")
}

fn confirmed(count: usize) -> Result<bool, Failure> {
    if !std::io::stdin().is_terminal() {
        return Err(Failure::input("bless asks before it writes: answer on a terminal, or use --yes after looking"));
    }
    eprint!("accept {count} baseline{} as above? [y/N] ", if count == 1 { "" } else { "s" });
    std::io::stderr().flush()?;
    let mut answer = String::new();
    std::io::stdin().lock().read_line(&mut answer)?;
    Ok(matches!(answer.trim(), "y" | "Y" | "yes"))
}

/// Runs the named scenarios, or all, in memory. What is unavailable here is said and left out.
fn measure(context: &Context<'_>, names: &[String]) -> Result<Vec<Measured>, Failure> {
    let names = if names.is_empty() { context.catalogue()?.names()? } else { names.to_vec() };
    let scenarios = context.scenarios(&names)?;
    let mut measured = Vec::new();
    for scenario in scenarios {
        if let Some(sweep) = &scenario.sweep {
            print(&format!(
                "{}: a sweep of {} cells, not compared: bless a scenario of the cell that matters\n",
                scenario.name,
                sweep.cells()
            ))?;
            continue;
        }
        // The gate compares errors with errors.
        let plan = Plan { bounds: false, ..Plan::new(&scenario, context.toolbox.detector.as_deref(), context.data()?) };
        if let Some(why) = plan.missing() {
            print(&format!("{}: unavailable, not compared: {why}\n", scenario.name))?;
            continue;
        }
        let progress = Progress::start(&scenario.name, plan.steps(), context.quiet);
        let mut table = Table::new(scenario.name.as_str(), plan.seed, Coordinates::of(scenario.has_truth()), &plan.method_infos());
        plan.run(&|| progress.step(), &mut |trial| {
            table.add(&trial);
            Ok(())
        })?;
        progress.finish("measured");
        measured.push(Measured { scenario, table });
    }
    Ok(measured)
}
