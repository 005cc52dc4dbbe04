//! A camera with what is known of it.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::named_camera::ParameterCovariance;
use nalgebra::DMatrix;

use crate::TaskError;

/// A camera with what is known of it.
#[derive(Clone, Copy, Debug)]
pub struct KnownCamera<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// Covariance of its parameters, if it is known.
    pub covariance: Option<&'a ParameterCovariance>,
    /// By how many times the cameras of photographs that are left out, or of halves of them, differ more than the covariance says, a number; below 1 as 1. `None` where nobody looked.
    pub halves: Option<f64>,
}

impl<'a> KnownCamera<'a> {
    /// A camera as files have it, of which nobody looked how far its model errs.
    pub fn of(named: &'a NamedCamera) -> Self {
        Self { camera: &named.camera, covariance: named.covariance.as_ref(), halves: None }
    }

    /// Whether only standard deviations are known: parameters are then taken as independent, which makes most measurements look worse.
    pub fn is_uncorrelated(&self) -> bool {
        self.covariance.is_some_and(|covariance| {
            let count = covariance.parameters.len();
            count > 1 && covariance.values.iter().enumerate().all(|(place, value)| *value == 0.0 || place / count == place % count)
        })
    }

    /// The standard deviation of the model's error in those of the covariance: the root of what `halves` adds to the variance.
    pub(crate) fn excess(&self) -> f64 {
        self.halves.map_or(0.0, |times| (times * times - 1.0).max(0.0).sqrt())
    }

    /// All parameters by independent standard normal numbers: `F` of `F F^T`, the covariance; without columns where none is known.
    pub(crate) fn factor(&self) -> Result<DMatrix<f64>, TaskError> {
        let parameters = self.camera.parameters();
        let Some(covariance) = self.covariance else { return Ok(DMatrix::zeros(parameters.len(), 0)) };
        let place = |name: &String| {
            parameters.iter().position(|parameter| parameter.name == name.as_str()).ok_or_else(|| TaskError::Parameter(name.clone()))
        };
        let places = covariance.parameters.iter().map(place).collect::<Result<Vec<_>, _>>()?;
        let count = places.len();
        let values = DMatrix::from_row_slice(count, count, &covariance.values);
        // As correlations, since units differ by many powers of ten.
        let sigmas: Vec<f64> = (0..count).map(|i| values[(i, i)].sqrt()).collect();
        let scaled = |i: usize, j: usize| if sigmas[i] > 0.0 && sigmas[j] > 0.0 { values[(i, j)] / sigmas[i] / sigmas[j] } else { 0.0 };
        let eigen = DMatrix::from_fn(count, count, scaled).symmetric_eigen();
        let mut factor = DMatrix::zeros(parameters.len(), count);
        for (row, &place) in places.iter().enumerate() {
            for column in 0..count {
                factor[(place, column)] = sigmas[row] * eigen.eigenvectors[(row, column)] * eigen.eigenvalues[column].max(0.0).sqrt();
            }
        }
        Ok(factor)
    }
}
