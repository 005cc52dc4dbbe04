//! Views of one trial, which are drawn and measured side by side: what becomes of each, on any number of threads.

use calibench_measure::Registry;
use calibench_records::results::{Group, Outcome, PointResult, Trial};
use calibench_scenario::{Scenario, parse};
use rayon::ThreadPoolBuilder;

use crate::store::{RecordsFolder, run};
use crate::{Plan, Tools};

/// Four images of a coded field: more than threads. Two are counted together, and the first of them is shown with its steps.
const SCENARIO: &str = r#"why = "To see what becomes of each view."
source = "a test"
seed = 3
trials = 1

[camera]
size = [240, 240]
pitch = 27.0
c = 57.5

[testfield]
kind = "coded"
unit = "mm"
bend = 0

[stations]
kind = "stand"
phis = [15, 30]
turns = [0, 90]
rolls = [0]
distance = 4700
bend = 0.8
bend_reach = 250

[optics]
blur = 0.6
fill_factor_linear = 0.8

[sensor]
snr_contrast_db = 46
adc_bits = 8

[pointing]
sigma = 0
whole_pixels = false

[recognition]
classifiers = ["modern"]

[[recognition.images]]
name = "all"
images = ["1???"]

[[recognition.images]]
name = "tilted"
images = ["12??"]

[[method]]
name = "pixel"

[[method]]
name = "centroid_binary"
window = 13
"#;
const VIEWS: [&str; 4] = ["1111", "1121", "1211", "1221"];

fn scenario(text: &str) -> Scenario {
    parse("small/views", "views.toml", text, &Registry::builtin()).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The only trial, on so many threads.
fn trial(scenario: &Scenario, threads: usize) -> Trial {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let mut trials = Vec::new();
    let plan = Plan::new(scenario, Tools::default(), ".".into());
    pool.install(|| {
        plan.run(&|| (), &mut |trial| {
            trials.push(trial);
            Ok(())
        })
    })
    .unwrap();
    assert_eq!(trials.len(), 1);
    trials.swap_remove(0)
}

#[test]
fn points_stand_in_the_order_of_methods_and_views_and_every_view_is_counted_once() {
    let scenario = scenario(SCENARIO);
    for threads in [1, 2, 3, 8] {
        let trial = trial(&scenario, threads);
        let mut stand: Vec<(usize, &str)> = trial.points.iter().map(|point| (point.method, &*point.view)).collect();
        stand.dedup();
        let expected: Vec<_> = [0, 1].iter().flat_map(|method| VIEWS.map(|view| (*method, view))).collect();
        assert_eq!(stand, expected, "{threads} threads");
        let figures = trial.calibrations[0].outcome.as_ref().unwrap();
        let count = |name: &str| figures.iter().find(|figure| figure.group == Group::Network && &*figure.name == name).map(|f| f.value);
        for (name, views) in [("all", 4.0), ("tilted", 2.0)] {
            for what in ["images", "grids"] {
                assert_eq!(count(&format!("modern/{what}/{name}")), Some(views), "{threads} threads: {what} of {name}");
            }
        }
    }
}

#[test]
fn kept_are_the_image_of_the_first_point_and_the_one_with_its_steps() {
    let scenario = scenario(SCENARIO);
    for threads in [1, 3] {
        let parent = tempfile::tempdir().unwrap();
        let folder = RecordsFolder::open(parent.path(), &scenario.name, None).unwrap();
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(&folder, &mut Plan::new(&scenario, Tools::default(), ".".into()), "r", &|| ())).unwrap();
        let paths = std::fs::read_dir(parent.path().join(&scenario.name)).unwrap().map(|entry| entry.unwrap().path());
        let images = paths.filter(|path| path.extension().is_some_and(|extension| extension == "png"));
        let kept: Vec<String> = images.map(|path| path.file_name().unwrap().to_string_lossy().into_owned()).collect();
        let of = |view: &str| kept.iter().filter(|name| name.contains(view)).count();
        // Four steps beside the image.
        assert_eq!(VIEWS.map(of), [1, 0, 5, 0], "{threads} threads: {kept:?}");
    }
}

/// A hand that points with scatter scatters anew in each view.
#[test]
fn each_view_draws_for_itself() {
    let scenario = scenario(&SCENARIO.replace("sigma = 0\n", "sigma = 0.4\n").replace(&SCENARIO[recognition()], ""));
    let trial = trial(&scenario, 2);
    // Of the same target in every view; the start itself is what `pixel` measures.
    let error = |view: &str| {
        let of = |point: &&PointResult| point.method == 0 && &*point.view == view && point.target == trial.points[0].target;
        match trial.points.iter().find(of).map(|point| &point.outcome) {
            Some(Outcome::Measured { error, .. }) => *error,
            _ => None,
        }
    };
    let errors = VIEWS.map(|view| error(view).unwrap_or_else(|| panic!("no start in {view}")));
    for (i, one) in errors.iter().enumerate() {
        assert!(errors[..i].iter().all(|other| (other.0 - one.0).abs() > 1e-6), "{errors:?}");
    }
}

/// Where the recognition is described.
fn recognition() -> std::ops::Range<usize> {
    let at = |text: &str| SCENARIO.find(text).unwrap();
    at("[recognition]")..at("[[method]]")
}
