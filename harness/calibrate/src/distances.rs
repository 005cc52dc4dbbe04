//! Distances that were measured, and lengths that are asked for.

use calibench_model::{MeasuredDistance, upper_median};
use nalgebra::Point3;
use statrs::distribution::{ContinuousCDF, Normal};

use crate::{Calibration, CalibrationError, Doubt, Subject};

/// The risk that any of the right distances is doubted.
const RISK: f64 = 1e-3;

/// A length between two adjusted targets.
#[derive(Clone, Debug, PartialEq)]
pub struct AdjustedLength {
    /// The targets at its ends.
    pub targets: [String; 2],
    /// How long it is, object units.
    pub value: f64,
    /// Its standard deviation, object units, with the variance factor of the covariances.
    pub sigma: f64,
    /// What was measured; `None` of a length that was only asked for.
    pub measured: Option<CheckedDistance>,
}

/// A measured distance, and how the images check it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CheckedDistance {
    /// What was measured, object units.
    pub value: f64,
    /// Its standard deviation, as given, object units.
    pub sigma: f64,
    /// Redundancy number, from 0 (not checked: it makes the scale alone) to 1; `None` where no test can be made.
    pub redundancy: Option<f64>,
    /// Normalised residual, a number; `None` likewise.
    pub w: Option<f64>,
}

/// The median ratio of measured distances to those between the points that `place` has; `None` where there is none.
pub(crate) fn scale_by(distances: &[MeasuredDistance], place: impl Fn(&str) -> Option<Point3<f64>>) -> Option<f64> {
    let ratio = |distance: &MeasuredDistance| {
        let [from, to] = distance.targets.each_ref().map(|name| place(name));
        Some(distance.value / (to? - from?).norm())
    };
    upper_median(distances.iter().filter_map(ratio).filter(|ratio| ratio.is_finite()))
}

impl Calibration<'_> {
    /// The distances that were measured, then the lengths that were asked for.
    ///
    /// # Errors
    /// As of their standard deviations.
    pub fn lengths(&self) -> Result<Vec<AdjustedLength>, CalibrationError> {
        let (settings, network) = (&self.prepared.settings, &self.prepared.network);
        let checks = self.reliability.iter().flat_map(|reliability| &reliability.observed);
        // They come last.
        let first = checks.clone().count().saturating_sub(network.distances.len());
        let mut checks = checks.skip(first);
        let measured = settings.distances.iter().zip(&network.distances).map(|(MeasuredDistance { targets, value, sigma }, distance)| {
            let check = checks.next();
            let (redundancy, w) = (check.map(|check| check.redundancy), check.map(|check| check.w));
            (targets, distance.points, Some(CheckedDistance { value: *value, sigma: *sigma, redundancy, w }))
        });
        let asked = settings.lengths.iter().zip(&self.prepared.lengths).map(|(targets, points)| (targets, *points, None));
        let length = |(targets, points, measured): (&[String; 2], [usize; 2], Option<CheckedDistance>)| {
            let found = self.solution.length(points, self.variance())?;
            let of_scale = settings.board.scale.map_or(0.0, |scale| found.value * scale.share());
            Ok(AdjustedLength { targets: targets.clone(), value: found.value, sigma: found.sigma.hypot(of_scale), measured })
        };
        measured.chain(asked).map(length).collect()
    }

    /// Distances that do not fit to the images and each other.
    pub(crate) fn doubted_distances(&self) -> Vec<Doubt> {
        let count = self.prepared.network.distances.len();
        if count == 0 {
            return Vec::new();
        }
        let critical = Normal::standard().inverse_cdf(1.0 - 0.5 * RISK / count as f64);
        let doubt = |length: AdjustedLength| {
            let (CheckedDistance { value, sigma, w, .. }, [from, to]) = (length.measured?, &length.targets);
            let w = w.filter(|w| w.abs() > critical)?;
            let words = format!(
                "the distance from {from} to {to} does not fit: measured {value} with {sigma}, adjusted {:.prec$}, {:.1} standard deviations off (bound {critical:.1}): is it right, and are its ends?",
                length.value,
                w.abs(),
                prec = digits(sigma)
            );
            Some(Doubt::of_all(Subject::Distances, words))
        };
        self.lengths().unwrap_or_default().into_iter().filter_map(doubt).collect()
    }
}

/// Decimals that show two digits of `sigma`.
fn digits(sigma: f64) -> usize {
    (1.0 - sigma.log10().floor()).clamp(0.0, 12.0) as usize
}
