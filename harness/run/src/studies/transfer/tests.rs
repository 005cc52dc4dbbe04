//! Calibrations that are applied: without errors nothing is wrong, and what is put in is what is found.

use std::path::Path;

use calibench_measure::registry::Build;
use calibench_measure::{Registry, opencv_subpix};
use calibench_records::figures::Group;
use calibench_records::results::{Calibrated, Figure, Trial};
use calibench_scenario::studies::transfer::{Conditions, Decomposition, Switch};
use calibench_scenario::{Scenario, parse};
use nalgebra::Vector2;

use super::decomposition::{Errors, Split};
use crate::Plan;

mod images;

/// The methods of most tests, by their places.
const METHODS: &str = r#"
[[transfer.method]]
name = "control"
from = "control"
model = "metashape"

[[transfer.method]]
name = "board"
from = "board"
model = "opencv"
sigma_px = 0.03

[[transfer.method]]
name = "nothing"
from = "nothing"
"#;
const CONTROL: usize = 0;
const BOARD: usize = 1;
const NOTHING: usize = 2;

/// With the one method of the wall and the board that is not built in.
fn registry() -> Registry {
    Registry::builtin().with(opencv_subpix::method(Build::Unavailable("a test"), "none".into()))
}

/// A study of two trials with the wall and the board of `canon-t3`; `cases` end it.
fn study(methods: &str, cases: &str) -> Scenario {
    read(&text(methods, cases))
}

fn text(methods: &str, cases: &str) -> String {
    format!(
        r#"
why = "A study."
source = "ours"
seed = 5
trials = 2

[transfer]
apply = "wall.toml"
control = ["G*"]
check = ["V*"]
sigma_px = 0.5
survey_sigma = 0.002
pitch = 5.38085
start_c = 18.0
poses_of = "control"

[transfer.board]
file = "board.toml"
views = 6
distance = [600, 900]
tilt = 35
roll = 20
aside = [280, 180]
{methods}
{cases}
"#
    )
}

fn read(text: &str) -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/canon-t3/test.toml");
    parse("canon-t3/test", &path.display().to_string(), text, &registry()).unwrap_or_else(|problems| panic!("{problems}"))
}

/// A case without errors, with the keys `more`.
fn case(name: &str, more: &str) -> String {
    format!("[[transfer.case]]\nname = \"{name}\"\nmeasurement = false\nsurvey = false\n{more}\n")
}

fn trials(scenario: &Scenario, seed: u64) -> Vec<Trial> {
    let (plan, mut found) = (Plan { seed, ..Plan::new(scenario, crate::Tools::default(), "".into()) }, Vec::new());
    plan.run(&|| (), &mut |trial| {
        found.push(trial);
        Ok(())
    })
    .unwrap();
    found
}

fn first(methods: &str, cases: &str) -> Vec<Calibrated> {
    trials(&study(methods, cases), 5).swap_remove(0).calibrations
}

fn figures(found: &[Calibrated], method: usize, set: usize) -> &[Figure] {
    let one = found.iter().find(|one| one.method == method && one.set == set).unwrap();
    one.outcome.as_ref().unwrap_or_else(|why| panic!("{why}"))
}

fn figure<'a>(found: &'a [Calibrated], (method, set): (usize, usize), group: Group, name: &str) -> &'a Figure {
    let all = figures(found, method, set);
    all.iter().find(|figure| figure.name.group() == group && figure.name.text() == name).unwrap_or_else(|| panic!("no {name}: {all:?}"))
}

fn value(found: &[Calibrated], of: (usize, usize), name: &str) -> f64 {
    figure(found, of, Group::Check, name).value
}

fn error(found: &[Calibrated], of: (usize, usize), name: &str) -> f64 {
    figure(found, of, Group::Iop, name).error.unwrap()
}

#[test]
fn without_errors_exact_cameras_find_every_check_point() {
    let cases = format!("{}{}", case("held", "poses = \"held\""), case("resected", "poses = \"resected\""));
    let found = first(METHODS, &cases);
    for method in [CONTROL, BOARD] {
        for set in 0..2 {
            let of = (method, set);
            for name in ["rmse_x", "rmse_y", "rmse_z", "rmse_xy", "rmse_xyz", "rmse_xy_survey"] {
                assert!(value(&found, of, name) < 1e-6, "{method} {set} {name}: {:e} m", value(&found, of, name));
            }
            assert_eq!(value(&found, of, "points"), 14.0);
            for name in ["c", "x0", "y0"] {
                assert!(error(&found, of, name).abs() < 1e-5, "{method} {name}: {:e} mm", error(&found, of, name));
            }
            let frame = figure(&found, of, Group::Frame, "rms").value;
            assert!(frame < 1e-3, "{method}: {frame:e} px");
        }
    }
    assert!(value(&found, (NOTHING, 0), "rmse_xy") > 0.1, "no calibration costs decimetres under poses of another");
    assert!(value(&found, (NOTHING, 1), "rmse_xy") < 0.1, "most of which is the poses'");
    assert_eq!(figures(&found, CONTROL, 0).iter().filter(|figure| figure.name.group() == Group::Object).count(), 3 * 14);
}

#[test]
fn what_is_put_in_is_what_is_found() {
    let put_in = [
        "refocus = 0.5",
        "pitch = 5.149813",
        "principal_point = [0.1, -0.564]",
        "conversion = \"naive\"",
        "bend = 0.5",
        "pitch = 5.149813\nconversion = \"naive\"",
    ];
    let listed = put_in.iter().enumerate().map(|(i, keys)| case(&format!("case {i}"), &format!("poses = \"held\"\n{keys}")));
    let cases: String = listed.collect();
    let found = first(METHODS, &cases);
    let truth = figure(&found, (BOARD, 0), Group::Iop, "c").value - error(&found, (BOARD, 0), "c");
    assert!((error(&found, (BOARD, 0), "c") - 0.5).abs() < 1e-5, "{}", error(&found, (BOARD, 0), "c"));
    assert!(error(&found, (CONTROL, 0), "c").abs() < 1e-5, "the wall is not refocused");
    let shorter = truth * (5.149_813 / 5.38085 - 1.0);
    for method in [CONTROL, BOARD] {
        assert!((error(&found, (method, 1), "c") - shorter).abs() < 1e-5);
        assert!((error(&found, (method, 2), "x0") - 0.1).abs() < 1e-5 && (error(&found, (method, 2), "y0") + 0.564).abs() < 1e-5);
        assert!(error(&found, (method, 2), "c").abs() < 1e-5);
        assert!((error(&found, (method, 5), "c") - shorter).abs() < 1e-5, "a naive conversion leaves c as it is");
        let centimetres = 100.0 * value(&found, (method, 3), "rmse_xy");
        assert!((0.2..5.0).contains(&centimetres), "{centimetres} cm by the naive conversion");
    }
    assert!(error(&found, (BOARD, 4), "c").abs() > 0.01 && error(&found, (CONTROL, 4), "c").abs() < 1e-5, "the board alone is bent");
    assert_eq!(error(&found, (NOTHING, 1), "c"), 18.0 - truth, "a data sheet's principal distance is in mm");
    let k1 = figure(&found, (BOARD, 3), Group::Iop, "k1");
    assert!((k1.value + 0.1702 / truth.powi(2)).abs() < 1e-7 && k1.unit == "mm^-2", "{k1:?}");
}

#[test]
fn errors_grow_with_the_noise_and_what_the_adjustment_says_of_them_is_right() {
    let listed = "[[transfer.case]]\nname = \"plain\"\nposes = \"resected\"\n\
                  [[transfer.case]]\nname = \"noisy board\"\nposes = \"resected\"\nboard_sigma_px = 0.3\n";
    let scenario = Scenario { trials: 24, ..study(METHODS, listed) };
    let found: Vec<Vec<Calibrated>> = trials(&scenario, 5).into_iter().map(|trial| trial.calibrations).collect();
    for set in 0..2 {
        // Of 24 trials the root mean square error of c lies within three of its standard deviations of what is reported.
        let mean = |of: &dyn Fn(&Vec<Calibrated>) -> f64| found.iter().map(of).sum::<f64>() / 24.0;
        let rms = mean(&|trial| error(trial, (BOARD, set), "c").powi(2)).sqrt();
        let own = mean(&|trial| figure(trial, (BOARD, set), Group::Iop, "c").sigma.unwrap());
        assert!((rms / own - 1.0).abs() < 3.0 / 48.0_f64.sqrt(), "{set}: {rms} mm, reported {own}");
        for method in [CONTROL, BOARD] {
            let sigma0 = mean(&|trial| figure(trial, (method, set), Group::Network, "sigma0").value);
            assert!((sigma0 - 1.0).abs() < 0.05, "{method}: {sigma0}, with control of its weight");
        }
        let survey = mean(&|trial| value(trial, (CONTROL, set), "rmse_xy_survey"));
        assert!((survey - 0.003).abs() < 0.001, "2 mm an axis are in the references: {survey} m");
    }
    let of = |set| mean_of(&found, |trial| error(trial, (BOARD, set), "c").abs());
    assert!((of(1) / of(0) - 10.0).abs() < 1.0, "the same errors, ten times as large: {} {}", of(0), of(1));
}

fn mean_of(found: &[Vec<Calibrated>], of: impl Fn(&[Calibrated]) -> f64) -> f64 {
    found.iter().map(|trial| of(trial)).sum::<f64>() / found.len() as f64
}

#[test]
fn the_seed_makes_the_numbers_on_any_number_of_threads() {
    let scenario = Scenario { trials: 5, ..study(METHODS, "[[transfer.case]]\nname = \"plain\"\nposes = \"held\"\n") };
    let on = |threads: usize, seed: u64| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| trials(&scenario, seed))
    };
    let one = on(1, 5);
    assert_eq!(one, on(3, 5));
    assert_ne!(one, on(1, 6));
    let values = |trial: &Trial| value(&trial.calibrations, (CONTROL, 0), "rmse_xy");
    assert_ne!(values(&one[0]), values(&one[1]));
    let kept = |trial: &Trial| figures(&trial.calibrations, CONTROL, 0).iter().any(|figure| figure.name.group() == Group::Object);
    assert!(kept(&one[0]) && !kept(&one[1]), "of later trials the check points are not kept");
}

#[test]
fn what_cannot_be_applied_is_told_and_the_rest_goes_on() {
    let methods = METHODS.replace(
        "model = \"metashape\"\n",
        "model = \"metashape\"\nparameters = [\"f\", \"cx\", \"cy\", \"k1\", \"k2\", \"k3\", \"k4\", \"p1\", \"p2\"]\n",
    );
    let found = first(&methods, &case("naive", "poses = \"held\"\nconversion = \"naive\""));
    let of = |method| &found.iter().find(|one| one.method == method).unwrap().outcome;
    let why = of(CONTROL).as_ref().unwrap_err();
    assert!(why.contains("naive conversion holds for cameras"), "{why}");
    assert!(of(BOARD).is_ok());
}

/// A study's own split: from nothing to everything, with shares that make up the whole.
#[test]
fn a_split_of_a_trial_sums_up() {
    let plan = "[[transfer.decomposition]]\nname = \"split\"\nmethods = [\"board\"]\nposes = \"held\"\npitch = 5.149813\nrefocus = 0.5\n";
    let found = first(METHODS, &format!("{}{plan}", case("plain", "poses = \"held\"")));
    let of = (BOARD, 1);
    assert!(value(&found, of, "none") < 1e-6, "without errors there is none");
    let switches = ["measurement", "survey", "naive conversion", "pitch", "refocus"];
    let shares: f64 = switches.iter().chain(&["none", "interactions"]).map(|name| value(&found, of, &format!("share/{name}"))).sum();
    assert!((shares - 1.0).abs() < 1e-9, "{shares}");
    // Both lengthen and shorten c alone: under held poses they nearly cancel, and add up.
    assert!(value(&found, of, "alone/pitch") > 0.1 && value(&found, of, "alone/refocus") > 0.05);
    assert!(value(&found, of, "pair/pitch+refocus") < 0.1 * value(&found, of, "alone/refocus"));
    assert_eq!(figure(&found, of, Group::Network, "runs").value, f64::from(2 + 5 + 5 + 10));
    assert!(figures(&found, BOARD, 1).iter().all(|figure| !figure.name.text().contains("exchanged")), "held throughout: no such switch");
}

fn plan() -> Decomposition {
    let on = Conditions { measurement: true, naive: true, held: true, ..Conditions::none() };
    let off = Conditions::none();
    Decomposition { name: "d".into(), methods: vec![0], on, off, switches: off.differing(&on) }
}

fn errors(x: f64, y: f64) -> Errors {
    vec![Vector2::new(x, y), Vector2::new(-y, x)]
}

fn named(split: &Split, name: &str) -> f64 {
    split.figures("m").iter().find(|figure| figure.name.text() == name).unwrap_or_else(|| panic!("no {name}")).value
}

/// 3 to the right and 4 upwards: they sum up, and to squares of 9 and 16 of 25.
#[test]
fn errors_that_add_up_have_no_interactions() {
    let of = |c: &Conditions| Ok(errors(if c.measurement { 3.0 } else { 0.0 }, if c.naive { 4.0 } else { 0.0 }));
    let split = Split::new(&plan(), of).unwrap();
    assert_eq!(split.switches, [Switch::Measurement, Switch::Naive, Switch::ExchangedPoses]);
    for (name, expected) in [
        ("none", 0.0),
        ("all", 5.0),
        ("interactions", 0.0),
        ("alone/measurement", 3.0),
        ("without/measurement", 4.0),
        ("alone/exchanged poses", 0.0),
        ("without/exchanged poses", 5.0),
        ("share/measurement", 9.0 / 25.0),
        ("share/naive conversion", 16.0 / 25.0),
        ("share/interactions", 0.0),
        ("pair/measurement+naive conversion", 0.0),
    ] {
        assert!((named(&split, name) - expected).abs() < 1e-12, "{name}: {}", named(&split, name));
    }
}

/// What two switches make together is in their pair, in the interactions, and in nothing else.
#[test]
fn an_interaction_is_that_of_its_pair() {
    let both = |c: &Conditions| c.naive && c.held;
    let of = |c: &Conditions| Ok(errors(1.0 + if c.measurement { 2.0 } else { 0.0 }, if both(c) { 7.0 } else { 0.0 }));
    let split = Split::new(&plan(), of).unwrap();
    assert!((named(&split, "none") - 1.0).abs() < 1e-12 && (named(&split, "interactions") - 7.0).abs() < 1e-12);
    assert!((named(&split, "pair/naive conversion+exchanged poses") - 7.0).abs() < 1e-12);
    assert!(named(&split, "pair/measurement+exchanged poses").abs() < 1e-12);
    assert!((split.shares().iter().sum::<f64>() - 1.0).abs() < 1e-12, "{:?}", split.shares());
    let failed = Split::new(&plan(), |c| if both(c) { Err("no rays".into()) } else { Ok(errors(0.0, 0.0)) }).unwrap_err();
    assert_eq!(failed, "all switches on: no rays");
}

/// Of the survey's 2 mm an axis check points keep what 33 control points leave of it against the truth, and all of it against their own survey. A case without
/// it has none, whatever was calibrated before.
#[test]
fn errors_of_the_survey_are_those_of_the_survey() {
    let cases =
        format!("{}{}", case("with", "poses = \"held\"").replace("survey = false", "survey = true"), case("without", "poses = \"held\""));
    let found = first(METHODS, &cases);
    let [to_truth, to_survey] = ["rmse_xy", "rmse_xy_survey"].map(|name| value(&found, (CONTROL, 0), name));
    assert!((to_survey / 0.002_f64.hypot(0.002) - 1.0).abs() < 3.0 / 56.0_f64.sqrt(), "{to_survey} m");
    assert!(to_truth > 1e-4 && to_truth < 0.6 * to_survey, "{to_truth} {to_survey} m");
    assert!(value(&found, (CONTROL, 1), "rmse_xy") < 1e-6 && value(&found, (BOARD, 1), "rmse_xy") < 1e-6);
}

/// Nine corners along the longer side: the fifth is the crest, the first and the last stay where they are.
#[test]
fn a_bent_board_has_its_crest_in_its_middle() {
    let scenario = study(METHODS, &case("plain", "poses = \"held\""));
    let calibench_scenario::Subject::Views(views) = &scenario.subject else { panic!("views") };
    let board = views.study.transfer().unwrap().board.as_ref().unwrap();
    let heights: Vec<f64> =
        super::bent::bent(board, 0.8).iter().zip(&board.field.targets).map(|(bent, flat)| bent.z - flat.surveyed.z).collect();
    assert_eq!(heights.len(), 54);
    for row in heights.chunks(9) {
        let expected = |i: usize| 0.8 * (1.0 - ((i as f64 - 4.0) / 4.0).powi(2));
        assert!(row.iter().enumerate().all(|(i, z)| (z - expected(i)).abs() < 1e-9), "{row:?}");
    }
}

/// A network of fewer stations is all there is: for the bundle, whose redundancy it lowers, for held poses and for check points. Without errors it costs nothing.
#[test]
fn a_network_of_fewer_stations_is_all_there_is() {
    let few = "poses = \"held\"\nstations = [\"1\", \"4\", \"12\"]";
    let noisy = format!("[[transfer.case]]\nname = \"noisy\"\n{few}\n[[transfer.case]]\nname = \"noisy, all\"\nposes = \"held\"\n");
    let found = first(METHODS, &format!("{}{}{noisy}", case("all", "poses = \"held\""), case("few", few)));
    for method in [CONTROL, BOARD] {
        assert!(value(&found, (method, 1), "rmse_xyz") < 1e-6, "{method}: {} m", value(&found, (method, 1), "rmse_xyz"));
    }
    let redundancy = |set| figure(&found, (CONTROL, set), Group::Network, "redundancy").value;
    // Two coordinates of each of 33 control points less six unknowns of each station, 9 fewer; not every point is in every image.
    assert!(redundancy(0) - redundancy(1) <= 9.0 * (2.0 * 33.0 - 6.0) && redundancy(1) < 0.3 * redundancy(0));
    let [few, all] = [2, 3].map(|set| value(&found, (CONTROL, set), "rmse_xyz"));
    assert!(few > 1.2 * all, "fewer rays, larger errors: {few} {all} m");
}

#[test]
fn the_network_is_a_switch_of_its_own() {
    let plan =
        "[[transfer.decomposition]]\nname = \"split\"\nmethods = [\"control\"]\nposes = \"held\"\nstations = [\"1\", \"4\", \"12\"]\n";
    let found = first(METHODS, &format!("{}{plan}", case("plain", "poses = \"held\"")));
    let of = (CONTROL, 1);
    assert!(value(&found, of, "alone/network") < 1e-6, "alone it has nothing to enlarge");
    let both = value(&found, of, "pair/measurement+network");
    assert!(both > 0.1 * value(&found, of, "alone/measurement"), "{both} m");
}
