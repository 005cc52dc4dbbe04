//! Observations of the centres of discs' pictures, as observations of the pictures of their centres.

use calibench_adjust::{ImageObservation, Network, Options, adjust};
use calibench_model::eccentricity::{Disc, in_image};
use calibench_model::{ObjectTarget, PixelPoint, TargetKind};
use nalgebra::Vector3;

use super::Job;

/// Change of a correction with which the rounds end, px.
const SMALL: f64 = 1e-6;
/// Rounds at most: each gains the ratio of the disc's radius to its distance, squared.
const ROUNDS: usize = 20;

/// Takes the eccentricity of discs out of the observations of `network`, as the adjusted network itself pictures
/// them.
///
/// # Errors
/// In words: an adjustment that fails, or corrections that do not settle.
pub fn centred(job: &Job<'_>, network: &mut Network) -> Result<(), String> {
    let discs: Vec<Option<(f64, Vector3<f64>)>> = network.points.iter().map(|point| disc(job, &point.name)).collect();
    if discs.iter().all(Option::is_none) {
        return Ok(());
    }
    let measured: Vec<PixelPoint> = network.observations.iter().map(|observation| observation.position).collect();
    let mut before = vec![[0.0; 2]; measured.len()];
    for _ in 0..ROUNDS {
        let solution = adjust(network, &Options::default()).map_err(|error| error.to_string())?;
        let offset = |observation: &ImageObservation| {
            let (radius, normal) = discs[observation.point]?;
            let disc = Disc::seen_from(&solution.poses()[observation.image], &solution.points()[observation.point], &normal, radius)?;
            in_image(&solution.cameras()[0], &disc)
        };
        let offsets: Vec<[f64; 2]> = network.observations.iter().map(|observation| offset(observation).unwrap_or_default()).collect();
        drop(solution);
        for ((observation, at), [x, y]) in network.observations.iter_mut().zip(&measured).zip(&offsets) {
            observation.position = PixelPoint::new(at.x - x, at.y - y);
        }
        if before.iter().zip(&offsets).all(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]) < SMALL) {
            return Ok(());
        }
        before = offsets;
    }
    Err("the corrections for the eccentricity of discs do not settle".into())
}

/// Radius and normal of a target that is a disc, as the field was designed.
fn disc(job: &Job<'_>, name: &str) -> Option<(f64, Vector3<f64>)> {
    let target: &ObjectTarget = job.field.targets.iter().find(|target| target.id == name && target.kind == TargetKind::Disc)?;
    let plate = &job.field.plates[target.plate];
    Some((0.5 * target.size, plate.u.cross(&plate.v)))
}
