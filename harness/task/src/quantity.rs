//! What follows from measured points, with its derivatives.

use calibench_adjust::approximate::{Shape, similarity};
use nalgebra::{DMatrix, Matrix3, Point3, Vector3};

use crate::TaskError;

/// What is measured: of points that are where they truly lie, object units.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// The distance of two points.
    Length([Point3<f64>; 2]),
    /// X, Y and Z of a point.
    Point(Point3<f64>),
    /// The angle at the second of three points.
    Angle([Point3<f64>; 3]),
    /// The plane of least squares through three points or more: where it lies along its normal, and how it is tilted.
    Plane(Vec<Point3<f64>>),
    /// How a body of three points or more is turned, about the axes of the object's frame.
    Rotation(Vec<Point3<f64>>),
}

/// One number of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Named {
    /// What it is.
    pub name: &'static str,
    /// Its value, in object units or degrees; `None` where only its error has a meaning.
    pub value: Option<f64>,
    /// Whether it is in degrees; if not, in object units.
    pub in_degrees: bool,
}

/// Below this sine two directions are one.
const STRAIGHT: f64 = 1e-6;

impl Quantity {
    /// The word for it in files.
    pub const fn word(&self) -> &'static str {
        match self {
            Self::Length(_) => "length",
            Self::Point(_) => "point",
            Self::Angle(_) => "angle",
            Self::Plane(_) => "plane",
            Self::Rotation(_) => "rotation",
        }
    }

    /// The points that are measured for it.
    pub fn points(&self) -> &[Point3<f64>] {
        match self {
            Self::Length(points) => points,
            Self::Point(point) => std::slice::from_ref(point),
            Self::Angle(points) => points,
            Self::Plane(points) | Self::Rotation(points) => points,
        }
    }

    /// The same elsewhere.
    #[must_use]
    pub fn moved(&self, by: &Vector3<f64>) -> Self {
        let all = |points: &[Point3<f64>]| points.iter().map(|point| point + by).collect::<Vec<_>>();
        match self {
            Self::Length(points) => Self::Length(points.map(|point| point + by)),
            Self::Point(point) => Self::Point(point + by),
            Self::Angle(points) => Self::Angle(points.map(|point| point + by)),
            Self::Plane(points) => Self::Plane(all(points)),
            Self::Rotation(points) => Self::Rotation(all(points)),
        }
    }

    /// Whether it changes with the scale of its frame.
    pub const fn has_scale(&self) -> bool {
        !matches!(self, Self::Angle(_) | Self::Rotation(_))
    }

    /// The numbers that it consists of.
    pub fn named(&self) -> Vec<Named> {
        let of = |name, value, in_degrees| Named { name, value, in_degrees };
        match self {
            Self::Length([from, to]) => vec![of("length", Some((to - from).norm()), false)],
            Self::Point(point) => {
                ["X", "Y", "Z"].into_iter().zip(point.iter()).map(|(name, value)| of(name, Some(*value), false)).collect()
            }
            Self::Angle(points) => vec![of("angle", Some(angle(points).to_degrees()), true)],
            Self::Plane(points) => {
                let shape = Shape::of(points.iter().copied());
                let from_origin = shape.axes.column(2).dot(&shape.centroid.coords);
                let tilts = ["tilt about the longer axis", "tilt about the shorter axis"].map(|name| of(name, None, true));
                [of("position along the normal", Some(from_origin), false)].into_iter().chain(tilts).collect()
            }
            Self::Rotation(_) => ["rotation about X", "rotation about Y", "rotation about Z"].map(|name| of(name, None, true)).into(),
        }
    }

    /// What is measured from `found`, the points with their errors, less what it truly is: in object units and degrees.
    ///
    /// # Errors
    /// [`TaskError::Quantity`] for points that do not determine it.
    pub(crate) fn errors(&self, found: &[Point3<f64>]) -> Result<Vec<f64>, TaskError> {
        Ok(match self {
            Self::Length([from, to]) => vec![(found[1] - found[0]).norm() - (to - from).norm()],
            Self::Point(point) => (found[0] - point).iter().copied().collect(),
            Self::Angle(points) => vec![(angle(&[found[0], found[1], found[2]]) - angle(points)).to_degrees()],
            Self::Plane(points) => {
                let frame = PlaneFrame::of(points)?;
                let mut matrix = Matrix3::zeros();
                let mut right = Vector3::zeros();
                for point in found {
                    let [u, v] = frame.shape.in_plane(point);
                    let row = Vector3::new(1.0, u, v);
                    matrix += row * row.transpose();
                    right += row * frame.shape.height(point);
                }
                let solved = matrix.cholesky().ok_or(LINE)?.solve(&right);
                // A slope across the axis is a tilt about it.
                vec![solved[0], solved[2].atan().to_degrees(), -solved[1].atan().to_degrees()]
            }
            Self::Rotation(points) => {
                let turned = similarity(points, found, false).map_err(|_| LINE)?;
                turn(&turned.rotation).iter().map(|turn| turn.to_degrees()).collect()
            }
        })
    }

    /// Derivatives of its numbers, object units or degrees, by X, Y and Z of its points: a row a number, three columns a point.
    ///
    /// # Errors
    /// [`TaskError::Quantity`] for points that do not determine it.
    pub(crate) fn gradient(&self) -> Result<DMatrix<f64>, TaskError> {
        let points = self.points();
        let mut rows = DMatrix::zeros(self.named().len(), 3 * points.len());
        match self {
            Self::Length([from, to]) => {
                let along = (to - from).try_normalize(0.0).ok_or(TaskError::Quantity("a length of 0 has no direction"))?;
                put(&mut rows, 0, 0, &-along);
                put(&mut rows, 0, 1, &along);
            }
            Self::Point(_) => rows.fill_with_identity(),
            Self::Angle([from, apex, to]) => {
                let (a, b) = (from - apex, to - apex);
                let (u, v) = (a.normalize(), b.normalize());
                let (cosine, sine) = (u.dot(&v), u.cross(&v).norm());
                if sine.is_nan() || sine < STRAIGHT {
                    return Err(TaskError::Quantity(
                        "an angle of 0 or 180 degrees has no derivative; expected three points that are not on a line",
                    ));
                }
                let (by_a, by_b) = ((u * cosine - v) / (a.norm() * sine), (v * cosine - u) / (b.norm() * sine));
                for (place, by) in [by_a, -(by_a + by_b), by_b].into_iter().enumerate() {
                    put(&mut rows, 0, place, &by.map(f64::to_degrees));
                }
            }
            Self::Plane(points) => {
                let PlaneFrame { shape, squares } = PlaneFrame::of(points)?;
                let [long, short, normal] = [0, 1, 2].map(|axis| Vector3::from(shape.axes.column(axis)));
                for (place, point) in points.iter().enumerate() {
                    let ([u, v], height) = (shape.in_plane(point), shape.height(point));
                    put(&mut rows, 0, place, &(normal / points.len() as f64));
                    // A point that is off the plane tips it when it moves along it, too.
                    put(&mut rows, 1, place, &((normal * v + short * height) / squares[1]).map(f64::to_degrees));
                    put(&mut rows, 2, place, &(-(normal * u + long * height) / squares[0]).map(f64::to_degrees));
                }
            }
            Self::Rotation(points) => {
                let centroid = Shape::of(points.iter().copied()).centroid;
                let arms = || points.iter().map(|point| point - centroid);
                let matrix: Matrix3<f64> = arms().map(|arm| Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()).sum();
                let inverse = matrix.try_inverse().filter(|_| PlaneFrame::of(points).is_ok()).ok_or(LINE)?;
                for (place, arm) in arms().enumerate() {
                    let by = inverse * arm.cross_matrix();
                    rows.view_mut((0, 3 * place), (3, 3)).copy_from(&by.map(f64::to_degrees));
                }
            }
        }
        Ok(rows)
    }
}

const LINE: TaskError = TaskError::Quantity("the points lie on a line; expected three at least that do not");

/// Axes in a plane of points and sums of the squares along them.
struct PlaneFrame {
    shape: Shape,
    squares: [f64; 2],
}

impl PlaneFrame {
    fn of(points: &[Point3<f64>]) -> Result<Self, TaskError> {
        let shape = Shape::of(points.iter().copied());
        if points.len() < 3 || shape.extents[1].is_nan() || shape.extents[1] <= STRAIGHT * shape.extents[0] {
            return Err(LINE);
        }
        let square = |axis: usize| points.iter().map(|point| shape.in_plane(point)[axis].powi(2)).sum();
        Ok(Self { shape, squares: [square(0), square(1)] })
    }
}

fn put(rows: &mut DMatrix<f64>, row: usize, point: usize, by: &Vector3<f64>) {
    for axis in 0..3 {
        rows[(row, 3 * point + axis)] = by[axis];
    }
}

/// The angle at the second of three points, rad.
fn angle([from, apex, to]: &[Point3<f64>; 3]) -> f64 {
    let (a, b) = (from - apex, to - apex);
    a.cross(&b).norm().atan2(a.dot(&b))
}

/// The axis of a rotation, as long as its angle, rad. By the sine: the cosine of a small angle has half the digits.
fn turn(rotation: &Matrix3<f64>) -> Vector3<f64> {
    let m = |row, column| rotation[(row, column)];
    let axis = 0.5 * Vector3::new(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
    let sine = axis.norm();
    if sine > 0.0 { axis * (sine.atan2(0.5 * (rotation.trace() - 1.0)) / sine) } else { axis }
}
