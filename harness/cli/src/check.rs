//! `calibench check`: the accuracy gate.

use std::path::{Path, PathBuf};

use calibench_files::OutputFile;
use calibench_gate::{
    Access, Baselines, CEILINGS, Ceilings, Cells, Check as Gate, FigureSums, Finding, ImageSums, Kept, Results, Rules, Table, json, junit,
    not_tested, recorded, render,
};
use calibench_scenario::Scenario;
use clap::Args;

use super::context::Context;
use super::gated::{Keep, Source, cell_verdicts, folder_of, gated, locked, scenarios, unit};
use super::output;
use super::stored::Reusing;
use crate::deliver::print;
use crate::failure::Failure;

#[derive(Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
pub struct Check {
    /// Names of scenarios [default: all]
    #[arg(value_name = "SCENARIO")]
    scenarios: Vec<String>,
    /// Test also what is large only to be large, which is otherwise named as not tested
    #[arg(long, conflicts_with = "scenarios")]
    nightly: bool,
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
    #[command(flatten)]
    reusing: Reusing,
}

impl Check {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let junit = self.junit.as_deref().map(|path| output::findings("--junit", path)).transpose()?;
        if let Some(against) = &self.against {
            return self.against(context, against, junit.as_ref());
        }
        let folder = context.root()?.join("reference/baselines");
        // What is missing is said before anything is run.
        let (_, mut ceilings) = (Baselines::open(&folder)?, Ceilings::read(&folder.join(CEILINGS))?);
        let (stored, keep) = (self.reusing.open(context)?, Keep::new(context)?);
        let (wanted, left) = self.wanted(context, &keep)?;
        let mut source = Source { records: self.records.clone(), kept: Some(keep), each: &mut |_, _, _| Ok(()), stored: &stored };
        let all = gated(context, &wanted, &mut source)?;
        let verdicts = cell_verdicts(context, &source)?;
        // As they are now: somebody may have blessed while this ran.
        let _lock = locked(&folder, Access::Compare)?;
        let (baselines, mut gate) = (Baselines::open(&folder)?, Gate::new());
        for one in &all {
            baselines.compare(one, &mut gate);
        }
        if self.scenarios.is_empty() {
            baselines.vanished(&all, &left, &mut gate)?;
            ceilings.list.retain(|ceiling| !left.contains(&ceiling.scenario));
        } else {
            ceilings.list.retain(|ceiling| all.iter().any(|one| one.scenario == ceiling.scenario));
        }
        baselines.compare_verdicts(&verdicts, self.scenarios.is_empty(), &mut gate);
        let tables: Vec<&Table> = all.iter().filter_map(Results::table).collect();
        gate.ceilings(&ceilings, &tables);
        let of = |table: &&Table| table.methods().map(|(label, _)| (table.scenario.clone(), label.to_string())).collect::<Vec<_>>();
        self.report(gate, &tables.iter().flat_map(of).collect::<Vec<_>>(), &left, (junit.as_ref(), &wanted))
    }

    /// Compares with records instead of baselines.
    fn against(&self, context: &Context<'_>, against: &Path, junit: Option<&OutputFile>) -> Result<(), Failure> {
        let (mut gate, mut compared) = (Gate::new(), Vec::new());
        let mut each = |scenario: &Scenario, cell: Option<usize>, table: &Table| {
            let earlier = recorded(&folder_of(against, scenario, cell), &table.scenario, unit(scenario))?;
            gate.compare(&earlier, table, scenario.is_deterministic());
            gate.compare_cells(&alone::<FigureSums>(&earlier), &alone(table));
            gate.compare_cells(&alone::<ImageSums>(&earlier), &alone(table));
            compared.extend(table.methods().map(|(label, _)| (table.scenario.clone(), label.to_string())));
            Ok(())
        };
        let stored = self.reusing.open(context)?;
        let (wanted, left) = self.wanted(context, &Keep::new(context)?)?;
        gated(context, &wanted, &mut Source { records: self.records.clone(), kept: None, each: &mut each, stored: &stored })?;
        self.report(gate, &compared, &left, (junit, &wanted))
    }

    /// The scenarios that are compared, and the names of those that are left to a check with --nightly. What published tables stand on is never left: their verdicts
    /// are compared as a whole.
    fn wanted(&self, context: &Context<'_>, keep: &Keep) -> Result<(Vec<Scenario>, Vec<String>), Failure> {
        let all = scenarios(context, &self.scenarios)?;
        if self.nightly || !self.scenarios.is_empty() {
            return Ok((all, Vec::new()));
        }
        let (left, now): (Vec<_>, Vec<_>) = all.into_iter().partition(|scenario| scenario.nightly && !keep.has(&scenario.name));
        // Where all are left they are what is asked for.
        Ok(if now.is_empty() { (left, Vec::new()) } else { (now, left.into_iter().map(|scenario| scenario.name).collect()) })
    }

    fn report(
        &self,
        gate: Gate,
        compared: &[(String, String)],
        left: &[String],
        (findings_file, wanted): (Option<&OutputFile>, &[Scenario]),
    ) -> Result<(), Failure> {
        let rules = Rules { strict: self.strict, locked: self.locked };
        let tally = gate.tally();
        let mut findings = gate.conclude();
        name_sets(&mut findings, wanted);
        if let Some(file) = findings_file {
            let text = junit(&findings, compared, rules);
            file.write(|file| file.write_all(text.as_bytes()))?;
        }
        print(&if self.json { json(&findings, rules, tally, left) } else { render(&findings, rules, tally) + &not_tested(left) })?;
        if findings.iter().any(|finding| finding.fails_by(rules)) {
            return Err(Failure::Gate);
        }
        if tally.methods == 0 {
            return Err(Failure::input("nothing was compared: none of the scenarios has a blessed method that could be run"));
        }
        Ok(())
    }
}

/// Calls sets of figures as their scenarios do, and not by their numbers.
fn name_sets(findings: &mut [Finding], scenarios: &[Scenario]) {
    for finding in findings {
        let scenario = scenarios.iter().find(|scenario| finding.scenario.split('@').next() == Some(&scenario.name));
        let (Some(scenario), Some(target)) = (scenario, &mut finding.target) else { continue };
        let Some((number, rest)) = target.strip_prefix("set ").and_then(|text| text.split_once(' ')) else { continue };
        let name = number.parse::<usize>().ok().and_then(|number| scenario.subject.sets().into_iter().nth(number.wrapping_sub(1)));
        if let Some(name) = name {
            *target = format!("{name} {rest}");
        }
    }
}

/// What is kept of one run, as if it were of a scenario without a sweep.
fn alone<T: Kept>(table: &Table) -> Cells<T> {
    let mut cells = Cells::new(&table.scenario, &table.text, table.seed, table.coordinates);
    cells.add("", table);
    cells
}
