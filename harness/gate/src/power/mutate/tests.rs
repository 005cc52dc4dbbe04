//! Every fault is put in as its name says.

use super::*;
use crate::tests::{NO_CORNER, at as place, lost as away, measured, method};

const KEY: Key<'_> = Key { seed: 0, of: "f/s", trial: 0, view: "m", target: "" };

fn kept(dx: f64, dy: f64) -> Entry {
    measured([dx, dy], Some(0.5))
}

/// The coordinates of a point after `mutation`.
fn after(method: &MethodTable, mutation: Mutation) -> impl Fn(u64, &str) -> [f64; 2] {
    let points = mutation.of(method, KEY).unwrap().points;
    move |trial, target| points[&place(trial, target)].coordinates().unwrap()
}

fn near([a, b]: [f64; 2], [c, d]: [f64; 2]) -> bool {
    (a - c).abs() < 1e-9 && (b - d).abs() < 1e-9
}

/// Points that were measured, and are so no more, as (was, is).
fn changed(old: &MethodTable, new: &MethodTable) -> Vec<(Entry, Entry)> {
    let pairs = old.points.iter().map(|(place, entry)| (*entry, new.points[place]));
    pairs.filter(|(old, new)| old != new && !(old.is_nan() && new.is_nan())).collect()
}

#[test]
fn deviations_from_the_mean_of_a_target_are_doubled() {
    let old = method([
        (0, "a", kept(0.1, 0.5)),
        (1, "a", kept(0.3, 0.1)),
        (2, "a", away([2.0, 0.0])),
        (0, "b", kept(-0.4, 0.2)),
        (1, "b", kept(-0.4, 0.4)),
        (2, "b", NO_CORNER),
        (0, "c", away([3.0, 1.0])),
    ]);
    // Means: (0.2, 0.3) and (-0.4, 0.3); c was never measured.
    let new = after(&old, Mutation::DoubledNoise);
    assert!(near(new(0, "a"), [0.0, 0.7]) && near(new(1, "a"), [0.4, -0.1]), "{:?} {:?}", new(0, "a"), new(1, "a"));
    assert!(near(new(0, "b"), [-0.4, 0.1]) && near(new(1, "b"), [-0.4, 0.5]));
    assert!(near(new(2, "a"), [3.8, -0.3]) && near(new(0, "c"), [3.0, 1.0]));
    assert_eq!(Mutation::DoubledNoise.of(&method([(0, "a", NO_CORNER)]), KEY), Err("no point is measured"));
}

#[test]
fn a_point_is_lost_beyond_the_border_alone() {
    let found = Found { at: [0.0; 2], sigma: Some(0.5) };
    assert_eq!(at(found, [LOST, 0.0]), measured([LOST, 0.0], Some(0.5)));
    assert_eq!(at(found, [0.8, -0.7]), Entry::Lost(Found { at: [0.8, -0.7], sigma: Some(0.5) }));
    assert!(matches!(at(found, [f64::NAN, 0.0]), Entry::Lost(_)));
}

#[test]
fn noise_makes_the_scatter_a_tenth_larger() {
    // 2000 trials of two targets with means (0.3, -0.2) and (-0.3, 0.1); each deviates by 0.05 and 0.02, with both signs.
    let sign = |bit: bool| if bit { 1.0 } else { -1.0 };
    let all = (0..2000_u64).flat_map(|trial| {
        let (dx, dy) = (0.05 * sign(trial.is_multiple_of(2)), 0.02 * sign(trial % 4 < 2));
        [(trial, "a", kept(0.3 + dx, -0.2 + dy)), (trial, "b", kept(-0.3 + dx, 0.1 + dy))]
    });
    let old = method(all);
    let new = Mutation::MoreNoise.of(&old, KEY).unwrap();
    let noise: Vec<[f64; 2]> = old
        .points
        .iter()
        .map(|(place, entry)| {
            let ([a, b], [c, d]) = (entry.coordinates().unwrap(), new.points[place].coordinates().unwrap());
            [c - a, d - b]
        })
        .collect();
    let n = noise.len() as f64;
    // Variance of a coordinate (0.05^2 + 0.02^2) / 2, of which 1.1^2 - 1 is added.
    let variance = (0.0025 + 0.0004) / 2.0 * 0.21;
    let mean = |of: &dyn Fn(&[f64; 2]) -> f64| noise.iter().map(of).sum::<f64>() / n;
    // Four standard deviations of a variance, a mean and a covariance of 4000 normal numbers.
    let part = 4.0 / n.sqrt();
    for axis in 0..2 {
        assert!(
            (mean(&|v| v[axis] * v[axis]) / variance - 1.0).abs() < part * 2.0_f64.sqrt(),
            "{}",
            mean(&|v| v[axis] * v[axis]) / variance
        );
        assert!(mean(&|v| v[axis]).abs() < part * variance.sqrt());
    }
    assert!(mean(&|v| v[0] * v[1]).abs() < part * variance, "both coordinates have their own");
    let same = Mutation::MoreNoise.of(&old, KEY).unwrap();
    assert_eq!(same, new, "the same key, the same noise");
    let still = method([(0, "a", kept(0.25, 0.5)), (1, "a", kept(0.25, 0.5)), (0, "b", kept(0.125, 0.0))]);
    assert_eq!(Mutation::MoreNoise.of(&still, KEY), Err("there is no scatter"));
    let one_axis = method([(0, "a", kept(0.25, 0.5)), (1, "a", kept(0.25, 0.75))]);
    assert!(Mutation::MoreNoise.of(&one_axis, KEY).is_ok());
}

#[test]
fn as_many_are_lost_as_were() {
    let with = |lost: u64, kept_points: u64| {
        let gone = (0..lost).map(|trial| (trial, "a", away([0.0, 1.5])));
        let kept_points = (0..kept_points).map(|trial| (trial, "b", kept(0.01 * trial as f64, 0.02)));
        method(gone.chain(kept_points))
    };
    for (lost, kept_points, more) in [(3, 9, 3), (3, 2, 2), (1, 9, 1)] {
        let old = with(lost, kept_points);
        let found = changed(&old, &Mutation::LostDoubled.of(&old, KEY).unwrap());
        assert_eq!(found.len(), more);
        for (was, is) in found {
            let [dx, dy] = was.coordinates().unwrap();
            assert!(was.is_kept() && matches!(is, Entry::Lost(_)) && near(is.coordinates().unwrap(), [dx + 2.0, dy]), "{is:?}");
        }
    }
    assert_eq!(Mutation::LostDoubled.of(&with(0, 9), KEY), Err("no point is lost"));
    assert_eq!(Mutation::LostDoubled.of(&with(3, 0), KEY), Err("no point is measured"));
}

#[test]
fn a_tenth_is_rejected_and_one_at_least() {
    for (points, tenth) in [(1, 1), (10, 1), (11, 2), (30, 3)] {
        let rest = [(0, "b", NO_CORNER), (0, "c", away([2.0, 0.0]))];
        let old = method((0..points).map(|trial| (trial, "a", kept(0.1, 0.2))).chain(rest));
        let found = changed(&old, &Mutation::TenthRejected.of(&old, KEY).unwrap());
        assert_eq!(found, vec![(kept(0.1, 0.2), NO_CORNER); tenth], "{points}");
    }
    assert_eq!(Mutation::TenthRejected.of(&method([(0, "c", away([2.0, 0.0]))]), KEY), Err("no point is measured"));
}

#[test]
fn which_points_are_taken_is_chosen_at_random() {
    let old = method((0..100).map(|trial| (trial, "a", kept(0.1, 0.2))));
    let of = |trial| Mutation::TenthRejected.of(&old, Key { trial, ..KEY }).unwrap();
    let first: Vec<u64> = of(0).points.iter().filter(|(_, entry)| !entry.is_kept()).map(|(place, _)| place.trial).collect();
    assert_ne!(first, (0..10).collect::<Vec<u64>>());
    assert!(of(0) == of(0) && of(0) != of(1));
}

#[test]
fn the_first_trial_becomes_the_second() {
    let old = method([
        (3, "a", kept(0.1, 0.2)),
        (3, "b", kept(0.3, 0.4)),
        (5, "a", kept(0.5, 0.6)),
        (5, "b", NO_CORNER),
        (7, "a", kept(0.7, 0.0)),
    ]);
    let new = Mutation::CopiedTrial.of(&old, KEY).unwrap().points;
    let mut expected = old.points.clone();
    expected.insert(place(3, "a"), kept(0.5, 0.6));
    expected.insert(place(3, "b"), NO_CORNER);
    assert_eq!(new, expected);
    assert_eq!(Mutation::CopiedTrial.of(&method([(3, "a", kept(0.1, 0.2)), (3, "b", kept(0.1, 0.3))]), KEY), Err("there is one trial"));
}

#[test]
fn the_first_measured_point_is_no_number() {
    let old = method([(0, "a", NO_CORNER), (0, "b", kept(0.3, 0.4)), (1, "b", kept(0.5, 0.6))]);
    let new = Mutation::OneNan.of(&old, KEY).unwrap();
    let [(was, Entry::Lost(found))] = changed(&old, &new)[..] else { panic!("one point") };
    assert!(was == kept(0.3, 0.4) && found.at[0].is_nan() && found.at[1] == 0.4 && found.sigma == Some(0.5));
    assert_eq!(Mutation::OneNan.of(&method([(0, "a", NO_CORNER)]), KEY), Err("no point is measured"));
}

#[test]
fn coordinates_are_exchanged_and_nothing_else() {
    let mut old = method([(0, "a", kept(0.1, 0.2)), (0, "b", away([0.0, 2.0])), (0, "c", NO_CORNER)]);
    old.settings = "k=1".into();
    let new = Mutation::Swapped.of(&old, KEY).unwrap();
    let expected = method([(0, "a", kept(0.2, 0.1)), (0, "b", away([2.0, 0.0])), (0, "c", NO_CORNER)]);
    assert_eq!(new, MethodTable { points: expected.points, ..old.clone() });
    assert_eq!(Mutation::Swapped.of(&method([(0, "a", kept(0.1, 0.1))]), KEY), Err("the results stay the same"));
}
