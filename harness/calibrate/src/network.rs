//! The network of a survey.

use std::collections::HashMap;

use calibench_adjust::{DistanceObservation, Exterior, ImageObservation, Interior, Network, ObjectPoint, Precision};
use calibench_diagnostics::nearest;
use calibench_model::MeasuredDistance;
use calibench_model::camera::Camera;

use super::start::Starts;
use super::survey::Known;
use super::{CalibrationError, DatumChoice, LeftOut, Optics, Settings, Survey, model, prior};

/// The network, the sight behind each of its observations, and the sights that take no part.
pub(super) fn network(
    survey: &Survey,
    owners: &[usize],
    starts: &Starts,
    settings: &Settings,
) -> Result<(Network, Vec<u32>, Vec<LeftOut>), CalibrationError> {
    let cameras = settings.cameras.iter().zip(&starts.cameras).map(|(optics, camera)| interior(optics, camera));
    let cameras = cameras.collect::<Result<Vec<_>, _>>()?;
    let image = |((name, &camera), pose): ((&String, &usize), &calibench_model::Pose)| {
        prior::exterior(Exterior::free(name.clone(), camera, *pose), prior::station(&settings.stations, name))
    };
    let images = survey.images.iter().zip(owners).zip(&starts.poses).map(image).collect();
    let (mut points, mut place) = (Vec::with_capacity(starts.points.iter().flatten().count()), vec![None; survey.targets()]);
    for (target, position) in starts.points.iter().enumerate() {
        if let Ok(position) = position {
            place[target] = Some(points.len());
            points.push(point(survey.target(target), survey.control(target), *position, &settings.datum));
        }
    }
    let (mut observations, mut sights) = (Vec::with_capacity(survey.sights()), Vec::with_capacity(survey.sights()));
    let mut left_out = Vec::new();
    for (index, sight) in (0..survey.sights()).map(|index| (index, survey.sight(index))) {
        match (place[sight.target], &starts.points[sight.target]) {
            (Some(point), _) => {
                let own = sight.covariance.filter(|_| settings.covariances);
                let precision = own.map_or(Precision::Sigma(settings.sigma()), Precision::Covariance);
                observations
                    .push(ImageObservation { precision, ..ImageObservation::new(sight.image, point, sight.position, settings.sigma()) });
                sights.push(index as u32);
            }
            (None, why) => {
                let why = why.as_ref().err().cloned().unwrap_or_default();
                left_out.push(LeftOut { sight: index, why });
            }
        }
    }
    let control =
        |name: &str| survey.target_called(name).filter(|&target| survey.control(target).is_some()).and_then(|target| place[target]);
    let datum = settings.datum.datum(control)?;
    let distances = distances(survey, settings, &place, &starts.points)?;
    Ok((Network { cameras, images, points, observations, distances, datum, ..Network::default() }, sights, left_out))
}

/// The distances between the points that take part.
fn distances(
    survey: &Survey,
    settings: &Settings,
    place: &[Option<usize>],
    starts: &[Result<nalgebra::Point3<f64>, String>],
) -> Result<Vec<DistanceObservation>, CalibrationError> {
    let end = |name: &String| {
        let target = target(survey, "distance", name)?;
        let why = || starts[target].as_ref().err().cloned().unwrap_or_default();
        place[target].ok_or_else(|| CalibrationError::LengthTarget { of: "distance", target: name.clone(), why: why(), near: None })
    };
    let of = |distance: &MeasuredDistance| {
        let [from, to] = &distance.targets;
        Ok(DistanceObservation { points: [end(from)?, end(to)?], value: distance.value, sigma: distance.sigma })
    };
    settings.distances.iter().map(of).collect()
}

/// Points between which lengths are asked for.
pub(super) fn lengths(survey: &Survey, settings: &Settings, network: &Network) -> Result<Vec<[usize; 2]>, CalibrationError> {
    let place: HashMap<&str, usize> = network.points.iter().enumerate().map(|(place, point)| (point.name.as_str(), place)).collect();
    let end = |name: &String| {
        target(survey, "length", name)?;
        let why = || "it has no coordinates".to_owned();
        place.get(name.as_str()).copied().ok_or_else(|| CalibrationError::LengthTarget {
            of: "length",
            target: name.clone(),
            why: why(),
            near: None,
        })
    };
    let both = |[from, to]: &[String; 2]| {
        if from == to {
            return Err(CalibrationError::LengthTarget { of: "length", target: from.clone(), why: "both ends are it".into(), near: None });
        }
        Ok([end(from)?, end(to)?])
    };
    if settings.lengths.is_empty() { Ok(Vec::new()) } else { settings.lengths.iter().map(both).collect() }
}

fn target(survey: &Survey, of: &'static str, name: &str) -> Result<usize, CalibrationError> {
    survey.target_called(name).ok_or_else(|| {
        let near = nearest(name, (0..survey.targets()).map(|target| survey.target(target))).map(str::to_owned);
        CalibrationError::LengthTarget { of, target: name.to_owned(), why: "no image shows it".into(), near }
    })
}

pub(super) fn interior(optics: &Optics, camera: &Camera) -> Result<Interior, CalibrationError> {
    let names = model::unknowns(camera, optics);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    prior::observed(Interior::fixed(optics.name.clone(), *camera).free(&names)?, &optics.priors)
}

fn point(name: &str, control: Option<&Known>, position: nalgebra::Point3<f64>, datum: &DatumChoice) -> ObjectPoint {
    match control {
        Some(_) if datum.is_minimal() => ObjectPoint::free(name, position),
        Some(control) => match control.sigmas.filter(|_| *datum == DatumChoice::Control) {
            Some(sigmas) => ObjectPoint::observed(name, position, sigmas),
            None => ObjectPoint::fixed(name, position),
        },
        None => ObjectPoint::free(name, position),
    }
}
