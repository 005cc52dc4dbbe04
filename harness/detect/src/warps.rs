//! How the lens warps what is pictured at a board's points, as all of them together tell it.

use calibench_model::boards::Layout;
use calibench_model::camera::ImageSize;
use calibench_model::{TargetKind, Warp};
use nalgebra::{SMatrix, SVector};

use crate::Found;
use crate::plane::{Homography, Point, dot, length, minus, times};

/// Unknowns: the map from the board to directions, row by row, and the lens's coefficients of r^2, r^4 and r^6.
const UNKNOWNS: usize = 12;
/// Fewer points do not tell a lens.
const LEAST: usize = 12;
/// Steps at most, the damping to begin with, and the gain of a step, as a share of the squares, at which they end.
const STEPS: usize = 60;
const DAMPING: f64 = 1e-3;
const GAIN: f64 = 1e-6;
/// Half the step of differences, as a share of the distance between points.
const STEP: f64 = 0.05;
/// Where points are farther off, RMS px, the lens is none of these.
const OFF: f64 = 2.0;

/// What the lens does beyond an affine map at each point that was found; `None` where they are too few or tell of no lens.
///
/// A lens is fitted that images a direction (X, Y, Z) at the distance r from the middle of the image with `r / (1 + a r^2 + b r^4 + c r^6) = hypot(X, Y) / Z`, as Scaramuzza et al. 2006 have it, before a
/// flat board in any pose: pinholes, fisheyes beyond 180 degrees, mirrors. Only what it does from point to point is taken from it. Discs get none: all operators take the centre of
/// the ellipse that is seen, and the adjustment knows by how much that is off.
pub fn warps(layout: &Layout, found: &Found, size: ImageSize) -> Vec<Option<Warp>> {
    let none = || vec![None; found.points.len()];
    let middle = [0.5 * (f64::from(size.width) - 1.0), 0.5 * (f64::from(size.height) - 1.0)];
    let scale = 0.5 * f64::from(size.width).hypot(f64::from(size.height));
    let places: Vec<Point> = found.points.iter().map(|point| layout.points[point.index].at).collect();
    let positions: Vec<Point> =
        found.points.iter().map(|point| times(minus([point.position.x, point.position.y], middle), 1.0 / scale)).collect();
    let is_disc = layout.points.iter().any(|point| point.kind == TargetKind::Disc);
    let (Some(board), true) = (Board::of(&places), places.len() >= LEAST && !is_disc) else { return none() };
    let rows: Vec<(Point, Point)> = places.iter().map(|at| board.of_place(*at)).zip(positions).collect();
    let Some(view) = View::fitted(&rows, scale) else { return none() };
    let step = STEP * board.spacing;
    rows.iter().map(|(at, position)| view.warp(*at, *position, (step, scale))).collect()
}

/// Coordinates on the board about its middle, of unit size.
struct Board {
    middle: Point,
    extent: f64,
    /// Between points, were they spread evenly.
    spacing: f64,
}

impl Board {
    fn of(places: &[Point]) -> Option<Self> {
        let range =
            |axis: usize| places.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (at[axis].min(low), at[axis].max(high)));
        let ([(left, right), (bottom, top)], count) = ([range(0), range(1)], places.len() as f64);
        let (width, height) = (right - left, top - bottom);
        let extent = 0.5 * width.max(height);
        let spacing = (width * height / count).sqrt() / extent;
        (width > 0.0 && height > 0.0).then_some(Self { middle: [0.5 * (left + right), 0.5 * (bottom + top)], extent, spacing })
    }

    fn of_place(&self, at: Point) -> Point {
        times(minus(at, self.middle), 1.0 / self.extent)
    }
}

/// A board before a lens: distances in the image are in units of half its diagonal, and are negative against the direction's side of the middle.
struct View {
    unknowns: SVector<f64, UNKNOWNS>,
}

/// What a point leaves, across the direction from the middle and along it, with derivatives.
struct Residuals {
    values: [f64; 2],
    derivatives: [SVector<f64, UNKNOWNS>; 2],
}

impl View {
    /// `scale`: px to a unit of the image.
    fn fitted(rows: &[(Point, Point)], scale: f64) -> Option<Self> {
        let pinhole = Homography::fitted(rows)?.elements().chain([0.0; 3]);
        let mut view = Self { unknowns: SVector::from_iterator(pinhole) };
        let mut omega = view.omega(rows)?;
        let mut damping = DAMPING;
        for _ in 0..STEPS {
            let (normal, side) = view.normal(rows)?;
            let damped = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::from_fn(|i, j| {
                if i == j { normal[(i, j)] * (1.0 + damping) + f64::EPSILON } else { normal[(i, j)] }
            });
            let next = damped.cholesky().map(|factor| Self { unknowns: view.unknowns + factor.solve(&side) });
            match next.and_then(|next| Some((next.omega(rows)?, next))) {
                Some((better, next)) if better <= omega => {
                    let gain = omega - better;
                    (view, omega, damping) = (next, better, 0.1 * damping);
                    if gain <= GAIN * omega {
                        break;
                    }
                }
                _ => damping *= 10.0,
            }
        }
        let rms = scale * (omega / rows.len() as f64).sqrt();
        (rms <= OFF).then_some(view)
    }

    fn direction(&self, [u, v]: Point) -> [f64; 3] {
        [0, 1, 2].map(|row| self.unknowns[3 * row] * u + self.unknowns[3 * row + 1] * v + self.unknowns[3 * row + 2])
    }

    /// The lens at a distance from the middle, and how that changes with it.
    fn lens(&self, r: f64) -> (f64, f64) {
        let ([a, b, c], square) = ([9, 10, 11].map(|i| self.unknowns[i]), r * r);
        (1.0 + square * (a + square * (b + square * c)), r * (2.0 * a + square * (4.0 * b + 6.0 * square * c)))
    }

    fn residuals(&self, (at, position): &(Point, Point)) -> Option<Residuals> {
        let [x, y, z] = self.direction(*at);
        let (rho, r) = (x.hypot(y), distance(*position, [x, y]));
        let (w, slope) = self.lens(r);
        let divisor = z - rho * slope;
        let (across, along) = ((position[0] * y - position[1] * x) / rho, (r * z - rho * w) / divisor);
        let place = [at[0], at[1], 1.0];
        let mut derivatives = [SVector::zeros(); 2];
        let by = [
            [(-position[1] - across * x / rho) / rho, (position[0] - across * y / rho) / rho, 0.0],
            [-w * x / (rho * divisor), -w * y / (rho * divisor), r / divisor],
        ];
        for (derivatives, by) in derivatives.iter_mut().zip(by) {
            for (row, by) in by.into_iter().enumerate() {
                place.into_iter().enumerate().for_each(|(column, value)| derivatives[3 * row + column] = by * value);
            }
        }
        (1..4).for_each(|power| derivatives[1][8 + power as usize] = -rho * r.powi(2 * power) / divisor);
        (across.is_finite() && along.is_finite()).then_some(Residuals { values: [across, along], derivatives })
    }

    fn omega(&self, rows: &[(Point, Point)]) -> Option<f64> {
        rows.iter().map(|row| self.residuals(row).map(|residuals| residuals.values.iter().map(|value| value * value).sum::<f64>())).sum()
    }

    fn normal(&self, rows: &[(Point, Point)]) -> Option<(SMatrix<f64, UNKNOWNS, UNKNOWNS>, SVector<f64, UNKNOWNS>)> {
        let (mut normal, mut side) = (SMatrix::zeros(), SVector::zeros());
        for row in rows {
            let Residuals { values, derivatives } = self.residuals(row)?;
            for (value, derivative) in values.into_iter().zip(derivatives) {
                normal += derivative * derivative.transpose();
                side -= derivative * value;
            }
        }
        Some((normal, side))
    }

    /// Where a place of the board is imaged, near a distance from the middle.
    fn image(&self, at: Point, near: f64) -> Option<Point> {
        let [x, y, z] = self.direction(at);
        let (rho, mut r) = (x.hypot(y), near);
        for _ in 0..20 {
            let (w, slope) = self.lens(r);
            let step = (r * z - rho * w) / (z - rho * slope);
            r -= step;
            if step.abs() < 1e-14 {
                break;
            }
        }
        let position = [r * x / rho, r * y / rho];
        position.iter().all(|part| part.is_finite()).then_some(position)
    }

    /// At a place that is seen at `position`, by differences over `step`; `scale`: px to a unit of the image.
    fn warp(&self, [u, v]: Point, position: Point, (step, scale): (f64, f64)) -> Option<Warp> {
        let [x, y, _] = self.direction([u, v]);
        let near = distance(position, [x, y]);
        let mut around = [[[0.0; 2]; 3]; 3];
        for (i, column) in around.iter_mut().enumerate() {
            for (j, there) in column.iter_mut().enumerate() {
                let [i, j] = [i, j].map(|place| place as f64 - 1.0);
                *there = times(self.image([u + i * step, v + j * step], near)?, scale);
            }
        }
        let [[before_both, before_u, mixed], [before_v, here, after_v], [other_mixed, after_u, after_both]] = around;
        let slope = |before: Point, after: Point| times(minus(after, before), 0.5);
        let bend = |before: Point, after: Point| minus(minus(after, here), minus(here, before));
        let twist = times(minus(minus(after_both, mixed), minus(other_mixed, before_both)), 0.25);
        Warp::of_derivatives(
            [slope(before_u, after_u), slope(before_v, after_v)],
            [bend(before_u, after_u), twist, bend(before_v, after_v)],
        )
    }
}

/// How far a position is from the middle on the side of a direction, or, negative, on the other.
fn distance(position: Point, direction: Point) -> f64 {
    length(position).copysign(dot(position, direction))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A board in the middle of a fisheye and beyond, half of it on each side.
    fn view() -> View {
        View { unknowns: SVector::from([0.9, 0.1, -0.2, -0.15, 0.8, 0.1, 0.3, -0.2, 0.7, -0.6, 0.1, 0.05]) }
    }

    #[test]
    fn residuals_vanish_where_the_lens_images_a_place_and_their_derivatives_are_differences() {
        let view = view();
        for at in [[0.7, 0.2], [-0.5, 0.6], [0.1, -0.9], [0.2, -0.1]] {
            let position = view.image(at, 0.4).unwrap();
            let found = view.residuals(&(at, position)).unwrap();
            assert!(found.values.iter().all(|value| value.abs() < 1e-12), "{at:?}: {:?}", found.values);
            for unknown in 0..UNKNOWNS {
                let step = 1e-6;
                let at_step = |step: f64| {
                    let mut moved = view.unknowns;
                    moved[unknown] += step;
                    View { unknowns: moved }.residuals(&(at, position)).unwrap().values
                };
                let (before, after) = (at_step(-step), at_step(step));
                for axis in 0..2 {
                    let difference = (after[axis] - before[axis]) / (2.0 * step);
                    let found = found.derivatives[axis][unknown];
                    assert!((found - difference).abs() < 1e-7, "{at:?} {unknown} {axis}: {found} {difference}");
                }
            }
        }
    }

    #[test]
    fn on_the_other_side_of_the_middle_a_distance_is_negative() {
        let (view, at) = (view(), [0.7, 0.2]);
        let position = view.image(at, 0.4).unwrap();
        let [seen, turned] = [position, times(position, -1.0)].map(|position| view.residuals(&(at, position)).unwrap().values[1]);
        assert!(seen.abs() < 1e-12 && turned.abs() > 0.1, "{seen} {turned}");
    }
}
