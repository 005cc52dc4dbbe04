//! Inputs that are something else than they say: what they may be in truth is tried, one after the other, and what explains the points is named.

mod alternatives;
mod frame;
mod raster;
mod shape;

use calibench_diagnostics::plain;
use calibench_exchange::{ControlRow, Points};

use crate::{Calibration, CalibrationError, Settings, prepare};
use alternatives::Alternative;

/// The residuals of what explains an input, as a share of those without it, at most.
const EXPLAINS: f64 = 0.5;
/// The same, px RMS, where without it there is no result.
const MOST_PX: f64 = 2.0;
/// Others whose residuals are so many times those of the best explain as well.
const AS_WELL: f64 = 1.5;
/// Image points up to which anything is tried.
pub const MOST_TRIED: usize = 100_000;

/// What an input may be in truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Suspected {
    /// A word for programs: `lens`, `raster`, `axes`, `up`, `spacing`, `stretch`, `size` or `scale`.
    pub kind: &'static str,
    /// What it may be, with its estimate where it has one, and what to do.
    pub what: String,
    /// What is left of the points then, px RMS; `None` where another sign than the residuals tells.
    pub rms_px: Option<f64>,
}

impl Suspected {
    /// In words.
    pub fn words(&self) -> String {
        self.rms_px.map_or_else(|| self.what.clone(), |rms| format!("{}; residuals are {} px RMS then", self.what, plain(rms)))
    }
}

/// What the inputs of a calibration may be in truth, first what explains them best; empty where nothing does.
///
/// `found` is what came of them: a result that is in doubt, or why there is none.
pub fn suspected(
    points: &Points,
    control: &[ControlRow],
    settings: &Settings,
    found: Result<&Calibration<'_>, &CalibrationError>,
) -> Vec<Suspected> {
    if points.len() > MOST_TRIED {
        return Vec::new();
    }
    let mut all = found.map_or_else(|_| Vec::new(), frame::suspected);
    let bound = found.map_or(MOST_PX, |calibration| EXPLAINS * calibration.rms_px());
    let mut explained: Vec<Suspected> =
        alternatives::all(points, control, settings, found.ok()).into_iter().filter_map(|other| other.tried(bound)).collect();
    explained.sort_by(|a, b| rms(a).total_cmp(&rms(b)));
    let most = explained.first().map_or(0.0, |best| AS_WELL * rms(best));
    all.extend(explained.into_iter().filter(|other| rms(other) <= most));
    all
}

fn rms(suspected: &Suspected) -> f64 {
    suspected.rms_px.unwrap_or(0.0)
}

impl Alternative<'_> {
    /// What it leaves of the points, if that is below `bound`, px RMS.
    fn tried(self, bound: f64) -> Option<Suspected> {
        let prepared = prepare(self.points.into_owned(), &self.control, &self.settings).ok()?;
        let rms = prepared.adjust().ok()?.rms_px();
        (rms < bound).then_some(Suspected { kind: self.kind, what: self.what, rms_px: Some(rms) })
    }
}
