//! Errors of check points and their root mean squares.

use calibench_records::results::{Figure, Group};
use calibench_scenario::Printed;
use nalgebra::Vector3;

use super::with_unit;
use crate::rmse::Rmse;

/// The axes of object space.
pub const AXES: [&str; 3] = ["X", "Y", "Z"];

/// Root mean squares of errors: by axis, in the plane of X and Y (2D), in space; object units.
pub fn root_mean_squares(errors: &[Vector3<f64>]) -> [(&'static str, f64); 5] {
    let Rmse { axes: [x, y, z], planimetric, spatial } = Rmse::of(errors.iter().copied());
    [("RMSE X", x), ("RMSE Y", y), ("RMSE Z", z), ("planimetric RMSE", planimetric), ("spatial RMSE", spatial)]
}

/// Those of the printed errors of a column.
pub fn recomputed(printed: &Printed, column: usize) -> Vec<Figure> {
    let errors: Vec<Vector3<f64>> = printed.points.iter().map(|point| point.errors[column].into()).collect();
    if errors.is_empty() {
        return Vec::new();
    }
    let unit = printed.unit.name();
    root_mean_squares(&errors).map(|(name, value)| Figure::plain(Group::Check, with_unit(name, unit), value, unit)).into()
}
