//! What a calibration says of itself.

use calibench_adjust::{Status, Variance};
use calibench_calibrate::choice::ModelChoice;
use calibench_calibrate::{CalibrationError, DatumChoice, GrossErrors, Optics, Prior, Risk, Settings, parameters};
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::convert::{DifferenceOptions, difference};
use glob::Pattern;

use crate::network::{SIZE, Scene, agrees, board, lens, optics, settings, wall};

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

fn noisy(scene: Scene, sigma: f64) -> Scene {
    Scene { sigma, ..scene }
}

#[test]
fn rms_is_the_root_of_the_mean_squared_length() {
    let prepared = noisy(board(lens()), 0.2).prepared(&settings("opencv5")).unwrap();
    let found = prepared.adjust().unwrap();
    let lengths: Vec<f64> = found.solution.each_residual().filter_map(|residual| residual.v).map(|[x, y]| x * x + y * y).collect();
    assert_eq!(lengths.len(), 441);
    assert!((found.rms_px() - (lengths.iter().sum::<f64>() / 441.0).sqrt()).abs() < 1e-15);
    // Two coordinates of 0.2 px less the share of 51 unknowns among 882 observations: within four standard deviations of the root.
    let expected = 0.2 * (2.0 * (1.0 - 51.0 / 882.0_f64)).sqrt();
    assert!((found.rms_px() - expected).abs() < 4.0 * expected / (2.0 * 831.0_f64).sqrt(), "{} for {expected}", found.rms_px());
}

/// Standard deviations and tests take the a-priori variance where the user states it, the estimated one where not.
#[test]
fn a_stated_standard_deviation_is_taken() {
    let scene = noisy(board(lens()), 0.2);
    let stated = Settings { sigma_px: Some(0.2), ..settings("opencv5") };
    let [with, without] = [&stated, &settings("opencv5")].map(|settings| scene.prepared(settings).unwrap());
    let (with, without) = (with.adjust().unwrap(), without.adjust().unwrap());
    let variance = |found: &calibench_calibrate::Calibration<'_>| found.reliability.as_ref().unwrap().test.variance;
    assert_eq!((variance(&with), variance(&without)), (Variance::Apriori, Variance::Estimated));
    // The same estimates, and nearly the same detectable error: only the factor differs.
    agrees(&with, without.camera(0), 1e-9);
    let least = |found: &calibench_calibrate::Calibration<'_>| found.reliability.as_ref().unwrap().points[0].detectable[0];
    let ratio = least(&with) / least(&without);
    assert!((ratio * without.solution.sigma0().unwrap() * 0.1 / 0.2 - 1.0).abs() < 1e-6, "{ratio}");
}

#[test]
fn gross_errors_are_looked_for_when_asked() {
    let scene = noisy(board(lens()), 0.05);
    let (whole, mut points) = (scene.points(), calibench_model::Points::default());
    for (index, mut row) in whole.rows().enumerate() {
        row.start.position.x += if index == 100 { 2.0 } else { 0.0 };
        points.push(row.image, row.target, row.start);
    }
    let settings = Settings { gross: GrossErrors::Rejected(Risk::EachPoint), sigma_px: Some(0.05), ..settings("opencv5") };
    let prepared = calibench_calibrate::prepare(points, &scene.known(), &settings).unwrap();
    let found = prepared.adjust().unwrap();
    assert!(found.found.iter().any(|found| found.observation == 100 && found.left_out), "{:?}", found.found);
    assert!(found.rms_px() < 0.1, "a point that is left out does not count: {}", found.rms_px());
}

#[test]
fn several_cameras_have_their_own_images_names_and_files() {
    let scene = board(lens());
    let camera = |name: &str, images: &str| Optics { name: name.into(), images: vec![Pattern::new(images).unwrap()], ..optics("opencv5") };
    let two = Settings::new(vec![camera("left", "image_[0-2]*"), camera("right", "image_*")]);
    let prepared = scene.prepared(&two).unwrap();
    let found = prepared.adjust().unwrap();
    assert_eq!((found.cameras(), found.name_of(1), found.parameter_name(&(1, "k1"))), (2, "right", "right.k1".to_owned()));
    assert_eq!((found.owner(2), found.owner(3)), (0, 1));
    let file = found.named_camera(1).unwrap();
    assert_eq!((file.name.as_str(), file.pitch_um), ("right", Some(5.0)));
    let covariance = file.covariance.unwrap();
    assert_eq!((covariance.parameters.len(), covariance.values.len()), (9, 81));
    let alone = scene.prepared(&settings("opencv5")).unwrap();
    let alone = alone.adjust().unwrap();
    assert_eq!((alone.named_camera(0).unwrap().name.as_str(), alone.parameter_name(&(0, "k1"))), ("", "k1".to_owned()));
}

/// Nested sets on a lens whose k3 and p2 matter: each is tested against the largest that it holds.
#[test]
fn sets_of_parameters_are_compared_with_those_they_hold() {
    let scene = noisy(board(lens()), 0.1);
    let prepared = scene.prepared(&settings("opencv5")).unwrap();
    let mut found = prepared.adjust().unwrap();
    let sets = [
        names(&["fx", "fy"]),
        names(&["fx", "fy", "cx", "cy"]),
        names(&["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"]),
        names(&["fx", "k1"]),
    ];
    found.compare(&sets).unwrap();
    let compared = found.compared.as_ref().unwrap();
    let against: Vec<Option<usize>> = compared.sets.iter().map(|set| set.against.as_ref().map(|(index, _)| *index)).collect();
    assert_eq!(against, [None, Some(0), Some(1), None]);
    let results: Vec<_> = compared.sets.iter().map(|set| set.result.as_ref().unwrap()).collect();
    let poses = 6 * scene.poses.len();
    assert_eq!(results.iter().map(|result| result.counts).collect::<Vec<_>>(), [2, 4, 9, 2].map(|u| (882, u + poses)));
    // The whole set is the calibration itself; the others are far off, and Akaike's criterion says so.
    let whole = results[2];
    assert!(whole.change_px.unwrap()[0] < 1e-6, "{:?}", whole.change_px);
    assert!((whole.sigma0_px - 0.1 * found.solution.sigma0().unwrap()).abs() < 1e-9, "{}", whole.sigma0_px);
    assert!(results[1].change_px.unwrap()[1] > 1.0 && results[1].aicc > whole.aicc + 100.0);
    // By hand: n ln(SS / n) + 2 k + 2 k (k + 1) / (n - k - 1) with the variance among the k.
    let (n, k) = (882.0, 9.0 + poses as f64 + 1.0);
    let expected = n * (found.solution.cost() / n).ln() + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0);
    assert!((whole.aicc - expected).abs() < 1e-6, "{} {expected}", whole.aicc);
    assert_eq!(whole.tests.len(), 9);
    assert!(found.compare(&[names(&["k9"])]).is_err());
}

#[test]
fn observed_parameters_stay_observed_in_every_set() {
    let scene = noisy(board(lens()), 0.1);
    let priors = vec!["k1=-0.11:0.001".parse::<Prior>().unwrap()];
    let prepared = scene.prepared(&Settings::new(vec![Optics { priors: priors.clone(), ..optics("opencv5") }])).unwrap();
    let of_k1 = |network: &calibench_adjust::Network| network.cameras[0].parameters[4];
    assert_eq!(of_k1(&prepared.network), Status::Observed { value: -0.11, sigma: 0.001 });
    let mut found = prepared.adjust().unwrap();
    found.compare(&[names(&["fx", "fy"])]).unwrap();
    let set = found.compared.as_ref().unwrap().sets[0].result.as_ref().unwrap();
    // Two free, one observed, six a pose; the observation counts.
    assert_eq!(set.counts, (883, 3 + 6 * 7));
    let twice = Settings::new(vec![Optics { priors: [priors.clone(), priors].concat(), ..optics("opencv5") }]);
    assert!(matches!(scene.prepared(&twice), Err(CalibrationError::PriorTwice { .. })));
}

#[test]
fn a_datum_holds_what_it_names() {
    let scene = noisy(wall(lens()), 0.1);
    let minimal = DatumChoice::Minimal { horizontal: ["t0", "t7"].map(str::to_owned), vertical: ["t0", "t7", "t40"].map(str::to_owned) };
    for (datum, held) in [(DatumChoice::Fixed, 144), (DatumChoice::Control, 144), (DatumChoice::Free, 0), (minimal, 0)] {
        let prepared = scene.prepared(&Settings { datum: datum.clone(), ..settings("opencv5") }).unwrap();
        let fixed = prepared.network.points.iter().flat_map(|point| point.coordinates).filter(|status| *status == Status::Fixed).count();
        assert_eq!(fixed, held, "{datum:?}");
        let found = prepared.adjust().unwrap();
        let Camera::OpenCv(camera) = found.camera(0) else { panic!("not OpenCV's model") };
        assert!((camera.fx - 1450.0).abs() < 5.0, "{datum:?}: {}", camera.fx);
    }
    let nobody = DatumChoice::Minimal { horizontal: ["t0", "t99"].map(str::to_owned), vertical: ["t0", "t7", "t40"].map(str::to_owned) };
    let error = scene.prepared(&Settings { datum: nobody, ..settings("opencv5") }).unwrap_err();
    assert!(matches!(&error, CalibrationError::DatumTarget { target } if target == "t99"), "{error}");
}

/// Every model by name: what it needs, what it is called, what is solved for by itself.
#[test]
fn models_have_the_parameters_they_usually_need() {
    for (model, expected) in [
        ("photogrammetric", "c x0 y0 k1 k2 p1 p2"),
        ("opencv4", "fx fy cx cy k1 k2 p1 p2"),
        ("metashape", "f cx cy k1 k2 k3 p1 p2"),
        ("eucm", "fx fy cx cy alpha beta"),
    ] {
        let prepared = board(lens()).prepared(&settings(model)).unwrap();
        let camera = &prepared.network.cameras[0];
        let named = camera.camera.parameters();
        let free: Vec<&str> = named.iter().zip(&camera.parameters).filter(|(_, s)| **s == Status::Free).map(|(p, _)| p.name).collect();
        assert_eq!(free.join(" "), expected, "{model}");
        assert!(free.iter().all(|name| parameters(&optics(model)).unwrap().contains(name)));
    }
    let without = Optics { pitch_um: None, ..optics("photogrammetric") };
    assert!(matches!(parameters(&without), Err(CalibrationError::NoPitch { .. })));
    let usual = |pitch_um| parameters(&Optics { pitch_um, model: None, ..Optics::new(SIZE) }).unwrap()[0];
    assert_eq!([usual(Some(5.0)), usual(None)], ["c", "fx"]);
    let c = Optics { solve: Some(names(&["c"])), ..Optics::new(SIZE) };
    assert!(matches!(parameters(&c), Err(CalibrationError::NoPitch { .. })));
}

/// A model in mm is calibrated with any pitch to the same camera in px.
#[test]
fn a_choice_of_models_brings_a_nominal_pitch() {
    let scene = board(lens());
    let choice = ModelChoice::parse("photogrammetric").unwrap();
    let [nominal, own] = [None, Some(5.0)].map(|pitch| scene.prepared(&choice.settings(SIZE, pitch)).unwrap());
    assert_eq!((nominal.settings.cameras[0].pitch_um, own.settings.cameras[0].pitch_um), (Some(10.0), Some(5.0)));
    let c = |prepared: &calibench_calibrate::Prepared| prepared.adjust().unwrap().camera(0).parameters()[0].value;
    assert!((c(&nominal) / c(&own) - 2.0).abs() < 1e-7);
}

#[test]
fn points_without_known_targets_are_named() {
    let mut scene = board(lens());
    let points = scene.points();
    scene.targets.truncate(1);
    scene.control = 1;
    let mut known = scene.known();
    known[0].target = "t0a".into();
    let error = calibench_calibrate::prepare(points, &known, &settings("opencv5")).unwrap_err().to_string();
    assert!(error.contains("`t0` was measured, `t0a` is known; is it `t0a`?"), "{error}");
}

/// The change of the camera that a set makes is that between two calibrations.
#[test]
fn the_change_of_a_set_is_the_difference_of_two_cameras() {
    let scene = noisy(board(lens()), 0.3);
    let few = names(&["fx", "fy", "cx", "cy", "k1"]);
    let whole = scene.prepared(&settings("opencv5")).unwrap();
    let mut whole = whole.adjust().unwrap();
    whole.compare(std::slice::from_ref(&few)).unwrap();
    let change = whole.compared.as_ref().unwrap().sets[0].result.as_ref().unwrap().change_px.unwrap();
    let solve = Settings { cameras: vec![Optics { solve: Some(few), ..optics("opencv5") }], ..settings("opencv5") };
    let part = scene.prepared(&solve).unwrap();
    let part = part.adjust().unwrap();
    let apart = difference(whole.camera(0), part.camera(0), &DifferenceOptions::default()).unwrap().spread;
    assert!((change[0] / apart.rms_px - 1.0).abs() < 1e-3 && (change[1] / apart.max_px - 1.0).abs() < 1e-3, "{change:?} {apart:?}");
}

/// A rational model on an ordinary board: what the images leave open is held near zero, named, and fits no worse than the model nested in it.
#[test]
fn what_a_rich_model_leaves_open_is_held_weakly() {
    let scene = noisy(board(lens()), 0.1);
    let user = Prior { parameter: "fx".into(), value: 1450.0, sigma: 50.0 };
    let cameras = vec![Optics { priors: vec![user], ..optics("opencv8") }];
    let prepared = scene.prepared(&Settings { cameras, ..settings("opencv8") }).unwrap();
    assert!(prepared.adjust().is_err_and(|error| error.is_undetermined()));
    let held = prepared.held_weakly().unwrap();
    assert_eq!(held.held, ["k4", "k5", "k6"]);
    let (rich, poor) = (held.adjust().unwrap(), scene.prepared(&settings("opencv5")).unwrap());
    let poor = poor.adjust().unwrap();
    assert!(rich.rms_px() < poor.rms_px() * (1.0 + 1e-6), "{} {}", rich.rms_px(), poor.rms_px());
    // A model without them has nothing to hold, nor has a fisheye, whose k4 is another.
    for model in ["opencv5", "opencv-fisheye"] {
        assert!(scene.prepared(&settings(model)).unwrap().held_weakly().is_none(), "{model}");
    }
}
