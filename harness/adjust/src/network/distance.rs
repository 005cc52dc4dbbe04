//! Observed distances between object points, as those of scale bars.

use super::check::{positive, within};
use super::{Network, NetworkError};

/// An observed distance between two object points, as a scale bar's length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceObservation {
    /// Indices of its ends among the network's points.
    pub points: [usize; 2],
    /// What was measured, object units.
    pub value: f64,
    /// Its standard deviation, object units.
    pub sigma: f64,
}

impl Network {
    /// The name of a distance in messages.
    pub fn name_of_distance(&self, distance: &DistanceObservation) -> String {
        let [from, to] = distance.points.map(|point| self.points[point].name.as_str());
        format!("the distance from {from} to {to}")
    }

    pub(super) fn check_distances(&self) -> Result<(), NetworkError> {
        let mut on_surface = vec![false; self.points.len()];
        for on in self.surfaces.iter().flat_map(|surface| &surface.points) {
            on_surface[on.point] = true;
        }
        for (index, distance) in self.distances.iter().enumerate() {
            distance.points.iter().try_for_each(|&point| within(|| format!("distance {index}"), "point", point, self.points.len()))?;
            let of = || self.name_of_distance(distance);
            positive(of, [distance.sigma])?;
            let refuse = |what| Err(NetworkError::NotANumber { of: of(), what });
            if !(distance.value > 0.0 && distance.value.is_finite()) {
                return refuse("it is not a positive number");
            }
            let [from, to] = distance.points.map(|point| self.points[point].position);
            if from == to {
                return refuse("its ends start at one place");
            }
            if distance.points.iter().any(|&point| on_surface[point]) {
                return refuse("a surface moves one of its ends");
            }
        }
        Ok(())
    }
}
