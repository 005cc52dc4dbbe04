//! One calibration of many: the camera and its covariance, no report.

use calibench_adjust::{ImageObservation, Network, Options, Residual, Variance, adjust};
use calibench_calibrate::{CalibrationError, Prepared, Settings, Shape, prepare};
use calibench_model::camera::{Camera, CameraModel, Ray};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{DMatrix, DVector};

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
    /// What was adjusted, its start values those of the result: where parts of it start.
    network: Network,
}

/// Calibrates from the corners of `operator` in `views`.
///
/// # Errors
/// As [`prepare`] and [`adjust`]: what cannot be determined, by name.
pub fn calibrate(material: &Material, operator: usize, views: &[usize], settings: &Settings) -> Result<Calibrated, CalibrationError> {
    let prepared = prepare(material.points(operator, views), &material.field.control(), settings)?;
    match Calibrated::of(&prepared, views) {
        Err(error) if error.is_undetermined() => Calibrated::of(&prepared.held_weakly().ok_or(error)?, views),
        found => found,
    }
}

impl Calibrated {
    fn of(prepared: &Prepared, views: &[usize]) -> Result<Self, CalibrationError> {
        let bend = match &prepared.shape {
            Shape::Bent { board, .. } => Bend::of(board.clone()),
            _ => Bend::default(),
        };
        Self::adjusted(prepared.network.clone(), views.to_vec(), (bend, prepared.held.clone()))
    }

    fn adjusted(mut network: Network, views: Vec<usize>, (bend, held): (Bend, Vec<String>)) -> Result<Self, CalibrationError> {
        let solution = adjust(&network, &Options::default())?;
        let (names, covariance) = solution.covariances(Variance::Estimated)?.of_camera(0);
        let mut counts = vec![0; views.len()];
        network.observations.iter().for_each(|observation| counts[observation.image] += 1);
        let residuals = solution.rms_by_image().into_iter().map(Option::unwrap_or_default).zip(counts).collect();
        let (camera, poses, redundancy) = (solution.cameras()[0], solution.poses().to_vec(), solution.counts().redundancy());
        let coefficients = solution.surfaces().next();
        network.cameras[0].camera = camera;
        network.images.iter_mut().zip(poses).for_each(|(image, pose)| image.pose = pose);
        network.surfaces.iter_mut().zip(coefficients).for_each(|(surface, found)| surface.coefficients = found);
        let bend = bend.with(coefficients.unwrap_or_default());
        Ok(Self { camera, names, covariance, redundancy, views, residuals, bend, held, network })
    }

    /// The same from some of the views only. The result of all is where it starts, and no more than that.
    ///
    /// # Errors
    /// As [`adjust`].
    pub fn part(&self, views: &[usize]) -> Result<Self, CalibrationError> {
        let place: Vec<Option<usize>> = self.views.iter().map(|view| views.iter().position(|part| part == view)).collect();
        let taken: Vec<usize> = (0..self.views.len()).filter(|&image| place[image].is_some()).collect();
        let renumbered = |image: usize| taken.iter().position(|&taken| taken == image);
        let images = taken.iter().map(|&image| self.network.images[image].clone()).collect();
        let observations = self.network.observations.iter();
        let observations = observations.filter_map(|o| Some(ImageObservation { image: renumbered(o.image)?, ..*o })).collect();
        let network = Network { images, observations, ..self.network.clone() };
        let views = taken.iter().map(|&image| self.views[image]).collect();
        Self::adjusted(network, views, (self.bend.clone(), self.held.clone()))
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
