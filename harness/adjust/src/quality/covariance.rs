//! Covariances of interior orientation, of each exterior orientation and of each object point.

use calibench_model::camera::CameraModel;
use nalgebra::{DMatrix, Matrix3, Matrix6};

use crate::AdjustError;
use crate::datum::STransformation;
use crate::network::Datum;
use crate::solution::Solution;
use crate::solve::{Coupling, Eliminated, Inverse, Kept};
use crate::state::Step;

/// The datum asked for is none.
pub(super) const NO_FRAME: AdjustError = AdjustError::NotAvailable("the datum does not fix the frame");
const NO_REDUNDANCY: AdjustError = AdjustError::NotAvailable("without redundancy no variance can be estimated");

/// The variance factor that covariances are scaled with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Variance {
    /// The standard deviations given are right: a factor of 1.
    #[default]
    Apriori,
    /// They are right but for a common factor, which the residuals tell: `sigma0^2`.
    Estimated,
}

/// Covariances of the unknowns, in blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariances {
    /// The variance factor that they are scaled with, a number.
    pub variance_factor: f64,
    /// Of all unknown parameters of all cameras together, in the order of `parameters` and in their units.
    pub interior: DMatrix<f64>,
    /// What the rows of `interior` are: index of the camera, name of the parameter.
    pub parameters: Vec<(usize, &'static str)>,
    /// Of each image: X0, Y0, Z0 in object units, then a small rotation about the camera's axes x, y, z in radians (`M` becomes `(1 + [d]x) M`); zeros for
    /// what is fixed.
    pub poses: Vec<Matrix6<f64>>,
    /// Of each point: X, Y, Z in object units; zeros for what is fixed.
    pub points: Vec<Matrix3<f64>>,
    /// Of each surface: its coefficients, object units; zeros for what is fixed.
    pub surfaces: Vec<Matrix3<f64>>,
}

/// Two parameters that the network hardly tells apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// Rows of [`Covariances::interior`].
    pub pair: [usize; 2],
    /// Their correlation, -1 to 1.
    pub rho: f64,
}

impl Covariances {
    /// Those of another variance factor than 1.
    pub(super) fn scaled(mut self, variance_factor: f64) -> Self {
        self.variance_factor = variance_factor;
        self.interior *= variance_factor;
        self.poses.iter_mut().for_each(|block| *block *= variance_factor);
        self.points.iter_mut().chain(&mut self.surfaces).for_each(|block| *block *= variance_factor);
        self
    }

    /// The covariance of one camera's unknown parameters, in their units, with their names in the order of its rows.
    pub fn of_camera(&self, camera: usize) -> (Vec<&'static str>, DMatrix<f64>) {
        let rows: Vec<usize> = (0..self.parameters.len()).filter(|&i| self.parameters[i].0 == camera).collect();
        let matrix = DMatrix::from_fn(rows.len(), rows.len(), |i, j| self.interior[(rows[i], rows[j])]);
        (rows.iter().map(|&i| self.parameters[i].1).collect(), matrix)
    }

    /// Correlations of all interior parameters, in the order of `parameters`, -1 to 1: ones on the diagonal.
    pub fn correlations(&self) -> DMatrix<f64> {
        let n = self.interior.nrows();
        DMatrix::from_fn(
            n,
            n,
            |i, j| if i == j { 1.0 } else { self.interior[(i, j)] / (self.interior[(i, i)] * self.interior[(j, j)]).sqrt() },
        )
    }

    /// Pairs of interior parameters whose correlation exceeds `bound` (0.9 is usual) in absolute value, the strongest first.
    pub fn correlated(&self, bound: f64) -> Vec<Correlation> {
        let rho = self.correlations();
        let pairs = (0..rho.nrows()).flat_map(|i| (0..i).map(move |j| [j, i]));
        let mut found: Vec<_> =
            pairs.map(|pair| Correlation { pair, rho: rho[(pair[0], pair[1])] }).filter(|found| found.rho.abs() > bound).collect();
        found.sort_by(|a, b| b.rho.abs().total_cmp(&a.rho.abs()));
        found
    }
}

impl Solution<'_> {
    /// The factor of [`Variance`], a number: what makes covariances of cofactors. Under Huber's weights the estimated one counts what they hold back as what it still does.
    ///
    /// # Errors
    /// [`AdjustError::NotAvailable`] without redundancy.
    pub fn variance_factor(&self, variance: Variance) -> Result<f64, AdjustError> {
        match variance {
            Variance::Estimated if self.is_weighted() => self.variance_under_weights().ok_or(NO_REDUNDANCY),
            _ => self.residual_variance(variance),
        }
    }

    /// The same of residuals: under Huber's weights by their median.
    pub(super) fn residual_variance(&self, variance: Variance) -> Result<f64, AdjustError> {
        let sigma0 = match variance {
            Variance::Apriori => Some(1.0),
            Variance::Estimated if self.is_weighted() => self.scale().filter(|_| self.counts().redundancy() > 0),
            Variance::Estimated => self.sigma0(),
        };
        sigma0.map(|sigma0| sigma0 * sigma0).ok_or(NO_REDUNDANCY)
    }

    /// Covariances of interior orientation and of each pose and point, by inversion of those blocks only.
    ///
    /// # Errors
    /// [`AdjustError::NotAvailable`] if the variance is to be estimated without redundancy.
    pub fn covariances(&self, variance: Variance) -> Result<Covariances, AdjustError> {
        let variance_factor = self.variance_factor(variance)?;
        let inverse = self.engine.inverse(&self.solved);
        Ok(self.cofactors(&inverse, &self.of_members(&inverse))?.scaled(variance_factor))
    }

    /// Covariances for a variance factor of 1, from the inverse and the cofactors of what was eliminated.
    pub(super) fn cofactors(&self, inverse: &Inverse, of_members: &[f64]) -> Result<Covariances, AdjustError> {
        let (mut poses, mut points) = self.blocks(inverse, of_members);
        if self.is_transformed() {
            self.transform(&mut poses, &mut points)?;
        }
        poses.iter_mut().enumerate().for_each(|(image, block)| *block = self.in_object_axes(image, block));
        let surfaces = points.split_off(self.network().points.len());
        Ok(Covariances { variance_factor: 1.0, interior: self.interior(inverse), parameters: self.parameters(), poses, points, surfaces })
    }

    /// The covariance of all unknowns, on request: of `n` of them, `n^2` numbers. Rows: the parameters of [`Covariances::interior`], then six for each
    /// image and three for each point and each surface, as in [`Covariances::poses`], [`Covariances::points`] and [`Covariances::surfaces`].
    ///
    /// # Errors
    /// As [`Self::covariances`]; and in a datum other than that of the adjustment.
    pub fn full_covariance(&self, variance: Variance) -> Result<DMatrix<f64>, AdjustError> {
        let variance_factor = self.variance_factor(variance)?;
        if self.is_transformed() {
            return Err(AdjustError::NotAvailable(
                "the full covariance belongs to the datum of the adjustment: control or minimal constraints",
            ));
        }
        let (engine, zero) = (&self.engine, self.engine.zero_step());
        let (width, images, points) = (zero.cameras.len(), zero.poses.len(), zero.points.len());
        let size = width + 6 * images + 3 * points;
        let mut full = DMatrix::zeros(size, size);
        for k in 0..size {
            let mut right = zero.clone();
            match k {
                k if k < width => right.cameras[k] = 1.0,
                k if k < width + 6 * images => {
                    let (image, i) = ((k - width) / 6, (k - width) % 6);
                    right.poses[image] = self.to_object_axes(image).row(i).transpose().into();
                }
                k => right.points[(k - width) / 3 - 2 * images][(k - width) % 3] = 1.0,
            }
            engine.mask(&mut right);
            let mut step = engine.answer(&self.solved, &self.end, &right);
            engine.mask(&mut step);
            for (i, value) in step.cameras.iter().enumerate() {
                full[(i, k)] = value * variance_factor;
            }
            for (image, value) in step.poses.iter().enumerate() {
                let turned = self.to_object_axes(image) * nalgebra::Vector6::from(*value);
                (0..6).for_each(|i| full[(width + 6 * image + i, k)] = turned[i] * variance_factor);
            }
            for (i, value) in step.points.iter().flatten().enumerate() {
                full[(width + 6 * images + i, k)] = value * variance_factor;
            }
        }
        Ok(full)
    }

    /// Camera and name of each unknown parameter.
    pub(crate) fn parameters(&self) -> Vec<(usize, &'static str)> {
        let of = |(camera, place): (usize, &crate::network::CameraPlace)| {
            let names = self.end.state.cameras[camera].parameters();
            place.free.iter().map(|&i| (camera, names[i].name)).collect::<Vec<_>>()
        };
        self.engine.layout.cameras.iter().enumerate().flat_map(of).collect()
    }

    pub(super) fn is_transformed(&self) -> bool {
        self.datum != Datum::Control && !(matches!(self.datum, Datum::Minimal { .. }) && self.datum == self.engine.network.datum)
    }

    fn interior(&self, inverse: &Inverse) -> DMatrix<f64> {
        let (width, plan, places) = (self.engine.layout.width, &self.engine.plan, &self.engine.layout.cameras);
        let mut interior = DMatrix::zeros(width, width);
        let used: Vec<usize> = (0..places.len()).filter(|&camera| !places[camera].free.is_empty()).collect();
        for (n, &column) in used.iter().enumerate() {
            let across = places[column].free.len();
            for (&row, block) in used[n..].iter().zip(inverse.of_cameras(&self.solved, plan, column, &used[n..])) {
                for (k, value) in block.into_iter().enumerate() {
                    let (i, j) = (places[row].offset + k / across, places[column].offset + k % across);
                    (interior[(i, j)], interior[(j, i)]) = (value, value);
                }
            }
        }
        interior
    }

    /// Cofactors of each member, row by row, one after the other.
    fn of_members(&self, inverse: &Inverse) -> Vec<f64> {
        let (plan, ordered) = (&self.engine.plan, self.engine.ordered(&self.end.state, &self.end.normals));
        let (mut found, mut coupling) = (Vec::with_capacity(plan.members.len() * plan.depth() * plan.depth()), Coupling::default());
        for place in 0..plan.members.len() {
            match plan.eliminated {
                Eliminated::Poses => {
                    found.extend(inverse.member::<6>(&self.solved, ordered, place, &mut coupling).own.as_flattened());
                }
                Eliminated::Points => {
                    found.extend(inverse.member::<3>(&self.solved, ordered, place, &mut coupling).own.as_flattened());
                }
            }
        }
        found
    }

    /// Cofactors of each pose, in the camera's axes, and of each point.
    fn blocks(&self, inverse: &Inverse, of_members: &[f64]) -> (Vec<Matrix6<f64>>, Vec<Matrix3<f64>>) {
        let (layout, plan) = (&self.engine.layout, &self.engine.plan);
        let mut poses = vec![Matrix6::zeros(); layout.pose_free.len()];
        let mut points = vec![Matrix3::zeros(); layout.triple_free.len()];
        for (kept, block) in plan.others() {
            let values = inverse.block(plan, block, block);
            match kept {
                Kept::Point(point) => points[point] = Matrix3::from_row_slice(&values),
                Kept::Pose(image) => poses[image] = Matrix6::from_row_slice(&values),
            }
        }
        for (&member, own) in plan.members.iter().zip(of_members.chunks_exact(plan.depth() * plan.depth())) {
            match plan.eliminated {
                Eliminated::Poses => poses[member] = Matrix6::from_row_slice(own),
                Eliminated::Points => points[member] = Matrix3::from_row_slice(own),
            }
        }
        for (image, block) in poses.iter_mut().enumerate() {
            let free = layout.pose_mask(image);
            block.iter_mut().enumerate().filter(|(k, _)| !(free[k % 6] && free[k / 6])).for_each(|(_, value)| *value = 0.0);
        }
        for (block, free) in points.iter_mut().zip(&layout.triple_free) {
            block.iter_mut().enumerate().filter(|(k, _)| !(free[k % 3] && free[k / 3])).for_each(|(_, value)| *value = 0.0);
        }
        (poses, points)
    }

    /// Takes cofactors over into the datum of the solution: `S Q S^T`, block by block.
    fn transform(&self, poses: &mut [Matrix6<f64>], points: &mut [Matrix3<f64>]) -> Result<(), AdjustError> {
        let (engine, state) = (&self.engine, &self.end.state);
        let s = STransformation::to(engine.network, &self.datum, state, &engine.zero_step()).ok_or(NO_FRAME)?;
        // Q B, and B^T Q B.
        let answers: Vec<Step> = s
            .constraints
            .iter()
            .map(|constraint| {
                let mut right = constraint.clone();
                engine.mask(&mut right);
                let mut step = engine.answer(&self.solved, &self.end, &right);
                engine.mask(&mut step);
                step
            })
            .collect();
        let dot = |a: &Step, b: &Step| a.points.iter().flatten().zip(b.points.iter().flatten()).map(|(a, b)| a * b).sum::<f64>();
        let n = answers.len();
        let both = DMatrix::from_fn(n, n, |i, j| dot(&s.constraints[i], &answers[j]));
        for (image, block) in poses.iter_mut().enumerate() {
            let (g, q) = (s.of_pose(state, image), DMatrix::from_fn(6, n, |i, j| answers[j].poses[image][i]));
            let cross = &g * q.transpose();
            let change = &g * &both * g.transpose() - &cross - cross.transpose();
            *block += Matrix6::from_fn(|i, j| change[(i, j)]);
        }
        for (point, block) in points.iter_mut().enumerate() {
            let (g, q) = (s.of_point(state, point), DMatrix::from_fn(3, n, |i, j| answers[j].points[point][i]));
            let cross = &g * q.transpose();
            let change = &g * &both * g.transpose() - &cross - cross.transpose();
            *block += Matrix3::from_fn(|i, j| change[(i, j)]);
        }
        Ok(())
    }

    /// From a small rotation and a shift along the camera's axes to X0, Y0, Z0 and the rotation.
    fn to_object_axes(&self, image: usize) -> Matrix6<f64> {
        let mut turn = Matrix6::zeros();
        turn.fixed_view_mut::<3, 3>(0, 3).copy_from(&-self.end.state.poses[image].rotation.transpose());
        turn.fixed_view_mut::<3, 3>(3, 0).copy_from(&Matrix3::identity());
        turn
    }

    fn in_object_axes(&self, image: usize, block: &Matrix6<f64>) -> Matrix6<f64> {
        let turn = self.to_object_axes(image);
        turn * block * turn.transpose()
    }
}
