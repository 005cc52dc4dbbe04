//! Errors of check points and their root mean squares.

use calibench_records::results::{Figure, Group};
use calibench_scenario::Printed;
use nalgebra::Vector3;

use super::with_unit;

/// The axes of object space.
pub const AXES: [&str; 3] = ["X", "Y", "Z"];

/// Root mean squares of errors: by axis, in the plane of X and Y (2D), in space; object units.
pub fn root_mean_squares(errors: &[Vector3<f64>]) -> [(&'static str, f64); 5] {
    let mean = |of: &dyn Fn(&Vector3<f64>) -> f64| (errors.iter().map(of).sum::<f64>() / errors.len() as f64).sqrt();
    [
        ("RMSE X", mean(&|e| e.x * e.x)),
        ("RMSE Y", mean(&|e| e.y * e.y)),
        ("RMSE Z", mean(&|e| e.z * e.z)),
        ("planimetric RMSE", mean(&|e| e.x * e.x + e.y * e.y)),
        ("spatial RMSE", mean(&|e| e.norm_squared())),
    ]
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
