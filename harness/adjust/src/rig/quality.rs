//! Covariances of a rig.

use calibench_model::Pose;
use nalgebra::{DMatrix, Matrix3x6, Matrix6, Vector6};

use super::frames::{adjoint, relative};
use super::solution::RigSolution;
use crate::AdjustError;
use crate::quality::Variance;

/// A pose with its covariance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mount {
    /// The pose.
    pub pose: Pose,
    /// Covariance of a small rotation about its own axes (radians) and a shift along them (object units): 6 x 6.
    pub covariance: Matrix6<f64>,
}

impl Mount {
    /// Standard deviations of X0, Y0, Z0 (the projection centre, along the axes of the frame that the pose is in), object units.
    pub fn centre_sigmas(&self) -> [f64; 3] {
        let m = &self.pose.rotation;
        let shift = m.transpose() * self.covariance.fixed_view::<3, 3>(3, 3) * m;
        [0, 1, 2].map(|i| shift[(i, i)].max(0.0).sqrt())
    }

    /// Standard deviations of t of `N = M X + t`, along its own axes, object units: t turns with the camera.
    pub fn translation_sigmas(&self) -> [f64; 3] {
        let t = -(self.pose.rotation * self.pose.centre.coords);
        // t' = t + d x t + s.
        let turned = -t.cross_matrix();
        let by = Matrix3x6::from_fn(|i, j| if j < 3 { turned[(i, j)] } else { f64::from(u8::from(i + 3 == j)) });
        let all = by * self.covariance * by.transpose();
        [0, 1, 2].map(|i| all[(i, i)].max(0.0).sqrt())
    }

    /// Standard deviations of the rotation about its own axes, radians.
    pub fn rotation_sigmas(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| self.covariance[(i, i)].max(0.0).sqrt())
    }

    /// How far its projection centre is from the origin of the frame it is in, with the standard deviation, object units.
    pub fn distance(&self) -> (f64, f64) {
        let length = self.pose.centre.coords.norm();
        if length == 0.0 {
            return (0.0, 0.0);
        }
        let along = self.pose.rotation * self.pose.centre.coords / length;
        let by = Vector6::new(0.0, 0.0, 0.0, along.x, along.y, along.z);
        (length, by.dot(&(self.covariance * by)).max(0.0).sqrt())
    }
}

/// Covariances of a rig.
#[derive(Clone, Debug)]
pub struct RigCovariances {
    /// With which cofactors were multiplied.
    pub variance_factor: f64,
    /// The unknown parameters of the cameras: camera and name.
    pub parameters: Vec<(usize, &'static str)>,
    /// Their covariance, then that of the mounts, six numbers each in the order of the cameras, without the origin.
    pub kept: DMatrix<f64>,
    mount: Vec<Option<usize>>,
    mounts: Vec<Pose>,
}

impl RigCovariances {
    /// The parameters of a camera that are unknowns, and their covariance in their units.
    pub fn of_camera(&self, camera: usize) -> (Vec<&'static str>, DMatrix<f64>) {
        let rows: Vec<usize> = (0..self.parameters.len()).filter(|&row| self.parameters[row].0 == camera).collect();
        let names = rows.iter().map(|&row| self.parameters[row].1).collect();
        (names, DMatrix::from_fn(rows.len(), rows.len(), |i, j| self.kept[(rows[i], rows[j])]))
    }

    /// The first row of a camera's mount in [`Self::kept`]; `None` of the origin.
    pub fn first_of_mount(&self, camera: usize) -> Option<usize> {
        self.mount[camera]
    }

    /// The mount of a camera.
    pub fn mount(&self, camera: usize) -> Mount {
        Mount { pose: self.mounts[camera], covariance: self.between(camera, camera) }
    }

    /// `second` as `first` sees it.
    pub fn relative(&self, first: usize, second: usize) -> Mount {
        let pose = relative(&self.mounts[first], &self.mounts[second]);
        let adjoint = adjoint(&pose);
        let cross = self.between(second, first) * adjoint.transpose();
        let covariance =
            self.between(second, second) + adjoint * self.between(first, first) * adjoint.transpose() - cross - cross.transpose();
        Mount { pose, covariance }
    }

    /// Covariance of two mounts: zero with the origin.
    fn between(&self, a: usize, b: usize) -> Matrix6<f64> {
        match (self.mount[a], self.mount[b]) {
            (Some(a), Some(b)) => self.kept.fixed_view::<6, 6>(a, b).into_owned(),
            _ => Matrix6::zeros(),
        }
    }
}

impl RigSolution<'_> {
    /// Covariances of interiors and mounts.
    ///
    /// # Errors
    /// [`AdjustError::NotAvailable`] if the variance is to be estimated without redundancy.
    pub fn covariances(&self, variance: Variance) -> Result<RigCovariances, AdjustError> {
        let variance_factor = self.variance(variance)?;
        let named = |(camera, place): (usize, &crate::network::CameraPlace)| {
            use calibench_model::camera::CameraModel;
            let parameters = self.state.cameras[camera].parameters();
            place.free.iter().map(|&i| (camera, parameters[i].name)).collect::<Vec<_>>()
        };
        Ok(RigCovariances {
            variance_factor,
            parameters: self.frame.layout.cameras.iter().enumerate().flat_map(named).collect(),
            kept: &self.cofactors.kept * variance_factor,
            mount: self.frame.mount.clone(),
            mounts: self.state.mounts.clone(),
        })
    }

    /// The covariance of a station: a small rotation about the rig's axes, radians, and a shift along them, object units.
    ///
    /// # Errors
    /// As [`Self::covariances`].
    pub fn station_covariance(&self, station: usize, variance: Variance) -> Result<Matrix6<f64>, AdjustError> {
        Ok(self.cofactors.stations[station].0 * self.variance(variance)?)
    }

    pub(super) fn variance(&self, variance: Variance) -> Result<f64, AdjustError> {
        const NONE: AdjustError = AdjustError::NotAvailable("without redundancy there is no estimated variance");
        match variance {
            Variance::Apriori => Ok(1.0),
            Variance::Estimated => self.sigma0().map(|sigma0| sigma0 * sigma0).ok_or(NONE),
        }
    }
}
