//! Where splines picture a ray, and on which control points that depends.

use super::splined::{Splined, stereographic};
use super::{ImageSize, NoCounterpart, Ray};
use crate::PixelPoint;

/// The image of a ray under some splines, with what it depends on. It is linear in the control points.
#[derive(Clone, Copy, Debug)]
pub struct SplinedImage {
    /// The image.
    pub point: PixelPoint,
    /// Derivatives of x and y by the ray's own axes, px.
    pub by_ray: [[f64; 3]; 2],
    /// `u + D(u)`, numbers: the derivative of x by fx and that of y by fy.
    pub distorted: [f64; 2],
    columns: usize,
    order: usize,
    first: [usize; 2],
    along: [f64; 4],
    down: [f64; 4],
}

impl SplinedImage {
    /// The control points that the image depends on, by their place in [`Splined::control`], each with its share: with the control point x changes by fx times the share, and y by fy times it.
    pub fn control(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let each = (0..=self.order).flat_map(move |row| (0..=self.order).map(move |column| (row, column)));
        each.map(move |(row, column)| ((self.first[1] + row) * self.columns + self.first[0] + column, self.along[column] * self.down[row]))
    }
}

impl Splined {
    /// Splines without any distortion beyond the stereographic projection: all control points are zero.
    pub fn flat(size: ImageSize, core: [f64; 4], order: usize, [columns, rows]: [usize; 2], fov_x_deg: f64) -> Self {
        // What is too many is refused by `check`.
        let control = vec![[0.0; 2]; columns.saturating_mul(rows)];
        Self { size, core, order, columns, rows, fov_x_deg, control }
    }

    /// The image of a ray with its derivatives, wherever the splines may fold: what their adjustment goes through on its way.
    ///
    /// # Errors
    /// [`NoCounterpart::Behind`] of a ray that points backwards along the axis, or is none.
    pub fn picture(&self, ray: Ray) -> Result<SplinedImage, NoCounterpart> {
        let (u, by_u) = stereographic(ray)?;
        let per_u = self.per_u();
        let bases = self.bases(u, per_u);
        let (distorted, by) = self.map_by((u, per_u), &bases);
        let [along, down] = bases;
        Ok(SplinedImage {
            point: self.pixel(distorted),
            by_ray: [0, 1].map(|row| std::array::from_fn(|i| self.core[row] * (by[row][0] * by_u[0][i] + by[row][1] * by_u[1][i]))),
            distorted,
            columns: self.columns,
            order: self.order,
            first: [along.first, down.first],
            along: along.value,
            down: down.value,
        })
    }

    /// Columns and rows of cells of the grid: a piece of the splines each.
    pub const fn cells(&self) -> [usize; 2] {
        [self.columns - self.order, self.rows - self.order]
    }

    /// The cell of the grid, column and row, in which a ray lies; `None` where the grid does not reach.
    pub fn cell(&self, ray: Ray) -> Option<[usize; 2]> {
        let (u, _) = stereographic(ray).ok()?;
        let (before, cells) = (0.5 * (self.order - 1) as f64, self.cells());
        let at = self.grid(u, self.per_u()).map(|at| at - before);
        let inside = (0..2).all(|axis| at[axis] >= 0.0 && at[axis] <= cells[axis] as f64);
        inside.then(|| [0, 1].map(|axis| (at[axis] as usize).min(cells[axis] - 1)))
    }

    /// The horizontal field of view with which a grid of as many control points just reaches a ray, degrees; of one that points backwards 360.
    pub fn fov_for(&self, ray: Ray) -> f64 {
        let Ok(([x, y], _)) = stereographic(ray) else { return 360.0 };
        let [columns, rows] = self.cells().map(|cells| cells as f64);
        (4.0 * (0.5 * x.abs().max(y.abs() * columns / rows)).atan()).to_degrees()
    }

    /// Coordinates in the grid, whose first control point is at (0, 0).
    pub(super) fn grid(&self, [x, y]: [f64; 2], per_u: f64) -> [f64; 2] {
        let centre = |count: usize| 0.5 * (count - 1) as f64;
        [x * per_u + centre(self.columns), y * per_u + centre(self.rows)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::CameraModel;

    fn camera(order: usize) -> Splined {
        let size = ImageSize { width: 1600, height: 1200 };
        let mut camera = Splined::flat(size, [900.0, 905.0, 790.0, 610.0], order, [12, 9], 130.0);
        for (i, point) in camera.control.iter_mut().enumerate() {
            *point = [0.01 * (i as f64).sin(), 0.01 * (1.7 * i as f64).cos()];
        }
        camera
    }

    #[test]
    fn an_image_changes_with_its_control_points_as_they_say() {
        for (order, ray) in [2, 3].into_iter().flat_map(|order| [[0.0, 0.0], [0.4, -0.3], [-1.1, 0.6]].map(|at| (order, at))) {
            let (camera, ray) = (camera(order), Ray::from_tangent(ray[0], ray[1]));
            let image = camera.picture(ray).unwrap();
            assert!(image.point.distance(camera.project(ray).unwrap()) < 1e-12);
            let derivatives = camera.derivatives(ray).unwrap();
            assert_eq!(image.by_ray, derivatives.by_ray);
            let mut shares = vec![0.0; camera.control.len()];
            image.control().for_each(|(place, share)| shares[place] += share);
            for (place, share) in shares.into_iter().enumerate() {
                let moved = |by: f64| {
                    let mut camera = camera.clone();
                    (camera.control[place][0], camera.control[place][1]) =
                        (camera.control[place][0] + by, camera.control[place][1] - 2.0 * by);
                    camera.picture(ray).unwrap().point
                };
                let (after, before) = (moved(1e-3), moved(-1e-3));
                let slope = [(after.x - before.x) / 2e-3, (after.y - before.y) / 2e-3];
                assert!((slope[0] - 900.0 * share).abs() < 1e-7 && (slope[1] + 2.0 * 905.0 * share).abs() < 1e-7, "{order} {place}");
            }
        }
    }

    #[test]
    fn cells_end_where_the_grid_does() {
        let camera = camera(3);
        assert_eq!(camera.cells(), [9, 6]);
        // 65 degrees from the axis along x; along y 6 of 9 cells' half.
        let ray = |x: f64, y: f64| Ray::from_tangent(x.to_radians().tan(), y.to_radians().tan());
        assert_eq!((camera.cell(ray(64.9, 0.0)), camera.cell(ray(65.1, 0.0))), (Some([8, 3]), None));
        assert_eq!(camera.cell(ray(-64.9, 0.0)), Some([0, 3]));
        let most = 2.0 * (2.0 / 3.0 * 32.5_f64.to_radians().tan()).atan().to_degrees();
        assert!(camera.cell(ray(0.0, most - 0.1)).is_some() && camera.cell(ray(0.0, most + 0.1)).is_none());
        assert!((camera.fov_for(ray(65.0, 0.0)) - 130.0).abs() < 1e-9 && (camera.fov_for(ray(0.0, most)) - 130.0).abs() < 1e-9);
        assert_eq!(camera.cell(Ray { x: 0.0, y: 0.0, z: 1.0 }), None);
    }
}
