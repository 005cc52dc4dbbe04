//! Directions in which the normal equations are singular, or so nearly that the result has no sense.

use calibench_model::camera::CameraModel;
use nalgebra::{DMatrix, SymmetricEigen, Vector3};

use super::defect::{Defect, Direction};
use super::geometry::reasons;
use super::names::participants;
use crate::normal::{Normals, Step};
use crate::solve::{Eliminated, Engine, Schur};
use crate::state::State;

/// An eigenvalue of the scaled normal equations that is rounding.
const SINGULAR: f64 = 1e-11;
/// One at which the result is asked whether it has any sense.
const WEAK: f64 = 1e-6;
/// A standard deviation of a rotation (radians), or of a principal distance or a distance relative to itself, beyond which linear theory says nothing.
const SENSELESS: f64 = 0.5;
/// Directions that are described.
const MOST: usize = 12;

/// A direction, and what an eigenvalue says of it.
struct Found {
    step: Step,
    eigenvalue: f64,
}

/// What `state` leaves undetermined: singular to rounding, if `sigma0` is not given; or so weak that its standard deviation has no sense.
pub(crate) fn directions(engine: &Engine, state: &State, normals: &Normals, sigma0: f64) -> Option<Defect> {
    let mut found = members(engine, normals);
    if found.is_empty() {
        found = kept(engine, normals, state, sigma0);
    }
    if found.is_empty() {
        return None;
    }
    let name = |found: &Found| Direction {
        unknowns: participants(engine.network, &engine.layout, state, normals, &found.step),
        eigenvalue: found.eigenvalue,
    };
    let directions = found.iter().take(MOST).map(name).collect();
    Some(Defect::Directions { directions, reasons: reasons(&engine.layout, state) })
}

/// Eliminated blocks that are singular by themselves.
fn members(engine: &Engine, normals: &Normals) -> Vec<Found> {
    let (plan, mut found) = (&engine.plan, Vec::new());
    for &member in &plan.members {
        let depth = plan.depth();
        let block: &[f64] = match plan.eliminated {
            Eliminated::Poses => &normals.pose[member],
            Eliminated::Points => &normals.point[member],
        };
        let scale: Vec<f64> = (0..depth).map(|i| root(block[i * (depth + 1)])).collect();
        let eigen = SymmetricEigen::new(DMatrix::from_fn(depth, depth, |i, j| block[i * depth + j] / (scale[i] * scale[j])));
        for k in (0..depth).filter(|&k| eigen.eigenvalues[k] < SINGULAR) {
            let mut step = engine.zero_step();
            let values = (0..depth).map(|i| eigen.eigenvectors[(i, k)] / scale[i]);
            match plan.eliminated {
                Eliminated::Poses => values.enumerate().for_each(|(i, value)| step.poses[member][i] = value),
                Eliminated::Points => values.enumerate().for_each(|(i, value)| step.points[member][i] = value),
            }
            found.push(Found { step, eigenvalue: eigen.eigenvalues[k].max(0.0) });
        }
    }
    found
}

/// Singular or senseless directions of what is kept.
fn kept(engine: &Engine, normals: &Normals, state: &State, sigma0: f64) -> Vec<Found> {
    let Some((schur, pairs)) = engine.weakest(normals) else { return Vec::new() };
    let found = |(eigenvalue, kept): (f64, Vec<f64>)| {
        let (step, eigenvalue) = (whole(engine, &schur, &kept), eigenvalue.max(0.0));
        let deviation = sigma0 / eigenvalue.max(f64::MIN_POSITIVE).sqrt();
        (eigenvalue < SINGULAR || senseless(engine, state, &step, deviation)).then_some(Found { step, eigenvalue })
    };
    pairs.into_iter().take_while(|(eigenvalue, _)| *eigenvalue < WEAK).filter_map(found).collect()
}

/// A direction of all unknowns from that of those that are kept.
fn whole(engine: &Engine, schur: &Schur, kept: &[f64]) -> Step {
    let mut step = engine.zero_step();
    schur.follow(&engine.plan, &engine.layout, kept, &mut step);
    step
}

/// Does `step`, times a standard deviation, leave the range in which a linear estimate of precision holds?
fn senseless(engine: &Engine, state: &State, step: &Step, deviation: f64) -> bool {
    let distance = |camera: usize, parameter: usize| {
        let parameters = state.cameras[camera].parameters();
        matches!(parameters[parameter].name, "c" | "f" | "F" | "fx" | "fy").then(|| parameters[parameter].value.abs())
    };
    let camera =
        engine.layout.cameras.iter().enumerate().any(|(i, place)| {
            place.free.iter().enumerate().any(|(k, &parameter)| {
                distance(i, parameter).is_some_and(|c| step.cameras[place.offset + k].abs() * deviation > SENSELESS * c)
            })
        });
    camera
        || engine.layout.of_image.iter().enumerate().any(|(i, range)| {
            let Some(sight) = engine.layout.sights.get(range.start).filter(|_| !range.is_empty()) else { return false };
            let reach = (state.points[sight.point] - state.poses[i].centre).norm();
            let [a, b, c, x, y, z] = step.poses[i];
            let (turn, shift) = (Vector3::new(a, b, c).norm(), Vector3::new(x, y, z).norm());
            turn * deviation > SENSELESS || shift * deviation > SENSELESS * reach
        })
}

fn root(value: f64) -> f64 {
    if value > 0.0 { value.sqrt() } else { 1.0 }
}
