//! What the report says of Vosselman & Förstner: what measuring makes of the testfield's bend.

use calibench_measure::Registry;
use calibench_records::results::{Calibrated, Outcome, PointResult};
use calibench_run::{Plan, Tools};
use calibench_scenario::{Scenario, parse};

/// A scenario of the paper, of one trial, and what it gives: points and blocks.
fn first_trial(name: &str) -> (Scenario, Vec<PointResult>, Vec<Calibrated>) {
    let path = crate::project::root().join(format!("scenarios/vosselman-1988/{name}.toml"));
    let text = std::fs::read_to_string(path).unwrap().replace("trials = 2\n", "trials = 1\n");
    let scenario = parse(&format!("vosselman-1988/{name}"), "test.toml", &text, &Registry::builtin()).unwrap();
    let mut trials = Vec::new();
    Plan::new(&scenario, Tools::default(), std::path::PathBuf::new())
        .run(&|| (), &mut |trial| {
            trials.push(trial);
            Ok(())
        })
        .unwrap();
    let first = trials.swap_remove(0);
    (scenario, first.points, first.calibrations)
}

/// The bend along X of the block `discs`, mm: of true places, of matching over the whole window, with a blur that is held, and without what stands beside.
fn bends(name: &str) -> [f64; 4] {
    let (scenario, points, blocks) = first_trial(name);
    // Matching over the window, the first three methods, loses no large target.
    let mut large = points.iter().filter(|point| point.method < 3 && point.target.contains("-large-"));
    assert!(large.all(|point| matches!(point.outcome, Outcome::Measured { .. })), "{name}");
    let labels = ["pixel", "lsm:window=13,neighbours=counted", "lsm:window=13,sharpness=held", "lsm:window=13,kinds"];
    labels.map(|label| {
        let method = scenario.methods.iter().position(|method| method.label.starts_with(label)).unwrap();
        let block = blocks.iter().find(|block| block.method == method && block.set == 0).unwrap();
        block.outcome.as_ref().unwrap().iter().find(|figure| figure.name.text() == "bend along X").unwrap().value
    })
}

/// A whole window makes a flat field bend by what stands in it beside the targets, and a bent one by as much; nothing else of the bend is lost.
#[test]
fn neighbours_in_the_window_bend_the_field() {
    let (flat, bent) = (bends("flat"), bends("bend"));
    let close = |value: f64, expected: f64, by: f64| assert!((value - expected).abs() < by, "{value}: {flat:?} {bent:?}");
    close(flat[0], 0.0, 1e-6);
    close(bent[0], 0.8, 1e-4);
    for (method, own) in [(1, -0.010), (2, -0.022), (3, 0.004)] {
        close(flat[method], own, 0.003);
        close(bent[method] - flat[method], 0.8, 0.01);
    }
}
