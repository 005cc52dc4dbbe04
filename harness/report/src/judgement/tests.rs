//! What a page says of a judgement, from rows whose figures are computed by hand.

use calibench_records::judgement::{ALPHA, Beside, Cell, HONEST, Predicted, Published, Row, Split, Summary, View, measure};

use super::{answer, section, tables, verdict};
use crate::plain;
use crate::tests::small::row;

fn by(method: &str, model: &str, row: Row) -> Row {
    row.by(&method.into(), &model.into())
}

/// One camera: its parameters, its RMS in three views held out and from side to side as logarithms of tenths of a pixel.
fn camera(method: &str, model: &str, parameters: u8, held_out: [f64; 3], across: [f64; 3]) -> Vec<Row> {
    let mut rows = vec![Row::plain(measure::PARAMETERS, "", f64::from(parameters))];
    for (name, logs) in [(measure::HOLDOUT, held_out), (measure::ACROSS, across)] {
        rows.extend(logs.iter().zip(1..).map(|(log, view)| Row::px(name, &format!("v{view}"), 0.1 * log.exp()).of(10)));
    }
    rows.into_iter().map(|row| by(method, model, row)).collect()
}

/// The RMS of three views of as many corners.
fn rms(logs: [f64; 3]) -> f64 {
    (logs.iter().map(|log| 0.01 * (2.0 * log).exp()).sum::<f64>() / 3.0).sqrt()
}

const Q: [f64; 3] = [0.1, 0.3, -0.1];
const R: [f64; 3] = [1.0, 1.3, 0.7];
const N: [f64; 3] = [2.0, 2.1, 1.9];

/// `m` is the best operator, `b` predicts best in all draws but those of the first view alone, where `c` does: one in 27.
fn rows() -> Vec<Row> {
    let corners = |method: &str, found: f64| by(method, "", Row::plain(measure::CORNERS, "v1", found).beside(6.0).of(10));
    let rejected = |method: &str, why: &str| by(method, "", Row::without(measure::REJECTED, "v1", "rejected", why));
    let failed = |method: &str, model: &str, why: &str| by(method, model, Row::without(measure::HOLDOUT, "", "failed", why));
    let mut rows = vec![corners("m", 9.0), by("m", "", Row::without(measure::CORNERS, "w", "missed", "no board"))];
    rows.extend([corners("n", 10.0), corners("q", 10.0), corners("r", 10.0), corners("o", 7.0)]);
    rows.push(by("u", "", Row::without(measure::CORNERS, "", "unavailable", "not built")));
    rows.extend([rejected("m", "border"), rejected("o", "border"), rejected("o", "flat"), rejected("o", "border")]);
    rows.extend(camera("m", "a", 4, [0.7; 3], [1.0, 1.1, 0.9]));
    rows.extend(camera("m", "b", 9, [0.0; 3], Q));
    rows.extend([by("m", "b", Row::px(measure::UNCERTAINTY, "centre", 0.02)), by("m", "b", Row::px(measure::UNCERTAINTY, "corner", 0.08))]);
    for (other, frame, most, seen) in [("c", 0.7, 1.5, 0.4), ("d", 0.9, 1.25, 0.3)] {
        rows.push(by("m", "b", Row::px(measure::BESIDE, other, frame).beside(most)));
        rows.push(by("m", "b", Row::px(measure::BESIDE_SEEN, other, seen)));
    }
    for (place, x, y) in [("all", 10.125, 20.25), ("half 1a", 9.0, 20.0), ("half 1b", 11.0, 24.0)] {
        rows.push(by("m", "b", Row::px(measure::PRINCIPAL[0], place, x).beside(0.5)));
        rows.push(by("m", "b", Row::px(measure::PRINCIPAL[1], place, y).beside(0.25)));
    }
    rows.extend(camera("m", "c", 12, [-0.8, 0.8, 0.8], [0.0; 3]));
    rows.extend(camera("m", "d", 13, [0.9; 3], [0.2, 0.4, 0.0]));
    rows.push(failed("m", "z", "two views are too few"));
    rows.push(failed("n", "y", "no start"));
    rows.extend(camera("n", "b", 9, N, [0.0; 3]));
    rows.push(failed("n", "z", "views are too few"));
    rows.extend(camera("q", "b", 9, Q, [0.0; 3]));
    rows.extend(camera("r", "b", 9, R, [0.0; 3]));
    rows
}

pub(super) fn judged() -> Summary {
    Summary::new(&rows(), 1)
}

fn cell<'a>(summary: &'a mut Summary, method: &str, model: &str) -> &'a mut Cell {
    summary.cells.iter_mut().find(|cell| &*cell.method == method && &*cell.model == model).unwrap()
}

fn views(of: &[(&str, f64, f64)]) -> Vec<View> {
    of.iter().map(|(name, rms, p)| View { name: (*name).into(), residual: (*rms, 40), p: *p }).collect()
}

fn says(summary: &Summary, expected: &str) {
    let text = verdict(summary, &summary.trusted().unwrap());
    assert!(text.contains(expected), "not said: {expected}\n{text}");
}

fn is_silent(summary: &Summary, word: &str) {
    let text = verdict(summary, &summary.trusted().unwrap());
    assert!(!text.contains(word), "said: {word}\n{text}");
}

/// The p-value of three logarithms with mean m and deviation s is 1/2 - t / (2 sqrt(2 + t^2)), t = sqrt(3) m / s: 0.239, 0.0144 and 0.0004; Holm: the
/// least one three times, the next one twice.
#[test]
fn operators_and_models_are_ranked_in_words() {
    let summary = judged();
    says(
        &summary,
        "trust `m` with the model `b`.** It predicts corners of photographs that took no part in the calibration to 0.100 px RMS",
    );
    let [q, r, n] = [Q, R, N].map(|logs| plain(rms(logs)));
    let operators =
        format!("`m` has the least RMS. Not to be told from it: `q` ({q} px). Worse: `r` ({r} px, p = 0.029) and `n` ({n} px, p = 0.001).");
    says(&summary, &operators);
    let trusted = summary.trusted().unwrap();
    let [b, c] = ["b", "c"].map(|model| trusted.models.iter().find(|standing| &*standing.cell.model == model).unwrap());
    assert!((c.share - 1.0 / 27.0).abs() < 0.015 && (b.loss.unwrap() - 0.7 * c.share.sqrt()).abs() < 1e-12, "{b:?}");
    let best = format!("parameters allowed for, by `b` in {:.0} % and `c` in {:.0} %.", 100.0 * b.share, 100.0 * c.share);
    says(
        &summary,
        &format!(
            "{best} The camera with `b` differs from that of the best model of each draw by {} px (RMS over the whole frame and all draws): so large an error is to be \
             expected for not knowing the true model. Not judged: `z` (",
            plain(b.loss.unwrap())
        ),
    );
    says(&summary, "`z` (two views are too few).\n");
    is_silent(&summary, "It is chosen since");
    assert_eq!(answer(&summary), verdict(&summary, &summary.trusted().unwrap()).lines().next().map(|line| line[2..].to_owned()));
}

#[test]
fn operators_that_measured_nothing_are_named() {
    let mut rows = rows();
    rows.push(by("s", "", Row::plain(measure::CORNERS, "v1", 0.0).of(10)));
    rows.extend(["flat", "border", "border"].map(|why| by("s", "", Row::without(measure::REJECTED, "v1", "rejected", why))));
    rows.push(by("t", "", Row::plain(measure::CORNERS, "v1", 0.0).of(10)));
    says(
        &Summary::new(&rows, 1),
        "**Measured nothing**: `u` (unavailable: not built), `s` (2 of 10 points rejected, border) and `t` (none of 10 points).\n",
    );
    rows.retain(|row| !["s", "t", "u"].contains(&&*row.method));
    is_silent(&Summary::new(&rows, 1), "Measured nothing");
}

#[test]
fn chances_are_told_by_three_digits_and_the_level_itself_is_worse() {
    let summary = judged();
    let mut trusted = summary.trusted().unwrap();
    for (other, p) in trusted.operators.iter_mut().zip([ALPHA, 0.001, 0.000_999]) {
        other.1 = p;
    }
    let text = verdict(&summary, &trusted);
    assert!(text.contains("None of the others is as good. Worse: `q` (") && text.contains(" px, p = 0.050), `r` ("), "{text}");
    assert!(text.contains(" px, p = 0.001) and `n` (") && text.contains(" px, p < 0.001)."), "{text}");
    trusted.operators.clear();
    let text = verdict(&summary, &trusted);
    assert!(text.contains("`m` has no other beside it. **Measured nothing**: "), "{text}");
    assert_eq!(text.matches("Worse").count(), 0, "{text}");
}

#[test]
fn a_model_alone_has_no_rivals() {
    let mut summary = judged();
    summary.cells.retain(|cell| &*cell.model == "b");
    says(&summary, "by `b` in 100 %.\n");
    is_silent(&summary, "of each draw");
    is_silent(&summary, "Not judged");
    is_silent(&summary, "Beyond the corners");
}

#[test]
fn a_model_that_is_chosen_for_another_reason_says_so_and_operators_are_not_dropped() {
    let summary = judged();
    let mut trusted = summary.trusted().unwrap();
    trusted.cell = summary.cell("m", "c").unwrap();
    trusted.unjudged = vec![summary.cell("n", "z").unwrap()];
    let text = verdict(&summary, &trusted);
    assert!(text.contains("It is chosen since least is lost with it, or for being simpler and the same within 0.02 px."), "{text}");
    assert!(text.contains(" Not judged with it: `n` (views are too few)."), "{text}");
}

/// One mode: 1.96 standard deviations.
#[test]
fn the_limit_over_the_frame_is_told_and_a_doubt_heads_it() {
    let mut summary = judged();
    is_silent(&summary, "95 of 100 cases");
    says(&summary, "- **In doubt**: its camera has no rays for parts of the frame. Its limits do not hold.\n");
    summary.cells.retain(|cell| &*cell.model == "b");
    cell(&mut summary, "m", "b").predicted = Some(Predicted { formal: 0.5, by_views: Some(0.625), modes: 1.0 });
    says(&summary, "over the whole frame the camera is within 0.980 px RMS of the truth in 95 of 100 cases, after the best rotation");
    says(&summary, "(standard deviation 0.500 px, 0.625 px by leaving photographs out)");
    is_silent(&summary, "In doubt");
    cell(&mut summary, "m", "b").split = Some(Split { difference: 0.5, predicted: 0.2, modes: 1.5, p: 0.001, count: 9 });
    says(&summary, "- **In doubt**: halves of the photographs differ by more than its standard deviations say.");
}

#[test]
fn corners_that_a_method_lost_are_said_to_be_compared_by_none() {
    let mut summary = judged();
    summary.methods.iter_mut().for_each(|method| (method.found, method.of) = (100, 100));
    for (found, common) in [(100, 100), (98, 98)] {
        (summary.methods[0].found, summary.common) = (found, common);
        is_silent(&summary, "Compared on");
    }
    (summary.methods[0].found, summary.common) = (90, 90);
    let lost = format!("Not measured were: `{}` 10;", summary.methods[0].method);
    says(&summary, &format!("**Compared on** 90 of 100 corners, which all of them measured. {lost}"));
    // One that is not compared narrows nothing.
    (summary.methods[0].found, summary.common) = (10, 100);
    is_silent(&summary, "Compared on");
}

#[test]
fn a_camera_that_is_hardly_known_is_in_doubt() {
    let mut summary = judged();
    summary.cells.retain(|cell| &*cell.model == "b");
    cell(&mut summary, "m", "b").predicted = Some(Predicted { formal: 0.5, by_views: Some(0.625), modes: 1.0 });
    summary.limit_px = Some(0.6);
    says(
        &summary,
        "- **In doubt**: its camera is known to 0.625 px over the frame (standard deviation, RMS), beyond the limit of 0.600 px",
    );
    summary.limit_px = Some(0.7);
    is_silent(&summary, "In doubt");
}

#[test]
fn sigmas_are_enlarged_where_halves_contradict_them() {
    let mut summary = judged();
    says(
        &summary,
        "has a standard deviation of 0.0200 px in the centre of the frame and 0.0800 px in its worst corner. There were too few photographs",
    );
    let split = |p| Some(Split { difference: 0.5, predicted: 0.2, modes: 1.5, p, count: 9 });
    for (p, word) in [(HONEST, "p = 0.010"), (0.5, "p = 0.500")] {
        cell(&mut summary, "m", "b").split = split(p);
        let found = format!("2.50 times what the sigmas say over the frame, 1.50 times mode by mode (9 splits, {word})");
        says(
            &summary,
            &format!(" Halves of the photographs differ by {found}: no more than chance allows, so the sigmas may be believed.\n"),
        );
    }
    cell(&mut summary, "m", "b").split = split(0.009);
    says(&summary, "(9 splits, p = 0.009): **the sigmas are too small**. Enlarged by 2.50: 0.0500 px and 0.200 px.\n");
    cell(&mut summary, "m", "b").uncertainty = None;
    is_silent(&summary, "How far");
}

#[test]
fn models_that_are_alike_are_compared_where_no_corner_was() {
    let mut summary = judged();
    let seen = "agree with `b` to 0.400 px RMS or better where corners were measured";
    says(&summary, &format!("{seen}, but over the whole frame only to 0.700 px RMS, and 1.50 px at most (`c`)."));
    for beside in cell(&mut summary, "m", "b").beside.values_mut() {
        beside.seen = None;
    }
    is_silent(&summary, "Beyond the corners");
}

#[test]
fn outlying_photographs_are_named_beside_the_median() {
    let mut summary = judged();
    cell(&mut summary, "m", "b").views =
        views(&[("v1", 0.4, 0.005), ("v2", 0.1, 1.0), ("v3", 0.5, 0.0005), ("v4", 0.2, 1.0), ("v5", 0.3, 0.5)]);
    let named = "`v3` (0.500 px, p < 0.001) and `v1` (0.400 px, p = 0.005) of 5, where the median is 0.300 px.";
    says(&summary, &format!("**Outlying photographs**: {named} Look at them"));
    cell(&mut summary, "m", "b").views.iter_mut().for_each(|view| view.p = 0.01);
    says(&summary, "**Outlying photographs**: none of 5 (alpha 0.01; median RMS 0.300 px).");
}

/// Within twice the standard deviation of 0.2 px, or of that times 2.5.
#[test]
fn a_published_camera_is_compared_with_the_enlarged_sigmas() {
    let mut summary = judged();
    is_silent(&summary, "published calibration");
    let halves = Some(Split { difference: 0.5, predicted: 0.2, modes: 1.5, p: 0.001, count: 9 });
    for (split, frame, told) in
        [(None, 0.4, "within twice"), (None, 0.41, "more than twice"), (halves, 0.95, "within twice"), (halves, 1.5, "more than twice")]
    {
        let of = cell(&mut summary, "m", "b");
        of.split = split;
        of.published = Some(Published { beside: Beside { frame, most: 3.0, seen: Some(0.125) }, predicted: 0.2, stated: None });
        let enlarged = split.map_or("", |_| ", enlarged 0.500 px");
        let sigma = format!("{told} the standard deviation of ours (0.200 px RMS over the frame{enlarged}).");
        let expected = format!("differs by {} px RMS over the frame after the best rotation, 3.00 px at most: {sigma}", plain(frame));
        says(&summary, &format!("{expected} Where corners were measured it differs by 0.125 px RMS.\n"));
    }
    cell(&mut summary, "m", "b").published =
        Some(Published { beside: Beside { frame: 0.3, most: 3.0, seen: None }, predicted: 0.2, stated: None });
    is_silent(&summary, "it differs by");
}

#[test]
fn what_operators_rejected_is_told_with_its_share() {
    let text = tables::about_holdout(&judged());
    for expected in [
        "Operators are compared on the 6 corners that all of them have",
        " `m` rejected 1 of 10 corners (10.0 %: 1 border). `o`",
        " `o` rejected 3 of 10 corners (30.0 %: 2 border and 1 flat). With less than 80 % of the corners it is not compared with the others.",
        " `u` is unavailable: not built.",
        " `w`: no board.",
    ] {
        assert!(text.contains(expected), "not said: {expected}\n{text}");
    }
    assert!(!text.contains("`n` rejected") && !text.contains("`q`"), "nothing was rejected: {text}");
}

#[test]
fn corners_of_which_a_file_says_nothing_are_lacking() {
    let mut summary = judged();
    let m = summary.methods.iter().position(|method| &*method.method == "m").unwrap();
    (summary.methods[m].found, summary.methods[m].of) = (17, 20);
    assert!(tables::about_holdout(&summary).contains(" `m` lacks 3 of 20 corners (15.0 %), among them 1 border rejected."));
    summary.methods[m].rejected.clear();
    assert!(tables::about_holdout(&summary).contains(" `m` lacks 3 of 20 corners (15.0 %). "));
}

/// Residuals 0.3 px of 4 corners and 0.6 px of 12: sqrt((0.36 + 4.32) / 16).
#[test]
fn every_camera_has_a_row_and_every_trouble_a_line() {
    let mut summary = judged();
    let residuals = [("v1", (0.3, 4)), ("v2", (0.6, 12))];
    cell(&mut summary, "m", "b").views = residuals.map(|(name, residual)| View { name: name.into(), residual, p: 1.0 }).to_vec();
    let text = tables::cells(&summary);
    let holdout = cell(&mut summary, "m", "b").holdout.unwrap();
    let across = plain(rms(Q));
    let interval = format!("{} to {}", plain(holdout.interval.0), plain(holdout.interval.1));
    assert_eq!(row(&text, &["`m`", "`b`"]), ["`m`", "`b`", "9", "0.100", &interval, &across, "-", "0.541"]);
    assert_eq!(row(&text, &["`m`", "`z`"]), ["`m`", "`z`", "0", "-", "", "-", "-", "-"]);
    let troubles: Vec<&str> = text.lines().filter(|line| line.starts_with("- ")).collect();
    assert_eq!(
        troubles,
        ["- `y` could not be judged everywhere: no start.", "- `z` could not be judged everywhere: two views are too few."]
    );
}

#[test]
fn halves_have_a_row_a_camera() {
    let mut summary = judged();
    for ((method, model), p) in [("m", "a"), ("m", "b"), ("n", "b")].into_iter().zip([0.000_9, 0.001, 0.25]) {
        cell(&mut summary, method, model).split = Some(Split { difference: 0.5, predicted: 0.2, modes: 1.5, p, count: 9 });
    }
    let text = tables::halves(&summary);
    let figures = ["0.500", "0.200", "2.50", "1.50"];
    assert_eq!(row(&text, &["`m`", "`a`"])[2..], [&figures[..], &["<0.001", "9", "-", "-"]].concat());
    assert_eq!(row(&text, &["`m`", "`b`"])[2..], [&figures[..], &["0.001", "9", "0.0200", "0.0800"]].concat());
    assert_eq!(row(&text, &["`n`", "`b`"])[6], "0.250");
    assert_eq!(text.lines().filter(|line| line.starts_with("| `")).count(), 3, "{text}");
}

#[test]
fn photographs_are_named_by_the_operators_of_the_same_model() {
    let mut summary = judged();
    cell(&mut summary, "m", "b").views = views(&[("v1", 0.5, 0.001), ("v2", 0.25, 1.0), ("v9", 0.125, 0.000_5)]);
    cell(&mut summary, "n", "b").views = views(&[("v1", 0.5, 0.005), ("v2", 0.25, 0.5)]);
    cell(&mut summary, "m", "a").views = views(&[("v1", 0.5, 0.005), ("v2", 0.25, 0.005)]);
    let text = tables::views(&summary, &summary.trusted().unwrap());
    assert_eq!(row(&text, &["`v1`"]), ["`v1`", "40", "0.500", "0.001", "0.100", "2 of 2"]);
    assert_eq!(row(&text, &["`v2`"]), ["`v2`", "40", "0.250", "1.000", "0.100", "0 of 2"]);
    assert_eq!(row(&text, &["`v9`"]), ["`v9`", "40", "0.125", "<0.001", "-", "1 of 2"]);
    assert!(!text.contains("published camera"), "{text}");
    cell(&mut summary, "m", "b").published_views = [("v2".into(), 0.75)].into();
    let text = tables::views(&summary, &summary.trusted().unwrap());
    assert_eq!((row(&text, &["`v1`"])[6].as_str(), row(&text, &["`v2`"])[6].as_str()), ("-", "0.750"));
    assert!(text.contains("with the published camera held"), "{text}");
}

/// Halves 2 apart in x and 4 in y: of one half the root of two less.
#[test]
fn the_principal_point_is_told_for_one_model() {
    let text = tables::principal(&judged(), "b");
    let expected = ["`m`", "10.12", "20.25", "0.500", "0.250", "-", "-", "1.41", "0.500", "2.83", "0.250"];
    assert_eq!(row(&text, &["`m`"]), expected);
    assert_eq!(text.lines().filter(|line| line.starts_with("| `")).count(), 1, "{text}");
    assert!(!tables::principal(&judged(), "a").contains("| `"));
}

#[test]
fn a_section_says_why_nothing_could_be_judged() {
    let unavailable = Summary::new(&[Row::without(measure::CORNERS, "", "unavailable", "one photograph")], 1);
    assert!(section(&unavailable).0.ends_with("**unavailable**: one photograph.\n\n") && answer(&unavailable).is_none());
    let failed = Summary::new(&[by("m", "z", Row::without(measure::SPLIT, "", "failed", "no start"))], 1);
    assert!(section(&failed).0.ends_with("Nothing could be judged: no start.\n\n") && answer(&failed).is_none());
    let (text, pictures) = section(&judged());
    let files: Vec<&str> = pictures.iter().map(|(file, _)| file.as_str()).collect();
    assert!(files.iter().all(|file| text.contains(&format!("]({file})"))) && files.contains(&"holdout.png"), "{files:?}");
}

#[test]
fn a_page_is_green_only_where_halves_say_nothing_against_it() {
    let mut summary = judged();
    cell(&mut summary, "m", "b").predicted = Some(Predicted { formal: 0.5, by_views: None, modes: 1.0 });
    let level = |summary: &Summary, doubts: &[String]| {
        let trusted = summary.trusted().unwrap();
        let html = super::page("T", "# T\n\nText.\n", (summary, Some(&trusted)), (None, doubts), super::Measured::default());
        html.split("class=\"verdict ").nth(1).unwrap().split('"').next().unwrap().to_owned()
    };
    cell(&mut summary, "m", "b").split = None;
    assert_eq!(level(&summary, &[]), "open");
    cell(&mut summary, "m", "b").split = Some(Split { difference: 0.3, predicted: 0.2, modes: 1.5, p: 0.5, count: 9 });
    assert_eq!(level(&summary, &[]), "good");
    assert_eq!(level(&summary, &["a tag is seen twice".to_owned()]), "doubt");
    cell(&mut summary, "m", "b").split = Some(Split { difference: 0.3, predicted: 0.2, modes: 1.5, p: 0.001, count: 9 });
    assert_eq!(level(&summary, &[]), "doubt");
}
