//! The points of a method in a cell of a sweep as a digest and, by target, counts and moments.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::point_entry::{Entry, Place};

/// The step, px, to which coordinates are rounded for a digest.
const STEP: f64 = 1e-6;

/// Counts and moments of the points of one target, all views and trials together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sum {
    /// How many points are measured, lost and rejected.
    pub counts: [u64; 3],
    /// How many of the lost ones are not a number.
    pub nans: u64,
    /// The mean of the measured ones' coordinates, px.
    pub mean: [f64; 2],
    /// Their covariance xx, xy, yy, px^2, divided by their number.
    pub covariance: [f64; 3],
    /// The root mean square of their reported standard deviations, px.
    pub sigma: Option<f64>,
}

/// All points of a method in a cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointSums {
    /// The first 8 bytes of the BLAKE3 hash of every point's place, status and coordinates, these rounded to 1e-6 px, in hexadecimal.
    pub(super) digest: String,
    pub(super) targets: BTreeMap<Arc<str>, Sum>,
}

impl Sum {
    /// Of the points of one target.
    pub fn of(entries: &[&Entry]) -> Self {
        let count = |status| entries.iter().filter(|entry| entry.status() == status).count() as u64;
        let counts = ["measured", "lost", "rejected"].map(count);
        let kept: Vec<[f64; 2]> = entries.iter().filter_map(|entry| entry.kept()).collect();
        let n = kept.len().max(1) as f64;
        let mean = [0, 1].map(|axis| kept.iter().map(|at| at[axis]).sum::<f64>() / n);
        let moment = |a: usize, b: usize| kept.iter().map(|at| (at[a] - mean[a]) * (at[b] - mean[b])).sum::<f64>() / n;
        let variances: Vec<f64> =
            entries.iter().filter(|e| e.is_kept()).filter_map(|e| Some(e.found()?.sigma?.powi(2))).filter(|v| v.is_finite()).collect();
        let sigma = (!variances.is_empty()).then(|| (variances.iter().sum::<f64>() / variances.len() as f64).sqrt());
        let nans = entries.iter().filter(|entry| entry.is_nan()).count() as u64;
        Self { counts, nans, mean, covariance: [moment(0, 0), moment(0, 1), moment(1, 1)], sigma }
    }

    /// How many points.
    pub fn points(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// The mean squared distance from zero, px^2.
    pub fn square(&self) -> f64 {
        let ([x, y], [xx, _, yy]) = (self.mean, self.covariance);
        x * x + y * y + xx + yy
    }

    /// The mean squared distance from the mean, px^2.
    pub fn spread(&self) -> f64 {
        self.covariance[0] + self.covariance[2]
    }
}

/// The digest of all points in their order.
pub(super) fn digest(points: &BTreeMap<Place, Entry>) -> String {
    let mut hasher = blake3::Hasher::new();
    for (place, entry) in points {
        let reason = if let Entry::Rejected(why) = entry { why.name() } else { "" };
        for text in [&*place.view, &*place.target, entry.status(), reason] {
            hasher.update(&(text.len() as u64).to_le_bytes());
            hasher.update(text.as_bytes());
        }
        hasher.update(&place.trial.to_le_bytes());
        for value in entry.coordinates().into_iter().flatten() {
            // Not a number has its own place.
            let steps = if value.is_nan() { i64::MIN } else { (value / STEP).round() as i64 };
            hasher.update(&steps.to_le_bytes());
        }
    }
    hasher.finalize().to_hex()[..16].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::point_entry::Found;

    fn measured(x: f64, y: f64, sigma: f64) -> Entry {
        Entry::Measured(Found { at: [x, y], sigma: Some(sigma) })
    }

    #[test]
    fn moments_by_hand() {
        let lost = Entry::Lost(Found::bare([5.0, 5.0]));
        let [a, b, c] = [measured(1.0, 2.0, 3.0), measured(3.0, 2.0, 4.0), measured(2.0, 5.0, 5.0)];
        let sum = Sum::of(&[&a, &b, &c, &lost]);
        assert_eq!((sum.counts, sum.mean), ([3, 1, 0], [2.0, 3.0]));
        // Deviations (-1, -1), (1, -1), (0, 2).
        let [xx, xy, yy] = sum.covariance;
        assert!((xx - 2.0 / 3.0).abs() < 1e-15 && xy.abs() < 1e-15 && (yy - 2.0).abs() < 1e-15);
        assert!((sum.square() - (5.0 + 13.0 + 29.0) / 3.0).abs() < 1e-12);
        assert!((sum.sigma.unwrap() - (50.0_f64 / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn covariances_and_counts_by_hand() {
        let nan = Entry::Lost(Found::bare([f64::NAN, 0.0]));
        let with = |x: f64, y: f64, sigma| Entry::Measured(Found { at: [x, y], sigma });
        let [a, b] = [with(1.0, 2.0, Some(f64::INFINITY)), with(3.0, 8.0, Some(2.0))];
        let lost = Entry::Lost(Found { at: [9.0, 9.0], sigma: Some(100.0) });
        let rejected = crate::tests::NO_CORNER;
        let sum = Sum::of(&[&nan, &a, &rejected, &b, &lost, &rejected, &rejected]);
        // Deviations (-1, -3) and (1, 3).
        assert_eq!((sum.counts, sum.nans, sum.points()), ([2, 2, 3], 1, 7));
        assert_eq!((sum.mean, sum.covariance, sum.sigma), ([2.0, 5.0], [1.0, 3.0, 9.0], Some(2.0)));
        assert_eq!((sum.square(), sum.spread()), ((5.0 + 73.0) / 2.0, 10.0));
        assert_eq!(Sum::of(&[&rejected]), Sum { counts: [0, 0, 1], ..Sum::default() });
    }

    #[test]
    fn a_digest_sees_places_and_reasons() {
        let place = |trial, view: &str, target: &str| Place { trial, view: view.into(), target: target.into() };
        let at = |place: Place, entry| digest(&[(place, entry)].into());
        let point = measured(0.1, 0.2, 1.0);
        let base = at(place(0, "v", "t"), point);
        for other in [place(1, "v", "t"), place(0, "w", "t"), place(0, "v", "u"), place(0, "vt", ""), place(0, "", "vt")] {
            assert_ne!(base, at(other.clone(), point), "{other}");
        }
        let [first, second] = [0, 1].map(|which| at(place(0, "v", "t"), Entry::Rejected(calibench_model::Rejection::ALL[which])));
        assert_ne!(first, second, "another reason");
        assert_eq!(base, at(place(0, "v", "t"), measured(0.1, 0.2, 9.0)), "standard deviations have their own sum");
        assert_eq!(base, at(place(0, "v", "t"), measured(0.1, 0.2 - 4e-7, 1.0)));
        assert_ne!(base, at(place(0, "v", "t"), measured(0.1, 0.2 - 6e-7, 1.0)));
        let nans = [[f64::NAN, 0.0], [0.0, f64::NAN]].map(|xy| at(place(0, "v", "t"), Entry::Lost(Found::bare(xy))));
        assert_ne!(nans[0], nans[1]);
    }

    #[test]
    fn a_digest_sees_every_point() {
        let of = |entries: &[(u64, Entry)]| {
            let place = |trial| Place { trial, view: "v".into(), target: "t".into() };
            digest(&entries.iter().map(|(trial, entry)| (place(*trial), *entry)).collect())
        };
        let plain = [(0, measured(0.1, 0.2, 1.0)), (1, measured(0.3, 0.4, 1.0))];
        let base = of(&plain);
        assert_eq!(base.len(), 16);
        assert_eq!(base, of(&[(0, measured(0.1 + 4e-7, 0.2, 1.0)), plain[1]]), "less than half a step");
        let swapped = [(0, measured(0.3, 0.4, 1.0)), (1, measured(0.1, 0.2, 1.0))];
        for other in [
            [(0, measured(0.1 + 6e-7, 0.2, 1.0)), plain[1]],
            [(0, measured(0.2, 0.1, 1.0)), plain[1]],
            swapped,
            [(0, Entry::Lost(Found::bare([0.1, 0.2]))), plain[1]],
            [(0, measured(f64::NAN, 0.2, 1.0)), plain[1]],
        ] {
            assert_ne!(base, of(&other), "{other:?}");
        }
    }
}
