//! What is said of an oriented pair.

use calibench_calibrate::orientation::Pair;
use calibench_exchange::station_numbers;

use crate::plain;

/// Thickness of the model, relative to its largest extent, below which it is called a plane.
const FLAT: f64 = 0.01;
/// A median angle between the rays below which the model is weak, degrees.
const SMALL_ANGLE: f64 = 2.0;
/// Correlations beyond this are flagged.
const CORRELATED: f64 = 0.9;
const ELEMENTS: [&str; 5] =
    ["rotation about x", "rotation about y", "rotation about z", "base across (first axis)", "base across (second axis)"];

/// The elements with their standard deviations, sigma0 and redundancy.
pub fn summary(pair: &Pair, [left, right]: [&str; 2]) -> String {
    let (found, sigmas) = (&pair.found, pair.sigmas());
    let numbers = station_numbers(&pair.pose(&found.pose));
    let value = |name: &str, i: usize| {
        let sigma = if i < 3 { sigmas[i] } else { sigmas[i].to_degrees() };
        format!("  {name} {:.6}, sigma {}\n", numbers[i], plain(sigma))
    };
    let used = found.residuals.len() - found.rejected.len();
    let mut text = format!(
        "orient: {right} in the axes of {left}: {used} of {} common targets, redundancy {}, sigma0 {} px; base {}\n",
        found.residuals.len(),
        found.redundancy,
        plain(found.sigma0),
        pair.base
    );
    ["X0", "Y0", "Z0"].iter().enumerate().for_each(|(i, name)| text.push_str(&value(name, i)));
    text.push_str(&format!("  omega {:.6}, phi {:.6}, kappa {:.6} degrees; ", numbers[3], numbers[4], numbers[5]));
    let turns = [3, 4, 5].map(|i| plain(sigmas[i].to_degrees()));
    text.push_str(&format!("sigmas about the right camera's x, y, z: {} degrees\n", turns.join(", ")));
    text
}

/// What makes the orientation doubtful.
pub fn warnings(pair: &Pair) -> Vec<String> {
    let found = &pair.found;
    let mut warnings = Vec::new();
    let flat = pair.thickness().filter(|share| *share < FLAT);
    if let Some(share) = flat {
        warnings.push(format!("the model is nearly a plane ({} of its extent thick): planes allow two orientations", plain(share)));
    }
    if let Some(rival) = &found.rival {
        let numbers = station_numbers(&pair.pose(rival)).map(|number| format!("{number:.5}")).join(", ");
        let why = if flat.is_some() { "the points lie in a plane" } else { "the points lie on or near a critical surface, or are few" };
        warnings.push(format!("another orientation fits as well, X0, Y0, Z0, omega, phi, kappa = {numbers}: {why}"));
    }
    if let Some(angle) = pair.median_angle().map(f64::to_degrees).filter(|angle| *angle < SMALL_ANGLE) {
        warnings.push(format!("rays meet at {} degrees (median): the base is short for the distance, depths are weak", plain(angle)));
    }
    for (i, j) in (0..5).flat_map(|i| (0..i).map(move |j| (i, j))).filter(|&(i, j)| pair.correlation(i, j).abs() > CORRELATED) {
        warnings.push(format!("{} and {} are hardly told apart: correlation {:.3}", ELEMENTS[j], ELEMENTS[i], pair.correlation(i, j)));
    }
    let parallel = pair.targets.len() - pair.points().count() - found.rejected.len();
    let without = [(found.rejected.len(), "were rejected"), (parallel, "take no part")];
    let without: Vec<String> =
        without.iter().filter(|(count, _)| *count > 0).map(|(count, how)| format!("{count} targets {how}")).collect();
    if !without.is_empty() {
        warnings.push(format!("{}: the point table says why", without.join(", ")));
    }
    warnings
}
