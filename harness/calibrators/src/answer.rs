//! What a calibrator answers.

use calibench_model::camera::Ray;
use calibench_model::{Covariance, NamedCamera};
use nalgebra::{DMatrix, Point3};

/// How a calibration ended, as its system says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Status {
    /// A camera, and nothing said against it.
    Calibrated,
    /// A camera, and a doubt said.
    Doubtful,
    /// The system says that there is none to be had from this.
    Refused,
    /// An exception, no convergence, no answer, or one that cannot be read.
    Failed,
}

impl Status {
    /// All of them with their names.
    pub const ALL: [(Self, &'static str); 4] =
        [(Self::Calibrated, "calibrated"), (Self::Doubtful, "doubtful"), (Self::Refused, "refused"), (Self::Failed, "failed")];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(status, _)| *status == self).map_or("", |(_, name)| name)
    }

    /// The one of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, other)| *other == name).map(|(status, _)| *status)
    }
}

/// What standard deviations are scaled by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scaled {
    /// Image coordinates of 1 px, whatever they were.
    Unit,
    /// The stated standard deviation of an image coordinate.
    Stated,
    /// The adjustment's own sigma0.
    Sigma0,
}

impl Scaled {
    /// The one of that name.
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "unit" => Self::Unit,
            "stated" => Self::Stated,
            "sigma0" => Self::Sigma0,
            _ => return None,
        })
    }
}

/// A calibrated camera, in whichever form its system has one.
#[derive(Clone, Debug, PartialEq)]
pub enum Lens {
    /// A camera of a model that calibench has.
    Camera(Box<NamedCamera>),
    /// A ray for each place of the task's grid: x right, y down, z forwards; `None` where nothing is pictured.
    Rays(Vec<Option<Ray>>),
}

/// What a system says of how well its camera is known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Precision {
    /// Covariance of the camera's parameters, with their names.
    pub covariance: Option<(Vec<String>, DMatrix<f64>)>,
    /// Standard deviations of parameters, where that is all that it says.
    pub sigmas: Vec<(String, f64)>,
    /// Of each place of the task's grid, how well the image of a point far away is known there, px²; empty where it does not say.
    pub at_grid: Vec<Option<Covariance>>,
    /// What these are scaled by, where it says so.
    pub scaled: Option<Scaled>,
}

/// An answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// How it ended.
    pub status: Status,
    /// What the system says to its user.
    pub messages: Vec<String>,
    /// Its camera, if there is one.
    pub lens: Option<Lens>,
    /// How well it says that this is known.
    pub precision: Precision,
    /// RMS of residuals as it reports it, px.
    pub rms_px: Option<f64>,
    /// Iterations.
    pub iterations: Option<u64>,
    /// The shape of the board as it was adjusted, object units; empty where it was not.
    pub shape: Vec<Point3<f64>>,
    /// Image points that it left out: places in the task's images and in their points.
    pub outliers: Vec<(usize, usize)>,
}

impl Answer {
    /// One without a camera, with the reason.
    pub fn without(status: Status, why: impl Into<String>) -> Self {
        Self {
            status,
            messages: vec![why.into()],
            lens: None,
            precision: Precision::default(),
            rms_px: None,
            iterations: None,
            shape: Vec::new(),
            outliers: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_status_has_a_name_of_its_own() {
        for (status, name) in Status::ALL {
            assert_eq!((status.name(), Status::named(name)), (name, Some(status)));
        }
        assert_eq!((Status::named("fine"), Scaled::named("pixels")), (None, None));
    }
}
