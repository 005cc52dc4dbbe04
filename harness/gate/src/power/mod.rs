//! What the gate sees and how often it is wrong, measured on the stored numbers of a project: a page of Markdown.

mod divide;
mod mutate;
mod sums;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use calibench_random::Key;
use rayon::prelude::*;

pub use divide::{Alarms, alarms};
pub use mutate::Mutation;
pub use sums::{SweepOutcome, sweep_power};

use crate::finding::{Finding, Rules};
use crate::table::Table;
use crate::{ALPHA, LEAST_PAIRS, compare};

/// How the gate judged one fault in one method of one scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// The scenario.
    pub scenario: String,
    /// The method's label.
    pub method: String,
    /// The fault.
    pub mutation: Mutation,
    /// Whether a strict check fails, and whether a plain one does; why there is no such fault otherwise.
    pub caught: Result<[bool; 2], &'static str>,
}

/// Puts every fault into every method of `tables`, one at a time. `tables` are of scenarios with random trials.
pub fn power(tables: &[&Table]) -> Vec<Outcome> {
    let all: Vec<(&Table, String)> =
        tables.iter().flat_map(|table| table.methods().map(|(label, _)| (*table, label.to_string())).collect::<Vec<_>>()).collect();
    all.into_par_iter().flat_map_iter(|(table, label)| Mutation::ALL.map(|(mutation, _)| one(table, &label, mutation))).collect()
}

fn one(table: &Table, label: &str, mutation: Mutation) -> Outcome {
    let key = Key { seed: 0, of: &table.scenario, trial: 0, view: label, target: "" };
    let caught = table.method(label).ok_or("there is no such method").and_then(|method| mutation.of(method, key)).map(|changed| {
        let (base, now) = (table.only(label, None), table.only(label, Some(changed)));
        let findings = compare(&base, &now, false);
        let by = |strict| findings.iter().any(|finding: &Finding| finding.fails_by(Rules { strict, locked: false }));
        [by(true), by(false)]
    });
    Outcome { scenario: table.scenario.clone(), method: label.to_owned(), mutation, caught }
}

/// The page: faults caught by scenario, what was not caught or could not be put in, the same of sweeps, false alarms.
pub fn page(outcomes: &[Outcome], sweeps: &[SweepOutcome], alarms: &Alarms) -> String {
    let pairs = outcomes.len() / Mutation::ALL.len();
    let mut text = format!(
        "# What the gate sees\n\nMade by `just power` from the shipped baselines; nothing here is written by hand.\n\n\
         Each fault was put into the stored numbers of every method of every scenario with random trials ({pairs} pairs), one at a time, and compared with what is \
         stored. *Strict* is `check --strict`, which fails on every number that changed. *Plain* is `check`, which fails on what is worse: what a fault leaves as good as it was, a \
         copied trial or exchanged axes, is named there and does not fail.\n\n## Faults caught\n\n"
    );
    text.push_str(&summary(outcomes));
    text.push_str("\n## By scenario\n\nPlainly caught of all methods in which there is such a fault.\n\n");
    text.push_str(&by_scenario(outcomes));
    text.push_str("\n## Not caught by a strict check\n\n");
    let missed: Vec<&Outcome> = outcomes.iter().filter(|outcome| matches!(outcome.caught, Ok([false, _]))).collect();
    if missed.is_empty() {
        text.push_str("None.\n");
    }
    for outcome in missed {
        text.push_str(&format!("- {}: `{}` of `{}`\n", name(outcome.mutation), outcome.method, outcome.scenario));
    }
    text.push_str("\n## Not tested\n\nFaults that cannot be put into the numbers of a method, and why.\n\n");
    text.push_str(&untested(outcomes));
    text.push_str(&of_sweeps(sweeps));
    text.push_str(&false_alarms(alarms));
    text
}

/// A row for each fault and sweep, and why a fault could not be put in.
fn of_sweeps(sweeps: &[SweepOutcome]) -> String {
    let mut text = "\n## Cells of sweeps\n\nOf a method in a cell of a sweep a digest of its points and sums are kept: the sums are given what the fault does to them on \
                    average, and another digest.\n\n| sweep | fault | put into | caught, strict | caught, plain | not tested |\n|---|---|---:|---:|---:|---|\n"
        .to_owned();
    for SweepOutcome { scenario, mutation, tried, caught: [strict, plain], untested } in sweeps {
        let why: Vec<String> = untested.iter().map(|(why, count)| format!("{count}: {why}")).collect();
        text.push_str(&format!("| `{scenario}` | {} | {tried} | {strict} | {plain} | {} |\n", name(*mutation), why.join("; ")));
    }
    text
}

fn name(mutation: Mutation) -> &'static str {
    Mutation::ALL.iter().find(|(other, _)| *other == mutation).map_or("", |(_, name)| name)
}

fn summary(outcomes: &[Outcome]) -> String {
    let mut text = "| fault | put into | caught, strict | caught, plain | not tested |\n|---|---:|---:|---:|---:|\n".to_owned();
    for (mutation, name) in Mutation::ALL {
        let of: Vec<&Outcome> = outcomes.iter().filter(|outcome| outcome.mutation == mutation).collect();
        let tried = of.iter().filter(|outcome| outcome.caught.is_ok()).count();
        let caught = |which: usize| of.iter().filter(|outcome| outcome.caught.is_ok_and(|caught| caught[which])).count();
        text.push_str(&format!("| {name} | {tried} | {} | {} | {} |\n", caught(0), caught(1), of.len() - tried));
    }
    text
}

fn by_scenario(outcomes: &[Outcome]) -> String {
    let heads: String = Mutation::ALL.iter().map(|(_, name)| format!(" {name} |")).collect();
    let mut text = format!("| scenario |{heads}\n|---|{}\n", "---:|".repeat(Mutation::ALL.len()));
    let mut scenarios: Vec<&str> = outcomes.iter().map(|outcome| outcome.scenario.as_str()).collect();
    scenarios.dedup();
    for scenario in scenarios {
        let cell = |(mutation, _): &(Mutation, &str)| {
            let of = outcomes.iter().filter(|outcome| outcome.scenario == scenario && outcome.mutation == *mutation);
            let tried: Vec<[bool; 2]> = of.filter_map(|outcome| outcome.caught.ok()).collect();
            format!(" {} of {} |", tried.iter().filter(|caught| caught[1]).count(), tried.len())
        };
        text.push_str(&format!("| `{scenario}` |{}\n", Mutation::ALL.iter().map(cell).collect::<String>()));
    }
    text
}

fn untested(outcomes: &[Outcome]) -> String {
    let mut reasons: BTreeMap<(&str, &str), BTreeMap<&str, Vec<String>>> = BTreeMap::new();
    for outcome in outcomes {
        if let Err(why) = outcome.caught {
            let methods = reasons.entry((name(outcome.mutation), why)).or_default().entry(outcome.scenario.as_str()).or_default();
            methods.push(format!("`{}`", outcome.method));
        }
    }
    let scenario = |(scenario, methods): (&&str, &Vec<String>)| format!("  - `{scenario}`: {}\n", methods.join(", "));
    let reason = |((name, why), scenarios): (&(&str, &str), &BTreeMap<&str, Vec<String>>)| {
        let count: usize = scenarios.values().map(Vec::len).sum();
        format!("- {name}: {why} ({count})\n{}", scenarios.iter().map(scenario).collect::<String>())
    };
    if reasons.is_empty() { "None.\n".to_owned() } else { reasons.iter().map(reason).collect() }
}

fn false_alarms(alarms: &Alarms) -> String {
    let Alarms { divisions, failed, lacking, methods, tests, too_few } = alarms;
    format!(
        "\n## False alarms\n\nThe stored trials of a scenario, divided at random into a baseline and a run, are alike: a check that fails there is wrong. {divisions} divisions of the \
         {methods} methods with at least {} trials, {tests} tests in each: **{failed} failed**. The gate promises a rate of {ALPHA}. \
         In {lacking} divisions a target that is seldom found was left in fewer than {LEAST_PAIRS} pairs; a check names that exactly, without a test, and with the same seed it cannot come \
         by chance. {too_few} methods have fewer trials and take no part: \
         with the same seed a check tests nothing that is unchanged, and cannot be wrong there.\n",
        2 * LEAST_PAIRS
    )
}
