//! Points one by one: what is missing, what changed, what became of it.

use super::{NO_CORNER, at, holding, info, lost, measured, method, point, rejected, table};
use crate::changed::{Changes, agree, distance};
use crate::few::few;
use crate::missing::completeness;
use crate::pairs::Pairs;
use crate::point_by_point::{exact, worse_status};
use crate::{Coordinates, Entry, Finding, Found, MethodTable, Numbers, Place, Table, Verdict};
use calibench_model::PixelPoint;
use calibench_records::figures::Quantity;
use calibench_records::results::{Outcome, PointResult};

fn kept(dx: f64) -> Entry {
    measured([dx, 0.0], None)
}

fn errors(points: impl IntoIterator<Item = (u64, &'static str, Entry)>) -> Table {
    holding(Coordinates::Errors, method(points))
}

/// Verdict, target and message of each.
fn said(findings: &[Finding]) -> Vec<(Verdict, Option<&str>, &str)> {
    findings.iter().map(|f| (f.verdict, f.target.as_deref(), &*f.message)).collect()
}

#[test]
fn what_is_missing_is_said_once() {
    let all = || (0..4_u64).flat_map(|trial| ["a", "b", "c"].map(|name| (trial, name, kept(0.1))));
    // Trials 1 and 3 are gone; of the rest, target b, and a in trial 2.
    let left = all().filter(|(trial, name, _)| trial.is_multiple_of(2) && *name != "b" && (*trial, *name) != (2, "a"));
    let found = completeness(&errors(all()), &errors(left));
    let expected = [
        (Verdict::Fails, None, "2 of 4 trials are missing, from 1 to 3"),
        (Verdict::Fails, Some("image/b"), "the target is missing: 2 of 12 points"),
        (Verdict::Fails, Some("trial 2 image/a"), "1 of 12 points are missing, the first in trial 2"),
    ];
    assert_eq!(said(&found), expected);
    let figures: Vec<_> = found.iter().map(|f| (f.metric, f.baseline.unwrap(), f.now.unwrap())).collect();
    assert_eq!(figures, [("trials", 4.0, 2.0), ("points", 12.0, 3.0), ("points", 12.0, 3.0)]);
    assert!(completeness(&errors(all()), &errors(all())).is_empty());
}

#[test]
fn a_method_that_has_nothing_is_missing() {
    let base = errors([(0, "a", kept(0.1)), (0, "b", kept(0.1))]);
    let with = |now: MethodTable| completeness(&base, &holding(Coordinates::Errors, now));
    let mut absent = method([(0, "a", kept(0.1))]);
    absent.unavailable = Some("not built".into());
    for (found, message) in [
        (completeness(&base, &table(Coordinates::Errors, &[], &[])), "the method is missing"),
        (with(absent), "the method is unavailable: not built"),
        (with(method([])), "the method has no points"),
    ] {
        assert_eq!(said(&found), [(Verdict::Fails, None, message)]);
        assert_eq!((found[0].baseline, found[0].now), (Some(2.0), Some(0.0)));
    }
}

/// What is adjusted alone has figures, which are compared as such; who has no point in either has lost none.
#[test]
fn a_method_of_figures_alone_is_not_missing() {
    let base = holding(Coordinates::Errors, method([]));
    let mut now = method([]);
    assert!(completeness(&base, &base).is_empty());
    now.figures.insert((0, Quantity::Sigma0.into()), [(0, Numbers { value: 1.0, sigma: None, error: None })].into());
    assert!(completeness(&base, &holding(Coordinates::Errors, now.clone())).is_empty());
    assert_eq!(said(&completeness(&errors([(0, "a", kept(0.1))]), &holding(Coordinates::Errors, now)))[0].2, "the method has no points");
}

#[test]
fn what_is_new_is_not_blessed() {
    let (base, none) = (errors([(0, "a", kept(0.1))]), table(Coordinates::Errors, &[], &[]));
    let more = errors([(0, "a", kept(0.1)), (0, "b", kept(0.1)), (1, "a", kept(0.1))]);
    assert_eq!(said(&completeness(&base, &more)), [(Verdict::Unblessed, None, "not blessed yet: 2 points")]);
    assert_eq!(said(&completeness(&none, &more)), [(Verdict::Unblessed, None, "not blessed yet: 3 points")]);
    let mut absent = info("m", "1");
    absent.unavailable = Some("not built".into());
    let absent = table(Coordinates::Errors, &[absent], &[]);
    assert_eq!(said(&completeness(&none, &absent)), [(Verdict::Unblessed, None, "not blessed yet, and unavailable: not built")]);
}

#[test]
fn versions_and_parameters_are_compared() {
    let with = |version: &str, settings: &str, library: &str| {
        let mut method = method([(0, "a", kept(0.1))]);
        (method.version, method.settings, method.library) = (version.into(), settings.into(), library.into());
        holding(Coordinates::Errors, method)
    };
    let found = |old: [&str; 3], new: [&str; 3]| {
        let found = completeness(&with(old[0], old[1], old[2]), &with(new[0], new[1], new[2]));
        found.into_iter().map(|f| (f.verdict, f.metric)).collect::<Vec<_>>()
    };
    assert_eq!(found(["1", "k=1", "A"], ["1", "k=1", "A"]), []);
    assert_eq!(found(["1", "k=1", "A"], ["2", "k=1", "A"]), [(Verdict::Changed, "version")]);
    assert_eq!(found(["1", "k=1", "A"], ["2", "k=1", "B"]), [(Verdict::Informs, "version")], "the machine's");
    assert_eq!(found(["1", "k=1", "A"], ["1", "k=2", "A"]), [(Verdict::Changed, "parameters")]);
    assert_eq!(found(["1", "", "A"], ["1", "k=2", "A"]), [], "they were not known");
    assert_eq!(found(["1", "k=1", "A"], ["1", "", "A"]), [], "they are not known");
}

#[test]
fn changes_are_sorted_by_what_changed() {
    let with = |sigma: f64| measured([0.1, 0.2], Some(sigma));
    let nan = |sigma| Entry::Lost(Found { at: [f64::NAN, 0.2], sigma });
    let old = method([
        (0, "a", with(0.5)),
        (0, "b", with(0.5)),
        (0, "c", with(0.5)),
        (0, "d", with(0.5)),
        (0, "e", nan(None)),
        (0, "f", nan(None)),
        (0, "g", with(0.5)),
        (0, "h", with(f64::INFINITY)),
    ]);
    let new = method([
        (0, "a", measured([0.1 + 9e-7, 0.2 - 9e-7], Some(0.5 + 9e-7))),
        (0, "b", measured([0.1 + 1.1e-6, 0.2], Some(0.5))),
        (0, "c", measured([0.1, 0.2 - 1.1e-6], Some(0.5 + 1.1e-6))),
        (0, "d", NO_CORNER),
        (0, "e", nan(None)),
        (0, "f", with(0.5)),
        (0, "h", with(f64::INFINITY)),
    ]);
    let changes = Changes::of(&old, &new);
    let names = |pairs: &[(&Place, &Entry, &Entry)]| pairs.iter().map(|pair| pair.0.target.to_string()).collect::<String>();
    assert_eq!((names(&changes.statuses), names(&changes.moved), names(&changes.sigmas)), ("df".into(), "bcf".into(), "cf".into()));
    assert!(!changes.is_empty() && Changes::of(&old, &old).is_empty());
    assert_eq!(changes.farthest(), f64::INFINITY, "a number that was none");
    for one in [[kept(0.1), NO_CORNER], [kept(0.1), kept(0.2)], [with(0.5), with(0.6)]] {
        let [old, new] = one.map(|entry| method([(0, "a", entry)]));
        assert!(!Changes::of(&old, &new).is_empty(), "one change is one");
    }
}

#[test]
fn distances_are_those_of_the_plane() {
    let place = at(0, "a");
    let far = |old: Entry, new: Entry| distance(&(&place, &old, &new));
    assert!((far(measured([0.1, -0.2], None), measured([0.4, 0.2], None)) - 0.5).abs() < 1e-12);
    assert_eq!(far(kept(0.1), NO_CORNER), 0.0);
    assert_eq!(far(kept(0.1), lost([f64::NAN, 0.0])), f64::INFINITY);
    let [old, new] = [[0.0, 0.0], [0.25, 0.5]].map(|[a, b]| method([(0, "a", kept(a)), (0, "b", kept(b))]));
    assert_eq!(Changes::of(&old, &new).farthest(), 0.5);
    assert!(agree(0.0, 1e-6) && agree(1e-6, 0.0) && !agree(0.0, 1.1e-6) && !agree(1.1e-6, 0.0) && agree(f64::NAN, f64::NAN));
    assert!(!agree(f64::NAN, 0.0) && !agree(0.0, f64::NAN));
}

#[test]
fn a_status_is_worse_if_a_point_is_measured_no_more() {
    let place = at(0, "a");
    let nan = lost([f64::NAN, 0.0]);
    let worse = |old: Entry, new: Entry| worse_status(&(&place, &old, &new));
    let away = lost([2.0, 0.0]);
    for (old, new, expected) in [
        (kept(0.1), NO_CORNER, true),
        (kept(0.1), away, true),
        (kept(0.1), nan, true),
        (away, nan, true),
        (NO_CORNER, nan, true),
        (nan, nan, false),
        (nan, kept(0.1), false),
        (away, kept(0.1), false),
        (NO_CORNER, away, false),
        (kept(0.1), kept(0.2), false),
    ] {
        assert_eq!(worse(old, new), expected, "{old:?} {new:?}");
    }
}

/// Verdict, metric and figures of a point that was at `old` and is at `new`.
fn exactly(coordinates: Coordinates, old: Entry, new: Entry) -> Vec<(Verdict, &'static str, Option<f64>, Option<f64>)> {
    let [old, new] = [old, new].map(|entry| holding(coordinates, method([(0, "a", entry), (0, "b", kept(0.3))])));
    let (base, now) = (old.method("m").unwrap(), new.method("m").unwrap());
    let found = exact(&old, "m", [base, now], &Changes::of(base, now));
    found.into_iter().map(|f| (f.verdict, f.metric, f.baseline, f.now)).collect()
}

#[test]
fn each_coordinate_that_moved_is_named() {
    let of = |new: [f64; 2]| exactly(Coordinates::Errors, measured([0.3, 0.4], None), measured(new, None));
    assert_eq!(of([0.3, 0.5]), [(Verdict::Fails, "dy", Some(0.4), Some(0.5))]);
    assert_eq!(of([0.3, 0.2]), [(Verdict::Changed, "dy", Some(0.4), Some(0.2))]);
    assert_eq!(of([0.4, 0.3]), [(Verdict::Changed, "dx", Some(0.3), Some(0.4)), (Verdict::Changed, "dy", Some(0.4), Some(0.3))]);
    let photo = |x: f64| exactly(Coordinates::Positions, kept(5.0), kept(x));
    assert_eq!([photo(4.0), photo(6.0)], [4.0, 6.0].map(|x| vec![(Verdict::Fails, "x", Some(5.0), Some(x))]));
    assert_eq!(exactly(Coordinates::Errors, kept(0.1), NO_CORNER).first(), Some(&(Verdict::Fails, "status", None, None)));
    // A status that changed is counted; as many as before are not.
    let counted = exactly(Coordinates::Errors, NO_CORNER, kept(0.1));
    let expected = [("status", None, None), ("measured", Some(1.0), Some(2.0)), ("rejected", Some(1.0), Some(0.0))];
    assert_eq!(counted.iter().map(|(_, metric, old, new)| (*metric, *old, *new)).collect::<Vec<_>>(), expected);
    assert_eq!(counted.iter().map(|found| found.0).collect::<Vec<_>>(), [Verdict::Changed, Verdict::Informs, Verdict::Informs]);
}

#[test]
fn the_tolerance_divides_better_from_alike_and_alike_from_worse() {
    // The other coordinate moves too, by less than the radius feels.
    let of = |r: f64| {
        let [old, new] = [0.0, r].map(|r| holding(Coordinates::Errors, method([(0, "a", measured([1e-3 * r.signum() + r, 0.0], None))])));
        let (base, now) = (old.method("m").unwrap(), new.method("m").unwrap());
        exact(&old, "m", [base, now], &Changes::of(base, now)).first().map(|f| (f.verdict, f.message.clone()))
    };
    assert_eq!(of(2e-6), Some((Verdict::Fails, "worse".to_owned())));
    assert_eq!(of(5e-7), None, "not moved");
    assert_eq!(of(-2.0e-3 + 5e-7), Some((Verdict::Fails, "worse".to_owned())));
    let turned = |r: f64| exactly(Coordinates::Errors, kept(0.5), measured([0.0, 0.5 + r], None))[0].0;
    assert_eq!(
        [turned(2e-6), turned(0.9e-6), turned(-0.9e-6), turned(-2e-6)],
        [Verdict::Fails, Verdict::Changed, Verdict::Changed, Verdict::Changed]
    );
}

#[test]
fn a_few_trials_are_judged_by_counts_and_root_mean_squares() {
    let of = |old: [Entry; 3], new: [Entry; 3]| {
        let [old, new] =
            [old, new].map(|entries| method((0..).zip(["a", "b", "c"]).zip(entries).map(|((t, name), entry)| (t, name, entry))));
        few("f/s", "m", &Pairs::of(&old, &new, false))
            .into_iter()
            .map(|f| (f.metric, f.baseline.unwrap(), f.now.unwrap()))
            .collect::<Vec<_>>()
    };
    let at = |x: f64, y: f64| measured([x, y], None);
    let base = [at(0.3, 0.4), at(0.0, 0.0), at(0.0, 0.5)];
    // Squares 0.25 and 0.25 of three, then 0.25, 1 and 0.25.
    let [(metric, old, new)] = of(base, [at(0.3, 0.4), at(0.6, 0.8), at(0.0, 0.5)])[..] else { panic!("one finding") };
    assert!(metric == "rms_error" && (old - (0.5_f64 / 3.0).sqrt()).abs() < 1e-12 && (new - 0.5_f64.sqrt()).abs() < 1e-12);
    assert_eq!(of(base, [at(0.3, 0.4), NO_CORNER, at(0.0, 0.0)]), [("measured", 3.0, 2.0)]);
    assert_eq!(of([NO_CORNER; 3], [NO_CORNER, NO_CORNER, at(0.0, 0.0)]), [], "one more");
    let scaled = |by: f64| of(base, base.map(|entry| entry.kept().map(|[x, y]| at(by * x, by * y)).unwrap())).len();
    assert_eq!([scaled(1.0099), scaled(1.0101), scaled(0.5)], [0, 1, 0]);
    let zero = [at(0.0, 0.0); 3];
    assert_eq!([0.9e-6, 1.1e-6].map(|dx| of(zero, [at(dx, 0.0); 3]).len()), [0, 1], "last bits");
}

#[test]
fn points_are_paired_by_trial_and_target() {
    let old = method([(3, "b", kept(0.1)), (3, "c", kept(0.2)), (8, "a", kept(0.3)), (8, "b", kept(0.4)), (9, "b", kept(0.5))]);
    let new = method([(3, "b", kept(0.6)), (3, "c", kept(0.7)), (8, "a", kept(0.8)), (8, "b", kept(0.9)), (7, "b", kept(0.5))]);
    let of = |single| {
        let pairs = Pairs::of(&old, &new, single);
        assert_eq!(pairs.targets, ["image/b", "image/c", "image/a"]);
        let items: Vec<_> = pairs.items.iter().map(|i| (i.trial, i.target, i.old.kept().unwrap()[0], i.new.kept().unwrap()[0])).collect();
        (pairs.trials, items)
    };
    assert_eq!(of(false), (2, vec![(0, 0, 0.1, 0.6), (0, 1, 0.2, 0.7), (1, 2, 0.3, 0.8), (1, 0, 0.4, 0.9)]));
    assert_eq!(of(true), (4, vec![(0, 0, 0.1, 0.6), (1, 1, 0.2, 0.7), (2, 2, 0.3, 0.8), (3, 0, 0.4, 0.9)]));
}

#[test]
fn entries_are_what_the_operator_gave() {
    let of = |error: Option<(f64, f64)>, coordinates| {
        let outcome = Outcome::Measured { position: PixelPoint::new(10.25, 20.0), error };
        let predicted = Some(0.123_456_78);
        Entry::of(&PointResult { predicted, ..PointResult::new("image", "a", 0, outcome) }, coordinates)
    };
    let found = |at| Found { at, sigma: Some(0.123_456_8) };
    assert_eq!(of(Some((0.6, 0.8)), Coordinates::Errors), Entry::Measured(found([0.6, 0.8])), "one pixel is not lost");
    assert_eq!(of(Some((0.6, 0.801)), Coordinates::Errors), Entry::Lost(found([0.6, 0.801])));
    assert_eq!(of(Some((1e-10, -1e-10)), Coordinates::Errors), Entry::Measured(found([0.0, 0.0])), "nine decimals");
    assert!(of(None, Coordinates::Errors).is_nan() && of(Some((f64::NAN, 0.0)), Coordinates::Errors).is_nan());
    assert_eq!(of(Some((5.0, 5.0)), Coordinates::Positions), Entry::Measured(found([10.25, 20.0])));
    let nowhere = Outcome::Measured { position: PixelPoint::new(1.0, f64::NAN), error: None };
    assert!(matches!(Entry::of(&PointResult::new("image", "a", 0, nowhere), Coordinates::Positions), Entry::Lost(found) if found.is_nan()));
    assert_eq!(Entry::of(&rejected(0, "a"), Coordinates::Positions), NO_CORNER);
    assert_eq!(Entry::of(&point(0, "a", [0.1, 0.2]), Coordinates::Errors), measured([0.1, 0.2], None));
}

#[test]
fn entries_say_what_they_are() {
    let nan = lost([0.0, f64::NAN]);
    let of = |entry: Entry| (entry.status(), entry.describe(), entry.is_kept(), entry.is_nan());
    assert_eq!(of(kept(0.1)), ("measured", "measured".into(), true, false));
    assert_eq!(of(lost([2.0, 0.0])), ("lost", "lost".into(), false, false));
    assert_eq!(of(nan), ("lost", "not a number".into(), false, true));
    assert_eq!(of(NO_CORNER), ("rejected", "rejected (no_corner)".into(), false, false));
    assert_eq!((kept(0.1).coordinates(), kept(0.1).kept()), (Some([0.1, 0.0]), Some([0.1, 0.0])));
    assert_eq!((lost([2.0, 0.0]).coordinates(), lost([2.0, 0.0]).kept()), (Some([2.0, 0.0]), None));
    assert_eq!((NO_CORNER.coordinates(), NO_CORNER.found()), (None, None));
    assert!(Found::bare([f64::NAN, 0.0]).is_nan() && Found::bare([0.0, f64::NAN]).is_nan() && !Found::bare([0.0; 2]).is_nan());
    assert_eq!([at(0, "a").to_string(), at(1, "a").to_string()], ["image/a", "trial 1 image/a"]);
    assert_eq!([Coordinates::of(true), Coordinates::of(false)], [Coordinates::Errors, Coordinates::Positions]);
}
