//! What a file knows of a camera, in other images.

use nalgebra::{DMatrix, DVector};

use super::{Reframing, ReframingError};
use crate::camera::{Camera, CameraModel};
use crate::convert::Region;
use crate::named_camera::{NamedCamera, ParameterCovariance, Splines};

/// Half the step of differences: formulas are linear in all parameters but b1, in which they are nearly so.
const STEP: f64 = 1e-4;

impl Reframing {
    /// The same camera in the new images with its pitch, its splines, its covariance and its pose, and what of it was dropped, in words.
    ///
    /// # Errors
    /// As [`Self::camera`]; a covariance that is not the camera's.
    pub fn named(&self, named: &NamedCamera) -> Result<(NamedCamera, Vec<String>), ReframingError> {
        let camera = self.camera(&named.camera)?;
        let covariance = named.covariance.as_ref().map(|stated| self.covariance(&named.camera, stated)).transpose()?;
        let (by, mut dropped) = (&self.resampling, Vec::new());
        let pitch_um = named.pitch_um.filter(|_| by.is_isotropic()).map(|pitch| pitch / by.scale[0]);
        if let (Some(pitch), None) = (named.pitch_um, pitch_um) {
            dropped.push(format!("the pixel pitch, {pitch} um: the new pixels are no squares"));
        }
        let splines = named.splines.as_ref().map(|splines| Box::new(self.splines(splines)));
        let pose = named.pose.map(|pose| self.turn.map_or(pose, |turn| pose.turned_by(turn.rotation())));
        Ok((NamedCamera { camera, splines, pitch_um, pose, covariance, ..named.clone() }, dropped))
    }

    /// Splines; of what is said in px of the fit to them the larger scale for a misfit and the smaller one for a radius.
    fn splines(&self, splines: &Splines) -> Splines {
        let [along, down] = self.resampling.scale;
        let region = match splines.region {
            Region::Radius { px } => Region::Radius { px: px * along.min(down) },
            region @ Region::Frame => region,
        };
        Splines { model: self.of_model(&splines.model), residual_px: splines.residual_px * along.max(down), region }
    }

    /// `J Q J^T`, J = d(new parameters) / d(parameters) by central differences. Parameters that were held fixed stay so.
    fn covariance(&self, camera: &Camera, stated: &ParameterCovariance) -> Result<ParameterCovariance, ReframingError> {
        let q = stated.whole(camera).map_err(ReframingError::Covariance)?;
        let values = |camera: &Camera| -> Vec<f64> { camera.parameters().iter().map(|p| p.value).collect() };
        let before = values(camera);
        let columns = (0..before.len()).map(|i| {
            let step = STEP * before[i].abs().max(1.0);
            let at = |change: f64| {
                let mut changed = before.clone();
                changed[i] += change;
                DVector::from_vec(values(&self.of_model(&camera.with_parameters(&changed))))
            };
            (at(step) - at(-step)) / (2.0 * step)
        });
        let jacobian = DMatrix::from_columns(&columns.collect::<Vec<_>>());
        let new = self.of_model(camera);
        ParameterCovariance::of(&new, &(&jacobian * q * jacobian.transpose())).map_err(ReframingError::Covariance)
    }
}
