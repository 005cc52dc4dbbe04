//! From start values to the minimum: Gauss-Newton, damped after Levenberg and Marquardt where it does not descend.

mod eigen;
mod elimination_order;
mod factor;
mod inverse;
mod kernel;
mod place;
mod reduced;
mod schur;
mod selected;
mod small_cholesky;
mod sparse_factor;
mod window;

use calibench_model::stop;

use crate::AdjustError;
use crate::descent::{Descended, UNDAMPED, descend};
use crate::network::{Layout, Network};
use crate::normal::{Loss, Lost, Normals, Scratch, linearise};
use crate::state::{State, Step, before};
pub(crate) use elimination_order::{Eliminated, Kept, Ordered, Plan};
pub(crate) use factor::Factor;
pub(crate) use inverse::{Inverse, Member};
pub(crate) use kernel::{Run, subtract_6};
use place::Place;
pub(crate) use reduced::Reduced;
pub(crate) use schur::{Coupling, Schur};
pub(crate) use small_cholesky::{backward, cholesky, forward};
use sparse_factor::Structure;

/// Sights up to which the couplings of all are kept.
const MOST_KEPT: usize = 1 << 18;

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
        let floor = layout.rounding(&network.observations);
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
        stop::point();
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
        for (kept, block) in self.plan.others() {
            let into = &mut scale[self.plan.kept[block]..self.plan.kept[block + 1]];
            into.iter_mut().enumerate().for_each(|(i, scale)| {
                *scale = root(match kept {
                    Kept::Point(point) => normals.point[point][4 * i],
                    Kept::Pose(image) => normals.pose[image][7 * i],
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

    /// The minimum from `start`.
    ///
    /// # Errors
    /// [`AdjustError::NotPictured`] by the start values.
    pub(crate) fn descend(&self, start: State, most_iterations: usize, worth: f64) -> Result<End, AdjustError> {
        let mut place = Place::at(self, start, worth)?;
        let Descended { iterations, gain, converged } = descend(&mut place, &UNDAMPED, most_iterations)?;
        let Place { state, normals, solved, .. } = place;
        Ok(End { state, normals, iterations, gain, converged, solved })
    }

    fn not_pictured(&self, state: &State, Lost(sight): Lost) -> AdjustError {
        use calibench_model::camera::{CameraModel, NoCounterpart};
        let sight = &self.layout.sights[sight];
        let is_behind = sight.observed(&self.network.observations).behind;
        let ray = before(state.poses[sight.image()].ray(&state.points[sight.point()]), is_behind);
        let why = state.camera(self.network, sight.image()).project(ray).err().unwrap_or(NoCounterpart::NoSolution);
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
            + self.own_gain
    }
}

#[cfg(test)]
mod tests;
