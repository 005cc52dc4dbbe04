//! Values of all unknowns, and how a step changes them.

use calibench_model::camera::opencv::CameraFromWorld;
use calibench_model::camera::{Camera, CameraModel, Ray};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

use crate::network::{ImageObservation, Layout, Network};

/// Values of all unknowns.
#[derive(Clone, Debug, Default)]
pub(crate) struct State {
    pub(crate) cameras: Vec<Camera>,
    pub(crate) poses: Vec<Pose>,
    /// Of each triple: where a point is, or the coefficients of a surface.
    pub(crate) points: Vec<Point3<f64>>,
    /// Of each image: numbers of its own; empty where none is asked for.
    pub(crate) own: Vec<Vec<f64>>,
}

impl State {
    /// The start values.
    pub(crate) fn of(network: &Network) -> Self {
        let coefficients = network.surfaces.iter().map(|surface| Point3::from(surface.coefficients));
        let mut points: Vec<Point3<f64>> = network.points.iter().map(|point| point.position).chain(coefficients).collect();
        for (on, coefficients) in network.surfaces.iter().flat_map(|surface| surface.points.iter().map(|on| (on, surface.coefficients))) {
            // The network is checked later.
            if let Some(point) = points.get_mut(on.point) {
                *point += on.basis * Vector3::from(coefficients);
            }
        }
        Self {
            cameras: network.cameras.iter().map(|interior| interior.camera).collect(),
            poses: network.images.iter().map(|image| image.pose).collect(),
            points,
            own: network.zero_own(),
        }
    }

    /// The camera that pictured an image, with what is the image's own.
    pub(crate) fn camera(&self, network: &Network, image: usize) -> Camera {
        let index = network.images[image].camera;
        let (camera, own) = (self.cameras[index], self.own.get(image).map_or(&[][..], Vec::as_slice));
        if own.is_empty() {
            return camera;
        }
        let mut values: Vec<f64> = camera.parameters().iter().map(|parameter| parameter.value).collect();
        for (of, value) in network.of_each_image(index).zip(own) {
            of.along.iter().for_each(|&(parameter, share)| values[parameter] += share * value);
        }
        camera.with_parameters(&values)
    }

    /// Where an observation of a checked network is pictured, if it is.
    pub(crate) fn pixel(&self, network: &Network, o: &ImageObservation) -> Option<PixelPoint> {
        let ray = before(self.poses[o.image].ray(&self.points[o.point]), o.behind);
        self.camera(network, o.image).project(ray).ok()
    }

    /// After a step.
    pub(crate) fn moved(&self, layout: &Layout, step: &Step) -> Self {
        let camera = |(camera, place): (&Camera, &crate::network::CameraPlace)| {
            if place.free.is_empty() {
                return *camera;
            }
            let mut values: Vec<f64> = camera.parameters().iter().map(|parameter| parameter.value).collect();
            place.free.iter().zip(&step.cameras[place.offset..]).for_each(|(&i, change)| values[i] += change);
            camera.with_parameters(&values)
        };
        let cameras = self.cameras.iter().zip(&layout.cameras).map(camera).collect();
        let pose = |(i, pose): (usize, &Pose)| if layout.is_pose_unknown(i) { turned(pose, &step.poses[i]) } else { *pose };
        let poses = self.poses.iter().enumerate().map(pose).collect();
        let mut points: Vec<_> = self.points.iter().zip(&step.points).map(|(point, change)| point + Vector3::from(*change)).collect();
        layout.triples.carry(&step.points, &mut points);
        let mut own = self.own.clone();
        own.iter_mut().flatten().zip(step.own.iter().flatten()).for_each(|(value, change)| *value += change);
        Self { cameras, poses, points, own }
    }
}

/// A change of all unknowns.
#[derive(Clone, Debug, Default)]
pub(crate) struct Step {
    /// Unknown parameters of all cameras, one after the other.
    pub(crate) cameras: Vec<f64>,
    /// Of each image: small rotation about the camera's axes, shift along them (`N + d x N + s`).
    pub(crate) poses: Vec<[f64; 6]>,
    /// Of each triple: X, Y, Z of a point, or the coefficients of a surface.
    pub(crate) points: Vec<[f64; 3]>,
    /// Numbers of each image's own; empty where none is asked for.
    pub(crate) own: Vec<Vec<f64>>,
}

impl Step {
    pub(crate) fn zero(cameras: usize, images: usize, points: usize) -> Self {
        Self { cameras: vec![0.0; cameras], poses: vec![[0.0; 6]; images], points: vec![[0.0; 3]; points], own: Vec::new() }
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.cameras.iter().all(|x| x.is_finite())
            && self.poses.iter().flatten().all(|x| x.is_finite())
            && self.points.iter().flatten().all(|x| x.is_finite())
            && self.own.iter().flatten().all(|x| x.is_finite())
    }
}

/// The pose after a small rotation about the camera's axes and a shift along them, `N + d x N + s`.
pub(crate) fn turned(pose: &Pose, step: &[f64; 6]) -> Pose {
    let [a, b, c, x, y, z] = *step;
    let mut rotation = Rotation3::new(Vector3::new(a, b, c)) * Rotation3::from_matrix_unchecked(pose.rotation);
    rotation.renormalize();
    Pose { rotation: *rotation.matrix(), centre: pose.centre - pose.rotation.tr_mul(&Vector3::new(x, y, z)) }
}

/// The ray to a point, or the one that goes on from it through the projection centre.
pub(crate) fn before(ray: Ray, is_behind: bool) -> Ray {
    if is_behind { Ray { x: -ray.x, y: -ray.y, z: -ray.z } } else { ray }
}

/// `N = M X - M X0`.
pub(crate) fn camera_from_world(pose: &Pose) -> CameraFromWorld {
    let m = &pose.rotation;
    let shift = -(m * pose.centre.coords);
    CameraFromWorld { rotation: std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)])), translation: shift.into() }
}

/// The rotation vector of `rotation`, radians: about the camera's axes, as in the step of a pose.
pub(crate) fn rotation_vector(rotation: &Matrix3<f64>) -> Vector3<f64> {
    let m = rotation;
    let v = Vector3::new(m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]) * 0.5;
    let (sine, cosine) = (v.norm(), 0.5 * (m.trace() - 1.0));
    // The trace alone loses small angles, the antisymmetric part those near a half turn.
    if cosine > -0.9 {
        return if sine > 0.0 { v * (sine.atan2(cosine) / sine) } else { v };
    }
    Rotation3::from_matrix_unchecked(*rotation).scaled_axis()
}

/// d(rotation vector of exp(d) R) / d(d) where R has the rotation vector `r`.
pub(crate) fn rotation_vector_slope(r: &Vector3<f64>) -> Matrix3<f64> {
    let (angle, cross) = (r.norm(), r.cross_matrix());
    // 1 / t^2 - (1 + cos t) / (2 t sin t), which tends to 1 / 12.
    let second = if angle < 1e-3 { 1.0 / 12.0 } else { 1.0 / (angle * angle) - (1.0 + angle.cos()) / (2.0 * angle * angle.sin()) };
    Matrix3::identity() - cross * 0.5 + cross * cross * second
}
