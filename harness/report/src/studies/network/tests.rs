//! Tables of adjustments from three trials, whose figures are computed by hand: t(0.975, 2) = 4.302653.

use calibench_records::adjustments::CalibrationWriter;
use calibench_records::figures::Quantity;
use calibench_records::points::RunInfo;
use calibench_records::results::{Calibrated, Figure, MethodInfo};
use calibench_records::stored::Table;

use super::tables;
use crate::load::adjustments::{Summaries, load};
use crate::published::adjustment::ours;
use crate::published::{Cell, Metric, Trials};
use crate::tests::small::new_table;

fn calibrated(method: usize, c: [f64; 3], rmse_xy: f64, failed: bool) -> Calibrated {
    let [value, sigma, error] = c;
    let iop = Figure { name: Quantity::Parameter.of(&["c"]), value, sigma: Some(sigma), error: Some(error), unit: "mm" };
    let check = |quantity: Quantity, value| Figure::plain(quantity, value, "m");
    let figures = vec![
        iop,
        Figure::plain(Quantity::Sigma0, 10.0 * sigma, "px"),
        check(Quantity::RmseXy, rmse_xy),
        check(Quantity::RmseXySurvey, 2.0 * rmse_xy),
        check(Quantity::Distance, 4.0),
    ];
    let outcome = if failed { Err("no convergence".to_owned()) } else { Ok(figures) };
    Calibrated { method, set: 0, outcome, check_failed: None }
}

/// `pixel` and `good`, three trials, and a fourth in which `good` failed.
fn summaries() -> Summaries {
    summaries_and_trials().0
}

fn summaries_and_trials() -> (Summaries, Trials) {
    let folder = tempfile::tempdir().unwrap();
    let info = |label: &str| MethodInfo { label: label.into(), version: "1".into(), unavailable: None };
    let run = RunInfo { scenario: "s".into(), seed: 1, revision: "r".into(), detector: None };
    let file = new_table(folder.path(), Table::Adjustments);
    let mut writer = CalibrationWriter::new(file, run, vec![info("pixel"), info("good")], vec!["c".into()]).unwrap();
    let pixel = [([16.5, 0.02, 0.002], 0.004), ([16.6, 0.02, 0.001], 0.002), ([16.7, 0.04, -0.002], 0.004), ([16.5, 0.02, 0.0], 0.004)];
    let good = [([16.51, 0.01, 0.001], 0.002), ([16.52, 0.02, -0.002], 0.001), ([16.53, 0.01, 0.003], 0.006), ([0.0; 3], 0.0)];
    for (number, ((c, xy), (own, own_xy))) in pixel.into_iter().zip(good).enumerate() {
        let all = [calibrated(0, c, xy, false), calibrated(1, own, own_xy, number == 3)];
        writer.trial(number as u64, &all).unwrap();
    }
    writer.finish().unwrap().finish().unwrap();
    let found = load(folder.path(), "s").unwrap().unwrap();
    (found, Trials::of_folder(folder.path(), "s", None).unwrap())
}

fn cell(metric: Metric) -> Cell {
    Cell::bare("0.5", metric)
}

fn close(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-6, "{found} is not {expected}");
}

/// Reported: 0.5, 1 and 0.25. True errors: squares 1, 4, 9 against 4, 1, 4, whose ratio and interval are those of `statistics::running`'s test.
#[test]
fn reduction_factors_are_paired_with_the_reference_trial_by_trial() {
    let (found, trials) = summaries_and_trials();
    for metric in [Metric::SigmaRatio, Metric::MeanSigmaRatio] {
        let figure = ours(&found, &trials, &cell(metric), "good", 5.0).unwrap();
        close(figure.one, 0.5);
        close(figure.mean, 1.75 / 3.0);
        let range = figure.range.unwrap();
        close(range.low, 0.25);
        close(range.high, 1.0);
        // Deviations -1/12, 5/12, -1/3: the variance of one run is 42/144 / 2.
        close(figure.half.unwrap(), 4.302_652_73 * (42.0_f64 / 288.0 / 3.0).sqrt());
        let (ratio, half) = figure.truth.unwrap();
        close(ratio, (14.0_f64 / 9.0).sqrt());
        close(half.unwrap(), 1.502_319_6);
    }
}

#[test]
fn sigmas_are_told_in_their_unit_and_beside_true_errors() {
    let (found, trials) = summaries_and_trials();
    let sigma = ours(&found, &trials, &cell(Metric::IopSigma), "good", 5.0).unwrap();
    close(sigma.mean, 0.04 / 3.0);
    close(sigma.truth.unwrap().0, (14e-6_f64 / 3.0).sqrt());
    // Half of the interval of the mean square, over twice the root: 4.302653 * sqrt(49 / 3) / sqrt(3) * 1e-6 / 2 / rms.
    close(sigma.truth.unwrap().1.unwrap(), 4.302_652_73 * 7.0 / 3.0 * 1e-6 / 2.0 / (14e-6_f64 / 3.0).sqrt());
    let pixels = ours(&found, &trials, &cell(Metric::IopSigmaPx), "good", 5.0).unwrap();
    close(pixels.mean, 0.04 / 3.0 * 200.0);
    close(pixels.half.unwrap(), sigma.half.unwrap() * 200.0);
    let value = ours(&found, &trials, &cell(Metric::IopValue), "good", 5.0).unwrap();
    close(value.one, 16.51);
    close(value.mean, 16.52);
    close(value.range.unwrap().high, 16.53);
}

#[test]
fn errors_of_check_points_are_told_over_the_mean_distance() {
    let (found, trials) = summaries_and_trials();
    let relative = ours(&found, &trials, &cell(Metric::RelativeXy), "good", 5.0).unwrap();
    close(relative.one, 0.001);
    close(relative.mean, 0.006 / 4.0);
    let ratio = ours(&found, &trials, &cell(Metric::RelativeXyRatio), "good", 5.0).unwrap();
    close(ratio.mean, 2.5 / 3.0);
    // Against the truth: the ratio of root mean squares.
    close(ratio.truth.unwrap().0, (41.0_f64 / 36.0).sqrt());
    assert_eq!(ours(&found, &trials, &cell(Metric::RelativeZ), "good", 5.0), None, "there is no such figure");
}

#[test]
fn the_table_of_methods() {
    let text = tables::methods(&summaries());
    let row = text.lines().find(|line| line.starts_with("| `good`")).unwrap();
    let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
    // sigma0, frame, error / sigma: sqrt(14e-6 / 3) / 0.04 * 3, factors, RMSE_XY, RMSE_Z, their factors, failures.
    assert_eq!(cells[1], "0.133 ± 0.143");
    assert_eq!(cells[3..6], ["0.16 ± 0.17", "0.583 ± 0.949", "1.247 ± 1.502"]);
    assert!(cells[6].starts_with("0.003000 ± 0.0065") && cells[8].starts_with("1.07 ± "), "{cells:?}");
    assert_eq!(*cells.last().unwrap(), "1");
    insta::assert_snapshot!(text);
}

#[test]
fn the_table_of_sets() {
    insta::assert_snapshot!(tables::sets(&summaries()));
}

/// Of `pixel`: sigmas 0.02, 0.02, 0.04, 0.02; squared errors 4, 1, 4, 0 of (0.001 mm)^2, whose deviation is 2.0616: t(0.975, 3) = 3.182446.
#[test]
fn a_cell_of_a_sweep_has_sigmas_true_errors_and_check_points() {
    let found = summaries();
    let text = super::sweep_orientation::table("depth", &[("7".to_owned(), &found)]);
    let row = text.lines().find(|line| line.starts_with("| 7 ")).unwrap();
    let cells: Vec<&str> = row.split('|').map(str::trim).collect();
    let half = 0.5 * 3.182_446 * 2.061_553 / 2.0 / 1.5;
    assert_eq!(cells, ["", "7", "25.0", &format!("1.5 ± {half:.1}"), "", "0.0035 ± 0.0016", "", "0", ""]);
    assert!(text.contains("set `c`") && text.contains("| `depth` | sigma of c | true error of c |"), "{text}");
}

/// Three images left out in the first of two trials, none in the second.
#[test]
fn images_that_were_left_out_are_said() {
    let folder = tempfile::tempdir().unwrap();
    let info = |label: &str| MethodInfo { label: label.into(), version: "1".into(), unavailable: None };
    let run = RunInfo { scenario: "s".into(), seed: 1, revision: "r".into(), detector: None };
    let file = new_table(folder.path(), Table::Adjustments);
    let mut writer = CalibrationWriter::new(file, run, vec![info("all"), info("some")], vec!["c".into()]).unwrap();
    for number in 0..2 {
        let mut some = calibrated(1, [16.5, 0.01, 0.001], 0.002, false);
        if number == 0 {
            some.outcome.as_mut().unwrap().push(Figure::plain(Quantity::ImagesLeftOut, 3.0, ""));
        }
        writer.trial(number, &[calibrated(0, [16.5, 0.01, 0.001], 0.002, false), some]).unwrap();
    }
    writer.finish().unwrap().finish().unwrap();
    let found = load(folder.path(), "s").unwrap().unwrap();
    assert_eq!((found.left_out("all"), found.left_out("some")), (0.0, 1.5));
    let page = tables::methods(&found);
    assert!(page.contains("- `some`: 1.5 images a trial were left out") && !page.contains("- `all`"), "{page}");
    assert!(!tables::methods(&summaries()).contains("left out"));
    let swept = super::sweep_orientation::table("tilt", &[("10".into(), &summaries()), ("75".into(), &found)]);
    assert!(!swept.contains("left out"), "of the first method alone: {swept}");
}
