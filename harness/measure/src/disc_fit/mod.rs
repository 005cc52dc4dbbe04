//! The ellipse whose blurred picture agrees best with grey values: roughly in single precision, then as exactly as the noise asks for.

mod sums;

use calibench_model::{Image, Rejection};
use nalgebra::SVector;

use crate::blurred_ellipse::{CENTRE, FINE, Fineness, NOISY, Picture, Planes, ROUGH, SHARPEST, is_pictured};
use crate::ellipse::{Ellipse, Guess};
use crate::lanes::Real;
use crate::marquardt::{Normal, Problem, STILL, Solution, minimise};
use crate::residuals::Structure;
use sums::{Greys, Levels, Summed};

/// Centre, three of the shape, variance of the blur, grey value outside, contrast.
pub(crate) const UNKNOWNS: usize = 8;
const BLUR: usize = 5;
/// The iteration ends with a step of so many standard deviations: the rough one, and the last.
const ROUGHLY: f64 = 1.0;
const NEARLY: f64 = 1e-2;
/// Where the outline moves by more than this fraction of the blur its derivatives are worked out anew.
const NEAR: f64 = 0.02;
/// Noise below this fraction of the contrast asks for double precision.
const QUIET: f64 = 1e-4;
/// Noise above this fraction of the contrast hides the errors of [`NOISY`].
const LOUD: f64 = 1e-3;
/// Blur at the start, px^2.
const VARIANCE: f64 = 0.5;
/// Steps with the same derivatives, and how much shorter, squared, each is to be.
const STEPS: usize = 6;
const SHORTER: f64 = 0.1;

pub(crate) type Unknowns = SVector<f64, UNKNOWNS>;

/// The window's grey values.
pub(crate) struct Grey {
    values: Vec<f32>,
    pub(crate) side: usize,
    /// The window's first pixel.
    pub(crate) first: [f64; 2],
}

impl Grey {
    /// Around pixel (x, y), of half-width `half`.
    ///
    /// # Errors
    /// [`Rejection::Border`], [`Rejection::NotFinite`].
    pub(crate) fn new(image: &Image, [x, y]: [i64; 2], half: i64) -> Result<Self, Rejection> {
        let rows = image.rows_around(x, y, half).ok_or(Rejection::Border)?;
        let side = (2 * half + 1) as usize;
        let mut grey = Vec::with_capacity(side * side);
        rows.for_each(|row| grey.extend_from_slice(row));
        if !grey.iter().all(|grey| grey.is_finite()) {
            return Err(Rejection::NotFinite);
        }
        Ok(Self { values: grey, side, first: [x - half, y - half].map(|c| c as f64) })
    }

    /// Its rows.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &[f32]> {
        self.values.chunks_exact(self.side)
    }

    /// Observations minus unknowns.
    pub(crate) fn redundancy(&self) -> f64 {
        (self.values.len() - UNKNOWNS) as f64
    }
}

/// A disc in a window, as a least-squares problem.
struct Disc<T> {
    greys: Greys<T>,
    planes: Planes<T>,
    fineness: Fineness,
    redundancy: f64,
    /// Where the planes were filled last.
    at: Unknowns,
}

impl<T: Real> Disc<T> {
    fn new(grey: &Grey, fineness: Fineness) -> Self {
        let planes = Planes::new(grey.side);
        let at = SVector::zeros();
        Self { greys: Greys::new(&grey.values, grey.side, planes.stride), planes, fineness, redundancy: grey.redundancy(), at }
    }
}

fn ellipse(x: &Unknowns) -> Ellipse {
    Ellipse { position: [x[0], x[1]], shape: [x[2], x[3], x[4]] }
}

fn levels(x: &Unknowns) -> Levels {
    [x[6], x[7]]
}

fn means_something(x: &Unknowns, side: usize) -> bool {
    x.iter().all(|value| value.is_finite()) && is_pictured(&ellipse(x), x[BLUR], side)
}

impl<T: Real> Problem<UNKNOWNS> for Disc<T>
where
    Planes<T>: Picture + Summed<T>,
{
    fn normal(&mut self, x: &Unknowns) -> Option<Normal<UNKNOWNS>> {
        if !means_something(x, self.planes.side) {
            return None;
        }
        self.planes.fill(&ellipse(x), x[BLUR], self.fineness);
        self.at = *x;
        Some(self.planes.normal(&mut self.greys, levels(x)))
    }

    fn lowest(&self, unknown: usize) -> f64 {
        if unknown == BLUR { SHARPEST } else { f64::NEG_INFINITY }
    }

    fn redundancy(&self) -> f64 {
        self.redundancy
    }
}

/// Where a fit starts, in the window's frame.
pub(crate) fn start(grey: &Grey, guess: &Guess) -> Unknowns {
    let ([x, y], [a, b, c]) = (guess.ellipse.position, guess.ellipse.shape);
    let [left, top] = grey.first;
    Unknowns::from([x - left, y - top, a, b, c, VARIANCE, guess.outside, guess.inside - guess.outside])
}

/// A fit, and what it leaves.
pub(crate) struct Fitted {
    pub(crate) found: Solution<UNKNOWNS>,
    pub(crate) structure: Structure,
}

/// A fit in single precision, to a standard deviation.
pub(crate) struct Rough<'a> {
    grey: &'a Grey,
    disc: Disc<f32>,
    pub(crate) near: Solution<UNKNOWNS>,
}

impl<'a> Rough<'a> {
    /// From a start.
    ///
    /// # Errors
    /// [`Rejection::NotConverged`].
    pub(crate) fn new(grey: &'a Grey, start: &Unknowns) -> Result<Self, Rejection> {
        let mut disc = Disc::new(grey, ROUGH);
        let near = minimise(&mut disc, *start, ROUGHLY)?;
        Ok(Self { grey, disc, near })
    }

    /// Whether there is so little noise that single precision is seen.
    pub(crate) fn is_quiet(&self) -> bool {
        self.noise() < QUIET
    }

    /// How closely the outline is to be followed.
    pub(crate) fn fineness(&self) -> Fineness {
        if self.noise() < LOUD { FINE } else { NOISY }
    }

    /// The picture whose derivatives led there, and whether these are those of what was found.
    pub(crate) fn into_planes(self) -> (Planes<f32>, bool) {
        let stands = !has_moved(&self.disc.at, &self.near.x);
        (self.disc.planes, stands)
    }

    /// The noise in units of the contrast.
    fn noise(&self) -> f64 {
        (self.near.normal.omega / self.disc.redundancy).sqrt() / self.near.x[7].abs()
    }

    /// The derivatives near by: those of the last place, unless the outline has moved since.
    fn normal(&mut self) -> Option<Normal<UNKNOWNS>> {
        let x = &self.near.x;
        if has_moved(&self.disc.at, x) { self.disc.normal(x) } else { Some(self.near.normal.clone()) }
    }

    /// Steps by the same derivatives, or almost; `None` where these do not lead there.
    fn settle(mut self) -> Option<Fitted> {
        let fineness = self.fineness();
        let mut exact = self.is_quiet().then(|| Disc::<f64>::new(self.grey, fineness));
        let (mut x, mut normal, mut last) = (self.near.x, self.normal()?, f64::INFINITY);
        for _ in 0..STEPS {
            if !means_something(&x, self.grey.side) {
                return None;
            }
            (normal.b, normal.omega) = match &mut exact {
                Some(exact) => {
                    exact.planes.cover(&ellipse(&x), x[BLUR], fineness);
                    exact.planes.gradient(&self.disc.planes, &mut exact.greys, levels(&x))
                }
                None => {
                    self.disc.planes.cover(&ellipse(&x), x[BLUR], fineness);
                    self.disc.planes.gradient(&self.disc.planes, &mut self.disc.greys, levels(&x))
                }
            };
            let (_, step, square) = normal.step(0.0, |i, b| x[i] <= self.disc.lowest(i) && b <= 0.0).ok()?;
            let next = x + step;
            if next[BLUR] < SHARPEST {
                return None;
            }
            if square <= NEARLY * NEARLY * normal.omega / self.disc.redundancy || step[0].hypot(step[1]) < STILL {
                let residuals = exact.as_ref().map_or_else(|| self.disc.greys.residuals(), |exact| exact.greys.residuals());
                let structure = structure(&self.disc.planes, residuals, next[7]);
                return Some(Fitted { found: Solution { x: next, normal }, structure });
            }
            if square > SHORTER * last {
                return None;
            }
            (x, last) = (next, square);
        }
        None
    }
}

/// Whether an outline is so far from another that its derivatives are others.
pub(crate) fn has_moved(from: &Unknowns, to: &Unknowns) -> bool {
    let (blur, by) = (to[BLUR].sqrt(), to - from);
    by.fixed_rows::<5>(0).amax().max(0.5 * by[BLUR].abs() / blur) > NEAR * blur
}

/// The fit from a start, in the window's frame.
///
/// # Errors
/// [`Rejection::NotConverged`].
pub(crate) fn fit(grey: &Grey, start: &Unknowns) -> Result<Fitted, Rejection> {
    if let Some(fitted) = Rough::new(grey, start).ok().and_then(Rough::settle) {
        return Ok(fitted);
    }
    let mut disc = Disc::<f64>::new(grey, FINE);
    let found = minimise(&mut disc, *start, NEARLY)?;
    let structure = structure(&disc.planes, disc.greys.residuals(), found.x[7]);
    Ok(Fitted { found, structure })
}

/// The structure of `residuals` along the outline, in units of half the contrast.
pub(crate) fn structure<T: Real>(planes: &Planes<T>, mut residuals: Vec<f32>, contrast: f64) -> Structure {
    let by = CENTRE.map(|plane| planes.values[plane].iter().map(|by| Into::<f64>::into(*by) as f32).collect::<Vec<_>>());
    let mut shows = vec![0.0; residuals.len()];
    Structure::of_outline(by.each_ref().map(Vec::as_slice), &mut residuals, &mut shows, (planes.stride, 2.0 / contrast))
}
