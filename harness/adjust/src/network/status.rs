//! Fixed, free or observed.

use nalgebra::{Matrix3, Point3};

/// What is known of a number before the adjustment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Status {
    /// Nothing but a start value.
    #[default]
    Free,
    /// All: it keeps its start value and is no unknown.
    Fixed,
    /// It was observed.
    Observed {
        /// What was observed, in the number's own unit.
        value: f64,
        /// Its standard deviation, a priori, in the same unit.
        sigma: f64,
    },
}

/// What is known of a projection centre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Centre {
    /// Nothing but a start value.
    #[default]
    Free,
    /// All.
    Fixed,
    /// It was observed.
    Observed {
        /// X0, object units.
        value: Point3<f64>,
        /// Standard deviations of X0, Y0 and Z0, object units.
        sigma: [f64; 3],
    },
}

/// What is known of a rotation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Attitude {
    /// Nothing but a start value.
    #[default]
    Free,
    /// All.
    Fixed,
    /// It was observed.
    Observed {
        /// M, 3 x 3: from object to camera axes.
        value: Matrix3<f64>,
        /// Standard deviations about the camera's axes x, y and z, radians.
        sigma: [f64; 3],
    },
}

impl Status {
    /// Whether it is an unknown of the adjustment: free or observed.
    pub const fn is_unknown(self) -> bool {
        !matches!(self, Self::Fixed)
    }
}
