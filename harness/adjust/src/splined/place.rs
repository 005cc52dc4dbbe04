//! Splines at one state, on their way down.

use calibench_model::camera::NoCounterpart;

use super::equations::{Frame, SplinedNormals, SplinedState, SplinedStep};
use crate::AdjustError;
use crate::descent::{Descended, Descent, UNDAMPED, descend};
use crate::normal::Lost;

/// Share of the sum of squares that a step must promise for another to follow: along what the prior alone holds (the camera turns, and all control points with it) the way is long
/// and crooked.
const WORTH: f64 = 1e-10;
/// Share that is so little that the sums themselves may not tell it.
const LITTLE: f64 = 1e-11;
/// Share of the sum of squares by which rounding may raise it.
const ROUNDING: f64 = 1e-12;

/// How many times as much as the equations say the sum of squares may bend along a step that is taken whole: it bends more where residuals are large against the prior.
const FAR: f64 = 1.25;

struct Place<'f, 'n> {
    frame: &'f Frame<'n>,
    state: SplinedState,
    normals: SplinedNormals,
    /// The equations at the step that was tried last.
    other: SplinedNormals,
    step: Option<SplinedStep>,
    /// What it promises.
    promised: f64,
}

/// Where the iteration ended.
pub(super) struct End {
    pub(super) state: SplinedState,
    pub(super) normals: SplinedNormals,
    pub(super) descended: Descended,
}

/// The minimum from `start`.
///
/// # Errors
/// [`AdjustError::NotPictured`] by the start values.
pub(super) fn minimum(frame: &Frame<'_>, start: SplinedState, most: usize) -> Result<End, AdjustError> {
    let mut normals = SplinedNormals::default();
    frame.linearise(&start, &mut normals).map_err(|Lost(sight)| {
        let (network, sight) = (&frame.of.network, &frame.layout.sights[sight]);
        let (image, point) = (network.images[sight.image()].name.clone(), network.points[sight.point()].name.clone());
        AdjustError::NotPictured { image, point, why: NoCounterpart::Behind }
    })?;
    let mut place = Place { frame, state: start, normals, other: SplinedNormals::default(), step: None, promised: 0.0 };
    let descended = descend(&mut place, &UNDAMPED, most)?;
    Ok(End { state: place.state, normals: place.normals, descended })
}

impl Place<'_, '_> {
    /// The parabola through the costs before and after the step, with the slope of the first: its second term.
    fn bend(&self) -> f64 {
        self.other.cost - self.normals.cost + 2.0 * self.promised
    }
}

impl Descent for Place<'_, '_> {
    type Lost = AdjustError;

    fn step(&mut self, damping: f64) -> Option<f64> {
        self.step = self.normals.eliminate(damping).ok()?.factor(&self.normals)?.step(&self.normals);
        self.promised = self.normals.along(self.step.as_ref()?);
        Some(self.promised)
    }

    fn arrives(&mut self, _promised: f64) -> bool {
        false
    }

    fn go(&mut self) -> Result<bool, AdjustError> {
        let Some(step) = self.step.take() else { return Ok(false) };
        let before = self.normals.cost;
        let mut moved = self.frame.moved(&self.state, &step);
        let mut pictured = self.frame.linearise(&moved, &mut self.other).is_ok();
        if pictured && self.bend() > FAR * self.promised {
            // Where poses stand images are linear in the control points: these follow at once, as a turn of the camera takes them along a curve.
            if let Some(settling) = self.other.settling(self.frame) {
                moved = self.frame.moved(&moved, &settling);
                pictured = self.frame.linearise(&moved, &mut self.other).is_ok();
            }
        }
        if pictured && self.bend() > FAR * self.promised {
            let full = self.other.cost;
            let part = self.frame.moved(&self.state, &step.times(self.promised / self.bend()));
            pictured = self.frame.linearise(&part, &mut self.other).is_ok();
            if pictured && self.other.cost < full {
                moved = part;
            } else {
                pictured = self.frame.linearise(&moved, &mut self.other).is_ok();
            }
        }
        let lower = pictured && self.other.cost <= before * (1.0 + ROUNDING) + self.frame.floor;
        if lower {
            self.state = moved;
            std::mem::swap(&mut self.normals, &mut self.other);
        }
        Ok(lower)
    }

    fn ends(&self, promised: f64, before: f64, lower: bool) -> bool {
        let (cost, floor) = (self.normals.cost, self.frame.floor);
        let stands = promised <= LITTLE * cost && promised > 0.25 * before;
        promised <= WORTH * cost + floor || (lower && stands)
    }
}
