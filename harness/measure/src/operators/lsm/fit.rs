//! Gauss-Newton for mask and grey values.

use calibench_model::{Affine, Covariance, Image, Rejection, TargetKind, Warp};

use super::area::{self, WIDEST};
use super::mask::{Mask, Rule};
use super::planes::{BLUR, COVERAGE, Derivatives, GROUND, Planes, Pose, UNKNOWNS};
use super::profile::Profile;
use crate::cholesky::{self, Factor, SINGULAR};
use crate::marquardt::descent::{Damping, Descent, Gone, descend};

/// The blur that is sought, px.
pub(super) const BLURS: (f64, f64) = (0.15, 5.0);
/// Affine terms may still move the edge of the mask by this many times the last step of the position; where the blur is sought, edge and blur only by as
/// much as the position: what is left goes with the square of the whole step.
const SHAPE: f64 = 3.0;
/// By what share a sum of squares may be off: that of a coarse drawing, and that of single precision.
const COARSE: f64 = 1e-2;
const EXACT: f64 = 1e-6;
const DAMPING: Damping = Damping { first: 0.0, again: 1e-2, least: 5e-4, rest: 0.0, most: 1e5 };

/// All parameters. Positions count from the window's first pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parameters {
    /// Where the mask is.
    pub(super) pose: Pose,
    /// The grey value around the target.
    pub(super) ground: f64,
    /// The target's grey value less the ground's.
    pub(super) contrast: f64,
    /// Standard deviation of the blur, px.
    pub(super) sigma: f64,
}

/// When to end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Most iterations.
    pub(super) iterations: usize,
    /// Last step of the position, px.
    pub(super) epsilon: f64,
    /// The blur is an unknown.
    pub(super) blur: bool,
}

/// The result.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fitted {
    /// The parameters.
    pub(super) parameters: Parameters,
    /// Covariance of the position, px^2.
    pub(super) covariance: Covariance,
    /// Standard deviation of a grey value, from the residuals.
    pub(super) noise: f64,
}

/// Memory of one fit, used again for the next.
pub(super) struct Work {
    /// The window.
    pub(super) planes: Planes,
    /// The profile of the blur.
    pub(super) profile: Profile,
    /// What the lens does to the mask beyond its affine map, if it does.
    pub(super) warp: Option<Warp>,
}

impl Work {
    /// Takes the window around a pixel; returns its lowest and highest grey value.
    ///
    /// # Errors
    /// [`Rejection::Border`]; those of [`area::range`].
    pub(super) fn observe(&mut self, image: &Image, (x, y): (i64, i64), half: i64) -> Result<(f32, f32), Rejection> {
        self.planes.observe(image.rows_around(x, y, half).ok_or(Rejection::Border)?);
        area::range(self.planes.grey())
    }

    /// Only these pixels count, as in [`Planes::count_only`], or all.
    pub(super) fn count(&mut self, pixels: Option<&[u64; WIDEST]>) {
        match pixels {
            Some(pixels) => self.planes.count_only(pixels),
            None => self.planes.count_all(),
        }
    }

    /// Draws the mask and takes the levels that fit best; the sum of squared residuals with them. `None` if the mask has no contrast in the window.
    pub(super) fn levels(&mut self, mask: &Mask, parameters: &mut Parameters) -> Option<f64> {
        self.draw(mask, parameters, (Derivatives::None, Rule::Coarse));
        (parameters.ground, parameters.contrast) = self.planes.levels()?;
        Some(self.planes.compare(parameters.ground, parameters.contrast))
    }

    pub(super) fn draw(&mut self, mask: &Mask, parameters: &Parameters, wanted: (Derivatives, Rule)) {
        self.profile.set(parameters.sigma);
        self.planes.draw(mask, (&parameters.pose, self.warp.as_ref()), &self.profile, wanted);
    }

    #[inline(always)]
    fn system(&self, mask: &Mask, at: &Parameters, blur: bool) -> Result<System, Rejection> {
        let (products, right) = self.planes.products(unknowns(blur));
        System::new(mask.kind, at, &products, &right, blur).ok_or(Rejection::NoCorner)
    }

    /// The least-squares fit from `start` on (its levels are taken from the image), by Gauss-Newton; where a step leads upwards, it is damped
    /// (Levenberg-Marquardt).
    ///
    /// # Errors
    /// [`Rejection::NoCorner`] for a window in which the parameters cannot be told apart, [`Rejection::LeftWindow`], [`Rejection::NotConverged`].
    pub(super) fn fit(&mut self, mask: &Mask, start: Parameters, limits: Limits) -> Result<Fitted, Rejection> {
        // The first drawing only leads to the next: no result comes of it.
        self.fit_from(mask, start, limits, (Rule::Coarse, COARSE))
    }

    /// As [`Self::fit`], from a `start` that is near.
    ///
    /// # Errors
    /// As [`Self::fit`].
    pub(super) fn fit_again(&mut self, mask: &Mask, start: Parameters, limits: Limits) -> Result<Fitted, Rejection> {
        self.fit_from(mask, start, limits, (Rule::Exact, EXACT))
    }

    fn fit_from(&mut self, mask: &Mask, start: Parameters, limits: Limits, (rule, slack): (Rule, f64)) -> Result<Fitted, Rejection> {
        let all = if limits.blur { Derivatives::PoseAndBlur } else { Derivatives::Pose };
        let mut at = start;
        self.draw(mask, &at, (all, rule));
        (at.ground, at.contrast) = self.planes.levels().ok_or(Rejection::NoCorner)?;
        let omega = self.planes.compare(at.ground, at.contrast);
        let system = self.system(mask, &at, limits.blur)?;
        descend(&mut Fit { work: self, mask, limits, at, omega, slack, system }, &DAMPING, limits.iterations)
    }

    fn conclude(&self, parameters: Parameters, system: &System, omega: f64) -> Result<Fitted, Rejection> {
        let last = self.planes.side() as f64 - 1.0;
        if parameters.pose.at.iter().any(|&p| p < 0.0 || p > last) {
            return Err(Rejection::LeftWindow);
        }
        let redundancy = self.planes.count().checked_sub(system.columns.count).filter(|r| *r > 0).ok_or(Rejection::NoCorner)?;
        let variance = omega / redundancy as f64;
        Ok(Fitted { parameters, covariance: system.covariance(variance), noise: variance.sqrt() })
    }
}

/// A fit on its way.
struct Fit<'a> {
    work: &'a mut Work,
    mask: &'a Mask,
    limits: Limits,
    at: Parameters,
    omega: f64,
    /// By what share `omega` may be off.
    slack: f64,
    system: System,
}

impl Descent for Fit<'_> {
    type Step = Step;
    type Found = Fitted;

    #[inline(always)]
    fn step(&self, damping: f64) -> Result<Step, Rejection> {
        self.system.step(damping).ok_or(Rejection::NoCorner)
    }

    #[inline(always)]
    fn found(&self, step: &Step, weak: bool, _: usize) -> Result<Option<Fitted>, Rejection> {
        if self.slack == COARSE || !weak || !step.is_small(self.mask, self.limits.epsilon) {
            return Ok(None);
        }
        let last = self.at.moved(step).ok_or(Rejection::NotConverged)?;
        self.work.conclude(last, &self.system, self.omega).map(Some)
    }

    #[inline(always)]
    fn go(&mut self, step: Step, _: bool) -> Result<Gone<Fitted>, Rejection> {
        let next = self.at.moved(&step).ok_or(Rejection::NotConverged)?;
        let all = if self.limits.blur { Derivatives::PoseAndBlur } else { Derivatives::Pose };
        self.work.draw(self.mask, &next, (all, Rule::Exact));
        let omega = self.work.planes.compare(next.ground, next.contrast);
        if !(omega.is_finite() && omega <= self.omega * (1.0 + self.slack)) {
            return Ok(Gone::Up);
        }
        (self.at, self.omega, self.slack) = (next, omega, EXACT);
        self.system = self.work.system(self.mask, &next, self.limits.blur)?;
        Ok(Gone::Down)
    }
}

fn unknowns(blur: bool) -> usize {
    if blur { UNKNOWNS } else { UNKNOWNS - 1 }
}

/// A change of all nine parameters.
struct Step([f64; UNKNOWNS]);

impl Step {
    fn is_small(&self, mask: &Mask, epsilon: f64) -> bool {
        // The shape's terms count with the mask's radius of gyration.
        let shape = self.0[2..6].iter().map(|d| d * d).sum::<f64>() * 2.0 * mask.moment;
        let position = self.0[0] * self.0[0] + self.0[1] * self.0[1];
        let bound = if self.0[BLUR] == 0.0 { SHAPE * epsilon } else { epsilon };
        position <= epsilon * epsilon && shape <= bound * bound && self.0[BLUR].abs() <= bound
    }
}

impl Parameters {
    /// After a step; `None` if the mask would collapse, turn over or leave all bounds.
    fn moved(&self, Step(d): &Step) -> Option<Self> {
        let [x, y] = self.pose.at;
        let a = self.pose.affine;
        let affine = Affine { axx: a.axx + d[2], axy: a.axy + d[3], ayx: a.ayx + d[4], ayy: a.ayy + d[5] };
        let determinant = |a: &Affine| a.axx * a.ayy - a.axy * a.ayx;
        let kept = determinant(&affine) / determinant(&a);
        let at = [x + d[0], y + d[1]];
        let sane = kept > 0.01 && kept < 100.0 && at.iter().all(|p| p.abs() < 1e3);
        let sigma = (self.sigma + d[BLUR]).clamp(BLURS.0.max(self.sigma / 2.0), BLURS.1.min(self.sigma * 2.0));
        let sigma = if d[BLUR] == 0.0 { self.sigma } else { sigma };
        sane.then_some(Self { pose: Pose { at, affine }, ground: self.ground + d[GROUND], contrast: self.contrast + d[COVERAGE], sigma })
    }
}

type Square = [[f64; UNKNOWNS]; UNKNOWNS];

/// The normal equations of the parameters that can be told apart.
struct System {
    columns: Columns,
    normal: Square,
    right: [f64; UNKNOWNS],
    factor: Factor<UNKNOWNS>,
}

impl System {
    /// `None` if it is singular.
    #[inline(always)]
    fn new(kind: TargetKind, at: &Parameters, products: &Square, right: &[f64; UNKNOWNS], blur: bool) -> Option<Self> {
        let columns = Columns::new(kind, &at.pose.affine, blur);
        // The planes are derivatives of the coverage: the grey value's are the contrast times these, but for the levels' own.
        let mut scale = [at.contrast; UNKNOWNS];
        (scale[GROUND], scale[COVERAGE]) = (1.0, 1.0);
        let (normal, of_residuals) = columns.combine(&scale, products, right);
        let factor = cholesky::factor(&normal, columns.count, SINGULAR)?;
        Some(Self { columns, normal, right: of_residuals, factor })
    }

    fn step(&self, damping: f64) -> Option<Step> {
        let solution = if damping == 0.0 {
            self.factor.solve(&self.right)
        } else {
            let mut damped = self.normal;
            (0..self.columns.count).for_each(|i| damped[i][i] *= 1.0 + damping);
            cholesky::factor(&damped, self.columns.count, SINGULAR)?.solve(&self.right)
        };
        let mut all = [0.0; UNKNOWNS];
        for (change, column) in solution.iter().zip(self.columns.iter()) {
            column.terms().for_each(|(k, factor)| all[k] += change * factor);
        }
        Some(Step(all))
    }

    fn covariance(&self, variance: f64) -> Covariance {
        let [[xx, xy], [_, yy]] = self.factor.inverse();
        Covariance { sxx: variance * xx, sxy: variance * xy, syy: variance * yy }
    }
}

/// A parameter that can be told, as a change of some of the nine.
#[derive(Clone, Copy, Default)]
struct Column {
    terms: [(usize, f64); 4],
    count: usize,
}

impl Column {
    fn of(terms: &[(usize, f64)]) -> Self {
        let mut column = Self { count: terms.len(), ..Self::default() };
        column.terms[..terms.len()].copy_from_slice(terms);
        column
    }

    fn terms(&self) -> impl Iterator<Item = (usize, f64)> {
        self.terms[..self.count].iter().copied()
    }
}

/// Position, what can be told of the shape, levels, and the blur if unknown.
struct Columns {
    all: [Column; UNKNOWNS],
    count: usize,
    /// Each is one of the nine, in their order.
    single: bool,
}

impl Columns {
    /// A disc looks the same after a turn of its own plane: of the four affine terms the three are left that change the ellipse, `dA = A S` with
    /// `S` symmetric. Edges without an end have no length: of an open mask each is left its direction.
    fn new(kind: TargetKind, a: &Affine, blur: bool) -> Self {
        let single = !matches!(kind, TargetKind::Disc | TargetKind::Corner | TargetKind::ChessCorner);
        let mut columns = Self { all: [Column::default(); UNKNOWNS], count: 0, single };
        let (axx, axy, ayx, ayy) = (2, 3, 4, 5);
        columns.push(&[(0, 1.0)]);
        columns.push(&[(1, 1.0)]);
        match kind {
            TargetKind::Disc => {
                columns.push(&[(axx, a.axx), (ayx, a.ayx)]);
                columns.push(&[(axy, a.axy), (ayy, a.ayy)]);
                columns.push(&[(axx, a.axy), (axy, a.axx), (ayx, a.ayy), (ayy, a.ayx)]);
            }
            TargetKind::Corner | TargetKind::ChessCorner => {
                columns.push(&[(axx, -a.ayx), (ayx, a.axx)]);
                columns.push(&[(axy, -a.ayy), (ayy, a.axy)]);
            }
            _ => [axx, axy, ayx, ayy].into_iter().for_each(|i| columns.push(&[(i, 1.0)])),
        }
        columns.push(&[(GROUND, 1.0)]);
        columns.push(&[(COVERAGE, 1.0)]);
        if blur {
            columns.push(&[(BLUR, 1.0)]);
        }
        columns
    }

    /// The normal equations of these columns from those of all nine parameters, each of which counts with its `scale`.
    #[inline(always)]
    fn combine(&self, scale: &[f64; UNKNOWNS], products: &Square, right: &[f64; UNKNOWNS]) -> (Square, [f64; UNKNOWNS]) {
        let (mut scaled, mut of_residuals) = (*products, *right);
        for (i, row) in scaled.iter_mut().enumerate() {
            row.iter_mut().zip(scale).for_each(|(product, scale_k)| *product *= scale[i] * scale_k);
            of_residuals[i] *= scale[i];
        }
        if self.single {
            return (scaled, of_residuals);
        }
        let (mut normal, mut combined) = ([[0.0; UNKNOWNS]; UNKNOWNS], [0.0; UNKNOWNS]);
        for (i, column) in self.iter().enumerate() {
            let mut row = [0.0; UNKNOWNS];
            for (l, factor) in column.terms() {
                for k in 0..UNKNOWNS {
                    row[k] += factor * scaled[l][k];
                }
            }
            for (j, other) in self.iter().enumerate().take(i + 1) {
                let sum = other.terms().map(|(k, factor)| row[k] * factor).sum();
                (normal[i][j], normal[j][i]) = (sum, sum);
            }
            combined[i] = column.terms().map(|(k, factor)| factor * of_residuals[k]).sum();
        }
        (normal, combined)
    }

    fn push(&mut self, terms: &[(usize, f64)]) {
        self.all[self.count] = Column::of(terms);
        self.count += 1;
    }

    fn iter(&self) -> impl Iterator<Item = &Column> {
        self.all[..self.count].iter()
    }
}
