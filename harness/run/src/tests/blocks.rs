//! Free blocks of a wall on a stand whose corners are drawn from the truth without error: what the figures of each block must be is known.

use calibench_records::figures::Group;
use calibench_records::results::{Calibrated, Figure};
use calibench_scenario::Scenario;

use super::recordings::on_stand;
use super::trials;

/// Two tilts, four turns, two rolls: 16 images of 25 points.
const STAND: &str = "phis = [30, 45]\nturns = [0, 90, 180, 270]\nrolls = [0, 90]\n";
pub(super) const BEND: &str = "bend = 0.002\nbend_reach = 0.5\n";
pub(super) const HEAD: &str = "[blocks]\nc = 10.0\nsigma_px = 0.5\ngross_px = 20\n";
pub(super) const SETS: &str = r#"
parameters = ["e1", "e2", "e3", "e4", "e5", "e6", "e7", "e8", "e9", "e10", "e11", "e12"]
groups = [["11?1"], ["11?2"], ["12?1"], ["12?2"]]
"#;
const IMAGES: f64 = 16.0;
const POINTS: f64 = 25.0;

/// The stand with the blocks `listed`, under their head, and a hand of this sigma, px.
pub(super) fn stand(bend: &str, camera: &str, listed: &str, sigma: &str) -> Scenario {
    let (listed, hand) = (format!("{listed}\n[pointing]"), format!("sigma = {sigma}"));
    let changes = [
        ("phis = [0, 30]\nturns = [0, 90]\nrolls = [0, 90]\n", STAND),
        ("rows = 4\ncolumns = 3\n", "rows = 5\ncolumns = 5\n"),
        ("c = 10.0\n", camera),
        ("sigma = 0.4", &*hand),
        ("trials = 2", "trials = 1"),
        ("[pointing]", &*listed),
    ];
    on_stand(bend, &changes)
}

/// The blocks `listed` of the first trial, without noise.
fn blocks(bend: &str, camera: &str, listed: &str) -> Vec<Calibrated> {
    // Without any motion or noise nothing but local distortion changes from trial to trial.
    trials(&stand(bend, camera, &format!("{HEAD}{listed}"), "0.0"), 1).swap_remove(0).calibrations
}

fn figures(found: &[Calibrated], set: usize) -> &[Figure] {
    let one = found.iter().find(|one| one.set == set).unwrap();
    one.outcome.as_ref().unwrap()
}

fn value(found: &[Calibrated], set: usize, name: &str) -> f64 {
    let figure = figures(found, set).iter().find(|figure| figure.name.group() == Group::Network && figure.name.text() == name);
    figure.unwrap_or_else(|| panic!("no {name}: {:?}", figures(found, set))).value
}

fn counts(found: &[Calibrated], set: usize) -> [f64; 4] {
    ["observations", "of them held", "unknowns", "redundancy"].map(|name| value(found, set, name))
}

/// Two equations an image point and seven of the datum; six unknowns an image, three a point, twelve a set.
#[test]
fn a_bend_is_in_the_residuals_unless_every_group_has_its_parameters() {
    let listed = format!(
        "[[block]]\nname = \"plain\"\n[[block]]\nname = \"sets\"{SETS}[[block]]\nname = \"corrected\"\ncorrected_by = \"sets\"\n\
         [[block]]\nname = \"one set\"\nparameters = [\"e3\", \"e4\"]\n"
    );
    let found = blocks(BEND, "c = 10.0\n", &listed);
    let (observations, unknowns) = (2.0 * IMAGES * POINTS + 7.0, 6.0 * IMAGES + 3.0 * POINTS);
    for (set, parameters) in [(0, 0.0), (1, 48.0), (2, 0.0), (3, 2.0)] {
        let expected = [observations, 7.0, unknowns + parameters, observations - unknowns - parameters];
        assert_eq!(counts(&found, set), expected, "block {set}");
    }
    let [plain, sets, corrected, one] = [0, 1, 2, 3].map(|set| value(&found, set, "sigma0"));
    assert!(plain > 0.05 && sets < 0.2 * plain, "{plain} {sets}");
    assert!(corrected < 1.05 * sets && one > 3.0 * sets, "{sets} {corrected} {one}");
    assert!((value(&found, 0, "sigma0 in um") / plain - 5.0).abs() < 1e-9);
    let named = figures(&found, 1).iter().filter(|figure| figure.name.group() == Group::Iop);
    let named: Vec<&str> = named.map(|figure| figure.name.text()).collect();
    assert_eq!((named.len(), named[0], named[47]), (48, "group 1/e1", "group 4/e12"));
}

/// Turns of 0 and 180 degrees bend the wall along X alone: one form in all of their images.
#[test]
fn images_of_one_bend_give_it_back() {
    let found = blocks(BEND, "c = 10.0\n", "[[block]]\nname = \"heights\"\nimages = [\"1?[13]?\"]\nbend_over = 0.5\n");
    let [along, across, sigma0] = ["bend along X", "bend along Y", "sigma0"].map(|name| value(&found, 0, name));
    assert!((along - 0.002).abs() < 4e-5 && across.abs() < 4e-5, "{along} {across}");
    assert!(sigma0 < 1e-3, "{sigma0}");
    assert_eq!(value(&found, 0, "images"), 8.0);
    let heights = figures(&found, 0).iter().filter(|figure| figure.name.group() == Group::Object).count();
    assert_eq!(heights as f64, POINTS);
}

/// Every height is an observation, and two horizontal points hold four coordinates. A choice of images is a network.
#[test]
fn observed_heights_and_lots_are_counted() {
    let listed = "[[block]]\nname = \"heights\"\nheight_sigma = 0.01\neach = [[\"1111\", \"1211\"], [\"1112\", \"1212\", \"1222\"]]\n\
                  [[block]]\nname = \"few\"\npoints_per_image = 10\n";
    let found = blocks("", "c = 10.0\n", listed);
    assert_eq!(value(&found, 0, "networks"), 2.0);
    for (of, images) in [("least", 2.0), ("most", 3.0)] {
        assert_eq!(value(&found, 0, &format!("observations, {of}")), 2.0 * images * POINTS + POINTS + 4.0);
        assert_eq!(value(&found, 0, &format!("unknowns, {of}")), 6.0 * images + 3.0 * POINTS);
        assert_eq!(value(&found, 0, &format!("of them held, {of}")), 4.0);
    }
    assert!(value(&found, 0, "sigma0, most") < 1e-6 && value(&found, 0, "sigma0/1111+1211") < 1e-6);
    assert_eq!(value(&found, 1, "image points"), 10.0 * IMAGES);
}

/// What a block leaves out are points of its own targets.
#[test]
fn gross_errors_are_counted_by_block() {
    let listed =
        format!("{}[[block]]\nname = \"all\"\n[[block]]\nname = \"some\"\ntargets = [\"*1\", \"*2\", \"*3\"]\n", HEAD.replace("20", "15"));
    let found = trials(&stand("", "c = 10.0\n", &listed, "8.0"), 1).swap_remove(0).calibrations;
    let of = |set: usize| ["gross errors", "image points", "points"].map(|name| value(&found, set, name));
    let ([gross, seen, points], [some, few, fewer]) = (of(0), of(1));
    assert!(gross > some && some > 0.0 && fewer < points, "{gross} {some} {points} {fewer}");
    assert_eq!((seen + gross, few + some), (IMAGES * points, IMAGES * fewer));
}

/// Images of one turn and roll see the wall alike, whatever the tilt: the camera's local distortion is the same in both.
#[test]
fn one_local_distortion_is_common_to_images_of_one_view() {
    let local = "c = 10.0\n[camera.local]\nsigma = 0.5\ncorrelation = 150\n";
    let pairs: Vec<String> = (1..=4).flat_map(|t| (1..=2).map(move |r| format!("[\"11{t}{r}\", \"12{t}{r}\"]"))).collect();
    let listed = format!("[[block]]\nname = \"all\"\n[blocks.residuals]\nblocks = [\"all\"]\npairs = [{}]\n", pairs.join(", "));
    let found = blocks("", local, &listed);
    let [within, across, pairs] = ["correlation within pairs", "correlation across pairs", "pairs"].map(|name| value(&found, 1, name));
    assert!(pairs == 8.0 && within > across + 0.2, "{pairs} {within} {across}");
    let each = figures(&found, 0).iter().filter(|figure| figure.name.group() == Group::Point).count();
    assert_eq!(each as f64, 2.0 * IMAGES * POINTS);
}
