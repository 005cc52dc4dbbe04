//! From start values to the minimum: Gauss-Newton, damped after Levenberg and Marquardt where it does not descend.

mod eigen;
mod elimination_order;
mod factor;
mod inverse;
mod kernel;
mod reduced;
mod schur;
mod small_cholesky;
mod window;

use crate::AdjustError;
use crate::network::{ImageObservation, Layout, Network, Sight};
use crate::normal::{Loss, Lost, Normals, Scratch, linearise, residuals};
use crate::state::{State, Step};
pub(crate) use elimination_order::{Eliminated, Ordered, Plan};
use factor::{Factor, Structure};
pub(crate) use inverse::{Inverse, Member};
use reduced::Reduced;
pub(crate) use schur::{Coupling, Schur};

/// Sights up to which the couplings of all are kept.
const MOST_KEPT: usize = 1 << 18;
/// Damping that is tried first, and below which there is none.
const FIRST: f64 = 1e-6;
const LEAST: f64 = 1e-9;
/// Damping beyond which nothing helps.
const MOST: f64 = 1e12;
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

/// The reduced normal equations, solved: what the way back and covariances need.
#[derive(Clone, Debug)]
pub(crate) struct Solved {
    pub(crate) schur: Schur,
    pub(crate) factor: Factor,
}

/// A network on its way to the minimum.
#[derive(Clone, Debug)]
pub(crate) struct Engine<'n> {
    pub(crate) network: &'n Network,
    pub(crate) layout: Layout,
    pub(crate) plan: Plan,
    pub(crate) loss: Loss,
    structure: Option<Structure>,
    blank: Reduced,
    /// What rounding of pixels makes of the sum of squares.
    floor: f64,
}

/// Where the iteration ended.
#[derive(Clone, Debug)]
pub(crate) struct End {
    pub(crate) state: State,
    pub(crate) normals: Normals,
    pub(crate) iterations: usize,
    /// What the last step still promised.
    pub(crate) gain: f64,
    pub(crate) converged: bool,
    /// The normal equations, solved, where the iteration needed that already.
    pub(crate) solved: Option<Solved>,
}

impl<'n> Engine<'n> {
    pub(crate) fn new(network: &'n Network, mut layout: Layout, loss: Loss) -> Self {
        let plan = Plan::of(&layout);
        layout.keeps_couplings = plan.eliminated == Eliminated::Poses || layout.sights.len() <= MOST_KEPT;
        let blank = Reduced::new(&plan.kept, || plan.pattern(&layout));
        let structure = Structure::of(&blank);
        let rounding = |at: f64, whiten: f64| (4.0 * f64::EPSILON * at.abs().max(1.0) * whiten).powi(2);
        let floor = |sight: &Sight| {
            let ImageObservation { position, precision, .. } = sight.observed(&network.observations);
            let [a, _, c] = precision.whitening();
            rounding(position.x, a) + rounding(position.y, c)
        };
        let floor = layout.sights.iter().map(floor).sum();
        Self { network, layout, plan, loss, structure, blank, floor }
    }

    pub(crate) fn linearise(&self, state: &State, scratch: &mut Scratch, into: &mut Normals) -> Result<(), Lost> {
        linearise(self.network, &self.layout, state, self.loss, scratch, into)
    }

    /// The normal equations made at `state`, in the order of elimination.
    pub(crate) fn ordered<'a>(&'a self, state: &'a State, normals: &'a Normals) -> Ordered<'a> {
        Ordered { engine: self, state, normals }
    }

    /// Solves the normal equations with their diagonal raised; `None` if they are singular.
    pub(crate) fn decompose(&self, (state, normals): (&State, &Normals), damping: f64) -> Option<Solved> {
        let (mut schur, mut reduced) = (Schur::default(), self.blank.clone());
        schur.eliminate(self.ordered(state, normals), damping, &mut reduced).ok()?;
        let factor = Factor::of(reduced, self.scale(normals), self.structure.as_ref())?;
        Some(Solved { schur: schur.solved(), factor })
    }

    /// Eigenvalues and eigenvectors of the reduced matrix, scaled to ones on the diagonal of the normal equations, from the smallest on: all of a small
    /// matrix, a few of a large one. Vectors are in the unknowns' own units. `None` if an eliminated block is singular by itself.
    pub(crate) fn weakest(&self, state: &State, normals: &Normals) -> Option<(Schur, Vec<eigen::Pair>)> {
        let (mut schur, mut reduced) = (Schur::default(), self.blank.clone());
        schur.eliminate(self.ordered(state, normals), 0.0, &mut reduced).ok()?;
        let scale = self.scale(normals);
        let pairs = if scale.len() <= eigen::FULL {
            eigen::all(&reduced.into_dense(), &scale)
        } else {
            eigen::few(&self.decompose((state, normals), eigen::SHIFT)?.factor, &scale)
        };
        let own = |(value, vector): eigen::Pair| (value, vector.iter().zip(&scale).map(|(x, scale)| x / scale).collect());
        Some((schur, pairs.into_iter().map(own).collect()))
    }

    /// Roots of the diagonal of the kept unknowns.
    fn scale(&self, normals: &Normals) -> Vec<f64> {
        let root = |value: f64| if value > 0.0 { value.sqrt() } else { 1.0 };
        let mut scale = vec![1.0; self.plan.size()];
        for (camera, place) in self.layout.cameras.iter().enumerate() {
            let width = place.free.len();
            (0..width).for_each(|i| scale[place.offset + i] = root(normals.camera[camera][i * (width + 1)]));
        }
        for (kept, &block) in self.plan.block_of.iter().enumerate().filter(|(_, block)| **block != usize::MAX) {
            let into = &mut scale[self.plan.kept[block]..self.plan.kept[block + 1]];
            into.iter_mut().enumerate().for_each(|(i, scale)| {
                *scale = root(match self.plan.eliminated {
                    Eliminated::Poses => normals.point[kept][4 * i],
                    Eliminated::Points => normals.pose[kept][7 * i],
                });
            });
        }
        scale
    }

    /// The blocks of the inverse that covariances need.
    pub(crate) fn inverse(&self, solved: &Solved) -> Inverse {
        Inverse::of(solved, &self.plan, &self.blank)
    }

    /// `N^-1 right`.
    pub(crate) fn answer(&self, solved: &Solved, End { state, normals, .. }: &End, right: &Step) -> Step {
        solved.schur.answer(self.ordered(state, normals), right, |x| solved.factor.solve(x))
    }

    /// Zeros where nothing may change.
    pub(crate) fn mask(&self, step: &mut Step) {
        for (image, values) in step.poses.iter_mut().enumerate() {
            let free = self.layout.pose_mask(image);
            values.iter_mut().zip(free).filter(|(_, free)| !free).for_each(|(value, _)| *value = 0.0);
        }
        for (values, free) in step.points.iter_mut().zip(&self.layout.triple_free) {
            values.iter_mut().zip(free).filter(|(_, free)| !**free).for_each(|(value, _)| *value = 0.0);
        }
    }

    pub(crate) fn zero_step(&self) -> Step {
        Step::zero(self.layout.width, self.layout.pose_free.len(), self.layout.triple_free.len())
    }

    /// The step with `damping`, what it promises and the decomposition behind it; `None` if there is none.
    fn step(&self, (state, normals): (&State, &Normals), damping: f64, schur: &mut Schur, step: &mut Step) -> Option<(f64, Factor)> {
        let mut reduced = self.blank.clone();
        schur.eliminate(self.ordered(state, normals), damping, &mut reduced).ok()?;
        let factor = Factor::of(reduced, self.scale(normals), self.structure.as_ref())?;
        let mut kept = schur.reduced.clone();
        factor.solve(&mut kept);
        schur.back(self.ordered(state, normals), &kept, step);
        step.is_finite().then(|| (normals.along(step), factor))
    }

    /// The minimum from `start`.
    ///
    /// # Errors
    /// [`AdjustError::NotPictured`] by the start values.
    pub(crate) fn descend(&self, start: State, most_iterations: usize) -> Result<End, AdjustError> {
        let (mut scratch, mut normals) = (Scratch::default(), Normals::default());
        self.linearise(&start, &mut scratch, &mut normals).map_err(|lost| self.not_pictured(&start, lost))?;
        let (mut state, mut step, mut damping, mut gain) = (start, self.zero_step(), 0.0, f64::INFINITY);
        let mut schur = Schur::default();
        for iterations in 1..=most_iterations {
            let mut accepted = false;
            if let Some((promised, factor)) = self.step((&state, &normals), damping, &mut schur, &mut step) {
                let before = std::mem::replace(&mut gain, promised);
                let cost = normals.cost;
                if damping == 0.0 && gain <= NOTHING * cost {
                    let moved = state.moved(&self.layout, &step);
                    if residuals(self.network, &self.layout, &moved, &mut scratch, &mut normals).is_ok() {
                        let solved = Some(Solved { schur: schur.solved(), factor });
                        return Ok(End { state: moved, normals, iterations, gain, converged: true, solved });
                    }
                }
                let moved = state.moved(&self.layout, &step);
                let pictured = self.linearise(&moved, &mut scratch, &mut normals).is_ok();
                accepted = pictured && normals.cost <= cost * (1.0 + ROUNDING) + NOISE * self.floor;
                if accepted {
                    state = moved;
                } else {
                    // Seldom, so that one set of equations is in memory and not two.
                    self.linearise(&state, &mut scratch, &mut normals).map_err(|lost| self.not_pictured(&state, lost))?;
                }
                // Nothing to gain, or so little that rounding alone decides: it no longer falls.
                let stands = (gain <= LITTLE * cost || gain <= NOISE * self.floor) && gain > 0.25 * before;
                if gain <= WORTH * cost + self.floor || (accepted && stands) {
                    return Ok(End { state, normals, iterations, gain, converged: true, solved: None });
                }
            }
            damping = match (accepted, damping) {
                (true, damping) if damping <= LEAST => 0.0,
                (true, damping) => damping * 0.1,
                (false, damping) => (damping * 10.0).max(FIRST),
            };
            if damping > MOST {
                return Ok(End { state, normals, iterations, gain, converged: false, solved: None });
            }
        }
        Ok(End { state, normals, iterations: most_iterations, gain, converged: false, solved: None })
    }

    fn not_pictured(&self, state: &State, Lost(sight): Lost) -> AdjustError {
        use calibench_model::camera::{CameraModel, NoCounterpart};
        let sight = &self.layout.sights[sight];
        let ray = state.poses[sight.image()].ray(&state.points[sight.point()]);
        let why = state.cameras[self.layout.camera_of[sight.image()]].project(ray).err().unwrap_or(NoCounterpart::NoSolution);
        let (image, point) = (self.network.images[sight.image()].name.clone(), self.network.points[sight.point()].name.clone());
        AdjustError::NotPictured { image, point, why }
    }
}

impl Normals {
    /// `g^T x`.
    pub(crate) fn along(&self, step: &Step) -> f64 {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        dot(&self.camera_right, &step.cameras)
            + dot(self.pose_right.as_flattened(), step.poses.as_flattened())
            + dot(self.point_right.as_flattened(), step.points.as_flattened())
    }
}

#[cfg(test)]
mod tests;
