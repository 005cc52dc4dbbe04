//! Searches edge and ellipse in turn, until the ellipse stands.

use nalgebra::SVector;

use super::conic::{self, UNKNOWNS};
use super::sectors::{Disc, Window};
use crate::blurred_ellipse::{SHARPEST, is_pictured};
use crate::ellipse::Ellipse;
use crate::marquardt::{Normal, STILL, Scaled, Solution, decompose};

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
/// Marquardt's damping, when there is some: the least and the most.
const DAMPING: f64 = 1e-3;
const STRONGEST: f64 = 1e3;

/// Centre, shape, variance of the blur, grey value outside and contrast.
type Unknowns = SVector<f64, UNKNOWNS>;

/// A step, and its squared length in standard deviations for grey values of unit variance.
struct Step {
    by: Unknowns,
    square: f64,
    factor: Scaled<UNKNOWNS>,
}

/// Steps until one moves the position by less than `short` standard deviations; it is still taken. `None` when that takes too long or comes to a place of no meaning.
///
/// Which pixels make a sector is decided at the start. A step is damped until what is left to go is less than it was: the residuals
/// themselves need not become smaller each time, as the ellipse goes through the edge points and not through the grey values.
///
/// Source: Deuflhard 2004, Sect. 3.3 (natural monotonicity test).
pub(super) fn search(window: &mut Window, start: Unknowns, short: f64) -> Option<Solution<UNKNOWNS>> {
    let mut x = start;
    let mut normal = normal(window, &x, true)?;
    let mut damping = 0.0;
    let mut step = Step::new(&normal, &x, damping)?;
    for search in 0..SEARCHES {
        if step.by[0].hypot(step.by[1]) < STILL || stands(&step, &normal, window.redundancy(), short, search) {
            return Some(Solution { x: bounded(&x, &(x + step.by)), normal });
        }
        let next = bounded(&x, &(x + step.by));
        let tried = self::normal(window, &next, false);
        let left = tried.as_ref().map_or(f64::INFINITY, |normal| step.left(normal, &next));
        match tried {
            Some(better) if left <= step.square * LESS || better.omega <= normal.omega * BETTER => {
                (x, normal, damping) = (next, better, if damping > DAMPING { 0.1 * damping } else { 0.0 });
            }
            _ if damping > STRONGEST => return None,
            _ => damping = (10.0 * damping).max(DAMPING),
        }
        step = Step::new(&normal, &x, damping)?;
    }
    None
}

/// Whether the step is short against its standard deviation, and that of the position shorter than the `short`th part.
fn stands(step: &Step, normal: &Normal<UNKNOWNS>, redundancy: f64, short: f64, search: usize) -> bool {
    let variance = normal.omega / redundancy;
    (step.square <= variance || search >= PATIENCE) && normal.position_rests(&step.by, short * short * variance)
}

fn normal(window: &mut Window, x: &Unknowns, part: bool) -> Option<Normal<UNKNOWNS>> {
    let disc =
        Disc { ellipse: Ellipse { position: [x[0], x[1]], shape: [x[2], x[3], x[4]] }, variance: x[5], ground: x[6], contrast: x[7] };
    if !x.iter().all(|value| value.is_finite()) || !is_pictured(&disc.ellipse, disc.variance, window.side) {
        return None;
    }
    window.picture(&disc);
    if part {
        window.part(&disc.ellipse);
    }
    let (points, common) = window.edge(&disc);
    Some(conic::normal(&points, &common))
}

fn bounded(from: &Unknowns, to: &Unknowns) -> Unknowns {
    let mut to = *to;
    to[BLUR] = to[BLUR].clamp((from[BLUR] / FACTOR).max(SHARPEST), from[BLUR] * FACTOR);
    to
}

/// Whether the blur presses against its bound.
fn pressed(b: &Unknowns, x: &Unknowns) -> bool {
    x[BLUR] <= SHARPEST && b[BLUR] <= 0.0
}

impl Step {
    fn new(normal: &Normal<UNKNOWNS>, x: &Unknowns, damping: f64) -> Option<Self> {
        let (mut n, mut b) = (normal.n, normal.b);
        for i in 0..UNKNOWNS {
            n[(i, i)] *= 1.0 + damping;
        }
        if pressed(&b, x) {
            n.row_mut(BLUR).fill(0.0);
            n.column_mut(BLUR).fill(0.0);
            (n[(BLUR, BLUR)], b[BLUR]) = (1.0, 0.0);
        }
        let factor = decompose(&n)?;
        let by = factor.solve(&b);
        let square = by.dot(&b);
        square.is_finite().then_some(Self { by, square, factor })
    }

    /// The squared length of the same way's next step, from `x`.
    fn left(&self, normal: &Normal<UNKNOWNS>, x: &Unknowns) -> f64 {
        let mut b = normal.b;
        if pressed(&b, x) {
            b[BLUR] = 0.0;
        }
        self.factor.solve(&b).dot(&b)
    }
}
