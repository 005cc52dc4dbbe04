//! What a comparison names, counts and lets pass.

use super::*;
use crate::point_entry::Entry;
use crate::tests::{NO_CORNER, holding, lost, measured, method};

fn kept(dx: f64) -> Entry {
    measured([dx, 0.0], None)
}

fn errors(points: impl IntoIterator<Item = (u64, &'static str, Entry)>) -> Table {
    holding(Coordinates::Errors, method(points))
}

fn metrics(findings: &[Finding]) -> Vec<(Verdict, &'static str)> {
    findings.iter().map(|finding| (finding.verdict, finding.metric)).collect()
}

/// `trials` trials of one point with an error of `dx`.
fn run(trials: u64, dx: f64) -> Table {
    errors((0..trials).map(|trial| (trial, "a", kept(dx))))
}

#[test]
fn another_seed_fails_where_trials_are_random() {
    let seeds = |coordinates, seed, deterministic| {
        let of = |seed| {
            let mut table = holding(coordinates, method([(0, "a", kept(0.1))]));
            table.seed = seed;
            table
        };
        metrics(&compare(&of(7), &of(seed), deterministic).findings)
    };
    assert_eq!(seeds(Coordinates::Errors, 8, false), [(Verdict::Fails, "seed")]);
    assert_eq!(seeds(Coordinates::Errors, 7, false), []);
    assert_eq!(seeds(Coordinates::Errors, 8, true), [], "nothing is random");
    assert_eq!(seeds(Coordinates::Positions, 8, false), [], "photographs have no trials");
}

#[test]
fn errors_and_positions_are_not_compared() {
    let found = compare(&run(1, 0.1), &holding(Coordinates::Positions, method([(0, "a", kept(0.1))])), true);
    assert_eq!((metrics(&found.findings), found.methods), (vec![(Verdict::Fails, "coordinates")], [0, 0]));
}

#[test]
fn methods_with_the_same_and_with_other_numbers_are_counted() {
    let with = |n: f64| {
        let mut table = run(12, 0.1);
        for (label, dx) in [("n", n), ("o", 0.1), ("p", 0.2)] {
            *table.method_mut(&label.into(), &"1".into()) = method([(0, "a", kept(dx))]);
        }
        table
    };
    let mut now = with(0.15);
    now.method_mut(&"p".into(), &"1".into()).unavailable = Some("not built".into());
    // m and o stay, n is another, p is not there.
    assert_eq!(compare(&with(0.1), &now, false).methods, [2, 1]);
}

#[test]
fn ten_trials_are_put_to_tests_and_nine_are_not() {
    assert_eq!(compare(&run(9, 0.1), &run(9, 0.2), false).tests.len(), 0);
    // Lost, rejected, two means of the target, two means of all, root mean square, scatter.
    assert_eq!(compare(&run(10, 0.1), &run(10, 0.2), false).tests.len(), 8);
    assert_eq!(compare(&run(20, 0.1), &run(20, 0.2), true).tests.len(), 0, "nothing is random");
}

#[test]
fn a_library_is_foreign_if_both_are_known_and_differ() {
    let with = |library: &str, dx: f64| {
        let mut table = run(12, dx);
        table.describe("m", String::new(), library.into());
        table
    };
    for (old, new, verdict) in
        [("A 1", "A 2", Verdict::Informs), ("A 1", "A 1", Verdict::Changed), ("", "A 2", Verdict::Changed), ("A 1", "", Verdict::Changed)]
    {
        let found = compare(&with(old, 0.1), &with(new, 0.2), false);
        assert_eq!(metrics(&found.findings), [(verdict, "position")], "{old}, {new}");
        assert!(found.tests.iter().all(|test| test.finding.verdict == verdict), "{old}, {new}");
    }
    let single = |new: &str| metrics(&compare(&with("A 1", 0.1), &with(new, 0.2), true).findings);
    assert_eq!(single("A 1"), vec![(Verdict::Fails, "dx"); 12], "each point by itself");
    // Twelve units of one point each, all of which moved.
    assert_eq!(single("A 2"), [(Verdict::Informs, "position")], "by statistics");
}

#[test]
fn an_edited_text_is_said_if_both_are_known() {
    let with = |text: &str, dx: f64| {
        let mut table = run(1, dx);
        text.clone_into(&mut table.text);
        table
    };
    let said = |old: &str, new: &str, dx: f64| {
        let found = compare(&with(old, 0.1), &with(new, dx), true).findings;
        found.into_iter().find(|finding| finding.metric == "scenario").map(|finding| finding.verdict)
    };
    assert_eq!(said("x", "y", 0.1), Some(Verdict::Changed));
    assert_eq!(said("x", "y", 0.2), Some(Verdict::Fails));
    for (old, new) in [("x", "x"), ("", "y"), ("x", "")] {
        assert_eq!(said(old, new, 0.2), None, "{old}, {new}");
    }
}

#[test]
fn what_got_worse_is_named_and_what_did_not_is_counted() {
    let nan = lost([f64::NAN, 0.0]);
    let old = method([
        (0, "a", kept(0.1)),
        (0, "b", kept(0.1)),
        (0, "c", NO_CORNER),
        (0, "d", lost([2.0, 0.0])),
        (0, "e", NO_CORNER),
        (0, "f", kept(0.1)),
    ]);
    let new = method([
        (0, "a", NO_CORNER),
        (0, "b", nan),
        (0, "c", kept(0.1)),
        (0, "d", kept(0.1)),
        (0, "e", lost([2.0, 0.0])),
        (0, "f", measured([0.1, 0.25], None)),
    ]);
    for (foreign, verdict) in [(false, Verdict::Changed), (true, Verdict::Informs)] {
        let found = named("f/s", "m", &Changes::of(&old, &new), foreign);
        let expected = [
            (verdict, Some("image/a"), "was measured, is rejected (no_corner)"),
            (Verdict::Fails, Some("image/b"), "was measured, is not a number"),
            (verdict, None, "3 points are measured that were not, or fail for another reason"),
            (verdict, None, "3 points moved, by up to inf px; the first is image/b"),
        ];
        let found: Vec<_> = found.iter().map(|finding| (finding.verdict, finding.target.as_deref(), &*finding.message)).collect();
        assert_eq!(found, expected);
    }
    let moved = named("f/s", "m", &Changes::of(&method([(0, "f", kept(0.1))]), &new), false);
    assert_eq!(moved.len(), 1, "no status is another: {moved:?}");
    assert_eq!(moved[0].message, "1 points moved, by up to 0.250000 px; the first is image/f");
}

#[test]
fn standard_deviations_that_are_lost_are_counted() {
    let with =
        |sigmas: [Option<f64>; 4]| method(["a", "b", "c", "d"].into_iter().zip(sigmas).map(|(name, s)| (0, name, measured([0.1; 2], s))));
    let said = |old, new| lost_sigmas("f/s", "m", &Changes::of(&with(old), &with(new))).map(|finding| (finding.verdict, finding.message));
    let all = [Some(0.1), Some(0.1), None, Some(0.1)];
    let (none, nan) =
        ([Some(0.2), None, Some(0.1), Some(f64::NAN)], "2 points have lost their reported standard deviation; the first is image/b");
    assert_eq!(said(all, none), Some((Verdict::Fails, nan.to_owned())));
    assert_eq!(said(all, [Some(0.2), Some(0.3), Some(0.4), Some(0.5)]), None, "others, and none lost");
    assert_eq!(said([Some(f64::NAN); 4], [None; 4]), None, "there was nothing to lose");
}

#[test]
fn standard_deviations_without_trials_are_judged_by_their_errors() {
    // Squared errors 25 and 144 + 25, in sum 194 hundredths of a px^2.
    let with = |coordinates, sigmas: [f64; 2]| {
        let at = [[0.3, 0.4], [1.2, 0.5]];
        holding(
            coordinates,
            method(["a", "b"].into_iter().zip(at.into_iter().zip(sigmas)).map(|(name, (at, s))| (0, name, measured(at, Some(s))))),
        )
    };
    let judged = |coordinates, old: [f64; 2], new: [f64; 2]| {
        let (old, new) = (with(coordinates, old), with(coordinates, new));
        sigmas(&old, "m", &Changes::of(old.method("m").unwrap(), new.method("m").unwrap())).unwrap()
    };
    let ratio = |[a, b]: [f64; 2]| (1.94 / (a * a + b * b)).sqrt();
    let errors = Coordinates::Errors;
    for (old, new, verdict) in [
        // Ratios 1.94 / 2, 1.94 / 1, 1.94 / 4.
        ([1.0, 1.0], [0.6, 0.8], Verdict::Fails),
        ([0.6, 0.8], [1.0, 1.0], Verdict::Changed),
        ([1.0, 1.0], [1.6, 1.2], Verdict::Fails),
        ([1.6, 1.2], [1.0, 1.0], Verdict::Changed),
        // The same sum of variances, the other way round.
        ([0.6, 0.8], [0.8, 0.6], Verdict::Changed),
    ] {
        let found = judged(errors, old, new);
        assert_eq!(found.verdict, verdict, "{old:?} {new:?}");
        let close = |found: Option<f64>, expected: f64| (found.unwrap() - expected).abs() < 1e-12;
        assert!(close(found.baseline, ratio(old)) && close(found.now, ratio(new)), "{found:?}");
        assert_eq!(found.message, "the reported standard deviation of 2 points is another; the first is image/a");
    }
    let unknown = judged(Coordinates::Positions, [1.0, 1.0], [2.0, 2.0]);
    assert_eq!((unknown.verdict, unknown.baseline), (Verdict::Fails, None), "no truth judges them");
}

#[test]
fn errors_that_are_zero_or_variances_that_are_judge_nothing() {
    let with = |dx: f64, sigma: f64| errors([(0, "a", measured([dx, 0.0], Some(sigma)))]);
    let judged = |old: &Table, new: &Table| {
        let found = sigmas(old, "m", &Changes::of(old.method("m").unwrap(), new.method("m").unwrap())).unwrap();
        (found.verdict, found.baseline)
    };
    // Ratios 2 and 1 are better; with no error, or no variance, there is no ratio.
    assert_eq!(judged(&with(0.2, 0.1), &with(0.2, 0.2)), (Verdict::Changed, Some(2.0)));
    for (old, new) in [([0.0, 0.1], [0.2, 0.2]), ([0.2, 0.1], [0.0, 0.2]), ([0.0, 0.1], [0.0, 0.2]), ([0.2, 0.0], [0.2, 0.2])] {
        assert_eq!(judged(&with(old[0], old[1]), &with(new[0], new[1])), (Verdict::Fails, None), "{old:?} {new:?}");
    }
    // A method that is exactly right may be further off by last bits alone: by a half and by two millionths.
    let scaled = |by: f64| judged(&with(4.0, 4.0), &with(4.0, 4.0 * (1.0 + by))).0;
    assert_eq!((scaled(5e-7), scaled(2e-6)), (Verdict::Changed, Verdict::Fails));
}

#[test]
fn points_of_another_version_may_move_by_a_twentieth_of_a_pixel() {
    // 100 points of which `moved` go 0.3, 0.4 away: squares 0.25, by 100.
    let with = |moved: usize, gone: usize| {
        let name = |index: usize| -> &'static str { ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j"][index % 10] };
        let entry = move |index: usize| match index {
            _ if index < gone => NO_CORNER,
            _ if index >= 100 - moved => measured([10.3, 10.4], None),
            _ => measured([10.0, 10.0], None),
        };
        method((0..100).map(move |index| (index as u64 / 10, name(index), entry(index))))
    };
    let base = with(0, 0);
    let found = |moved: usize, gone: usize| {
        let now = with(moved, gone);
        let found = other_version("f/s", "m", &Changes::of(&base, &now), 100);
        found.into_iter().map(|f| (f.metric, f.baseline.unwrap(), f.now.unwrap(), f.fails())).collect::<Vec<_>>()
    };
    assert_eq!(found(0, 0), []);
    let [(metric, was, now, fails)] = found(4, 0)[..] else { panic!("{:?}", found(4, 0)) };
    assert!(metric == "position" && was == 0.0 && (now - 0.1).abs() < 1e-12 && fails, "the root of 4 * 0.25 / 100 is 0.1: {now}");
    assert_eq!(found(0, 1), [], "one of a hundred");
    assert_eq!(found(0, 2), [("measured", 100.0, 98.0, true)]);
    // All points by 0.05 px, in one coordinate: not more than the bound.
    let shifted = |by: f64| {
        let now = method((0..4).map(|trial| (trial, "a", measured([by, 0.0], None))));
        let base = method((0..4).map(|trial| (trial, "a", measured([0.0, 0.0], None))));
        other_version("f/s", "m", &Changes::of(&base, &now), 4).len()
    };
    assert_eq!([shifted(0.05), shifted(0.050_001)], [0, 1]);
}

#[test]
fn photographs_of_another_version_are_judged_by_their_moves() {
    let with = |library: &str, x: f64, sigma: f64| {
        let mut table = holding(Coordinates::Positions, method([(0, "a", measured([x, 0.0], Some(sigma)))]));
        table.describe("m", String::new(), library.into());
        table
    };
    let base = with("A 1", 0.0, 0.1);
    let found = |now: &Table| metrics(&compare(&base, now, false).findings);
    assert_eq!(found(&with("A 2", 0.04, 0.1)), [(Verdict::Informs, "position")]);
    assert_eq!(found(&with("A 2", 0.06, 0.1)), [(Verdict::Informs, "position"), (Verdict::Fails, "position")]);
    assert_eq!(found(&with("A 2", 0.0, 0.2)), [(Verdict::Informs, "sigma")]);
    assert_eq!(found(&with("A 1", 0.04, 0.1)), [(Verdict::Fails, "x")]);
    assert_eq!(found(&with("A 1", 0.0, 0.2)), [(Verdict::Fails, "sigma")]);
}
