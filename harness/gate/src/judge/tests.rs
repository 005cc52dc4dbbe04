//! The tests of a method, each against means and differences by hand.

use super::*;
use crate::point_entry::Found;
use crate::tests::{NO_CORNER, lost, measured, method};

/// +1 and -1 in turn: ten of them have mean 0 and mean square 1.
const SIGNS: [f64; 10] = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0];

fn subject(metric: &'static str) -> Finding {
    Finding::new(Verdict::Changed, "f/s", "m", metric, "better, not blessed")
}

/// What `run` adds to nothing.
fn collected(run: impl FnOnce(&mut Collected)) -> Collected {
    let mut all = Collected { tests: Vec::new(), lacking: Vec::new() };
    run(&mut all);
    all
}

/// A target's name, and its old and new entry by trial.
type Target<'t> = (&'static str, &'t dyn Fn(usize) -> [Entry; 2]);

/// Points of ten trials.
fn pairs(targets: &[Target<'_>]) -> Pairs {
    let which =
        |index: usize| method((0..10).flat_map(|trial| targets.iter().map(move |(name, of)| (trial as u64, *name, of(trial)[index]))));
    Pairs::of(&which(0), &which(1), false)
}

fn close(found: Option<f64>, expected: f64) -> bool {
    found.is_some_and(|found| (found - expected).abs() < 1e-12)
}

/// The one test of `metric`, about `target` or all of them.
fn one<'a>(tests: &'a [Test], metric: &str, target: Option<&str>) -> &'a Test {
    let found: Vec<&Test> = tests.iter().filter(|t| t.finding.metric == metric && t.finding.target.as_deref() == target).collect();
    assert_eq!(found.len(), 1, "{metric} {target:?}");
    found[0]
}

#[test]
fn a_mean_is_worse_if_it_is_further_from_zero() {
    let of = |old: f64, new: f64| {
        // Differences (new - old) of 0.98 and 1.02 times their mean.
        let values: Vec<Figures> = SIGNS.iter().map(|s| (old + 0.01 * s * (new - old), new - 0.01 * s * (new - old))).collect();
        let mut all = collected(|all| all.mean(subject("mean_dx"), &values));
        let test = all.tests.pop().unwrap();
        assert!(close(test.finding.baseline, old) && close(test.finding.now, new) && test.family == Family::Means, "{:?}", test.finding);
        (test.worse, test.better, test.finding.message)
    };
    // t = 1 / (0.02 sqrt(10/9) / sqrt(10)) = 150 on nine degrees of freedom, whatever the mean.
    let p = paired_t(&SIGNS.map(|s| 1.0 - 0.02 * s)).two_sided;
    assert!(p > 0.0 && p < 1e-14, "{p}");
    let same = |found: f64| (found / p - 1.0).abs() < 1e-6;
    let (worse, better, _) = of(0.1, 0.2);
    assert!(same(worse) && better == 1.0);
    let (worse, better, _) = of(0.1, -0.2);
    assert!(same(worse) && better == 1.0, "on the other side");
    let (worse, better, message) = of(0.2, 0.1);
    assert!(worse == 1.0 && same(better) && message == "better, not blessed");
    let (worse, better, message) = of(-0.2, 0.1);
    assert!(worse == 1.0 && same(better) && message == "better, not blessed");
    let (worse, better, message) = of(0.1, -0.1);
    assert!(worse == 1.0 && same(better) && message == "as far off, elsewhere; not blessed");
    for (old, new) in [(0.1, 0.1 + 5e-7), (0.1 + 5e-7, 0.1)] {
        let (worse, better, _) = of(old, new);
        assert_eq!((worse, better), (1.0, 1.0), "within the tolerance");
    }
    for (old, new) in [(0.1, 0.1 + 3e-6), (-0.1, -0.1 - 3e-6)] {
        assert!(of(old, new).0 < 1e-10, "beyond the tolerance");
    }
}

/// One of sixteen values is 16 times `value`, the others are 0: the mean is `value` to the last bit.
fn sixteen(value: f64) -> [f64; 16] {
    let mut values = [0.0; 16];
    values[3] = 16.0 * value;
    values
}

#[test]
fn what_differs_by_the_tolerance_does_not_differ() {
    let p = paired_t(&sixteen(TOLERANCE));
    assert!(p.two_sided < 1.0 && p.growth < 1.0);
    let chances = |metric: &str, square: bool, [old, new]: [f64; 2]| {
        let power = |value: f64| sixteen(if square { value * value } else { value });
        let values: Vec<Figures> = power(old).into_iter().zip(power(new)).collect();
        let run = |all: &mut Collected| if square { all.mean_square(subject("x"), &values) } else { all.mean(subject("x"), &values) };
        let found = collected(run);
        assert_eq!(found.tests.len(), 1, "{metric}");
        [found.tests[0].worse, found.tests[0].better]
    };
    for square in [false, true] {
        assert_eq!(chances("as large", square, [0.0, TOLERANCE]), [1.0, 1.0]);
        assert_eq!(chances("as small", square, [TOLERANCE, 0.0]), [1.0, 1.0]);
        let ([worse, not_better], [not_worse, better]) =
            (chances("larger", square, [0.0, 2.0 * TOLERANCE]), chances("smaller", square, [2.0 * TOLERANCE, 0.0]));
        assert!(worse < 1.0 && better < 1.0 && [not_better, not_worse] == [1.0, 1.0], "{worse} {better}");
    }
    // As far off on the other side, but for the tolerance: a change, and no better.
    let values: Vec<Figures> = sixteen(2.0 * TOLERANCE).into_iter().zip(sixteen(-TOLERANCE)).collect();
    let found = collected(|all| all.mean(subject("x"), &values));
    assert_eq!(found.tests[0].finding.message, "as far off, elsewhere; not blessed");
    // Further off there, by the tolerance: neither.
    let values: Vec<Figures> = sixteen(TOLERANCE).into_iter().zip(sixteen(-2.0 * TOLERANCE)).collect();
    let found = collected(|all| all.mean(subject("x"), &values));
    assert!(found.tests[0].worse == 1.0 && found.tests[0].better < 1.0);
}

#[test]
fn a_mean_square_is_worse_if_it_grows() {
    let of = |old: f64, new: f64| {
        let values: Vec<Figures> = SIGNS.iter().map(|s| (old * old * (1.0 + 0.01 * s), new * new * (1.0 - 0.01 * s))).collect();
        let found = collected(|all| all.mean_square(subject("scatter"), &values)).tests.pop().unwrap();
        let differences: Vec<f64> = values.iter().map(|(old, new)| new - old).collect();
        assert!(
            close(found.finding.baseline, old) && close(found.finding.now, new) && found.family == Family::Spread,
            "{:?}",
            found.finding
        );
        (found.worse, found.better, paired_t(&differences))
    };
    let (worse, better, p) = of(0.1, 0.2);
    assert!(worse == p.growth && worse < 1e-9 && better == 1.0);
    let (worse, better, p) = of(0.2, 0.1);
    assert!(worse == 1.0 && better == p.fall && better < 1e-9);
}

#[test]
fn nine_pairs_are_no_test() {
    let values: Vec<Figures> = SIGNS.iter().map(|s| (0.1 * s, 0.1 * s + 0.25)).collect();
    assert!(test(&values[..9]).is_none());
    let (old, new, p) = test(&values).unwrap();
    assert!(old.abs() < 1e-15 && (new - 0.25).abs() < 1e-15);
    assert!(p.growth < 1e-9 && p.fall > 0.5, "now less blessed");
}

#[test]
fn lost_and_rejected_points_are_counted_apart() {
    let kept = measured([0.1; 2], None);
    // Three become lost; five become rejected, one rejected point is found.
    let a = |trial| [kept, if trial < 3 { lost([2.0, 0.0]) } else { kept }];
    let b = |trial| if trial == 9 { [NO_CORNER, kept] } else { [kept, if trial < 5 { NO_CORNER } else { kept }] };
    let found = collected(|all| all.counts(&subject, &pairs(&[("a", &a), ("b", &b)])));
    let [lost, rejected] = &found.tests[..] else { panic!("two tests") };
    assert_eq!((lost.finding.metric, lost.finding.baseline, lost.finding.now), ("lost", Some(0.0), Some(3.0)));
    assert_eq!((rejected.finding.metric, rejected.finding.baseline, rejected.finding.now), ("rejected", Some(1.0), Some(5.0)));
    // One at a time: three up is one of eight; five up and one down is 7 of 64.
    assert!((lost.worse - 0.125).abs() < 1e-12 && (lost.better - 1.0).abs() < 1e-12);
    assert!((rejected.worse - 7.0 / 64.0).abs() < 1e-12 && (rejected.better - 63.0 / 64.0).abs() < 1e-12);
    assert!(found.tests.iter().all(|test| test.family == Family::Counts));
}

#[test]
fn the_figures_of_trials_by_hand() {
    // Target a: (0.4 + s/10, 0.2), then (0.4 + s/5, 0.2 - s/10). Target b: (0, -0.2), then (0.2, -0.6 + s/10); s is the sign of the trial.
    let a = |trial: usize| {
        let s = SIGNS[trial];
        [measured([0.4 + 0.1 * s, 0.2], None), measured([0.4 + 0.2 * s, 0.2 - 0.1 * s], None)]
    };
    let b = |trial: usize| [measured([0.0, -0.2], None), measured([0.2, -0.6 + 0.1 * SIGNS[trial]], None)];
    let (tests, lacking) = tests("f/s", "m", &pairs(&[("a", &a), ("b", &b)]));
    assert!(lacking.is_empty());
    // Two counts, two means of two targets and of all, root mean square and scatter; no method reports a standard deviation.
    assert_eq!(tests.len(), 10);
    let square = |x: f64, y: f64| x * x + y * y;
    let expected = [
        ("mean_dx", Some("image/a"), [0.4, 0.4]),
        ("mean_dy", Some("image/a"), [0.2, 0.2]),
        ("mean_dx", Some("image/b"), [0.0, 0.2]),
        ("mean_dy", Some("image/b"), [-0.2, -0.6]),
        ("mean_dx", None, [0.2, 0.3]),
        ("mean_dy", None, [0.0, -0.2]),
        // Mean squares: those of the means, and s^2 = 1 of the rest.
        ("rms_error", None, [((0.2 + 0.01 + 0.04) / 2.0_f64).sqrt(), ((0.2 + 0.04 + 0.01 + 0.4 + 0.01) / 2.0_f64).sqrt()]),
        ("scatter", None, [(0.01 / 2.0_f64).sqrt(), ((0.04 + 0.01 + 0.01) / 2.0_f64).sqrt()]),
    ];
    for (metric, target, [old, new]) in expected {
        let found = one(&tests, metric, target);
        assert!(close(found.finding.baseline, old) && close(found.finding.now, new), "{metric} {target:?}: {:?}", found.finding);
    }
    // Differences of a trial's means: dx 0.1 + s/20, dy -0.2 + s(-0.1 + 0.1)/2.
    let p = |of: &dyn Fn(f64) -> f64| paired_t(&SIGNS.map(of));
    let like = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-6;
    assert!(like(one(&tests, "mean_dx", None).worse, p(&|s| 0.1 + 0.05 * s).two_sided));
    let squares = |s: f64| {
        let old = square(0.4 + 0.1 * s, 0.2) + square(0.0, -0.2);
        (square(0.4 + 0.2 * s, 0.2 - 0.1 * s) + square(0.2, -0.6 + 0.1 * s) - old) / 2.0
    };
    assert!(like(one(&tests, "rms_error", None).worse, p(&squares).growth));
    // The scatter of every trial is the same: all of it is evidence.
    assert!(one(&tests, "scatter", None).worse < 1e-9);
}

#[test]
fn a_trial_counts_the_targets_that_it_has() {
    // Target b is rejected in trial 0, in both runs: the mean of trial 0 is that of a alone.
    let a = |trial: usize| [measured([0.1, 0.0], None), measured([0.3 + 0.01 * SIGNS[trial], 0.0], None)];
    let b = |trial| if trial == 0 { [NO_CORNER; 2] } else { [measured([0.2, 0.0], None); 2] };
    let (tests, lacking) = tests("f/s", "m", &pairs(&[("a", &a), ("b", &b)]));
    assert!(lacking.is_empty(), "the baseline has no ten of b either");
    assert!(tests.iter().all(|test| test.finding.target.as_deref() != Some("image/b")), "nine trials are no test");
    let found = one(&tests, "mean_dx", None);
    // (0.1 + 9 * 0.15) / 10; then 0.31 alone, five trials of (0.29 + 0.2) / 2 and four of (0.31 + 0.2) / 2.
    assert!(
        close(found.finding.baseline, 0.145) && close(found.finding.now, (0.31 + 5.0 * 0.245 + 4.0 * 0.255) / 10.0),
        "{:?}",
        found.finding
    );
}

#[test]
fn a_target_that_was_tested_must_be_tested() {
    let lacking = |blessed: usize, now: usize| {
        let kept = |is: bool| if is { measured([0.1; 2], None) } else { NO_CORNER };
        let of = move |trial: usize| [kept(trial < blessed), kept(trial < now)];
        let (_, lacking) = tests("f/s", "m", &pairs(&[("a", &of), ("b", &|_| [measured([0.1; 2], None); 2])]));
        lacking.into_iter().map(|f| (f.verdict, f.target.unwrap(), f.baseline.unwrap(), f.now.unwrap())).collect::<Vec<_>>()
    };
    assert_eq!(lacking(10, 10), []);
    assert_eq!(lacking(10, 9), [(Verdict::Fails, "image/a".to_owned(), 10.0, 9.0)]);
    assert_eq!(lacking(9, 8), [], "it was not tested before");
    let of = |trial: usize| [measured([0.1; 2], None), if trial < 2 { NO_CORNER } else { measured([0.2; 2], None) }];
    let message = "no longer tested: the baseline found the point in 10 trials, this run in 8 of them";
    assert_eq!(tests("f/s", "m", &pairs(&[("a", &of)])).1[0].message, message);
}

#[test]
fn errors_over_standard_deviations_by_hand() {
    // Two targets; squares over variances of 1 and 4, then of 9 and 4 in even trials, of 25 and 4 in odd ones.
    let with = |over: f64, sigma: f64| measured([0.6 * over * sigma, -0.8 * over * sigma], Some(sigma));
    let a = |trial: usize| [with(1.0, 0.25), with(if trial.is_multiple_of(2) { 3.0 } else { 5.0 }, 0.125)];
    let b = |_| [with(2.0, 0.1); 2];
    let found = collected(|all| all.sigmas(&subject, &pairs(&[("a", &a), ("b", &b)]))).tests.pop().unwrap();
    assert_eq!((found.finding.metric, found.family), ("error_over_sigma", Family::Sigmas));
    assert!(close(found.finding.baseline, 2.5_f64.sqrt()) && close(found.finding.now, 10.5_f64.sqrt()), "{:?}", found.finding);
    let p = paired_t(&SIGNS.map(|s| if s > 0.0 { 4.0 } else { 12.0 })).two_sided;
    assert!((found.worse / p - 1.0).abs() < 1e-9 && found.better == 1.0, "{} {p}", found.worse);
    let chances = |old: f64, new: f64| {
        let of = move |trial: usize| [with(old, 0.1), with(new * (1.0 + 0.001 * SIGNS[trial]), 0.1)];
        let test = collected(|all| all.sigmas(&subject, &pairs(&[("a", &of)]))).tests.pop().unwrap();
        (test.worse < 1e-9, test.worse == 1.0, test.better < 1e-9, test.better == 1.0)
    };
    let (worse, better, neither) = ((true, false, false, true), (false, true, true, false), (false, true, false, true));
    assert_eq!(chances(1.0, 1.5), worse, "too sure");
    assert_eq!(chances(1.0, 0.5), worse, "too unsure");
    assert_eq!(chances(2.0, 0.9), better);
    assert_eq!(chances(0.4, 1.5), better);
    // The same in every trial: squares that differ by 0.8 and 1.2 millionths, and 4 and 1/4, which are as far from 1.
    let alike = |old: f64, new: f64| {
        let of = move |_| [old, new].map(|over| measured([0.5 * over, 0.0], Some(0.5)));
        let test = collected(|all| all.sigmas(&subject, &pairs(&[("a", &of)]))).tests.pop().unwrap();
        (test.worse < 1e-9, test.worse == 1.0, test.better < 1e-9, test.better == 1.0)
    };
    assert_eq!([alike(1.0, 1.0 - 0.4e-6), alike(1.0, 1.0 + 0.4e-6)], [neither; 2], "but for last bits");
    assert_eq!([alike(1.0, 1.0 - 0.6e-6), alike(1.0, 1.0 + 0.6e-6)], [worse; 2]);
    assert_eq!([alike(2.0, 0.5), alike(0.5, 2.0)], [better; 2], "as far off, on the other side");
}

#[test]
fn nothing_that_lacks_a_standard_deviation_counts_in_units_of_it() {
    let with = |sigma| measured([0.3, 0.4], sigma);
    assert!((normalised(&with(Some(0.25))).unwrap() - 4.0).abs() < 1e-12);
    assert_eq!(normalised(&with(Some(0.01))), Some(100.0), "at most ten standard deviations");
    assert_eq!(normalised(&with(None)), None);
    assert_eq!(normalised(&with(Some(0.0))), None);
    assert_eq!(normalised(&Entry::Lost(Found { at: [0.3, 0.4], sigma: Some(0.25) })), None);
    // Nine trials with one are no test; the tenth makes them one.
    let count = |trials: usize| {
        let of = move |trial: usize| [with((trial < trials).then_some(0.25)), with(Some(0.2))];
        collected(|all| all.sigmas(&subject, &pairs(&[("a", &of)]))).tests.len()
    };
    assert_eq!([count(9), count(10)], [0, 1]);
    assert_eq!(collected(|all| all.sigmas(&subject, &pairs(&[("a", &|_| [measured([0.0; 2], Some(0.1)); 2])]))).tests.len(), 1);
}

#[test]
fn wild_points_count_up_to_the_bound() {
    assert_eq!(bounded(&measured([0.5, -0.5], None)), Some([0.5, -0.5]));
    assert_eq!(bounded(&lost([-40.0, f64::NAN])), Some([-3.0, 3.0]));
    assert_eq!(bounded(&lost([40.0, 2.5])), Some([3.0, 2.5]));
    assert_eq!(bounded(&NO_CORNER), None);
}
