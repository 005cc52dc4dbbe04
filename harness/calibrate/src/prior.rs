//! What was observed beside image points and control: parameters of the camera, and poses.

use std::str::FromStr;

use calibench_adjust::{Attitude, Centre, Exterior, Interior};
use calibench_diagnostics::nearest;
use calibench_model::ObservedStation;
use thiserror::Error;

use super::CalibrationError;

/// A parameter of the interior orientation that was observed.
#[derive(Clone, Debug, PartialEq)]
pub struct Prior {
    /// Its name, as the model calls it.
    pub parameter: String,
    /// What was observed, in its unit.
    pub value: f64,
    /// Its standard deviation, in the same unit.
    pub sigma: f64,
}

/// Text that is no observed parameter.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("`{0}` is no observed parameter: expected NAME=VALUE:SIGMA with a positive standard deviation, as in k1=-3e-4:1e-5")]
pub struct NoPrior(String);

impl FromStr for Prior {
    type Err = NoPrior;

    fn from_str(text: &str) -> Result<Self, NoPrior> {
        let parts = || {
            let (parameter, rest) = text.split_once('=')?;
            let (value, sigma) = rest.split_once(':').or_else(|| rest.split_once('\u{b1}'))?;
            let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
            let sigma = number(sigma).filter(|sigma| *sigma > 0.0)?;
            Some(Self { parameter: parameter.trim().to_owned(), value: number(value)?, sigma })
        };
        parts().filter(|prior| !prior.parameter.is_empty()).ok_or_else(|| NoPrior(text.to_owned()))
    }
}

/// The interior orientation with its observed parameters.
pub(super) fn observed(mut interior: Interior, priors: &[Prior]) -> Result<Interior, CalibrationError> {
    for (index, prior) in priors.iter().enumerate() {
        if priors[..index].iter().any(|earlier| earlier.parameter == prior.parameter) {
            return Err(CalibrationError::PriorTwice { parameter: prior.parameter.clone() });
        }
        interior = interior.observed(&prior.parameter, prior.value, prior.sigma)?;
    }
    Ok(interior)
}

/// The observed pose of an image: by its name, or by that without its ending (`render` names stations, photographs have an ending).
pub(super) fn station<'s>(stations: &'s [ObservedStation], image: &str) -> Option<&'s ObservedStation> {
    let stem = image.rsplit_once('.').map_or(image, |(stem, _)| stem);
    let named = |name: &str| stations.iter().find(|row| row.station.image == name);
    named(image).or_else(|| named(stem))
}

/// Stations must be of images that there are.
pub(super) fn check(stations: &[ObservedStation], images: &[String]) -> Result<(), CalibrationError> {
    let of_none = stations.iter().find(|row| images.iter().all(|image| station(std::slice::from_ref(row), image).is_none()));
    of_none.map_or(Ok(()), |row| {
        let near = nearest(&row.station.image, images.iter().map(String::as_str)).map(str::to_owned);
        Err(CalibrationError::StationOfNone { image: row.station.image.clone(), near })
    })
}

/// An image with what was observed of its pose.
pub(super) fn exterior(image: Exterior, observed: Option<&ObservedStation>) -> Exterior {
    let Some(row) = observed else { return image };
    let (pose, mut image) = (row.station.pose, image);
    if let Some(sigma) = row.centre {
        image.centre = Centre::Observed { value: pose.centre, sigma };
    }
    if let Some(sigma) = row.rotation {
        image.attitude = Attitude::Observed { value: pose.rotation, sigma };
    }
    image
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_observed_parameter_is_a_word() {
        let expected = Prior { parameter: "k1".into(), value: -3e-4, sigma: 1e-5 };
        assert_eq!("k1=-3e-4:1e-5".parse(), Ok(expected.clone()));
        assert_eq!("k1 = -3e-4 \u{b1} 1e-5".parse(), Ok(expected));
        for wrong in ["", "k1", "k1=", "k1=1", "k1=1:", "k1=1:0", "k1=1:-1", "k1=NaN:1", "k1=1:inf", "=1:1", "k1:1=1"] {
            assert!(wrong.parse::<Prior>().is_err(), "{wrong}");
        }
    }
}
