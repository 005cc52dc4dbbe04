//! Errors of check points and their root mean squares.

use calibench_records::figures::Quantity;
use calibench_records::results::Figure;
use calibench_scenario::Printed;
use nalgebra::Vector3;

use crate::rmse::Rmse;

/// Root mean squares of errors: by axis, in the plane of X and Y (2D), in space; object units.
pub fn root_mean_squares(errors: &[Vector3<f64>]) -> [f64; 5] {
    let Rmse { axes: [x, y, z], planimetric, spatial } = Rmse::of(errors.iter().copied());
    [x, y, z, planimetric, spatial]
}

/// Those of printed errors.
const PRINTED: [Quantity; 5] =
    [Quantity::PrintedX, Quantity::PrintedY, Quantity::PrintedZ, Quantity::PrintedPlanimetric, Quantity::PrintedSpatial];

/// Those of the printed errors of a column.
pub fn recomputed(printed: &Printed, column: usize) -> Vec<Figure> {
    let errors: Vec<Vector3<f64>> = printed.points.iter().map(|point| point.errors[column].into()).collect();
    if errors.is_empty() {
        return Vec::new();
    }
    let unit = printed.unit.name();
    let values = PRINTED.into_iter().zip(root_mean_squares(&errors));
    values.map(|(quantity, value)| Figure::plain(quantity.of(&[unit]), value, unit)).collect()
}
