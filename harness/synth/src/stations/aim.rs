//! What the generators of stations are told about a field.

use calibench_model::{Pose, Testfield};
use nalgebra::{Point3, Rotation3, Unit, Vector3};

/// The middle of a field, the way it faces and its upwards direction: three axes at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aim {
    /// The middle of the targets as surveyed, object units.
    pub middle: Point3<f64>,
    /// From the field towards the cameras: a direction in object axes, of length 1.
    pub facing: Unit<Vector3<f64>>,
    /// Upwards along the field: a direction in object axes, of length 1.
    pub up: Unit<Vector3<f64>>,
}

impl Aim {
    /// At `middle` (object units), seen against `facing`, with `up` as near as can be; both are directions in object axes, of any length. `None` if
    /// they are parallel or vanish.
    pub fn new(middle: Point3<f64>, facing: Vector3<f64>, up: Vector3<f64>) -> Option<Self> {
        let facing = Unit::try_new(facing, 0.0)?;
        let across = up - facing.into_inner() * facing.dot(&up);
        let up = Unit::try_new(across, 1e-9 * up.norm())?;
        Some(Self { middle, facing, up })
    }

    /// At the middle of the box around a field's targets, from where its sheets face in the mean, upwards as its first sheet.
    ///
    /// `None` without targets, or when the sheets face no common way.
    pub fn of(field: &Testfield) -> Option<Self> {
        let points = || field.targets.iter().map(|target| target.surveyed);
        let first = points().next()?;
        let (low, high) = points().fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p)));
        let facing: Vector3<f64> = field.plates.iter().map(calibench_model::Plate::normal).sum();
        if facing.norm() < 0.1 * field.plates.len() as f64 {
            return None;
        }
        Self::new(nalgebra::center(&low, &high), facing, field.plates.first()?.v)
    }

    /// To the right along the field, for who looks at its front: a direction in object axes, of length 1.
    pub fn right(&self) -> Vector3<f64> {
        self.up.cross(&self.facing)
    }

    /// A camera that looks at the middle from `distance` (object units), as if the field had been turned before it by `turn` (in the field's own
    /// axes: right, up, facing) and the camera rolled by `roll` radians. `None` at no distance.
    pub fn view(&self, turn: &Rotation3<f64>, distance: f64, roll: f64) -> Option<Pose> {
        let axes = nalgebra::Matrix3::from_columns(&[self.right(), self.up.into_inner(), self.facing.into_inner()]);
        let towards = axes * (turn.inverse() * Vector3::z());
        let up = axes * (turn.inverse() * Vector3::y());
        Pose::looking_at(self.middle + towards * distance, self.middle, up, roll)
    }
}
