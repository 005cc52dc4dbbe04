//! `calibench check`: the accuracy gate.

use std::path::{Path, PathBuf};

use calibench_gate::{
    BaselineError, Ceilings, Cells, Check as Gate, FigureSums, Finding, INDEX, Index, Rules, Table, Verdict, Verdicts, baseline_path,
    figures_path, json, junit, read_baseline, render,
};
use calibench_scenario::Scenario;
use clap::Args;

use super::context::Context;
use super::gated::{Gated, Keep, Outcome, Source, cell_verdicts, folder_of, gated};
use super::recorded::stored;
use crate::deliver::{deliver, print};
use crate::failure::Failure;

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
    /// Compare with these records of an earlier run, point by point, in place of the baselines
    #[arg(long, value_name = "RECORDS")]
    against: Option<PathBuf>,
    /// Take these records of an earlier run in place of running the scenarios now
    #[arg(long, value_name = "RECORDS")]
    records: Option<PathBuf>,
    /// Print all findings as JSON
    #[arg(long)]
    json: bool,
    /// Write all findings as JUnit XML, a test case for each method of each scenario
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
}

impl Check {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        if let Some(against) = &self.against {
            return self.against(context, against);
        }
        let folder = context.root()?.join("reference/baselines");
        // What is missing is said before anything is run.
        let (index, mut ceilings) = (Index::read(&folder)?, Ceilings::read(&folder.join("ceilings.toml"))?);
        let mut source = Source { records: self.records.clone(), kept: Some(Keep::new(context)?), each: &mut |_, _, _| Ok(()) };
        let all = gated(context, &self.scenarios, &mut source)?;
        let mut gate = Gate::new();
        for one in &all {
            compare(&mut gate, one, &folder, &index);
        }
        if self.scenarios.is_empty() {
            vanished(&folder, &all, &index, &mut gate)?;
        } else {
            ceilings.list.retain(|ceiling| all.iter().any(|one| one.scenario.name == ceiling.scenario));
        }
        published(&mut gate, &folder, &index, &cell_verdicts(context, &source)?, self.scenarios.is_empty());
        let tables: Vec<&Table> = all.iter().filter_map(Gated::table).collect();
        gate.ceilings(&ceilings, &tables);
        let of = |table: &&Table| table.methods().map(|(label, _)| (table.scenario.clone(), label.to_string())).collect::<Vec<_>>();
        self.report(gate, &tables.iter().flat_map(of).collect::<Vec<_>>())
    }

    /// Compares with records instead of baselines.
    fn against(&self, context: &Context<'_>, against: &Path) -> Result<(), Failure> {
        let (mut gate, mut compared) = (Gate::new(), Vec::new());
        let mut each = |scenario: &Scenario, cell: Option<usize>, table: &Table| {
            let mut earlier = stored(&folder_of(against, scenario, cell), &table.scenario, scenario)?;
            if cell.is_some() {
                earlier.text.clone_from(&table.text);
            }
            gate.compare(&earlier, table, scenario.is_deterministic());
            gate.compare_cells(&figures(&earlier), &figures(table));
            compared.extend(table.methods().map(|(label, _)| (table.scenario.clone(), label.to_string())));
            Ok(())
        };
        gated(context, &self.scenarios, &mut Source { records: self.records.clone(), kept: None, each: &mut each })?;
        self.report(gate, &compared)
    }

    fn report(&self, gate: Gate, compared: &[(String, String)]) -> Result<(), Failure> {
        let rules = Rules { strict: self.strict, locked: self.locked };
        let tally = gate.tally();
        let findings = gate.conclude();
        if let Some(path) = &self.junit {
            let text = junit(&findings, compared, rules);
            deliver(Some(path.as_path()), |file| file.write_all(text.as_bytes()))?;
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

/// The figures of one run as if it were a scenario without a sweep.
fn figures(table: &Table) -> Cells<FigureSums> {
    let mut cells = Cells::new(&table.scenario, &table.text, table.seed, table.coordinates);
    cells.add("", table);
    cells
}

/// Compares one scenario with its baseline; a baseline that is not what was blessed is a finding, and the others are still compared.
fn compare(gate: &mut Gate, one: &Gated, folder: &Path, index: &Index) {
    let name = &one.scenario.name;
    let path = baseline_path(folder, name);
    match &one.outcome {
        Outcome::Points(table) => {
            if let Some(baseline) = blessed(gate, name, &path, index, read_baseline(&path, name)) {
                gate.compare(&baseline, table, one.scenario.is_deterministic());
            } else if !index.lists(&path) {
                gate.unblessed(table);
            }
        }
        Outcome::Sums(sums) => {
            if let Some(baseline) = blessed(gate, name, &path, index, Cells::read(&path, name)) {
                gate.compare_cells(&baseline, sums);
            } else if !index.lists(&path) {
                let message = format!("not blessed yet: {} cells", sums.len());
                gate.note(Finding::new(Verdict::Unblessed, name, "all methods", "cells", message));
            }
        }
        Outcome::NotCompared(why) => {
            return gate.note(Finding::new(Verdict::Informs, name, "all methods", "untested", format!("not compared: {why}")));
        }
    }
    let path = figures_path(folder, name);
    let Some(baseline) = blessed(gate, name, &path, index, Cells::<FigureSums>::read(&path, name)) else {
        if one.figures.is_some() && !index.lists(&path) {
            gate.note(Finding::new(Verdict::Unblessed, name, "all methods", "figures", "figures of adjustments: not blessed yet"));
        }
        return;
    };
    match &one.figures {
        Some(now) => gate.compare_cells(&baseline, now),
        None => gate.note(Finding::new(Verdict::Fails, name, "all methods", "figures", "there are no figures of adjustments any more")),
    }
}

/// The content of a file if it is there; what is wrong with it is noted.
fn blessed<T>(gate: &mut Gate, name: &str, path: &Path, index: &Index, read: Result<Option<(T, String)>, BaselineError>) -> Option<T> {
    let fails = |why: String| Finding::new(Verdict::Fails, name, "all methods", "baseline", why);
    let found = match read {
        Ok(found) => found,
        Err(error) => {
            gate.note(fails(error.to_string()));
            return None;
        }
    };
    let checksum = found.as_ref().map(|(_, sum)| sum.as_str());
    if let Some(why) = index.mistake(path, checksum) {
        gate.note(fails(why));
    }
    found.map(|(content, _)| content)
}

/// Compares the verdicts of published cells; of some scenarios alone, those of the tables that stand on them.
fn published(gate: &mut Gate, folder: &Path, index: &Index, now: &Verdicts, whole: bool) {
    let path = Verdicts::path(folder);
    let Some(mut baseline) = blessed(gate, "published tables", &path, index, Verdicts::read(&path)) else {
        if !now.0.is_empty() && !index.lists(&path) {
            gate.note(Finding::new(
                Verdict::Unblessed,
                "published tables",
                "",
                "published cell",
                "verdicts of published cells: not blessed yet",
            ));
        }
        return;
    };
    if !whole {
        baseline.0.retain(|[table, ..], _| now.0.keys().any(|[other, ..]| other == table));
    }
    gate.verdicts(&baseline, now);
}

/// Every baseline whose scenario is gone.
fn vanished(folder: &Path, all: &[Gated], index: &Index, gate: &mut Gate) -> Result<(), Failure> {
    let paths = |one: &Gated| [baseline_path(folder, &one.scenario.name), figures_path(folder, &one.scenario.name)];
    let known: Vec<PathBuf> = all.iter().flat_map(paths).chain([Verdicts::path(folder)]).collect();
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    files.extend(index.files.keys().map(|file| folder.join(file)));
    files.sort();
    files.dedup();
    for path in files.into_iter().filter(|path| path.extension().is_some_and(|e| e == "csv") && !known.contains(path)) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().replace("--", "/");
        let message = if index.lists(&path) {
            "the scenario is gone, its baseline is blessed: restore it, or `calibench bless`".to_owned()
        } else {
            format!("there is no such scenario, and its baseline is not in {INDEX}: remove {}", path.display())
        };
        gate.note(Finding::new(Verdict::Fails, &name, "all methods", "scenario", message));
    }
    Ok(())
}
