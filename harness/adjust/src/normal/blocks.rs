//! The normal equations of the whole network, block by block. Sums run in the order of images and points: the same bits every time.

use std::ops::Range;

use nalgebra::{Matrix2, Matrix3, Vector2};

use super::distances::Stretch;
use super::image_equations::{Lost, Residual, Setting, View};
use super::observed_unknowns;
use super::own::Own;
use super::projection::{Optics, POSE};
use super::robust::Loss;
use crate::network::{Layout, Network};
use crate::state::State;

/// Blocks of `N dx = g`, matrices row by row. An unknown that may not change has a one on its diagonal and nothing else.
#[derive(Clone, Debug, Default)]
pub(crate) struct Normals {
    /// Weighted sum of squares, or what a robust loss makes of it.
    pub(crate) cost: f64,
    /// Of each camera: n x n.
    pub(crate) camera: Vec<Vec<f64>>,
    pub(crate) camera_right: Vec<f64>,
    pub(crate) pose: Vec<[f64; 36]>,
    pub(crate) pose_right: Vec<[f64; 6]>,
    /// Of each image: 6 x n of its camera.
    pub(crate) pose_camera: Vec<Vec<f64>>,
    /// Of each triple.
    pub(crate) point: Vec<[f64; 9]>,
    pub(crate) point_right: Vec<[f64; 3]>,
    /// Of each distance: 3 x 3 of its ends.
    pub(crate) point_point: Vec<[f64; 9]>,
    /// Of each pair of a triple and a camera: 3 x n, one after the other.
    pub(crate) point_camera: Vec<f64>,
    /// Of each sight: 3 x 6.
    pub(crate) point_pose: Vec<[f64; 18]>,
    /// Of each image and, within it, each surface: 3 x 6.
    pub(crate) surface_pose: Vec<[f64; 18]>,
    /// Of each image: what its own numbers leave; empty where no image has any.
    pub(crate) own: Vec<Own>,
    /// What these numbers alone take off the sum of squares.
    pub(crate) own_gain: f64,
    /// Of each sight.
    pub(crate) residuals: Vec<Residual>,
}

/// Image points of an image that are linearised at a time: bounds the memory, whatever their number.
const CHUNK: usize = 1 << 14;

/// The parts of a range, none longer than [`CHUNK`].
fn chunks(range: &Range<usize>) -> impl Iterator<Item = Range<usize>> + use<> {
    let end = range.end;
    range.clone().step_by(CHUNK).map(move |start| start..(start + CHUNK).min(end))
}

/// Memory that is used again from iteration to iteration.
#[derive(Default)]
pub(crate) struct Scratch(View);

/// Linearises all observation equations at `state`.
///
/// # Errors
/// [`Lost`], if a measured point is not pictured.
pub(crate) fn linearise(
    network: &Network,
    layout: &Layout,
    state: &State,
    loss: Loss,
    scratch: &mut Scratch,
    into: &mut Normals,
) -> Result<(), Lost> {
    into.reset(layout, state);
    let optics = optics(layout, state);
    let view = &mut scratch.0;
    for (image, range) in layout.of_image.iter().enumerate() {
        let camera = network.images[image].camera;
        let free = &layout.cameras[camera].free;
        let own = own_optics((network, layout), state, image);
        let aside = own.is_some().then(|| into.put_aside(layout, image));
        let optics = own.as_ref().unwrap_or(&optics[camera]);
        let setting = Setting { optics, pose: &state.poses[image], free, loss, observations: &network.observations };
        for chunk in chunks(range) {
            let sights = &layout.sights[chunk.clone()];
            let residuals = &mut into.residuals[chunk.clone()];
            view.linearise(setting, sights, &state.points, residuals).map_err(|Lost(i)| Lost(chunk.start + i))?;
            view.sum();
            into.cost += view.cost;
            into.add_view(layout, image, camera, view);
            into.add_points(layout, state, image, chunk, view);
        }
        if let Some(aside) = aside {
            into.eliminate_own((network, layout), state, image, &aside).ok_or(Lost(range.start))?;
        }
    }
    observed_unknowns::add(network, layout, state, into);
    into.add_distances(network, layout, state);
    into.hold(layout);
    Ok(())
}

fn optics(layout: &Layout, state: &State) -> Vec<Optics> {
    state.cameras.iter().map(|camera| Optics::of(camera, layout.all_before)).collect()
}

/// Those of an image whose camera differs from that of the others.
fn own_optics((network, layout): (&Network, &Layout), state: &State, image: usize) -> Option<Optics> {
    layout.has_own[layout.camera_of[image]].then(|| Optics::of(&state.camera(network, image), layout.all_before))
}

/// Residuals alone, at a `state` so near that all else is the same to its last digits.
///
/// # Errors
/// [`Lost`], if a measured point is not pictured.
pub(crate) fn residuals(network: &Network, layout: &Layout, state: &State, scratch: &mut Scratch, into: &mut Normals) -> Result<(), Lost> {
    let optics = optics(layout, state);
    for (image, range) in layout.of_image.iter().enumerate() {
        let own = own_optics((network, layout), state, image);
        let optics = own.as_ref().unwrap_or(&optics[network.images[image].camera]);
        let setting = Setting { optics, pose: &state.poses[image], free: &[], loss: Loss::Squares, observations: &network.observations };
        for chunk in chunks(range) {
            let sights = &layout.sights[chunk.clone()];
            let found = scratch.0.picture(setting, sights, &state.points);
            found.map_err(|Lost(i)| Lost(chunk.start + i))?;
            scratch.0.subtract(sights, &network.observations, &mut into.residuals[chunk]);
        }
    }
    Ok(())
}

/// White derivatives of some sights of an image, of each so many: by the unknown parameters of its camera, then six by its pose, then three by its point;
/// zero where nothing may change. Of an image with numbers of its own: what these leave of them.
#[derive(Default)]
pub(crate) struct Rows {
    values: Vec<[f64; 2]>,
    /// Of each sight: by the numbers of the image's own.
    by_own: Vec<[f64; 2]>,
    own: Own,
    residuals: Vec<Residual>,
    width: usize,
    first: usize,
}

impl Rows {
    /// Computes those of the sights `range` of an image.
    ///
    /// # Errors
    /// [`Lost`], if a measured point is not pictured.
    pub(crate) fn fill(
        &mut self,
        (network, layout): (&Network, &Layout),
        state: &State,
        loss: Loss,
        (image, own): (usize, &[Own]),
        range: Range<usize>,
        Scratch(view): &mut Scratch,
    ) -> Result<(), Lost> {
        let camera = network.images[image].camera;
        let (free, pose) = (&layout.cameras[camera].free, &state.poses[image]);
        let optics = Optics::of(&state.camera(network, image), layout.all_before);
        let setting = Setting { optics: &optics, pose, free, loss, observations: &network.observations };
        let mask = layout.pose_mask(image);
        (self.width, self.first) = (free.len() + POSE + 3, range.start);
        self.values.clear();
        self.by_own.clear();
        self.own = own.get(image).cloned().unwrap_or_default();
        for chunk in chunks(&range) {
            let sights = &layout.sights[chunk.clone()];
            self.residuals.resize(sights.len(), Residual::default());
            view.linearise(setting, sights, &state.points, &mut self.residuals).map_err(|Lost(i)| Lost(chunk.start + i))?;
            for (k, sight) in sights.iter().enumerate() {
                let parameters = (0..free.len()).map(|i| view.at(k, POSE + i));
                let of_pose = (0..POSE).map(|i| if mask[i] { view.at(k, i) } else { [0.0; 2] });
                let of_point = by_triple(layout, view, (k, sight.point()), &pose.rotation);
                let start = self.values.len();
                self.values.extend(parameters.chain(of_pose).chain(of_point));
                if !self.own.is_none() {
                    let by_own = self.own.columns(&self.values[start..][..free.len()]);
                    self.own.take_off(&by_own, (free.len(), layout.triples.surface_of(sight.point()).is_some()), &mut self.values[start..]);
                    self.by_own.extend(by_own);
                }
            }
        }
        Ok(())
    }

    /// What the numbers of an image's own add to `A Q A^T` of a sight, beyond what is in its row.
    pub(crate) fn beside(&self, sight: usize) -> Matrix2<f64> {
        let count = self.own.cofactors.nrows();
        let by: Vec<Vector2<f64>> = self.by_own[(sight - self.first) * count..][..count].iter().map(|by| Vector2::from(*by)).collect();
        let of = |i: usize, j: usize| by[i] * by[j].transpose() * self.own.cofactors[(i, j)];
        (0..count * count).map(|k| of(k / count, k % count)).sum()
    }

    /// Those of a sight, by its place among all.
    pub(crate) fn of(&self, sight: usize) -> &[[f64; 2]] {
        &self.values[(sight - self.first) * self.width..][..self.width]
    }
}

impl Normals {
    /// Gives back what nothing asks for once the equations are solved: the points' own blocks.
    pub(crate) fn release(&mut self) {
        (self.point, self.point_right) = (Vec::new(), Vec::new());
    }

    fn reset(&mut self, layout: &Layout, state: &State) {
        let (images, points) = (state.poses.len(), state.points.len());
        (self.cost, self.own_gain) = (0.0, 0.0);
        self.own.clear();
        self.own.resize_with(if layout.has_own.contains(&true) { images } else { 0 }, Own::default);
        self.camera.resize_with(state.cameras.len(), Vec::new);
        for (block, place) in self.camera.iter_mut().zip(&layout.cameras) {
            zero(block, place.free.len() * place.free.len());
        }
        zero(&mut self.camera_right, layout.width);
        self.pose.clear();
        self.pose.resize(images, [0.0; 36]);
        self.pose_right.clear();
        self.pose_right.resize(images, [0.0; 6]);
        self.pose_camera.resize_with(images, Vec::new);
        for (block, camera) in self.pose_camera.iter_mut().zip(&layout.camera_of) {
            zero(block, POSE * layout.cameras[*camera].free.len());
        }
        self.point.clear();
        self.point.resize(points, [0.0; 9]);
        self.point_right.clear();
        self.point_right.resize(points, [0.0; 3]);
        zero(&mut self.point_camera, if layout.keeps_couplings { layout.pair_values } else { 0 });
        let coupled = if layout.has_unknown_points() && layout.keeps_couplings { layout.sights.len() } else { 0 };
        self.point_pose.resize(coupled, [0.0; 18]);
        self.surface_pose.clear();
        self.surface_pose.resize(images * layout.triples.surfaces, [0.0; 18]);
        self.residuals.resize(layout.sights.len(), Residual::default());
    }

    /// What an image says of its pose and its camera.
    fn add_view(&mut self, layout: &Layout, image: usize, camera: usize, view: &View) {
        let width = layout.cameras[camera].free.len();
        let last = POSE + width;
        let free = layout.pose_mask(image);
        let keep = |i: usize| if free[i] { 1.0 } else { 0.0 };
        for i in 0..POSE {
            for j in 0..=i {
                let value = self.pose[image][i * POSE + j] + view.product(i, j) * keep(i) * keep(j);
                (self.pose[image][i * POSE + j], self.pose[image][j * POSE + i]) = (value, value);
            }
            self.pose_right[image][i] += view.product(last, i) * keep(i);
        }
        let coupling = &mut self.pose_camera[image];
        for i in 0..POSE {
            (0..width).for_each(|k| coupling[i * width + k] += view.product(POSE + k, i) * keep(i));
        }
        let (block, right) = (&mut self.camera[camera], &mut self.camera_right[layout.cameras[camera].offset..]);
        for i in 0..width {
            for j in 0..=i {
                block[i * width + j] += view.product(POSE + i, POSE + j);
                block[j * width + i] = block[i * width + j];
            }
            right[i] += view.product(last, POSE + i);
        }
    }

    /// What the sights `range` of an image say of their points.
    fn add_points(&mut self, layout: &Layout, state: &State, image: usize, range: Range<usize>, view: &View) {
        if !layout.has_unknown_points() && layout.triples.surfaces == 0 {
            return;
        }
        let width = layout.cameras[layout.camera_of[image]].free.len();
        let m = &state.poses[image].rotation;
        let (pose_mask, is_pose_unknown) = (layout.pose_mask(image), layout.is_pose_unknown(image));
        for (k, sight) in layout.sights[range.clone()].iter().enumerate() {
            let triple = layout.triples.of_point(sight.point());
            if !layout.is_triple_unknown(triple) {
                continue;
            }
            let pose: [[f64; 2]; POSE] = std::array::from_fn(|column| view.at(k, column));
            let by = by_triple(layout, view, (k, sight.point()), m);
            let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
            let misclosure = view.at(k, POSE + width);
            for i in 0..3 {
                (0..3).for_each(|j| self.point[triple][3 * i + j] += dot(by[i], by[j]));
                self.point_right[triple][i] += dot(by[i], misclosure);
            }
            if !layout.keeps_couplings {
                continue;
            }
            if is_pose_unknown {
                let block = match layout.triples.surface_of(sight.point()) {
                    Some((surface, _)) => &mut self.surface_pose[image * layout.triples.surfaces + surface],
                    None => {
                        self.point_pose[range.start + k] = [0.0; 18];
                        &mut self.point_pose[range.start + k]
                    }
                };
                for (j, (column, _)) in pose.iter().zip(pose_mask).enumerate().filter(|(_, (_, free))| *free) {
                    (0..3).for_each(|i| block[POSE * i + j] += dot(by[i], *column));
                }
            }
            if width > 0 {
                let block = &mut self.point_camera[layout.pairs[sight.pair as usize].offset..][..3 * width];
                for j in 0..width {
                    let column = view.at(k, POSE + j);
                    (0..3).for_each(|i| block[i * width + j] += dot(by[i], column));
                }
            }
        }
    }

    /// What the distances say of the points at their ends.
    fn add_distances(&mut self, network: &Network, layout: &Layout, state: &State) {
        self.point_point.clear();
        for distance in &network.distances {
            let Stretch { length, slopes } = Stretch::of(layout, state, distance);
            let (p, w) = (1.0 / (distance.sigma * distance.sigma), distance.value - length);
            for (point, slope) in distance.points.into_iter().zip(&slopes) {
                for i in 0..3 {
                    (0..3).for_each(|j| self.point[point][3 * i + j] += p * slope[i] * slope[j]);
                    self.point_right[point][i] += p * w * slope[i];
                }
            }
            let [from, to] = &slopes;
            self.point_point.push(std::array::from_fn(|k| p * from[k / 3] * to[k % 3]));
            self.cost += p * w * w;
        }
    }

    /// Ones on the diagonal of what may not change.
    fn hold(&mut self, layout: &Layout) {
        for (image, block) in self.pose.iter_mut().enumerate() {
            for (i, free) in layout.pose_mask(image).into_iter().enumerate() {
                if !free {
                    block[7 * i] = 1.0;
                }
            }
        }
        for (block, free) in self.point.iter_mut().zip(&layout.triple_free) {
            for (i, free) in free.iter().enumerate() {
                if !free {
                    block[4 * i] = 1.0;
                }
            }
        }
    }
}

/// White derivatives of a sight, by its place in the view and its point, by the triple that moves it; zero along what may not change.
#[inline]
fn by_triple(layout: &Layout, view: &View, (sight, point): (usize, usize), rotation: &Matrix3<f64>) -> [[f64; 2]; 3] {
    let free = layout.triple_free[layout.triples.of_point(point)];
    let Some((_, basis)) = layout.triples.surface_of(point) else { return view.by_point(sight, rotation, free) };
    let by = view.by_point(sight, rotation, [true; 3]);
    let along = |axis: usize, k: usize| (0..3).map(|i| by[i][axis] * basis[(i, k)]).sum();
    std::array::from_fn(|k| if free[k] { [along(0, k), along(1, k)] } else { [0.0; 2] })
}

fn zero(values: &mut Vec<f64>, length: usize) {
    values.clear();
    values.resize(length, 0.0);
}
