//! Whether the residuals hold what the model does not: a structure that is no chance, and that moves the camera by more than its standard deviations say.

mod control;
pub(crate) mod gross;
pub(crate) mod impossible;
mod lens;
mod motion;
mod overlap;
mod shutter;
mod stated_precision;
mod uncertain;

use calibench_adjust::{Distance, Solution, Variance, frame_uncertainty};
use calibench_model::camera::Camera;
use calibench_model::convert::{DifferenceOptions, difference};
use nalgebra::{DMatrix, DVector};
use rayon::join;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use crate::allowed::{Allowed, Verdicts};
use crate::ended::ended;
use crate::resampled::MOST;
use crate::{Calibration, Checked, Doubt, Finding, MeasuredBoard, OverFrame, Resampled, SHARE, Subject, Verdict};

/// Probability below which a structure is no chance. Five tests together: once in 2000 sound calibrations, if residuals are independent.
pub(crate) const ALPHA: f64 = 1e-4;

/// Places of the grid over the frame.
const GRID: (usize, usize) = (15, 11);

/// A solution that allows for more.
struct Richer {
    /// Weighted sum of squares.
    cost: f64,
    /// Unknowns beside those that there were.
    more: usize,
    cameras: Cameras,
    /// White residuals.
    white: Vec<[f64; 2]>,
}

/// The cameras of another solution.
enum Cameras {
    Others(Vec<Camera>),
    /// By so much, to first order, in their unknown parameters: of each camera those of [`calibench_adjust::Covariances::of_camera`].
    Changed(Vec<DVector<f64>>),
}

impl Calibration<'_> {
    /// Looks for what the model leaves out, and keeps the result in [`Self::checked`]: the precision that was stated, gross errors, coordinates of control,
    /// the lens, the shutter. Where image points are in gross error the others are not judged: they would find those.
    ///
    /// Each allows for one more kind of unknown, and asks by an F test whether that is no chance, and how far the camera moves.
    pub fn examine(&mut self) {
        let (gross, structures) = self.allowed_for().clone();
        let (gross, structures) = overlap::settled(gross, structures);
        let (gross, [control, lens, shutter]) =
            if self.is_off_together { overlap::counted(gross, structures) } else { (gross, structures) };
        let all = [
            (Subject::Precision, stated_precision::check(self)),
            (Subject::GrossErrors, gross),
            (Subject::Control, control),
            (Subject::Lens, lens),
            (Subject::Shutter, shutter),
        ];
        self.checked = all.map(|(subject, verdict)| Checked { subject, verdict }).into();
        self.over_frame = (0..self.cameras()).map(|camera| OverFrame::of(self, camera)).collect();
        self.uncertain = uncertain::found(self);
        (self.impossible, self.rims) = impossible::found(self);
    }

    /// The checks that adjust again, made once; of many image points none, which would take as long and as much memory once more.
    fn allowed_for(&self) -> &Verdicts {
        self.allowed.get_or_init(|| self.allow())
    }

    fn allow(&self) -> Verdicts {
        if self.prepared.network.observations.len() > MOST {
            let why = format!("more than {MOST} image points");
            return (Verdict::Untested(why.clone()), [(); 3].map(|()| Allowed::untested(&why)));
        }
        let ((gross, control), (lens, shutter)) =
            join(|| join(|| gross::check(self), || control::check(self)), || join(|| lens::check(self), || shutter::check(self)));
        (gross, [control, lens, shutter])
    }

    /// Whether control, lens or shutter explain so much of the residuals that these are no set of gross errors, however long some are.
    pub(crate) fn is_structured(&self) -> bool {
        let (_, structures) = self.allowed_for();
        structures.iter().any(|allowed| allowed.is_structure() && allowed.explains() > overlap::EXPLAINED)
    }

    /// Whether control, lens or shutter are in doubt.
    pub(crate) fn is_doubted(&self) -> bool {
        let (_, structures) = self.allowed_for();
        structures.iter().any(|allowed| allowed.verdict.is_doubt())
    }

    /// The most likely causes of doubt, first the one that explains most; then what cannot be, and what is hardly known.
    pub fn doubts(&self) -> Vec<Doubt> {
        let explains = |doubt: &Doubt| doubt.finding.map_or(0.0, |finding| finding.explains);
        let mut doubts: Vec<Doubt> = self.checked.iter().filter_map(Checked::doubt).collect();
        doubts.sort_by(|a, b| explains(b).total_cmp(&explains(a)));
        let of_board = self.measured_board.iter().flatten().flat_map(MeasuredBoard::doubts);
        doubts.extend(of_board.map(|words| Doubt::of_all(Subject::Board, words)));
        doubts.extend(self.impossible.iter().chain(&self.uncertain).cloned());
        doubts
    }

    /// The verdict on a network that is adjusted with `more` unknowns.
    fn adjusted(&self, richer: &Solution<'_>, more: usize, cause: impl FnOnce() -> String) -> Allowed {
        let (cost, cameras) = (richer.cost(), Cameras::Others(richer.cameras().to_vec()));
        let found = Richer { cost, more, cameras, white: richer.each_white_residual().collect() };
        self.judged(&found, || self.optimism(richer), cause)
    }

    /// The verdict on a solution that allows for more. `optimism`: how many times too small its formal standard deviations are, as leaving images out shows.
    fn judged(&self, richer: &Richer, optimism: impl FnOnce() -> Option<f64>, cause: impl FnOnce() -> String) -> Allowed {
        let verdict = self.verdict(richer, optimism, cause);
        Allowed { verdict, is_clean: gross::is_clean(&richer.white) }
    }

    fn verdict(&self, richer: &Richer, optimism: impl FnOnce() -> Option<f64>, cause: impl FnOnce() -> String) -> Verdict {
        let more = richer.more as f64;
        let redundancy = self.solution.counts().redundancy() as f64 - more;
        let Ok(fisher) = FisherSnedecor::new(more, redundancy) else { return Verdict::Untested("there is no redundancy".into()) };
        let gain = (self.solution.cost() - richer.cost).max(0.0) / more;
        let p = fisher.sf(gain / (richer.cost / redundancy).max(f64::MIN_POSITIVE));
        let sigma0 = (richer.cost / redundancy).sqrt();
        let explains = (1.0 - (sigma0 / self.solution.sigma0().unwrap_or(f64::INFINITY)).powi(2)).max(0.0);
        let mut finding = Finding { p, moves: self.moves(&richer.cameras, sigma0), explains };
        // Residuals that are rounding are no structure.
        let is_rounding = self.solution.sigma0().is_none_or(|sigma0| sigma0 < 1e-5);
        if p >= ALPHA || is_rounding {
            return Verdict::Sound(finding);
        }
        if finding.moves.is_none_or(|moves| moves > SHARE) {
            let optimism = optimism().unwrap_or(1.0).max(1.0);
            finding.moves = finding.moves.map(|moves| moves / optimism);
        }
        finding.weighed(cause())
    }

    fn optimism(&self, richer: &Solution<'_>) -> Option<f64> {
        let network = ended(richer);
        let formal = richer.covariances(Variance::Estimated).ok()?;
        let resampled = Resampled::of(&network, &self.options(), &formal.parameters).ok()?;
        resampled.ratio((0..formal.interior.nrows()).map(|i| formal.interior[(i, i)].sqrt()))
    }

    /// By how many of their standard deviations over the frame the cameras move: the most of any camera. A structure raises the residuals and with them the
    /// standard deviations behind which it hides: `sigma0` is what is left without it.
    fn moves(&self, to: &Cameras, sigma0: f64) -> Option<f64> {
        let factor = sigma0 / self.covariances.variance_factor.sqrt().max(f64::MIN_POSITIVE);
        let of = |index: usize| {
            let (names, covariance) = self.covariances.of_camera(index);
            if names.is_empty() {
                return Some(0.0);
            }
            let over_frame = |covariance: &DMatrix<f64>| {
                let map = frame_uncertainty(self.camera(index), (&names, covariance), GRID, Distance::Far).ok()?;
                Some((map.iter().map(|place| place.covariance.sxx + place.covariance.syy).sum::<f64>() / map.len().max(1) as f64).sqrt())
            };
            let apart = match to {
                Cameras::Others(others) => {
                    difference(self.camera(index), &others[index], &DifferenceOptions::default()).ok()?.spread.rms_px
                }
                Cameras::Changed(changes) => over_frame(&(&changes[index] * changes[index].transpose()))?,
            };
            Some(apart / (factor * over_frame(&covariance)?).max(f64::MIN_POSITIVE))
        };
        (0..self.cameras()).map(of).try_fold(0.0, |most: f64, moves| Some(most.max(moves?)))
    }
}
