//! Searches edge and ellipse in turn, until the ellipse stands.

use calibench_model::Rejection;
use nalgebra::SVector;

use super::conic::{self, UNKNOWNS};
use super::sectors::{Disc, Sectored, Window};
use crate::blurred_ellipse::{Picture, Planes, SHARPEST, is_pictured};
use crate::disc_fit::has_moved;
use crate::ellipse::Ellipse;
use crate::lanes::Real;
use crate::marquardt::descent::{Damping, Descent, Gone, descend};
use crate::marquardt::{Normal, STILL, Scaled, Solution};

const BLUR: usize = 5;
/// In one step the blur's variance changes at most by this factor.
const FACTOR: f64 = 4.0;
/// What is left to go must be less than this fraction of the square of what it was.
const LESS: f64 = 0.8;
/// A step is also taken that leaves no more than this fraction of the squared residuals.
const BETTER: f64 = 0.97;
const SEARCHES: usize = 60;
/// From so many searches on only the position need stand: a small, soft disc hardly tells its size from its blur and contrast.
const PATIENCE: usize = 6;
/// Steps by the same derivatives, and how much shorter, squared, each is to be.
const STEPS: usize = 6;
const SHORTER: f64 = 0.1;
const DAMPING: Damping = Damping { first: 0.0, again: 1e-3, least: 5e-4, rest: 0.0, most: 1e3 };

/// Centre, shape, variance of the blur, grey value outside and contrast.
type Unknowns = SVector<f64, UNKNOWNS>;

/// A step, and its squared length in standard deviations for grey values of unit variance.
struct Step {
    by: Unknowns,
    square: f64,
    factor: Scaled<UNKNOWNS>,
}

/// Steps until one moves the position by less than `short` standard deviations; it is still taken.
///
/// Which pixels make a sector is decided at the start. A step is damped until what is left to go is less than it was: the residuals
/// themselves need not become smaller each time, as the ellipse goes through the edge points and not through the grey values.
///
/// Source: Deuflhard 2004, Sect. 3.3 (natural monotonicity test).
///
/// # Errors
/// [`Rejection::NotConverged`] when that takes too long or comes to a place of no meaning.
pub(super) fn search<T: Real>(window: &mut Window<T>, start: Unknowns, short: f64) -> Result<Solution<UNKNOWNS>, Rejection>
where
    Planes<T>: Picture,
    Window<T>: Sectored,
{
    let normal = normal(window, &start, true).ok_or(Rejection::NotConverged)?;
    descend(&mut Search { window, x: start, normal, short }, &DAMPING, SEARCHES)
}

/// Steps from a start that is near, by the derivatives there (which the window's planes hold already if `stands`) unless the outline moves on; until one moves the position by less than `short` standard
/// deviations: it is still taken. `None` where they do not become shorter.
pub(super) fn settle<T: Real>(window: &mut Window<T>, start: Unknowns, stands: bool, short: f64) -> Option<Solution<UNKNOWNS>>
where
    Planes<T>: Picture,
    Window<T>: Sectored,
{
    let (mut at, mut x, mut last) = (start, start, f64::INFINITY);
    let disc = pictured(window, &start)?;
    if stands {
        window.cover(&disc);
    } else {
        window.picture(&disc);
    }
    window.part(&disc.ellipse);
    let mut normal = of_edge(window, &disc);
    for _ in 0..STEPS {
        let (_, step, square) = normal.step(0.0, |i, b| is_pressed(i, b, &x)).ok()?;
        let next = bounded(&x, &(x + step));
        let variance = normal.omega / window.redundancy();
        let is_short = || square <= variance && normal.position_rests(&step, short * short * variance);
        if step[0].hypot(step[1]) < STILL || is_short() {
            return Some(Solution { x: next, normal });
        }
        if square > SHORTER * last {
            return None;
        }
        (x, last) = (next, square);
        if has_moved(&at, &x) {
            (at, normal) = (x, self::normal(window, &x, false)?);
        } else {
            (normal.b, normal.omega) = window.gradient(&pictured(window, &x)?);
        }
    }
    None
}

struct Search<'a, T> {
    window: &'a mut Window<T>,
    x: Unknowns,
    normal: Normal<UNKNOWNS>,
    short: f64,
}

impl<T: Real> Descent for Search<'_, T>
where
    Planes<T>: Picture,
    Window<T>: Sectored,
{
    type Step = Step;
    type Found = Solution<UNKNOWNS>;

    fn step(&self, damping: f64) -> Result<Step, Rejection> {
        let (factor, by, square) = self.normal.step(damping, |i, b| is_pressed(i, b, &self.x))?;
        Ok(Step { by, square, factor })
    }

    /// The step is short against its standard deviation, and that of the position shorter than the `short`th part.
    fn found(&self, step: &Step, _: bool, trial: usize) -> Result<Option<Self::Found>, Rejection> {
        let variance = self.normal.omega / self.window.redundancy();
        let stands =
            || (step.square <= variance || trial >= PATIENCE) && self.normal.position_rests(&step.by, self.short * self.short * variance);
        let found = || Solution { x: bounded(&self.x, &(self.x + step.by)), normal: self.normal.clone() };
        Ok((step.by[0].hypot(step.by[1]) < STILL || stands()).then(found))
    }

    fn go(&mut self, step: Step, _: bool) -> Result<Gone<Self::Found>, Rejection> {
        let next = bounded(&self.x, &(self.x + step.by));
        Ok(match normal(self.window, &next, false) {
            Some(there) if step.left(&there, &next) <= step.square * LESS || there.omega <= self.normal.omega * BETTER => {
                (self.x, self.normal) = (next, there);
                Gone::Down
            }
            _ => Gone::Up,
        })
    }
}

fn normal<T: Real>(window: &mut Window<T>, x: &Unknowns, part: bool) -> Option<Normal<UNKNOWNS>>
where
    Planes<T>: Picture,
    Window<T>: Sectored,
{
    let disc = pictured(window, x)?;
    window.picture(&disc);
    if part {
        window.part(&disc.ellipse);
    }
    Some(of_edge(window, &disc))
}

/// The normal equations of the edge of the disc that was pictured.
fn of_edge<T: Real>(window: &mut Window<T>, disc: &Disc) -> Normal<UNKNOWNS>
where
    Planes<T>: Picture,
    Window<T>: Sectored,
{
    let (points, common) = window.edge(disc);
    conic::normal(&points, &common)
}

/// The disc of these unknowns; `None` where they have no meaning.
fn pictured<T>(window: &Window<T>, x: &Unknowns) -> Option<Disc> {
    let ellipse = Ellipse { position: [x[0], x[1]], shape: [x[2], x[3], x[4]] };
    let sane = x.iter().all(|value| value.is_finite()) && is_pictured(&ellipse, x[BLUR], window.side);
    sane.then_some(Disc { ellipse, variance: x[BLUR], ground: x[6], contrast: x[7] })
}

fn bounded(from: &Unknowns, to: &Unknowns) -> Unknowns {
    let mut to = *to;
    to[BLUR] = to[BLUR].clamp((from[BLUR] / FACTOR).max(SHARPEST), from[BLUR] * FACTOR);
    to
}

/// Whether an unknown is the blur and presses against its bound.
fn is_pressed(unknown: usize, b: f64, x: &Unknowns) -> bool {
    unknown == BLUR && x[BLUR] <= SHARPEST && b <= 0.0
}

impl Step {
    /// The squared length of the same way's next step, from `x`.
    fn left(&self, normal: &Normal<UNKNOWNS>, x: &Unknowns) -> f64 {
        let mut b = normal.b;
        if is_pressed(BLUR, b[BLUR], x) {
            b[BLUR] = 0.0;
        }
        self.factor.solve(&b).dot(&b)
    }
}
