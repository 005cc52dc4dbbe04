//! mrcal's splined stereographic camera, to be read and fitted by another model.

use serde::{Deserialize, Serialize};

use super::newton::{self, ValueAndDerivatives, determinant};
use super::plane_map::{PlaneMap, first_fold, is_on_branch};
use super::{CameraModel, CameraParameter, DerivativeBuffer, ImageSize, NoCounterpart, Ray, Reframe, Resampling, Turn, named};
use crate::PixelPoint;

/// mrcal's `LENSMODEL_SPLINED_STEREOGRAPHIC`. Direction: **ideal to distorted**; y points down; the centre of the first pixel is (0, 0).
///
/// With the angle from the axis `theta` and the direction `e` of (X, Y) (x right, y down, z forward): `u = 2 tan(theta/2) e`,
/// `x = fx (u_x + D_x(u)) + cx`, `y = fy (u_y + D_y(u)) + cy`. D are uniform B-splines of order 2 or 3 over a grid of `columns` x `rows` control points
/// around the axis, whose spacing in u is `4 tan(fov/4) / (columns - order)`, where fov is the horizontal field of view.
///
/// It has hundreds of numbers and is no [`super::Camera`]: other tools cannot hold it. [`crate::convert::fit`] finds a camera that they can.
///
/// Source: mrcal's documentation, "mrcal splined lens models".
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Splined {
    /// Size of its images.
    pub size: ImageSize,
    /// fx, fy, cx, cy, px; the principal point from the centre of the first pixel, y down.
    pub core: [f64; 4],
    /// Order of the splines: 2 or 3.
    pub order: usize,
    /// Columns of control points.
    pub columns: usize,
    /// Rows of control points.
    pub rows: usize,
    /// Horizontal field of view that the grid spans, degrees.
    pub fov_x_deg: f64,
    /// Control points (D_x, D_y), x right, y down, numbers as u is; `columns` x `rows` of them, row by row from the top.
    pub control: Vec<[f64; 2]>,
}

const NAMES: [(&str, &str); 4] = [("fx", "px"), ("fy", "px"), ("cx", "px"), ("cy", "px")];
/// The largest |u| that is looked at where a grid reaches further: 160 degrees from the axis.
const WIDEST: f64 = 11.34;
const PLACES: usize = 400;

/// Values and derivatives of the basis at a grid coordinate, and the first control point that they belong to.
pub(super) struct Basis {
    pub(super) first: usize,
    pub(super) value: [f64; 4],
    slope: [f64; 4],
}

impl Basis {
    /// Where `at` is no number, values and slopes are none either.
    pub(super) fn new(order: usize, at: f64, count: usize) -> Self {
        // A cast takes what is no number to 0.
        let before = |place: f64| (place as usize).saturating_sub(1);
        if order == 2 {
            let middle = (at + 0.5).floor().clamp(1.0, (count - 2) as f64);
            let t = at - middle;
            let value = [(0.5 - t) * (0.5 - t) / 2.0, 0.75 - t * t, (0.5 + t) * (0.5 + t) / 2.0, 0.0];
            return Self { first: before(middle), value, slope: [t - 0.5, -2.0 * t, t + 0.5, 0.0] };
        }
        let left = at.floor().clamp(1.0, (count - 3) as f64);
        let t = at - left;
        let s = 1.0 - t;
        let value =
            [s * s * s / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0, (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0, t * t * t / 6.0];
        let slope = [-s * s / 2.0, (3.0 * t * t - 4.0 * t) / 2.0, -(3.0 * s * s - 4.0 * s) / 2.0, t * t / 2.0];
        Self { first: before(left), value, slope }
    }
}

impl Splined {
    /// Checked: an order of 2 or 3, more control points than that along each side and as many as given, a field of view below 360 degrees.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn check(&self) -> Result<(), String> {
        if ![2, 3].contains(&self.order) {
            return Err(format!("order {} of the splines; expected 2 or 3", self.order));
        }
        if self.columns.min(self.rows) <= self.order {
            return Err(format!("{} x {} control points; expected more than {} along each side", self.columns, self.rows, self.order));
        }
        if self.columns.checked_mul(self.rows) != Some(self.control.len()) {
            return Err(format!("expected {} x {} control points, found {}", self.columns, self.rows, self.control.len()));
        }
        if !(self.fov_x_deg > 0.0 && self.fov_x_deg < 360.0) {
            return Err(format!("a field of view of {} degrees; expected 0 to 360", self.fov_x_deg));
        }
        Ok(())
    }

    /// Control points to a unit of u.
    pub(super) fn per_u(&self) -> f64 {
        (self.columns - self.order) as f64 / (4.0 * (self.fov_x_deg.to_radians() / 4.0).tan())
    }

    /// How far the grid reaches from the axis in a direction, in u: beyond, mrcal has no splines but their last ones, extended.
    fn reach(&self, [x, y]: [f64; 2]) -> f64 {
        let half = |count: usize| 0.5 * (count - self.order) as f64 / self.per_u();
        (half(self.columns) / x.abs()).min(half(self.rows) / y.abs()).min(WIDEST)
    }

    /// Whether an image point lies in the frame, or nearly so.
    fn is_in_frame(&self, at: PixelPoint) -> bool {
        let within = |place: f64, side: u32| (-1.0..=f64::from(side)).contains(&place);
        within(at.x, self.size.width) && within(at.y, self.size.height)
    }

    pub(super) fn pixel(&self, [x, y]: [f64; 2]) -> PixelPoint {
        let [fx, fy, cx, cy] = self.core;
        PixelPoint::new(fx * x + cx, fy * y + cy)
    }
}

impl PlaneMap for Splined {
    fn map(&self, u: [f64; 2]) -> ValueAndDerivatives {
        let per_u = self.per_u();
        self.map_by((u, per_u), &self.bases(u, per_u))
    }
}

impl Splined {
    /// The bases along and down the grid at u, of [`Self::per_u`], whose tangent costs as much as they do.
    pub(super) fn bases(&self, u: [f64; 2], per_u: f64) -> [Basis; 2] {
        let [along, down] = self.grid(u, per_u);
        [Basis::new(self.order, along, self.columns), Basis::new(self.order, down, self.rows)]
    }

    /// The map at u with its bases there.
    pub(super) fn map_by(&self, ([ux, uy], per_u): ([f64; 2], f64), [along, down]: &[Basis; 2]) -> ValueAndDerivatives {
        let (mut value, mut by) = ([ux, uy], [[1.0, 0.0], [0.0, 1.0]]);
        for row in 0..=self.order {
            for column in 0..=self.order {
                let point = self.control[(down.first + row) * self.columns + along.first + column];
                for axis in 0..2 {
                    value[axis] += along.value[column] * down.value[row] * point[axis];
                    by[axis][0] += per_u * along.slope[column] * down.value[row] * point[axis];
                    by[axis][1] += per_u * along.value[column] * down.slope[row] * point[axis];
                }
            }
        }
        (value, by)
    }
}

/// The stereographic u (right, down) of a ray, with its derivatives by the ray's own axes.
pub(super) fn stereographic(ray: Ray) -> Result<([f64; 2], [[f64; 3]; 2]), NoCounterpart> {
    let [x, y, z] = [ray.x, -ray.y, -ray.z];
    let d = (x * x + y * y + z * z).sqrt();
    let under = d + z;
    if !under.is_finite() || under <= 1e-12 * d || d == 0.0 {
        return Err(NoCounterpart::Behind);
    }
    // 2 tan(theta/2) = 2 sin / (1 + cos): u = 2 (x, y) / (d + z).
    let u = [2.0 * x / under, 2.0 * y / under];
    let by_under = [x / d, y / d, z / d + 1.0];
    let signs = [1.0, -1.0, -1.0];
    let row = |axis: usize| std::array::from_fn(|i| signs[i] * (if i == axis { 2.0 } else { 0.0 } - u[axis] * by_under[i]) / under);
    Ok((u, [row(0), row(1)]))
}

impl CameraModel for Splined {
    fn size(&self) -> ImageSize {
        self.size
    }

    /// The four of the core; the control points are not among them.
    fn parameters(&self) -> Vec<CameraParameter> {
        named(&NAMES, &self.core)
    }

    fn with_parameters(&self, values: &[f64]) -> Self {
        Self { core: [values[0], values[1], values[2], values[3]], ..self.clone() }
    }

    fn project(&self, ray: Ray) -> Result<PixelPoint, NoCounterpart> {
        let (u, _) = stereographic(ray)?;
        if is_on_branch(self, u) { Ok(self.pixel(self.map(u).0)) } else { Err(NoCounterpart::Fold) }
    }

    fn unproject(&self, point: PixelPoint) -> Result<Ray, NoCounterpart> {
        let [fx, fy, cx, cy] = self.core;
        let goal = [(point.x - cx) / fx, (point.y - cy) / fy];
        if !(goal[0].is_finite() && goal[1].is_finite()) {
            return Err(NoCounterpart::NoSolution);
        }
        // Where the way from the origin's image fails, that from the goal itself may not: on the same branch alone.
        let from_goal = |why| match newton::solve(goal, goal, |at| self.map(at)) {
            Ok(found) if is_on_branch(self, found) => Ok(found),
            _ => Err(why),
        };
        let [ux, uy] = super::plane_map::invert(self, goal).or_else(from_goal)?;
        // The point of the unit sphere: (u, 1 - |u|^2/4) / (1 + |u|^2/4).
        let quarter = 0.25 * (ux * ux + uy * uy);
        Ok(Ray { x: ux / (1.0 + quarter), y: -uy / (1.0 + quarter), z: -(1.0 - quarter) / (1.0 + quarter) })
    }

    fn derivatives_into(&self, ray: Ray, into: &mut DerivativeBuffer) -> Result<(), NoCounterpart> {
        let (u, by_u) = stereographic(ray)?;
        if !is_on_branch(self, u) {
            return Err(NoCounterpart::Fold);
        }
        let (distorted, by) = self.map(u);
        into.clear();
        into.by_ray = [0, 1].map(|row| std::array::from_fn(|i| self.core[row] * (by[row][0] * by_u[0][i] + by[row][1] * by_u[1][i])));
        into.point = self.pixel(distorted);
        into.extend([[distorted[0], 0.0], [0.0, distorted[1]], [1.0, 0.0], [0.0, 1.0]]);
        Ok(())
    }

    fn fold_towards(&self, angle: f64) -> Option<PixelPoint> {
        let (sin, cos) = angle.sin_cos();
        let reach = self.reach([cos, sin]);
        let image = |s: f64| self.pixel(self.map([s * cos, s * sin]).0);
        // What the splines do once the image has left the frame says nothing of the frame.
        let leaves = (1..=PLACES).map(|place| reach * place as f64 / PLACES as f64).find(|&s| !self.is_in_frame(image(s)));
        let fold = first_fold(|s| determinant(self.map([s * cos, s * sin]).1), leaves.unwrap_or(reach), PLACES)?;
        Some(image(fold))
    }
}

impl Reframe for Splined {
    fn resampled(&self, by: &Resampling) -> Self {
        let [fx, fy, cx, cy] = self.core;
        let (at, [fx, fy]) = (by.point(PixelPoint::new(cx, cy)), by.lengths([fx, fy]));
        Self { size: by.size, core: [fx, fy, at.x, at.y], ..self.clone() }
    }

    /// The grid turns with the images: of rows that become columns the field of view is another one, and their spacing the same.
    fn turned(&self, turn: Turn) -> Self {
        let [fx, fy, cx, cy] = self.core;
        let (at, [fx, fy]) = (turn.point(self.size, PixelPoint::new(cx, cy)), turn.along([fx, fy]));
        let (columns, rows) = if turn.swaps_axes() { (self.rows, self.columns) } else { (self.columns, self.rows) };
        let spanned = (columns - self.order) as f64 / (4.0 * self.per_u());
        let fov_x_deg = if turn.swaps_axes() { (4.0 * spanned.atan()).to_degrees() } else { self.fov_x_deg };
        let before = |index: usize| {
            let (column, row) = (index % columns, index / columns);
            let (column, row) = match turn {
                Turn::Quarter => (row, self.rows - 1 - column),
                Turn::Half => (self.columns - 1 - column, self.rows - 1 - row),
                Turn::ThreeQuarters => (self.columns - 1 - row, column),
            };
            turn.vector(self.control[row * self.columns + column])
        };
        let control = (0..self.control.len()).map(before).collect();
        Self { size: turn.size(self.size), core: [fx, fy, at.x, at.y], columns, rows, fov_x_deg, control, ..self.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::conformance::{self, Shape};

    fn camera(order: usize) -> Splined {
        let (columns, rows) = (12, 9);
        let control = (0..columns * rows).map(|i| {
            let (x, y) = ((i % columns) as f64 - 5.5, (i / columns) as f64 - 4.0);
            [-4e-4 * x * (x * x + y * y) + 1e-3 * y, -4e-4 * y * (x * x + y * y) + 2e-3 * x.sin()]
        });
        let size = ImageSize { width: 1600, height: 1200 };
        Splined { size, core: [900.0, 905.0, 790.0, 610.0], order, columns, rows, fov_x_deg: 130.0, control: control.collect() }
    }

    #[test]
    fn conforms() {
        for order in [2, 3] {
            let camera = camera(order);
            camera.check().unwrap();
            conformance::check(&camera, Shape::Barrel);
        }
    }

    /// The last column of control points turns the image back, but only once it has left the frame.
    #[test]
    fn what_splines_do_outside_the_frame_is_no_fold_of_it() {
        let turned_back = |i: usize| if [0, 11].contains(&(i % 12)) { -0.3 * ((i % 12) as f64 - 5.5) } else { 0.0 };
        let control = (0..12 * 9).map(|i| [turned_back(i), 0.0]).collect();
        let wide = Splined { control, size: ImageSize { width: 1100, height: 500 }, core: [400.0, 400.0, 349.5, 249.5], ..camera(3) };
        let camera = Splined { size: ImageSize { width: 700, height: 500 }, ..wide.clone() };
        assert!(wide.fold_towards(0.0).is_some_and(|at| at.x > 700.0 && at.x < 1100.0), "{:?}", wide.fold_towards(0.0));
        assert_eq!((camera.fold_towards(0.0), crate::camera::fold(&camera)), (None, None));
        for [x, y] in [[0.0, 0.0], [699.0, 499.0], [0.0, 499.0], [350.0, 2.0]] {
            let ray = camera.unproject(PixelPoint::new(x, y)).unwrap();
            assert!(camera.project(ray).unwrap().distance(PixelPoint::new(x, y)) < 1e-9);
        }
    }

    #[test]
    fn control_points_on_a_plane_give_that_plane() {
        // B-splines reproduce linear functions: D = 0.03 g_x, -0.02 g_y of the grid coordinates from its middle.
        let mut camera = camera(3);
        camera.control = (0..12 * 9).map(|i| [0.03 * (f64::from(i % 12) - 5.5), -0.02 * (f64::from(i / 12) - 4.0)]).collect();
        let per_u = 9.0 / (4.0 * 32.5_f64.to_radians().tan());
        for u in [[0.0, 0.0], [0.3, -0.2], [-0.61, 0.44]] {
            let ([x, y], _) = camera.map(u);
            assert!((x - u[0] * (1.0 + 0.03 * per_u)).abs() < 1e-13 && (y - u[1] * (1.0 - 0.02 * per_u)).abs() < 1e-13);
        }
    }

    #[test]
    fn knots_of_any_size_are_no_panic() {
        let rays = [[0.0, 0.0], [0.1, -0.2], [2.0, 1.0]].map(|[x, y]| Ray::from_tangent(x, y));
        for (order, huge) in [2, 3].into_iter().flat_map(|order| [1e308, -1e308, f64::MIN_POSITIVE, f64::NAN].map(|huge| (order, huge))) {
            for place in 0..2 * 12 * 9 {
                let mut camera = camera(order);
                camera.control[place / 2][place % 2] = huge;
                for ray in rays {
                    let _ = (camera.project(ray), camera.derivatives(ray));
                }
                let _ = (camera.unproject(PixelPoint::new(0.0, 0.0)), camera.unproject(PixelPoint::new(1599.0, 600.0)));
            }
            let map = camera(order).map([huge * 10.0, f64::NAN]);
            assert!(map.0[1].is_nan());
        }
    }

    #[test]
    fn what_does_not_fit_together_is_refused() {
        for wrong in [
            Splined { order: 4, ..camera(3) },
            Splined { columns: 3, ..camera(3) },
            Splined { rows: 10, ..camera(3) },
            Splined { fov_x_deg: 360.0, ..camera(3) },
        ] {
            assert!(wrong.check().is_err(), "{wrong:?}");
        }
    }
}
