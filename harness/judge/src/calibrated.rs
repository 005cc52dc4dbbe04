//! One calibration of many: the camera and its covariance, no report.

use std::collections::HashMap;

use calibench_adjust::{Datum, Network, Options, Residual, Variance, adjust};
use calibench_calibrate::{CalibrationError, Prepared, Settings, Shape, part_of, prepare};
use calibench_model::camera::{Camera, CameraModel, Ray};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{DMatrix, DVector, Point3};

use super::bend::Bend;
use super::material::Material;

/// A camera calibrated from some of the views.
#[derive(Clone, Debug)]
pub struct Calibrated {
    /// The camera.
    pub camera: Camera,
    /// Its unknown parameters.
    pub names: Vec<&'static str>,
    /// Their covariance, in the order of `names` and in their units, with the estimated variance factor.
    pub covariance: DMatrix<f64>,
    /// Observations less unknowns.
    pub redundancy: i64,
    /// The views, in the order of the network's images.
    pub views: Vec<usize>,
    /// RMS of the residuals of each view, px (2D), and how many corners it has.
    pub residuals: Vec<(f64, usize)>,
    /// How the board is bent; flat if that was not asked.
    pub bend: Bend,
    /// Coefficients that the corners do not determine, held near zero by weak priors.
    pub held: Vec<String>,
    /// Of a board whose corners are free: the corner of each point of the network. Empty of others.
    corners: Vec<usize>,
    /// What was adjusted, its start values those of the result: where parts of it start.
    network: Network,
}

/// Calibrates from the corners of `operator` in `views`.
///
/// # Errors
/// As [`prepare`] and [`adjust`]: what cannot be determined, by name.
pub fn calibrate(material: &Material, operator: usize, views: &[usize], settings: &Settings) -> Result<Calibrated, CalibrationError> {
    let prepared = prepare(material.points(operator, views), &material.field.control(), settings)?;
    match Calibrated::of(material, &prepared, views) {
        Err(error) if error.is_undetermined() => Calibrated::of(material, &prepared.held_weakly().ok_or(error)?, views),
        found => found,
    }
}

/// The corner of each point of a network.
fn corners(material: &Material, network: &Network) -> Vec<usize> {
    let place: HashMap<String, usize> =
        (0..material.field.count()).map(|corner| (material.field.name(corner).into_owned(), corner)).collect();
    network.points.iter().filter_map(|point| place.get(&point.name).copied()).collect()
}

impl Calibrated {
    fn of(material: &Material, prepared: &Prepared, views: &[usize]) -> Result<Self, CalibrationError> {
        let corners = if prepared.network.datum == Datum::Inner { corners(material, &prepared.network) } else { Vec::new() };
        let bend = match &prepared.shape {
            Shape::Bent { board, .. } => Bend::of(board.clone()),
            _ => Bend::default(),
        };
        Self::adjusted(prepared.network.clone(), views.to_vec(), (bend, prepared.held.clone()), corners)
    }

    fn adjusted(
        mut network: Network,
        views: Vec<usize>,
        (bend, held): (Bend, Vec<String>),
        corners: Vec<usize>,
    ) -> Result<Self, CalibrationError> {
        let solution = adjust(&network, &Options::default())?;
        let (names, covariance) = solution.covariances(Variance::Estimated)?.of_camera(0);
        let mut counts = vec![0; views.len()];
        network.observations.iter().for_each(|observation| counts[observation.image] += 1);
        let residuals = solution.rms_by_image().into_iter().map(Option::unwrap_or_default).zip(counts).collect();
        let (camera, poses, redundancy) = (solution.cameras()[0], solution.poses().to_vec(), solution.counts().redundancy());
        let coefficients = solution.surfaces().next();
        let freed: Vec<(usize, Point3<f64>)> = corners.iter().copied().zip(solution.points().iter().copied()).collect();
        network.cameras[0].camera = camera;
        network.images.iter_mut().zip(poses).for_each(|(image, pose)| image.pose = pose);
        network.surfaces.iter_mut().zip(coefficients).for_each(|(surface, found)| surface.coefficients = found);
        let bend = bend.with(coefficients.unwrap_or_default()).freed(freed.into_iter());
        Ok(Self { camera, names, covariance, redundancy, views, residuals, bend, held, corners, network })
    }

    /// The same from some of the views only. The result of all is where it starts, and no more than that.
    ///
    /// # Errors
    /// As [`adjust`].
    pub fn part(&self, views: &[usize]) -> Result<Self, CalibrationError> {
        let is_of = |image: usize| views.contains(&self.views[image]);
        // A point that is free is where two views place it.
        let least = if self.corners.is_empty() { 0 } else { 2 };
        let (network, points) = part_of(&self.network, &[], is_of, least);
        let corners = if self.corners.is_empty() { Vec::new() } else { points.iter().map(|&point| self.corners[point]).collect() };
        let views = self.views.iter().copied().filter(|view| views.contains(view)).collect();
        Self::adjusted(network, views, (self.bend.clone(), self.held.clone()), corners)
    }

    /// How far corners that are free are from where the field has them, and the standard deviations of that: root mean squares in the plane (2D) and along Z, object
    /// units.
    ///
    /// # Errors
    /// As [`adjust`].
    pub fn moved(&self) -> Result<[(f64, f64); 2], CalibrationError> {
        let solution = adjust(&self.network, &Options::default())?;
        let covariances = solution.covariances(Variance::Estimated)?;
        let of = |axes: &[usize]| {
            let (mut moved, mut variance) = (0.0, 0.0);
            for (k, at) in solution.points().iter().enumerate() {
                let from = self.network.points[k].position;
                moved += axes.iter().map(|&axis| (at[axis] - from[axis]).powi(2)).sum::<f64>();
                variance += axes.iter().map(|&axis| covariances.points[k][(axis, axis)]).sum::<f64>();
            }
            let n = solution.points().len().max(1) as f64;
            ((moved / n).sqrt(), (variance / n).max(0.0).sqrt())
        };
        Ok([of(&[0, 1]), of(&[2])])
    }

    /// What is left of each corner: its view, where it was measured and its residual (adjusted less observed), px.
    ///
    /// # Errors
    /// As [`adjust`].
    pub fn left(&self) -> Result<Vec<(usize, PixelPoint, [f64; 2])>, CalibrationError> {
        let solution = adjust(&self.network, &Options::default())?;
        let of =
            |residual: Residual| Some((self.views[residual.image], self.network.observations[residual.observation].position, residual.v?));
        Ok(solution.each_residual().filter_map(of).collect())
    }

    /// The values of its unknown parameters, in the order of `names` and in their units.
    pub fn values(&self) -> DVector<f64> {
        let all = self.camera.parameters();
        let value = |name: &&str| all.iter().find(|parameter| parameter.name == *name).map_or(f64::NAN, |parameter| parameter.value);
        DVector::from_iterator(self.names.len(), self.names.iter().map(value))
    }

    /// The pose of a view.
    pub fn pose(&self, view: usize) -> Option<Pose> {
        let image = self.views.iter().position(|own| *own == view)?;
        Some(self.network.images[image].pose)
    }

    /// The principal point, x and y, px as in [`PixelPoint`], each with its standard deviation: where the axis is
    /// pictured. `None` for a camera that does not picture it.
    pub fn principal_point(&self) -> Option<[(f64, f64); 2]> {
        let found = self.camera.derivatives(Ray::from_tangent(0.0, 0.0)).ok()?;
        let all = self.camera.parameters();
        let place = |name: &&str| all.iter().position(|parameter| parameter.name == *name);
        let by: Vec<[f64; 2]> = self.names.iter().filter_map(place).map(|place| found.by_parameters[place]).collect();
        let sigma = |axis: usize| {
            let slope = DVector::from_iterator(by.len(), by.iter().map(|by| by[axis]));
            (slope.transpose() * &self.covariance * &slope)[0].max(0.0).sqrt()
        };
        Some([(found.point.x, sigma(0)), (found.point.y, sigma(1))])
    }
}
