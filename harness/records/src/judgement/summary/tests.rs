//! What the rows of a judgement come to, by hand.

use super::*;

fn by(method: &str, model: &str, row: Row) -> Row {
    row.by(&method.into(), &model.into())
}

/// Corners of an operator in a view: how many, how many all have, of ten.
fn corners(method: &str, view: &str, found: f64, common: f64) -> Row {
    by(method, "", Row::plain(measure::CORNERS, view, found).beside(common).of(10))
}

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "{found} is not {expected}");
}

/// One camera with a figure of every kind.
fn rows() -> Vec<Row> {
    let all = [
        Row::without(measure::SPLIT, "3", "failed", "no halves"),
        Row::without(measure::MAP, "1:1", "failed", "nothing there"),
        Row::plain(measure::PARAMETERS, "", 9.0),
        Row::plain("other", "", 7.0),
        Row::px(measure::RESIDUALS, "v1", 0.125).of(40),
        Row::px(measure::RESIDUALS, "v2", 0.25).of(50),
        Row::px(measure::HOLDOUT, "v1", 0.3).of(4),
        Row::px(measure::HOLDOUT, "v2", 0.6).of(12),
        Row::px(measure::ACROSS, "v1", 3.0).of(7),
        Row::px(measure::STRAIGHT, "v2", 0.05).of(9),
        Row::px(measure::SPLIT, "1", 0.3).beside(0.2),
        Row::px(measure::SPLIT, "2", 0.5).beside(0.4),
        Row::plain(measure::SPLIT_TEST, "1", 1.5).beside(0.01),
        Row::plain(measure::SPLIT_TEST, "2", 3.5).beside(0.04),
        Row::px(measure::MAP, "10.5:-20", 0.5).beside(0.25),
        Row::px(measure::MAP, "nowhere", 0.5).beside(0.25),
        Row::px(measure::UNCERTAINTY, "centre", 0.02),
        Row::px(measure::UNCERTAINTY, "corner", 0.08),
        Row::px(measure::FRAME, "", 0.11).beside(0.13),
        Row::plain(measure::FRAME_MODES, "", 1.75),
        Row::px(measure::BESIDE, "b", 0.7).beside(1.5),
        Row::px(measure::BESIDE, "c", 0.9).beside(2.5),
        Row::px(measure::BESIDE_SEEN, "c", 0.6),
        Row::px(measure::BESIDE_SEEN, "b", 0.4),
        Row::px(measure::PUBLISHED, "", 0.8).beside(0.35),
        Row::px(measure::PUBLISHED_SIGMA, "", 0.15),
        Row::px(measure::PUBLISHED_MOST, "", 1.9),
        Row::px(measure::PUBLISHED_SEEN, "", 0.65),
        Row::px(measure::PUBLISHED_VIEW, "v1", 0.21).of(54),
    ];
    all.into_iter().map(|row| by("m", "a", row)).collect()
}

#[test]
fn every_figure_of_a_camera_comes_from_its_rows() {
    let summary = Summary::new(&rows(), 1);
    let cell = summary.cell("m", "a").unwrap();
    assert_eq!((&*cell.method, &*cell.model, cell.parameters, cell.trouble.as_deref()), ("m", "a", 9, Some("no halves")));
    let views: Vec<_> = cell.views.iter().map(|view| (&*view.name, view.residual, view.p)).collect();
    assert_eq!(views, [("v1", (0.125, 40), 1.0), ("v2", (0.25, 50), 1.0)], "two views are no test");
    assert_eq!(cell.held_out, [("v1".into(), (0.3, 4)), ("v2".into(), (0.6, 12))].into());
    close(cell.holdout.unwrap().value, (4.68_f64 / 16.0).sqrt());
    assert_eq!(cell.carried, [("v1".into(), (3.0, 7))].into());
    assert_eq!(cell.across.unwrap(), Estimate { value: 3.0, interval: (3.0, 3.0) }, "one view drawn again is the same view");
    close(cell.straight.unwrap().value, 0.05);
    assert_eq!(cell.map, [(10.5, -20.0, 0.5, 0.25)]);
    assert_eq!(cell.uncertainty, Some((0.02, 0.08)));
    assert_eq!(cell.predicted, Some(Predicted { formal: 0.11, by_views: Some(0.13), modes: 1.75 }));
    assert_eq!(cell.principal, None);
    let published = Published { beside: Beside { frame: 0.8, most: 1.9, seen: Some(0.65) }, predicted: 0.35, stated: Some(0.15) };
    assert_eq!(cell.published, Some(published));
    assert_eq!(cell.published_views, [("v1".into(), 0.21)].into());
}

#[test]
fn halves_are_averaged_in_squares() {
    let rows = rows();
    let split = Summary::new(&rows, 1).cells[0].split.unwrap();
    close(split.difference, 0.17_f64.sqrt());
    close(split.predicted, 0.1_f64.sqrt());
    close(split.modes, 2.5_f64.sqrt());
    close(split.p, 0.08);
    assert_eq!(split.count, 2);
    close(split.ratio(), 1.7_f64.sqrt());
    let without: Vec<Row> = rows.into_iter().filter(|row| &*row.measure != measure::SPLIT).collect();
    assert_eq!(Summary::new(&without, 1).cells[0].split, None);
}

#[test]
fn splits_of_the_same_photographs_count_by_twice_their_median() {
    for (p, expected) in [(vec![], 1.0), (vec![0.3], 0.6), (vec![0.9], 1.0), (vec![0.1, 0.25], 0.5), (vec![0.4, 0.05, 0.2], 0.4)] {
        close(twice_median(p), expected);
    }
}

#[test]
fn two_models_are_compared_whichever_is_named_first() {
    let mut rows = rows();
    rows.push(by("m", "b", Row::plain(measure::PARAMETERS, "", 12.0)));
    let summary = Summary::new(&rows, 1);
    let expected = Beside { frame: 0.7, most: 1.5, seen: Some(0.4) };
    assert_eq!((summary.beside("m", ["a", "b"]), summary.beside("m", ["b", "a"])), (Some(expected), Some(expected)));
    assert_eq!(summary.beside("m", ["a", "c"]), Some(Beside { frame: 0.9, most: 2.5, seen: Some(0.6) }));
    assert_eq!((summary.beside("m", ["b", "c"]), summary.beside("n", ["a", "b"])), (None, None));
    let unseen: Vec<Row> = rows.into_iter().filter(|row| &*row.measure != measure::BESIDE_SEEN).collect();
    assert_eq!(Summary::new(&unseen, 1).beside("m", ["a", "b"]), Some(Beside { seen: None, ..expected }));
}

#[test]
fn rows_are_told_apart_by_operator_and_by_model() {
    let of = |method: &str, model: &str, value| by(method, model, Row::plain(measure::PARAMETERS, "", value));
    let mut rows = vec![corners("m", "v1", 9.0, 8.0), of("m", "a", 1.0), of("m", "b", 2.0), corners("n", "v1", 9.0, 8.0)];
    rows.extend([of("n", "b", 4.0), by("n", "b", Row::without(measure::SPLIT, "1", "failed", "no halves")), of("o", "a", 3.0)]);
    let summary = Summary::new(&rows, 1);
    let found: Vec<_> = summary.cells.iter().map(|cell| (&*cell.method, &*cell.model, cell.parameters)).collect();
    assert_eq!(found, [("m", "a", 1), ("m", "b", 2), ("n", "b", 4), ("o", "a", 3)]);
    for cell in &summary.cells {
        assert_eq!(summary.cell(&cell.method, &cell.model), Some(cell));
        assert_eq!(cell.trouble.is_some(), &*cell.method == "n");
    }
    assert_eq!(summary.cell("n", "a"), None);
    assert_eq!(summary.models, ["a".into(), "b".into()]);
    assert_eq!(summary.unavailable, None);
}

#[test]
fn corners_are_counted_by_operator_and_shared_ones_by_view() {
    let rejected = |method: &str, why: &str| by(method, "", Row::without(measure::REJECTED, "v1", "rejected", why));
    let missed = |method: &str, why: &str| by(method, "", Row::without(measure::CORNERS, "w", "missed", why));
    let rows = [
        corners("m", "v1", 8.0, 5.0),
        corners("m", "v2", 9.0, 6.0),
        missed("m", "no board"),
        corners("n", "v1", 7.0, 5.0),
        corners("n", "v3", 6.0, 4.0),
        missed("n", "nothing"),
        by("o", "", Row::without(measure::CORNERS, "", "unavailable", "not built")),
        rejected("m", "border"),
        rejected("n", "flat"),
        rejected("m", "border"),
        rejected("m", "flat"),
        rejected("nobody", "flat"),
    ];
    let summary = Summary::new(&rows, 1);
    let [m, n, o] = &summary.methods[..] else { panic!("three operators: {:?}", summary.methods) };
    assert_eq!((&*m.method, m.found, m.of, &*n.method, n.found, n.of, &*o.method, o.found, o.of), ("m", 17, 20, "n", 13, 20, "o", 0, 0));
    assert_eq!(m.rejected, [("border".into(), 2), ("flat".into(), 1)].into());
    assert_eq!(n.rejected, [("flat".into(), 1)].into());
    assert_eq!([&m.unavailable, &n.unavailable, &o.unavailable].map(Option::as_deref), [None, None, Some("not built")]);
    assert_eq!(summary.views, ["v1".into(), "v2".into(), "v3".into()]);
    assert_eq!(summary.missed, [("w".into(), "no board".into())].into());
    assert_eq!(summary.common, 15);
    let nothing = Summary::new(&[Row::without(measure::PUBLISHED, "", "unavailable", "one photograph")], 1);
    assert_eq!(nothing.unavailable.as_deref(), Some("one photograph"));
}

/// As many of the photographs that are drawn again have less than the lower end as have more than the upper one: one in forty.
#[test]
fn an_interval_over_views_leaves_as_much_out_below_as_above() {
    let views: BTreeMap<Arc<str>, (f64, usize)> =
        (1..=9).map(|k| (format!("v{k}").into(), (0.1 * f64::from(k).sqrt(), 10 + k as usize))).collect();
    let Estimate { value, interval: (low, high) } = pooled(&views, 5).unwrap();
    let squares: Vec<(f64, f64)> = (1..=9).map(|k| (0.01 * f64::from(k), f64::from(k + 10))).collect();
    let rms = |of: &[(f64, f64)]| {
        let corners: f64 = of.iter().map(|view| view.1).sum();
        of.iter().map(|(square, count)| square * count / corners).sum::<f64>().sqrt()
    };
    close(value, rms(&squares));
    let mut rng = stream(Key { seed: 5, of: "interval over views", trial: 0, view: "", target: "" }, Purpose::Split);
    let drawn: Vec<f64> =
        (0..2000).map(|_| rms(&(0..9).map(|_| squares[rng.random_range(0..squares.len())]).collect::<Vec<_>>())).collect();
    let beyond = |outside: &dyn Fn(f64) -> bool| drawn.iter().filter(|value| outside(**value)).count();
    assert_eq!((beyond(&|value| value < low - 1e-12), beyond(&|value| value > high + 1e-12)), (50, 50));
    assert_eq!(pooled(&BTreeMap::new(), 5), None);
}

#[test]
fn outlying_views_are_named_below_one_in_a_hundred_and_the_worst_first() {
    let mut cell = Summary::new(&rows(), 1).cells.remove(0);
    let views = [("a", 0.5, 0.005), ("b", 0.9, 0.01), ("c", 0.7, 0.001), ("d", 0.1, 0.5)];
    cell.views = views.map(|(name, rms, p)| View { name: name.into(), residual: (rms, 54), p }).to_vec();
    assert_eq!(cell.outlying().iter().map(|view| &*view.name).collect::<Vec<_>>(), ["c", "a"]);
}

/// Five views of 54 corners and a camera of 8 parameters: each has 2 * 54 - 6 - 8 / 5 redundant coordinates, so that chance alone makes 0.070569
/// in the logarithm, and the fifth, 0.2 above the others, has t = 2.8341 on 4 degrees of freedom.
#[test]
fn views_are_tested_with_the_parameters_of_their_camera() {
    let of = |view: i32, log: f64| by("m", "a", Row::px(measure::RESIDUALS, &format!("v{view}"), 0.1 * log.exp()).of(54));
    let mut rows: Vec<Row> = (1..5).map(|view| of(view, 0.0)).collect();
    rows.extend([of(5, 0.2), by("m", "a", Row::plain(measure::PARAMETERS, "", 8.0))]);
    let p: Vec<f64> = Summary::new(&rows, 1).cells[0].views.iter().map(|view| view.p).collect();
    let a: f64 = 1.0 + 0.04 * 200.8 / 4.0;
    let t = 0.2 * 200.8_f64.sqrt();
    close(p[4], 5.0 * (0.5 - 0.375 * t / a.sqrt() * (1.0 - t * t / a / 12.0)));
    assert_eq!(p[..4], [1.0; 4]);
}
