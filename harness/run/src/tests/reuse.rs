//! With a store every run hands on the trials of a run without one, to the last bit, and computes nothing that is there.

use std::path::PathBuf;
use std::sync::Arc;

use calibench_measure::{Build, Method, Outside, Registry};
use calibench_records::parts::Span;
use calibench_records::results::Trial;
use calibench_scenario::{Scenario, parse};
use calibench_store::Store;

use super::views::{coded, pointed};
use super::{SCENARIO, scenario};
use crate::reuse::{Reuse, Tally};
use crate::{Plan, Tools};

const SCENE: &str = r#"
why = "Corners in noise."
source = "ours"
seed = 5
trials = 40

[scene]
width = 60
height = 50
background = 0.2
phase = "uniform"
grey_noise = 0.02

[[scene.polygon]]
id = "a"
grey = 0.8
vertices = [[20, 15], [45, 15], [45, 35], [20, 35]]

[[scene.target]]
id = "1"
kind = "corner"
at = [20, 15]

[[scene.target]]
id = "2"
kind = "corner"
at = [45, 35]

[scene.pointing]
sigma = 0.5
whole_pixels = true

[optics]
blur = 0.7

[[method]]
name = "forstner"
window = 9

[[method]]
name = "pixel"

[[method]]
name = "parametric_junction"
"#;

fn scene(text: &str) -> Scenario {
    parse("small/scene", "scene.toml", text, &Registry::builtin()).unwrap_or_else(|problems| panic!("{problems}"))
}

/// A store in a folder of its own.
struct Kept {
    folder: tempfile::TempDir,
}

impl Kept {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn open(&self, fresh: bool) -> Store {
        Store::open(self.folder.path(), 1 << 30, fresh)
    }

    /// The entries, by their paths below the folder.
    fn entries(&self) -> Vec<PathBuf> {
        let mut found = Vec::new();
        for folder in std::fs::read_dir(self.folder.path()).unwrap() {
            let below = std::fs::read_dir(folder.unwrap().path()).unwrap().map(|entry| entry.unwrap().path());
            found.extend(below.map(|path| path.strip_prefix(self.folder.path()).unwrap().to_owned()));
        }
        found
    }

    /// The trials of `plan`, how many results were found, and how many were computed.
    fn run(&self, plan: Plan<'_>) -> (Vec<Trial>, [usize; 2]) {
        let (store, tally) = (self.open(false), Tally::default());
        let found = all(&Plan { reuse: Some(Reuse { store: &store, program: "p", tally: &tally }), ..plan });
        assert_eq!((tally.refused(), store.broken()), (None, 0));
        (found, [tally.found(), tally.computed()])
    }
}

fn all(plan: &Plan<'_>) -> Vec<Trial> {
    let mut found = Vec::new();
    crate::reuse::run(plan, &|| (), &mut |trial| {
        found.push(trial);
        Ok(())
    })
    .unwrap();
    found
}

fn plan(scenario: &Scenario) -> Plan<'_> {
    Plan::new(scenario, Tools::default(), PathBuf::new())
}

/// Scenes, coordinates that are drawn and adjusted, recognition with blocks, points that are kept and adjusted apart, hands without more.
fn scenarios() -> Vec<Scenario> {
    let keeps = SCENARIO.replacen("drawn = { \"forstner:window=9\" = 0 }", "keep_points = true", 1);
    let kept = parse("small/kept", "kept.toml", &keeps, &Registry::builtin()).unwrap_or_else(|problems| panic!("{problems}"));
    vec![scene(SCENE), scenario(&[("trials = 2", "trials = 35")]), coded(), pointed(), kept]
}

#[test]
fn trials_are_the_same_without_a_store_with_an_empty_one_and_with_a_full_one() {
    for scenario in scenarios() {
        let (kept, methods) = (Kept::new(), scenario.methods.len());
        let without = all(&plan(&scenario));
        assert_eq!(without.len() as u64, scenario.trials);
        for counts in [[0, methods], [methods, 0], [methods, 0]] {
            let (trials, counted) = kept.run(plan(&scenario));
            assert!(trials == without, "{}", scenario.name);
            assert_eq!(counted, counts, "{}", scenario.name);
        }
    }
}

/// Whichever methods are there already, alone or in another order.
#[test]
fn a_method_that_is_added_is_computed_alone_and_stands_in_its_place() {
    for scenario in scenarios() {
        let without = all(&plan(&scenario));
        for first in 0..scenario.methods.len() {
            let (kept, asked) = (Kept::new(), [first]);
            let (_, counted) = kept.run(Plan { asked: Some(&asked), ..plan(&scenario) });
            assert_eq!(counted, [0, 1]);
            let (trials, counted) = kept.run(plan(&scenario));
            assert_eq!(counted, [1, scenario.methods.len() - 1]);
            assert!(trials == without, "{} with {first} there", scenario.name);
        }
    }
    let text = SCENE.replacen("[[method]]\nname = \"forstner\"\nwindow = 9\n", "", 1);
    let (kept, fewer, more) = (Kept::new(), scene(&text), scene(SCENE));
    kept.run(plan(&fewer));
    let (trials, counted) = kept.run(plan(&more));
    assert!(trials == all(&plan(&more)) && counted == [2, 1], "{counted:?}");
}

#[test]
fn whatever_results_depend_on_is_another_result() {
    let kept = Kept::new();
    kept.run(plan(&scene(SCENE)));
    let computed = |scenario: &Scenario, seed: Option<u64>| {
        let own = plan(scenario);
        let seed = seed.unwrap_or(own.seed);
        kept.run(Plan { seed, ..own }).1[1]
    };
    for (old, new) in [
        ("seed = 5", "seed = 6"),
        ("trials = 40", "trials = 41"),
        ("grey_noise = 0.02", "grey_noise = 0.021"),
        ("blur = 0.7", "blur = 0.71"),
        ("sigma = 0.5", "sigma = 0.4"),
        ("grey = 0.8", "grey = 0.81"),
        ("seed = 5", "seed = 5\nbound_window = 13"),
    ] {
        assert_eq!(computed(&scene(&SCENE.replacen(old, new, 1)), None), 3, "{new}");
    }
    assert_eq!(computed(&scene(&SCENE.replacen("window = 9", "window = 11", 1)), None), 1);
    assert_eq!(computed(&scene(&SCENE.replacen("name = \"pixel\"", "name = \"pixel\"\nkinds = [\"corner\"]", 1)), None), 1);
    assert_eq!(computed(&scene(SCENE), Some(99)), 3, "another seed than the file's");
    let other = parse("small/other", "scene.toml", SCENE, &Registry::builtin()).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(computed(&other, None), 0, "a name has no part in it");
    let same = SCENE.replacen("blur = 0.7", "blur = 0.70 # px", 1).replacen("Corners in noise", "Why not", 1);
    assert_eq!(computed(&scene(&same), None), 0, "words and ways to write a number have no part in it");
}

#[test]
fn cells_that_differ_in_the_adjustment_alone_share_their_points() {
    let text = SCENARIO.replacen("drawn = { \"forstner:window=9\" = 0 }", "keep_points = true", 1);
    let other = text.replacen("sigma_px = 0.4", "sigma_px = 0.3", 1);
    let read = |text: &str| parse("small/kept", "kept.toml", text, &Registry::builtin()).unwrap_or_else(|problems| panic!("{problems}"));
    let (one, two, kept) = (read(&text), read(&other), Kept::new());
    kept.run(plan(&one));
    let first = kept.entries().len();
    let (trials, counted) = kept.run(plan(&two));
    assert!(trials == all(&plan(&two)) && trials != all(&plan(&one)));
    assert_eq!(
        (first, kept.entries().len(), counted),
        (6, 8, [0, 2]),
        "points, bounds and adjustments of two methods, then adjustments alone"
    );
}

/// The gate asks for no bounds, a report for them: points serve both, and bounds are added to those that are there.
#[test]
fn points_serve_with_bounds_and_without() {
    let bounded = |trials: &[Trial]| trials.iter().flat_map(|trial| &trial.points).filter(|point| point.bound.is_some()).count();
    let seen = pointed();
    for scenario in [&scene(SCENE), &seen] {
        let without = || Plan { bounds: false, ..plan(scenario) };
        let (with, plain) = (all(&plan(scenario)), all(&without()));
        assert!(bounded(&plain) == 0 && bounded(&with) > 0);
        let (kept, methods) = (Kept::new(), scenario.methods.len());
        for (counts, bounds) in [([0, methods], false), ([0, methods], true), ([methods, 0], true), ([methods, 0], false)] {
            let (trials, counted) = kept.run(if bounds { plan(scenario) } else { without() });
            assert!(trials == *if bounds { &with } else { &plain }, "{} {counts:?}", scenario.name);
            assert_eq!(counted, counts);
        }
        // Bounds that are there, of points that are not: as after a change of an operator.
        let bounds = Kept::new();
        bounds.run(plan(scenario));
        for path in without_bounds(scenario) {
            std::fs::remove_file(bounds.folder.path().join(path)).unwrap();
        }
        let (trials, counted) = bounds.run(plan(scenario));
        assert!(trials == with && counted == [0, methods], "{counted:?}");
    }
}

/// The entries of a run that asks for no bounds: those of points.
fn without_bounds(scenario: &Scenario) -> Vec<PathBuf> {
    let kept = Kept::new();
    kept.run(Plan { bounds: false, ..plan(scenario) });
    kept.entries()
}

/// Every entry with one bit changed: it is noticed, and done anew.
#[test]
fn a_corrupted_entry_is_done_anew() {
    let (scenario, kept) = (scene(SCENE), Kept::new());
    let (without, _) = kept.run(plan(&scenario));
    let entries = kept.entries();
    assert_eq!(entries.len(), 2 * 3, "points and bounds");
    for path in entries {
        let path = kept.folder.path().join(path);
        let mut bytes = std::fs::read(&path).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 4;
        std::fs::write(&path, bytes).unwrap();
        let (store, tally) = (kept.open(false), Tally::default());
        let trials = all(&Plan { reuse: Some(Reuse { store: &store, program: "p", tally: &tally }), ..plan(&scenario) });
        assert!(trials == without);
        assert_eq!((tally.found(), tally.computed(), store.broken()), (2, 1, 1));
    }
    let (store, tally) = (kept.open(true), Tally::default());
    all(&Plan { reuse: Some(Reuse { store: &store, program: "p", tally: &tally }), ..plan(&scenario) });
    assert_eq!(tally.computed(), 3, "a fresh one takes nothing");
}

/// A store that cannot be written costs nothing but itself, and is told.
#[test]
fn a_store_that_refuses_is_told() {
    let (scenario, parent) = (scene(SCENE), tempfile::tempdir().unwrap());
    let place = parent.path().join("file");
    std::fs::write(&place, "no folder").unwrap();
    let (store, tally) = (Store::open(&place, 1 << 20, false), Tally::default());
    let trials = all(&Plan { reuse: Some(Reuse { store: &store, program: "p", tally: &tally }), ..plan(&scenario) });
    assert!(trials == all(&plan(&scenario)) && tally.refused().is_some());
}

/// Of a method that took the name of one of the crates' own, or that is beside them, the program is the code.
#[test]
fn a_method_of_another_program_is_another_result() {
    let taken = |name: &'static str| {
        let method = Registry::builtin().methods().iter().find(|method| method.name == "pixel").unwrap().clone();
        Registry::builtin().with(Method { name, ..method })
    };
    for (registry, computed) in [(Registry::builtin(), 0), (taken("forstner_of_mine"), 1), (taken("pixel"), 1)] {
        let text = if computed == 1 && registry.has("forstner_of_mine") {
            SCENE.replacen("name = \"pixel\"", "name = \"forstner_of_mine\"", 1)
        } else {
            SCENE.to_owned()
        };
        let scenario = parse("small/scene", "scene.toml", &text, &registry).unwrap_or_else(|problems| panic!("{problems}"));
        let kept = Kept::new();
        let run = |program: &str| {
            let (store, tally) = (kept.open(false), Tally::default());
            all(&Plan { reuse: Some(Reuse { store: &store, program, tally: &tally }), ..plan(&scenario) });
            tally.computed()
        };
        assert_eq!([run("one"), run("one"), run("other")], [3, 0, computed]);
    }
}

#[test]
fn another_version_of_a_method_is_another_result() {
    let (kept, pixel) = (Kept::new(), Registry::builtin().methods().iter().find(|method| method.name == "pixel").unwrap().clone());
    let computed = |version: &str| {
        let registry = Registry::builtin().with(Method { version: version.into(), ..pixel.clone() });
        kept.run(plan(&parse("small/scene", "scene.toml", SCENE, &registry).unwrap_or_else(|problems| panic!("{problems}")))).1[1]
    };
    assert_eq!(["1", "1", "2", "1"].map(computed), [3, 0, 1, 0]);
}

/// The light of a still scene is rendered once, and noise is drawn in every trial; where rows move by themselves there is no such light.
#[test]
fn still_scenes_and_views_give_the_images_that_one_trial_alone_gives() {
    let still = SCENE.replacen("phase = \"uniform\"", "phase = \"fixed\"", 1);
    let jitter = still.replacen("grey_noise = 0.02\n", "", 1) + "\n[sensor]\ngrey_noise = 0.02\nrow_jitter = 0.3\n";
    let wall = SCENARIO.replacen("drawn = { \"forstner:window=9\" = 0 }", "keep_points = true", 1) + "\n[sensor]\ngrey_noise = 0.01\n";
    let moved = format!("{wall}row_jitter = 0.3\n");
    for text in [still, jitter, wall, moved] {
        let scenario =
            parse("small/still", "still.toml", &text, &Registry::builtin()).unwrap_or_else(|problems| panic!("{problems}\n{text}"));
        let together = all(&plan(&scenario));
        let alone = |number: u64| all(&Plan { only: Some(Span { from: number, to: number + 1 }), ..plan(&scenario) }).swap_remove(0);
        let one = alone(1);
        assert!(together[1] == one && together[0].points != one.points, "{text}");
        assert!(one.points.iter().any(|point| point.outcome.position().is_some()), "{text}");
    }
}

/// Of a program of others nobody knows when it changes: it is run whenever it is asked for, and everything is made of its points that is made of others.
#[test]
fn a_method_from_outside_is_always_computed() {
    let outside = || {
        let operator = Registry::builtin().parse("pixel").unwrap().operator;
        Ok(Outside { version: "9".into(), operator })
    };
    let method = Method {
        name: "theirs",
        about: "As pixel.",
        source: "a test",
        version: String::new(),
        parameters: &[],
        build: Build::Outside(Arc::new(move |_| outside())),
    };
    let registry = Registry::builtin().with(method);
    let keeps = SCENARIO.replacen("drawn = { \"forstner:window=9\" = 0 }", "keep_points = true", 1);
    for text in [format!("{keeps}\n[[method]]\nname = \"theirs\"\n"), format!("{SCENE}\n[[method]]\nname = \"theirs\"\n")] {
        let scenario = parse("small/theirs", "theirs.toml", &text, &registry).unwrap_or_else(|problems| panic!("{problems}"));
        let (kept, own) = (Kept::new(), scenario.methods.len() - 1);
        let without = all(&plan(&scenario));
        for counts in [[0, own + 1], [own, 1], [own, 1]] {
            let (trials, counted) = kept.run(plan(&scenario));
            assert!(trials == without, "{}", scenario.name);
            assert_eq!(counted, counts);
        }
    }
}
