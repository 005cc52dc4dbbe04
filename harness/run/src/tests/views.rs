//! Views of one trial, which are drawn and measured side by side: what becomes of each, on any number of threads.

use calibench_records::figures::Group;
use calibench_records::results::{Outcome, PointResult, Trial};
use calibench_scenario::Scenario;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::{NAME, changed, trials};
use crate::store::{RecordsFolder, run};
use crate::{Plan, Tools};

const VIEWS: [&str; 4] = ["1111", "1121", "1211", "1221"];

const CODED: &str = include_str!("coded.toml");
const FOUR: [(&str, &str); 4] = [
    ("trials = 4", "trials = 1"),
    ("phis = [0, 30]", "phis = [15, 30]"),
    ("snr_contrast_db = 27.5", "snr_contrast_db = 46"),
    ("[[method]]", "[[method]]\nname = \"pixel\"\n\n[[method]]"),
];

/// Four images of a coded field: more than threads. Two are counted together, and the first of them is shown with its steps.
pub(super) fn coded() -> Scenario {
    let tilted = ("[blocks]", "[[recognition.images]]\nname = \"tilted\"\nimages = [\"12??\"]\n\n[blocks]");
    changed(CODED, &[&FOUR[..], &[tilted]].concat())
}

/// The same images, in which a hand points.
pub(super) fn pointed() -> Scenario {
    let [recognition, methods] = ["[recognition]", "[[method]]"].map(|header| CODED.find(header).unwrap());
    changed(CODED, &[&[(&CODED[recognition..methods], ""), ("sigma = 0\n", "sigma = 0.4\n")], &FOUR[..]].concat())
}

fn pool(threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
}

/// The first trial, on so many threads.
fn trial(scenario: &Scenario, threads: usize) -> Trial {
    pool(threads).install(|| trials(scenario, scenario.seed)).swap_remove(0)
}

#[test]
fn points_stand_in_the_order_of_methods_and_views_and_every_view_is_counted_once() {
    let scenario = coded();
    for threads in [1, 2, 3, 8] {
        let trial = trial(&scenario, threads);
        let mut stand: Vec<(usize, &str)> = trial.points.iter().map(|point| (point.method, &*point.view)).collect();
        stand.dedup();
        let expected: Vec<_> = [0, 1].iter().flat_map(|method| VIEWS.map(|view| (*method, view))).collect();
        assert_eq!(stand, expected, "{threads} threads");
        let figures = || trial.calibrations.iter().flat_map(|one| one.outcome.as_ref().unwrap());
        let count = |name: &str| {
            figures().find(|figure| figure.name.group() == Group::Network && figure.name.text() == name).map(|figure| figure.value)
        };
        for (name, views) in [("all", 4.0), ("tilted", 2.0)] {
            for what in ["images", "grids"] {
                assert_eq!(count(&format!("modern/{what}/{name}")), Some(views), "{threads} threads: {what} of {name}");
            }
        }
    }
}

#[test]
fn kept_are_the_image_of_the_first_point_and_the_one_with_its_steps() {
    let scenario = coded();
    for threads in [1, 3] {
        let parent = tempfile::tempdir().unwrap();
        let folder = RecordsFolder::open(parent.path(), NAME, None).unwrap();
        pool(threads).install(|| run(&folder, &Plan::new(&scenario, Tools::default(), ".".into()), "r", &|| ())).unwrap();
        let paths = std::fs::read_dir(parent.path().join(NAME)).unwrap().map(|entry| entry.unwrap().path());
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
    let trial = trial(&pointed(), 2);
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
