//! Which operator and model come out best, and what is said when nothing can.

use calibench_model::NamedCamera;
use calibench_model::named_camera::ParameterCovariance;
use calibench_records::judgement::{measure, write_rows};
use calibench_records::points::RunInfo;

use super::*;
use crate::calibrated::calibrate;
use crate::{JudgementError, stated_sigma};

const POOR: &str = "opencv4:fx,fy,cx,cy";

#[test]
fn a_model_that_is_too_poor_and_an_operator_that_is_noisier_are_worse() {
    let material = material("ranking", 0, 12, &[0.05, 0.1, 0.05]);
    let (_, summary) = judged(&material, &options(&[POOR, "opencv4", "opencv5"], 6));
    let trusted = summary.trusted().unwrap();
    // k3 is zero: the model without it predicts as well and has fewer parameters.
    assert_eq!(&*trusted.cell.model, "opencv4");
    assert_ne!(&*trusted.cell.method, "operator-2");
    let p = |others: &[(&calibench_records::judgement::Cell, f64)], name: &str| {
        others.iter().find(|(cell, _)| &*cell.model == name || &*cell.method == name).map(|(_, p)| *p).unwrap()
    };
    let standing = |name: &str| trusted.models.iter().find(|standing| &*standing.cell.model == name).unwrap();
    assert_eq!(standing(POOR).share, 0.0);
    assert!(standing(POOR).loss.unwrap() > 10.0 * standing("opencv4").loss.unwrap().max(0.01));
    assert!(p(&trusted.operators, "operator-2") < 1e-3);
    let cell = |model: &str| summary.cell("operator-1", model).unwrap();
    for (poor, right) in [
        (cell(POOR).holdout, cell("opencv4").holdout),
        (cell(POOR).across, cell("opencv4").across),
        (cell(POOR).straight, cell("opencv4").straight),
    ] {
        assert!(poor.unwrap().value > 3.0 * right.unwrap().value);
    }
    // Halves of a model that is too poor disagree by more than its residuals explain.
    assert!(cell(POOR).split.unwrap().p < 0.01 && cell(POOR).split.unwrap().modes > 1.5);
    // The hold-out error is the noise of the predicted corner and that of the pose: a little more than sqrt(2) sigma.
    let holdout = cell("opencv4").holdout.unwrap().value;
    assert!(holdout > 0.05 * 2.0_f64.sqrt() && holdout < 0.05 * 2.0_f64.sqrt() * 1.3, "{holdout}");
}

#[test]
fn exact_corners_are_predicted_exactly_and_lie_on_straight_lines() {
    let (rows, summary) = judged(&material("exact", 0, 8, &[0.0]), &options(&["opencv5", "opencv4"], 2));
    for cell in &summary.cells {
        for figure in [cell.holdout, cell.across, cell.straight] {
            assert!(figure.unwrap().value < 1e-6, "{cell:?}");
        }
    }
    assert!(rows.iter().filter_map(|row| row.value).all(f64::is_finite));
}

#[test]
fn the_true_camera_is_within_the_uncertainty() {
    let published = Some(camera());
    let (mut squares, mut predicted) = (0.0, 0.0);
    for trial in 0..40 {
        let options = Options { published, ..options(&["opencv4"], 1) };
        let (_, summary) = judged(&material("published", trial, 8, &[0.1]), &options);
        let found = summary.cells[0].published.unwrap();
        let (rms, sigma, most) = (found.beside.frame, found.predicted, found.beside.most);
        assert!(most >= rms);
        squares += rms * rms;
        predicted += sigma * sigma;
        // Six parameters of each pose are taken off: less than sqrt(2) sigma.
        assert!(summary.cells[0].published_views.values().all(|rms| *rms > 0.08 && *rms < 0.2));
    }
    // A mean of 40 squares; if one mode rules each, its standard deviation is sqrt(2 / 40) = 0.22: 0.8 is 3.6 of them.
    assert!((squares / predicted - 1.0).abs() < 0.8, "{}", squares / predicted);
}

/// What a file states of a camera is what the adjustment predicted of it.
#[test]
fn the_uncertainty_of_a_file_is_the_one_of_its_covariance() {
    let material = material("stated", 0, 8, &[0.1]);
    let options = options(&["opencv4"], 1);
    let found = calibrate(&material, 0, &material.usable(0), &options.models[0].settings(SIZE, None)).unwrap();
    let names = found.names.iter().map(|name| (*name).to_owned()).collect();
    let covariance = Some(ParameterCovariance::named(names, &found.covariance).unwrap());
    let named = NamedCamera { covariance, ..NamedCamera::new("", found.camera) };
    let (_, summary) = judged(&material, &options);
    let formal = summary.cells[0].predicted.unwrap().formal;
    let stated = stated_sigma(&named).unwrap();
    assert!((stated / formal - 1.0).abs() < 1e-9, "{stated} is not {formal}");
    assert_eq!(stated_sigma(&NamedCamera { covariance: None, ..named }), None);
}

#[test]
fn corners_that_one_operator_lacks_are_counted_and_not_compared() {
    let mut material = material("lacking", 0, 8, &[0.05, 0.05, 0.05]);
    for corner in 0..9 {
        material.operators[0].at[2][corner] = None;
        material.operators[0].rejected.push((2, corner, "border".into()));
    }
    // The second misses every other view: it does not decide what the others are compared on.
    for view in (0..8).step_by(2) {
        material.operators[1].at[view] = vec![None; BOARD.corners()];
    }
    let (rows, summary) = judged(&material, &options(&["opencv4"], 1));
    assert_eq!(rows.iter().filter(|row| &*row.measure == measure::REJECTED && &*row.status == "rejected").count(), 9);
    assert_eq!(summary.common, 8 * 54 - 9);
    assert_eq!((summary.methods[0].found, summary.methods[0].of), (8 * 54 - 9, 8 * 54));
    assert_eq!(summary.cell("operator-3", "opencv4").unwrap().held_out["v03"].1, 45);
    assert!(!summary.is_compared("operator-2") && summary.is_compared("operator-1"));
    assert!(summary.trusted().unwrap().operators.iter().all(|(cell, _)| &*cell.method != "operator-2"));
    let left_out = rows.iter().filter(|row| &*row.method == "operator-2" && &*row.status == "left out").count();
    assert_eq!(left_out, 4);
}

#[test]
fn one_thread_and_two_write_the_same_bytes() {
    let material = material("threads", 0, 7, &[0.05, 0.2]);
    let bytes = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let rows = pool.install(|| judge(&material, &options(&["opencv4", "photogrammetric", "eucm"], 3)).unwrap());
        let mut bytes = Vec::new();
        write_rows(&mut bytes, &RunInfo::default(), &rows).unwrap();
        bytes
    };
    assert!(bytes(1) == bytes(2));
}

#[test]
fn too_few_photographs_are_an_error_and_a_hopeless_model_is_a_row() {
    let few = judge(&material("few", 0, 5, &[0.1]), &options(&["opencv4"], 1)).unwrap_err();
    assert_eq!(few, JudgementError::TooFewViews { found: 5, needed: 6 });
    let mut none = material("few", 0, 6, &[0.1]);
    none.operators[0].unavailable = Some("not built".into());
    assert!(matches!(judge(&none, &options(&["opencv4"], 1)), Err(JudgementError::NoOperator(_))));
    // Every corner at one place: no calibration, and no panic.
    let mut spoiled = material("few", 0, 6, &[0.1]);
    spoiled.operators[0].at.iter_mut().flatten().for_each(|at| *at = Some(PixelPoint::new(100.0, 100.0)));
    let (_, summary) = judged(&spoiled, &options(&["opencv4"], 1));
    assert!(summary.trusted().is_none() && summary.cells[0].trouble.is_some());
}
