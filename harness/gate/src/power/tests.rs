//! The page of faults and false alarms, counted by hand.

use super::*;
use crate::Coordinates;
use crate::tests::{NO_CORNER, at, holding, lost, measured, method};

fn outcome(scenario: &str, method: &str, mutation: Mutation, caught: Result<[bool; 2], &'static str>) -> Outcome {
    Outcome { scenario: scenario.into(), method: method.into(), mutation, caught }
}

/// Two methods of one scenario and one of another: noise caught by both checks, by one and by none; a trial that cannot be copied.
fn outcomes() -> Vec<Outcome> {
    let (both, strict, none) = (Ok([true, true]), Ok([true, false]), Ok([false, false]));
    let mut all = Vec::new();
    for (scenario, method, noise) in [("f/s", "m", both), ("f/s", "n", strict), ("f/t", "m", none)] {
        for (mutation, _) in Mutation::ALL {
            let caught = match mutation {
                Mutation::MoreNoise => noise,
                Mutation::CopiedTrial => Err("there is one trial"),
                _ => both,
            };
            all.push(outcome(scenario, method, mutation, caught));
        }
    }
    all
}

#[test]
fn faults_are_counted_by_kind() {
    let text = summary(&outcomes());
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 2 + Mutation::ALL.len(), "{text}");
    assert_eq!(lines[0], "| fault | put into | caught, strict | caught, plain | not tested |");
    assert_eq!(lines[2], "| +10 % noise | 3 | 2 | 1 | 0 |");
    assert_eq!(lines[3], "| noise doubled | 3 | 3 | 3 | 0 |");
    assert_eq!(lines[6], "| a trial copied | 0 | 0 | 0 | 3 |");
}

#[test]
fn faults_are_counted_by_scenario() {
    let text = by_scenario(&outcomes());
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 4, "{text}");
    assert!(lines[0].starts_with("| scenario | +10 % noise | noise doubled | lost points doubled |"), "{text}");
    assert_eq!(lines[1], "|---|---:|---:|---:|---:|---:|---:|---:|");
    assert_eq!(lines[2], "| `f/s` | 1 of 2 | 2 of 2 | 2 of 2 | 2 of 2 | 0 of 0 | 2 of 2 | 2 of 2 |");
    assert_eq!(lines[3], "| `f/t` | 0 of 1 | 1 of 1 | 1 of 1 | 1 of 1 | 0 of 0 | 1 of 1 | 1 of 1 |");
}

#[test]
fn what_could_not_be_put_in_is_said_with_its_reason() {
    assert_eq!(untested(&outcomes()), "- a trial copied: there is one trial (3)\n  - `f/s`: `m`, `n`\n  - `f/t`: `m`\n");
    assert_eq!(untested(&[outcome("f/s", "m", Mutation::OneNan, Ok([false; 2]))]), "None.\n");
}

#[test]
fn the_page_has_all_parts() {
    let mutation = Mutation::Swapped;
    let untested = vec![("no point is lost", 2), ("no point is measured", 1)];
    let sweep = SweepOutcome { scenario: "f/w".into(), mutation, tried: 9, caught: [8, 7], untested };
    let alarms = Alarms { divisions: 6, failed: 5, lacking: 4, methods: 3, tests: 2, too_few: 1 };
    let text = page(&outcomes(), &[sweep], &alarms);
    assert!(text.contains("every scenario with random trials (3 pairs)"), "{text}");
    for part in [summary(&outcomes()), by_scenario(&outcomes())] {
        assert!(text.contains(&part), "{part}");
    }
    assert!(text.contains("## Not caught by a strict check\n\n- +10 % noise: `m` of `f/t`\n\n## Not tested"), "{text}");
    assert!(text.contains("| `f/w` | dx, dy swapped | 9 | 8 | 7 | 2: no point is lost; 1: no point is measured |\n"), "{text}");
    assert!(text.contains(
        "6 divisions of the 3 methods with at least 20 trials, 2 tests in each: **5 failed**. The gate promises a rate of 0.001."
    ));
    assert!(
        text.contains("In 4 divisions a target") && text.contains("fewer than 10 pairs") && text.contains("1 methods have fewer trials")
    );
    let caught = [outcome("f/s", "m", mutation, Ok([true, false]))];
    assert!(page(&caught, &[], &alarms).contains("## Not caught by a strict check\n\nNone.\n\n"));
}

#[test]
fn faults_in_a_run_are_caught() {
    // Twelve trials of three targets; of method `l` one point is lost.
    let error = |trial: u64, k: f64| 0.1 * (k + 1.7 * trial as f64).sin();
    let entry = move |trial: u64, k: f64| measured([error(trial, k), error(trial, k + 1.0)], None);
    let all = (0..12).flat_map(|trial| [("a", 0.0), ("b", 2.0), ("c", 4.0)].map(|(name, k)| (trial, name, entry(trial, k))));
    let plain = method(all);
    let mut one_lost = plain.clone();
    one_lost.points.insert(at(0, "c"), lost([2.0, 0.0]));
    let mut table = holding(Coordinates::Errors, plain);
    *table.method_mut(&"l".into(), &"1".into()) = one_lost;
    *table.method_mut(&"n".into(), &"1".into()) = method([(0, "a", NO_CORNER)]);
    let found = power(&[&table]);
    assert_eq!(found.len(), 3 * Mutation::ALL.len());
    let caught = |method: &str, mutation| found.iter().find(|o| o.method == method && o.mutation == mutation).unwrap().caught;
    for (mutation, name) in Mutation::ALL {
        assert!(caught("l", mutation).unwrap()[0], "a strict check fails: {name}");
        assert!(caught("n", mutation).is_err(), "there is nothing to put it into: {name}");
    }
    assert_eq!(caught("m", Mutation::LostDoubled), Err("no point is lost"));
    assert_eq!(caught("m", Mutation::OneNan), Ok([true, true]));
    assert_eq!(caught("m", Mutation::DoubledNoise), Ok([true, true]));
    assert_eq!(caught("m", Mutation::CopiedTrial), Ok([true, false]), "as good as it was");
    assert_eq!(one(&table, "o", Mutation::OneNan).caught, Err("there is no such method"));
    assert!(found.iter().all(|outcome| outcome.scenario == "f/s"));
}
