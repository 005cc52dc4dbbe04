//! What the observations of a rig leave open.

use calibench_model::camera::CameraModel;
use nalgebra::{DMatrix, SymmetricEigen};

use super::equations::{Frame, RigNormals, RigState};
use crate::defect::{Defect, Direction};

/// An eigenvalue of the scaled normal equations that is rounding.
const SINGULAR: f64 = 1e-11;
/// Part of the largest share in a direction that an unknown must have to be named.
const PART: f64 = 0.05;
/// Directions that are described.
const MOST: usize = 12;

/// Cameras that no chain of stations joins, if there are any.
pub(super) fn unconnected(frame: &Frame<'_>) -> Option<Defect> {
    let cameras = &frame.rig.network.cameras;
    let mut set: Vec<usize> = (0..cameras.len()).collect();
    for images in &frame.images {
        for pair in images.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|image| set[frame.layout.camera_of[image]]);
            set.iter_mut().filter(|set| **set == a.max(b)).for_each(|set| *set = a.min(b));
        }
    }
    let mut sets: Vec<Vec<String>> = Vec::new();
    for first in 0..set.len() {
        let members: Vec<String> =
            (0..set.len()).filter(|&camera| set[camera] == first).map(|camera| cameras[camera].name.clone()).collect();
        if !members.is_empty() {
            sets.push(members);
        }
    }
    (sets.len() > 1).then_some(Defect::Unconnected { sets })
}

/// Stations and directions of what is kept that are singular to rounding, by name.
pub(super) fn singular(frame: &Frame<'_>, state: &RigState, normals: &RigNormals) -> Option<Defect> {
    let mut directions = Vec::new();
    for (station, block) in frame.rig.stations.iter().zip(&normals.stations).filter(|(_, block)| block.own.diagonal().max() > 0.0) {
        let root = block.own.diagonal().map(|value| if value > 0.0 { value.sqrt() } else { 1.0 });
        let scaled = DMatrix::from_fn(6, 6, |i, j| block.own[(i, j)] / (root[i] * root[j]));
        let least = SymmetricEigen::new(scaled).eigenvalues.min();
        if least < SINGULAR && directions.len() < MOST {
            directions.push(Direction { unknowns: vec![format!("the pose of station {}", station.name)], eigenvalue: least.max(0.0) });
        }
    }
    if directions.is_empty() {
        let (reduced, scale) = (normals.reduced(0.0)?, normals.scale());
        let scaled = DMatrix::from_fn(scale.len(), scale.len(), |i, j| reduced.matrix[(i, j)] / (scale[i] * scale[j]));
        let eigen = SymmetricEigen::new(scaled);
        for (k, &eigenvalue) in eigen.eigenvalues.iter().enumerate().filter(|(_, value)| **value < SINGULAR).take(MOST) {
            let share: Vec<f64> = eigen.eigenvectors.column(k).iter().map(|share| share.abs()).collect();
            directions.push(Direction { unknowns: names(frame, state, &share), eigenvalue: eigenvalue.max(0.0) });
        }
    }
    (!directions.is_empty()).then(|| Defect::Directions { directions, reasons: Vec::new() })
}

fn names(frame: &Frame<'_>, state: &RigState, share: &[f64]) -> Vec<String> {
    let largest = share.iter().fold(0.0, |a: f64, b| a.max(*b));
    let takes_part = |place: usize| share[place] > PART * largest;
    let mut found = Vec::new();
    for (camera, interior) in frame.rig.network.cameras.iter().enumerate() {
        let (place, parameters) = (&frame.layout.cameras[camera], state.cameras[camera].parameters());
        let free = place.free.iter().enumerate().filter(|(k, _)| takes_part(place.offset + k));
        let names: Vec<&str> = free.map(|(_, &i)| parameters[i].name).collect();
        if !names.is_empty() {
            found.push(format!("{} of {}", names.join(", "), interior.name));
        }
        let Some(first) = frame.mount[camera] else { continue };
        for (range, what) in [(first..first + 3, "rotation"), (first + 3..first + 6, "place")] {
            if range.into_iter().any(takes_part) {
                found.push(format!("the {what} of {} on the rig", interior.name));
            }
        }
    }
    found
}
