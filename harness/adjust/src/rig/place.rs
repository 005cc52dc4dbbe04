//! A rig at one state, on its way down.

use super::equations::{Frame, RigNormals, RigState, RigStep};
use crate::AdjustError;
use crate::descent::{Descended, Descent, UNDAMPED, descend};
use crate::normal::{Lost, Scratch};

/// Share of the sum of squares that a step must promise for another to follow.
const WORTH: f64 = 1e-14;
/// Share that is so little that the sums themselves may not tell it.
const LITTLE: f64 = 1e-10;
/// Share of the sum of squares by which rounding may raise it.
const ROUNDING: f64 = 1e-12;
/// How far rounding of object coordinates may exceed that of pixels, squared.
const NOISE: f64 = 1e4;

struct Place<'f, 'r> {
    frame: &'f Frame<'r>,
    state: RigState,
    normals: RigNormals,
    scratch: Scratch,
    step: Option<RigStep>,
}

/// Where the iteration ended.
pub(super) struct End {
    pub(super) state: RigState,
    pub(super) normals: RigNormals,
    pub(super) descended: Descended,
}

/// The minimum from `start`.
///
/// # Errors
/// [`AdjustError::NotPictured`] by the start values.
pub(super) fn minimum(frame: &Frame<'_>, start: RigState, most: usize) -> Result<End, AdjustError> {
    let (mut scratch, mut normals) = (Scratch::default(), RigNormals::default());
    frame.linearise(&start, &mut scratch, &mut normals).map_err(|lost| not_pictured(frame, &start, lost))?;
    let mut place = Place { frame, state: start, normals, scratch, step: None };
    let descended = descend(&mut place, &UNDAMPED, most)?;
    Ok(End { state: place.state, normals: place.normals, descended })
}

fn not_pictured(frame: &Frame<'_>, state: &RigState, Lost(sight): Lost) -> AdjustError {
    use calibench_model::camera::{CameraModel, NoCounterpart};
    let (network, sight, state) = (&frame.rig.network, &frame.layout.sights[sight], frame.whole(state));
    let ray = state.poses[sight.image()].ray(&state.points[sight.point()]);
    let why = state.cameras[frame.layout.camera_of[sight.image()]].project(ray).err().unwrap_or(NoCounterpart::NoSolution);
    AdjustError::NotPictured { image: network.images[sight.image()].name.clone(), point: network.points[sight.point()].name.clone(), why }
}

impl Descent for Place<'_, '_> {
    type Lost = AdjustError;

    fn step(&mut self, damping: f64) -> Option<f64> {
        self.step = self.normals.reduced(damping)?.step(&self.normals);
        Some(self.normals.along(self.step.as_ref()?))
    }

    /// The step is small enough to be looked at: of rigs that costs nothing.
    fn arrives(&mut self, _promised: f64) -> bool {
        false
    }

    fn go(&mut self) -> Result<bool, AdjustError> {
        let Some(step) = self.step.take() else { return Ok(false) };
        let (moved, before) = (self.frame.moved(&self.state, &step), self.normals.cost());
        let pictured = self.frame.linearise(&moved, &mut self.scratch, &mut self.normals).is_ok();
        if pictured && self.normals.cost() <= before * (1.0 + ROUNDING) + NOISE * self.frame.floor {
            self.state = moved;
            return Ok(true);
        }
        let (frame, state) = (self.frame, &self.state);
        frame.linearise(state, &mut self.scratch, &mut self.normals).map_err(|lost| not_pictured(frame, state, lost))?;
        Ok(false)
    }

    fn ends(&self, promised: f64, before: f64, lower: bool) -> bool {
        let (cost, floor) = (self.normals.cost(), self.frame.floor);
        let stands = (promised <= LITTLE * cost || promised <= NOISE * floor) && promised > 0.25 * before;
        promised <= WORTH * cost + floor || (lower && stands)
    }
}
