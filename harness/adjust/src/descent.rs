//! The way down a sum of squares after Levenberg and Marquardt: steps that are damped where an undamped one does not descend.

use calibench_model::stop;

/// [`crate::Options::worth`] of results: a step moves the unknowns by 1e-7 of their standard deviations.
pub const EXACT: f64 = 1e-14;
/// [`crate::Options::worth`] where the answer needs few digits: which residuals are long, how far cameras move. Huber's weights take hundreds of steps to the other end;
/// here the last iteration is one, too.
pub const ROUGH: f64 = 1e-7;

/// By how much the diagonal of the normal equations is raised, as a fraction of it.
pub(crate) struct Damping {
    /// At the start.
    pub(crate) first: f64,
    /// At least, after a step that did not lead down.
    pub(crate) again: f64,
    /// What falls to this
    pub(crate) least: f64,
    /// becomes this: none, or as good as none.
    pub(crate) rest: f64,
    /// Beyond this there is no way down.
    pub(crate) most: f64,
    /// By what it falls after a step that led down, and grows after one that did not.
    pub(crate) factors: (f64, f64),
}

/// No damping, unless it is needed.
pub(crate) const UNDAMPED: Damping = Damping { first: 0.0, again: 1e-6, least: 1e-9, rest: 0.0, most: 1e12, factors: (0.1, 10.0) };

impl Damping {
    fn after(&self, damping: f64, lower: bool) -> f64 {
        match lower {
            true if damping <= self.least => self.rest,
            true => damping * self.factors.0,
            false => (damping * self.factors.1).max(self.again),
        }
    }
}

/// A place from which steps are tried.
pub(crate) trait Descent {
    /// Why a way ends early.
    type Lost;

    /// Finds the step from here and the fall of the sum of squares that it promises; `None` if the equations are singular.
    fn step(&mut self, damping: f64) -> Option<f64>;

    /// Takes an undamped step without a look back if it is the last one, whose promise is beyond the digits of the sum.
    fn arrives(&mut self, promised: f64) -> bool;

    /// Takes the step if the sum falls; whether it does.
    ///
    /// # Errors
    /// There is no way back.
    fn go(&mut self) -> Result<bool, Self::Lost>;

    /// Whether a step that `promised` so much, the one before it `before`, leaves nothing to gain; `lower` if it was taken.
    fn ends(&self, promised: f64, before: f64, lower: bool) -> bool;
}

/// How a way ended.
pub(crate) struct Descended {
    pub(crate) iterations: usize,
    /// What the last step promised.
    pub(crate) gain: f64,
    pub(crate) converged: bool,
}

/// Goes down as far as it leads, with `most` steps at most.
///
/// # Errors
/// Those of [`Descent::go`].
pub(crate) fn descend<D: Descent>(place: &mut D, by: &Damping, most: usize) -> Result<Descended, D::Lost> {
    let (mut damping, mut gain) = (by.first, f64::INFINITY);
    for iterations in 1..=most {
        stop::point();
        let mut lower = false;
        if let Some(promised) = place.step(damping) {
            let before = std::mem::replace(&mut gain, promised);
            if damping == 0.0 && place.arrives(promised) {
                return Ok(Descended { iterations, gain, converged: true });
            }
            lower = place.go()?;
            if place.ends(promised, before, lower) {
                return Ok(Descended { iterations, gain, converged: true });
            }
        }
        damping = by.after(damping, lower);
        if damping > by.most {
            return Ok(Descended { iterations, gain, converged: false });
        }
    }
    Ok(Descended { iterations: most, gain, converged: false })
}
