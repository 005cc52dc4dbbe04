//! Elimination of exterior orientations or object points, one by one, and the way back.
//!
//! With `N_ee = L L^T` of an eliminated block and `Y = L^-1 N_ek`: the kept unknowns have `S = N_kk - sum Y^T Y` and `b = g_k - sum Y^T L^-1 g_e`; then
//! `x_e = L^-T (L^-1 g_e - Y x_k)`. `Y` is as large as all coupling blocks together: it is made anew where it is needed, member by member.

use super::Engine;
use super::elimination_order::{Coupled, Eliminated, Kept, Ordered};
use super::kernel::{Run, runs, subtract_3, subtract_6};
use super::reduced::Reduced;
use super::small_cholesky::{backward, cholesky, forward};
use super::window::Window;
use crate::state::Step;

/// What the elimination leaves for the way back. `D` unknowns of each eliminated block.
#[derive(Clone, Debug, Default)]
pub(crate) struct Schur {
    /// Cholesky factors, D x D each.
    pub(crate) factors: Vec<f64>,
    /// `L^-1 g_e`.
    right: Vec<f64>,
    /// `b`.
    pub(crate) reduced: Vec<f64>,
    runs: Vec<Run>,
}

/// `Y` of a member, D rows one after the other, and what its columns belong to.
#[derive(Default)]
pub(crate) struct Coupling {
    window: Window,
    pub(super) coupled: Vec<Coupled>,
    pub(super) y: Vec<f64>,
    pub(super) columns: usize,
}

/// A member whose own unknowns are not determined, the others being known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Loose(pub(crate) usize);

impl Schur {
    /// Eliminates; diagonals are raised by the share `damping`.
    pub(crate) fn eliminate(&mut self, of: Ordered, damping: f64, into: &mut Reduced) -> Result<(), Loose> {
        let Ordered { engine: Engine { plan, layout, .. }, normals, .. } = of;
        keep(of, damping, into);
        self.reduced.clear();
        self.reduced.resize(plan.size(), 0.0);
        self.reduced[..layout.width].copy_from_slice(&normals.camera_right);
        for (kept, block) in plan.others() {
            let into = &mut self.reduced[plan.kept[block]..plan.kept[block + 1]];
            match kept {
                Kept::Point(point) => into.copy_from_slice(&normals.point_right[point]),
                Kept::Pose(image) => into.copy_from_slice(&normals.pose_right[image]),
            }
        }
        self.factors.clear();
        self.right.clear();
        match plan.eliminated {
            Eliminated::Poses => self.members::<6>(of, damping, into),
            Eliminated::Points => self.members::<3>(of, damping, into),
        }
    }

    /// Without the right side, once the step is known.
    pub(crate) fn solved(self) -> Self {
        Self { right: Vec::new(), ..self }
    }

    fn members<const D: usize>(&mut self, of: Ordered, damping: f64, into: &mut Reduced) -> Result<(), Loose> {
        let (Ordered { engine: Engine { plan, .. }, normals, .. }, mut coupling) = (of, Coupling::default());
        for (place, &member) in plan.members.iter().enumerate() {
            let (block, right): (&[f64], &[f64]) = match plan.eliminated {
                Eliminated::Poses => (&normals.pose[member], &normals.pose_right[member]),
                Eliminated::Points => (&normals.point[member], &normals.point_right[member]),
            };
            let raised = |i: usize, j: usize| block[i * D + j] * if i == j { 1.0 + damping } else { 1.0 };
            let normal: [[f64; D]; D] = std::array::from_fn(|i| std::array::from_fn(|j| raised(i, j)));
            let l = cholesky(&normal).ok_or(Loose(member))?;
            let mut z: [f64; D] = std::array::from_fn(|i| right[i]);
            forward(&l, &mut z);
            self.factors.extend(l.as_flattened());
            self.right.extend(z);
            coupling.make(of, place, &l);
            self.subtract(&coupling, &z, into);
        }
        Ok(())
    }

    /// Takes `Y^T Y` and `Y^T z` off.
    fn subtract<const D: usize>(&mut self, Coupling { coupled, y, columns, .. }: &Coupling, z: &[f64; D], into: &mut Reduced) {
        let columns = *columns;
        let mut down = 0;
        for (i, column) in coupled.iter().enumerate() {
            let stride = runs(coupled, i, down, into, &mut self.runs);
            if D == 3 {
                subtract_3(y, columns, (down, column.width), &self.runs, stride, &mut into.values);
            } else {
                subtract_6(y, columns, (down, column.width), &self.runs, stride, &mut into.values);
            }
            for j in 0..column.width {
                let sum: f64 = (0..D).map(|d| y[d * columns + down + j] * z[d]).sum();
                self.reduced[column.offset + j] -= sum;
            }
            down += column.width;
        }
    }

    /// The step of all unknowns, of which `kept` are known.
    pub(crate) fn back(&self, of: Ordered, kept: &[f64], step: &mut Step) {
        self.back_with(of, kept, &self.right, step);
    }

    /// The change of all unknowns that goes with a change of those that are kept, while no observation asks for any.
    pub(crate) fn follow(&self, of: Ordered, kept: &[f64], step: &mut Step) {
        self.back_with(of, kept, &[], step);
    }

    fn back_with(&self, of: Ordered, kept: &[f64], right: &[f64], step: &mut Step) {
        let Engine { plan, layout, .. } = of.engine;
        step.cameras.copy_from_slice(&kept[..layout.width]);
        for (held, block) in plan.others() {
            let from = &kept[plan.kept[block]..plan.kept[block + 1]];
            match held {
                Kept::Point(point) => step.points[point].copy_from_slice(from),
                Kept::Pose(image) => step.poses[image].copy_from_slice(from),
            }
        }
        let mut coupling = Coupling::default();
        for (place, &member) in plan.members.iter().enumerate() {
            match plan.eliminated {
                Eliminated::Poses => step.poses[member] = self.back_to(of, place, (kept, right), &mut coupling),
                Eliminated::Points => step.points[member] = self.back_to(of, place, (kept, right), &mut coupling),
            }
        }
    }

    /// `L^-T (z - Y x_k)` of a member, where `right` holds all `z` or nothing.
    fn back_to<const D: usize>(&self, of: Ordered, place: usize, (kept, right): (&[f64], &[f64]), coupling: &mut Coupling) -> [f64; D] {
        let mut x: [f64; D] = std::array::from_fn(|d| right.get(place * D + d).copied().unwrap_or(0.0));
        let l = self.factor::<D>(place);
        coupling.make(of, place, &l);
        let Coupling { coupled, y, columns, .. } = &*coupling;
        let mut column = 0;
        for coupled in coupled {
            let from = &kept[coupled.offset..coupled.offset + coupled.width];
            for (d, x) in x.iter_mut().enumerate() {
                let y = &y[d * columns + column..][..coupled.width];
                *x -= y.iter().zip(from).map(|(y, k)| y * k).sum::<f64>();
            }
            column += coupled.width;
        }
        backward(&l, &mut x);
        x
    }

    /// The step that answers to other right sides.
    pub(crate) fn answer(&self, of: Ordered, right: &Step, solve: impl Fn(&mut [f64])) -> Step {
        let (Engine { plan, layout, .. }, mut coupling) = (of.engine, Coupling::default());
        let (mut kept, mut rights) = (vec![0.0; plan.size()], Vec::with_capacity(plan.members.len() * plan.depth()));
        kept[..layout.width].copy_from_slice(&right.cameras);
        for (held, block) in plan.others() {
            let into = &mut kept[plan.kept[block]..plan.kept[block + 1]];
            match held {
                Kept::Point(point) => into.copy_from_slice(&right.points[point]),
                Kept::Pose(image) => into.copy_from_slice(&right.poses[image]),
            }
        }
        for (place, &member) in plan.members.iter().enumerate() {
            match plan.eliminated {
                Eliminated::Poses => rights.extend(self.take_off::<6>(of, place, right.poses[member], (&mut kept, &mut coupling))),
                Eliminated::Points => rights.extend(self.take_off::<3>(of, place, right.points[member], (&mut kept, &mut coupling))),
            }
        }
        solve(&mut kept);
        let mut step = Step::zero(layout.width, layout.pose_free.len(), layout.triple_free.len());
        self.back_with(of, &kept, &rights, &mut step);
        step
    }

    /// `z = L^-1 g`, after `Y^T z` is taken off the right side of what is kept.
    fn take_off<const D: usize>(
        &self,
        of: Ordered,
        place: usize,
        mut right: [f64; D],
        (kept, coupling): (&mut [f64], &mut Coupling),
    ) -> [f64; D] {
        let l = self.factor::<D>(place);
        forward(&l, &mut right);
        coupling.make(of, place, &l);
        let Coupling { coupled, y, columns, .. } = &*coupling;
        let mut column = 0;
        for coupled in coupled {
            for j in 0..coupled.width {
                let sum: f64 = (0..D).map(|d| y[d * columns + column + j] * right[d]).sum();
                kept[coupled.offset + j] -= sum;
            }
            column += coupled.width;
        }
        right
    }

    /// `L` of a member.
    pub(crate) fn factor<const D: usize>(&self, place: usize) -> [[f64; D]; D] {
        std::array::from_fn(|i| std::array::from_fn(|j| self.factors[place * D * D + i * D + j]))
    }
}

impl Coupling {
    /// Makes that of the member at `place`, whose own block is `l l^T`.
    pub(super) fn make<const D: usize>(&mut self, of: Ordered, place: usize, l: &[[f64; D]; D]) {
        self.window.hold(of, of.engine.plan.members[place]);
        of.engine.plan.couple(&of.engine.layout, place, &mut self.coupled);
        let columns = self.coupled.iter().map(|coupled| coupled.width).sum();
        self.columns = columns;
        self.y.clear();
        self.y.resize(D * columns, 0.0);
        let mut rest = &mut self.y[..];
        for i in 0..D {
            let (row, after) = rest.split_at_mut(columns);
            let mut column = 0;
            for coupled in &self.coupled {
                of.coupling_row(&self.window, coupled, i, &mut row[column..column + coupled.width]);
                column += coupled.width;
            }
            rest = after;
        }
        for (i, row) in l.iter().enumerate() {
            let (above, this) = self.y.split_at_mut(i * columns);
            for (k, factor) in row[..i].iter().enumerate() {
                this[..columns].iter_mut().zip(&above[k * columns..]).for_each(|(y, above)| *y -= factor * above);
            }
            this[..columns].iter_mut().for_each(|y| *y /= row[i]);
        }
    }
}

/// The kept blocks, before anything is taken off.
fn keep(of: Ordered, damping: f64, into: &mut Reduced) {
    let Ordered { engine: Engine { plan, layout, .. }, normals, .. } = of;
    into.values.fill(0.0);
    let mut window = Window::default();
    let mut add = |(row, column): (usize, usize), value: &dyn Fn(usize, usize) -> f64| {
        let (start, stride) = into.place((row, plan.kept[row]), (column, plan.kept[column]));
        for j in 0..plan.width(column) {
            for i in 0..plan.width(row) {
                let raise = if row == column && i == j { 1.0 + damping } else { 1.0 };
                into.values[start + j * stride + i] += value(i, j) * raise;
            }
        }
    };
    for (camera, place) in layout.cameras.iter().enumerate() {
        let width = place.free.len();
        add((camera, camera), &|i, j| normals.camera[camera][i * width + j]);
    }
    for (kept, block) in plan.others() {
        match kept {
            Kept::Point(point) => {
                add((block, block), &|i, j| normals.point[point][3 * i + j]);
                window.hold(of, point);
                for pair in &layout.pairs[layout.pairs_of(point)] {
                    let (width, coupling) = (layout.cameras[pair.camera].free.len(), window.camera(of, pair.offset));
                    add((block, pair.camera), &|i, j| coupling[i * width + j]);
                }
                for (sight, pose) in plan.kept_sights(layout, point) {
                    let coupling = window.pose(of, sight);
                    add((block, pose), &|i, j| coupling[6 * i + j]);
                }
            }
            Kept::Pose(image) => {
                add((block, block), &|i, j| normals.pose[image][6 * i + j]);
                let camera = layout.camera_of[image];
                let width = layout.cameras[camera].free.len();
                add((block, camera), &|i, j| normals.pose_camera[image][i * width + j]);
            }
        }
    }
    for (ends, coupling) in layout.distances.iter().zip(&normals.point_point) {
        let Some([low, high]) = plan.joint(*ends) else { continue };
        let is_turned = plan.point_block[ends[0]] == high;
        add((low, high), &|i, j| if is_turned { coupling[3 * j + i] } else { coupling[3 * i + j] });
    }
}
