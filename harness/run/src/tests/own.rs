//! The project's own scenarios, changed.

use std::path::{Path, PathBuf};

use calibench_measure::Registry;
use calibench_records::figures::Quantity;
use calibench_records::results::{Figure, Trial, find};
use calibench_scenario::{Scenario, parse};

/// `scenarios/NAME.toml`, changed.
pub fn scenario(name: &str, changes: &[(&str, &str)]) -> Scenario {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(format!("{name}.toml"));
    let mut text = std::fs::read_to_string(&path).unwrap();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    parse(name, &path.display().to_string(), &text, &Registry::builtin()).unwrap_or_else(|error| panic!("{error}"))
}

/// Of the first method.
pub fn figures(trial: &Trial) -> &[Figure] {
    trial.calibrations[0].outcome.as_ref().unwrap_or_else(|why| panic!("trial {}: {why}", trial.number))
}

/// Of the first method, one of its figures.
pub fn value(trial: &Trial, quantity: Quantity) -> f64 {
    find(figures(trial), quantity).unwrap_or_else(|| panic!("{quantity:?}: {:?}", figures(trial))).value
}

/// Whether a family is there: a package of the crate is without.
pub fn there(family: &str) -> bool {
    let there = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(family).is_dir();
    if !there {
        println!("scenarios/{family} are not there");
    }
    there
}
