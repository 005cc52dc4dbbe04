//! Observed parameters, centres, rotations and coordinates.

use calibench_model::camera::CameraModel;
use nalgebra::{Matrix3, Vector3};

use super::blocks::Normals;
use crate::network::{Attitude, Centre, Layout, Network, Status};
use crate::state::{State, rotation_vector, rotation_vector_slope};

/// Adds the equations of everything that was observed beside image coordinates.
pub(super) fn add(network: &Network, layout: &Layout, state: &State, into: &mut Normals) {
    for (index, (interior, place)) in network.cameras.iter().zip(&layout.cameras).enumerate() {
        if !interior.parameters.iter().any(|status| matches!(status, Status::Observed { .. })) {
            continue;
        }
        let values = state.cameras[index].parameters();
        for (row, &parameter) in place.free.iter().enumerate() {
            let Some((p, w)) = equation(interior.parameters[parameter], values[parameter].value) else { continue };
            into.camera[index][row * (place.free.len() + 1)] += p;
            into.camera_right[place.offset + row] += p * w;
            into.cost += p * w * w;
        }
    }
    for (index, image) in network.images.iter().enumerate() {
        let pose = &state.poses[index];
        if let Centre::Observed { value, sigma } = image.centre {
            // X0 changes by -M^T s.
            into.add_to_pose(index, 3, &-pose.rotation.transpose(), &(value - pose.centre), sigma);
        }
        if let Attitude::Observed { value, sigma } = image.attitude {
            let off = rotation_vector(&(pose.rotation * value.transpose()));
            into.add_to_pose(index, 0, &rotation_vector_slope(&off), &-off, sigma);
        }
    }
    let triples = network.points.iter().map(|point| &point.coordinates).chain(network.surfaces.iter().map(|surface| &surface.statuses));
    for (index, statuses) in triples.enumerate() {
        for (axis, status) in statuses.iter().enumerate() {
            let Some((p, w)) = equation(*status, state.points[index][axis]) else { continue };
            into.point[index][4 * axis] += p;
            into.point_right[index][axis] += p * w;
            into.cost += p * w * w;
        }
    }
}

/// Weight and misclosure of an observed number.
fn equation(status: Status, now: f64) -> Option<(f64, f64)> {
    match status {
        Status::Observed { value, sigma } => Some((1.0 / (sigma * sigma), value - now)),
        _ => None,
    }
}

impl Normals {
    /// Three equations `slope dx = misclosure` on the unknowns of a pose from `first` on.
    fn add_to_pose(&mut self, image: usize, first: usize, slope: &Matrix3<f64>, misclosure: &Vector3<f64>, sigma: [f64; 3]) {
        let weights = Matrix3::from_diagonal(&Vector3::from(sigma.map(|sigma| 1.0 / (sigma * sigma))));
        let (normal, right) = (slope.tr_mul(&(weights * slope)), slope.tr_mul(&(weights * misclosure)));
        for i in 0..3 {
            (0..3).for_each(|j| self.pose[image][6 * (first + i) + first + j] += normal[(i, j)]);
            self.pose_right[image][first + i] += right[i];
        }
        self.cost += misclosure.dot(&(weights * misclosure));
    }
}
