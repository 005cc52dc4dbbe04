//! Views of a field that is turned on a stand before a camera that stays where it is.

use calibench_model::testfield::Bend;
use calibench_model::{Plate, Testfield};
use nalgebra::{Rotation3, Vector3};

use super::{Aim, Station, StationError, angle, length, rolls, within};

/// Most values of a kind: each is one digit of a station's name.
const MOST: usize = 9;
/// Over the whole sheet a bend is at most this part of its shorter side high: it is a board's, not a roll's.
const HIGHEST: f64 = 0.25;

/// A field on a stand: turned in its own plane, tilted with the stand before the camera, and the camera rolled; every tilt with every turn and roll.
///
/// A tilt turns the stand about its upright axis, which passes through the field's middle; a turn turns the field on the stand about the field's normal.
/// Both are right-handed: a positive turn is anticlockwise for the camera. Object space is the field's own: the camera goes round it. Without tilt, turning
/// the field is rolling the camera the other way, and the field is pictured with the first turn only.
///
/// Source: Vosselman & Förstner 1988, section 2.2 and figure 3.
#[derive(Clone, Debug, PartialEq)]
pub struct Stand {
    /// Tilts phi, radians; each within 85 degrees.
    pub phis: Vec<f64>,
    /// Turns of the field in its own plane (the testfield's kappa), radians.
    pub turns: Vec<f64>,
    /// Rolls of the camera (its kappa), radians.
    pub rolls: Vec<f64>,
    /// Distance from the middle, object units.
    pub distance: f64,
    /// How the stand bends what it holds.
    pub bend: Option<StandBend>,
}

/// A bend that stays where it is on the stand, and passes over the field as that is turned: the height is that of [`Bend`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandBend {
    /// The height in the field's middle over that at `reach` from it, towards the camera, object units.
    pub peak: f64,
    /// How far from the middle the height is zero, object units; beyond, it goes on falling.
    pub reach: f64,
    /// The direction across the crest, from the stand's right (for the camera) upwards, radians.
    pub across: f64,
}

impl Stand {
    /// The stations, all turns and rolls of the first tilt, then of the next. They are called as the recordings of the paper: a 1, and the numbers of tilt,
    /// turn and roll, counted from 1.
    ///
    /// # Errors
    /// A parameter out of its range; on a stand that bends, a field that is not one sheet or is bent itself.
    pub fn generate(&self, aim: &Aim, field: &Testfield) -> Result<Vec<Station>, StationError> {
        self.check()?;
        let bent = self.bend.map(|bend| Ok((bend, bendable(field)?))).transpose()?;
        let mut stations = Vec::new();
        for (i, &phi) in self.phis.iter().enumerate() {
            let turns = if phi == 0.0 { &self.turns[..1] } else { &self.turns[..] };
            for (j, &turn) in turns.iter().enumerate() {
                let turned = Rotation3::from_axis_angle(&Vector3::y_axis(), phi) * Rotation3::from_axis_angle(&Vector3::z_axis(), turn);
                let bend = bent.map(|(bend, plate)| bend.on(aim, plate, turn)).transpose()?;
                for (k, &roll) in self.rolls.iter().enumerate() {
                    let name = format!("1{}{}{}", i + 1, j + 1, k + 1);
                    let pose = aim.view(&turned, self.distance, roll).ok_or_else(|| StationError::Undetermined(name.clone()))?;
                    stations.push(Station { bend, ..Station::new(name, pose) });
                }
            }
        }
        Ok(stations)
    }

    fn check(&self) -> Result<(), StationError> {
        for (parameter, values) in [("phis", &self.phis), ("turns", &self.turns), ("rolls", &self.rolls)] {
            if values.is_empty() {
                return Err(StationError::Empty(parameter));
            }
            if values.len() > MOST {
                return Err(StationError::Many { parameter, found: values.len(), most: MOST });
            }
        }
        self.phis.iter().try_for_each(|&phi| angle("phis", phi, -85.0, 85.0))?;
        self.turns.iter().try_for_each(|&turn| angle("turns", turn, -360.0, 360.0))?;
        rolls(&self.rolls)?;
        length("distance", self.distance)?;
        let Some(bend) = self.bend else { return Ok(()) };
        length("bend_reach", bend.reach)?;
        within("bend", bend.peak, -1e6, 1e6)?;
        angle("bend_across", bend.across, -360.0, 360.0)
    }
}

/// The sheet of a field that a stand can bend.
fn bendable(field: &Testfield) -> Result<&Plate, StationError> {
    let [plate] = &field.plates[..] else { return Err(StationError::Plates(field.plates.len())) };
    if plate.bend.is_some() { Err(StationError::BentTwice(plate.id.clone())) } else { Ok(plate) }
}

impl StandBend {
    /// The bend in the axes of `plate`, which `turn` (radians) has turned on the stand.
    fn on(&self, aim: &Aim, plate: &Plate, turn: f64) -> Result<Bend, StationError> {
        let (sine, cosine) = (self.across - turn).sin_cos();
        let axis = aim.right() * cosine + aim.up.into_inner() * sine;
        let middle = aim.middle - plate.origin;
        let bend = Bend {
            peak: self.peak,
            middle: [middle.dot(&plate.u), middle.dot(&plate.v)],
            across: axis.dot(&plate.v).atan2(axis.dot(&plate.u)),
            reach: self.reach,
            along: 0.0,
        };
        let [[u0, v0], [u1, v1]] = plate.corners;
        let most = HIGHEST * (u1 - u0).min(v1 - v0);
        let lowest = [[u0, v0], [u1, v0], [u1, v1], [u0, v1]].map(|at| (bend.height(at) - self.peak).abs()).into_iter().fold(0.0, f64::max);
        if lowest > most {
            let expected = format!("at most {:.6}, which makes {most} over the whole sheet", self.peak.abs() * most / lowest);
            return Err(StationError::Parameter { parameter: "bend", value: self.peak, expected });
        }
        Ok(bend)
    }
}

#[cfg(test)]
mod tests;
