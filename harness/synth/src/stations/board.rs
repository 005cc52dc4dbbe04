//! Views of a board at given tilts and distances.

use nalgebra::{Rotation3, Vector3};

use super::{Aim, Station, StationError, angle, length, named, rolls};

/// Every tilt at every distance with every roll.
///
/// A tilt turns the board before the camera: about its own u axis (to the right) first, then about the v axis of the untilted board (upwards), both
/// right-handed. The board stays where it is in object space; the camera goes round it.
#[derive(Clone, Debug, PartialEq)]
pub struct BoardViews {
    /// Tilts about u and v, radians; each within 85 degrees.
    pub tilts: Vec<[f64; 2]>,
    /// Distances from the middle, object units.
    pub distances: Vec<f64>,
    /// Rolls (kappa), radians.
    pub rolls: Vec<f64>,
}

impl BoardViews {
    /// The stations, named as those of [`super::Ring`]: all tilts at the first distance, then at the next.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn generate(&self, aim: &Aim) -> Result<Vec<Station>, StationError> {
        for (name, empty) in [("tilts", self.tilts.is_empty()), ("distances", self.distances.is_empty())] {
            if empty {
                return Err(StationError::Empty(name));
            }
        }
        self.tilts.iter().flatten().try_for_each(|&tilt| angle("tilts", tilt, -85.0, 85.0))?;
        self.distances.iter().try_for_each(|&distance| length("distances", distance))?;
        rolls(&self.rolls)?;
        let places = self.distances.iter().flat_map(|distance| self.tilts.iter().map(move |tilt| (tilt, distance)));
        let mut stations = Vec::new();
        for (i, (&[about_u, about_v], &distance)) in places.enumerate() {
            let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), about_v) * Rotation3::from_axis_angle(&Vector3::x_axis(), about_u);
            for (k, &roll) in self.rolls.iter().enumerate() {
                let name = named(i, k, self.rolls.len());
                let pose = aim.view(&turn, distance, roll).ok_or_else(|| StationError::Undetermined(name.clone()))?;
                stations.push(Station::new(name, pose));
            }
        }
        Ok(stations)
    }
}
