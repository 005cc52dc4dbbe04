//! A check adds up what it compared and decides all tests together.

use super::{at, holding, measured, method, point, table};
use crate::judge::{Family, Test};
use crate::{
    ALPHA, Ceilings, Cells, Check, Coordinates, FigureSums, Finding, MethodTable, Numbers, PointSums, Table, Tally, Verdict, Verdicts,
    compare, decide,
};
use calibench_records::figures::Quantity;

fn verdicts(words: &[&str]) -> Verdicts {
    let cell = |(row, word): (usize, &&str)| (["p/table-1".to_owned(), row.to_string(), "x".to_owned()], (*word).to_owned());
    Verdicts(words.iter().enumerate().map(cell).collect())
}

/// Methods `m` and `n` with `points` points each.
fn two(points: u64, dx: f64) -> Table {
    let of = |dx: f64| method((0..points).map(|trial| (trial, "a", measured([dx, 0.0], None))));
    let mut table = holding(Coordinates::Errors, of(0.1));
    *table.method_mut(&"n".into(), &"1".into()) = of(dx);
    table
}

fn figures(count: usize) -> MethodTable {
    let mut method = MethodTable::new("1".into());
    for index in 0..count {
        let numbers = Numbers { value: 1.0, sigma: None, error: None };
        method.figures.insert((0, Quantity::Omega.of(&[&index.to_string()])), [(0, numbers)].into());
    }
    method
}

#[test]
fn what_is_compared_is_added_up() {
    let mut check = Check::new();
    assert_eq!(check.tally(), Tally::default());
    check.compare(&two(3, 0.1), &two(3, 0.2), true);
    check.compare(&two(2, 0.1), &two(2, 0.1), true);
    check.compare(&two(1, 0.1), &two(1, 0.3), true);
    let mut expected = Tally { scenarios: 3, methods: 6, changed: 2, points: 12, ..Tally::default() };
    assert_eq!(check.tally(), expected);
    // Two sweeps of three cells and of two, each with two methods of two points.
    for labels in [&["x", "y", "z"][..], &["x", "y"]] {
        let mut cells: Cells<PointSums> = Cells::new("f/w", "", 7, Coordinates::Errors);
        labels.iter().for_each(|label| cells.add(label, &two(2, 0.1)));
        check.compare_cells(&cells, &cells);
    }
    (expected.scenarios, expected.methods, expected.points) = (3 + 5, 6 + 10, 12 + 20);
    assert_eq!(check.tally(), expected);
    for count in [3, 4] {
        let mut cells: Cells<FigureSums> = Cells::new("f/c", "", 7, Coordinates::Errors);
        cells.add("", &holding(Coordinates::Errors, figures(count)));
        check.compare_cells(&cells, &cells);
    }
    for words in [&["reproduces"; 3][..], &["differs"; 2]] {
        check.verdicts(&verdicts(words), &verdicts(words));
    }
    (expected.figures, expected.cells) = (7, 5);
    assert_eq!(check.tally(), expected);
    let text = "[[ceiling]]\nscenario = \"f/s\"\nmethod = \"m\"\nmetric = \"rmse_xy\"\nat_most = 1.0\nwhy = \"so\"\n";
    for copies in [2, 3] {
        check.ceilings(&Ceilings::parse("c", &text.repeat(copies)).unwrap(), &[&two(1, 0.1)]);
    }
    expected.ceilings = 5;
    assert_eq!(check.tally(), expected);
    let found = check.conclude();
    assert_eq!(found.iter().map(|f| (f.method.as_str(), f.metric)).collect::<Vec<_>>(), [("n", "dx"); 4], "3 points and 1: {found:?}");
}

#[test]
fn whatever_is_noted_is_concluded_in_order() {
    let note = |verdict, scenario: &str| Finding::new(verdict, scenario, "m", "x", "so");
    let mut check = Check::new();
    check.note(note(Verdict::Informs, "a"));
    check.note(note(Verdict::Fails, "c"));
    check.note(note(Verdict::Unblessed, "a"));
    check.note(note(Verdict::Fails, "b"));
    check.verdicts(&verdicts(&["reproduces"]), &verdicts(&["differs"]));
    check.ceilings(
        &Ceilings::parse("c", "[[ceiling]]\nscenario = \"z\"\nmethod = \"m\"\nmetric = \"rmse_xy\"\nat_most = 1.0\nwhy = \"so\"\n")
            .unwrap(),
        &[],
    );
    check.unblessed(&table(Coordinates::Errors, &[super::info("m", "1")], &[vec![point(0, "a", [0.1; 2])]]));
    let found: Vec<_> = check.conclude().into_iter().map(|f| (f.verdict, f.scenario)).collect();
    let expected = [(Verdict::Fails, "b"), (Verdict::Fails, "c"), (Verdict::Fails, "p/table-1"), (Verdict::Fails, "z")];
    let rest = [(Verdict::Unblessed, "a"), (Verdict::Unblessed, "f/s"), (Verdict::Informs, "a")];
    assert_eq!(found, expected.into_iter().chain(rest).map(|(verdict, name)| (verdict, name.to_owned())).collect::<Vec<_>>());
}

fn test(family: Family, method: &str, worse: f64, better: f64) -> Test {
    Test { family, finding: Finding::new(Verdict::Changed, "f/s", method, "x", "better, not blessed"), worse, better }
}

#[test]
fn a_family_has_a_quarter_of_the_error_rate() {
    let of = |worse: f64, better: f64| {
        let found = decide(vec![&test(Family::Means, "m", worse, better)]);
        found.first().map(|f| (f.verdict, f.p.unwrap(), f.message.clone()))
    };
    let share = ALPHA / 4.0;
    let (worse, better) = ("worse".to_owned(), "better, not blessed".to_owned());
    assert_eq!(of(share, 1.0), Some((Verdict::Fails, share, worse.clone())), "at most its share");
    assert_eq!(of(0.5 * share, share), Some((Verdict::Fails, 0.5 * share, worse)));
    assert_eq!(of(1.0, share), Some((Verdict::Changed, share, better.clone())));
    assert_eq!(of(1.0, 0.5 * share), Some((Verdict::Changed, 0.5 * share, better)));
    assert_eq!(of(1.000_001 * share, 1.000_001 * share), None);
    assert_eq!(of(1.0, 1.0), None);
}

#[test]
fn the_tests_of_a_family_share_its_part() {
    let half = ALPHA / 8.0;
    let failing = |families: [Family; 2], p: f64| {
        let tests = families.into_iter().zip(["m", "n"]).map(|(family, method)| test(family, method, p, 1.0)).collect();
        Check { tests, ..Check::default() }.conclude().iter().filter(|finding| finding.fails()).count()
    };
    assert_eq!(failing([Family::Means; 2], half), 2);
    assert_eq!(failing([Family::Means; 2], 1.01 * half), 0);
    assert_eq!(failing([Family::Means, Family::Spread], 1.01 * half), 2, "each has its own part");
    assert_eq!(failing([Family::Counts, Family::Sigmas], 1.99 * half), 2);
}

#[test]
fn tests_are_kept_until_all_is_decided() {
    let mut check = Check::new();
    let run = |trials, dx| holding(Coordinates::Errors, method((0..trials).map(|trial| (trial, "a", measured([dx, 0.0], None)))));
    // Lost, rejected, two means of the target and of all, root mean square, scatter: each time eight.
    check.compare(&run(10, 0.1), &run(10, 0.2), false);
    check.compare(&run(12, 0.1), &run(12, 0.2), false);
    assert_eq!(check.tests(), 16);
    let failing: Vec<_> = check.conclude().into_iter().filter(Finding::fails).map(|f| (f.metric, f.target)).collect();
    let once = [("mean_dx", None), ("mean_dx", Some("image/a".to_owned())), ("rms_error", None)];
    assert_eq!(failing, once.iter().flat_map(|found| [found.clone(), found.clone()]).collect::<Vec<_>>());
    let alone = compare(&run(10, 0.1), &run(10, 0.2), false);
    assert_eq!(alone.iter().filter(|f| f.fails()).count(), 3, "a comparison is a check of its own: {alone:?}");
}

#[test]
fn tables_count_trials_and_points() {
    let table = two(3, 0.1);
    assert_eq!((table.trials(), table.points()), (3, 6));
    let mut other = table.clone();
    other.method_mut(&"n".into(), &"1".into()).points.insert(at(9, "b"), super::NO_CORNER);
    assert_eq!((other.trials(), other.points(), other.method("n").unwrap().counts()), (4, 7, [3, 0, 1]));
    // One method alone, with its own points or with others.
    let alone = table.only("m", None);
    assert_eq!((alone.methods().count(), alone.method("m"), alone.seed), (1, table.method("m"), 7));
    let replaced = table.only("m", Some(method([(0, "a", super::lost([2.0, 0.0]))])));
    assert_eq!(replaced.method("m").unwrap().counts(), [0, 1, 0]);
    assert_eq!(table.only("o", None).methods().count(), 0);
}
