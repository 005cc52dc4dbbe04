//! A board that is bent.

use calibench_model::{Bend, Plate, Testfield};
use calibench_scenario::studies::transfer::Board;
use nalgebra::Point3;

/// The corners of a board whose middle is higher by `peak` than its outermost corners along its longer side.
pub(super) fn bent(board: &Board, peak: f64) -> Vec<Point3<f64>> {
    let plate = bent_plate(&board.field, peak);
    board.field.targets.iter().map(|target| plate.point(target.at)).collect()
}

/// The board's sheet, bent so.
pub(super) fn bent_plate(field: &Testfield, peak: f64) -> Plate {
    let ends = |axis: usize| {
        let along = field.targets.iter().map(|target| target.at[axis]);
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)))
    };
    let [(u0, u1), (v0, v1)] = [ends(0), ends(1)];
    let across = if u1 - u0 >= v1 - v0 { 0.0 } else { std::f64::consts::FRAC_PI_2 };
    let reach = 0.5 * (u1 - u0).max(v1 - v0);
    let bend = Some(Bend { peak, middle: [0.5 * (u0 + u1), 0.5 * (v0 + v1)], across, reach, along: 0.0 });
    Plate { bend, ..field.plates[0].clone() }
}
