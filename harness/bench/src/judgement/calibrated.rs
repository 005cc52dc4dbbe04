//! One calibration of many: the camera and its covariance, no report.

use std::sync::Arc;

use calibench_adjust::{Options, Variance, adjust};
use calibench_model::camera::{Camera, CameraModel, Ray};
use nalgebra::DMatrix;

use super::material::Material;
use crate::calibration::{CalibrationError, Settings, prepare};

/// A camera calibrated from some of the views.
#[derive(Clone, Debug)]
pub struct Calibrated {
    /// The camera.
    pub camera: Camera,
    /// Its unknown parameters.
    pub names: Vec<&'static str>,
    /// Their covariance, with the estimated variance factor.
    pub covariance: DMatrix<f64>,
    /// Observations less unknowns.
    pub redundancy: i64,
    /// RMS of the residuals of each view, px (2D), and how many corners it has.
    pub residuals: Vec<(Arc<str>, f64, usize)>,
}

/// Calibrates from the corners of `operator` in `views`, from the camera `start` if there is one.
///
/// # Errors
/// As [`prepare`] and [`adjust`]: what cannot be determined, by name.
pub fn calibrate(
    material: &Material,
    operator: usize,
    views: &[usize],
    settings: &Settings,
    start: Option<&Camera>,
) -> Result<Calibrated, CalibrationError> {
    let settings = Settings { start: start.copied(), ..settings.clone() };
    let prepared = prepare(&material.points(operator, views), &material.control(), &settings)?;
    let solution = adjust(&prepared.network, &Options::default())?;
    let (names, covariance) = solution.covariances(Variance::Estimated)?.of_camera(0);
    let count = |image: usize| prepared.survey.sights.iter().filter(|sight| sight.image == image).count();
    let residuals = solution.rms_by_image().into_iter().enumerate();
    let residuals = residuals.filter_map(|(image, rms)| Some((prepared.survey.images[image].as_str().into(), rms?, count(image)))).collect();
    Ok(Calibrated { camera: solution.cameras()[0], names, covariance, redundancy: solution.counts().redundancy(), residuals })
}

impl Calibrated {
    /// The principal point, px, with its standard deviations: where the axis is pictured. `None` for a camera that does not picture it.
    pub fn principal_point(&self) -> Option<[(f64, f64); 2]> {
        let found = self.camera.derivatives(Ray::from_tangent(0.0, 0.0)).ok()?;
        let all = self.camera.parameters();
        let place = |name: &&str| all.iter().position(|parameter| parameter.name == *name);
        let by: Vec<[f64; 2]> = self.names.iter().filter_map(place).map(|place| found.by_parameters[place]).collect();
        let sigma = |axis: usize| {
            let slope = nalgebra::DVector::from_iterator(by.len(), by.iter().map(|by| by[axis]));
            (slope.transpose() * &self.covariance * &slope)[0].max(0.0).sqrt()
        };
        Some([(found.point.x, sigma(0)), (found.point.y, sigma(1))])
    }
}
