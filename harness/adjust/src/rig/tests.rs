//! Every block of the equations of a rig, and every cofactor, against differences.

use calibench_model::camera::{Camera, ImageSize, OpenCv};
use calibench_model::{Covariance, PixelPoint, Pose};
use nalgebra::{DMatrix, DVector, Point3, Rotation3, Vector3, Vector6};

use super::cofactors::Cofactors;
use super::equations::{Frame, RigNormals, RigState, RigStep};
use super::{Rig, Station, adjoint, mounted, relative};
use crate::network::{Exterior, ImageObservation, Interior, Layout, Network, ObjectPoint, Precision, Status};
use crate::normal::{Loss, Scratch};
use crate::state::{rotation_vector, turned};

fn pose(seed: f64) -> Pose {
    let turn = Vector3::new((seed * 1.3).sin(), (seed * 2.1).cos(), (seed * 0.7).sin()) * 0.4;
    Pose { rotation: *Rotation3::new(turn).matrix(), centre: Point3::new(seed.sin(), (2.0 * seed).cos(), 0.5 * seed.cos()) }
}

/// From one pose to a near one: rotation about the camera's axes, shift along them.
fn step_between(from: &Pose, to: &Pose) -> Vector6<f64> {
    let turn = rotation_vector(&(to.rotation * from.rotation.transpose()));
    let shift = -(from.rotation * (to.centre - from.centre));
    Vector6::new(turn.x, turn.y, turn.z, shift.x, shift.y, shift.z)
}

#[test]
fn the_adjoint_is_what_a_motion_of_the_rig_does_to_a_camera() {
    let (mount, station, h) = (pose(1.0), pose(2.0), 1e-6);
    let adjoint = adjoint(&mount);
    for k in 0..6 {
        let moved = |h: f64| mounted(&mount, &turned(&station, &std::array::from_fn(|i| if i == k { h } else { 0.0 })));
        let difference =
            (step_between(&mounted(&mount, &station), &moved(h)) - step_between(&mounted(&mount, &station), &moved(-h))) / (2.0 * h);
        assert!((difference - adjoint.column(k)).amax() < 1e-8, "{k}: {difference} {}", adjoint.column(k));
    }
    let (point, back) = (Point3::new(0.3, -0.4, 2.0), relative(&mount, &mounted(&pose(3.0), &mount)));
    assert!(
        (mounted(&mount, &station).camera_from_world(&point) - mount.camera_from_world(&station.camera_from_world(&point).into())).norm()
            < 1e-14
    );
    assert!((back.rotation - pose(3.0).rotation).amax() < 1e-14 && (back.centre - pose(3.0).centre).norm() < 1e-14);
}

/// Three cameras, four stations, nothing at its observed value; the second station lacks a camera.
fn rig() -> Rig {
    let camera = |f: f64| -> Camera {
        let mut distortion = [0.0; 14];
        distortion[..5].copy_from_slice(&[-0.1, 0.05, 2e-4, -3e-4, 0.01]);
        OpenCv { size: ImageSize { width: 1280, height: 960 }, fx: f, fy: f + 2.0, cx: 640.0, cy: 470.0, distortion, coefficients: 5 }
            .into()
    };
    let first = Interior::fixed("a", camera(1000.0)).free(&["fx", "cy"]).unwrap().observed("k1", -0.11, 0.02).unwrap();
    let mut last = Interior::fixed("c", camera(900.0));
    last.parameters[..4].fill(Status::Free);
    let mounts = [
        pose(0.0),
        Pose { centre: Point3::new(0.4, 0.02, -0.05), ..pose(0.3) },
        Pose { centre: Point3::new(-0.3, 0.1, 0.03), ..pose(-0.2) },
    ];
    let mut rig = Rig { mounts: mounts.to_vec(), origin: 1, ..Rig::default() };
    rig.network.cameras = vec![first, Interior::fixed("b", camera(950.0)), last];
    rig.network.points = (0..12)
        .map(|i| ObjectPoint::fixed(format!("{i}"), Point3::new(f64::from(i % 4) * 0.3, f64::from(i / 4) * 0.3, 0.05 * f64::from(i % 3))))
        .collect();
    let precision = Precision::Covariance(Covariance { sxx: 0.5, sxy: 0.2, syy: 0.8 });
    for station in 0..4 {
        let centre = Point3::new(0.4 + 0.1 * station as f64, 0.3, 2.5 + 0.1 * station as f64);
        let turn = Rotation3::new(Vector3::new(0.1 * station as f64, -0.15, 0.1));
        rig.stations.push(Station { name: format!("{station}"), pose: Pose { rotation: *turn.matrix(), centre } });
        for camera in (0..3).filter(|camera| (station, *camera) != (1, 2)) {
            let image = rig.network.images.len();
            rig.network.images.push(Exterior::free(format!("{camera}/{station}"), camera, pose(0.0)));
            rig.station_of.push(station);
            let pose = rig.pose(image);
            for point in (0..12).filter(|point| !(point + image).is_multiple_of(5)) {
                use calibench_model::camera::CameraModel;
                let seen = rig.network.cameras[camera].camera.project(pose.ray(&rig.network.points[point].position)).unwrap();
                let position = PixelPoint::new(seen.x + (point as f64).sin(), seen.y + (point as f64 * 1.7).cos());
                rig.network.observations.push(ImageObservation { image, point, position, precision, behind: false });
            }
        }
    }
    rig
}

fn unit(frame: &Frame<'_>, k: usize, h: f64) -> RigStep {
    let mut step = RigStep { kept: DVector::zeros(frame.kept), stations: vec![Vector6::zeros(); frame.images.len()] };
    match k.checked_sub(frame.kept) {
        None => step.kept[k] = h,
        Some(k) => step.stations[k / 6][k % 6] = h,
    }
    step
}

/// White residuals of image points and of the observed parameter.
fn white(frame: &Frame<'_>, state: &RigState) -> Vec<f64> {
    use calibench_model::camera::CameraModel;
    let whole = frame.whole(state);
    let network: &Network = &frame.rig.network;
    let of = |o: &ImageObservation| {
        let at = whole.pixel(network, o).unwrap();
        o.precision.whitened([at.x - o.position.x, at.y - o.position.y])
    };
    let k1 = whole.cameras[0].parameters().iter().find(|parameter| parameter.name == "k1").unwrap().value;
    network.observations.iter().flat_map(of).chain([(k1 + 0.11) / 0.02]).collect()
}

#[test]
fn equations_and_cofactors_are_those_of_differences() {
    let rig = rig();
    rig.check().unwrap();
    let frame = Frame::new(&rig, Layout::new(&rig.network, &[], &[]).unwrap(), Loss::Squares);
    let (state, mut normals) = (frame.start(), RigNormals::default());
    frame.linearise(&state, &mut Scratch::default(), &mut normals).unwrap();
    let size = frame.kept + 24;
    assert_eq!((frame.kept, frame.counts.unknowns, frame.counts.observed), (7 + 12, size, 1));
    let residuals = DVector::from_vec(white(&frame, &state));
    let mut slopes = DMatrix::zeros(residuals.len(), size);
    for k in 0..size {
        let h = if k < 7 { 1e-4 * if k == 2 { 0.01 } else { 1.0 } } else { 1e-6 };
        let at = |h: f64| DVector::from_vec(white(&frame, &frame.moved(&state, &unit(&frame, k, h))));
        slopes.set_column(k, &((at(h) - at(-h)) / (2.0 * h)));
    }
    let (dense, right) = (slopes.tr_mul(&slopes), -slopes.tr_mul(&residuals));
    assert!((normals.cost() / residuals.norm_squared() - 1.0).abs() < 1e-12);
    let scale = |i: usize| dense[(i, i)].sqrt();
    let near = |a: f64, i: usize, j: usize, what: &str| {
        assert!((a - dense[(i, j)]).abs() < 1e-6 * scale(i) * scale(j), "{what} {i} {j}: {a} {}", dense[(i, j)]);
    };
    let along = |a: f64, i: usize| assert!((a - right[i]).abs() < 1e-6 * scale(i) * residuals.norm(), "right {i}: {a} {}", right[i]);
    for i in 0..frame.kept {
        (0..frame.kept).for_each(|j| near(normals.kept[(i, j)], i, j, "kept"));
        along(normals.right[i], i);
    }
    for (s, station) in normals.stations.iter().enumerate() {
        let first = frame.kept + 6 * s;
        for i in 0..6 {
            (0..6).for_each(|j| near(station.own[(i, j)], first + i, first + j, "station"));
            along(station.right[i], first + i);
            let mut coupling = vec![0.0; frame.kept];
            station.columns.iter().enumerate().for_each(|(k, &column)| coupling[column] += station.coupling[(i, k)]);
            (0..frame.kept).for_each(|j| near(coupling[j], first + i, j, "coupling"));
        }
    }
    cofactors_and_step(&frame, &normals, &dense, &right);
}

fn cofactors_and_step(frame: &Frame<'_>, normals: &RigNormals, dense: &DMatrix<f64>, right: &DVector<f64>) {
    let inverse = dense.clone().try_inverse().unwrap();
    let cofactors = Cofactors::of(normals).unwrap();
    let near = |a: f64, i: usize, j: usize| {
        let size = (inverse[(i, i)] * inverse[(j, j)]).sqrt();
        assert!((a - inverse[(i, j)]).abs() < 1e-4 * size, "{i} {j}: {a} {}", inverse[(i, j)]);
    };
    for i in 0..frame.kept {
        (0..frame.kept).for_each(|j| near(cofactors.kept[(i, j)], i, j));
    }
    for (s, (own, cross)) in cofactors.stations.iter().enumerate() {
        let first = frame.kept + 6 * s;
        for i in 0..6 {
            (0..6).for_each(|j| near(own[(i, j)], first + i, first + j));
            (0..frame.kept).for_each(|j| near(cross[(i, j)], first + i, j));
        }
    }
    let (step, other) = (normals.reduced(0.0).unwrap().step(normals).unwrap(), &inverse * right);
    for k in 0..other.len() {
        let own = if k < frame.kept { step.kept[k] } else { step.stations[(k - frame.kept) / 6][(k - frame.kept) % 6] };
        assert!((own - other[k]).abs() < 1e-4 * inverse[(k, k)].sqrt(), "{k}: {own} {}", other[k]);
    }
}
