//! Whether the residuals hold what the model does not: a structure that is no chance, and that moves the camera by more than its standard deviations say.

mod control;
mod gross;
mod lens;
mod precision;

use calibench_adjust::{Distance, Solution, Variance, frame_uncertainty};
use calibench_model::camera::Camera;
use calibench_model::convert::{DifferenceOptions, difference};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use crate::ended::ended;
use crate::resampled::MOST;
use crate::{Calibration, Checked, Finding, Resampled, SHARE, Verdict};

/// Probability below which a structure is no chance. Four tests together: once in 2500 sound calibrations, if residuals are independent.
const ALPHA: f64 = 1e-4;
/// Places of the grid over the frame.
const GRID: (usize, usize) = (15, 11);

impl Calibration<'_> {
    /// Looks for what the model leaves out, and keeps the result in [`Self::checked`]: the precision that was stated, gross errors, coordinates of control,
    /// the lens. Where image points are in gross error the others are not judged: they would find those.
    ///
    /// Each allows for one more kind of unknown, and asks by an F test whether that is no chance, and how far the camera moves.
    pub fn examine(&mut self) {
        let (mut gross, (mut control, is_clean), mut lens) = self.allowed_for();
        if let Verdict::Doubt(finding, _) | Verdict::Slight(finding, _) = gross {
            let untested = || Verdict::Untested("image points are in gross error".into());
            if matches!(control, Verdict::Doubt(..) | Verdict::Slight(..)) && is_clean {
                // Image points of a control point that is not there are off together, and not for themselves.
                gross = Verdict::Sound(finding);
            } else if matches!(gross, Verdict::Doubt(..)) {
                (control, lens) = (untested(), untested());
            }
        }
        let all = [
            ("the precision of image points", precision::check(self)),
            ("gross errors of image points", gross),
            ("the coordinates of control points", control),
            ("the lens", lens),
        ];
        self.checked = all.map(|(what, verdict)| Checked { what, verdict }).into();
    }

    /// The checks that adjust again; of many image points none, which would take as long and as much memory once more.
    fn allowed_for(&self) -> (Verdict, (Verdict, bool), Verdict) {
        if self.prepared.network.observations.len() > MOST {
            let untested = || Verdict::Untested(format!("more than {MOST} image points"));
            return (untested(), (untested(), false), untested());
        }
        (gross::check(self), control::check(self), lens::check(self))
    }

    /// The most likely causes of doubt, the strongest first.
    pub fn doubts(&self) -> Vec<&str> {
        let moves = |checked: &&Checked| match checked.verdict {
            Verdict::Doubt(Finding { moves, .. }, _) => moves.unwrap_or(f64::INFINITY),
            _ => 0.0,
        };
        let mut doubts: Vec<&Checked> = self.checked.iter().filter(|checked| checked.doubt().is_some()).collect();
        doubts.sort_by(|a, b| moves(b).total_cmp(&moves(a)));
        doubts.into_iter().filter_map(Checked::doubt).collect()
    }

    /// The verdict on a network that allows for `more` unknowns.
    fn judged(&self, richer: &Solution<'_>, more: usize, cause: impl FnOnce() -> String) -> Verdict {
        let redundancy = self.solution.counts().redundancy() as f64 - more as f64;
        let Ok(fisher) = FisherSnedecor::new(more as f64, redundancy) else { return Verdict::Untested("there is no redundancy".into()) };
        let gain = (self.solution.cost() - richer.cost()).max(0.0) / more as f64;
        let p = fisher.sf(gain / (richer.cost() / redundancy).max(f64::MIN_POSITIVE));
        let sigma0 = (richer.cost() / redundancy).sqrt();
        let mut finding = Finding { p, moves: self.moves(richer.cameras(), sigma0) };
        // Residuals that are rounding are no structure.
        let is_rounding = self.solution.sigma0().is_none_or(|sigma0| sigma0 < 1e-5);
        if p >= ALPHA || is_rounding {
            return Verdict::Sound(finding);
        }
        if finding.moves.is_none_or(|moves| moves > SHARE) {
            finding.moves = finding.moves.map(|moves| moves / self.optimism(richer));
        }
        finding.weighed(cause())
    }

    /// How many times too small the formal standard deviations are when a structure is allowed for, as leaving images out shows: 1 at least.
    fn optimism(&self, richer: &Solution<'_>) -> f64 {
        let network = ended(richer);
        let formal = richer.covariances(Variance::Estimated);
        let ratio = formal.ok().and_then(|formal| {
            let resampled = Resampled::of(&network, &self.options(), &formal.parameters).ok()?;
            resampled.ratio((0..formal.interior.nrows()).map(|i| formal.interior[(i, i)].sqrt()))
        });
        ratio.unwrap_or(1.0).max(1.0)
    }

    /// By how many of their standard deviations over the frame the cameras differ from others: the most of any camera. A structure raises the residuals
    /// and with them the standard deviations behind which it hides: `sigma0` is what is left without it.
    fn moves(&self, others: &[Camera], sigma0: f64) -> Option<f64> {
        let factor = sigma0 / self.covariances.variance_factor.sqrt().max(f64::MIN_POSITIVE);
        let of = |index: usize| {
            let (names, covariance) = self.covariances.of_camera(index);
            if names.is_empty() {
                return Some(0.0);
            }
            let map = frame_uncertainty(self.camera(index), (&names, &covariance), GRID, Distance::Far).ok()?;
            let mean = map.iter().map(|place| place.covariance.sxx + place.covariance.syy).sum::<f64>() / map.len().max(1) as f64;
            let apart = difference(self.camera(index), &others[index], &DifferenceOptions::default()).ok()?.spread.rms_px;
            Some(apart / (factor * mean.sqrt()).max(f64::MIN_POSITIVE))
        };
        (0..self.cameras()).map(of).try_fold(0.0, |most: f64, moves| Some(most.max(moves?)))
    }
}
