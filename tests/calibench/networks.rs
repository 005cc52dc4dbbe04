//! Adjustments within a run: against a second way, against the truth, and against themselves.

use std::path::PathBuf;

use calibench_calibrate::{DatumChoice, Optics, Settings, prepare};
use calibench_model::camera::CameraModel;
use calibench_model::{ControlRow, PointRow, Points, Start};
use calibench_random::Key;
use calibench_records::figures::Group;
use calibench_records::results::Trial;
use calibench_records::results::{Calibrated, Figure};
use calibench_run::Plan;
use calibench_run::studies::network::{ImagePoint, Job, calibrate, observe};
use calibench_scenario::{Scenario, Subject, ViewsSubject, parse};

use crate::project::root;

const NAME: &str = "galo-2011/network-coordinates";

/// The coordinates-only scenario with parts of its text replaced.
fn text(changes: &[(&str, &str)]) -> String {
    let path = root().join("scenarios").join(format!("{NAME}.toml"));
    let mut text = std::fs::read_to_string(path).unwrap();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    text
}

fn scenario(changes: &[(&str, &str)]) -> Scenario {
    parse(NAME, "network.toml", &text(changes), &calibench_opencv::registry()).unwrap()
}

fn views(scenario: &Scenario) -> &ViewsSubject {
    let Subject::Views(views) = &scenario.subject else { panic!("a scenario of views") };
    views
}

fn first_trial(scenario: &Scenario) -> Trial {
    let mut plan = Plan::new(scenario, calibench_run::Tools::default(), PathBuf::new());
    plan.trials = 1;
    let mut found = None;
    plan.run(&|| (), &mut |trial| {
        found = Some(trial);
        Ok(())
    })
    .unwrap();
    found.unwrap()
}

fn figure<'a>(calibrated: &'a Calibrated, group: Group, name: &str) -> &'a Figure {
    let figures = calibrated.outcome.as_ref().unwrap();
    figures.iter().find(|figure| figure.name.group() == group && figure.name.text() == name).unwrap_or_else(|| panic!("{name}"))
}

#[test]
fn a_user_who_calibrates_the_same_coordinates_finds_the_same_camera() {
    let scenario = scenario(&[]);
    let views = views(&scenario);
    let calibration = views.study.network().unwrap();
    let trial = first_trial(&scenario);
    let job = Job { calibration, field: &views.field, unit: views.unit, camera: &views.camera, stations: &views.stations };
    let key = Key { seed: scenario.seed, of: &scenario.drawn, trial: 0, view: "", target: "" };
    let observed = observe(&job, &trial.points, key);
    let name = |target: usize| views.field.targets[target].id.clone();
    let row = |point: &ImagePoint| PointRow {
        image: views.stations[point.view].name.clone(),
        target: name(point.target),
        start: Start::at(point.at),
    };
    let control: Vec<ControlRow> = observed
        .control
        .iter()
        .enumerate()
        .map(|(i, at)| ControlRow { sigmas: Some([calibration.control_sigma; 3]), ..ControlRow::new(name(i), (*at).into()) })
        .collect();
    for calibrated in &trial.calibrations {
        let points: Points = observed.points.iter().filter(|point| point.method == calibrated.method).map(row).collect();
        let optics = Optics {
            pitch_um: Some(4.70),
            model: Some("photogrammetric".into()),
            solve: Some(calibration.sets[calibrated.set].parameters.clone()),
            start: Some(calibration.start.into()),
            ..Optics::new(views.camera.size())
        };
        let settings = Settings { datum: DatumChoice::Control, sigma_px: Some(calibration.sigma_px), ..Settings::new(vec![optics]) };
        let prepared = prepare(points, &control, &settings).unwrap();
        let theirs = prepared.adjust().unwrap();
        for parameter in theirs.camera(0).parameters() {
            if !calibration.sets[calibrated.set].parameters.iter().any(|name| name == parameter.name) {
                continue;
            }
            let ours = figure(calibrated, Group::Iop, parameter.name);
            let off = (ours.value - parameter.value).abs() / ours.sigma.unwrap();
            assert!(off < 1e-4, "{} of {}: {off} standard deviations", parameter.name, calibration.sets[calibrated.set].name);
        }
        let ours = figure(calibrated, Group::Network, "sigma0").value;
        let sigma0 = theirs.solution.sigma0().unwrap() * calibration.sigma_px;
        assert!((ours / sigma0 - 1.0).abs() < 1e-8, "{ours} {sigma0}");
    }
}

#[test]
fn without_noise_the_truth_comes_back() {
    let scenario = scenario(&[
        ("floor_px = 0.52\n", ""),
        ("survey_sigma = 0.0005", "control_sigma = 0.0005"),
        ("\"forstner:window=9\" = 0.19, \"forstner:window=15\" = 0.05", "\"forstner:window=9\" = 0, \"forstner:window=15\" = 0"),
        ("sigma = 0.5\nwhole_pixels = true", "sigma = 0\nwhole_pixels = false"),
        ("trials = 200", "trials = 1"),
    ]);
    let trial = first_trial(&scenario);
    assert_eq!(trial.calibrations.len(), 3 * views(&scenario).study.network().unwrap().sets.len());
    for calibrated in trial.calibrations.iter().filter(|calibrated| calibrated.set == 0) {
        for (name, tolerance) in [("c", 1e-7), ("x0", 1e-7), ("y0", 1e-7), ("k1", 1e-10)] {
            let error = figure(calibrated, Group::Iop, name).error.unwrap();
            assert!(error.abs() < tolerance, "{name}: {error:e}");
        }
        for (group, name, tolerance) in [(Group::Eop, "6/X0", 1e-7), (Group::Eop, "9/kappa", 1e-6)] {
            let error = figure(calibrated, group, name).error.unwrap();
            assert!(error.abs() < tolerance, "{name}: {error:e}");
        }
        assert!(figure(calibrated, Group::Frame, "rms").value < 1e-5);
        for name in ["rmse_xy", "rmse_z", "rmse_xy_survey"] {
            assert!(figure(calibrated, Group::Check, name).value < 1e-8, "{name}");
        }
        assert_eq!(figure(calibrated, Group::Check, "points").value, 23.0);
    }
}

#[test]
fn the_reduction_factor_of_reported_sigmas_is_the_ratio_of_two_sigma0() {
    let trial = first_trial(&scenario(&[]));
    let of = |method: usize| trial.calibrations.iter().find(|c| c.method == method && c.set == 0).unwrap();
    let (pixel, subpixel) = (of(0), of(2));
    let ratio = figure(subpixel, Group::Network, "sigma0").value / figure(pixel, Group::Network, "sigma0").value;
    for (group, name) in [(Group::Iop, "c"), (Group::Iop, "k1"), (Group::Eop, "6/Y0"), (Group::Eop, "3/phi")] {
        let factor = figure(subpixel, group, name).sigma.unwrap() / figure(pixel, group, name).sigma.unwrap();
        // Cofactors differ by as much as the estimates at which they are linearised.
        assert!((factor / ratio - 1.0).abs() < 0.03, "{name}: {factor} {ratio}");
    }
}

#[test]
fn what_fails_is_a_row_with_its_reason() {
    let scenario = scenario(&[]);
    let views = views(&scenario);
    let calibration = views.study.network().unwrap();
    let job = Job { calibration, field: &views.field, unit: views.unit, camera: &views.camera, stations: &views.stations };
    let key = Key { seed: 1, of: NAME, trial: 0, view: "", target: "" };
    // An operator that measured nothing.
    let all = calibrate(&job, &[], &[0], key);
    assert!(!all.is_empty());
    assert!(all.iter().all(|one| one.outcome.as_ref().is_err_and(|why| why == "no image has 6 points or more")));
    // One that measured no control point of the second step: the first step stands.
    let control = &calibration.check.as_ref().unwrap().control;
    let names: Vec<&str> = control.iter().map(|&target| views.field.targets[target].id.as_str()).collect();
    let points: Vec<_> = first_trial(&scenario).points.into_iter().filter(|point| !names.contains(&&*point.target)).collect();
    let first = &calibrate(&job, &points, &[0], key)[0];
    assert!(first.outcome.is_ok());
    assert!(first.check_failed.as_ref().is_some_and(|why| why.starts_with("image 6: 0 known points")), "{:?}", first.check_failed);
}

#[test]
fn mistakes_have_line_and_column() {
    for (old, new, expected) in [
        ("\"c,x0,y0,k1\"", "\"c,x0,y0,k9\"", "the camera has no parameter `k9`"),
        ("\"c,x0,y0\"", "\"c,x0,y0,k1\"", "is listed twice"),
        ("start_c = 16.0", "start_c = 0", "expected a number from 0.001"),
        ("start_c = 16.0\n", "", "[calibration] has no `start_c`"),
        ("sigma_px = 0.5", "sigma_pixel = 0.5", "unknown key `sigma_pixel`"),
        ("\"forstner:window=9\" = 0.19", "\"forstner:window=7\" = 0.19", "`drawn` has `forstner:window=7`"),
        ("views = [\"6\", \"1\", \"9\"]", "views = [\"6\", \"11\"]", "no station is called `11`"),
        ("control = [\"left/1\", \"right/3\"", "control = [\"left/1\", \"right/2\"", "is a control point and a check point"),
    ] {
        let changed = text(&[(old, new)]);
        let problems = parse(NAME, "network.toml", &changed, &calibench_opencv::registry()).err().unwrap_or_else(|| panic!("{expected}"));
        let message = problems.to_string();
        assert!(message.contains(expected), "{expected}\n{message}");
        let place = message.strip_prefix("network.toml:").unwrap().split(':').take(2).map(|n| n.parse::<usize>().unwrap());
        assert!(place.min().unwrap() >= 1, "{message}");
    }
}
