//! The way down: steps that are damped where an undamped one leads upwards.

use calibench_model::Rejection;

/// A step that is damped by no more is as good as an undamped one.
const WEAK: f64 = 1e-3;
/// By what factors damping falls after a step that led down, and grows after one that did not.
const FACTORS: (f64, f64) = (0.1, 10.0);

/// Marquardt's damping, by which the diagonal of the normal equations grows, as a fraction of it.
pub(crate) struct Damping {
    /// At the start.
    pub(crate) first: f64,
    /// After an undamped step that did not lead down.
    pub(crate) again: f64,
    /// It does not fall below this,
    pub(crate) least: f64,
    /// but to this: none, or as good as none.
    pub(crate) rest: f64,
    /// Beyond this there is no way down.
    pub(crate) most: f64,
}

impl Damping {
    fn less(&self, damping: f64) -> f64 {
        let less = FACTORS.0 * damping;
        if less < self.least { self.rest } else { less }
    }

    fn more(&self, damping: f64) -> Option<f64> {
        (damping <= self.most).then(|| (FACTORS.1 * damping).max(self.again))
    }
}

/// A place from which steps are tried.
pub(crate) trait Descent {
    /// A change of the unknowns.
    type Step;
    /// What is found.
    type Found;

    /// The step from here.
    ///
    /// # Errors
    /// That the unknowns cannot be told apart here.
    fn step(&self, damping: f64) -> Result<Self::Step, Rejection>;

    /// What is found if this step is short enough to be the last; `weak` if damping does not make it short. `trial` counts steps from 0.
    ///
    /// # Errors
    /// What is found is none.
    fn found(&self, step: &Self::Step, weak: bool, trial: usize) -> Result<Option<Self::Found>, Rejection>;

    /// Goes there, if it leads down.
    ///
    /// # Errors
    /// The step leaves all bounds.
    fn go(&mut self, step: Self::Step, weak: bool) -> Result<Gone<Self::Found>, Rejection>;
}

/// Where a step led.
pub(crate) enum Gone<F> {
    /// Down.
    Down,
    /// Up, and it was not taken.
    Up,
    /// Neither, what differs is rounding: this is found.
    Level(F),
}

/// Steps until one is short enough; at most `trials` of them.
///
/// # Errors
/// [`Rejection::NotConverged`]; those of the steps.
#[inline(always)]
pub(crate) fn descend<D: Descent>(descent: &mut D, damping: &Damping, trials: usize) -> Result<D::Found, Rejection> {
    let mut strength = damping.first;
    for trial in 0..trials {
        let weak = strength <= WEAK;
        let step = descent.step(strength)?;
        if let Some(found) = descent.found(&step, weak, trial)? {
            return Ok(found);
        }
        strength = match descent.go(step, weak)? {
            Gone::Down => damping.less(strength),
            Gone::Level(found) => return Ok(found),
            Gone::Up => damping.more(strength).ok_or(Rejection::NotConverged)?,
        };
    }
    Err(Rejection::NotConverged)
}
