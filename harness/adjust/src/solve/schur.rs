//! Elimination of exterior orientations or object points, one by one, and the way back.
//!
//! With `N_ee = L L^T` of an eliminated block and `Y = L^-1 N_ek`: the kept unknowns have `S = N_kk - sum Y^T Y` and `b = g_k - sum Y^T L^-1 g_e`; then
//! `x_e = L^-T (L^-1 g_e - Y x_k)`.

use super::elimination_order::{Eliminated, Plan};
use super::kernel::{Run, runs, subtract_3, subtract_6};
use super::reduced::Reduced;
use super::small_cholesky::{backward, cholesky, forward};
use crate::network::Layout;
use crate::normal::{Normals, Step};

/// What the elimination leaves for the way back. `D` unknowns of each eliminated block.
#[derive(Clone, Debug, Default)]
pub(crate) struct Schur {
    /// Cholesky factors, D x D each.
    pub(crate) factors: Vec<f64>,
    /// `L^-1 g_e`.
    right: Vec<f64>,
    /// `Y`, D rows each.
    pub(crate) y: Vec<f64>,
    /// Of each member: first value of its `Y`, and its columns.
    pub(crate) place: Vec<(usize, usize)>,
    /// `b`.
    pub(crate) reduced: Vec<f64>,
    runs: Vec<Run>,
}

/// A member whose own unknowns are not determined, the others being known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Loose(pub(crate) usize);

impl Schur {
    /// Eliminates; diagonals are raised by the share `damping`.
    pub(crate) fn eliminate(
        &mut self,
        plan: &Plan,
        layout: &Layout,
        normals: &Normals,
        damping: f64,
        into: &mut Reduced,
    ) -> Result<(), Loose> {
        keep(plan, layout, normals, damping, into);
        self.reduced.clear();
        self.reduced.resize(plan.size(), 0.0);
        self.reduced[..layout.width].copy_from_slice(&normals.camera_right);
        for (kept, &block) in plan.block_of.iter().enumerate().filter(|(_, block)| **block != usize::MAX) {
            let into = &mut self.reduced[plan.kept[block]..plan.kept[block + 1]];
            match plan.eliminated {
                Eliminated::Poses => into.copy_from_slice(&normals.point_right[kept]),
                Eliminated::Points => into.copy_from_slice(&normals.pose_right[kept]),
            }
        }
        self.factors.clear();
        self.right.clear();
        self.y.clear();
        self.place.clear();
        match plan.eliminated {
            Eliminated::Poses => self.members::<6>(plan, normals, damping, into),
            Eliminated::Points => self.members::<3>(plan, normals, damping, into),
        }
    }

    fn members<const D: usize>(&mut self, plan: &Plan, normals: &Normals, damping: f64, into: &mut Reduced) -> Result<(), Loose> {
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
            self.couple(plan, normals, place, &l);
            self.subtract(plan, place, &z, into);
        }
        Ok(())
    }

    /// `Y` of a member.
    fn couple<const D: usize>(&mut self, plan: &Plan, normals: &Normals, place: usize, l: &[[f64; D]; D]) {
        let coupled = &plan.coupled[plan.start[place]..plan.start[place + 1]];
        let columns = coupled.iter().map(|coupled| coupled.width).sum();
        let first = self.y.len();
        self.place.push((first, columns));
        self.y.resize(first + D * columns, 0.0);
        let mut rest = &mut self.y[first..];
        for i in 0..D {
            let (row, after) = rest.split_at_mut(columns);
            let mut column = 0;
            for coupled in coupled {
                plan.coupling_row(normals, coupled, i, &mut row[column..column + coupled.width]);
                column += coupled.width;
            }
            rest = after;
        }
        let y = &mut self.y[first..];
        for (i, row) in l.iter().enumerate() {
            let (above, this) = y.split_at_mut(i * columns);
            for (k, factor) in row[..i].iter().enumerate() {
                this[..columns].iter_mut().zip(&above[k * columns..]).for_each(|(y, above)| *y -= factor * above);
            }
            this[..columns].iter_mut().for_each(|y| *y /= row[i]);
        }
    }

    /// Takes `Y^T Y` and `Y^T z` off.
    fn subtract<const D: usize>(&mut self, plan: &Plan, place: usize, z: &[f64; D], into: &mut Reduced) {
        let coupled = &plan.coupled[plan.start[place]..plan.start[place + 1]];
        let (first, columns) = self.place[place];
        let y = &self.y[first..first + D * columns];
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
    pub(crate) fn back(&self, plan: &Plan, layout: &Layout, kept: &[f64], step: &mut Step) {
        self.back_with(plan, layout, kept, &self.right, step);
    }

    /// The change of all unknowns that goes with a change of those that are kept, while no observation asks for any.
    pub(crate) fn follow(&self, plan: &Plan, layout: &Layout, kept: &[f64], step: &mut Step) {
        self.back_with(plan, layout, kept, &[], step);
    }

    fn back_with(&self, plan: &Plan, layout: &Layout, kept: &[f64], right: &[f64], step: &mut Step) {
        step.cameras.copy_from_slice(&kept[..layout.width]);
        for (index, &block) in plan.block_of.iter().enumerate().filter(|(_, block)| **block != usize::MAX) {
            let from = &kept[plan.kept[block]..plan.kept[block + 1]];
            match plan.eliminated {
                Eliminated::Poses => step.points[index].copy_from_slice(from),
                Eliminated::Points => step.poses[index].copy_from_slice(from),
            }
        }
        for (place, &member) in plan.members.iter().enumerate() {
            match plan.eliminated {
                Eliminated::Poses => step.poses[member] = self.back_to(plan, place, kept, right),
                Eliminated::Points => step.points[member] = self.back_to(plan, place, kept, right),
            }
        }
    }

    /// `L^-T (z - Y x_k)` of a member, where `right` holds all `z` or nothing.
    fn back_to<const D: usize>(&self, plan: &Plan, place: usize, kept: &[f64], right: &[f64]) -> [f64; D] {
        let mut x: [f64; D] = std::array::from_fn(|d| right.get(place * D + d).copied().unwrap_or(0.0));
        let (first, columns) = self.place[place];
        let mut column = 0;
        for coupled in &plan.coupled[plan.start[place]..plan.start[place + 1]] {
            let from = &kept[coupled.offset..coupled.offset + coupled.width];
            for (d, x) in x.iter_mut().enumerate() {
                let y = &self.y[first + d * columns + column..][..coupled.width];
                *x -= y.iter().zip(from).map(|(y, k)| y * k).sum::<f64>();
            }
            column += coupled.width;
        }
        backward(&self.factor::<D>(place), &mut x);
        x
    }

    /// The step that answers to other right sides.
    pub(crate) fn answer(&self, plan: &Plan, layout: &Layout, right: &Step, solve: impl Fn(&mut [f64])) -> Step {
        let (mut kept, mut rights) = (vec![0.0; plan.size()], Vec::with_capacity(self.right.len()));
        kept[..layout.width].copy_from_slice(&right.cameras);
        for (index, &block) in plan.block_of.iter().enumerate().filter(|(_, block)| **block != usize::MAX) {
            let into = &mut kept[plan.kept[block]..plan.kept[block + 1]];
            match plan.eliminated {
                Eliminated::Poses => into.copy_from_slice(&right.points[index]),
                Eliminated::Points => into.copy_from_slice(&right.poses[index]),
            }
        }
        for (place, &member) in plan.members.iter().enumerate() {
            match plan.eliminated {
                Eliminated::Poses => rights.extend(self.take_off::<6>(plan, place, right.poses[member], &mut kept)),
                Eliminated::Points => rights.extend(self.take_off::<3>(plan, place, right.points[member], &mut kept)),
            }
        }
        solve(&mut kept);
        let mut step = Step::zero(layout.width, layout.pose_free.len(), layout.point_free.len());
        self.back_with(plan, layout, &kept, &rights, &mut step);
        step
    }

    /// `z = L^-1 g`, after `Y^T z` is taken off the right side of what is kept.
    fn take_off<const D: usize>(&self, plan: &Plan, place: usize, mut right: [f64; D], kept: &mut [f64]) -> [f64; D] {
        forward(&self.factor::<D>(place), &mut right);
        let (first, columns) = self.place[place];
        let mut column = 0;
        for coupled in &plan.coupled[plan.start[place]..plan.start[place + 1]] {
            for j in 0..coupled.width {
                let sum: f64 = (0..D).map(|d| self.y[first + d * columns + column + j] * right[d]).sum();
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

/// The kept blocks, before anything is taken off.
fn keep(plan: &Plan, layout: &Layout, normals: &Normals, damping: f64, into: &mut Reduced) {
    into.values.fill(0.0);
    let mut put = |(row, column): (usize, usize), (height, width): (usize, usize), value: &dyn Fn(usize, usize) -> f64| {
        let (start, stride) = into.place((row, plan.kept[row]), (column, plan.kept[column]));
        for j in 0..width {
            for i in 0..height {
                let raise = if row == column && i == j { 1.0 + damping } else { 1.0 };
                into.values[start + j * stride + i] = value(i, j) * raise;
            }
        }
    };
    for (camera, place) in layout.cameras.iter().enumerate() {
        let width = place.free.len();
        put((camera, camera), (width, width), &|i, j| normals.camera[camera][i * width + j]);
    }
    for (kept, &block) in plan.block_of.iter().enumerate().filter(|(_, block)| **block != usize::MAX) {
        match plan.eliminated {
            Eliminated::Poses => {
                put((block, block), (3, 3), &|i, j| normals.point[kept][3 * i + j]);
                for pair in &layout.pairs[layout.pairs_of(kept)] {
                    let width = layout.cameras[pair.camera].free.len();
                    put((block, pair.camera), (3, width), &|i, j| normals.point_camera[pair.offset + i * width + j]);
                }
            }
            Eliminated::Points => {
                put((block, block), (6, 6), &|i, j| normals.pose[kept][6 * i + j]);
                let camera = layout.camera_of[kept];
                let width = layout.cameras[camera].free.len();
                put((block, camera), (6, width), &|i, j| normals.pose_camera[kept][i * width + j]);
            }
        }
    }
}
