//! Points of known object coordinates: control.

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
