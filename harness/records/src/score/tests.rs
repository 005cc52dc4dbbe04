//! Figures of scores against textbooks and hands.

use super::*;
use calibench_model::{PixelPoint, Rejection};

fn point(method: usize, target: &str, error: Option<(f64, f64)>) -> PointResult {
    let outcome = error.map_or(Outcome::Rejected(Rejection::Border), |error| Outcome::Measured {
        position: PixelPoint::new(0.0, 0.0),
        error: Some(error),
    });
    PointResult::new("v", target, method, outcome)
}

#[test]
fn lost_and_rejected_points_are_counted_and_not_averaged() {
    let mut scores = Scores::new(3);
    let points = vec![
        point(0, "a", Some((0.3, 0.4))),
        point(0, "b", Some((3.0, 4.0))),
        point(0, "c", None),
        point(1, "a", Some((0.0, 0.1))),
        point(1, "b", Some((0.0, 0.7))),
        point(2, "a", Some((9.0, 0.0))),
    ];
    // Method 2 only points: what it loses is still common to the operators.
    scores.add(&Trial { number: 0, points, ..Trial::default() }, |method| method < 2);
    let first = &scores.methods[0];
    assert_eq!((first.measured, first.lost, first.rejected["border"], first.points()), (1, 1, 1, 3));
    assert!((first.kept.rmse().unwrap() - 0.5).abs() < 1e-15);
    assert!((first.whole.square.mean().unwrap() - (0.25 + 25.0) / 2.0).abs() < 1e-12);
    assert_eq!((first.targets[1].failed, first.targets[2].failed, first.targets[2].whole.dx.count()), (1, 1, 0));
    let second = &scores.methods[1];
    assert!((second.kept.rmse().unwrap() - 0.5).abs() < 1e-15, "sqrt((0.01 + 0.49) / 2)");
    assert!((second.common.square.mean().unwrap() - 0.01).abs() < 1e-15, "only `a` is common");
    assert_eq!(second.kept.rmse_interval(), None, "one trial has no interval");
    assert_eq!(scores.methods[2].common.square.count(), 1);
}

#[test]
fn groups_are_scored_together() {
    let groups = [("a", "disc"), ("b", "disc")].map(|(target, group)| (target.into(), group.into())).into();
    let mut scores = Scores { groups, ..Scores::new(1) };
    let points = vec![point(0, "a", Some((0.3, 0.0))), point(0, "b", Some((0.1, 0.0))), point(0, "c", None)];
    scores.add(&Trial { number: 0, points, ..Trial::default() }, |_| true);
    let found: Vec<(&str, u64, u64)> = scores.methods[0].targets.iter().map(|t| (&*t.target, t.whole.dx.count(), t.failed)).collect();
    assert_eq!(found, [("disc", 2, 0), ("c", 0, 1)]);
}

#[test]
fn bias_and_scatter_make_the_rmse() {
    let mut errors = Errors::default();
    errors.add(&[(0.1, 0.2), (0.3, -0.1)]);
    errors.add(&[(-0.2, 0.05)]);
    let (dx, dy) = (errors.dx.mean().unwrap(), errors.dy.mean().unwrap());
    let sum = dx * dx + dy * dy + errors.scatter().unwrap().powi(2);
    assert!((sum.sqrt() - errors.rmse().unwrap()).abs() < 1e-15);
}

#[test]
fn one_value_a_trial_is_the_textbook() {
    let mut pooled = Pooled::default();
    [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].into_iter().for_each(|v| pooled.add(&[v]));
    assert_eq!(pooled.mean(), Some(5.0));
    assert!((pooled.standard_error().unwrap() - (32.0_f64 / 7.0 / 8.0).sqrt()).abs() < 1e-14);
    // t(0.975, 7) = 2.364624.
    let (low, high) = pooled.interval(0.95).unwrap();
    let half = 2.364_624_25 * (32.0_f64 / 7.0 / 8.0).sqrt();
    assert!((high - 5.0 - half).abs() < 1e-6 && (5.0 - low - half).abs() < 1e-6);
}

#[test]
fn points_that_repeat_each_other_add_no_certainty() {
    let (mut single, mut repeated) = (Pooled::default(), Pooled::default());
    for value in [0.3, -0.1, 0.4, 0.2, -0.3] {
        single.add(&[value]);
        repeated.add(&[value; 8]);
    }
    assert!((single.standard_error().unwrap() - repeated.standard_error().unwrap()).abs() < 1e-15);
}

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "{found} is not {expected}");
}

fn squares(values: &[f64]) -> Pooled {
    let mut pooled = Pooled::default();
    values.iter().for_each(|value| pooled.add(&[*value]));
    pooled
}

/// Trials 1, 2 | 3 | 4, 6, 5: mean 3.5; sums less 3.5 times counts are -4, -0.5, 4.5, their squares 36.5; sqrt(3 / 2 * 36.5) / 6.
#[test]
fn trials_of_unlike_size_scatter_about_their_share_of_the_mean() {
    let mut pooled = Pooled::default();
    assert_eq!((pooled.mean(), pooled.standard_error(), pooled.interval(0.95), pooled.count()), (None, None, None, 0));
    pooled.add(&[1.0, 2.0]);
    assert_eq!((pooled.mean(), pooled.standard_error(), pooled.count()), (Some(1.5), None, 2));
    pooled.add(&[]);
    assert_eq!(pooled.standard_error(), None, "a trial without points is none");
    pooled.add(&[3.0]);
    pooled.add(&[4.0, 6.0, 5.0]);
    assert_eq!((pooled.mean(), pooled.count()), (Some(3.5), 6));
    close(pooled.standard_error().unwrap(), 54.75_f64.sqrt() / 6.0);
    // t(0.9, 2) = 1.885618: the interval of 80 %.
    let (low, high) = pooled.interval(0.8).unwrap();
    let half = 1.885_618_083 * 54.75_f64.sqrt() / 6.0;
    assert!((low - 3.5 + half).abs() < 1e-8 && (high - 3.5 - half).abs() < 1e-8, "{low} {high}");
}

#[test]
fn two_trials_are_enough_for_a_standard_error() {
    close(squares(&[1.0, 4.0]).standard_error().unwrap(), 1.5);
    close(squares(&[1.0, 4.0]).single().unwrap(), 4.5_f64.sqrt());
}

/// Mean 5, standard error sqrt(32 / 7 / 8), t(0.975, 7) = 2.364624: the root of the mean and of both ends.
#[test]
fn the_root_of_a_mean_of_squares_has_the_roots_of_its_interval() {
    let (value, interval) = root(&squares(&[2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]), 0.95).unwrap();
    let half = 2.364_624_25 * (32.0_f64 / 7.0 / 8.0).sqrt();
    let (low, high) = interval.unwrap();
    close(value, 5.0_f64.sqrt());
    assert!((low - (5.0 - half).sqrt()).abs() < 1e-6 && (high - (5.0 + half).sqrt()).abs() < 1e-6, "{low} {high}");
    let (low, high) = root(&squares(&[0.0, 18.0]), 0.95).unwrap().1.unwrap();
    // t(0.975, 1) = 12.7062: 9 less 114 is less than nothing.
    assert!(low == 0.0 && (high - (9.0_f64 + 9.0 * 12.706_204_7).sqrt()).abs() < 1e-6, "{low} {high}");
    assert_eq!(root(&squares(&[9.0]), 0.95), Some((3.0, None)));
    assert_eq!(root(&Pooled::default(), 0.95), None);
}

/// Squared errors 5, 8 and 11: mean 8, standard error sqrt(3), t(0.975, 2) = 4.302653.
#[test]
fn the_interval_of_an_rmse_is_that_of_the_mean_square() {
    let mut errors = Errors::default();
    [(1.0, -2.0), (2.0, 2.0), (1.0, 10.0_f64.sqrt())].iter().for_each(|error| errors.add(&[*error]));
    let (low, high) = errors.rmse_interval().unwrap();
    let half = 4.302_652_73 * 3.0_f64.sqrt();
    close(errors.rmse().unwrap(), 8.0_f64.sqrt());
    assert!((low - (8.0 - half).sqrt()).abs() < 1e-6 && (high - (8.0 + half).sqrt()).abs() < 1e-6, "{low} {high}");
    assert_eq!((Errors::default().rmse(), Errors::default().rmse_interval(), Errors::default().scatter()), (None, None, None));
}

/// Errors (1, 3) and (5, 7): mean (3, 5), each 2 off in both.
#[test]
fn scatter_is_about_the_mean_error() {
    let mut errors = Errors::default();
    errors.add(&[(1.0, 3.0), (5.0, 7.0)]);
    close(errors.scatter().unwrap(), 8.0_f64.sqrt());
    close(errors.rmse().unwrap(), 42.0_f64.sqrt());
}

#[test]
fn errors_are_compared_with_the_bound_and_with_what_the_method_predicts() {
    let with = |error, bound, predicted| PointResult { bound, predicted, ..point(0, "a", Some(error)) };
    let points = vec![
        with((0.3, 0.4), Some(0.25), Some(1.0)),
        with((0.6, -0.2), Some(0.0), Some(0.5)),
        with((0.5, 0.5), Some(1.0), None),
        with((3.0, 4.0), Some(0.1), Some(0.1)),
    ];
    let mut scores = Scores::new(1);
    scores.add(&Trial { points, ..Trial::default() }, |_| true);
    let score = &scores.methods[0];
    assert_eq!((score.to_bound.count(), score.to_predicted.count()), (2, 2), "no bound of zero, no point that is lost");
    close(score.to_bound.mean().unwrap(), (4.0 + 0.5) / 2.0);
    close(score.to_predicted.mean().unwrap(), (0.25 + 1.6) / 2.0);
    close(score.kept.square.mean().unwrap(), (0.25 + 0.4 + 0.5) / 3.0);
}

#[test]
fn every_point_is_counted_once_over_all_trials() {
    let unknown = |method: usize, target: &str| {
        PointResult::new("v", target, method, Outcome::Measured { position: PixelPoint::new(1.0, 2.0), error: None })
    };
    let mut scores = Scores::new(0);
    for number in 0..3 {
        let mut points = vec![point(0, "a", Some((0.25, 0.0))), point(0, "b", Some((2.0, 0.0))), point(0, "b", None), unknown(0, "c")];
        points.extend([point(2, "a", Some((0.5, 0.0))), point(2, "b", Some((0.0, 0.75))), point(2, "b", None), point(2, "b", None)]);
        scores.add(&Trial { number, points, ..Trial::default() }, |_| true);
    }
    assert_eq!((scores.trials, scores.methods.len()), (3, 3), "methods come as they are met");
    let [first, nobody, third] = &scores.methods[..] else { panic!("three methods") };
    assert_eq!((first.measured, first.lost, first.rejected["border"], first.points()), (6, 3, 3, 12));
    assert_eq!((third.measured, third.lost, third.rejected["border"], third.points()), (6, 0, 6, 12));
    assert_eq!(nobody.points(), 0);
    let targets = |score: &Score| score.targets.iter().map(|t| (t.target.to_string(), t.whole.dx.count(), t.failed)).collect::<Vec<_>>();
    assert_eq!(targets(first), [("a".into(), 3, 0), ("b".into(), 3, 6), ("c".into(), 0, 0)]);
    assert_eq!(targets(third), [("a".into(), 3, 0), ("b".into(), 3, 6)]);
    close(first.targets[1].whole.dx.mean().unwrap(), 2.0);
    assert_eq!((first.whole.dx.count(), first.kept.dx.count()), (6, 3));
    // `b` was lost by the first method.
    assert_eq!((first.common.dx.count(), third.common.dx.count()), (3, 3));
    close(third.common.rmse().unwrap(), 0.5);
}

#[test]
fn points_are_common_by_view_and_target() {
    let seen = |view: &str, method: usize, dx: f64| PointResult { view: view.into(), ..point(method, "a", Some((dx, 0.0))) };
    let points = vec![seen("v", 0, 0.125), seen("w", 0, 0.25), seen("w", 1, 0.5), seen("x", 1, 0.75), seen("w", 2, 2.0)];
    let mut scores = Scores::new(3);
    scores.add(&Trial { points, ..Trial::default() }, |method| method < 2);
    let common = |method: usize| scores.methods[method].common.rmse();
    assert_eq!([common(0), common(1), common(2)], [Some(0.25), Some(0.5), Some(2.0)]);
}

/// Methods 1 and 2 are limited to one target each; method 3 only points.
#[test]
fn a_limited_operator_is_asked_only_for_what_it_measures() {
    let row = |method: usize, target: &str, dx: f64| point(method, target, Some((dx, 0.0)));
    let points = vec![
        row(0, "a", 0.125),
        row(0, "b", 0.125),
        row(0, "c", 0.125),
        row(1, "a", 0.5),
        row(2, "b", 5.0),
        row(3, "a", 0.25),
        row(3, "c", 0.75),
    ];
    let common = |limited: &[usize]| {
        let mut scores = Scores { limited: limited.iter().copied().collect(), ..Scores::new(4) };
        scores.add(&Trial { points: points.clone(), ..Trial::default() }, |method| method < 3);
        scores.methods.iter().map(|score| score.common.square.count()).collect::<Vec<_>>()
    };
    // `b` is lost by the only other method that is to measure it.
    assert_eq!(common(&[1, 2]), [2, 1, 0, 2]);
    assert_eq!(common(&[]), [0, 0, 0, 0]);
}
