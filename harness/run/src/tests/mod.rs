//! Runs of a small wall whose figures have closed forms.

mod accepted;
mod blocks;
mod boards;
mod drawn;
mod example;
mod kinds;
mod network;
mod networks;
mod own;
mod recordings;
mod reuse;
mod second_solver;
mod stations;
mod store;
mod tasks;
mod truth;
mod views;

use std::path::PathBuf;

use calibench_measure::Registry;
use calibench_random::Key;
use calibench_records::results::{Outcome, Trial};
use calibench_scenario::{Scenario, Subject, ViewsSubject, parse};

use crate::Plan;

const NAME: &str = "small/wall";
const KEY: Key<'_> = Key { seed: 3, of: NAME, trial: 0, view: "", target: "" };

/// A wall of 12 corners in the plane Z = 0, m, seen by a camera of c = 10 mm and 5 um: 2000 px per unit of slope. Its first station stands on the Z
/// axis, 6 m off. Coordinates are drawn from the truth; `exact` has no error.
const SCENARIO: &str = r#"
why = "A wall."
source = "ours"
seed = 3
trials = 2

[camera]
size = [1000, 801]
pitch = 5.0
c = 10.0

[testfield]
kind = "wall"
unit = "m"

[[testfield.plate]]
id = "w"
middle = [0, 0, 0]
right = [1, 0, 0]
up = [0, 1, 0]
width = 1.6
height = 1.4

[testfield.fill]
kinds = ["corner"]
size = 0.06
rows = 4
columns = 3

[[station]]
name = "front"
at = [0, 0, 6]
towards = [0, 0, 0]

[[station]]
name = "left"
at = [-3.5, 0.3, 4.5]
towards = [0, 0.05, 0]
roll = 90

[[station]]
name = "right"
at = [3.4, -0.2, 4.6]
towards = [0.05, 0, 0]
roll = 180

[[station]]
name = "top"
at = [0.3, 3.2, 4.8]
towards = [0, 0, 0]
roll = -90

[pointing]
sigma = 0.4
whole_pixels = false

[calibration]
sets = ["c,x0,y0", "c"]
start_c = 9.8
sigma_px = 0.4
control_sigma = 0.0005
drawn = { "forstner:window=9" = 0 }

[calibration.check]
views = ["front", "left", "right"]
control = ["w/1", "w/3", "w/5", "w/10", "w/12"]
points = ["w/2", "w/4", "w/6", "w/7", "w/8", "w/9", "w/11"]

[[method]]
name = "pixel"

[[method]]
name = "forstner"
window = 9
"#;

/// The place of the method without error.
const EXACT: usize = 1;

fn scenario(changes: &[(&str, &str)]) -> Scenario {
    changed(SCENARIO, changes)
}

/// The scenario that `text` describes with each of `changes`.
fn changed(text: &str, changes: &[(&str, &str)]) -> Scenario {
    let mut text = text.to_owned();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    parse(NAME, "wall.toml", &text, &Registry::builtin()).unwrap_or_else(|problems| panic!("{problems}"))
}

fn views(scenario: &Scenario) -> &ViewsSubject {
    let Subject::Views(views) = &scenario.subject else { panic!("a scenario of views") };
    views
}

fn trials(scenario: &Scenario, seed: u64) -> Vec<Trial> {
    let mut plan = Plan::new(scenario, crate::Tools::default(), PathBuf::new());
    plan.seed = seed;
    let mut found = Vec::new();
    plan.run(&|| (), &mut |trial| {
        found.push(trial);
        Ok(())
    })
    .unwrap();
    found
}

#[test]
fn trials_come_in_their_order_and_steps_are_counted() {
    let scenario = scenario(&[("trials = 2", "trials = 40")]);
    let plan = Plan::new(&scenario, crate::Tools::default(), PathBuf::new());
    let steps = std::sync::atomic::AtomicU64::new(0);
    let mut numbers = Vec::new();
    let count = || {
        steps.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    plan.run(&count, &mut |trial| {
        numbers.push(trial.number);
        Ok(())
    })
    .unwrap();
    assert_eq!(numbers, (0..40).collect::<Vec<u64>>());
    assert_eq!((steps.into_inner(), plan.steps()), (40, 40));
}

/// The error of a point that was measured, however large.
fn error(outcome: &Outcome) -> (f64, f64) {
    let Outcome::Measured { error: Some(error), .. } = outcome else { panic!("{outcome:?}") };
    *error
}

/// What is drawn depends on the seed, what is pictured, the trial, the view and the target, and on nothing else.
#[test]
fn the_seed_makes_the_noise() {
    let scenario = scenario(&[]);
    let (a, again, other) = (trials(&scenario, 3), trials(&scenario, 3), trials(&scenario, 4));
    assert_eq!(a, again);
    assert_ne!(a[0].points, other[0].points);
    let errors = |trial: &Trial, method: usize| {
        let points = trial.points.iter().filter(|point| point.method == method);
        points.map(|point| error(&point.outcome)).collect::<Vec<_>>()
    };
    let exact = errors(&a[0], EXACT);
    assert_eq!(exact.len(), 4 * 12, "every target is in every image");
    assert!(exact.iter().all(|error| *error == (0.0, 0.0)));
    // 96 coordinates of sigma 0.4: the root mean square lies within three of its standard deviations.
    let hand = errors(&a[0], 0);
    let rms = (hand.iter().map(|(x, y)| x * x + y * y).sum::<f64>() / 96.0).sqrt();
    assert!((rms / 0.4 - 1.0).abs() < 3.0 / (2.0_f64 * 96.0).sqrt(), "{rms}");
    assert!(a[1].points.is_empty(), "points of later trials are not kept");
    assert_eq!(a[1].calibrations.len(), 2 * 2, "two methods, two sets");
}

#[test]
fn a_sink_that_fails_ends_the_run() {
    let scenario = scenario(&[]);
    let plan = Plan::new(&scenario, crate::Tools::default(), PathBuf::new());
    let error = plan.run(&|| (), &mut |_| Err(std::io::Error::other("the disk is full").into())).unwrap_err();
    assert_eq!(error.to_string(), "the disk is full");
}
