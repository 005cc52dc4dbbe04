//! What the report says of Vosselman & Förstner: what measuring makes of the testfield's bend.

use calibench_measure::Registry;
use calibench_records::results::{Calibrated, Outcome, PointResult};
use calibench_run::{Plan, Tools};
use calibench_scenario::{Scenario, parse};

use crate::paper::typed::assert_says;

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

/// Of Table 5 the targets that each image and each pair shows, of Table 4 how much better large ones are.
#[test]
fn what_is_computed_of_print_is_what_the_report_says() {
    // 4 n + p + 4 = 1199 and 4 n - 2 p - 8 = 420.
    let p = (1199.0 - 4.0 - 420.0 - 8.0) / 3.0;
    let n = (1199.0 - 4.0 - p) / 4.0;
    assert_says("vosselman-1988", "table-5", &format!("n = {n:.1} and p = {p:.1}"));
    let ratios = [(0.040, 0.034), (0.056, 0.050), (0.044, 0.030), (0.041, 0.033)].map(|(small, large)| small / large);
    assert_says("vosselman-1988", "table-4-ratios", &format!("Table 4's own mean is {:.2}", ratios.iter().sum::<f64>() / 4.0));
}

/// Root mean square residual of the images of a block whose names begin so, px, from the gate's baseline; blocks are numbered from 1 as in the scenario.
fn residuals(block: usize, images: &str) -> f64 {
    let path = crate::project::root().join("reference/baselines/vosselman-1988--campaign.figures.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let mut labels = text.lines().filter_map(|line| line.strip_prefix("# label = "));
    let method = 1 + labels.position(|label| label == "\"lsm:window=13,neighbours=counted\"").unwrap();
    let start = format!("1,{method},{block},residual,{images}");
    let squares: Vec<f64> = text
        .lines()
        .filter_map(|line| line.strip_prefix(&start))
        .map(|line| line.split(',').skip(2).take(2).map(|field| field.parse::<f64>().unwrap().powi(2)).sum())
        .collect();
    assert_eq!(squares.len(), 16, "{start}");
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// As in the paper, residuals with one set of parameters are larger at 45 degrees; sets of each group take that up.
#[test]
fn first_residuals_are_what_the_report_says() {
    let [one, eight] = [2, 3].map(|block| ["13", "12"].map(|images| residuals(block, images)));
    let said = |what: String| assert_says("vosselman-1988", "text", &what);
    said(format!("`one set` they are {:.3} px at 45 and {:.3} px at 30 degrees", one[0], one[1]));
    said(format!("and {:.3} and {:.3} px with eight sets", eight[0], eight[1]));
    assert!(one[0] > 1.2 * one[1] && eight[0] < 0.7 * one[0]);
}
