//! Derivatives beside differences, and budgets beside measurements with drawn errors of every source.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::*;
use crate::scene::Scene;
use crate::{HALF_95, KnownCamera};

const QUANTITIES: [&str; 5] = [
    "length = [[-60, -20, 10], [55, 40, -30]]",
    "point = [30, -40, 20]",
    "angle = [[-60, -20, 10], [0, 50, 0], [55, 40, -30]]",
    "plane = [[-60, -20, 10], [55, 40, -30], [0, -70, 5], [-20, 60, 0]]",
    "rotation = [[-60, -20, 10], [55, 40, -30], [0, -70, 5], [-20, 60, 0]]",
];
const REST: &str =
    "[control]\nsigma = 0.08\nflatness_sigma = 0.05\n[temperature]\ndifference = 4\nsigma = 2\nexpansion = 2e-5\nexpansion_sigma = 2e-6\n";

fn known() -> NamedCamera {
    camera(&[("fx", 1.5), ("fy", 1.4), ("cx", 1.0), ("cy", 0.8), ("k1", 0.002)])
}

/// Every task of these tests: by its text, and whether control gives the poses.
fn tasks() -> Vec<(Task, bool)> {
    let pairs = QUANTITIES.iter().map(|what| format!("sigma = 0.15\nscale_sigma = 1e-4\n[measure]\n{what}\n{PAIR}{REST}"));
    let pairs: Vec<Task> = pairs.map(|text| task(&text)).collect();
    let oblique = DOWN.replace("[0, 0, 800]\nangles = [0, 0, 0]", "[200, 100, 700]\ntarget = [0, 0, 0]\nroll = 20") + REST;
    let stated = pairs.iter().map(|task| (task.clone(), false));
    let held = pairs.iter().map(|task| (task.clone(), true));
    stated.chain(held).chain([(task(&oblique), false), (task(&oblique), true)]).collect()
}

#[test]
fn derivatives_are_those_of_the_measurement() {
    const STEP: f64 = 1e-2;
    let (named, board) = (known(), board());
    let camera = KnownCamera { halves: Some(1.6), ..KnownCamera::of(&named) };
    for (task, has_control) in tasks() {
        let scene = Scene::new(&task, &camera, has_control.then_some(&board[..])).unwrap();
        let rows = scene.rows().unwrap();
        let mut z = vec![0.0; scene.count()];
        for column in 0..scene.count() {
            let mut at = |step: f64| {
                z[column] = step;
                let found = scene.simulated(&z).unwrap();
                z[column] = 0.0;
                found
            };
            let (high, low) = (at(STEP), at(-STEP));
            for row in 0..rows.nrows() {
                let by_difference = (high[row] - low[row]) / (2.0 * STEP);
                let scale = rows.row(row).norm();
                let off = (rows[(row, column)] - by_difference).abs() / scale;
                assert!(
                    off < 2e-6,
                    "{} {row} by {column} of {:?}: {} and {by_difference}",
                    task.quantity.word(),
                    scene.sources(),
                    rows[(row, column)]
                );
            }
        }
    }
}

/// Measurements with drawn errors of every source at once scatter as the budget says, and 95 in 100 of their intervals hold the truth.
#[test]
fn drawn_measurements_scatter_as_the_budget_says() {
    const DRAWS: usize = 1500;
    let (named, board) = (known(), board());
    let camera = KnownCamera { halves: Some(1.6), ..KnownCamera::of(&named) };
    let mut random = ChaCha8Rng::seed_from_u64(68);
    for (task, has_control) in tasks() {
        let control = has_control.then_some(&board[..]);
        let budget = Budget::of(&task, &camera, control).unwrap();
        assert!(!budget.is_bent(), "{budget:?}");
        let scene = Scene::new(&task, &camera, control).unwrap();
        let mut draw = || (0..scene.count()).map(|_| Distribution::<f64>::sample(&StandardNormal, &mut random)).collect::<Vec<_>>();
        let errors: Vec<Vec<f64>> = (0..DRAWS).map(|_| scene.simulated(&draw()).unwrap()).collect();
        for (place, component) in budget.components.iter().enumerate() {
            let scatter = (errors.iter().map(|error| error[place].powi(2)).sum::<f64>() / DRAWS as f64).sqrt();
            near(scatter, component.sigma, 4.5 / (2.0 * DRAWS as f64).sqrt());
            let held = errors.iter().filter(|error| error[place].abs() <= HALF_95 * component.sigma).count() as f64 / DRAWS as f64;
            assert!((held - 0.95).abs() < 4.5 * (0.95 * 0.05 / DRAWS as f64).sqrt(), "{} {held}", task.quantity.word());
        }
    }
}
