//! The normal equations of a rig, from those of its images.

use calibench_model::Pose;
use calibench_model::camera::Camera;
use nalgebra::{Cholesky, Const, DMatrix, DVector, Dyn, Matrix6, Point3, Vector6};

use super::frames::{adjoint, mounted};
use super::{Rig, Station};
use crate::network::{Counts, Layout};
use crate::normal::{Loss, Lost, Normals, Scratch, linearise};
use crate::state::{State, Step, turned};

/// A pivot relative to the diagonal it started from, below which it is rounding.
pub(super) const LOST: f64 = 1e-13;

/// Values of all unknowns.
#[derive(Clone, Debug, Default)]
pub(super) struct RigState {
    pub(super) cameras: Vec<Camera>,
    pub(super) mounts: Vec<Pose>,
    pub(super) stations: Vec<Pose>,
}

/// A change of all unknowns.
#[derive(Clone, Debug)]
pub(super) struct RigStep {
    /// Interiors of all cameras, then mounts.
    pub(super) kept: DVector<f64>,
    pub(super) stations: Vec<Vector6<f64>>,
}

/// A rig that is adjusted: where everything stands.
#[derive(Clone, Debug)]
pub(super) struct Frame<'r> {
    pub(super) rig: &'r Rig,
    pub(super) layout: Layout,
    pub(super) counts: Counts,
    /// First unknown of each mount among those that are kept; `None` of the origin.
    pub(super) mount: Vec<Option<usize>>,
    /// Unknowns that are kept: interiors and mounts.
    pub(super) kept: usize,
    /// Of each station: its images in use.
    pub(super) images: Vec<Vec<usize>>,
    pub(super) loss: Loss,
    points: Vec<Point3<f64>>,
    /// What rounding of pixels makes of the sum of squares.
    pub(super) floor: f64,
}

impl<'r> Frame<'r> {
    /// Of a checked rig.
    pub(super) fn new(rig: &'r Rig, layout: Layout, loss: Loss) -> Self {
        let mut images = vec![Vec::new(); rig.stations.len()];
        let used = layout.of_image.iter().enumerate().filter(|(_, range)| !range.is_empty());
        used.for_each(|(image, _)| images[rig.station_of[image]].push(image));
        let mut kept = layout.width;
        let mut place = |camera: usize| {
            let own = (camera != rig.origin).then_some(kept);
            kept += if own.is_some() { 6 } else { 0 };
            own
        };
        let mount: Vec<Option<usize>> = (0..rig.mounts.len()).map(&mut place).collect();
        let stations = images.iter().filter(|images| !images.is_empty()).count();
        let mut counts = layout.counts;
        counts.unknowns = kept + 6 * stations;
        counts.observed = Counts::of(&rig.network, 0, 0).observed;
        let floor = layout.rounding(&rig.network.observations);
        let points = rig.network.points.iter().map(|point| point.position).collect();
        Self { rig, layout, counts, mount, kept, images, loss, points, floor }
    }

    pub(super) fn start(&self) -> RigState {
        RigState {
            cameras: self.rig.network.cameras.iter().map(|interior| interior.camera).collect(),
            mounts: self.rig.mounts.clone(),
            stations: self.rig.stations.iter().map(|Station { pose, .. }| *pose).collect(),
        }
    }

    /// The state of the images.
    pub(super) fn whole(&self, state: &RigState) -> State {
        let pose = |(image, &station): (usize, &usize)| mounted(&state.mounts[self.layout.camera_of[image]], &state.stations[station]);
        let poses = self.rig.station_of.iter().enumerate().map(pose).collect();
        State { cameras: state.cameras.clone(), poses, points: self.points.clone(), ..State::default() }
    }

    pub(super) fn moved(&self, state: &RigState, step: &RigStep) -> RigState {
        let six = |from: &[f64]| -> [f64; 6] { std::array::from_fn(|i| from[i]) };
        let mount = |(pose, place): (&Pose, &Option<usize>)| match place {
            Some(first) => turned(pose, &six(&step.kept.as_slice()[*first..])),
            None => *pose,
        };
        let interiors = Step { cameras: step.kept.as_slice()[..self.layout.width].to_vec(), ..Step::default() };
        let bare = State { cameras: state.cameras.clone(), ..State::default() };
        RigState {
            cameras: bare.moved(&self.layout, &interiors).cameras,
            mounts: state.mounts.iter().zip(&self.mount).map(mount).collect(),
            stations: state.stations.iter().zip(&step.stations).map(|(pose, step)| turned(pose, &six(step.as_slice()))).collect(),
        }
    }

    /// Linearises all observation equations at `state`.
    pub(super) fn linearise(&self, state: &RigState, scratch: &mut Scratch, into: &mut RigNormals) -> Result<(), Lost> {
        linearise(&self.rig.network, &self.layout, &self.whole(state), self.loss, scratch, &mut into.images)?;
        into.gather(self, state);
        Ok(())
    }

    /// Unknowns of an image that are kept: places of those of its camera, then of its mount.
    pub(super) fn columns(&self, image: usize) -> Vec<usize> {
        let camera = self.layout.camera_of[image];
        let place = &self.layout.cameras[camera];
        let interior = place.offset..place.offset + place.free.len();
        interior.chain(self.mount[camera].into_iter().flat_map(|first| first..first + 6)).collect()
    }
}

/// What the images of a station say of it, and of what they share with others.
#[derive(Clone, Debug)]
pub(super) struct StationNormals {
    pub(super) own: Matrix6<f64>,
    pub(super) right: Vector6<f64>,
    /// Which of the kept unknowns it is coupled with.
    pub(super) columns: Vec<usize>,
    /// 6 x columns.
    pub(super) coupling: DMatrix<f64>,
}

/// Blocks of `N dx = g`.
#[derive(Default)]
pub(super) struct RigNormals {
    /// Those of the images.
    pub(super) images: Normals,
    pub(super) kept: DMatrix<f64>,
    pub(super) right: DVector<f64>,
    pub(super) stations: Vec<StationNormals>,
}

impl RigNormals {
    pub(super) fn cost(&self) -> f64 {
        self.images.cost
    }

    /// Makes of the equations of the images those of interiors, mounts and stations.
    fn gather(&mut self, frame: &Frame<'_>, state: &RigState) {
        let (layout, from) = (&frame.layout, &self.images);
        self.kept = DMatrix::zeros(frame.kept, frame.kept);
        self.right = DVector::zeros(frame.kept);
        for (place, block) in layout.cameras.iter().zip(&from.camera) {
            let width = place.free.len();
            (0..width * width).for_each(|k| self.kept[(place.offset + k / width, place.offset + k % width)] += block[k]);
        }
        self.right.as_mut_slice()[..layout.width].copy_from_slice(&from.camera_right);
        self.stations.clear();
        for images in &frame.images {
            let (mut own, mut right) = (Matrix6::zeros(), Vector6::zeros());
            let (mut columns, mut parts) = (Vec::new(), Vec::new());
            for &image in images {
                let camera = layout.camera_of[image];
                let (place, adjoint) = (&layout.cameras[camera], adjoint(&state.mounts[camera]));
                let block = Matrix6::from_row_slice(&from.pose[image]);
                let misclosure = Vector6::from_row_slice(&from.pose_right[image]);
                own += adjoint.tr_mul(&(block * adjoint));
                right += adjoint.tr_mul(&misclosure);
                let width = place.free.len();
                let interior = DMatrix::from_row_slice(6, width, &from.pose_camera[image]);
                columns.extend(frame.columns(image));
                parts.push(adjoint.transpose() * &interior);
                let Some(first) = frame.mount[camera] else { continue };
                parts.push(adjoint.transpose() * DMatrix::from_column_slice(6, 6, block.as_slice()));
                for i in 0..6 {
                    (0..6).for_each(|j| self.kept[(first + i, first + j)] += block[(i, j)]);
                    self.right[first + i] += misclosure[i];
                    for k in 0..width {
                        self.kept[(first + i, place.offset + k)] += interior[(i, k)];
                        self.kept[(place.offset + k, first + i)] += interior[(i, k)];
                    }
                }
            }
            let mut coupling = DMatrix::zeros(6, columns.len());
            let mut next = 0;
            for part in parts {
                coupling.columns_mut(next, part.ncols()).copy_from(&part);
                next += part.ncols();
            }
            self.stations.push(StationNormals { own, right, columns, coupling });
        }
    }

    /// Eliminates the stations, with the diagonal raised; `None` if one of them is singular by itself.
    pub(super) fn reduced(&self, damping: f64) -> Option<Reduced> {
        let (mut matrix, mut right) = (self.kept.clone(), self.right.clone());
        (0..matrix.nrows()).for_each(|i| matrix[(i, i)] *= 1.0 + damping);
        let mut factors = Vec::with_capacity(self.stations.len());
        for station in &self.stations {
            if station.columns.is_empty() && station.own == Matrix6::zeros() {
                factors.push(None);
                continue;
            }
            let mut own = station.own;
            (0..6).for_each(|i| own[(i, i)] *= 1.0 + damping);
            let factor = own.cholesky().filter(|factor| (0..6).all(|i| factor.l_dirty()[(i, i)].powi(2) > LOST * own[(i, i)]))?;
            let half = factor.l().solve_lower_triangular(&station.coupling)?;
            let half_right = factor.l().solve_lower_triangular(&station.right)?;
            let (products, shares) = (half.tr_mul(&half), half.tr_mul(&half_right));
            for (i, &row) in station.columns.iter().enumerate() {
                right[row] -= shares[i];
                station.columns.iter().enumerate().for_each(|(j, &column)| matrix[(row, column)] -= products[(i, j)]);
            }
            factors.push(Some(factor));
        }
        Some(Reduced { matrix, right, factors })
    }

    /// Roots of the diagonal of what is kept.
    pub(super) fn scale(&self) -> DVector<f64> {
        self.kept.diagonal().map(|value| if value > 0.0 { value.sqrt() } else { 1.0 })
    }

    /// `g^T x`.
    pub(super) fn along(&self, step: &RigStep) -> f64 {
        let stations: f64 = self.stations.iter().zip(&step.stations).map(|(station, step)| station.right.dot(step)).sum();
        self.right.dot(&step.kept) + stations
    }
}

/// The equations of what is kept.
pub(super) struct Reduced {
    pub(super) matrix: DMatrix<f64>,
    pub(super) right: DVector<f64>,
    /// Of each station in use.
    pub(super) factors: Vec<Option<Cholesky<f64, Const<6>>>>,
}

impl Reduced {
    /// The factor of the matrix scaled to ones on the diagonal of the normal equations; `None` if it is singular.
    pub(super) fn factor(&self, scale: &DVector<f64>) -> Option<Cholesky<f64, Dyn>> {
        let scaled = DMatrix::from_fn(scale.len(), scale.len(), |i, j| self.matrix[(i, j)] / (scale[i] * scale[j]));
        let factor = scaled.cholesky()?;
        (0..self.right.len()).all(|i| factor.l_dirty()[(i, i)].powi(2) > LOST).then_some(factor)
    }

    /// The step that the equations ask for.
    pub(super) fn step(&self, normals: &RigNormals) -> Option<RigStep> {
        let scale = normals.scale();
        let mut kept = self.factor(&scale)?.solve(&self.right.component_div(&scale));
        kept.component_div_assign(&scale);
        let stations = self.follow(normals, &kept, 1.0);
        let step = RigStep { kept, stations };
        let finite = step.kept.iter().chain(step.stations.iter().flatten()).all(|value| value.is_finite());
        finite.then_some(step)
    }

    /// The stations that follow what is kept; `share` of their own misclosures.
    pub(super) fn follow(&self, normals: &RigNormals, kept: &DVector<f64>, share: f64) -> Vec<Vector6<f64>> {
        let of = |(station, factor): (&StationNormals, &Option<Cholesky<f64, Const<6>>>)| {
            let Some(factor) = factor else { return Vector6::zeros() };
            let own = DVector::from_iterator(station.columns.len(), station.columns.iter().map(|&column| kept[column]));
            factor.solve(&(station.right * share - &station.coupling * own))
        };
        normals.stations.iter().zip(&self.factors).map(of).collect()
    }
}
