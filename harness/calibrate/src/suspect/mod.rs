//! Inputs that are something else than they say: what they may be in truth is tried, one after the other, and what explains the points is named.

mod alternatives;
mod frame;
mod scale;
mod shape;

use calibench_diagnostics::plain;
use calibench_model::camera::{CameraModel, Ray};
use calibench_model::{ControlRow, PixelPoint, Points};

use crate::placed::is_outside;
use crate::raster::Raster;
use crate::{Calibration, CalibrationError, Settings, prepare};
use alternatives::Alternative;

/// The residuals of what explains an input, as a share of those without it, at most.
const EXPLAINS: f64 = 0.5;
/// The same, px RMS, where without it there is no result.
const MOST_PX: f64 = 2.0;
/// Others whose residuals are so many times those of the best explain as well.
const AS_WELL: f64 = 1.5;
/// The word of a lens that is a fisheye's.
const LENS: &str = "lens";
/// Image points up to which anything is tried.
pub const MOST_TRIED: usize = 100_000;

/// What an input may be in truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Suspected {
    /// A word for programs: `lens`, `raster`, `axes`, `up`, `origin`, `spacing`, `stretch`, `scale` or `size`.
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
    let flat = Raster::of(control).is_some();
    let mut all = found.map_or_else(|_| Vec::new(), |found| frame::suspected(found, flat));
    let bound = found.map_or(MOST_PX, |calibration| EXPLAINS * calibration.rms_px());
    let mut explained: Vec<Explained> =
        alternatives::all(points, control, settings, found.ok()).into_iter().filter_map(|other| other.tried(bound)).collect();
    // Where a pinhole with five coefficients does as well, the lens is no fisheye.
    if let Some(lens) = explained.iter().find(|other| other.suspected.kind == LENS) {
        let bound = AS_WELL * lens.rms_px;
        if alternatives::richer(points, control, settings).and_then(|other| other.tried(bound)).is_some() {
            explained.retain(|other| other.suspected.kind != LENS);
        }
    }
    let most = AS_WELL * explained.iter().map(|other| other.rms_px).fold(f64::INFINITY, f64::min);
    explained.retain(|other| other.rms_px <= most);
    // Of what explains as well, what lies in the image and has its axis near the middle: a mirror image may be turned by a right angle.
    explained.sort_by(|a, b| a.outside.cmp(&b.outside).then(a.off.total_cmp(&b.off)));
    all.extend(explained.into_iter().map(|other| other.suspected));
    all
}

/// An input that explains the points.
struct Explained {
    suspected: Suspected,
    rms_px: f64,
    /// Image points outside of their images.
    outside: usize,
    /// How far the principal point is off the middle of the frame, px.
    off: f64,
}

impl Alternative<'_> {
    /// What it leaves of the points, if that is below `bound`, px RMS.
    fn tried(self, bound: f64) -> Option<Explained> {
        let prepared = prepare(self.points.into_owned(), &self.control, &self.settings).ok()?;
        let calibration = prepared.adjust().ok()?;
        let (rms_px, camera) = (calibration.rms_px(), calibration.camera(0));
        let size = |image: usize| calibration.camera(calibration.owner(image)).size();
        let outside = prepared.network.observations.iter().filter(|o| is_outside(size(o.image), o.position)).count();
        let middle = PixelPoint::new(f64::from(camera.size().width - 1) / 2.0, f64::from(camera.size().height - 1) / 2.0);
        let off = camera.project(Ray::from_tangent(0.0, 0.0)).map_or(f64::INFINITY, |at| at.distance(middle));
        let suspected = Suspected { kind: self.kind, what: self.what, rms_px: Some(rms_px) };
        (rms_px < bound).then_some(Explained { suspected, rms_px, outside, off })
    }
}
