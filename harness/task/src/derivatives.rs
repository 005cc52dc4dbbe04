//! How the measured points err with all that errs, to first order.
//!
//! A pose or a point of least squares without residuals moves by `-(A^T A)^-1 A^T dm`, with `A` the derivatives of its image coordinates and `dm` what an error does to
//! computed less measured: through the camera, the control, the pose, the image (Mikhail, Bethel & McGlone 2001, section 5; GUM, JCGM 100:2008, 5.1.2).

use calibench_model::Pose;
use calibench_model::camera::{CameraModel, DerivativeBuffer, Ray};
use nalgebra::{DMatrix, Matrix3, Matrix6, Point3, RowDVector, SVector, Vector3};

use crate::scene::{Scene, Seen};
use crate::{Source, TaskError};

/// What is left of a unit of a pose beside all others, at least.
const DETERMINED: f64 = 1e-6;

#[expect(clippy::struct_field_names, reason = "derivatives by")]
/// A picture of a point with its derivatives: by the camera's numbers, the pose and the point.
struct Linear {
    /// Of x and y by the parameters' standard normal numbers.
    by_camera: DMatrix<f64>,
    /// By a small rotation about the camera's axes and the projection centre.
    by_pose: [SVector<f64, 6>; 2],
    by_object: [Vector3<f64>; 2],
}

impl Scene<'_> {
    fn linear(&self, pose: &Pose, object: &Point3<f64>) -> Result<Linear, TaskError> {
        let n = pose.camera_from_world(object);
        let mut buffer = DerivativeBuffer::default();
        let ray = Ray { x: n.x, y: n.y, z: n.z };
        self.camera.derivatives_into(ray, &mut buffer).map_err(|error| TaskError::Geometry(error.to_string()))?;
        let by_parameters = buffer.by_parameters();
        let by_camera = DMatrix::from_fn(2, by_parameters.len(), |axis, parameter| by_parameters[parameter][axis]) * &self.factor;
        let by_ray = buffer.by_ray.map(Vector3::from);
        let by_object = by_ray.map(|by_ray| pose.rotation.transpose() * by_ray);
        let row = |axis: usize| {
            let (turn, shift) = (n.cross(&by_ray[axis]), -by_object[axis]);
            SVector::from([turn.x, turn.y, turn.z, shift.x, shift.y, shift.z])
        };
        Ok(Linear { by_camera, by_pose: [row(0), row(1)], by_object })
    }

    /// What an error of the camera does to an image coordinate.
    fn add_camera(&self, row: &mut RowDVector<f64>, by_camera: &DMatrix<f64>, axis: usize) {
        for (source, times) in [(Source::Camera, 1.0), (Source::Model, self.excess)] {
            if let Some(first) = self.first(source) {
                (0..by_camera.ncols()).for_each(|column| row[first + column] += times * by_camera[(axis, column)]);
            }
        }
    }

    /// Derivatives of a pose by all numbers: a small rotation about the camera's axes, then the projection centre.
    fn of_pose(&self, image: usize) -> Result<DMatrix<f64>, TaskError> {
        let station = &self.task.images[image];
        let mut found = DMatrix::zeros(6, self.count());
        if self.control.is_empty() {
            for (source, row, sigma) in [(Source::Angles, 0, station.sigma_angles), (Source::Centres, 3, station.sigma_centre)] {
                if let Some(first) = self.first(source) {
                    (0..3).for_each(|axis| found[(row + axis, first + 3 * image + axis)] = sigma);
                }
            }
            return Ok(found);
        }
        let mut normal = Matrix6::zeros();
        for seen in &self.marks[image] {
            let linear = self.linear(&station.pose, &self.control[seen.of].object)?;
            for axis in 0..2 {
                let row = linear.by_pose[axis];
                normal += row * row.transpose();
                let moved = self.of_mark(seen, &linear, axis);
                found -= DMatrix::from_column_slice(6, 1, row.as_slice()) * moved;
            }
        }
        // In units of the same size: radians and object units are far apart.
        let scale = Matrix6::from_diagonal(&normal.diagonal().map(|value| 1.0 / value.sqrt()));
        let undetermined = TaskError::Control { image: image + 1, found: self.marks[image].len() };
        let factor = (scale * normal * scale).cholesky().filter(|factor| factor.l().diagonal().min() > DETERMINED).ok_or(undetermined)?;
        let inverse = factor.inverse();
        let cofactor = scale * inverse * scale;
        Ok(DMatrix::from_column_slice(6, 6, cofactor.as_slice()) * found)
    }

    /// What all errors do to computed less measured of a control point.
    fn of_mark(&self, seen: &Seen, linear: &Linear, axis: usize) -> RowDVector<f64> {
        let (mark, by) = (&self.control[seen.of], &linear.by_object[axis]);
        let mut row = RowDVector::zeros(self.count());
        self.add_camera(&mut row, &linear.by_camera, axis);
        if let Some(first) = self.first(Source::ControlImage) {
            row[first + 2 * seen.number + axis] -= self.task.control.sigma_px;
        }
        if let Some(first) = self.first(Source::ControlPoints) {
            (0..3).for_each(|k| row[first + 3 * seen.of + k] += by[k] * mark.sigmas[k]);
        }
        if let Some(first) = self.first(Source::Flatness) {
            (0..3).for_each(|k| row[first + k] += by.dot(&mark.bends[k]));
        }
        row
    }

    /// Derivatives of all measured points by all numbers: three rows a point.
    pub(crate) fn of_points(&self) -> Result<DMatrix<f64>, TaskError> {
        let objects = self.task.quantity.points();
        let mut normal = vec![Matrix3::zeros(); objects.len()];
        let mut found = DMatrix::zeros(3 * objects.len(), self.count());
        for (image, station) in self.task.images.iter().enumerate() {
            let of_pose = self.of_pose(image)?;
            for seen in &self.points[image] {
                let linear = self.linear(&station.pose, &objects[seen.of])?;
                for axis in 0..2 {
                    let mut row = RowDVector::zeros(self.count());
                    self.add_camera(&mut row, &linear.by_camera, axis);
                    row += linear.by_pose[axis].transpose() * &of_pose;
                    if let Some(first) = self.first(Source::Image) {
                        row[first + 2 * seen.number + axis] -= self.task.sigma_px;
                    }
                    add(&mut normal, &mut found, seen.of, &linear.by_object[axis], &row);
                }
            }
        }
        for (point, object) in objects.iter().enumerate() {
            let Some((by, row)) = self.of_plane(object, &normal[point]) else { continue };
            add(&mut normal, &mut found, point, &by, &row);
        }
        for (point, normal) in normal.iter().enumerate() {
            let inverse = normal.cholesky().ok_or_else(|| TaskError::Geometry("they are parallel".into()))?.inverse();
            let solved = DMatrix::from_column_slice(3, 3, inverse.as_slice()) * found.rows(3 * point, 3);
            found.rows_mut(3 * point, 3).copy_from(&solved);
        }
        for (number, sigma) in self.scales() {
            for (point, object) in objects.iter().enumerate() {
                (0..3).for_each(|axis| found[(3 * point + axis, number)] += sigma * object[axis]);
            }
        }
        Ok(found)
    }

    /// The equation that a point lies in the known plane, as heavy as those of its image: with them it is solved exactly.
    fn of_plane(&self, object: &Point3<f64>, images: &Matrix3<f64>) -> Option<(Vector3<f64>, RowDVector<f64>)> {
        let plane = self.task.plane.as_ref()?;
        let heavy = images.trace().sqrt();
        let mut row = RowDVector::zeros(self.count());
        if let Some(first) = self.first(Source::Plane) {
            row[first] = -heavy * plane.sigma;
        }
        if let Some(first) = self.first(Source::PlaneTilt) {
            let from = object - plane.point;
            plane.axes().iter().enumerate().for_each(|(k, axis)| row[first + k] = heavy * plane.sigma_tilt * axis.dot(&from));
        }
        Some((heavy * plane.normal, row))
    }
}

/// Adds an equation of a point: its derivatives by it, and by all numbers.
fn add(normal: &mut [Matrix3<f64>], found: &mut DMatrix<f64>, point: usize, by: &Vector3<f64>, row: &RowDVector<f64>) {
    normal[point] += by * by.transpose();
    for axis in 0..3 {
        found.row_mut(3 * point + axis).zip_apply(row, |value, part| *value -= by[axis] * part);
    }
}
