//! What is to be measured, from where, and how well its parts are known.

use calibench_model::Pose;
use nalgebra::{Point3, Vector3};

use crate::Quantity;

/// Something that is to be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// The unit of the object, as it is named.
    pub unit: Option<String>,
    /// What is measured.
    pub quantity: Quantity,
    /// The images that it is measured in: one with a known plane, or more without.
    pub images: Vec<Station>,
    /// The plane that all of it lies in, of a single image.
    pub plane: Option<KnownPlane>,
    /// Standard deviation of an image coordinate of what is measured, px.
    pub sigma_px: f64,
    /// How control errs, if poses come from it.
    pub control: ControlErrors,
    /// Relative standard uncertainty of the scale of the object's frame: of the board, or of the coordinates that poses come from; 0 where it is taken as exact.
    pub scale_sigma: f64,
    /// What is known of the object's temperature.
    pub temperature: Option<Temperature>,
}

/// Where an image is taken from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// The pose.
    pub pose: Pose,
    /// Standard deviation of each coordinate of the projection centre, object units; 0 where it is taken as exact. Not used with control.
    pub sigma_centre: f64,
    /// Standard deviation of a rotation about each axis of the camera, rad; 0 where it is taken as exact. Not used with control.
    pub sigma_angles: f64,
}

/// A known plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownPlane {
    /// A point of it, about which it is tilted, object units.
    pub point: Point3<f64>,
    /// Its normal, of length one.
    pub normal: Vector3<f64>,
    /// Standard deviation of where it lies along its normal, object units; 0 where it is taken as exact.
    pub sigma: f64,
    /// Standard deviation of its tilt about either axis in it, rad; 0 where it is taken as exact.
    pub sigma_tilt: f64,
}

impl KnownPlane {
    /// Two axes in the plane, of length one.
    pub fn axes(&self) -> [Vector3<f64>; 2] {
        let across = self.normal.cross(&if self.normal.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() }).normalize();
        [across, self.normal.cross(&across)]
    }
}

/// How control errs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ControlErrors {
    /// Standard deviation of an image coordinate, px.
    pub sigma_px: f64,
    /// Standard deviation of each coordinate of a point that its file gives none for, object units; 0 where it is taken as exact.
    pub print_sigma: f64,
    /// Standard deviation of each of the three bends of a board (along it, across, twist; object units, as `calibrate` tells them); 0 where it is taken as flat.
    pub flatness_sigma: f64,
}

/// The temperature of an object, by which lengths are brought to that of the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Temperature {
    /// Object less reference, K.
    pub difference: f64,
    /// Its standard uncertainty, K.
    pub sigma: f64,
    /// Coefficient of expansion, 1/K.
    pub expansion: f64,
    /// Its standard uncertainty, 1/K.
    pub expansion_sigma: f64,
}

impl Temperature {
    /// Relative standard uncertainty of a length at the reference's temperature.
    pub fn relative_sigma(&self) -> f64 {
        (self.expansion * self.sigma).hypot(self.difference * self.expansion_sigma)
    }
}
