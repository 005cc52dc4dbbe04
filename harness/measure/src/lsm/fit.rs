//! Gauss-Newton for mask and grey values.

use calibench_model::{Affine, Covariance, Rejection, TargetKind};

use super::mask::Mask;
use super::planes::{BLUR, COVERAGE, GROUND, Normal, Planes, Pose, UNKNOWNS};
use super::profile::Profile;
use crate::cholesky;

/// The blur that is sought, px.
const BLURS: (f64, f64) = (0.15, 5.0);
/// Affine terms may still move the edge of the mask by this many times the last step of the position.
const SHAPE: f64 = 10.0;
/// Damping from which a step tells nothing of convergence, and at which there is no way down.
const DAMPED: (f64, f64) = (1e-3, 1e6);

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
    /// Is the blur unknown?
    pub(super) blur: bool,
}

/// The result.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fitted {
    /// The parameters.
    pub(super) parameters: Parameters,
    /// Covariance of the position, px^2.
    pub(super) covariance: Covariance,
}

/// Memory of one fit, used again for the next.
pub(super) struct Work {
    /// The window.
    pub(super) planes: Planes,
    /// The profile of the blur.
    pub(super) profile: Profile,
}

impl Work {
    /// Draws the mask and takes the levels that fit best; the sum of squared residuals with them. `None` if the mask has no contrast in the window.
    pub(super) fn levels(&mut self, mask: &Mask, parameters: &mut Parameters, blur: bool) -> Option<f64> {
        self.profile.set(parameters.sigma);
        self.planes.draw(mask, &parameters.pose, &self.profile, blur);
        (parameters.ground, parameters.contrast) = self.planes.levels()?;
        Some(self.planes.compare(parameters.ground, parameters.contrast))
    }

    fn evaluate(&mut self, mask: &Mask, parameters: &Parameters, blur: bool) -> f64 {
        self.profile.set(parameters.sigma);
        self.planes.draw(mask, &parameters.pose, &self.profile, blur);
        self.planes.compare(parameters.ground, parameters.contrast)
    }

    /// The least-squares fit from `start` on (its levels are taken from the image), by Gauss-Newton; where a step leads upwards, it is damped (Levenberg-Marquardt).
    ///
    /// # Errors
    /// [`Rejection::NoCorner`] for a window in which the parameters cannot be told apart, [`Rejection::LeftWindow`], [`Rejection::NotConverged`].
    pub(super) fn fit(&mut self, mask: &Mask, start: Parameters, limits: Limits) -> Result<Fitted, Rejection> {
        let mut now = start;
        let mut omega = self.levels(mask, &mut now, limits.blur).ok_or(Rejection::NoCorner)?;
        let mut system = System::new(mask.kind, &now, &self.planes.normal(unknowns(limits.blur)), limits.blur);
        let mut damping = 0.0;
        for _ in 0..limits.iterations {
            let step = system.step(damping).ok_or(Rejection::NoCorner)?;
            let next = now.moved(&step).ok_or(Rejection::NotConverged)?;
            if damping <= DAMPED.0 && step.is_small(mask, limits.epsilon) {
                return self.conclude(next, &system, omega);
            }
            let there = self.evaluate(mask, &next, limits.blur);
            if there.is_finite() && there <= omega * (1.0 + 1e-12) {
                (now, omega) = (next, there);
                system = System::new(mask.kind, &now, &self.planes.normal(unknowns(limits.blur)), limits.blur);
                damping = if damping <= DAMPED.0 { 0.0 } else { damping / 10.0 };
            } else {
                damping = if damping == 0.0 { 1e-2 } else { damping * 10.0 };
                if damping > DAMPED.1 {
                    return Err(Rejection::NotConverged);
                }
            }
        }
        Err(Rejection::NotConverged)
    }

    fn conclude(&self, parameters: Parameters, system: &System, omega: f64) -> Result<Fitted, Rejection> {
        let last = (self.planes.count() as f64).sqrt() - 1.0;
        if parameters.pose.at.iter().any(|&p| p < 0.0 || p > last) {
            return Err(Rejection::LeftWindow);
        }
        let variance = omega / (self.planes.count() - system.count) as f64;
        let covariance = system.covariance(variance).ok_or(Rejection::NoCorner)?;
        Ok(Fitted { parameters, covariance })
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
        let radius = (2.0 * mask.moment).sqrt();
        let shape = self.0[2..6].iter().map(|d| d * d).sum::<f64>().sqrt() * radius;
        self.0[0].hypot(self.0[1]) <= epsilon && shape <= SHAPE * epsilon && self.0[BLUR].abs() <= SHAPE * epsilon
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

/// The normal equations of the parameters that can be told apart.
struct System {
    /// How many these are.
    count: usize,
    /// Each as a change of all nine.
    basis: [[f64; UNKNOWNS]; UNKNOWNS],
    normal: [[f64; UNKNOWNS]; UNKNOWNS],
    right: [f64; UNKNOWNS],
}

impl System {
    fn new(kind: TargetKind, at: &Parameters, sums: &Normal, blur: bool) -> Self {
        let (basis, count) = basis(kind, &at.pose.affine, blur);
        // The planes are derivatives of the coverage: the grey value's are the contrast times these, but for the levels' own.
        let scale: [f64; UNKNOWNS] = std::array::from_fn(|i| if i == GROUND || i == COVERAGE { 1.0 } else { at.contrast });
        let mut system = Self { count, basis, normal: [[0.0; UNKNOWNS]; UNKNOWNS], right: [0.0; UNKNOWNS] };
        for i in 0..count {
            let row: [f64; UNKNOWNS] = std::array::from_fn(|k| (0..UNKNOWNS).map(|l| basis[i][l] * scale[l] * sums.products[l][k]).sum());
            for (j, other) in basis.iter().enumerate().take(i + 1) {
                let sum = (0..UNKNOWNS).map(|k| row[k] * scale[k] * other[k]).sum();
                (system.normal[i][j], system.normal[j][i]) = (sum, sum);
            }
            system.right[i] = (0..UNKNOWNS).map(|k| basis[i][k] * scale[k] * sums.right[k]).sum();
        }
        system
    }

    fn step(&self, damping: f64) -> Option<Step> {
        let mut damped = self.normal;
        (0..self.count).for_each(|i| damped[i][i] *= 1.0 + damping);
        let solution = cholesky::factor(&damped, self.count)?.solve(&self.right);
        let all = std::array::from_fn(|k| (0..self.count).map(|i| solution[i] * self.basis[i][k]).sum());
        Some(Step(all))
    }

    fn covariance(&self, variance: f64) -> Option<Covariance> {
        let factor = cholesky::factor(&self.normal, self.count)?;
        let column = |i: usize| factor.solve(&std::array::from_fn(|k| if k == i { variance } else { 0.0 }));
        let (x, y) = (column(0), column(1));
        Some(Covariance { sxx: x[0], sxy: x[1], syy: y[1] })
    }
}

/// Position, what can be told of the shape, levels, and the blur if unknown.
///
/// A disc looks the same after a turn of its own plane: of the four affine terms the three are left that change the ellipse, `dA = A S` with
/// `S` symmetric. Edges without an end have no length: of an open mask each is left its direction.
fn basis(kind: TargetKind, a: &Affine, blur: bool) -> ([[f64; UNKNOWNS]; UNKNOWNS], usize) {
    let unit = |i: usize| std::array::from_fn(|k| if k == i { 1.0 } else { 0.0 });
    let shape = |d: [f64; 4]| std::array::from_fn(|k| if (2..6).contains(&k) { d[k - 2] } else { 0.0 });
    let mut basis = [[0.0; UNKNOWNS]; UNKNOWNS];
    let mut count = 0;
    let mut push = |column: [f64; UNKNOWNS]| {
        basis[count] = column;
        count += 1;
    };
    push(unit(0));
    push(unit(1));
    match kind {
        TargetKind::Disc => {
            [[a.axx, 0.0, a.ayx, 0.0], [0.0, a.axy, 0.0, a.ayy], [a.axy, a.axx, a.ayy, a.ayx]].map(shape).into_iter().for_each(&mut push);
        }
        TargetKind::Corner | TargetKind::ChessCorner => {
            [[-a.ayx, 0.0, a.axx, 0.0], [0.0, -a.ayy, 0.0, a.axy]].map(shape).into_iter().for_each(&mut push);
        }
        _ => (2..6).map(unit).for_each(&mut push),
    }
    push(unit(GROUND));
    push(unit(COVERAGE));
    if blur {
        push(unit(BLUR));
    }
    (basis, count)
}
