//! Tests of the whole gate.

mod baselines;
mod cells;
mod check;
mod files;
mod findings;
mod judged;
mod kept;
mod points;
mod printed;

use calibench_model::{PixelPoint, Rejection};
use calibench_records::results::{MethodInfo, Outcome, PointResult, Trial};

use super::{Coordinates, Entry, Found, MethodTable, Place, Table};

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

/// A point that was measured, with the standard deviation that was reported.
pub(super) fn measured(at: [f64; 2], sigma: Option<f64>) -> Entry {
    Entry::Measured(Found { at, sigma })
}

/// A point that was found and is lost.
pub(super) fn lost(at: [f64; 2]) -> Entry {
    Entry::Lost(Found::bare(at))
}

/// A point that was rejected.
pub(super) const NO_CORNER: Entry = Entry::Rejected(Rejection::NoCorner);

/// Points of the view `image` by trial and target.
pub(super) fn method(points: impl IntoIterator<Item = (u64, &'static str, Entry)>) -> MethodTable {
    let mut method = MethodTable::new("1".into());
    method.points = points.into_iter().map(|(trial, target, entry)| (at(trial, target), entry)).collect();
    method
}

/// The place of a target in the view `image`.
pub(super) fn at(trial: u64, target: &str) -> Place {
    Place { trial, view: "image".into(), target: target.into() }
}

/// A table of scenario `f/s` with seed 7 that holds `method` as `m`.
pub(super) fn holding(coordinates: Coordinates, method: MethodTable) -> Table {
    let mut table = Table::new("f/s", 7, coordinates, &[]);
    *table.method_mut(&"m".into(), &"1".into()) = method;
    table
}
