//! `calibench check`: the accuracy gate.

use std::path::{Path, PathBuf};

use calibench_exchange::atomic::write_atomically;
use calibench_gate::{
    Ceilings, Check as Gate, Finding, INDEX, Index, Rules, Table, Verdict, baseline_path, json, junit, read_baseline, render,
};
use clap::Args;

use super::context::Context;
use super::gated::{Gated, Outcome, gated};
use super::{Failure, print};

#[derive(Args)]
pub struct Check {
    /// Names of scenarios [default: all]
    #[arg(value_name = "SCENARIO")]
    scenarios: Vec<String>,
    /// Fail on every number that changed without a bless, not only on what is worse
    #[arg(long)]
    strict: bool,
    /// Fail on everything that is not blessed: scenarios, methods, points
    #[arg(long)]
    locked: bool,
    /// Print all findings as JSON
    #[arg(long)]
    json: bool,
    /// Write all findings as JUnit XML, a test case for each method of each scenario
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
}

impl Check {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let folder = context.root()?.join("reference/baselines");
        // What is missing is said before anything is run.
        let (index, mut ceilings) = (Index::read(&folder)?, Ceilings::read(&folder.join("ceilings.toml"))?);
        let all = gated(context, &self.scenarios)?;
        let mut gate = Gate::new();
        for one in &all {
            compare(&mut gate, one, &folder, &index);
        }
        if self.scenarios.is_empty() {
            vanished(&folder, &all, &index, &mut gate)?;
        } else {
            ceilings.list.retain(|ceiling| all.iter().any(|one| one.scenario.name == ceiling.scenario));
        }
        let tables: Vec<&Table> = all.iter().filter_map(Gated::table).collect();
        gate.ceilings(&ceilings, &tables);
        self.report(gate, &tables)
    }

    fn report(&self, gate: Gate, tables: &[&Table]) -> Result<(), Failure> {
        let rules = Rules { strict: self.strict, locked: self.locked };
        let tally = gate.tally();
        let findings = gate.conclude();
        if let Some(path) = &self.junit {
            let of = |table: &&Table| table.methods().map(|(label, _)| (table.scenario.clone(), label.to_string())).collect::<Vec<_>>();
            let compared: Vec<(String, String)> = tables.iter().flat_map(of).collect();
            let text = junit(&findings, &compared, rules);
            write_atomically(path, |file| file.write_all(text.as_bytes()))
                .map_err(|error: std::io::Error| Failure::input(format!("{}: {error}", path.display())))?;
        }
        print(&if self.json { json(&findings, rules, tally) } else { render(&findings, rules, tally) })?;
        if findings.iter().any(|finding| finding.fails_by(rules)) {
            return Err(Failure::Gate);
        }
        if tally.methods == 0 {
            return Err(Failure::input("nothing was compared: none of the scenarios has a blessed method that could be run"));
        }
        Ok(())
    }
}

/// Compares one scenario with its baseline; a baseline that is not what was blessed is a finding, and the others are still compared.
fn compare(gate: &mut Gate, one: &Gated, folder: &Path, index: &Index) {
    let name = &one.scenario.name;
    let table = match &one.outcome {
        Outcome::Points(table) => table,
        Outcome::NotCompared(why) => {
            return gate.note(Finding::new(Verdict::Informs, name, "all methods", "untested", format!("not compared: {why}")));
        }
    };
    let path = baseline_path(folder, name);
    let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let fails = |why: String| Finding::new(Verdict::Fails, name, "all methods", "baseline", why);
    match read_baseline(&path, name) {
        Err(error) => gate.note(fails(error.to_string())),
        Ok(None) => match index.mistake(&file, None) {
            Some(why) => gate.note(fails(why)),
            None => gate.unblessed(table),
        },
        Ok(Some((baseline, checksum))) => {
            if let Some(why) = index.mistake(&file, Some(&checksum)) {
                gate.note(fails(why));
            }
            gate.compare(&baseline, table, one.scenario.is_deterministic());
        }
    }
}

/// Every baseline whose scenario is gone.
fn vanished(folder: &Path, all: &[Gated], index: &Index, gate: &mut Gate) -> Result<(), Failure> {
    let known: Vec<PathBuf> = all.iter().map(|one| baseline_path(folder, &one.scenario.name)).collect();
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    files.extend(index.files.keys().map(|file| folder.join(file)));
    files.sort();
    files.dedup();
    for path in files.into_iter().filter(|path| path.extension().is_some_and(|e| e == "csv") && !known.contains(path)) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().replace("--", "/");
        let listed = if index.files.contains_key(&*path.file_name().unwrap_or_default().to_string_lossy()) { "blessed" } else { "not in" };
        let message = match listed {
            "blessed" => "the scenario is gone, its baseline is blessed: restore it, or `calibench bless`".to_owned(),
            _ => format!("the scenario is gone, and its baseline is not in {INDEX}: remove {}", path.display()),
        };
        gate.note(Finding::new(Verdict::Fails, &name, "all methods", "scenario", message));
    }
    Ok(())
}
