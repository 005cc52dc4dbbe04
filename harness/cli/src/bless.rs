//! `calibench bless`: today's numbers become the baseline.

use std::io::{BufRead, IsTerminal, Write};
use std::path::Path;

use calibench_gate::{Index, IndexError, Table, baseline_path, read_baseline, worse_than, write_baseline};
use clap::Args;

use super::context::Context;
use super::gated::gated;
use super::{Failure, print};

#[derive(Args)]
pub struct Bless {
    /// Names of scenarios [default: all]
    #[arg(value_name = "SCENARIO")]
    scenarios: Vec<String>,
    /// Accept without asking
    #[arg(long)]
    yes: bool,
}

impl Bless {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let folder = context.root()?.join("reference/baselines");
        let mut index = match Index::read(&folder) {
            Err(IndexError::Missing(_)) => Index::default(),
            other => other?,
        };
        let all = gated(context, &self.scenarios)?;
        let mut changed = Vec::new();
        for one in &all {
            let Some(table) = one.table() else { continue };
            all_available(&one.scenario.name, table)?;
            let path = baseline_path(&folder, &one.scenario.name);
            let file = file_name(&path);
            // A baseline that is damaged, or of an older version, is replaced as if there were none.
            let old = read_baseline(&path, &one.scenario.name);
            let listed = matches!(&old, Ok(Some((_, sum))) if index.files.get(&file) == Some(sum));
            let old = old.ok().flatten().map(|(table, _)| table);
            if listed && old.as_ref().is_some_and(|old| same(old, table)) {
                continue;
            }
            print(&news(&one.scenario.name, old.as_ref(), table))?;
            changed.push((path, table));
        }
        let gone = if self.scenarios.is_empty() { gone(&folder, &index, context)? } else { Vec::new() };
        for file in &gone {
            print(&format!("{file}: its scenario is gone, the baseline will be removed\n"))?;
        }
        if changed.is_empty() && gone.is_empty() {
            return print("nothing to bless: every baseline is as today\n");
        }
        if !self.yes && !confirmed(changed.len() + gone.len())? {
            return Err(Failure::input("nothing was blessed"));
        }
        std::fs::create_dir_all(&folder)?;
        for (path, table) in &changed {
            let sum = write_baseline(path, table)?;
            index.files.insert(file_name(path), sum);
            print(&format!("blessed {}\n", path.display()))?;
        }
        for file in gone {
            index.files.remove(&file);
            std::fs::remove_file(folder.join(&file)).or_else(|e| if e.kind() == std::io::ErrorKind::NotFound { Ok(()) } else { Err(e) })?;
        }
        Ok(index.write(&folder)?)
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// The blessed files whose scenario is gone.
fn gone(folder: &Path, index: &Index, context: &Context<'_>) -> Result<Vec<String>, Failure> {
    let known: Vec<String> = context.catalogue()?.names()?.iter().map(|name| file_name(&baseline_path(folder, name))).collect();
    Ok(index.files.keys().filter(|file| !known.contains(file)).cloned().collect())
}

/// Whether both would be written as the same baseline, but for the program and the machine.
fn same(old: &Table, new: &Table) -> bool {
    let available = |table: &'_ Table| {
        let kept = table.methods().filter(|(_, method)| method.unavailable.is_none());
        kept.map(|(label, m)| (label.clone(), m.version.clone(), m.settings.clone(), m.library.clone(), m.points.clone()))
            .collect::<Vec<_>>()
    };
    old.seed == new.seed && old.text == new.text && old.coordinates == new.coordinates && available(old) == available(new)
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
