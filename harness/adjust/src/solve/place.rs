//! A network at one state, on its way down.

use super::{Engine, Factor, Schur, Solved};
use crate::AdjustError;
use crate::descent::Descent;
use crate::normal::{Normals, Scratch, residuals};
use crate::state::{State, Step};

/// Share of the sum of squares that is beyond its digits: a step that promises no more changes neither it nor the normal equations, only the unknowns.
const NOTHING: f64 = 1e-16;
/// Share that is so little that the sums themselves may not tell it.
const LITTLE: f64 = 1e-10;
/// How far rounding of object coordinates may exceed that of pixels, squared.
const NOISE: f64 = 1e4;
/// Share of the sum of squares by which rounding may raise it.
const ROUNDING: f64 = 1e-12;
/// Undamped steps beyond one that raised the sum of squares, while none ends far above the first, before all are taken back.
const AHEAD: usize = 20;
/// By how much the sum of one of them may exceed that of the first.
const WILD: f64 = 10.0;
/// How often on a way it is looked ahead.
const LOOKS: usize = 5;
/// Steps after which it is looked ahead from a place that damped steps have crept to.
const CREPT: usize = 6;

/// The state, its normal equations and the step from it.
pub(super) struct Place<'e, 'n> {
    engine: &'e Engine<'n>,
    pub(super) state: State,
    pub(super) normals: Normals,
    scratch: Scratch,
    schur: Schur,
    step: Step,
    factor: Option<Factor>,
    /// Whether the last step was undamped.
    undamped: bool,
    /// How often it may still be looked ahead.
    looks: usize,
    /// Steps since it was.
    crept: usize,
    /// The sum of squares before the last step.
    before: f64,
    /// [`crate::Options::worth`].
    worth: f64,
    /// The normal equations, solved, where the last step needed that.
    pub(super) solved: Option<Solved>,
}

impl<'e, 'n> Place<'e, 'n> {
    /// The start.
    ///
    /// # Errors
    /// [`AdjustError::NotPictured`].
    pub(super) fn at(engine: &'e Engine<'n>, state: State, worth: f64) -> Result<Self, AdjustError> {
        let (mut scratch, mut normals) = (Scratch::default(), Normals::default());
        engine.linearise(&state, &mut scratch, &mut normals).map_err(|lost| engine.not_pictured(&state, lost))?;
        let (step, before) = (engine.zero_step(), normals.cost);
        let (schur, factor, solved) = (Schur::default(), None, None);
        Ok(Self { engine, state, normals, scratch, schur, step, factor, undamped: true, looks: LOOKS, crept: 0, before, worth, solved })
    }

    /// Solves the normal equations made at `state` for the step.
    fn solve(&mut self, state: &State, damping: f64) -> Option<Factor> {
        let Self { engine, normals, schur, step, .. } = self;
        let mut reduced = engine.blank.clone();
        schur.eliminate(engine.ordered(state, normals), damping, &mut reduced).ok()?;
        let factor = Factor::of(reduced, engine.scale(normals), engine.structure.as_ref())?;
        let mut kept = schur.reduced.clone();
        factor.solve(&mut kept);
        schur.back(engine.ordered(state, normals), &kept, step);
        normals.follow(&engine.layout, step);
        step.is_finite().then_some(factor)
    }

    /// Moves from `state` by the step and makes the normal equations there; `None` if points are not pictured.
    fn moved(&mut self, state: &State) -> Option<State> {
        let moved = state.moved(&self.engine.layout, &self.step);
        self.engine.linearise(&moved, &mut self.scratch, &mut self.normals).is_ok().then_some(moved)
    }

    /// Makes the normal equations at `state` again.
    fn again(&mut self, state: &State) -> Result<(), AdjustError> {
        let Self { engine, scratch, normals, .. } = self;
        engine.linearise(state, scratch, normals).map_err(|lost| engine.not_pictured(state, lost))
    }

    /// Whether the sum of squares is not above that before the last step.
    fn is_lower(&self) -> bool {
        self.normals.cost <= self.before * (1.0 + ROUNDING) + NOISE * self.engine.floor
    }

    /// From a state with a higher sum, or one to which damped steps have crept: the first of the next undamped ones whose sum is lower than before. Where unknowns bend the way together (the form of an
    /// object, and parameters of many cameras that do the like to its images) a step may lead far up a side of the valley, and the next one to its floor.
    ///
    /// Source: the watchdog technique of Chamberlain, Powell, Lemarechal & Pedersen 1982.
    fn ahead(&mut self, mut state: State) -> Option<State> {
        (self.looks, self.crept) = (self.looks - 1, 0);
        let mut first = None;
        for _ in 0..AHEAD {
            self.solve(&state, 0.0)?;
            state = self.moved(&state)?;
            if self.is_lower() {
                return Some(state);
            }
            if self.normals.cost > WILD * *first.get_or_insert(self.normals.cost) {
                return None;
            }
        }
        None
    }
}

impl Descent for Place<'_, '_> {
    type Lost = AdjustError;

    fn step(&mut self, damping: f64) -> Option<f64> {
        (self.factor, self.before, self.undamped) = (None, self.normals.cost, damping == 0.0);
        let state = std::mem::take(&mut self.state);
        let factor = self.solve(&state, damping);
        self.state = state;
        self.factor = Some(factor?);
        Some(self.normals.along(&self.step))
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
        self.factor = None;
        self.crept += 1;
        let from = std::mem::take(&mut self.state);
        let mut moved = match self.moved(&from) {
            Some(moved) if self.is_lower() => Some(moved),
            Some(moved) if self.undamped && self.looks > 0 => self.ahead(moved),
            _ => None,
        };
        if moved.is_none() {
            // Seldom, so that one set of equations is in memory and not two.
            self.again(&from)?;
            if !self.undamped && self.looks > 0 && self.crept >= CREPT {
                moved = self.ahead(from.clone());
                if moved.is_none() {
                    self.again(&from)?;
                }
            }
        }
        let lower = moved.is_some();
        self.state = moved.unwrap_or(from);
        Ok(lower)
    }

    /// Nothing to gain, or so little that rounding alone decides: it no longer falls.
    fn ends(&self, promised: f64, before: f64, lower: bool) -> bool {
        let (cost, floor) = (self.before, self.engine.floor);
        let stands = (promised <= LITTLE * cost || promised <= NOISE * floor) && promised > 0.25 * before;
        promised <= self.worth * cost + floor || (lower && stands)
    }
}
