//! Adjustments within a run: closed forms, and errors that are put in.

use calibench_adjust::ObjectPoint;
use calibench_model::{PixelPoint, Pose};
use calibench_random::Key;
use calibench_records::figures::Group;
use calibench_records::results::{Calibrated, Figure, PointResult};
use calibench_scenario::Calibration;
use nalgebra::{Matrix3, Point3, Vector3};

use super::{EXACT, KEY, scenario, trials, views};
use crate::studies::network::{Job, Observed, Wanted, adjusted, angles, check, control_point, draw, observe, resections};

fn with_job(test: impl FnOnce(&Job<'_>, &[PointResult])) {
    let scenario = scenario(&[]);
    let views = views(&scenario);
    let calibration = views.study.network().unwrap();
    let job = Job { calibration, field: &views.field, unit: views.unit, camera: &views.camera, stations: &views.stations };
    test(&job, &trials(&scenario, 3)[0].points);
}

fn figure<'a>(figures: &'a [Figure], group: Group, name: &str) -> &'a Figure {
    figures.iter().find(|figure| figure.name.group() == group && figure.name.text() == name).unwrap_or_else(|| panic!("{name}"))
}

fn checked(job: &Job<'_>, observed: &Observed) -> Vec<Figure> {
    check(job, job.calibration.check.as_ref().unwrap(), observed, EXACT, job.camera).unwrap()
}

/// Without error in the image the points are found where they are; every check point's survey is then off by 3, 4 and 12 mm.
#[test]
fn errors_of_check_points_are_2d_in_the_plane_and_apart_from_height() {
    with_job(|job, points| {
        let mut observed = observe(job, points, KEY);
        for &target in &job.calibration.check.as_ref().unwrap().points {
            observed.control[target] += Vector3::new(0.003, -0.004, 0.012);
        }
        let figures = checked(job, &observed);
        let value = |name: &str| figure(&figures, Group::Check, name).value;
        assert!(value("rmse_xy") < 1e-9 && value("rmse_z") < 1e-9, "{figures:?}");
        assert!((value("rmse_xy_survey") - 0.005).abs() < 1e-9, "sqrt(3^2 + 4^2) mm, not {}", value("rmse_xy_survey"));
        assert!((value("rmse_z_survey") - 0.012).abs() < 1e-9);
        assert_eq!(value("points"), 7.0);
        // The mean of 3 x 7 distances from the stations, written out.
        let stations = [[0.0, 0.0, 6.0], [-3.5, 0.3, 4.5], [3.4, -0.2, 4.6]].map(Point3::from);
        let targets: Vec<Point3<f64>> =
            job.calibration.check.as_ref().unwrap().points.iter().map(|&t| job.field.position(&job.field.targets[t])).collect();
        let mean = stations.iter().flat_map(|s| targets.iter().map(move |t| (s - t).norm())).sum::<f64>() / 21.0;
        assert!((value("distance") - mean).abs() < 1e-9, "{} {mean}", value("distance"));
        assert!(["rmse_xy", "rmse_z", "distance"].iter().all(|name| figure(&figures, Group::Check, name).unit == "m"));
    });
}

#[test]
fn a_mean_square_is_over_the_points_that_were_found() {
    with_job(|job, points| {
        let mut observed = observe(job, points, KEY);
        let check = job.calibration.check.as_ref().unwrap();
        // One point seen once is not intersected; of the six others one is surveyed 6 mm off in X.
        let (lost, off) = (check.points[0], check.points[1]);
        observed.points.retain(|point| point.target != lost || point.view == check.views[0]);
        observed.control[off].x += 0.006;
        let figures = checked(job, &observed);
        let value = |name: &str| figure(&figures, Group::Check, name).value;
        assert_eq!(value("points"), 6.0);
        assert!((value("rmse_xy_survey") - 0.006 / 6.0_f64.sqrt()).abs() < 1e-9);
        observed.points.retain(|point| !check.points.contains(&point.target));
        let why = check::check(job, check, &observed, EXACT, job.camera).unwrap_err();
        assert_eq!(why, "no check point was measured in two of the images");
    });
}

/// Residuals and their root mean squares: what is moved by a pixel in x shows in x.
#[test]
fn figures_of_an_adjustment_without_noise_are_the_truth() {
    with_job(|job, points| {
        let observed = observe(job, points, KEY);
        let starts = resections(job, &observed, EXACT).unwrap();
        let found = adjusted(job, &observed, EXACT, &["c", "x0", "y0"], &starts, Wanted::Points).unwrap();
        for name in ["c", "x0", "y0"] {
            let error = figure(&found.figures, Group::Iop, name).error.unwrap();
            assert!(error.abs() < 1e-7, "{name}: {error:e} mm");
        }
        for (station, pose) in job.stations.iter().zip(&found.poses) {
            assert!((pose.centre - station.pose.centre).norm() < 1e-7, "{}", station.name);
            assert!(figure(&found.figures, Group::Residual, &station.name).value < 1e-7);
        }
        let network = |name: &str| figure(&found.figures, Group::Network, name).value;
        assert_eq!(network("image points"), 48.0);
        // 96 image coordinates and 36 of control less 3 + 4 * 6 + 36 unknowns.
        assert_eq!(network("redundancy"), 69.0);
        assert!(figure(&found.figures, Group::Frame, "rms").value < 1e-5);
        assert_eq!(found.figures.iter().filter(|figure| figure.name.group() == Group::Point).count(), 96);
        let less = adjusted(job, &observed, EXACT, &["c"], &starts, Wanted::Interior).unwrap();
        assert!(less.figures.iter().all(|figure| matches!(figure.name.group(), Group::Iop | Group::Network)));
    });
}

#[test]
fn a_blunder_shows_in_its_own_residual_along_its_own_axis() {
    with_job(|job, points| {
        let mut observed = observe(job, points, KEY);
        let moved = observed.points.iter_mut().find(|p| p.method == EXACT && p.view == 1 && p.target == 6).unwrap();
        moved.at.y += 5.0;
        let starts = resections(job, &observe(job, points, KEY), EXACT).unwrap();
        let found = adjusted(job, &observed, EXACT, &["c", "x0", "y0"], &starts, Wanted::Points).unwrap();
        let points: Vec<&Figure> = found.figures.iter().filter(|figure| figure.name.group() == Group::Point).collect();
        let worst = points.iter().max_by(|a, b| a.value.abs().total_cmp(&b.value.abs())).unwrap();
        assert_eq!((worst.name.text(), worst.unit), (format!("left/{}/y", job.field.targets[6].id).as_str(), "px"));
        // Adjusted less observed: against the blunder, and most of it.
        assert!((-5.0..-2.5).contains(&worst.value), "{}", worst.value);
        // An image's figure is the root mean square over its coordinates.
        let own = points.iter().filter(|figure| figure.name.text().starts_with("left/")).map(|figure| figure.value.powi(2));
        let rms = (own.sum::<f64>() / 24.0).sqrt();
        assert!((figure(&found.figures, Group::Residual, "left").value / rms - 1.0).abs() < 1e-12);
    });
}

/// Reported angles: value and error in degrees, the error being what the pose is off.
#[test]
fn angles_are_reported_in_degrees_with_honest_sigmas() {
    let scenario = scenario(&[("trials = 2", "trials = 60")]);
    let names = ["omega", "phi", "kappa"].iter().flat_map(|angle| ["front", "left", "top"].map(|view| format!("{view}/{angle}")));
    let all = trials(&scenario, 3);
    let of_hand = |trial: &calibench_records::results::Trial| {
        let found: &Calibrated = trial.calibrations.iter().find(|found| found.method == 0 && found.set == 0).unwrap();
        found.outcome.clone().unwrap()
    };
    let figures: Vec<Vec<Figure>> = all.iter().map(of_hand).collect();
    for name in names.chain(["left/X0".into(), "top/Z0".into()]) {
        let of_trial = figures.iter().map(|figures| figure(figures, Group::Eop, &name));
        let squares = of_trial.map(|figure| (figure.error.unwrap() / figure.sigma.unwrap()).powi(2)).sum::<f64>() / 60.0;
        // The control's error is not drawn here, so that sigmas are a little too large.
        assert!((0.3..1.5).contains(&squares), "{name}: mean square of error over sigma {squares}");
    }
    let left = figure(&figures[0], Group::Eop, "left/kappa");
    assert!((left.value.abs() - 90.0).abs() < 10.0 && left.unit == "deg" && left.error.unwrap().abs() < 1.0, "{left:?}");
}

#[test]
fn sigmas_of_angles_have_closed_forms() {
    let c = Matrix3::from_diagonal(&Vector3::new(1e-6, 4e-6, 9e-6));
    let of = |angles: [f64; 3]| angles::sigmas(&Pose::from_angles(Point3::origin(), angles), &c).unwrap();
    let close = |found: [f64; 3], squares: [f64; 3]| {
        for (found, square) in found.iter().zip(squares) {
            assert!((found / square.sqrt() - 1.0).abs() < 1e-6, "{found} is not the root of {square}");
        }
    };
    close(of([0.7, 0.0, 0.0]), [1e-6, 4e-6, 9e-6]);
    // kappa = 30 deg: cos^2 = 3/4 of one axis and 1/4 of the other.
    close(of([0.2, 0.0, 30_f64.to_radians()]), [1.75e-6, 3.25e-6, 9e-6]);
    // phi = 60 deg: omega is the first over cos phi, and kappa makes up for it by tan phi.
    close(of([0.0, 60_f64.to_radians(), 0.0]), [4e-6, 4e-6, 12e-6]);
    assert_eq!(angles::sigmas(&Pose::from_angles(Point3::origin(), [0.0, 90_f64.to_radians(), 0.0]), &c), None, "omega and kappa are one");
}

#[test]
fn a_difference_of_angles_is_the_short_way() {
    let degrees = |a: f64, b: f64| angles::difference(a.to_radians(), b.to_radians()).to_degrees();
    for (a, b, expected) in [(179.0, -179.0, -2.0), (-179.0, 179.0, 2.0), (10.0, 350.0, 20.0), (90.0, 30.0, 60.0), (5.0, 5.0, 0.0)] {
        assert!((degrees(a, b) - expected).abs() < 1e-12, "{a} - {b}: {}", degrees(a, b));
    }
}

#[test]
fn what_is_observed_is_what_was_measured_with_the_errors_of_the_scenario() {
    with_job(|job, points| {
        let observed = observe(job, points, KEY);
        assert_eq!(observed.points.len(), points.len());
        for (given, seen) in points.iter().zip(&observed.points) {
            assert_eq!(Some(seen.at), given.outcome.position());
            assert_eq!((&*given.view, &*given.target), (job.stations[seen.view].name.as_str(), job.field.targets[seen.target].id.as_str()));
        }
        assert!(observed.control.iter().zip(&job.field.targets).all(|(at, target)| *at == target.surveyed));
    });
    let noisy = scenario(&[("sigma_px = 0.4", "sigma_px = 0.4\nfloor_px = 0.3\nsurvey_sigma = 0.002"), ("control_sigma = 0.0005\n", "")]);
    let views = views(&noisy);
    let calibration = views.study.network().unwrap();
    let job = Job { calibration, field: &views.field, unit: views.unit, camera: &views.camera, stations: &views.stations };
    let points = &trials(&noisy, 3)[0].points;
    let (mut floors, mut surveys) = (Vec::new(), Vec::new());
    for trial in 0..20 {
        let observed = observe(&job, points, Key { trial, ..KEY });
        let shift = |given: &PointResult, at: PixelPoint| {
            let from = given.outcome.position().unwrap();
            [at.x - from.x, at.y - from.y]
        };
        let all: Vec<[f64; 2]> = points.iter().zip(&observed.points).map(|(given, seen)| shift(given, seen.at)).collect();
        // All methods share the error of a point: those of the second half are those of the first.
        assert!(all[..48].iter().zip(&all[48..]).all(|(a, b)| (a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9));
        floors.extend(all[..48].iter().flatten().copied());
        surveys.extend(
            observed.control.iter().zip(&job.field.targets).flat_map(|(at, t)| (at - t.surveyed).iter().copied().collect::<Vec<_>>()),
        );
    }
    for (values, sigma) in [(floors, 0.3), (surveys, 0.002)] {
        let n = values.len() as f64;
        let rms = (values.iter().map(|v| v * v).sum::<f64>() / n).sqrt();
        assert!((rms / sigma - 1.0).abs() < 4.0 / (2.0 * n).sqrt(), "{rms} of {n} is not {sigma}");
        assert!((values.iter().sum::<f64>() / n).abs() < 4.0 * sigma / n.sqrt());
    }
}

#[test]
fn control_without_a_standard_deviation_is_fixed_and_other_control_is_weighted() {
    with_job(|job, _| {
        let at = Point3::new(1.0, 2.0, 3.0);
        assert_eq!(control_point(job, "a", at), ObjectPoint::observed("a", at, [0.0005; 3]));
        let calibration = Calibration { control_sigma: 0.0, ..job.calibration.clone() };
        let job = Job { calibration: &calibration, ..*job };
        assert_eq!(control_point(&job, "a", at), ObjectPoint::fixed("a", at));
    });
}

#[test]
fn methods_draw_errors_of_their_own() {
    let truth = PixelPoint::new(100.0, 200.0);
    let of = |method: &str, target: &str| draw(truth, 0.5, method, Key { target, ..KEY }).position;
    assert_eq!(of("a", "1"), of("a", "1"));
    assert!(of("a", "1") != of("b", "1") && of("a", "1") != of("a", "2"));
    assert_eq!(draw(truth, 0.0, "a", KEY).position, truth);
}
