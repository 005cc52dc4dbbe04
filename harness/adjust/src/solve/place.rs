//! A network at one state, on its way down.

use super::{Engine, Factor, Schur, Solved};
use crate::AdjustError;
use crate::descent::Descent;
use crate::normal::{Normals, Scratch, residuals};
use crate::state::{State, Step};

/// Share of the sum of squares that a step must promise for another to follow: it moves the unknowns by 1e-7 of their standard deviations.
const WORTH: f64 = 1e-14;
/// Share of the sum of squares that is beyond its digits: a step that promises no more changes neither it nor the normal equations, only the unknowns.
const NOTHING: f64 = 1e-16;
/// Share that is so little that the sums themselves may not tell it.
const LITTLE: f64 = 1e-10;
/// How far rounding of object coordinates may exceed that of pixels, squared.
const NOISE: f64 = 1e4;
/// Share of the sum of squares by which rounding may raise it.
const ROUNDING: f64 = 1e-12;

/// The state, its normal equations and the step from it.
pub(super) struct Place<'e, 'n> {
    engine: &'e Engine<'n>,
    pub(super) state: State,
    pub(super) normals: Normals,
    scratch: Scratch,
    schur: Schur,
    step: Step,
    factor: Option<Factor>,
    /// The sum of squares before the last step.
    before: f64,
    /// The normal equations, solved, where the last step needed that.
    pub(super) solved: Option<Solved>,
}

impl<'e, 'n> Place<'e, 'n> {
    /// The start.
    ///
    /// # Errors
    /// [`AdjustError::NotPictured`].
    pub(super) fn at(engine: &'e Engine<'n>, state: State) -> Result<Self, AdjustError> {
        let (mut scratch, mut normals) = (Scratch::default(), Normals::default());
        engine.linearise(&state, &mut scratch, &mut normals).map_err(|lost| engine.not_pictured(&state, lost))?;
        let (step, before) = (engine.zero_step(), normals.cost);
        Ok(Self { engine, state, normals, scratch, schur: Schur::default(), step, factor: None, before, solved: None })
    }
}

impl Descent for Place<'_, '_> {
    type Lost = AdjustError;

    fn step(&mut self, damping: f64) -> Option<f64> {
        let Self { engine, state, normals, schur, step, .. } = self;
        (self.factor, self.before) = (None, normals.cost);
        let mut reduced = engine.blank.clone();
        schur.eliminate(engine.ordered(state, normals), damping, &mut reduced).ok()?;
        let factor = Factor::of(reduced, engine.scale(normals), engine.structure.as_ref())?;
        let mut kept = schur.reduced.clone();
        factor.solve(&mut kept);
        schur.back(engine.ordered(state, normals), &kept, step);
        self.factor = Some(factor);
        step.is_finite().then(|| normals.along(step))
    }

    fn arrives(&mut self, promised: f64) -> bool {
        if promised > NOTHING * self.before {
            return false;
        }
        let moved = self.state.moved(&self.engine.layout, &self.step);
        let pictured = residuals(self.engine.network, &self.engine.layout, &moved, &mut self.scratch, &mut self.normals).is_ok();
        if pictured {
            let schur = std::mem::take(&mut self.schur).solved();
            self.solved = self.factor.take().map(|factor| Solved { schur, factor });
            self.state = moved;
        }
        pictured
    }

    fn go(&mut self) -> Result<bool, AdjustError> {
        let Self { engine, scratch, normals, .. } = self;
        self.factor = None;
        let moved = self.state.moved(&engine.layout, &self.step);
        let pictured = engine.linearise(&moved, scratch, normals).is_ok();
        let lower = pictured && normals.cost <= self.before * (1.0 + ROUNDING) + NOISE * engine.floor;
        if lower {
            self.state = moved;
        } else {
            // Seldom, so that one set of equations is in memory and not two.
            engine.linearise(&self.state, scratch, normals).map_err(|lost| engine.not_pictured(&self.state, lost))?;
        }
        Ok(lower)
    }

    /// Nothing to gain, or so little that rounding alone decides: it no longer falls.
    fn ends(&self, promised: f64, before: f64, lower: bool) -> bool {
        let (cost, floor) = (self.before, self.engine.floor);
        let stands = (promised <= LITTLE * cost || promised <= NOISE * floor) && promised > 0.25 * before;
        promised <= WORTH * cost + floor || (lower && stands)
    }
}
