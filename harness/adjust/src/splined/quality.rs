//! How well splines are known.

use calibench_model::camera::{CameraModel, Ray, Splined};
use calibench_model::{Covariance, PixelPoint};
use nalgebra::{DMatrix, Matrix2, Matrix2x3, Matrix3, Matrix3xX, MatrixXx3, Vector2};

use super::CORE;
use crate::quality::by_turn;

/// Covariance of core and control points, and where image points hold them.
#[derive(Clone, Debug)]
pub struct SplinedQuality {
    /// Of fx, fy, cx, cy, then x and y of each control point, then what else was adjusted with them; zeros of what was held.
    covariance: DMatrix<f64>,
    /// The covariance of these with the rotation of the camera by which the image points in use move least, and of that rotation.
    with_turn: MatrixXx3<f64>,
    of_turn: Matrix3<f64>,
    /// Cells of the grid, row by row: how many image points lie in each.
    points: Vec<usize>,
    camera: Splined,
    /// How well image points fit.
    pub fit: SplinedFit,
}

/// How well image points fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplinedFit {
    /// Image coordinates less the unknowns that they determine, a number that need not be whole: the prior determines the others.
    pub redundancy: f64,
    /// The estimated standard deviation of unit weight of image points, a number; `None` without redundancy. The prior has no say: control points are far nearer to zero than it expects.
    pub sigma0: Option<f64>,
}

/// A place of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplinedPlace {
    /// Where.
    pub at: PixelPoint,
    /// Covariance of the image of the point far away that is seen there, px^2, after the rotation of the camera that makes up for most at the image points in use.
    pub covariance: Covariance,
    /// Whether an image point in use lies in its cell of the grid. Elsewhere the splines are held by neighbours and by the prior.
    pub is_held: bool,
}

/// What the image of a far point depends on.
struct FarPoint {
    /// Which of what is kept, and the derivatives of x and y.
    row: Vec<(usize, [f64; 2])>,
    /// Derivatives of x and y by a small rotation of the camera.
    turn: Matrix2x3<f64>,
}

impl FarPoint {
    fn of(camera: &Splined, ray: Ray) -> Option<Self> {
        let image = camera.picture(ray).ok()?;
        let ([fx, fy, ..], [x, y]) = (camera.core, image.distorted);
        let core = [[x, 0.0], [0.0, y], [1.0, 0.0], [0.0, 1.0]].into_iter().enumerate();
        let control =
            image.control().flat_map(|(place, share)| [(CORE + 2 * place, [fx * share, 0.0]), (CORE + 2 * place + 1, [0.0, fy * share])]);
        let row = core.chain(control).collect();
        let [first, second] = [0, 1].map(|axis| by_turn(image.by_ray[axis], ray));
        Some(Self { row, turn: Matrix2x3::from_fn(|i, j| if i == 0 { first[j] } else { second[j] }) })
    }
}

/// `A = (R^T R)^-1 R^T J` of image points: what the camera turns by where a number changes. Zeros where they do not tell.
fn turn_by(n: usize, points: impl Iterator<Item = FarPoint>) -> Matrix3xX<f64> {
    let (mut normal, mut turn) = (Matrix3::<f64>::zeros(), Matrix3xX::<f64>::zeros(n));
    for point in points {
        normal += point.turn.tr_mul(&point.turn);
        for &(column, by) in &point.row {
            let mut into = turn.column_mut(column);
            into += point.turn.tr_mul(&Vector2::from(by));
        }
    }
    normal.try_inverse().map_or_else(|| Matrix3xX::zeros(n), |inverse| inverse * turn)
}

impl SplinedQuality {
    pub(super) fn new(
        camera: &Splined,
        (cofactors, factor): (&[f64], f64),
        fit: SplinedFit,
        rays: impl Iterator<Item = Ray> + Clone,
    ) -> Self {
        let n = cofactors.len().isqrt();
        let covariance = DMatrix::from_column_slice(n, n, cofactors) * factor;
        let [columns, rows] = camera.cells();
        let mut points = vec![0; columns * rows];
        rays.clone().filter_map(|ray| camera.cell(ray)).for_each(|[column, row]| points[row * columns + column] += 1);
        let turn = turn_by(n, rays.filter_map(|ray| FarPoint::of(camera, ray)));
        let with_turn = &covariance * turn.transpose();
        let of_turn = Matrix3::from_iterator((&turn * &with_turn).iter().copied());
        Self { covariance, with_turn, of_turn, points, camera: camera.clone(), fit }
    }

    /// Standard deviations of fx, fy, cx, cy, px; zeros of what was held.
    pub fn core_sigmas(&self) -> [f64; CORE] {
        std::array::from_fn(|i| self.covariance[(i, i)].max(0.0).sqrt())
    }

    /// Standard deviations of x and y of each control point, numbers as u is.
    pub fn control_sigmas(&self) -> Vec<[f64; 2]> {
        let sigma = |i: usize| self.covariance[(i, i)].max(0.0).sqrt();
        (0..self.camera.control.len()).map(|place| [sigma(CORE + 2 * place), sigma(CORE + 2 * place + 1)]).collect()
    }

    /// The uncertainty over the frame, on a grid of `columns` x `rows` places (2 x 2 at least) from the first pixel's centre to the last's, row by row; places without a ray are left out.
    ///
    /// Source: after the projection uncertainty of mrcal (Kogan 2022).
    pub fn over_frame(&self, (columns, rows): (usize, usize)) -> Vec<SplinedPlace> {
        let size = self.camera.size();
        let along = |i: usize, n: usize, length: u32| f64::from(length - 1) * i as f64 / (n.max(2) - 1) as f64;
        let at = |k: usize| PixelPoint::new(along(k % columns, columns, size.width), along(k / columns, rows, size.height));
        self.at((0..columns * rows).map(at))
    }

    /// The uncertainty at places of the frame.
    pub fn at(&self, places: impl Iterator<Item = PixelPoint>) -> Vec<SplinedPlace> {
        places.filter_map(|at| self.place(at)).collect()
    }

    fn place(&self, at: PixelPoint) -> Option<SplinedPlace> {
        let ray = self.camera.unproject(at).ok()?;
        let FarPoint { row, turn } = FarPoint::of(&self.camera, ray)?;
        let mut q = Matrix2::<f64>::zeros();
        let mut with_turn = Matrix2x3::<f64>::zeros();
        for &(i, a) in &row {
            for &(j, b) in &row {
                let c = self.covariance[(j, i)];
                for (k, l) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    q[(k, l)] += a[k] * b[l] * c;
                }
            }
            (0..2).for_each(|k| (0..3).for_each(|t| with_turn[(k, t)] += a[k] * self.with_turn[(i, t)]));
        }
        let cross = with_turn * turn.transpose();
        let left = q - cross - cross.transpose() + turn * self.of_turn * turn.transpose();
        let covariance = Covariance { sxx: left[(0, 0)], sxy: left[(0, 1)], syy: left[(1, 1)] };
        let columns = self.camera.cells()[0];
        let is_held = self.camera.cell(ray).is_some_and(|[column, row]| self.points[row * columns + column] > 0);
        Some(SplinedPlace { at, covariance, is_held })
    }

    /// How many control points no image point depends on: the prior alone holds them.
    pub fn control_points_without_image_points(&self) -> usize {
        let [columns, rows] = self.camera.cells();
        let order = self.camera.order;
        let touched = |place: usize| {
            let (column, row) = (place % self.camera.columns, place / self.camera.columns);
            let near = |at: usize, cells: usize| at.saturating_sub(order)..=at.min(cells - 1);
            near(row, rows).any(|row| near(column, columns).any(|column| self.points[row * columns + column] > 0))
        };
        (0..self.camera.control.len()).filter(|&place| !touched(place)).count()
    }
}
