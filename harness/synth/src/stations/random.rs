//! Stations at random within bounds.

use std::f64::consts::TAU;

use calibench_model::Pose;
use calibench_random::{Key, Purpose, stream};
use rand::{Rng, RngExt};

use super::{Aim, Station, StationError, angle, length, within};

/// How many poses are tried for a station.
const TRIES: usize = 1000;

/// Stations at random within bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomViews {
    /// How many, 1 to 10000.
    pub count: usize,
    /// The least and the greatest distance from the middle, object units.
    pub distance: [f64; 2],
    /// The greatest angle of the line of sight from the normal, radians, 0 to 85 degrees; all directions within are equally likely.
    pub tilt: f64,
    /// Rolls are uniform from minus to plus this, radians, 0 to 180 degrees.
    pub roll: f64,
    /// The cameras look at a point this far from the middle at most, to the right or left and up or down, object units.
    pub aside: [f64; 2],
}

impl RandomViews {
    /// The stations, `s01`, `s02`, ..., each the first of its own random poses that `accepts` takes: one that sees enough of the field, say.
    ///
    /// # Errors
    /// A parameter out of its range; [`StationError::NoneSees`] when 1000 poses of a station were refused.
    pub fn generate(&self, aim: &Aim, key: Key<'_>, accepts: impl Fn(&Pose) -> bool) -> Result<Vec<Station>, StationError> {
        self.check()?;
        let station = |i: usize| {
            let name = super::named(i, 0, 1);
            let mut rng = stream(Key { view: &name, ..key }, Purpose::Station);
            let pose = (0..TRIES).find_map(|_| self.pose(aim, &mut rng).filter(&accepts));
            pose.map(|pose| Station::new(name.clone(), pose)).ok_or(StationError::NoneSees { name, tries: TRIES })
        };
        (0..self.count).map(station).collect()
    }

    fn check(&self) -> Result<(), StationError> {
        within("count", self.count as f64, 1.0, 1e4)?;
        self.distance.iter().try_for_each(|&distance| length("distance", distance))?;
        if self.distance[0] > self.distance[1] {
            let expected = format!("at least the first, {}", self.distance[0]);
            return Err(StationError::Parameter { parameter: "distance", value: self.distance[1], expected });
        }
        angle("tilt", self.tilt, 0.0, 85.0)?;
        angle("roll", self.roll, 0.0, 180.0)?;
        self.aside.iter().try_for_each(|&aside| within("aside", aside, 0.0, 1e9))
    }

    fn pose(&self, aim: &Aim, rng: &mut impl Rng) -> Option<Pose> {
        let mut uniform = |low: f64, high: f64| low + (high - low) * rng.random::<f64>();
        let distance = uniform(self.distance[0], self.distance[1]);
        // Uniform on the cap of the sphere: its area grows with the cosine.
        let cosine: f64 = uniform(self.tilt.cos(), 1.0);
        let (side_up, side_right) = uniform(0.0, TAU).sin_cos();
        let roll = uniform(-self.roll, self.roll);
        let [right, up] = self.aside.map(|aside| uniform(-aside, aside));
        let side = aim.right() * side_right + aim.up.into_inner() * side_up;
        let towards = aim.facing.into_inner() * cosine + side * (1.0 - cosine * cosine).max(0.0).sqrt();
        let target = aim.middle + aim.right() * right + aim.up.into_inner() * up;
        Pose::looking_at(target + towards * distance, target, aim.up.into_inner(), roll)
    }
}
