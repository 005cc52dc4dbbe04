//! Poses that change while an image is taken, to first order: what the camera would be with six velocities for each image.

use calibench_adjust::{Network, Residual, Solution, Status, Use};
use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, DerivativeBuffer};
use nalgebra::{DMatrix, DVector, SMatrix, SymmetricEigen};
use rayon::prelude::*;

use crate::Resampled;

/// Of a pose: a small rotation about the camera's axes, a shift along them.
const POSE: usize = 6;
/// Pose and velocities.
const MOVING: usize = 2 * POSE;
/// Of a matrix with ones on its diagonal an eigenvalue that is zero.
const ZERO: f64 = 1e-9;

/// One image: its equations without what pose and velocities make up for.
struct Image {
    /// Derivatives by the unknown parameters of all cameras: white, two rows for a point.
    camera: DMatrix<f64>,
    /// Orthonormal columns over the same rows: all that pose and velocities can do.
    moving: DMatrix<f64>,
    /// White residuals, observed less computed.
    residuals: DVector<f64>,
    normal: DMatrix<f64>,
    right: DVector<f64>,
    squares: f64,
}

/// The solution with velocities.
pub(super) struct Moving<'s, 'n> {
    solution: &'s Solution<'n>,
    /// Camera and place of each unknown parameter.
    unknowns: Vec<(usize, usize)>,
    images: Vec<Image>,
    /// Of the observed parameters.
    prior: (DMatrix<f64>, DVector<f64>, f64),
    /// Unknowns beside those of the solution.
    pub(super) more: usize,
    /// Weighted sum of squares.
    pub(super) cost: f64,
    change: DVector<f64>,
}

impl<'s, 'n> Moving<'s, 'n> {
    /// With velocities along `time` (of a computed image point, any unit); `None` if the camera is not determined, or nothing can move.
    pub(super) fn of(solution: &'s Solution<'n>, time: impl Fn(&PixelPoint) -> f64 + Sync) -> Option<Self> {
        let network = solution.network();
        let statuses = network.cameras.iter().enumerate();
        let unknowns: Vec<(usize, usize)> = statuses
            .flat_map(|(camera, interior)| {
                let unknown = interior.parameters.iter().enumerate().filter(|(_, status)| status.is_unknown());
                unknown.map(move |(place, _)| (camera, place))
            })
            .collect();
        let mut of_image: Vec<Vec<Residual>> = vec![Vec::new(); network.images.len()];
        solution.each_residual().filter(|r| r.used != Use::LeftOut).for_each(|r| of_image[r.image].push(r));
        let images = of_image.par_iter().filter(|rows| !rows.is_empty());
        let images: Vec<Image> = images.map(|rows| image(solution, &unknowns, rows, &time)).collect::<Option<_>>()?;
        let more = images.iter().map(|image| image.moving.ncols().saturating_sub(POSE)).sum();
        let prior = prior(solution, network, &unknowns);
        let (mut normal, mut right, mut squares) = prior.clone();
        for image in &images {
            normal += &image.normal;
            right += &image.right;
            squares += image.squares;
        }
        let change = solve(normal, &right)?;
        let cost = squares - right.dot(&change);
        (more > 0).then_some(Self { solution, unknowns, images, prior, more, cost, change })
    }

    /// By how much the unknown parameters of each camera change.
    pub(super) fn changes(&self) -> Vec<DVector<f64>> {
        let of = |camera: usize| {
            let own = self.unknowns.iter().zip(self.change.iter()).filter(|((owner, _), _)| *owner == camera);
            DVector::from_vec(own.map(|(_, change)| *change).collect())
        };
        (0..self.solution.cameras().len()).map(of).collect()
    }

    /// White residuals, image by image.
    pub(super) fn white(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.images.iter().flat_map(|image| {
            let left = &image.residuals - &image.camera * &self.change;
            let left = &left - &image.moving * image.moving.tr_mul(&left);
            left.as_slice().chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>()
        })
    }

    /// The median ratio of standard deviations from leaving out images, one of `groups` after the other, to the formal ones; `None` if there are none.
    pub(super) fn optimism(&self, groups: usize, redundancy: f64) -> Option<f64> {
        let groups = self.images.len().min(groups);
        let part = |group: usize| {
            let (mut normal, mut right, _) = self.prior.clone();
            for (_, image) in self.images.iter().enumerate().filter(|(place, _)| place % groups != group) {
                normal += &image.normal;
                right += &image.right;
            }
            solve(normal, &right)
        };
        let found: Vec<Vec<f64>> = (0..groups).map(|group| Some(part(group)?.as_slice().to_vec())).collect::<Option<_>>()?;
        let normal = self.images.iter().fold(self.prior.0.clone(), |sum, image| sum + &image.normal);
        let cofactors = normal.cholesky()?.inverse();
        let formal = (0..self.unknowns.len()).map(|k| (cofactors[(k, k)] * self.cost / redundancy).sqrt());
        Resampled::from_groups(found).ratio(formal)
    }
}

fn solve(normal: DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let change = normal.cholesky()?.solve(right);
    change.iter().all(|value| value.is_finite()).then_some(change)
}

/// Normal equations of the parameters that were observed, and the sum of their squares.
fn prior(solution: &Solution<'_>, network: &Network, unknowns: &[(usize, usize)]) -> (DMatrix<f64>, DVector<f64>, f64) {
    let count = unknowns.len();
    let (mut normal, mut right, mut squares) = (DMatrix::zeros(count, count), DVector::zeros(count), 0.0);
    for (k, &(camera, place)) in unknowns.iter().enumerate() {
        if let Status::Observed { value, sigma } = network.cameras[camera].parameters[place] {
            let off = (value - solution.cameras()[camera].parameters()[place].value) / sigma;
            normal[(k, k)] = 1.0 / (sigma * sigma);
            right[k] = off / sigma;
            squares += off * off;
        }
    }
    (normal, right, squares)
}

fn image(solution: &Solution<'_>, unknowns: &[(usize, usize)], rows: &[Residual], time: &impl Fn(&PixelPoint) -> f64) -> Option<Image> {
    let network = solution.network();
    let owner = network.images[rows[0].image].camera;
    let (camera, pose) = (&solution.cameras()[owner], &solution.poses()[rows[0].image]);
    let mut buffer = DerivativeBuffer::default();
    let mut by_camera = DMatrix::zeros(2 * rows.len(), unknowns.len());
    let mut by_pose = DMatrix::zeros(2 * rows.len(), MOVING);
    let mut residuals = DVector::zeros(2 * rows.len());
    for (index, row) in rows.iter().enumerate() {
        let observation = &network.observations[row.observation];
        let ray = pose.ray(&solution.points()[row.point]);
        camera.derivatives_into(ray, &mut buffer).ok()?;
        let weight = if let Use::Downweighted(weight) = row.used { weight.sqrt() } else { 1.0 };
        let white = |[x, y]: [f64; 2]| observation.precision.whitened([weight * x, weight * y]);
        let put = |into: &mut DMatrix<f64>, column: usize, value: [f64; 2]| {
            let [x, y] = white(value);
            (into[(2 * index, column)], into[(2 * index + 1, column)]) = (x, y);
        };
        for (column, &(_, place)) in unknowns.iter().enumerate().filter(|(_, (camera, _))| *camera == owner) {
            put(&mut by_camera, column, buffer.by_parameters()[place]);
        }
        // Where it is computed: the noise of an observed place would pass for a motion.
        let t = time(&buffer.point);
        for (column, [x, y]) in by_motion(&buffer, [ray.x, ray.y, ray.z]).into_iter().enumerate() {
            put(&mut by_pose, column, [x, y]);
            put(&mut by_pose, POSE + column, [t * x, t * y]);
        }
        let [x, y] = white(row.v?);
        (residuals[2 * index], residuals[2 * index + 1]) = (-x, -y);
    }
    let moving = orthonormal(&by_pose);
    let (without, left) = (moving.tr_mul(&by_camera), moving.tr_mul(&residuals));
    let normal = by_camera.tr_mul(&by_camera) - without.tr_mul(&without);
    let right = by_camera.tr_mul(&residuals) - without.tr_mul(&left);
    let squares = residuals.norm_squared() - left.norm_squared();
    Some(Image { camera: by_camera, moving, residuals, normal, right, squares })
}

/// By a small rotation about the camera's axes and by a shift along them, px per rad and per object unit.
fn by_motion(buffer: &DerivativeBuffer, [x, y, z]: [f64; 3]) -> [[f64; 2]; POSE] {
    let turned = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let unit = |axis: usize| std::array::from_fn(|k| if k == axis { 1.0 } else { 0.0 });
    std::array::from_fn(|column| {
        let direction: [f64; 3] = if column < 3 { turned[column] } else { unit(column - 3) };
        std::array::from_fn(|row| direction.iter().zip(&buffer.by_ray[row]).map(|(d, by)| d * by).sum())
    })
}

/// An orthonormal basis of the columns.
fn orthonormal(columns: &DMatrix<f64>) -> DMatrix<f64> {
    let scale = DVector::from_iterator(MOVING, columns.column_iter().map(|column| column.norm().max(f64::MIN_POSITIVE).recip()));
    let scaled = columns * DMatrix::from_diagonal(&scale);
    let products = scaled.tr_mul(&scaled);
    let eigen = SymmetricEigen::new(SMatrix::<f64, MOVING, MOVING>::from_fn(|i, k| products[(i, k)]));
    let kept: Vec<usize> = (0..MOVING).filter(|&k| eigen.eigenvalues[k] > ZERO).collect();
    let basis = DMatrix::from_fn(MOVING, kept.len(), |i, k| eigen.eigenvectors[(i, kept[k])] / eigen.eigenvalues[kept[k]].sqrt());
    scaled * basis
}

#[cfg(test)]
mod tests {
    use calibench_adjust::{Options, adjust};

    use super::*;
    use crate::scenes::{Scene, board, lens, settings};
    use crate::{Prior, Settings};

    fn prepared(settings: &Settings) -> crate::Prepared {
        Scene { sigma: 0.1, ..board(lens()) }.prepared(settings).unwrap()
    }

    #[test]
    fn the_sum_of_squares_is_that_of_the_white_residuals() {
        let prepared = prepared(&settings("opencv5"));
        let solution = adjust(&prepared.network, &Options::default()).unwrap();
        let moving = Moving::of(&solution, |at| at.y).unwrap();
        let squares: f64 = moving.white().map(|[x, y]| x * x + y * y).sum();
        assert!((squares / moving.cost - 1.0).abs() < 1e-9 && moving.cost < solution.cost(), "{squares} for {}", moving.cost);
        // Six velocities of each of seven images.
        assert_eq!(moving.more, 42);
    }

    #[test]
    fn leaving_images_out_of_pure_noise_shows_what_the_covariances_say() {
        let prepared = prepared(&settings("opencv5"));
        let solution = adjust(&prepared.network, &Options::default()).unwrap();
        let moving = Moving::of(&solution, |at| at.y).unwrap();
        let redundancy = (solution.counts().redundancy() - 42) as f64;
        for groups in [7, 20] {
            let found = moving.optimism(groups, redundancy).unwrap();
            assert!((0.4..2.5).contains(&found), "{groups}: {found}");
        }
    }

    #[test]
    fn what_was_observed_of_a_parameter_counts_as_an_observation() {
        let mut settings = settings("opencv5");
        settings.cameras[0].priors = vec![Prior { parameter: "k1".into(), value: -0.1, sigma: 0.01 }];
        let prepared = prepared(&settings);
        let solution = adjust(&prepared.network, &Options::default()).unwrap();
        let names = solution.cameras()[0].parameters();
        let place = names.iter().position(|parameter| parameter.name == "k1").unwrap();
        let (normal, right, squares) = prior(&solution, &prepared.network, &[(0, 0), (0, place)]);
        let off = -0.1 - names[place].value;
        assert!(off.abs() > 1e-3, "{off}");
        assert_eq!((normal[(0, 0)], normal[(0, 1)], right[0]), (0.0, 0.0, 0.0));
        for (found, expected) in [(normal[(1, 1)], 1e4), (right[1], off * 1e4), (squares, off * off * 1e4)] {
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} for {expected}");
        }
    }
}
