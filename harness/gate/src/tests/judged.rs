//! Monte Carlo runs: same seed, same numbers; what changed is judged, and nothing is green that was not tested.

use super::{info, point, rejected};
use crate::{Check, Coordinates, Finding, Table, Verdict, compare};
use calibench_records::results::{PointResult, Trial};

const TARGETS: [&str; 6] = ["a", "b", "c", "d", "e", "f"];

/// Errors that look random and are the same everywhere, uniform in -0.1 to 0.1 px: SplitMix64 of the place.
fn error(trial: u64, target: usize, axis: u64) -> f64 {
    let mut z = (trial * 1_000 + target as u64 * 10 + axis + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) as f64 / 2.0_f64.powi(64) - 0.5) * 0.2
}

/// A run of `trials` trials whose points went through `change`.
fn run(trials: u64, change: impl Fn(u64, usize, PointResult) -> PointResult) -> Table {
    let mut table = Table::new("f/s", 7, Coordinates::Errors, &[info("m", "1")]);
    for number in 0..trials {
        let made = |(index, name): (usize, &&str)| {
            let plain = point(0, name, [error(number, index, 0), error(number, index, 1)]);
            change(number, index, PointResult { predicted: Some(0.08), ..plain })
        };
        table.add(&Trial { number, points: TARGETS.iter().enumerate().map(made).collect(), ..Trial::default() });
    }
    table
}

fn plain(trials: u64) -> Table {
    run(trials, |_, _, point| point)
}

fn moved(p: &PointResult, change: impl Fn([f64; 2]) -> [f64; 2]) -> PointResult {
    let (dx, dy) = p.outcome.position().map(|at| (at.x - 10.0, at.y - 20.0)).unwrap();
    PointResult { predicted: p.predicted, ..point(0, &p.target, change([dx, dy])) }
}

fn fails(findings: &[Finding]) -> bool {
    findings.iter().any(Finding::fails)
}

#[test]
fn the_same_numbers_are_not_tested_at_all() {
    let mut check = Check::new();
    check.compare(&plain(20), &run(20, |_, _, p| moved(&p, |[x, y]| [x + 5e-7, y - 5e-7])), false);
    assert_eq!((check.tests(), check.tally().changed, check.tally().methods, check.tally().points), (0, 0, 1, 120));
    assert!(check.conclude().is_empty());
}

#[test]
fn a_method_that_rejects_everything_fails_however_few_the_trials() {
    for trials in [1, 2, 5, 9, 10, 12, 20] {
        let findings = compare(&plain(trials), &run(trials, |_, _, p| rejected(0, &p.target)), false);
        assert!(fails(&findings), "{trials} trials: {findings:?}");
        let named = findings.iter().filter(|f| f.message.starts_with("was measured, is rejected")).count();
        assert_eq!(named, trials as usize * TARGETS.len(), "every point is named");
    }
}

#[test]
fn fewer_than_ten_trials_are_judged_by_their_figures() {
    let findings = compare(&plain(5), &run(5, |_, _, p| moved(&p, |[x, y]| [1000.0 * x, 1000.0 * y])), false);
    assert!(findings.iter().any(|f| f.fails() && f.metric == "rms_error" && f.message.contains("5 trials are too few")), "{findings:?}");
    // Half a percent more is a change, not worse; 1.5 percent is worse.
    let grown = |factor: f64| compare(&plain(5), &run(5, |_, _, p| moved(&p, |[x, y]| [factor * x, factor * y])), false);
    assert!(!fails(&grown(1.005)) && grown(1.005).iter().any(|f| f.verdict == Verdict::Changed), "{:?}", grown(1.005));
    assert!(fails(&grown(1.015)));
}

#[test]
fn one_point_that_is_no_number_fails() {
    for trials in [5, 20] {
        let nan = |trial, target, p: PointResult| if (trial, target) == (3, 2) { moved(&p, |[x, _]| [x, f64::NAN]) } else { p };
        let findings = compare(&plain(trials), &run(trials, nan), false);
        assert!(findings.iter().any(|f| f.fails() && f.message == "was measured, is not a number"), "{findings:?}");
    }
}

#[test]
fn one_trial_that_repeats_another_is_a_change() {
    let copied = run(20, |trial, target, p| {
        let from = if trial == 4 { 5 } else { trial };
        moved(&p, |_| [error(from, target, 0), error(from, target, 1)])
    });
    let findings = compare(&plain(20), &copied, false);
    assert!(!fails(&findings), "nothing is worse: {findings:?}");
    assert!(findings.iter().any(|f| f.verdict == Verdict::Changed && f.message.starts_with("6 points moved, by up to 0.")), "{findings:?}");
}

#[test]
fn more_scatter_about_a_large_bias_is_worse() {
    let base = run(20, |_, _, p| moved(&p, |[x, y]| [0.7 + 0.05 * x, y * 0.05]));
    let doubled = run(20, |_, _, p| moved(&p, |[x, y]| [0.7 + 0.1 * x, y * 0.1]));
    let findings = compare(&base, &doubled, false);
    assert!(findings.iter().any(|f| f.fails() && f.metric == "scatter"), "{findings:?}");
    assert!(!findings.iter().any(|f| f.fails() && f.metric == "rms_error"), "the bias hides it there: {findings:?}");
}

#[test]
fn a_target_that_is_no_longer_found_is_no_longer_tested_and_fails() {
    let findings =
        compare(&plain(12), &run(12, |trial, target, p| if target == 1 && trial < 4 { rejected(0, &p.target) } else { p }), false);
    let lacking = findings.iter().find(|f| f.metric == "tests").unwrap();
    assert!(lacking.fails() && lacking.target.as_deref() == Some("image/b"), "{findings:?}");
    assert_eq!((lacking.baseline, lacking.now), (Some(12.0), Some(8.0)));
}

#[test]
fn reported_standard_deviations_are_compared_and_judged() {
    // Errors uniform in -0.1 to 0.1: 0.0816 px in 2D; 0.08 is right.
    for trials in [5, 20] {
        let wrong = compare(&plain(trials), &run(trials, |_, _, p| PointResult { predicted: Some(0.02), ..p }), false);
        assert!(wrong.iter().any(|f| f.metric == "sigma" && f.verdict == Verdict::Changed), "{wrong:?}");
        let none = compare(&plain(trials), &run(trials, |_, _, p| PointResult { predicted: None, ..p }), false);
        assert!(none.iter().any(|f| f.fails() && f.message.contains("have lost their reported standard deviation")), "{none:?}");
    }
    let wrong = compare(&plain(20), &run(20, |_, _, p| PointResult { predicted: Some(0.02), ..p }), false);
    assert!(wrong.iter().any(|f| f.fails() && f.metric == "error_over_sigma"), "{wrong:?}");
    let back = compare(&run(20, |_, _, p| PointResult { predicted: Some(0.02), ..p }), &plain(20), false);
    assert!(!fails(&back) && back.iter().any(|f| f.p.is_some() && f.metric == "error_over_sigma"), "{back:?}");
}

#[test]
fn a_scenario_that_was_edited_is_said_and_fails_with_its_numbers() {
    let with = |text: &str, factor: f64| {
        let mut table = run(20, |_, _, p| moved(&p, |[x, y]| [factor * x, factor * y]));
        text.clone_into(&mut table.text);
        table
    };
    let same = compare(&with("a", 1.0), &with("b", 1.0), false);
    assert!(same.len() == 1 && same[0].verdict == Verdict::Changed && same[0].metric == "scenario", "{same:?}");
    let noisier = compare(&with("a", 1.0), &with("b", 1.000_1), false);
    assert!(noisier.iter().any(|f| f.fails() && f.metric == "scenario"), "{noisier:?}");
}

#[test]
fn other_parameters_are_said() {
    let with = |settings: &str| {
        let mut table = plain(20);
        table.describe("m", settings.into(), String::new());
        table
    };
    let findings = compare(&with("k=1"), &with("k=2"), false);
    assert!(findings.len() == 1 && findings[0].message.contains("the parameters were k=1 and are k=2"), "{findings:?}");
}

#[test]
fn a_library_of_another_version_is_judged_by_statistics_alone() {
    let with = |version: &str, factor: f64| {
        let mut table = run(20, |_, _, p| moved(&p, |[x, y]| [factor * x, factor * y]));
        table.describe("m", String::new(), format!("OpenCV {version}"));
        table
    };
    // Moved by a hundredth of what another image's noise does: neither better nor worse.
    let mut other =
        run(20, |trial, target, p| moved(&p, |[x, y]| [x + 0.01 * error(trial + 50, target, 0), y + 0.01 * error(trial + 50, target, 1)]));
    other.describe("m", String::new(), "OpenCV 4.10.0".into());
    let alike = compare(&with("4.6.0", 1.0), &other, false);
    assert!(alike.iter().all(|f| f.verdict == Verdict::Informs) && !alike.is_empty(), "{alike:?}");
    assert!(fails(&compare(&with("4.6.0", 1.0), &with("4.10.0", 2.0), false)));
    let same_version = compare(&with("4.6.0", 1.0), &with("4.6.0", 0.999), false);
    assert!(same_version.iter().any(|f| f.verdict == Verdict::Changed), "{same_version:?}");
}
