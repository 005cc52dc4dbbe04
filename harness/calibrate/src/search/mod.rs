//! Whether another start arrives lower: on some of the images and points, cameras from several starts are adjusted by nested models, parameter by
//! parameter, against the start that the usual way found.

mod clean;
mod ladder;
mod lenses;
mod sample;

use calibench_model::camera::{Camera, CameraModel};
use calibench_model::convert::{DifferenceOptions, difference};

use crate::start::{Starts, orient_all};
use crate::{CalibrationError, Optics, Rival, Settings, Survey, model};
use sample::{Arrived, Sample};

/// A start is another one if it ends this much lower, as a fraction of the sum of squares: more than the last step of an adjustment leaves.
const LOWER: f64 = 1e-6;
/// Sums of squares below this, by redundancy, are no more than rounding: residuals of 1e-5 standard deviations.
const NOTHING: f64 = 1e-10;
/// A minimum is a rival if its sum of squares is above the least by no more than this many variances of an image coordinate: the 99.9 % point of chi
/// squared with one degree of freedom.
pub(crate) const WITHIN: f64 = 10.83;
/// Cameras that are closer than this over the frame after the best rotation are one, px (RMS).
const SAME: f64 = 0.1;

/// `starts`, or better ones where there are, and the minima that the observations do not tell from the one found.
pub(super) fn better(
    survey: &Survey,
    owners: &[usize],
    settings: &Settings,
    starts: Result<Starts, CalibrationError>,
) -> Result<(Starts, Vec<Rival>), CalibrationError> {
    if starts.as_ref().is_err_and(|error| !is_of_start(error)) {
        return starts.map(|starts| (starts, Vec::new()));
    }
    let (mut cameras, mut rivals) = (Vec::new(), Vec::new());
    for (index, optics) in settings.cameras.iter().enumerate() {
        let usual = starts.as_ref().ok().map(|starts| (starts.cameras[index], starts.origins[index].clone()));
        let sample = || Sample::of(survey, owners, index, settings);
        let found = optics.start.is_none().then(sample).flatten().and_then(|mut sample| {
            let (first, others) = lenses::arrived(&mut sample, optics, usual.as_ref());
            best(&sample, optics, first, others)
        });
        cameras.push(found.as_ref().filter(|found| found.replaces).map(|found| (found.camera, found.origin.clone())).or(usual));
        rivals.extend(found.and_then(|found| found.rival).map(|rival| Rival { camera: index, ..rival }));
    }
    let replaced = |starts: &Starts| starts.cameras.iter().zip(&cameras).any(|(old, new)| new.as_ref().is_some_and(|(new, _)| new != old));
    match &starts {
        Ok(usual) if !replaced(usual) => Ok((starts?, rivals)),
        Err(_) if cameras.iter().any(Option::is_none) => Ok((starts?, rivals)),
        _ => {
            let (cameras, origins) = cameras.into_iter().flatten().unzip();
            // A camera that does not orient every image replaces none that did.
            Ok((orient_all(survey, owners, settings, cameras, origins).or(starts)?, rivals))
        }
    }
}

/// Whether another start may help.
pub(crate) fn is_of_start(error: &CalibrationError) -> bool {
    matches!(error, CalibrationError::NoPose { .. } | CalibrationError::Convert(_) | CalibrationError::Start(_))
}

struct Best {
    camera: Camera,
    origin: String,
    /// The usual start is not to be taken.
    replaces: bool,
    rival: Option<Rival>,
}

/// The lowest of all minima; the usual start's, where none is lower.
fn best(sample: &Sample, optics: &Optics, usual: Option<Arrived>, others: Vec<Arrived>) -> Option<Best> {
    let has_usual = usual.is_some();
    let all: Vec<Arrived> = usual.into_iter().chain(others).collect();
    let redundancy = sample.redundancy(optics, &all.first()?.camera).max(1) as f64;
    let costs: Vec<f64> = all.iter().map(|arrived| arrived.cost).collect();
    let chosen = lowest(&costs, redundancy)?;
    let stays = has_usual && chosen == 0;
    let Arrived { camera, cost, .. } = &all[chosen];
    let variance = cost / redundancy;
    let apart = |other: &&Arrived| distance(camera, &other.camera).is_none_or(|px| px > SAME);
    let near = all.iter().filter(|other| other.cost - cost < WITHIN * variance).filter(apart);
    let rival = near.min_by(|a, b| a.cost.total_cmp(&b.cost)).map(|rival| Rival {
        camera: 0,
        found: *camera,
        other: rival.camera,
        origin: rival.origin.clone(),
        distance_px: distance(camera, &rival.camera),
    });
    // With images beside the sample the minimum orients them better than the rough camera that led to it.
    Some(Best { camera: *camera, origin: all[chosen].origin.clone(), replaces: !stays || sample.is_part, rival })
}

/// The place of the lowest sum of squares; the first one's, where none is lower by more than steps and rounding leave.
fn lowest(costs: &[f64], redundancy: f64) -> Option<usize> {
    let least = (0..costs.len()).min_by(|a, b| costs[*a].total_cmp(&costs[*b]))?;
    Some(if costs[0] <= costs[least] * (1.0 + LOWER) + NOTHING * redundancy { 0 } else { least })
}

/// RMS over the frame after the best rotation, px; `None` where they cannot be compared.
pub(crate) fn distance(a: &Camera, b: &Camera) -> Option<f64> {
    difference(a, b, &DifferenceOptions::default()).ok().map(|found| found.spread.rms_px)
}

/// Parameters that are not solved for as `rest` has them.
fn kept(camera: &Camera, optics: &Optics, rest: &Camera) -> Camera {
    let unknown = model::unknowns(camera, optics);
    let values: Vec<f64> = camera
        .parameters()
        .iter()
        .zip(rest.parameters())
        .map(|(own, rest)| if unknown.iter().any(|name| name == own.name) { own.value } else { rest.value })
        .collect();
    camera.with_parameters(&values)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A scale that is off by e moves an image point by e of its distance from the middle: over the frame the root of (w^2 + h^2) / 12, which no rotation
    /// makes up for.
    #[test]
    fn cameras_are_apart_by_pixels_over_the_frame() {
        let size = calibench_model::camera::ImageSize { width: 1600, height: 1200 };
        let lens = |f: f64| crate::start::pinhole(size, f, [799.5, 599.5]);
        assert!(distance(&lens(1500.0), &lens(1500.0)).unwrap() < 1e-9);
        for e in [1e-4, 1e-3] {
            let found = distance(&lens(1500.0), &lens(1500.0 * (1.0 + e))).unwrap();
            assert!((found / (e * 2000.0 / 12_f64.sqrt()) - 1.0).abs() < 0.1, "{found}");
        }
    }

    #[test]
    fn the_first_minimum_stays_unless_another_is_lower() {
        assert_eq!(lowest(&[], 10.0), None);
        assert_eq!(lowest(&[100.0, 100.0, 99.0], 10.0), Some(2));
        assert_eq!(lowest(&[99.0, 100.0, 1e9], 10.0), Some(0));
        assert_eq!(lowest(&[100.0, 100.0 * (1.0 - 5e-7)], 10.0), Some(0));
        assert_eq!(lowest(&[100.0, 100.0 * (1.0 - 5e-6)], 10.0), Some(1));
        // Of exact data all sums are rounding.
        assert_eq!(lowest(&[5e-10, 1e-20], 10.0), Some(0));
    }
}
