//! The requirement, on the scenario that is to meet it: at most one false alarm in a hundred reseeded runs, and in at least 99 of a
//! hundred each regression found, by name. Reseeded is the hard case: baseline and run share no random number.
//!
//! Seeds were chosen before the first run: the scenario's for the baseline, 1 to 100 for the runs.

use std::path::PathBuf;

use calibench_gate::{Check, Coordinates, Finding, Table, compare};
use calibench_measure::{Configured, Registry};
use calibench_records::results::{Outcome, PointResult, Trial};
use calibench_run::Plan;
use calibench_scenario::{Scenario, Subject, parse};

const TEXT: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/corners/noise.toml"));
const BASE_SEED: u64 = 20_110_513;
const RUNS: u64 = 100;
const TRIALS: u64 = 200;
/// Pointing by hand scatters by 0.4 px a coordinate: 0.05 px are told from chance in this many trials. In 200 the chance is about one in five.
const POINTING_TRIALS: u64 = 2000;
const METHODS: [&str; 3] = ["pixel", "forstner:window=11", "harris_paraboloid:window=11"];

/// The scenario with the methods of every build.
fn scenario(methods: &[&str]) -> Scenario {
    let text = TEXT.split("[[method]]").next().unwrap();
    let mut scenario =
        parse("corners/noise", "noise.toml", &format!("{text}[[method]]\nname = \"pixel\"\n"), &Registry::builtin()).unwrap();
    scenario.methods = methods.iter().map(|label| Registry::builtin().parse(label)).collect::<Result<Vec<Configured>, _>>().unwrap();
    scenario
}

/// The same pointing without an image to measure in: `pixel` reads none, and its random numbers have their own streams.
fn pointing() -> Scenario {
    let mut scenario = scenario(&METHODS[..1]);
    if let Subject::Scene(scene) = &mut scenario.subject {
        scene.grey_noise = 0.0;
        scene.scene.polygons.clear();
        scene.bits = None;
    }
    scenario
}

fn run(scenario: &Scenario, seed: u64, trials: u64) -> Vec<Trial> {
    let mut plan = Plan::new(scenario, calibench_run::Tools::default(), PathBuf::new());
    (plan.seed, plan.trials, plan.bounds) = (seed, trials, false);
    let mut all = Vec::new();
    plan.run(&|| (), &mut |trial| {
        all.push(trial);
        Ok(())
    })
    .unwrap();
    all
}

/// The table of a run whose points went through `change`; points that it returns as `None` are dropped.
fn table(scenario: &Scenario, trials: &[Trial], change: impl Fn(u64, PointResult) -> Option<PointResult>) -> Table {
    let infos = Plan::new(scenario, calibench_run::Tools::default(), PathBuf::new()).method_infos();
    let mut table = Table::new(scenario.name.as_str(), 0, Coordinates::of(scenario.has_truth()), &infos);
    for trial in trials {
        let points = trial.points.iter().filter_map(|point| change(trial.number, point.clone())).collect();
        table.add(&Trial { points, ..trial.clone() });
    }
    table
}

fn plain(scenario: &Scenario, trials: &[Trial]) -> Table {
    table(scenario, trials, |_, point| Some(point))
}

fn shifted(point: PointResult, method: usize, bias: f64) -> PointResult {
    match point.outcome {
        Outcome::Measured { mut position, error: Some((dx, dy)) } if point.method == method => {
            position.x += bias;
            PointResult { outcome: Outcome::Measured { position, error: Some((dx + bias, dy)) }, ..point }
        }
        _ => point,
    }
}

fn names(findings: &[Finding], method: &str) -> bool {
    findings.iter().any(|finding| finding.fails() && finding.method == method)
}

/// How many of the runs are so.
fn count(tables: impl Iterator<Item = bool>) -> u64 {
    tables.filter(|found| *found).count() as u64
}

#[test]
fn regressions_are_told_from_chance() {
    let scenario = scenario(&METHODS);
    let pointing = pointing();
    let base = plain(&scenario, &run(&scenario, BASE_SEED, TRIALS));
    let pointing_base = plain(&pointing, &run(&pointing, BASE_SEED, POINTING_TRIALS));
    let runs: Vec<[Vec<Trial>; 2]> = (1..=RUNS).map(|seed| [run(&scenario, seed, TRIALS), run(&pointing, seed, POINTING_TRIALS)]).collect();
    // Both in one check, so that all tests share one budget.
    let check = |trials: &[Vec<Trial>; 2], change: &dyn Fn(u64, PointResult) -> Option<PointResult>| {
        let mut check = Check::new();
        check.compare(&base, &table(&scenario, &trials[0], change), false);
        check.compare(&pointing_base, &table(&pointing, &trials[1], change), false);
        check.conclude()
    };
    let detected = |method: &str, change: &dyn Fn(u64, PointResult) -> Option<PointResult>| {
        count(runs.iter().map(|trials| names(&check(trials, change), method)))
    };

    let alarms = count(runs.iter().map(|trials| check(trials, &|_, point| Some(point)).iter().any(Finding::fails)));
    println!("false alarms: {alarms} of {RUNS}");
    let mut rates = Vec::new();
    for (index, method) in METHODS.into_iter().enumerate() {
        let of = |point: &PointResult| point.method == index;
        rates.push((method, "0.05 px", detected(method, &|_, point| Some(shifted(point, index, 0.05)))));
        rates.push((method, "no target", detected(method, &|_, p| (!of(&p) || &*p.target != "chess-at-15").then_some(p))));
        rates.push((method, "no method", detected(method, &|_, p| (!of(&p)).then_some(p))));
        rates.push((method, "10 trials fewer", detected(method, &|trial, p| (trial + 10 < TRIALS).then_some(p))));
    }
    for rate in &rates {
        println!("{rate:?}");
    }
    let at_200 =
        count(runs.iter().map(|t| names(&compare(&base, &table(&scenario, &t[0], |_, p| Some(shifted(p, 0, 0.05))), false), METHODS[0])));
    println!("pixel 0.05 px at {TRIALS} trials: {at_200} of {RUNS}");
    assert!(alarms <= 1, "{alarms}");
    assert!(rates.iter().all(|(.., found)| *found >= 99), "{rates:?}");
}

#[test]
fn doubled_noise_is_found() {
    let mut scenario = scenario(&METHODS[1..]);
    let base = plain(&scenario, &run(&scenario, BASE_SEED, TRIALS));
    if let Subject::Scene(scene) = &mut scenario.subject {
        scene.grey_noise *= 2.0;
    }
    let runs: Vec<Vec<Finding>> = (1..=RUNS).map(|seed| compare(&base, &plain(&scenario, &run(&scenario, seed, TRIALS)), false)).collect();
    for method in &METHODS[1..] {
        println!("doubled noise, {method}: {}", count(runs.iter().map(|findings| names(findings, method))));
    }
    for method in &METHODS[1..] {
        assert!(count(runs.iter().map(|findings| names(findings, method))) >= 99, "{method}");
    }
}

#[test]
fn with_the_same_seed_a_thousandth_of_a_pixel_is_found() {
    let scenario = scenario(&METHODS);
    let trials = run(&scenario, BASE_SEED, TRIALS);
    let base = plain(&scenario, &trials);
    assert_eq!(compare(&base, &base, false), []);
    for (index, method) in METHODS.into_iter().enumerate() {
        let found = compare(&base, &table(&scenario, &trials, |_, p| Some(shifted(p, index, 0.001))), false);
        assert!(names(&found, method) && METHODS.iter().all(|other| *other == method || !names(&found, other)), "{method}");
        let last_bits = |_, p| Some(shifted(p, index, 1e-9));
        assert_eq!(compare(&base, &table(&scenario, &trials, last_bits), false), [], "{method}");
    }
}
