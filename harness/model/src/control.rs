//! What is known of an object: points of known coordinates (control), and distances and lengths.

/// A point of known object coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct ControlRow {
    /// The target's name.
    pub target: String,
    /// X, Y, Z, object units.
    pub position: [f64; 3],
    /// Standard deviations of X, Y, Z, object units; `None` where none is given.
    pub sigmas: Option<[f64; 3]>,
    /// Of a disc: boxed, as few targets say so.
    pub disc: Option<Box<ControlDisc>>,
}

/// A measured corner of a board, in the board's own frame.
#[derive(Clone, Debug, PartialEq)]
pub struct BoardCorner {
    /// Its name.
    pub target: String,
    /// X, Y, Z, object units.
    pub position: [f64; 3],
    /// Standard deviations of X, Y, Z, object units.
    pub sigmas: [f64; 3],
    /// Covariances of X and Y, X and Z, Y and Z, object units squared; `None` where they are not stated.
    pub covariances: Option<[f64; 3]>,
    /// Where it is nominally: X, Y, Z, object units; `None` where that is not stated.
    pub nominal: Option<[f64; 3]>,
    /// In how many photographs it was measured, 0 where its nominal place stands for it; `None` where that is not stated.
    pub photographs: Option<usize>,
}

/// A measured distance between two targets, as the length of a scale bar.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredDistance {
    /// The targets at its ends.
    pub targets: [String; 2],
    /// Object units.
    pub value: f64,
    /// Its standard deviation, object units.
    pub sigma: f64,
}

/// A calibrated length by which measuring is tested, and what was measured of it.
#[derive(Clone, Debug, PartialEq)]
pub struct TestLength {
    /// The measurement line that it lies on.
    pub line: String,
    /// The targets at its ends.
    pub targets: [String; 2],
    /// Calibrated length, object units.
    pub calibrated: f64,
    /// Standard uncertainty of the calibrated length, object units; 0 where it is taken as exact.
    pub sigma: f64,
    /// Measured length, object units; `None` where it follows from measured points.
    pub measured: Option<f64>,
}

/// What is known of a target that is a disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlDisc {
    /// Object units.
    pub radius: f64,
    /// A normal of its plane in the object's frame, either way and of any length but zero; `None` where none is given.
    pub normal: Option<[f64; 3]>,
}

impl ControlRow {
    /// A point of known coordinates, object units.
    pub fn new(target: impl Into<String>, position: [f64; 3]) -> Self {
        Self { target: target.into(), position, sigmas: None, disc: None }
    }
}
