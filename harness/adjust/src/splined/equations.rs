//! The normal equations of splines: of each image point its few derivatives.

use calibench_model::Pose;
use calibench_model::camera::{Splined, SplinedImage};
use nalgebra::{Matrix3, Point3, Vector3};

use super::{CORE, SplinedNetwork};
use crate::network::{Counts, ImageObservation, Layout, Status};
use crate::normal::{Loss, Lost, Residual};
use crate::state::{camera_from_world, turned};

/// Derivatives of an image point by what is kept, at most: core, 16 control points, a surface.
const MOST: usize = CORE + 2 * 16 + 3;

/// Values of all unknowns.
#[derive(Clone, Debug)]
pub(super) struct SplinedState {
    pub(super) camera: Splined,
    pub(super) poses: Vec<Pose>,
    /// Coefficients of each surface.
    pub(super) surfaces: Vec<[f64; 3]>,
}

/// A change of all unknowns.
#[derive(Clone, Debug)]
pub(super) struct SplinedStep {
    /// Core, control points, coefficients of the surfaces.
    pub(super) kept: Vec<f64>,
    pub(super) poses: Vec<[f64; 6]>,
}

impl SplinedStep {
    /// A part of it.
    pub(super) fn times(&self, part: f64) -> Self {
        let mut step = self.clone();
        step.kept.iter_mut().chain(step.poses.as_flattened_mut()).for_each(|value| *value *= part);
        step
    }
}

/// Splines that are adjusted: where everything stands.
#[derive(Clone, Debug)]
pub(super) struct Frame<'n> {
    pub(super) of: &'n SplinedNetwork,
    pub(super) layout: Layout,
    pub(super) counts: Counts,
    pub(super) loss: Loss,
    /// Which of the kept unknowns may change.
    pub(super) free: Vec<bool>,
    /// What rounding of pixels makes of the sum of squares.
    pub(super) floor: f64,
}

impl<'n> Frame<'n> {
    /// Of a checked network.
    pub(super) fn new(of: &'n SplinedNetwork, layout: Layout, loss: Loss) -> Self {
        let (surfaces, control) = (&of.network.surfaces, of.camera.control.len());
        let shapes = surfaces.iter().flat_map(|surface| surface.statuses).map(Status::is_unknown);
        let free: Vec<bool> = of.core.into_iter().chain((0..2 * control).map(|_| true)).chain(shapes).collect();
        let mut counts = layout.counts;
        counts.unknowns = free.iter().filter(|free| **free).count() + 6 * of.network.images.len();
        // The prior: two of each control point.
        counts.observed = 2 * control;
        let floor = layout.rounding(&of.network.observations);
        Self { of, layout, counts, loss, free, floor }
    }

    pub(super) fn start(&self) -> SplinedState {
        let network = &self.of.network;
        SplinedState {
            camera: self.of.camera.clone(),
            poses: network.images.iter().map(|image| image.pose).collect(),
            surfaces: network.surfaces.iter().map(|surface| surface.coefficients).collect(),
        }
    }

    /// Where a point is.
    pub(super) fn point(&self, state: &SplinedState, point: usize) -> Point3<f64> {
        let position = self.of.network.points[point].position;
        match self.layout.triples.surface_of(point) {
            Some((surface, basis)) => position + basis * Vector3::from(state.surfaces[surface]),
            None => position,
        }
    }

    pub(super) fn moved(&self, state: &SplinedState, step: &SplinedStep) -> SplinedState {
        let mut moved = state.clone();
        let [core, control, shapes] = self.parts(&step.kept);
        moved.camera.core.iter_mut().zip(core).for_each(|(value, change)| *value += change);
        // Images are linear in fx and fx times the control points, together: steps in these keep to the valley along which the two stand for each other.
        let kept = [0, 1].map(|axis| state.camera.core[axis] / moved.camera.core[axis]);
        for (point, change) in moved.camera.control.iter_mut().zip(control.chunks_exact(2)) {
            (0..2).for_each(|axis| point[axis] += change[axis] * kept[axis]);
        }
        moved.surfaces.as_flattened_mut().iter_mut().zip(shapes).for_each(|(value, change)| *value += change);
        moved.poses.iter_mut().zip(&step.poses).for_each(|(pose, step)| *pose = turned(pose, step));
        moved
    }

    /// Core, control points, surfaces.
    fn parts<'k>(&self, kept: &'k [f64]) -> [&'k [f64]; 3] {
        let ((core, rest), numbers) = (kept.split_at(CORE), self.of.numbers());
        let (control, shapes) = rest.split_at(numbers - CORE);
        [core, control, shapes]
    }

    /// Linearises all observation equations at `state`.
    ///
    /// # Errors
    /// [`Lost`], if a measured point lies straight behind the camera.
    pub(super) fn linearise(&self, state: &SplinedState, into: &mut SplinedNormals) -> Result<(), Lost> {
        into.reset(self);
        let mut image_rows = ImageRows::new(self.free.len());
        for (image, range) in self.layout.of_image.iter().enumerate() {
            image_rows.clear();
            for sight in range.clone() {
                let row = SightRow::of(self, state, (image, sight))?;
                into.residuals[sight] = row.residual;
                into.cost += row.cost;
                into.add(&row, &self.free);
                image_rows.add(&row, &self.free);
            }
            into.images.push(image_rows.normals());
        }
        into.add_prior(self.of, state);
        Ok(())
    }
}

/// An image point's derivatives by what is kept and by its pose, its weight (xx, xy, yy) and misclosure (observed less computed, px).
pub(super) struct SightRow {
    columns: [usize; MOST],
    by: [[f64; 2]; MOST],
    count: usize,
    pub(super) pose: [[f64; 2]; 6],
    weight: [f64; 3],
    misclosure: [f64; 2],
    residual: Residual,
    cost: f64,
}

impl SightRow {
    pub(super) fn of(frame: &Frame<'_>, state: &SplinedState, (image, sight): (usize, usize)) -> Result<Self, Lost> {
        let (seen, pose) = (&frame.layout.sights[sight], &state.poses[image]);
        let ray = pose.ray(&frame.point(state, seen.point()));
        let pictured = state.camera.picture(ray).map_err(|_| Lost(sight))?;
        if !pictured.point.is_finite() {
            return Err(Lost(sight));
        }
        let ImageObservation { position, precision, .. } = seen.observed(&frame.of.network.observations);
        let px = [pictured.point.x - position.x, pictured.point.y - position.y];
        let [a, b, c] = precision.whitening();
        let [x, y] = precision.whitened(px);
        let (cost, robust) = frame.loss.of(x * x + y * y);
        let weight = [a * a + b * b, b * c, c * c].map(|weight| weight * robust);
        let gradient = |axis: usize| [pictured.by_ray[0][axis], pictured.by_ray[1][axis]];
        let (dx, dy, dz) = (gradient(0), gradient(1), gradient(2));
        // d N = d x N + s.
        let cross = |a: f64, p: [f64; 2], b: f64, q: [f64; 2]| [a * p[0] - b * q[0], a * p[1] - b * q[1]];
        let pose_columns = [cross(ray.y, dz, ray.z, dy), cross(ray.z, dx, ray.x, dz), cross(ray.x, dy, ray.y, dx), dx, dy, dz];
        let mut row = Self {
            columns: [0; MOST],
            by: [[0.0; 2]; MOST],
            count: 0,
            pose: pose_columns,
            weight,
            misclosure: px.map(|v| -v),
            residual: Residual { px, weight: robust },
            cost,
        };
        row.push_interior(&state.camera, &pictured);
        if let Some((surface, basis)) = frame.layout.triples.surface_of(seen.point()) {
            row.push_surface(frame.of.numbers() + 3 * surface, &(camera_from_world(pose).rotation, basis), [dx, dy, dz]);
        }
        Ok(row)
    }

    /// Derivatives by what is kept, px: of which, and of x and y.
    pub(super) fn kept(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        self.columns.into_iter().zip(self.by).take(self.count)
    }

    fn push(&mut self, column: usize, by: [f64; 2]) {
        (self.columns[self.count], self.by[self.count]) = (column, by);
        self.count += 1;
    }

    fn push_interior(&mut self, camera: &Splined, image: &SplinedImage) {
        let [fx, fy, ..] = camera.core;
        let [x, y] = image.distorted;
        for (column, by) in [[x, 0.0], [0.0, y], [1.0, 0.0], [0.0, 1.0]].into_iter().enumerate() {
            self.push(column, by);
        }
        for (place, share) in image.control() {
            self.push(CORE + 2 * place, [fx * share, 0.0]);
            self.push(CORE + 2 * place + 1, [0.0, fy * share]);
        }
    }

    /// d N = M B da.
    fn push_surface(&mut self, first: usize, (rotation, basis): &([[f64; 3]; 3], &Matrix3<f64>), gradient: [[f64; 2]; 3]) {
        for k in 0..3 {
            let moved: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| rotation[i][j] * basis[(j, k)]).sum());
            let along = |axis: usize| (0..3).map(|i| gradient[i][axis] * moved[i]).sum();
            self.push(first + k, [along(0), along(1)]);
        }
    }

    fn weighted(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [xx, xy, yy] = self.weight;
        [xx * x + xy * y, xy * x + yy * y]
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// What an image says of its pose, and of what is kept with it.
#[derive(Clone, Debug)]
pub(super) struct ImageNormals {
    pub(super) own: [[f64; 6]; 6],
    pub(super) right: [f64; 6],
    /// The kept unknowns that it touches, in ascending order.
    pub(super) columns: Vec<usize>,
    /// 6 x columns, row by row.
    pub(super) coupling: Vec<f64>,
}

/// Sums of the points of an image.
struct ImageRows {
    own: [[f64; 6]; 6],
    right: [f64; 6],
    /// Of each kept unknown: with the pose.
    coupling: Vec<[f64; 6]>,
    touched: Vec<bool>,
}

impl ImageRows {
    fn new(kept: usize) -> Self {
        Self { own: [[0.0; 6]; 6], right: [0.0; 6], coupling: vec![[0.0; 6]; kept], touched: vec![false; kept] }
    }

    fn clear(&mut self) {
        (self.own, self.right) = ([[0.0; 6]; 6], [0.0; 6]);
        self.coupling.fill([0.0; 6]);
        self.touched.fill(false);
    }

    fn add(&mut self, row: &SightRow, free: &[bool]) {
        let pose = row.pose.map(|by| row.weighted(by));
        for (i, weighted) in pose.iter().enumerate() {
            self.right[i] += dot(*weighted, row.misclosure);
            (0..6).for_each(|j| self.own[i][j] += dot(*weighted, row.pose[j]));
        }
        for (&column, by) in row.columns.iter().zip(&row.by).take(row.count).filter(|(column, _)| free[**column]) {
            self.touched[column] = true;
            self.coupling[column].iter_mut().zip(&pose).for_each(|(sum, weighted)| *sum += dot(*weighted, *by));
        }
    }

    fn normals(&self) -> ImageNormals {
        let columns: Vec<usize> = (0..self.touched.len()).filter(|&column| self.touched[column]).collect();
        let coupling = (0..6).flat_map(|i| columns.iter().map(move |&column| self.coupling[column][i])).collect();
        ImageNormals { own: self.own, right: self.right, columns, coupling }
    }
}

/// Blocks of `N dx = g`.
#[derive(Clone, Debug, Default)]
pub(super) struct SplinedNormals {
    /// Weighted sum of squares of image points and prior.
    pub(super) cost: f64,
    /// The prior's part of it.
    pub(super) prior: f64,
    /// Of what is kept: the lower triangle, column by column. An unknown that may not change has a one on its diagonal and nothing else.
    pub(super) kept: Vec<f64>,
    pub(super) right: Vec<f64>,
    pub(super) images: Vec<ImageNormals>,
    /// Of each sight.
    pub(super) residuals: Vec<Residual>,
}

impl SplinedNormals {
    fn reset(&mut self, frame: &Frame<'_>) {
        let n = frame.free.len();
        (self.cost, self.prior) = (0.0, 0.0);
        self.kept.clear();
        self.kept.resize(n * n, 0.0);
        self.right.clear();
        self.right.resize(n, 0.0);
        self.images.clear();
        self.residuals.resize(frame.layout.sights.len(), Residual::default());
        frame.free.iter().enumerate().filter(|(_, free)| !**free).for_each(|(i, _)| self.kept[i * (n + 1)] = 1.0);
    }

    fn add(&mut self, row: &SightRow, free: &[bool]) {
        let n = self.right.len();
        let is_free: [bool; MOST] = std::array::from_fn(|i| i < row.count && free[row.columns[i]]);
        for i in (0..row.count).filter(|i| is_free[*i]) {
            let (column, weighted) = (row.columns[i], row.weighted(row.by[i]));
            self.right[column] += dot(weighted, row.misclosure);
            // Columns ascend within a row.
            let values = &mut self.kept[column * n..(column + 1) * n];
            for j in (i..row.count).filter(|j| is_free[*j]) {
                values[row.columns[j]] += dot(weighted, row.by[j]);
            }
        }
    }

    fn add_prior(&mut self, of: &SplinedNetwork, state: &SplinedState) {
        let n = self.right.len();
        for (place, &[x, y]) in state.camera.control.iter().enumerate() {
            let ([xx, xy, yy], first) = (of.prior.weight(&of.camera, place), CORE + 2 * place);
            self.kept[first * (n + 1)] += xx;
            self.kept[first * n + first + 1] += xy;
            self.kept[(first + 1) * (n + 1)] += yy;
            let weighted = [xx * x + xy * y, xy * x + yy * y];
            self.right[first] -= weighted[0];
            self.right[first + 1] -= weighted[1];
            self.prior += dot(weighted, [x, y]);
        }
        self.cost += self.prior;
    }

    /// `g^T x`.
    pub(super) fn along(&self, step: &SplinedStep) -> f64 {
        let poses = self.images.iter().zip(&step.poses).flat_map(|(image, step)| image.right.iter().zip(step));
        self.right.iter().zip(&step.kept).chain(poses).map(|(g, x)| g * x).sum()
    }
}
