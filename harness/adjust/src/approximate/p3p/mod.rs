//! Resection from three points.

use calibench_model::camera::Camera;
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Matrix3, Point3, Vector3};

use super::ApproximateError;
use super::pose_fit::{Control, all_finite, rays};
use super::roots::real_roots;
use super::shape::{Shape, ascending};

/// Newton steps on the distances at most; two or three are enough but near a double solution.
const POLISHES: usize = 30;
/// A misclosure of the squared sides, relative, of what is a solution after polishing.
const CLOSED: f64 = 1e-10;
/// A negative discriminant, relative, that rounding makes of a double root.
const DOUBLE: f64 = 1e-5;
/// A determinant, of a conic of unit norm, that is zero but for rounding.
const INFINITE: f64 = 1e-14;
/// Distances that differ by less, relative, are one solution.
const SAME: f64 = 1e-9;

/// All poses from which three control points are seen where `camera` pictures them: up to four.
///
/// # Errors
/// [`ApproximateError::NotFinite`], [`ApproximateError::Collinear`], [`ApproximateError::NotInCamera`]. An empty list where no pose exists.
pub fn poses_of_three(camera: &Camera, control: &[Control; 3]) -> Result<Vec<Pose>, ApproximateError> {
    all_finite(control)?;
    let points = control.map(|point| point.object);
    if Shape::of(points.into_iter()).is_line() {
        return Err(ApproximateError::Collinear);
    }
    let images: [PixelPoint; 3] = control.map(|point| point.image);
    let rays = rays(camera, images.into_iter())?;
    Ok(p3p(&[rays[0], rays[1], rays[2]], &points))
}

/// All poses from which three points (object units) lie in the directions `rays` (camera axes, any length): the perspective-three-point problem.
///
/// The ratios of the distances are the common points of two conics. A member of their pencil that splits into two lines is found from a cubic; each line
/// cuts a conic in two points. The distances are polished by Newton's method. Degenerate points have no poses.
///
/// Source: the conics and their pencil after Ding, Yang, Larsson, Olsson & Åström 2023, Revisiting the P3P problem; polishing of the distances after
/// Persson & Nordberg 2018, Lambda Twist.
pub fn p3p(rays: &[Vector3<f64>; 3], points: &[Point3<f64>; 3]) -> Vec<Pose> {
    let directions = rays.map(|ray| ray.normalize());
    let triangle = Triangle::of(&directions, points);
    let mut found: Vec<Vector3<f64>> = Vec::with_capacity(4);
    for start in triangle.distances() {
        let Some(distances) = triangle.polished(start) else { continue };
        if !found.iter().any(|other| (other - distances).amax() <= SAME * distances.amax()) {
            found.push(distances);
        }
    }
    found.iter().filter_map(|distances| pose(&directions, points, distances)).collect()
}

/// Sides and angles: `d_i^2 + d_j^2 - 2 d_i d_j cos_ij = side_ij^2` for the pairs (0, 1), (0, 2), (1, 2), with sides scaled to a sum of squares of one.
struct Triangle {
    cosines: [f64; 3],
    squares: [f64; 3],
    /// The root of the sum of the squared sides, object units.
    size: f64,
}

const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

impl Triangle {
    fn of(directions: &[Vector3<f64>; 3], points: &[Point3<f64>; 3]) -> Self {
        let squares = PAIRS.map(|(i, j)| (points[i] - points[j]).norm_squared());
        let sum: f64 = squares.iter().sum();
        Self {
            cosines: PAIRS.map(|(i, j)| directions[i].dot(&directions[j])),
            squares: squares.map(|square| square / sum),
            size: sum.sqrt(),
        }
    }

    /// The form `d_i^2 + d_j^2 - 2 d_i d_j cos_ij` of a pair.
    fn form(&self, pair: usize) -> Matrix3<f64> {
        let ((i, j), mut form) = (PAIRS[pair], Matrix3::zeros());
        (form[(i, i)], form[(j, j)]) = (1.0, 1.0);
        (form[(i, j)], form[(j, i)]) = (-self.cosines[pair], -self.cosines[pair]);
        form
    }

    /// Approximate distances, scaled.
    fn distances(&self) -> Vec<Vector3<f64>> {
        // With a short side in both, the conics would hardly differ.
        let longest = Vector3::from(self.squares).imax();
        let conic = |pair: usize| self.form(pair) * self.squares[longest] - self.form(longest) * self.squares[pair];
        let (first, second) = (conic((longest + 1) % 3), conic((longest + 2) % 3));
        let sum = self.form(0) + self.form(1) + self.form(2);
        let Some(lines) = split_of_pencil(&first, &second) else { return Vec::new() };
        let scaled = |at: Vector3<f64>| {
            let at = at * if at.sum() < 0.0 { -1.0 } else { 1.0 };
            let square = (at.transpose() * sum * at).x;
            (square > 0.0 && at.min() > -1e-3 * at.amax()).then(|| at / square.sqrt())
        };
        lines.iter().flat_map(|line| cut(line, &first, &second)).filter_map(scaled).collect()
    }

    /// Newton's method on the three sides; `None` where it does not end in positive distances that close.
    fn polished(&self, start: Vector3<f64>) -> Option<Vector3<f64>> {
        let mut d = start;
        let mut misclosure = self.misclosure(&d);
        for _ in 0..POLISHES {
            let Some(step) = self.step(&d, &misclosure) else { break };
            // Near a double solution a whole step may overshoot.
            let trials = [1.0, 0.5, 0.25, 0.125].into_iter().map(|share| d - step * share).map(|next| (next, self.misclosure(&next)));
            let mut closer = trials.filter(|(_, left)| left.amax() < misclosure.amax());
            let Some(next) = closer.next() else { break };
            (d, misclosure) = next;
        }
        (d.min() > 0.0 && misclosure.amax() <= CLOSED * d.norm_squared().max(1.0)).then(|| d * self.size)
    }

    /// The change of the distances that closes the linearised sides, by Cramer's rule: each side depends on two of them.
    fn step(&self, d: &Vector3<f64>, misclosure: &Vector3<f64>) -> Option<Vector3<f64>> {
        let slope = |of: usize, by: usize, pair: usize| 2.0 * (d[of] - d[by] * self.cosines[pair]);
        // Rows (a, b, 0), (c, 0, e), (0, f, g).
        let ([a, b], [c, e], [f, g]) =
            ([slope(0, 1, 0), slope(1, 0, 0)], [slope(0, 2, 1), slope(2, 0, 1)], [slope(1, 2, 2), slope(2, 1, 2)]);
        let [u, v, w] = [misclosure.x, misclosure.y, misclosure.z];
        let (determinant, rest) = (-a * e * f - b * c * g, g * v - e * w);
        let step = Vector3::new(-e * f * u - b * rest, a * rest - c * g * u, c * f * u - a * f * v - b * c * w) / determinant;
        (determinant != 0.0 && step.iter().all(|value| value.is_finite())).then_some(step)
    }

    fn misclosure(&self, d: &Vector3<f64>) -> Vector3<f64> {
        let side = |pair: usize| {
            let (i, j) = PAIRS[pair];
            // As a sum of two squares it keeps its digits where the angle is small.
            (d[i] - d[j]).powi(2) + 2.0 * d[i] * d[j] * (1.0 - self.cosines[pair]) - self.squares[pair]
        };
        Vector3::new(side(0), side(1), side(2))
    }
}

/// Two lines that make up a conic of the pencil `first + s second`, the clearest of those that are real.
fn split_of_pencil(first: &Matrix3<f64>, second: &Matrix3<f64>) -> Option<[Vector3<f64>; 2]> {
    let (a, b) = (adjugate(first), adjugate(second));
    let cubic = [first.determinant(), (a * second).trace(), (b * first).trace(), second.determinant()];
    let split = |conic: Matrix3<f64>| {
        let (values, vectors) = ascending(conic / conic.norm());
        // One eigenvalue of each sign; the third is zero but for rounding.
        let clear = (-values[0]).min(values[2]);
        let (low, high) = (vectors.column(0) * (-values[0]).max(0.0).sqrt(), vectors.column(2) * values[2].max(0.0).sqrt());
        (clear, [high + low, high - low])
    };
    // A root at infinity is the second conic itself.
    let last = (second.determinant().abs() < INFINITE * second.norm().powi(3)).then(|| split(*second));
    let candidates = real_roots(&cubic).into_iter().map(|s| split(first + second * s)).chain(last);
    candidates.filter(|(clear, _)| *clear >= 0.0).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, lines)| lines)
}

/// The points in which a line cuts the conic of the two that it meets most clearly.
fn cut(line: &Vector3<f64>, first: &Matrix3<f64>, second: &Matrix3<f64>) -> Vec<Vector3<f64>> {
    let along = |conic: &Matrix3<f64>, u: &Vector3<f64>, v: &Vector3<f64>| {
        let (cu, cv) = (conic * u, conic * v);
        [u.dot(&cu), u.dot(&cv), v.dot(&cv)]
    };
    let Some(u) = line.cross(&Vector3::ith(line.iamin(), 1.0)).try_normalize(0.0) else { return Vec::new() };
    let v = line.cross(&u).normalize();
    let (p, q) = (along(first, &u, &v), along(second, &u, &v));
    let size = |[a, b, c]: [f64; 3]| a.abs() + 2.0 * b.abs() + c.abs();
    let [a, b, c] = if size(p) >= size(q) { p } else { q };
    // a x^2 + 2 b x y + c y^2 = 0 at u x + v y.
    let (discriminant, scale) = (b * b - a * c, b * b + (a * c).abs());
    if discriminant < -DOUBLE * scale {
        return Vec::new();
    }
    let h = -(b + discriminant.max(0.0).sqrt() * b.signum());
    [u * h + v * a, u * c + v * h].into_iter().filter_map(|at| at.try_normalize(0.0)).collect()
}

/// The transposed matrix of cofactors.
fn adjugate(m: &Matrix3<f64>) -> Matrix3<f64> {
    let (x, y, z) = (m.column(0), m.column(1), m.column(2));
    Matrix3::from_rows(&[y.cross(&z).transpose(), z.cross(&x).transpose(), x.cross(&y).transpose()])
}

/// The pose that brings the points to the given distances.
fn pose(directions: &[Vector3<f64>; 3], points: &[Point3<f64>; 3], distances: &Vector3<f64>) -> Option<Pose> {
    let seen: [Vector3<f64>; 3] = std::array::from_fn(|i| directions[i] * distances[i]);
    let from = axes(&(points[1] - points[0]), &(points[2] - points[0]))?;
    let to = axes(&(seen[1] - seen[0]), &(seen[2] - seen[0]))?;
    let rotation = to * from.transpose();
    let mean = |of: &dyn Fn(usize) -> Vector3<f64>| (of(0) + of(1) + of(2)) / 3.0;
    let centre = mean(&|i| points[i].coords) - rotation.transpose() * mean(&|i| seen[i]);
    Some(Pose { rotation, centre: centre.into() })
}

/// Right-handed axes: the first along `a`, the third across `a` and `b`.
fn axes(a: &Vector3<f64>, b: &Vector3<f64>) -> Option<Matrix3<f64>> {
    let first = a.try_normalize(0.0)?;
    let third = a.cross(b).try_normalize(0.0)?;
    Some(Matrix3::from_columns(&[first, third.cross(&first), third]))
}

#[cfg(test)]
mod tests;
