//! Tests of the whole gate.

mod cells;
mod files;
mod findings;
mod judged;

use calibench_model::{PixelPoint, Rejection};
use calibench_records::results::{MethodInfo, Outcome, PointResult, Trial};

use super::{Coordinates, Table};

pub(super) fn info(label: &str, version: &str) -> MethodInfo {
    MethodInfo { label: label.into(), version: version.into(), unavailable: None }
}

pub(super) fn point(method: usize, target: &str, error: [f64; 2]) -> PointResult {
    let position = PixelPoint::new(10.0 + error[0], 20.0 + error[1]);
    let outcome = Outcome::Measured { position, error: Some((error[0], error[1])) };
    PointResult::new("image", target, method, outcome)
}

pub(super) fn rejected(method: usize, target: &str) -> PointResult {
    PointResult { outcome: Outcome::Rejected(Rejection::NoCorner), ..point(method, target, [0.0; 2]) }
}

/// A table of scenario `f/s` with seed 7.
pub(super) fn table(coordinates: Coordinates, methods: &[MethodInfo], trials: &[Vec<PointResult>]) -> Table {
    let mut table = Table::new("f/s", 7, coordinates, methods);
    for (number, points) in trials.iter().enumerate() {
        table.add(&Trial { number: number as u64, points: points.clone(), ..Trial::default() });
    }
    table
}
