//! The eccentricity of discs in images whose orientation is known.

use calibench_model::camera::Camera;
use calibench_model::eccentricity::{Disc, in_image};
use calibench_model::{Pose, TargetKind};

use super::Known;
use super::plane::Neighbours;
use crate::{CalibrationError, Discs, Survey};

/// What is to be taken from an image point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Offset {
    /// It is of no disc.
    NoDisc,
    /// Centre of the disc's picture minus picture of its centre, px (x right, y down).
    Of([f64; 2]),
    /// It is of a disc, and this is missing.
    Unknown(&'static str),
}

/// The eccentricity of each image point of a survey as known cameras and poses, one for each image, picture its control point.
///
/// # Errors
/// Discs whose plane nobody states and whose neighbours among the control points lie in none; none at all.
pub fn offsets(survey: &Survey, cameras: &[Camera], poses: &[Option<Pose>], discs: Discs) -> Result<Vec<Offset>, CalibrationError> {
    let seen = (0..survey.sights()).map(|sight| (survey.sight(sight).target, sight));
    let known = Known::of(survey, survey.targets(), seen, discs);
    if known.count() == 0 {
        return Err(CalibrationError::NoDisc { with_radius: discs != Discs::Control });
    }
    let neighbours = Neighbours::new((0..survey.targets()).filter_map(|target| survey.known(target)));
    // Of a target that is no control point nothing is asked.
    let plane = |target: usize| survey.known(target).map_or(Some(nalgebra::Vector3::z()), |at| neighbours.normal(&at));
    let normals = known.normals(|target| survey.target(target).to_owned(), plane)?;
    let offset = |sight: usize| {
        let of = survey.sight(sight);
        let Some((radius, normal)) = normals[of.target].filter(|_| known.is_disc(sight)) else {
            let unstated = survey.kind(sight) == Some(TargetKind::Disc);
            return if unstated { Offset::Unknown("eccentricity: nothing states the disc's radius") } else { Offset::NoDisc };
        };
        let Some(pose) = &poses[of.image] else { return Offset::Unknown("eccentricity: the image has no station") };
        let Some(centre) = survey.known(of.target) else { return Offset::Unknown("eccentricity: the target is no control point") };
        let disc = Disc::seen_from(pose, &centre, &normal, radius);
        disc.and_then(|disc| in_image(&cameras[of.image], &disc))
            .map_or(Offset::Unknown("eccentricity: the disc does not lie before the camera as a whole"), Offset::Of)
    };
    Ok((0..survey.sights()).map(offset).collect())
}
