//! Couplings that are made anew are those that are kept.

use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Point3, Vector3};

use super::*;

use crate::network::{Exterior, ImageObservation, Interior, ObjectPoint};

/// Six images of sixty points, some of which are known, with wobbling image coordinates.
fn network() -> Network {
    let size = ImageSize { width: 1000, height: 800 };
    let camera: Camera = OpenCv { size, fx: 900.0, fy: 900.0, cx: 500.0, cy: 400.0, distortion: [0.0; 14], coefficients: 5 }.into();
    let wave = |i: usize, by: f64| (i as f64 * by).sin();
    let at = |i: usize| Point3::new(3.0 * wave(i, 1.7), 2.0 * wave(i, 2.3), 0.8 * wave(i, 3.1));
    let pose = |i: usize| {
        Pose::looking_at(Point3::new(4.0 * wave(i, 1.0), 4.0 * wave(i, 2.0), 9.0), Point3::origin(), Vector3::y(), i as f64).unwrap()
    };
    let poses: Vec<Pose> = (0..6).map(pose).collect();
    let (mut observations, mut points) = (Vec::new(), Vec::new());
    for point in 0..60 {
        let name = point.to_string();
        points.push(if point % 9 == 0 { ObjectPoint::fixed(name, at(point)) } else { ObjectPoint::free(name, at(point)) });
        for (image, pose) in poses.iter().enumerate().filter(|(image, _)| (image + point) % 4 != 0) {
            let seen = CameraModel::project(&camera, pose.ray(&at(point))).unwrap();
            let off = PixelPoint::new(seen.x + 0.2 * wave(7 * point + image, 1.3), seen.y + 0.2 * wave(5 * point + image, 2.9));
            observations.push(ImageObservation::new(image, point, off, 0.2));
        }
    }
    let images = poses.into_iter().enumerate().map(|(i, pose)| Exterior::free(i.to_string(), 0, pose)).collect();
    let interior = Interior::fixed("camera", camera).free(&["fx", "fy", "cx", "cy", "k1"]).unwrap();
    Network { cameras: vec![interior], images, points, observations, ..Network::default() }
}

#[test]
fn couplings_made_anew_are_those_kept() {
    let network = network();
    let kept = Engine::new(&network, Layout::new(&network, &[], &[]).unwrap(), Loss::Huber(2.0));
    assert!(kept.layout.keeps_couplings && kept.plan.eliminated == Eliminated::Points);
    let mut anew = kept.clone();
    anew.layout.keeps_couplings = false;
    let ends = [&kept, &anew].map(|engine| engine.descend(State::of(&network), 50, crate::EXACT).unwrap());
    assert!(ends.iter().all(|end| end.converged) && ends[1].normals.point_pose.is_empty() && ends[1].normals.point_camera.is_empty());
    assert_eq!((ends[0].normals.cost, ends[0].iterations), (ends[1].normals.cost, ends[1].iterations));
    assert!(ends[0].state.points == ends[1].state.points);
    let solved = [&kept, &anew].map(|engine| engine.decompose((&ends[0].state, &ends[0].normals), 0.0).unwrap());
    let inverses = [(&kept, &solved[0]), (&anew, &solved[1])].map(|(engine, solved)| engine.inverse(solved));
    let mut couplings = [Coupling::default(), Coupling::default()];
    for place in 0..kept.plan.members.len() {
        let one = inverses[0].member::<3>(&solved[0], kept.ordered(&ends[0].state, &ends[0].normals), place, &mut couplings[0]);
        let other = inverses[1].member::<3>(&solved[1], anew.ordered(&ends[0].state, &ends[0].normals), place, &mut couplings[1]);
        assert_eq!(one.own, other.own);
    }
}
