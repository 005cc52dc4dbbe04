//! Local distortion of a camera: a smooth random field over the sensor that no camera model holds.
//!
//! The field is white noise on a lattice under a Gaussian, so that its covariance is `sigma^2 exp(-d^2 / (2 correlation^2))` for each component, and the
//! components are independent. The lattice leaves the variance uneven by 3e-5 of itself; values outside the frame fall to zero smoothly.

use std::sync::LazyLock;

use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;
use calibench_random::{Key, Purpose, stream};
use rand_distr::{Distribution, StandardNormal};
use thiserror::Error;

/// Distance of the lattice's nodes, in lengths of correlation.
const STEP: f64 = 2.0 / 3.0;
/// Where a node's Gaussian is cut off, in lengths of correlation: at 1.4e-11 of its height.
const CUT: f64 = 5.0;
/// Nodes within the cut along an axis: `2 CUT / STEP`, and one.
const NEAR: usize = 16;
/// `exp(-(k STEP)^2)`: of two nodes k apart.
static GAUSSIANS: LazyLock<[f64; NEAR]> = LazyLock::new(|| std::array::from_fn(|k| (-(k as f64 * STEP).powi(2)).exp()));
/// Nodes at most: 64 MB.
const MOST_NODES: f64 = 4e6;
/// Most of sigma in lengths of correlation. A fold takes a gradient of ten standard deviations then, which has a chance below 1e-15 at any place.
const STEEPEST: f64 = 0.1;
/// More standard deviations than a component reaches anywhere in a frame.
const REACH: f64 = 6.0;
/// Where Newton's steps to the inverse end, px, and after how many at most.
const CLOSE: f64 = 1e-12;
const STEPS: usize = 20;

/// How large and how smooth the field is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalDesign {
    /// Standard deviation of each component, px.
    pub sigma: f64,
    /// Length of correlation, px: at this distance the correlation is exp(-1/2).
    pub correlation: f64,
}

/// A local distortion that cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LocalError {
    /// Nothing, or less than nothing.
    #[error("`{parameter}` is {value}: expected a number above zero, px")]
    Number {
        /// Its name in scenarios.
        parameter: &'static str,
        /// What it is.
        value: f64,
    },
    /// A field that may fold.
    #[error("`sigma` is {sigma} px with a `correlation` of {correlation} px: the image would fold over; expected at most a tenth, {}", STEEPEST * correlation)]
    Fold {
        /// Standard deviation, px.
        sigma: f64,
        /// Length of correlation, px.
        correlation: f64,
    },
    /// A field with too many nodes.
    #[error("`correlation` is {correlation} px: too fine for a frame of {width} x {height} px, expected at least {least:.2}")]
    Fine {
        /// Length of correlation, px.
        correlation: f64,
        /// Columns, px.
        width: u32,
        /// Rows, px.
        height: u32,
        /// The least length, px.
        least: f64,
    },
}

impl LocalDesign {
    /// Whether fields of this design are one to one over a frame of `size`, and of a size to be held.
    ///
    /// # Errors
    /// [`LocalError`] says which parameter is out of its range, and what was expected.
    pub fn check(&self, size: ImageSize) -> Result<(), LocalError> {
        let Self { sigma, correlation } = *self;
        for (parameter, value) in [("sigma", sigma), ("correlation", correlation)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(LocalError::Number { parameter, value });
            }
        }
        let (width, height) = (f64::from(size.width), f64::from(size.height));
        let nodes = |correlation: f64| count(width, correlation) * count(height, correlation);
        if nodes(correlation) > MOST_NODES {
            // Up to the nodes around the frame their number falls with the square.
            let mut least = (width * height / MOST_NODES).sqrt() / STEP;
            while nodes(least) > MOST_NODES {
                least *= 1.01;
            }
            return Err(LocalError::Fine { correlation, width: size.width, height: size.height, least });
        }
        if sigma > STEEPEST * correlation {
            return Err(LocalError::Fold { sigma, correlation });
        }
        Ok(())
    }
}

/// Nodes along a side of `length` px.
fn count(length: f64, correlation: f64) -> f64 {
    ((length + 2.0 * CUT * correlation) / (STEP * correlation)).ceil() + 1.0
}

/// A field that was drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct LocalDistortion {
    design: LocalDesign,
    columns: usize,
    rows: usize,
    /// Of each node, row by row: x, y, px.
    weights: Vec<Weight>,
}

/// What the field does at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shift {
    /// By how much the image is displaced (x, y), px.
    pub by: [f64; 2],
    /// Its derivatives by the place: rows x, y.
    pub slope: [[f64; 2]; 2],
}

/// The nodes near a coordinate, with their Gaussians and the derivatives; zero beyond the cut.
struct Near {
    from: usize,
    values: [f64; NEAR],
    slopes: [f64; NEAR],
}

/// What stands at a node: x, y, px.
type Weight = [f64; 2];

impl LocalDistortion {
    /// The field of `design` over a frame of `size`. Of `key` seed and trial count: it is the camera's own, and the same in all of a trial's images.
    ///
    /// # Errors
    /// As [`LocalDesign::check`].
    pub fn draw(design: LocalDesign, size: ImageSize, key: Key<'_>) -> Result<Self, LocalError> {
        design.check(size)?;
        let [columns, rows] = [size.width, size.height].map(|side| count(f64::from(side), design.correlation) as usize);
        // Of a Gaussian exp(-x^2 / L^2) on the lattice the squares add up to sqrt(pi / 2) L / step, along each axis.
        let height = design.sigma * STEP / std::f64::consts::FRAC_PI_2.sqrt();
        let mut rng = stream(Key { seed: key.seed, of: "", trial: key.trial, view: "", target: "" }, Purpose::LocalDistortion);
        let mut normal = || height * Distribution::<f64>::sample(&StandardNormal, &mut rng);
        let weights = (0..columns * rows).map(|_| [normal(), normal()]).collect();
        Ok(Self { design, columns, rows, weights })
    }

    /// What was drawn.
    pub fn design(&self) -> LocalDesign {
        self.design
    }

    /// More than any displacement in the frame, px.
    pub fn reach(&self) -> f64 {
        REACH * self.design.sigma
    }

    /// How long a piece of a line may be, px, so that a quartic through five of its images is nearer to them than `tolerance` (px) for all that this field does.
    ///
    /// The fifth derivative of a component has the standard deviation `sqrt(945) sigma / correlation^5`, of which four are taken; of five places a quarter of the
    /// length d apart the remainder is at most 0.00355 d^5 / 5! of it.
    pub(crate) fn longest(&self, tolerance: f64) -> f64 {
        let remainder = 0.00355 / 120.0 * 4.0 * 945_f64.sqrt() * self.design.sigma;
        self.design.correlation * (tolerance / remainder).powf(0.2)
    }

    /// What it does at `at`, where the camera alone would picture a point.
    pub fn at(&self, at: PixelPoint) -> Shift {
        self.shift::<true>(at)
    }

    /// Where the image of a point is that the camera alone would picture at `at`.
    pub fn displaced(&self, at: PixelPoint) -> PixelPoint {
        let [dx, dy] = self.shift::<false>(at).by;
        PixelPoint::new(at.x + dx, at.y + dy)
    }

    /// The shift at `at`; without `SLOPES` its derivatives are left zero.
    fn shift<const SLOPES: bool>(&self, at: PixelPoint) -> Shift {
        let (x, y) = (self.near::<SLOPES>(at.x, self.columns), self.near::<SLOPES>(at.y, self.rows));
        let nodes = &self.weights[y.from * self.columns + x.from..];
        let mut shift = Shift::default();
        let columns = sum_columns(nodes, self.columns, &y.values);
        shift.by = sum_row(&columns, &x.values);
        if SLOPES {
            let (by_x, by_y) = (sum_row(&columns, &x.slopes), sum_row(&sum_columns(nodes, self.columns, &y.slopes), &x.values));
            shift.slope = [0, 1].map(|axis| [by_x[axis], by_y[axis]]);
        }
        shift
    }

    /// Where the camera alone would picture the point whose image is at `at`: the inverse of [`Self::displaced`], to 1e-10 px.
    pub fn undisplaced(&self, at: PixelPoint) -> PixelPoint {
        let mut found = at;
        for _ in 0..STEPS {
            let Shift { by: [x, y], slope: [[xx, xy], [yx, yy]] } = self.at(found);
            let (a, b, c, d) = (1.0 + xx, xy, yx, 1.0 + yy);
            let (x, y) = (at.x - found.x - x, at.y - found.y - y);
            // Nowhere zero: the field does not fold.
            let determinant = a * d - b * c;
            let (dx, dy) = ((d * x - b * y) / determinant, (a * y - c * x) / determinant);
            found = PixelPoint::new(found.x + dx, found.y + dy);
            if dx.hypot(dy) < CLOSE {
                break;
            }
        }
        found
    }

    fn near<const SLOPES: bool>(&self, x: f64, nodes: usize) -> Near {
        let LocalDesign { correlation, .. } = self.design;
        let mut near = Near { from: 0, values: [0.0; NEAR], slopes: [0.0; NEAR] };
        // In steps from the first node.
        let place = ((x + 0.5) / correlation + CUT) / STEP;
        let (first, last) = ((place - CUT / STEP).ceil().max(0.0), (place + CUT / STEP).floor().min(nodes as f64 - 1.0));
        if !place.is_finite() || first > last {
            return near;
        }
        near.from = (first as usize).min(nodes - NEAR);
        let within = first as usize - near.from..last as usize + 1 - near.from;
        let middle = (place.round().clamp(first, last) as usize) - near.from;
        let t = (place - (near.from + middle) as f64) * STEP;
        // exp(-(t - k STEP)^2) = exp(-t^2) exp(2 t STEP)^k exp(-(k STEP)^2): exponentials are dear, and two will do.
        let top = (-t * t).exp();
        let ratio = (2.0 * t * STEP).exp();
        outward(near.values[within.start..=middle].iter_mut().rev(), top, 1.0 / ratio);
        outward(near.values[middle..within.end].iter_mut(), top, ratio);
        if SLOPES {
            for (node, (slope, value)) in near.slopes.iter_mut().zip(near.values).enumerate() {
                *slope = -2.0 * (place - (near.from + node) as f64) * STEP * value / correlation;
            }
        }
        near
    }
}

/// Gaussians of nodes one after the other, away from the one whose own is `top`.
fn outward<'a>(values: impl Iterator<Item = &'a mut f64>, top: f64, ratio: f64) {
    let mut power = top;
    for (value, gaussian) in values.zip(GAUSSIANS.iter()) {
        *value = power * gaussian;
        power *= ratio;
    }
}

/// Of the nodes within `NEAR` rows and columns from the first on: each column's sum down the rows with `factors`, as x, y, x, y.
#[cfg_attr(not(any(test, debug_assertions)), multiversion::multiversion(targets("x86_64+avx512f+avx512vl", "x86_64+avx2")))]
fn sum_columns(nodes: &[Weight], columns: usize, factors: &[f64; NEAR]) -> [f64; 2 * NEAR] {
    let mut sums = [0.0; 2 * NEAR];
    for (row, factor) in nodes.chunks(columns).zip(factors) {
        let Some(row) = row.as_flattened().first_chunk::<{ 2 * NEAR }>() else { return sums };
        for (sum, weight) in sums.iter_mut().zip(row) {
            *sum += factor * weight;
        }
    }
    sums
}

/// The sum of columns, x, y, x, y, with `factors`.
fn sum_row(columns: &[f64; 2 * NEAR], factors: &[f64; NEAR]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for (column, factor) in columns.chunks_exact(2).zip(factors) {
        sums[0] += factor * column[0];
        sums[1] += factor * column[1];
    }
    sums
}

#[cfg(test)]
mod tests;
