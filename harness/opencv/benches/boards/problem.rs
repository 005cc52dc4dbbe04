//! The problem that all solve: a board's corners in some views, and a start.

use std::error::Error;

use calibench_adjust::Network;
use calibench_adjust::approximate::{Control, interior_from_planes, planar_starts};
use calibench_model::Pose;
use calibench_model::camera::{CameraModel, ImageSize};
use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::networks;
use crate::theirs::{Board, Theirs};

/// The board with noisy corners in single precision, which is what OpenCV takes, and a start as good as Zhang's.
pub(crate) fn problem(views: usize) -> Network {
    let mut network = networks::board(networks::opencv(), views, 1);
    networks::free(&mut network, &networks::FIVE);
    let mut random = networks::random(2);
    networks::shake_pixels(&mut network, 0.2, &mut random);
    for observation in &mut network.observations {
        let at = &mut observation.position;
        (at.x, at.y) = (f64::from(at.x as f32), f64::from(at.y as f32));
    }
    networks::shake_poses(&mut network, 5.0, 0.02, &mut random);
    network
}

pub(crate) fn control(network: &Network, views: usize) -> Vec<Vec<Control>> {
    let mut control = vec![Vec::new(); views];
    for o in &network.observations {
        control[o.image].push(Control { object: network.points[o.point].position, image: o.position });
    }
    control
}

pub(crate) fn board(network: &Network, views: usize) -> Board {
    let size = network.cameras[0].camera.size();
    let control = control(network, views);
    let objects = control.iter().map(|view| view.iter().map(|point| [point.object.x, point.object.y]).collect()).collect();
    let images = control.iter().map(|view| view.iter().map(|point| [point.image.x, point.image.y]).collect()).collect();
    Board { size: (size.width as i32, size.height as i32), objects, images }
}

/// The same network with start values from the corners alone.
pub(crate) fn from_corners(network: &Network, control: &[Vec<Control>], size: ImageSize) -> Result<Network, Box<dyn Error>> {
    let mut network = network.clone();
    let views: Vec<&[Control]> = control.iter().map(Vec::as_slice).collect();
    network.cameras[0].camera = interior_from_planes(&views, size)?.camera;
    for (image, view) in network.images.iter_mut().zip(&views) {
        image.pose = planar_starts(&network.cameras[0].camera, view)?[0];
    }
    Ok(network)
}

/// The network with OpenCV's result as its start values.
pub(crate) fn from_theirs(network: &Network, theirs: &Theirs) -> Network {
    let mut network = network.clone();
    network.cameras[0].camera = network.cameras[0].camera.with_parameters(&theirs.parameters);
    // Of our axes x right, y up, z backwards, the second and the third turn round.
    let turn = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
    for (image, [a, b, c, x, y, z]) in network.images.iter_mut().zip(&theirs.poses) {
        let rotation = turn * Rotation3::new(Vector3::new(*a, *b, *c)).matrix();
        let centre = (-rotation.tr_mul(&(turn * Vector3::new(*x, *y, *z)))).into();
        image.pose = Pose { rotation, centre };
    }
    network
}
