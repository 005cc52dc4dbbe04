//! Directions in which the normal equations are singular, or so nearly that the result has no sense.

use calibench_model::camera::CameraModel;
use nalgebra::{DMatrix, SymmetricEigen, Vector3};

use super::geometry::reasons;
use super::names::{cameras, participants};
use crate::defect::{Defect, Direction};
use crate::normal::Normals;
use crate::solve::{Eliminated, Engine, Schur, Solved};
use crate::state::{State, Step};

/// An eigenvalue of the scaled normal equations that is rounding.
const SINGULAR: f64 = 1e-11;
/// One at which the result is asked whether it has any sense; where one direction has none, all below go with it.
const WEAK: f64 = 1e-6;
/// A standard deviation of a rotation (radians), or of a principal distance or a distance relative to itself, beyond which linear theory says nothing.
const SENSELESS: f64 = 0.5;
/// Part of the largest effect of an interior parameter below which the rest of the directions has none.
const MIXED: f64 = 1e-3;
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
    separate(engine, normals, &mut found);
    let name = |found: &Found| Direction {
        unknowns: participants(engine.network, &engine.layout, state, normals, &found.step),
        eigenvalue: found.eigenvalue,
    };
    let mut directions: Vec<Direction> = Vec::new();
    for direction in found.iter().take(MOST).map(name) {
        if directions.iter().all(|known| known.unknowns != direction.unknowns) {
            directions.push(direction);
        }
    }
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
        // Each is as large as all unknowns together.
        if found.len() >= MOST {
            break;
        }
    }
    found
}

/// Singular or senseless directions of what is kept.
fn kept(engine: &Engine, normals: &Normals, state: &State, sigma0: f64) -> Vec<Found> {
    let Some((schur, pairs)) = engine.weakest(state, normals) else { return Vec::new() };
    let weak = pairs.into_iter().take_while(|(eigenvalue, _)| *eigenvalue < WEAK);
    let mut weak: Vec<Found> =
        weak.map(|(value, kept)| Found { step: whole(engine, (state, normals), &schur, &kept), eigenvalue: value.max(0.0) }).collect();
    let lost = |found: &Found| {
        let deviation = sigma0 / found.eigenvalue.max(f64::MIN_POSITIVE).sqrt();
        found.eigenvalue < SINGULAR || senseless(engine, state, &found.step, deviation)
    };
    // Noise decides which of several weak directions is past the bound, and how they mix: they go together.
    if !weak.iter().any(lost) {
        weak.clear();
    }
    weak
}

/// Makes of the directions others of the same space that do not mix: each changes one interior parameter that the others leave alone, as far as there are
/// such parameters. Eigenvectors of nearly the same eigenvalue are any mixture, which noise chooses.
fn separate(engine: &Engine, normals: &Normals, found: &mut [Found]) {
    for row in 0..found.len() {
        let effects = |found: &Found| cameras(&engine.layout, normals, &found.step).concat();
        let rest = found[row..].iter().enumerate().flat_map(|(i, found)| {
            let effects = effects(found);
            (0..effects.len()).map(|k| (effects[k], row + i, k)).collect::<Vec<_>>()
        });
        let Some((effect, pivot, column)) = rest.max_by(|a, b| a.0.total_cmp(&b.0)) else { return };
        let largest = found.iter().flat_map(effects).fold(0.0, f64::max);
        if effect <= MIXED * largest {
            return;
        }
        found.swap(row, pivot);
        for other in (0..found.len()).filter(|&other| other != row) {
            let share = found[other].step.cameras[column] / found[row].step.cameras[column];
            let taken = found[row].step.clone();
            subtract(&mut found[other].step, &taken, share);
            found[other].step.cameras[column] = 0.0;
        }
    }
}

fn subtract(from: &mut Step, step: &Step, share: f64) {
    from.cameras.iter_mut().zip(&step.cameras).for_each(|(a, b)| *a -= share * b);
    from.poses.iter_mut().flatten().zip(step.poses.iter().flatten()).for_each(|(a, b)| *a -= share * b);
    from.points.iter_mut().flatten().zip(step.points.iter().flatten()).for_each(|(a, b)| *a -= share * b);
}

/// A direction of all unknowns from that of those that are kept.
fn whole(engine: &Engine, (state, normals): (&State, &Normals), schur: &Schur, kept: &[f64]) -> Step {
    let mut step = engine.zero_step();
    schur.follow(engine.ordered(state, normals), kept, &mut step);
    step
}

/// The principal distances that are unknown: place among the unknowns of cameras, and value.
fn distances<'a>(engine: &'a Engine, state: &'a State) -> impl Iterator<Item = (usize, f64)> + 'a {
    engine.layout.cameras.iter().zip(&state.cameras).flat_map(|(place, camera)| {
        let parameters = camera.parameters();
        let distance = move |(k, &parameter): (usize, &usize)| {
            let parameter = &parameters[parameter];
            matches!(parameter.name, "c" | "f" | "F" | "fx" | "fy").then(|| (place.offset + k, parameter.value.abs()))
        };
        place.free.iter().enumerate().filter_map(distance)
    })
}

impl Engine<'_> {
    /// Whether a principal distance has a standard deviation of which linear theory says nothing.
    pub(crate) fn has_senseless_distance(&self, solved: &Solved, state: &State, sigma0: f64) -> bool {
        distances(self, state).any(|(unknown, c)| {
            let mut column = vec![0.0; self.plan.size()];
            column[unknown] = 1.0;
            solved.factor.solve(&mut column);
            sigma0 * column[unknown].max(0.0).sqrt() > SENSELESS * c
        })
    }
}

/// Whether `step`, times a standard deviation, leaves the range in which a linear estimate of precision holds.
fn senseless(engine: &Engine, state: &State, step: &Step, deviation: f64) -> bool {
    distances(engine, state).any(|(unknown, c)| step.cameras[unknown].abs() * deviation > SENSELESS * c)
        || engine.layout.of_image.iter().enumerate().any(|(i, range)| {
            let Some(sight) = engine.layout.sights.get(range.start).filter(|_| !range.is_empty()) else { return false };
            let reach = (state.points[sight.point()] - state.poses[i].centre).norm();
            let [a, b, c, x, y, z] = step.poses[i];
            let (turn, shift) = (Vector3::new(a, b, c).norm(), Vector3::new(x, y, z).norm());
            turn * deviation > SENSELESS || shift * deviation > SENSELESS * reach
        })
}

fn root(value: f64) -> f64 {
    if value > 0.0 { value.sqrt() } else { 1.0 }
}
