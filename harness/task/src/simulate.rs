//! The measurement itself, with errors drawn or chosen: resections, intersections and all.

use calibench_adjust::approximate::{Control, Sight, fit_pose, intersect};
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{DVector, Point3, Rotation3, Vector3};

use crate::scene::Scene;
use crate::{Source, TaskError};

impl Scene<'_> {
    /// What is measured with these errors, less what truly is: object units or degrees, a number for each of the quantity's.
    pub(crate) fn simulated(&self, z: &[f64]) -> Result<Vec<f64>, TaskError> {
        let camera = self.camera_with(z);
        let poses = (0..self.task.images.len()).map(|image| self.pose_with(&camera, image, z)).collect::<Result<Vec<_>, _>>()?;
        let scale: f64 = 1.0 + self.scales().map(|(number, sigma)| sigma * z[number]).sum::<f64>();
        let count = self.task.quantity.points().len();
        let points =
            (0..count).map(|point| Ok(self.point_with(&camera, &poses, point, z)? * scale)).collect::<Result<Vec<_>, TaskError>>()?;
        self.task.quantity.errors(&points)
    }

    fn number(&self, z: &[f64], source: Source, place: usize) -> f64 {
        self.first(source).map_or(0.0, |first| z[first + place])
    }

    fn three(&self, z: &[f64], source: Source, from: usize) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| self.number(z, source, from + axis))
    }

    fn camera_with(&self, z: &[f64]) -> Camera {
        let number = |column: usize| self.number(z, Source::Camera, column) + self.excess * self.number(z, Source::Model, column);
        let numbers = DVector::from_fn(self.factor.ncols(), |column, _| number(column));
        let step = &self.factor * numbers;
        let values: Vec<f64> = self.camera.parameters().iter().zip(step.iter()).map(|(parameter, step)| parameter.value + step).collect();
        self.camera.with_parameters(&values)
    }

    fn pose_with(&self, camera: &Camera, image: usize, z: &[f64]) -> Result<Pose, TaskError> {
        let station = &self.task.images[image];
        if self.control.is_empty() {
            let turn = Rotation3::new(station.sigma_angles * self.three(z, Source::Angles, 3 * image));
            let centre = station.pose.centre + station.sigma_centre * self.three(z, Source::Centres, 3 * image);
            return Ok(Pose { rotation: turn * station.pose.rotation, centre });
        }
        let marks = &self.marks[image];
        let sigma = self.task.control.sigma_px;
        let seen = |seen: &crate::scene::Seen| {
            let mark = &self.control[seen.of];
            let by = |axis: usize| sigma * self.number(z, Source::ControlImage, 2 * seen.number + axis);
            let printed = self.three(z, Source::ControlPoints, 3 * seen.of).component_mul(&mark.sigmas);
            let bent: Vector3<f64> = (0..3).map(|k| mark.bends[k] * self.number(z, Source::Flatness, k)).sum();
            Control { object: mark.object + printed + bent, image: PixelPoint::new(seen.at.x + by(0), seen.at.y + by(1)) }
        };
        let control: Vec<Control> = marks.iter().map(seen).collect();
        let undetermined = || TaskError::Control { image: image + 1, found: control.len() };
        let fitted = fit_pose(camera, &station.pose, &control).map_err(|_| undetermined())?;
        fitted.cofactor.ok_or_else(undetermined)?;
        Ok(fitted.pose)
    }

    fn point_with(&self, camera: &Camera, poses: &[Pose], point: usize, z: &[f64]) -> Result<Point3<f64>, TaskError> {
        let sigma = self.task.sigma_px;
        let geometry = |words: String| TaskError::Geometry(words);
        let mut sights = Vec::new();
        for (pose, seen) in poses.iter().zip(&self.points) {
            for seen in seen.iter().filter(|seen| seen.of == point) {
                let by = |axis: usize| sigma * self.number(z, Source::Image, 2 * seen.number + axis);
                sights.push(Sight { camera, pose, image: PixelPoint::new(seen.at.x + by(0), seen.at.y + by(1)) });
            }
        }
        let (Some(plane), Some(sight)) = (&self.task.plane, sights.first()) else {
            return intersect(&sights, 0.0, None).map(|found| found.point).map_err(|error| geometry(error.to_string()));
        };
        let [across, along] = plane.axes();
        let tilt = |place: usize| plane.sigma_tilt * self.number(z, Source::PlaneTilt, place);
        let normal = plane.normal + tilt(0) * across + tilt(1) * along;
        let at = plane.point + plane.sigma * self.number(z, Source::Plane, 0) * plane.normal;
        let ray = camera.unproject(sight.image).map_err(|error| geometry(error.to_string()))?;
        let direction = sight.pose.world_from_ray(ray);
        let way = (at - sight.pose.centre).dot(&normal) / direction.dot(&normal);
        if way > 0.0 && way.is_finite() {
            Ok(sight.pose.centre + way * direction)
        } else {
            Err(geometry("a ray meets the plane nowhere".into()))
        }
    }
}
