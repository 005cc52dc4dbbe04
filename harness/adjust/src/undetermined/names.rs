//! Unknowns by name.

use calibench_model::camera::CameraModel;
use nalgebra::{Matrix3, Vector3};

use crate::network::{Layout, Network};
use crate::normal::Normals;
use crate::state::{State, Step};

/// Part of the largest effect that an unknown must have to be named.
const PART: f64 = 0.05;
/// A change of a parameter that no observation feels, as part of a unit vector, below which it is none.
const ROUNDING: f64 = 1e-6;

/// A change of unknowns in words: who takes part, measured by what each alone would do to the observations.
pub(super) fn participants(network: &Network, layout: &Layout, state: &State, normals: &Normals, step: &Step) -> Vec<String> {
    let cameras = cameras(layout, normals, step);
    let poses = poses(layout, state, normals, step);
    let points = points(layout, normals, step);
    let all = cameras.iter().flatten().chain(poses.iter().flatten()).chain(points.iter().flatten());
    let largest = all.fold(0.0, |a: f64, b| a.max(*b));
    // What no observation feels is a direction by itself, and the rest of it rounding.
    let takes_part = |effect: f64| if largest.is_infinite() { effect.is_infinite() } else { effect > PART * largest };
    let mut found = Vec::new();
    for (index, effects) in cameras.iter().enumerate() {
        let parameters = state.cameras[index].parameters();
        let free = &layout.cameras[index].free;
        let names: Vec<&str> =
            effects.iter().zip(free).filter(|(effect, _)| takes_part(**effect)).map(|(_, &i)| parameters[i].name).collect();
        if !names.is_empty() {
            found.push(format!("{} of {}", names.join(", "), network.cameras[index].name));
        }
    }
    let unknown = |i: &usize| layout.is_pose_unknown(*i);
    let images: Vec<usize> = (0..layout.pose_free.len()).filter(unknown).collect();
    let name = |i: usize| network.images[i].name.as_str();
    for (k, what) in ["X0", "Y0", "Z0", "rotation"].into_iter().enumerate() {
        found.extend(of_some(&images, |i| takes_part(poses[i][k]), name, what, "image"));
    }
    let unknown: Vec<usize> = (0..network.points.len()).filter(|&i| layout.is_triple_unknown(i)).collect();
    let name = |i: usize| network.points[i].name.as_str();
    for (k, what) in ["X", "Y", "Z"].into_iter().enumerate() {
        found.extend(of_some(&unknown, |i| takes_part(points[i][k]), name, what, "point"));
    }
    let shapes = network.surfaces.iter().zip(&points[network.points.len()..]);
    found.extend(shapes.filter(|(_, effects)| effects.iter().any(|effect| takes_part(*effect))).map(|(surface, _)| surface.name.clone()));
    found
}

/// "X0 of image 3", "X0 of images 3, 4", "X0 of 12 images", "X0 of all images".
fn of_some<'a>(
    all: &[usize],
    takes_part: impl Fn(usize) -> bool,
    name: impl Fn(usize) -> &'a str,
    what: &str,
    kind: &str,
) -> Option<String> {
    let some: Vec<usize> = all.iter().copied().filter(|&i| takes_part(i)).collect();
    match some.len() {
        0 => None,
        1 => Some(format!("{what} of {kind} {}", name(some[0]))),
        n if n == all.len() => Some(format!("{what} of all {kind}s")),
        n if n <= 5 => Some(format!("{what} of {kind}s {}", some.iter().map(|&i| name(i)).collect::<Vec<_>>().join(", "))),
        n => Some(format!("{what} of {n} {kind}s")),
    }
}

/// Effects of each camera's parameters; infinite for a parameter that changes while no observation feels it.
pub(super) fn cameras(layout: &Layout, normals: &Normals, step: &Step) -> Vec<Vec<f64>> {
    let of = |(place, block): (&crate::network::CameraPlace, &Vec<f64>)| {
        let width = place.free.len();
        let effect = |change: f64, felt: f64| match felt > 0.0 {
            true => change * felt.sqrt(),
            false if change > ROUNDING => f64::INFINITY,
            false => 0.0,
        };
        (0..width).map(|i| effect(step.cameras[place.offset + i].abs(), block[i * (width + 1)])).collect()
    };
    layout.cameras.iter().zip(&normals.camera).map(of).collect()
}

/// Effects of X0, Y0, Z0 and the rotation of each image.
fn poses(layout: &Layout, state: &State, normals: &Normals, step: &Step) -> Vec<[f64; 4]> {
    let of = |i: usize| {
        if !layout.is_pose_unknown(i) {
            return [0.0; 4];
        }
        let (m, block) = (&state.poses[i].rotation, &normals.pose[i]);
        let shift = m.tr_mul(&Vector3::from_fn(|k, _| step.poses[i][3 + k]));
        let normal = m.tr_mul(&Matrix3::from_fn(|r, c| block[6 * (3 + r) + 3 + c])) * m;
        let turn: f64 = (0..3).map(|k| step.poses[i][k].powi(2) * block[7 * k]).sum();
        let along = |k: usize| shift[k].abs() * normal[(k, k)].max(0.0).sqrt();
        [along(0), along(1), along(2), turn.max(0.0).sqrt()]
    };
    (0..step.poses.len()).map(of).collect()
}

fn points(layout: &Layout, normals: &Normals, step: &Step) -> Vec<[f64; 3]> {
    let of = |i: usize| {
        let along = |k: usize| step.points[i][k].abs() * normals.point[i][4 * k].max(0.0).sqrt();
        if layout.is_triple_unknown(i) { std::array::from_fn(along) } else { [0.0; 3] }
    };
    (0..step.points.len()).map(of).collect()
}
