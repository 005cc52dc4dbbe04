//! `calibench bless`: today's numbers become the baseline.

use std::io::{BufRead, IsTerminal, Write};
use std::path::{Path, PathBuf};

use calibench_gate::{
    BaselineError, Cells, Index, IndexError, Kept, Table, Verdicts, baseline_path, figures_path, read_baseline, worse_than, write_baseline,
};
use calibench_scenario::Scenario;
use clap::Args;

use super::context::Context;
use super::gated::{Gated, Keep, Outcome, Source, cell_verdicts, gated};
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
}

/// Writes a baseline to a path; returns its checksum.
type Writer<'a> = Box<dyn Fn(&Path) -> Result<String, BaselineError> + 'a>;

/// A file that is to be written, and how.
struct New<'a> {
    path: PathBuf,
    write: Writer<'a>,
}

impl Bless {
    /// Everything, without asking.
    pub const fn all() -> Self {
        Self { scenarios: Vec::new(), yes: true }
    }

    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let folder = context.root()?.join("reference/baselines");
        let mut index = match Index::read(&folder) {
            Err(IndexError::Missing(_)) => Index::default(),
            other => other?,
        };
        let mut available = |scenario: &Scenario, _: Option<usize>, table: &Table| all_available(&scenario.name, table);
        let mut source = Source { records: None, kept: Some(Keep::new(context)?), each: &mut available };
        let all = gated(context, &self.scenarios, &mut source)?;
        let mut verdicts = cell_verdicts(context, &source)?;
        let mut changed = Vec::new();
        for one in &all {
            changed.extend(files(one, &folder, &index)?);
        }
        changed.extend(published(&folder, &index, &mut verdicts, self.scenarios.is_empty())?);
        let gone = if self.scenarios.is_empty() { gone(&folder, &index, &all) } else { Vec::new() };
        for path in &gone {
            print(&format!("{}: nothing makes these numbers any more, the file will be removed\n", path.display()))?;
        }
        if changed.is_empty() && gone.is_empty() {
            return print("nothing to bless: every baseline is as today\n");
        }
        if !self.yes && !confirmed(changed.len() + gone.len())? {
            return Err(Failure::input("nothing was blessed"));
        }
        std::fs::create_dir_all(&folder)?;
        for New { path, write } in &changed {
            index.bless(path, write(path)?);
            print(&format!("blessed {}\n", path.display()))?;
        }
        for path in &gone {
            index.forget(path);
            std::fs::remove_file(path).or_else(|error| if error.kind() == std::io::ErrorKind::NotFound { Ok(()) } else { Err(error) })?;
        }
        Ok(index.write(&folder)?)
    }
}

/// The files of a scenario that are not as they are blessed, with the news of each.
fn files<'a>(one: &'a Gated, folder: &Path, index: &Index) -> Result<Vec<New<'a>>, Failure> {
    let (name, path) = (&one.scenario.name, baseline_path(folder, &one.scenario.name));
    let mut news: Vec<New<'a>> = Vec::new();
    match &one.outcome {
        Outcome::NotCompared(_) => return Ok(news),
        Outcome::Points(table) => {
            // A baseline that is damaged, or of an older version, is replaced as if there were none.
            let old = listed(read_baseline(&path, name), &path, index);
            if !old.as_ref().is_some_and(|old| same(old, table)) {
                print(&changes(name, old.as_ref(), table))?;
                news.push(New { path, write: Box::new(|path| write_baseline(path, table)) });
            }
        }
        Outcome::Sums(sums) => news.extend(cells(name, path, sums, index)?),
    }
    if let Some(figures) = &one.figures {
        news.extend(cells(name, figures_path(folder, name), figures, index)?);
    }
    Ok(news)
}

fn cells<'a, T: Kept>(name: &str, path: PathBuf, now: &'a Cells<T>, index: &Index) -> Result<Option<New<'a>>, Failure> {
    let old = listed(Cells::<T>::read(&path, name), &path, index);
    match &old {
        Some(old) => {
            let findings = old.compare(now);
            if findings.is_empty() {
                return Ok(None);
            }
            let worse: Vec<String> = findings
                .iter()
                .filter(|finding| finding.fails())
                .map(|f| format!("    {}: {}: {}\n", f.scenario, f.method, f.message))
                .collect();
            let verdict = if worse.is_empty() { "changed, nothing gets worse" } else { "gets worse:" };
            print(&format!("{name}: {verdict}\n{}", worse.concat()))?;
        }
        None => print(&format!("{name}: new baseline of {} points or figures in {} cells\n", now.counts()[1], now.len()))?,
    }
    Ok(Some(New { path, write: Box::new(|path| now.write(path)) }))
}

/// The verdicts of published cells, if they are not as they are blessed; of some scenarios alone, the others stay.
fn published<'a>(folder: &Path, index: &Index, now: &'a mut Verdicts, whole: bool) -> Result<Option<New<'a>>, Failure> {
    let path = Verdicts::path(folder);
    let old = listed(Verdicts::read(&path), &path, index);
    for (cell, word) in old.iter().filter(|_| !whole).flat_map(|old| &old.0) {
        now.0.entry(cell.clone()).or_insert_with(|| word.clone());
    }
    if old.as_ref().map_or(now.0.is_empty(), |old| old == now) {
        return Ok(None);
    }
    let findings = old.map(|old| old.compare(now)).unwrap_or_default();
    print(&format!("published tables: verdicts of {} cells\n", now.0.len()))?;
    for finding in findings.iter().filter(|finding| finding.fails()) {
        print(&format!("    {} {}: {}\n", finding.scenario, finding.target.as_deref().unwrap_or_default(), finding.message))?;
    }
    Ok(Some(New { path, write: Box::new(|path| now.write(path)) }))
}

/// The content of a file that is whole and listed.
fn listed<T>(read: Result<Option<(T, String)>, BaselineError>, path: &Path, index: &Index) -> Option<T> {
    let (content, sum) = read.ok().flatten()?;
    index.mistake(path, Some(&sum)).is_none().then_some(content)
}

/// The blessed files that nothing makes any more.
fn gone(folder: &Path, index: &Index, all: &[Gated]) -> Vec<PathBuf> {
    let mut made: Vec<PathBuf> = vec![Verdicts::path(folder)];
    for one in all {
        made.push(baseline_path(folder, &one.scenario.name));
        if one.figures.is_some() || matches!(one.outcome, Outcome::NotCompared(_)) {
            made.push(figures_path(folder, &one.scenario.name));
        }
    }
    index.files.keys().map(|file| folder.join(file)).filter(|path| !made.contains(path)).collect()
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

fn changes(scenario: &str, old: Option<&Table>, new: &Table) -> String {
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
