//! The plane on which control lies.

use calibench_adjust::{Network, OnSurface, Status};
use nalgebra::{Matrix3, Point3, SymmetricEigen, Unit, Vector3};

/// Height of control over its plane, as a share of its extent, up to which it is a board: the coordinates of a board that was measured are not flat.
const FLAT: f64 = 5e-3;
/// Extent across, as a share of that along, below which it is a strip whose bend across has no meaning.
const STRIP: f64 = 0.02;
/// Fixed points on a board: a surface of second order has six coefficients.
const LEAST: usize = 9;

/// Where a board lies, and how large it is, in the object's frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Board {
    /// The middle of its extent, object units.
    pub middle: Point3<f64>,
    /// Unit vectors along u, v and the normal, which points to the side from which it is seen.
    pub axes: [Vector3<f64>; 3],
    /// Half of its extent along u and v, object units.
    pub half: [f64; 2],
}

impl Board {
    /// Where a point lies on the board: u and v, from -1 to 1.
    pub fn place(&self, point: &Point3<f64>) -> [f64; 2] {
        let from = point - self.middle;
        [from.dot(&self.axes[0]) / self.half[0], from.dot(&self.axes[1]) / self.half[1]]
    }

    /// How far coefficients lift a place along the normal, object units.
    pub fn lift(coefficients: [f64; 3], place: [f64; 2]) -> f64 {
        Self::shapes(place).iter().zip(coefficients).map(|(shape, coefficient)| shape * coefficient).sum()
    }

    /// The greatest difference of height that coefficients make on the board, object units: how far it departs from flat, tilt included in neither.
    pub fn deflection(coefficients: [f64; 3]) -> f64 {
        let steps = |i: i32| f64::from(i) / 10.0;
        let heights = (-10..=10).flat_map(|i| (-10..=10).map(move |k| Self::lift(coefficients, [steps(i), steps(k)])));
        let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], height| [low.min(height), high.max(height)]);
        high - low
    }

    fn shapes([u, v]: [f64; 2]) -> [f64; 3] {
        [1.0 - u * u, 1.0 - v * v, u * v]
    }

    /// The fixed points of `network`, all of which lie on the board, with what its coefficients do to them.
    pub(super) fn on(&self, network: &Network) -> Vec<OnSurface> {
        let lifted = |(point, position): (usize, Point3<f64>)| {
            let shapes = Self::shapes(self.place(&position));
            OnSurface { point, basis: Matrix3::from_columns(&shapes.map(|shape| self.axes[2] * shape)) }
        };
        fixed(network).map(lifted).collect()
    }
}

fn fixed(network: &Network) -> impl Iterator<Item = (usize, Point3<f64>)> + '_ {
    let fixed = network.points.iter().enumerate().filter(|(_, point)| point.coordinates == [Status::Fixed; 3]);
    fixed.map(|(index, point)| (index, point.position))
}

/// The board that all fixed points of `network` lie on.
///
/// # Errors
/// Why there is none, in words.
pub(crate) fn board(network: &Network) -> Result<Board, &'static str> {
    if network.points.iter().any(|point| point.coordinates.iter().any(|status| matches!(status, Status::Observed { .. }))) {
        return Err("the control is weighted: its standard deviations say how far it may move");
    }
    let points: Vec<Point3<f64>> = fixed(network).map(|(_, position)| position).collect();
    if points.len() < LEAST {
        return Err("there are fewer than nine fixed control points");
    }
    let (mean, normal) = plane(&points)?;
    let normal = towards(network, mean, normal);
    let [u, v] = in_plane(&normal);
    let extent = |axis: &Vector3<f64>| {
        let along = points.iter().map(|point| point.coords.dot(axis));
        let [low, high] = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)]);
        [0.5 * (low + high), 0.5 * (high - low)]
    };
    let [[mu, hu], [mv, hv]] = [extent(&u), extent(&v)];
    let middle = Point3::from(u * mu + v * mv + normal * normal.dot(&mean));
    let board = Board { middle, axes: [u, v, normal], half: [hu, hv] };
    if spans(&board, &points) { Ok(board) } else { Err("its points are too few to tell a bend from a tilt") }
}

/// The middle of points in a plane, and its normal, either way.
fn plane(points: &[Point3<f64>]) -> Result<(Vector3<f64>, Vector3<f64>), &'static str> {
    let mean = points.iter().map(|point| point.coords).sum::<Vector3<f64>>() / points.len() as f64;
    let spread: Matrix3<f64> = points.iter().map(|point| (point.coords - mean) * (point.coords - mean).transpose()).sum();
    let eigen = SymmetricEigen::new(spread);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let [thin, middle, long] = order.map(|i| eigen.eigenvalues[i].max(0.0).sqrt());
    if thin > FLAT * long {
        return Err("the control points do not lie in one plane");
    }
    if middle < STRIP * long {
        return Err("the control points lie along a line");
    }
    Ok((mean, eigen.eigenvectors.column(order[0]).into_owned()))
}

/// Whether the object points of `network`, whatever is known of them, are those of a board.
pub(crate) fn is_flat(network: &Network) -> bool {
    let points: Vec<Point3<f64>> = network.points.iter().map(|point| point.position).collect();
    points.len() >= LEAST && plane(&points).is_ok()
}

/// The normal on the side of most projection centres.
fn towards(network: &Network, mean: Vector3<f64>, normal: Vector3<f64>) -> Vector3<f64> {
    let side: f64 = network.images.iter().map(|image| (image.pose.centre.coords - mean).dot(&normal).signum()).sum();
    if side < 0.0 { -normal } else { normal }
}

/// The object's axes in the plane, as far as they lie in it: u the first of X, Y, Z that is not across it, v at a right angle.
fn in_plane(normal: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let across = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(2);
    let [first, second] = [[1, 2], [0, 2], [0, 1]][across].map(|i| axes[i]);
    let u = Unit::new_normalize(first - normal * normal.dot(&first)).into_inner();
    let v = normal.cross(&u);
    [u, if v.dot(&second) < 0.0 { -v } else { v }]
}

/// Whether heights at the points tell a surface of second order: six functions that are independent there.
fn spans(board: &Board, points: &[Point3<f64>]) -> bool {
    let row = |point: &Point3<f64>| {
        let [u, v] = board.place(point);
        nalgebra::RowVector6::new(1.0, u, v, u * u, v * v, u * v)
    };
    let normal: nalgebra::Matrix6<f64> = points.iter().map(|point| row(point).transpose() * row(point)).sum();
    SymmetricEigen::new(normal / points.len() as f64).eigenvalues.min() > 1e-4
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_adjust::{Exterior, ObjectPoint};
    use calibench_model::Pose;

    fn network(points: impl IntoIterator<Item = Point3<f64>>, eye: Point3<f64>) -> Network {
        let points = points.into_iter().map(|point| ObjectPoint::fixed("", point)).collect();
        let pose = Pose { rotation: Matrix3::identity(), centre: eye };
        Network { points, images: vec![Exterior::free("", 0, pose)], ..Network::default() }
    }

    fn grid(columns: i32, rows: i32) -> impl Iterator<Item = Point3<f64>> {
        (0..columns * rows).map(move |k| Point3::new(f64::from(k % columns) * 20.0 + 7.0, f64::from(k / columns) * 20.0, 3.0))
    }

    #[test]
    fn a_board_has_the_axes_of_its_coordinates_and_its_normal_to_the_camera() {
        let found = board(&network(grid(6, 4), Point3::new(50.0, 30.0, -400.0))).unwrap();
        assert!((found.middle - Point3::new(57.0, 30.0, 3.0)).norm() < 1e-9, "{found:?}");
        assert!((found.axes[2] + Vector3::z()).norm() < 1e-9 && (found.axes[0] - Vector3::x()).norm() < 1e-9);
        assert!((found.axes[1] - Vector3::y()).norm() < 1e-9);
        assert!((found.half[0] - 50.0).abs() < 1e-9 && (found.half[1] - 30.0).abs() < 1e-9);
        assert_eq!(found.place(&Point3::new(107.0, 0.0, 3.0)).map(f64::round), [1.0, -1.0]);
        // A bend of 2 mm lifts the middle to the camera by as much, and the edges not at all.
        let on = found.on(&network(grid(6, 4), Point3::new(50.0, 30.0, -400.0)));
        assert_eq!(on.len(), 24);
        assert!((on[0].basis * Vector3::new(2.0, 0.0, 0.0)).norm() < 1e-9, "{:?}", on[0]);
        let near = on[8].basis * Vector3::new(0.0, 1.0, 0.0);
        assert!((near + Vector3::z() * (1.0 - (10.0_f64 / 30.0).powi(2))).norm() < 1e-9, "{near:?}");
    }

    #[test]
    fn a_board_may_stand_anywhere() {
        // In the plane x = z / 2, turned.
        let turned = grid(6, 4).map(|p| Point3::new(0.447_213_595 * p.x, p.y, 0.894_427_191 * p.x));
        let found = board(&network(turned, Point3::new(100.0, 0.0, 0.0))).unwrap();
        assert!(found.axes[2].dot(&Vector3::new(0.894_427_191, 0.0, -0.447_213_595)) > 1.0 - 1e-9, "{found:?}");
        let square = |i: usize, k: usize| found.axes[i].dot(&found.axes[k]);
        assert!((0..9).all(|k| (square(k / 3, k % 3) - f64::from(u8::from(k / 3 == k % 3))).abs() < 1e-12));
        assert!((found.half[0].max(found.half[1]) - 50.0).abs() < 1e-6);
    }

    #[test]
    fn deflection_is_the_range_of_heights() {
        assert!((Board::deflection([1.0, 0.0, 0.0]) - 1.0).abs() < 1e-12);
        assert!((Board::deflection([1.0, -0.5, 0.0]) - 1.5).abs() < 1e-12);
        assert!((Board::deflection([0.0, 0.0, 1.0]) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_no_board_is_said() {
        let eye = Point3::new(0.0, 0.0, 500.0);
        let why = |network: &Network| board(network).unwrap_err();
        assert!(why(&network(grid(4, 2), eye)).contains("nine"));
        assert!(why(&network(grid(20, 1), eye)).contains("line"));
        assert!(why(&network(grid(8, 2), eye)).contains("bend from a tilt"));
        assert!(why(&network(grid(5, 5).enumerate().map(|(i, p)| p + Vector3::z() * (i % 3) as f64), eye)).contains("one plane"));
        assert!(board(&network(grid(5, 5).enumerate().map(|(i, p)| p + Vector3::z() * 0.05 * (i % 3) as f64), eye)).is_ok());
        let mut weighted = network(grid(5, 5), eye);
        weighted.points[3] = ObjectPoint::observed("", weighted.points[3].position, [0.1; 3]);
        assert!(why(&weighted).contains("weighted"));
    }
}
