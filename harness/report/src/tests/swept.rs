//! A small sweep.

use std::collections::BTreeMap;
use std::path::PathBuf;

use calibench_records::description::{self, Axis, Description, Study, Sweep, Value};
use calibench_records::score::{Errors, Score};

use crate::load::sweep::{LoadedCell, LoadedMethod};
use crate::sweep::LoadedSweep;

/// Measured and missed points of a method in a cell, each with one error a trial.
pub fn score(trials: &[(f64, f64)], lost: u64) -> Score {
    let mut whole = Errors::default();
    trials.iter().for_each(|error| whole.add(&[*error]));
    Score { measured: trials.len() as u64, lost, whole, ..Score::default() }
}

/// Blur 0.5 and 2 by noise 0 and 0.1; nothing was measured in the last cell.
pub fn loaded() -> LoadedSweep {
    let axis = |path: &str, numbers: [f64; 2]| Axis {
        path: path.into(),
        name: path.rsplit('.').next().unwrap().into(),
        values: numbers.map(|number| Value { text: number.to_string(), number: Some(number) }).to_vec(),
        log: false,
    };
    let cells = [[0, 0], [0, 1], [1, 0], [1, 1]].map(|places| description::Cell { label: String::new(), places: places.to_vec() });
    let scenario = Description {
        why: String::new(),
        source: String::new(),
        notes: Vec::new(),
        seed: 1,
        trials: 2,
        bound_window: 11,
        bound_window_discs: None,
        finders: Vec::new(),
        methods: Vec::new(),
        defaults: BTreeMap::new(),
        study: Study::Scene,
        sweep: None,
    };
    let other = score(&[(9.0, 9.0)], 0);
    let found = [score(&[(1.0, 2.0), (3.0, 4.0)], 6), score(&[(0.5, 0.0)], 0), score(&[(0.0, -0.25)], 1), Score::default()];
    let method = |name: &str| LoadedMethod { name: name.into(), version: "1".into(), unavailable: None };
    LoadedSweep {
        name: "s".into(),
        scenario,
        sweep: Sweep { axes: vec![axis("optics.blur", [0.5, 2.0]), axis("noise", [0.0, 0.1])], cells: cells.to_vec() },
        methods: vec![method("other"), method("m")],
        cells: found.into_iter().map(|score| LoadedCell { scores: vec![other.clone(), score], trials: 2 }).collect(),
        seed: 1,
        folder: PathBuf::new(),
    }
}
