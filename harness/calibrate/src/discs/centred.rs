//! Observations of the centres of discs' pictures, as observations of pictures of the discs' centres.

use calibench_adjust::Solution;
use calibench_model::PixelPoint;
use calibench_model::eccentricity::{Disc, in_image};
use rayon::prelude::*;

use super::Known;
use super::plane::Neighbours;
use crate::ended::ended;
use crate::{Calibration, CalibrationError, Discs, Eccentricity, Prepared};

/// Change of a correction with which the rounds end, px.
const SMALL: f64 = 1e-6;
/// Rounds at most: each gains the ratio of the disc's radius to its distance, squared.
const ROUNDS: usize = 20;

impl Calibration<'_> {
    /// The same network from the end of this adjustment, its observations freed of the eccentricity of discs; `None` where there is no disc or it was not asked
    /// for.
    ///
    /// Offsets follow from the solution and the solution from them, in rounds until none changes by more than 1e-6 px. Their small dependence on the unknowns is
    /// not in the normal equations; at the end it need not be.
    ///
    /// # Errors
    /// Discs whose plane nobody states and whose neighbours lie in none; none at all; an adjustment that fails.
    pub(crate) fn centred(&self) -> Result<Option<Prepared>, CalibrationError> {
        let Some(discs) = self.prepared.settings.discs else { return Ok(None) };
        let known = self.known(discs);
        if known.count() == 0 {
            return Err(CalibrationError::NoDisc { with_radius: discs != Discs::Control });
        }
        let mut centred = Prepared { network: self.ended(), ..self.prepared.clone() };
        let mut found = eccentricity(&self.solution, &known)?;
        for _ in 0..ROUNDS {
            let before = centred.taken(found);
            let solution = centred.solution()?;
            found = eccentricity(&solution.0, &known)?;
            centred.network = ended(&solution.0);
            if before.iter().zip(&found.offsets).all(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]) < SMALL) {
                return Ok(Some(centred));
            }
        }
        Err(CalibrationError::NotCentred)
    }

    /// What would be taken from the centres of those discs whose radius is known, where that was not asked for.
    pub fn untaken(&self) -> Option<Eccentricity> {
        let prepared = self.prepared;
        let known = (prepared.settings.discs.is_none() && prepared.survey.states_discs()).then(|| self.known(Discs::Control))?;
        if known.count() == 0 { None } else { eccentricity(&self.solution, &known).ok() }
    }

    fn known(&self, discs: Discs) -> Known {
        let Prepared { network, survey, sights, .. } = self.prepared;
        let seen = network.observations.iter().zip(sights).map(|(observation, &sight)| (observation.point, sight as usize));
        Known::of(survey, network.points.len(), seen, discs)
    }
}

impl Prepared {
    /// Takes an eccentricity from what was measured, and gives the offsets that were taken before.
    fn taken(&mut self, found: Eccentricity) -> Vec<[f64; 2]> {
        let rows = self.network.observations.iter_mut().zip(&self.sights).zip(&found.offsets);
        for ((observation, &sight), [x, y]) in rows {
            let measured = self.survey.sight(sight as usize).position;
            observation.position = PixelPoint::new(measured.x - x, measured.y - y);
        }
        let offsets = found.offsets.clone();
        self.eccentricity = Some(found);
        offsets
    }
}

/// The eccentricity of each observation of a disc as a solution pictures it; zero where not all of the disc has a picture.
fn eccentricity(solution: &Solution<'_>, known: &Known) -> Result<Eccentricity, CalibrationError> {
    let (network, points) = (solution.network(), solution.points());
    let neighbours = Neighbours::new(points.iter().copied());
    let normals = known.normals(|point| network.points[point].name.clone(), |point| neighbours.normal(&points[point]))?;
    let offset = |(index, observation): (usize, &calibench_adjust::ImageObservation)| {
        let (radius, normal) = normals[observation.point].filter(|_| known.is_disc(index))?;
        let pose = &solution.poses()[observation.image];
        let disc = Disc::seen_from(pose, &points[observation.point], &normal, radius)?;
        in_image(&solution.cameras()[network.images[observation.image].camera], &disc)
    };
    let offsets: Vec<Option<[f64; 2]>> = network.observations.par_iter().enumerate().map(offset).collect();
    let image_points = known.count();
    let unpictured = image_points - offsets.iter().flatten().count();
    let offsets = offsets.into_iter().map(Option::unwrap_or_default).collect();
    Ok(Eccentricity { offsets, image_points, discs: known.discs(), unpictured, unstated: known.unstated() })
}
