//! The gate's requirement for OpenCV's operator, with the bounds of the gate's own test: reseeded runs, seeds chosen beforehand.

use std::path::PathBuf;

use calibench_gate::{Check, Coordinates, Finding, Table};
use calibench_records::results::{Outcome, PointResult, Trial};
use calibench_run::Plan;
use calibench_scenario::{Scenario, Subject, parse};

const LABEL: &str = "opencv_subpix:window=11";
const RUNS: u64 = 100;
const TRIALS: u64 = 100;

fn scenario() -> Scenario {
    let path = crate::project::root().join("scenarios/corners/noise.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let mut scenario = parse("corners/noise", "noise.toml", &text, &calibench_opencv::registry()).unwrap();
    scenario.methods.retain(|method| method.label == LABEL);
    scenario
}

/// A run whose points went through `change`. All tables carry one seed: that of the file is another test's matter.
fn table(scenario: &Scenario, seed: u64, change: &dyn Fn(PointResult) -> PointResult) -> Table {
    let mut plan = Plan::new(scenario, calibench_run::Tools::default(), PathBuf::new());
    (plan.seed, plan.trials, plan.bounds) = (seed, TRIALS, false);
    let mut table = Table::new(scenario.name.as_str(), 0, Coordinates::of(scenario.has_truth()), &plan.method_infos());
    plan.run(&|| (), &mut |trial| {
        let points = trial.points.iter().cloned().map(change).collect();
        table.add(&Trial { points, ..trial });
        Ok(())
    })
    .unwrap();
    table
}

fn biased(point: PointResult) -> PointResult {
    let Outcome::Measured { position, error: Some((dx, dy)) } = point.outcome else { return point };
    PointResult { outcome: Outcome::Measured { position, error: Some((dx + 0.05, dy)) }, ..point }
}

fn fails(base: &Table, now: &Table) -> bool {
    let mut check = Check::new();
    check.compare(base, now, false);
    check.conclude().iter().any(|finding: &Finding| finding.fails() && finding.method == LABEL)
}

#[test]
fn opencvs_regressions_are_told_from_chance() {
    let scenario = scenario();
    let base = table(&scenario, 20_110_513, &|point| point);
    let mut noisy = self::scenario();
    let Subject::Scene(subject) = &mut noisy.subject else { panic!("a scene") };
    subject.grey_noise *= 2.0;
    let (mut alarms, mut bias, mut noise) = (0, 0, 0);
    for seed in 1..=RUNS {
        alarms += u64::from(fails(&base, &table(&scenario, seed, &|point| point)));
        bias += u64::from(fails(&base, &table(&scenario, seed, &biased)));
        noise += u64::from(fails(&base, &table(&noisy, seed, &|point| point)));
    }
    println!("of {RUNS}: {alarms} false alarms, 0.05 px found {bias} times, doubled noise {noise} times");
    assert!(alarms <= 1 && bias >= 99 && noise >= 99, "{alarms} {bias} {noise}");
}
