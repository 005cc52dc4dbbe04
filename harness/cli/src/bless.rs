//! `calibench bless`: today's numbers become the baseline.

use std::io::{BufRead, IsTerminal, Write};

use calibench_gate::{Access, Baselines, CEILINGS, Ceilings, Change, Finding, Results, Table};
use calibench_scenario::Scenario;
use clap::Args;

use super::context::Context;
use super::gated::{Keep, Source, cell_verdicts, gated, locked, scenarios};
use super::stored::Reusing;
use crate::deliver::print;
use crate::failure::Failure;

#[derive(Args)]
pub struct Bless {
    /// Names of scenarios [default: all]
    #[arg(value_name = "SCENARIO")]
    scenarios: Vec<String>,
    /// Accept without asking
    #[arg(long)]
    yes: bool,
    #[command(flatten)]
    reusing: Reusing,
}

impl Bless {
    /// Everything, without asking, and without leaving a store.
    pub fn all() -> Self {
        Self { scenarios: Vec::new(), yes: true, reusing: Reusing::nothing() }
    }

    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let folder = context.root()?.join("reference/baselines");
        // What is missing is said before anything is run.
        let mut ceilings =
            if Baselines::open_or_new(&folder)?.is_new() { Ceilings::default() } else { Ceilings::read(&folder.join(CEILINGS))? };
        let mut available = |scenario: &Scenario, _: Option<usize>, table: &Table| all_available(&scenario.name, table);
        let stored = self.reusing.open(context)?;
        let mut source = Source { records: None, kept: Some(Keep::new(context)?), each: &mut available, stored: &stored };
        let all = gated(context, &scenarios(context, &self.scenarios)?, &mut source)?;
        let mut verdicts = cell_verdicts(context, &source)?;
        let whole = self.scenarios.is_empty();
        // From here to the last file this is the only one that blesses.
        std::fs::create_dir_all(&folder)?;
        let _lock = locked(&folder, Access::Bless)?;
        let baselines = Baselines::open_or_new(&folder)?;
        let gone = baselines.gone(&all, &verdicts, whole)?;
        let mut changed: Vec<Change<'_>> = all.iter().flat_map(|one| baselines.changes(one)).collect();
        changed.extend(baselines.changed_verdicts(&mut verdicts, whole));
        changed.iter().try_for_each(|change| print(&change.news))?;
        for path in &gone {
            print(&format!("{}: nothing makes these numbers any more, the file will be removed\n", path.display()))?;
        }
        let tables: Vec<&Table> = all.iter().filter_map(Results::table).collect();
        ceilings.list.retain(|ceiling| whole || all.iter().any(|one| one.scenario == ceiling.scenario));
        for Finding { scenario, method, message, .. } in ceilings.check(&tables) {
            print(&format!("{method} in {scenario}: {message}; blessing moves no ceiling, and a check fails\n"))?;
        }
        if changed.is_empty() && gone.is_empty() {
            return print("nothing to bless: every baseline is as today\n");
        }
        if !self.yes && !confirmed(changed.len() + gone.len())? {
            return Err(Failure::input("nothing was blessed"));
        }
        let mut printed = Ok(());
        baselines.bless(&changed, &gone, &mut |path| {
            if printed.is_ok() {
                printed = print(&format!("blessed {}\n", path.display()));
            }
        })?;
        printed
    }
}

/// A build that lacks a method must not bless its figures away.
fn all_available(scenario: &str, table: &Table) -> Result<(), Failure> {
    let absent = table.methods().find_map(|(label, method)| Some((label, method.unavailable.as_ref()?)));
    absent.map_or(Ok(()), |(label, why)| {
        Err(Failure::input(format!("{scenario}: `{label}` is unavailable ({why}); bless with a build that has it")))
    })
}

fn confirmed(count: usize) -> Result<bool, Failure> {
    if !std::io::stdin().is_terminal() {
        return Err(Failure::input("bless asks before it writes: answer on a terminal, or use --yes after looking"));
    }
    // Who was not asked has not answered.
    write!(std::io::stderr(), "accept {count} baseline{} as above? [y/N] ", if count == 1 { "" } else { "s" }).map_err(|error| {
        Failure::input(format!("standard error: {error}; bless asks there before it writes, or use --yes after looking"))
    })?;
    let mut answer = String::new();
    std::io::stdin().lock().read_line(&mut answer)?;
    Ok(matches!(answer.trim(), "y" | "Y" | "yes"))
}
