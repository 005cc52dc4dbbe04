//! Sweeps, cell by cell: a digest sees every change, the sums judge it.

use super::{info, point, rejected};
use crate::{Cells, Coordinates, Finding, ImageSums, PointSums, Table, Verdict};
use calibench_records::figures::Quantity;
use calibench_records::results::{Calibrated, Figure, PointResult, Trial};

/// Twelve trials of three targets, with errors that look random within 0.1 px.
fn table(change: impl Fn(u64, usize, [f64; 2]) -> Option<[f64; 2]>) -> Table {
    let mut table = Table::new("f/s", 7, Coordinates::Errors, &[info("m", "1")]);
    for number in 0..12 {
        let made = |target: usize| {
            let wave = |k: f64| 0.1 * (k + 1.7 * number as f64 + 2.9 * target as f64).sin();
            let name = ["a", "b", "c"][target];
            change(number, target, [wave(0.0), wave(1.0)])
                .map_or_else(|| rejected(0, name), |error| PointResult { predicted: Some(0.1), ..point(0, name, error) })
        };
        table.add(&Trial { number, points: (0..3).map(made).collect(), ..Trial::default() });
    }
    table
}

fn cells(tables: &[(&str, Table)]) -> Cells<PointSums> {
    let mut cells = Cells::new("f/s", "text", 7, Coordinates::Errors);
    tables.iter().for_each(|(label, table)| cells.add(label, table));
    cells
}

fn found(change: impl Fn(u64, usize, [f64; 2]) -> Option<[f64; 2]>) -> Vec<Finding> {
    cells(&[("k=1", table(|_, _, e| Some(e)))]).compare(&cells(&[("k=1", table(change))]))
}

fn verdict(findings: &[Finding]) -> Option<Verdict> {
    findings.iter().map(|finding| finding.verdict).min()
}

#[test]
fn the_same_points_have_nothing_to_say() {
    assert!(found(|_, _, e| Some(e)).is_empty());
    // A coordinate that last bits push over the border of two rounded values: another digest, the same sums.
    let border = |last: f64| {
        move |trial: u64, target: usize, e: [f64; 2]| Some(if (trial, target) == (3, 1) { [0.012_345_5 + last, e[1]] } else { e })
    };
    let (low, high) = (cells(&[("", table(border(-1e-9)))]), cells(&[("", table(border(1e-9)))]));
    assert_ne!(low, high, "the digests differ");
    assert!(low.compare(&high).is_empty());
}

#[test]
fn every_change_is_seen_and_only_the_worse_fails() {
    let copied = found(|trial, target, e| Some(if trial == 4 { [0.1 * (2.9 * target as f64).sin(), e[1]] } else { e }));
    assert_eq!(verdict(&copied), Some(Verdict::Changed), "{copied:?}");
    let grown = |factor: f64| found(move |_, _, [x, y]| Some([factor * x, factor * y]));
    assert_eq!(verdict(&grown(1.01)), Some(Verdict::Changed));
    assert_eq!(verdict(&grown(0.9)), Some(Verdict::Changed));
    assert!(grown(1.03).iter().any(|f| f.fails() && f.metric == "rms_error" && f.scenario == "f/s@k=1"));
    // 0.7 px of bias hide 50 % more scatter from the root mean square.
    let biased = |factor: f64| table(move |_, _, [x, y]| Some([0.7 + factor * x, factor * y]));
    let hidden = cells(&[("", biased(0.1))]).compare(&cells(&[("", biased(0.15))]));
    assert!(
        hidden.iter().any(|f| f.fails() && f.metric == "scatter") && !hidden.iter().any(|f| f.fails() && f.metric == "rms_error"),
        "{hidden:?}"
    );
    let one_target = found(|_, target, [x, y]| Some(if target == 2 { [1.6 * x, 1.6 * y] } else { [0.8 * x, 0.8 * y] }));
    assert!(one_target.iter().any(|f| f.fails() && f.target.as_deref() == Some("c")), "{one_target:?}");
}

#[test]
fn points_that_fail_are_named_by_target_and_counted() {
    let one = found(|trial, target, e| ((trial, target) != (3, 1)).then_some(e));
    assert_eq!(verdict(&one), Some(Verdict::Changed), "one of 36 may be: {one:?}");
    assert!(one.iter().any(|f| f.metric == "rejected" && f.target.as_deref() == Some("b")), "{one:?}");
    let two = found(|trial, target, e| (trial > 1 || target != 1).then_some(e));
    assert!(two.iter().any(|f| f.fails() && f.metric == "rejected"), "{two:?}");
    let all = found(|_, _, _| None);
    assert!(all.iter().any(|f| f.fails() && f.metric == "tests"), "{all:?}");
    let nan = found(|trial, target, e| Some(if (trial, target) == (3, 1) { [f64::NAN, 0.0] } else { e }));
    assert!(nan.iter().any(|f| f.fails() && f.metric == "nan" && f.target.as_deref() == Some("b")), "{nan:?}");
}

#[test]
fn cells_and_methods_are_complete() {
    let base = cells(&[("k=1", table(|_, _, e| Some(e))), ("k=2", table(|_, _, e| Some(e)))]);
    let without = base.compare(&cells(&[("k=1", table(|_, _, e| Some(e))), ("k=3", table(|_, _, e| Some(e)))]));
    assert!(without.iter().any(|f| f.fails() && f.scenario == "f/s@k=2" && f.message == "the cell is missing"), "{without:?}");
    assert!(without.iter().any(|f| f.verdict == Verdict::Unblessed && f.scenario == "f/s@k=3"), "{without:?}");
    let empty = Table::new("f/s", 7, Coordinates::Errors, &[]);
    let none = base.compare(&cells(&[("k=1", empty), ("k=2", table(|_, _, e| Some(e)))]));
    assert!(none.iter().any(|f| f.fails() && f.method == "m" && f.message == "the method is missing"), "{none:?}");
}

#[test]
fn sums_are_read_as_they_were_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.csv");
    let all = cells(&[("k=1", table(|_, _, e| Some(e))), ("k=2", table(|trial, _, e| (trial > 2).then_some(e)))]);
    let sum = all.write(&path).unwrap();
    let (again, checksum) = Cells::<PointSums>::read(&path, "f/s").unwrap().unwrap();
    assert_eq!((checksum, again.counts()), (sum, [2, 72]));
    assert!(again.compare(&all).is_empty() && all.compare(&again).is_empty(), "{:?}", again.compare(&all));
    let bytes = std::fs::read(&path).unwrap();
    again.write(&path).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), bytes);
    let text = String::from_utf8(bytes).unwrap();
    let cut: Vec<&str> = text.lines().collect();
    std::fs::write(&path, cut[..cut.len() - 1].join("\n")).unwrap();
    assert!(Cells::<PointSums>::read(&path, "f/s").err().unwrap().to_string().contains("rows were cut or added"));
}

#[test]
fn reported_standard_deviations_of_cells_are_judged() {
    let with = |sigma: f64| {
        let mut table = table(|_, _, e| Some(e));
        for entry in table.method_mut(&"m".into(), &"1".into()).points.values_mut() {
            if let crate::Entry::Measured(found) = entry {
                found.sigma = Some(sigma);
            }
        }
        cells(&[("", table)])
    };
    // The root mean square error is 0.1 px: 2D, of two waves of amplitude 0.1.
    assert_eq!(verdict(&with(0.1).compare(&with(0.101))), Some(Verdict::Changed));
    assert_eq!(verdict(&with(0.1).compare(&with(0.05))), Some(Verdict::Fails));
    assert_eq!(verdict(&with(0.05).compare(&with(0.1))), Some(Verdict::Changed));
}

/// Another version of a library informs, and one that nobody knows excuses nothing, in a cell as elsewhere.
#[test]
fn only_another_version_of_a_library_excuses_a_change() {
    for (blessed, now, expected) in [
        ("OpenCV 4.10", "OpenCV 4.12", Verdict::Informs),
        ("OpenCV 4.10", "OpenCV 4.10", Verdict::Changed),
        ("OpenCV 4.10", "", Verdict::Changed),
        ("", "OpenCV 4.10", Verdict::Changed),
    ] {
        let of = |library: &str, version: &str, factor: f64| {
            let mut table = table(move |_, _, [x, y]| Some([factor * x, factor * y]));
            table.describe("m", String::new(), library.to_owned());
            table.method_mut(&"m".into(), &"1".into()).version = version.into();
            table
        };
        let (old, new) = (of(blessed, "1", 1.0), of(now, "1", 0.99));
        assert_eq!(verdict(&cells(&[("k=1", old.clone())]).compare(&cells(&[("k=1", new)]))), Some(expected), "{blessed} {now}");
        // The version by itself, in a sweep and in a scenario without one.
        let other = of(now, "2", 1.0);
        assert_eq!(verdict(&cells(&[("k=1", old.clone())]).compare(&cells(&[("k=1", other.clone())]))), Some(expected), "{blessed} {now}");
        assert_eq!(verdict(&crate::compare(&old, &other, false)), Some(expected), "{blessed} {now}");
    }
}

/// The image points behind adjustments are no points of the method, and are compared all the same.
#[test]
fn image_points_of_adjustments_are_compared() {
    let of = |off: f64| {
        let mut table = Table::new("f/s", 7, Coordinates::Errors, &[info("m", "1")]);
        let figures = vec![Figure::plain(Quantity::OverFrame, 0.25, "px")];
        let calibrations = vec![Calibrated { method: 0, set: 0, outcome: Ok(figures), check_failed: None }];
        let points = vec![point(0, "a", [0.1, 0.2]), point(0, "b", [0.3 + off, 0.0])];
        table.add(&Trial { points, calibrations, ..Trial::default() });
        let mut cells = Cells::<ImageSums>::new("f/s", "", 7, Coordinates::Errors);
        cells.add("", &table);
        cells
    };
    assert_eq!((of(0.0).counts(), of(0.0).compare(&of(0.0)).len()), ([1, 2], 0));
    assert_eq!(verdict(&of(0.0).compare(&of(-0.01))), Some(Verdict::Changed));
    assert_eq!(verdict(&of(0.0).compare(&of(0.2))), Some(Verdict::Fails));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.images.csv");
    of(0.0).write(&path).unwrap();
    let (again, _) = Cells::<ImageSums>::read(&path, "f/s").unwrap().unwrap();
    assert!(again.compare(&of(0.0)).is_empty() && !again.compare(&of(2e-6)).is_empty());
    assert!(Cells::<PointSums>::read(&path, "f/s").is_err(), "of another kind");
}
