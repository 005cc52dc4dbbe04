//! Sums of two runs, judged against bounds by hand.

use super::*;

/// A target with `counts`, both coordinates' mean and variance, and a reported standard deviation.
fn sum(counts: [u64; 3], mean: [f64; 2], variance: [f64; 2], sigma: Option<f64>) -> Sum {
    Sum { counts, mean, covariance: [variance[0], 0.0, variance[1]], sigma, ..Sum::default() }
}

fn sums(digest: &str, targets: &[(&str, Sum)]) -> PointSums {
    PointSums { digest: digest.into(), targets: targets.iter().map(|(name, sum)| ((*name).into(), *sum)).collect() }
}

fn make(verdict: Verdict, metric: &'static str, message: String) -> Finding {
    Finding::new(verdict, "f/s", "m", metric, message)
}

/// What is found of targets `a`, `b`, ..., with other digests: verdict, metric, target.
fn found(old: &[Sum], new: &[Sum]) -> Vec<Finding> {
    let of = |digest, all: &[Sum]| sums(digest, &["a", "b", "c"].into_iter().zip(all.iter().copied()).collect::<Vec<_>>());
    judged(&of("old", old), &of("new", new), &make)
}

fn fails(findings: &[Finding]) -> Vec<(&'static str, Option<&str>)> {
    findings.iter().filter(|f| f.fails()).map(|f| (f.metric, f.target.as_deref())).collect()
}

fn close(found: Option<f64>, expected: f64) -> bool {
    found.is_some_and(|found| (found - expected).abs() < 1e-12)
}

fn of<'a>(findings: &'a [Finding], metric: &str) -> &'a Finding {
    findings.iter().find(|finding| finding.metric == metric).unwrap()
}

#[test]
fn targets_are_pooled_by_their_points() {
    // 30 points with squares 0.25 + 0.05 and 10 with 1 + 0.2; the spread is what lies about the means.
    let all = [sum([30, 1, 4], [0.3, -0.4], [0.04, 0.01], None), sum([10, 2, 3], [0.0, 1.0], [0.1, 0.1], None)];
    let pooled = Pooled::of(all.iter());
    assert_eq!(pooled.counts, [40.0, 3.0, 7.0]);
    assert!((pooled.points() - 50.0).abs() < 1e-12);
    assert!((pooled.rms() - ((30.0 * 0.3 + 10.0 * 1.2) / 40.0_f64).sqrt()).abs() < 1e-12);
    assert!((pooled.scatter() - ((30.0 * 0.05 + 10.0 * 0.2) / 40.0_f64).sqrt()).abs() < 1e-12);
    let none = Pooled::of([sum([0, 3, 0], [0.0; 2], [0.0; 2], None)].iter());
    assert_eq!((none.rms(), none.scatter()), (0.0, 0.0));
}

#[test]
fn a_changed_digest_is_said_with_both_figures() {
    let old = [sum([30, 0, 0], [0.3, 0.4], [0.0; 2], None), sum([10, 0, 0], [0.0, 1.0], [0.0; 2], None)];
    let new = [sum([30, 0, 0], [0.4, 0.3], [0.0; 2], None), old[1]];
    let all = found(&old, &new);
    assert_eq!((all.len(), all[0].verdict, all[0].metric), (1, Verdict::Changed, "digest"), "as large, elsewhere: {all:?}");
    let rms = ((30.0 * 0.25 + 10.0) / 40.0_f64).sqrt();
    assert!(close(all[0].baseline, rms) && close(all[0].now, rms));
    assert!(judged(&sums("d", &[("a", old[0])]), &sums("d", &[("a", new[0])]), &make).is_empty(), "the same digest, the same points");
}

#[test]
fn last_digits_of_sums_are_no_change() {
    let base = sum([30, 0, 0], [0.3, 0.4], [0.04, 0.01], None);
    let same = |change: &dyn Fn(&mut Sum)| {
        let mut new = base;
        change(&mut new);
        let (there, back) = (found(&[base], &[new]), found(&[new], &[base]));
        assert_eq!(there.is_empty(), back.is_empty());
        there.is_empty()
    };
    assert!(same(&|s| s.mean[0] += 1.9e-8) && !same(&|s| s.mean[0] += 2.1e-8));
    assert!(same(&|s| s.mean[1] -= 1.9e-8) && !same(&|s| s.mean[1] -= 2.1e-8));
    // Four millionths of 0.05.
    for place in 0..3 {
        assert!(same(&|s| s.covariance[place] += 1.9e-7), "{place}");
        assert!(!same(&|s| s.covariance[place] += 2.1e-7), "{place}");
    }
    assert!(!same(&|s| s.counts = [29, 1, 0]) && !same(&|s| s.counts = [30, 0, 1]));
    assert!(!same(&|s| s.nans = 1));
    // Where all points are one, what rounding leaves of a square: 4e-16.
    let point = sum([30, 0, 0], [0.3, 0.4], [0.0; 2], None);
    assert!(found(&[point], &[Sum { covariance: [0.0, 3.9e-16, 0.0], ..point }]).is_empty());
    assert!(!found(&[point], &[Sum { covariance: [0.0, 4.1e-16, 0.0], ..point }]).is_empty());
}

#[test]
fn a_target_that_is_missing_fails_and_a_new_one_changes() {
    let base = sum([30, 0, 0], [0.3, 0.4], [0.04, 0.01], None);
    assert_eq!(fails(&found(&[base, base], &[base])), [("target", Some("b"))]);
    let more = found(&[base], &[base, base]);
    assert!(fails(&more).is_empty() && more.len() == 1 && more[0].metric == "digest", "{more:?}");
}

#[test]
fn a_root_mean_square_may_grow_by_a_fiftieth_and_scatter_by_a_twentyfifth() {
    let with = |mean: f64, scatter: f64| [sum([100, 0, 0], [mean, 0.0], [scatter * scatter, 0.0], None)];
    let grown = |mean: f64, scatter: f64| {
        let all = found(&with(0.5, 0.01), &with(0.5 * mean, 0.01 * scatter));
        fails(&all).into_iter().map(|(metric, _)| metric).collect::<Vec<_>>()
    };
    assert!(grown(1.019, 1.0).is_empty());
    assert_eq!(grown(1.021, 1.0), ["rms_error"]);
    assert!(grown(1.0, 1.039).is_empty());
    assert_eq!(grown(1.0, 1.041), ["scatter"]);
    assert!(grown(0.5, 0.5).is_empty(), "better");
    let found = found(&with(0.5, 0.0), &with(0.6, 0.0));
    let worse = of(&found, "rms_error");
    assert!(close(worse.baseline, 0.5) && close(worse.now, 0.6) && worse.message == "worse by more than 2 %", "{worse:?}");
    // Where there was no error, last bits are none.
    assert!(!grew(0.0, 1e-6, 0.02) && grew(0.0, 1.1e-6, 0.02) && !grew(1.0, 1.02 + 0.9e-6, 0.02) && grew(1.0, 1.02 + 1.1e-6, 0.02));
}

#[test]
fn a_target_may_grow_by_a_fifth_of_the_methods_own() {
    // Root mean squares 0.8 and 0.6 of as many points: the method's own is 0.7071, a fifth of it 0.1414.
    let with = |a: f64, b: f64| [sum([50, 0, 0], [0.0, a], [0.0; 2], None), sum([50, 0, 0], [b, 0.0], [0.0; 2], None)];
    let targets = |a: f64, b: f64| {
        let all = found(&with(0.8, 0.6), &with(a, b));
        all.into_iter().filter(|f| f.fails() && f.target.is_some()).map(|f| (f.target.unwrap(), f.baseline, f.now)).collect::<Vec<_>>()
    };
    assert_eq!(targets(0.5, 0.741), []);
    let [(name, old, new)] = &targets(0.5, 0.742)[..] else { panic!("one target") };
    assert!(name == "b" && close(*old, 0.6) && close(*new, 0.742));
    assert_eq!(targets(0.942, 0.1).len(), 1);
    assert_eq!(targets(0.941, 0.1), []);
    // Without any error before, a millionth of a pixel is none.
    let none = |now: f64| fails(&found(&with(0.0, 0.0), &with(now, 0.0))).iter().filter(|(_, target)| target.is_some()).count();
    assert_eq!([none(0.9e-6), none(1.1e-6)], [0, 1]);
}

#[test]
fn one_in_a_hundred_points_may_fail() {
    // 300 points of which one is lost and two are rejected: three more of each may be, four are too many.
    let with = |lost: u64, rejected: u64| [sum([300 - lost - rejected, lost, rejected], [0.1, 0.0], [0.0; 2], None)];
    let said = |lost: u64, rejected: u64| {
        let all = found(&with(1, 2), &with(lost, rejected));
        let counted = |f: Finding| (f.verdict, f.metric, f.target, f.baseline.unwrap(), f.now.unwrap());
        all.into_iter().filter(|f| f.metric != "digest").map(counted).collect::<Vec<_>>()
    };
    let target = Some("a".to_owned());
    assert_eq!(said(4, 2), [(Verdict::Changed, "lost", target.clone(), 1.0, 4.0)]);
    assert_eq!(said(5, 2), [(Verdict::Changed, "lost", target.clone(), 1.0, 5.0), (Verdict::Fails, "lost", None, 1.0, 5.0)]);
    assert_eq!(said(1, 5), [(Verdict::Changed, "rejected", target.clone(), 2.0, 5.0)]);
    assert_eq!(said(1, 6), [(Verdict::Changed, "rejected", target.clone(), 2.0, 6.0), (Verdict::Fails, "rejected", None, 2.0, 6.0)]);
    assert_eq!(said(0, 0), [], "fewer");
    // Of twenty points one may, whatever its share.
    let few = |lost: u64| {
        fails(&found(&[sum([20, 0, 0], [0.1; 2], [0.0; 2], None)], &[sum([20 - lost, lost, 0], [0.1; 2], [0.0; 2], None)])).len()
    };
    assert_eq!([few(1), few(2)], [0, 1]);
}

#[test]
fn points_of_several_targets_are_counted_together() {
    let kept = |lost: u64| sum([100 - lost, lost, 0], [0.1, 0.0], [0.0; 2], None);
    let all = found(&[kept(0), kept(2)], &[kept(2), kept(1)]);
    let lost: Vec<_> = all.iter().filter(|f| f.metric == "lost").map(|f| (f.verdict, f.target.as_deref())).collect();
    assert_eq!(lost, [(Verdict::Changed, Some("a"))], "b has fewer, and one more of all is not too many");
}

#[test]
fn a_method_that_measures_nothing_is_not_tested() {
    let none = sum([0, 0, 30], [0.0; 2], [0.0; 2], None);
    let some = sum([30, 0, 0], [0.1; 2], [0.0; 2], None);
    let all = found(&[some], &[none]);
    assert!(of(&all, "tests").fails() && close(of(&all, "tests").baseline, 30.0) && close(of(&all, "tests").now, 0.0));
    let tests = |old: &[Sum], new: &[Sum]| found(old, new).iter().filter(|f| f.metric == "tests").count();
    assert_eq!(tests(&[none, some], &[some, none]), 0, "one target of two");
    assert_eq!(tests(&[none], &[sum([0, 1, 29], [0.0; 2], [0.0; 2], None)]), 0, "there was none before");
    assert_eq!(tests(&[none], &[some]), 0);
}

#[test]
fn more_points_that_are_no_number_fail() {
    let with = |nans: u64| Sum { nans, ..sum([95, 5, 0], [0.1; 2], [0.0; 2], None) };
    let all = found(&[with(2), with(3)], &[with(3), with(3)]);
    let nans: Vec<_> = all.iter().filter(|f| f.metric == "nan").map(|f| (f.verdict, f.target.as_deref(), f.baseline, f.now)).collect();
    assert_eq!(nans, [(Verdict::Fails, Some("a"), Some(2.0), Some(3.0))]);
    assert!(found(&[with(2)], &[with(1)]).iter().all(|f| f.metric != "nan"), "fewer");
}

#[test]
fn reported_standard_deviations_are_judged_by_the_points_of_all_targets() {
    // Squares 0.25 of 30 points and 1 of 10, in sum 17.5; variances by the same numbers.
    let with = |a: Option<f64>, b: Option<f64>| [sum([30, 0, 0], [0.3, 0.4], [0.0; 2], a), sum([10, 0, 0], [1.0, 0.0], [0.0; 2], b)];
    let judge = |old: [Option<f64>; 2], new: [Option<f64>; 2]| {
        let [old, new] = [old, new].map(|[a, b]| with(a, b));
        sigmas(&sums("d", &[("a", old[0]), ("b", old[1])]), &sums("d", &[("a", new[0]), ("b", new[1])]), &make).pop()
    };
    let ratio = |a: f64, b: f64| (17.5 / (30.0 * a * a + 10.0 * b * b)).sqrt();
    let found = judge([Some(0.5), Some(1.0)], [Some(0.25), Some(0.75)]).unwrap();
    assert!(found.fails() && close(found.baseline, 1.0) && close(found.now, ratio(0.25, 0.75)), "{found:?}");
    assert_eq!(found.message, "the reported standard deviations of 2 targets are others");
    let back = judge([Some(0.25), Some(0.75)], [Some(0.5), Some(1.0)]).unwrap();
    assert!(back.verdict == Verdict::Changed && close(back.baseline, ratio(0.25, 0.75)) && close(back.now, 1.0));
    // A twentieth away from what fits is too far, on either side.
    let scaled = |by: f64| judge([Some(0.5), Some(1.0)], [Some(0.5 * by), Some(by)]).unwrap().verdict;
    assert_eq!([0.049_f64, -0.049].map(|by| scaled(by.exp())), [Verdict::Changed; 2]);
    assert_eq!([0.051_f64, -0.051].map(|by| scaled(by.exp())), [Verdict::Fails; 2]);
    // One target alone, and by no more than the tolerance.
    assert!(judge([Some(0.5), Some(1.0)], [Some(0.51), Some(1.0)]).unwrap().message.contains(" 1 targets"));
    assert_eq!(judge([Some(0.5), Some(1.0)], [Some(0.5 + 0.9e-6), Some(1.0 - 0.9e-6)]), None);
    assert!(judge([Some(0.5), Some(1.0)], [Some(0.5), Some(1.0 + 1.1e-6)]).is_some());
    assert_eq!(judge([None, Some(1.0)], [Some(0.5), Some(1.0)]), None, "one more is no loss");
}

#[test]
fn standard_deviations_that_are_missing_fail_where_points_are_measured() {
    let with = |kept: u64, sigma| sums("d", &[("a", sum([kept, 30 - kept, 0], [0.3, 0.4], [0.0; 2], sigma))]);
    let of = |kept: u64, sigma| sigmas(&with(30, Some(0.5)), &with(kept, sigma), &make);
    assert!(of(30, None)[0].fails() && of(1, None)[0].fails());
    assert!(of(0, None).is_empty(), "there is no point that could have one");
    // The digest does not see them: they are judged with the same one.
    assert_eq!(judged(&with(30, Some(0.5)), &with(30, None), &make).len(), 1);
}
