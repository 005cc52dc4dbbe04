//! The plane that a target's neighbours lie in.

use nalgebra::{Matrix3, Point3, Vector3};
use rstar::RTree;

/// Targets that make a plane: those of a regular grid around one, and itself.
const NEIGHBOURS: usize = 9;
/// Of them at least: a plane through three is not tested.
const FEWEST: usize = 4;
/// Least width of the neighbours, in lengths: of a line there is no plane.
const NARROW: f64 = 0.05;
/// Most thickness, in widths: a tenth is six degrees.
const THICK: f64 = 0.1;

/// Targets whose neighbours can be asked for.
pub(super) struct Neighbours(RTree<[f64; 3]>);

impl Neighbours {
    pub(super) fn new(points: impl Iterator<Item = Point3<f64>>) -> Self {
        Self(RTree::bulk_load(points.map(Into::into).collect()))
    }

    /// A normal of unit length of the plane through the targets nearest to a place, which they fit; `None` where they fit none.
    pub(super) fn normal(&self, at: &Point3<f64>) -> Option<Vector3<f64>> {
        let near = self.0.nearest_neighbor_iter([at.x, at.y, at.z]).take(NEIGHBOURS);
        let near: Vec<Vector3<f64>> = near.map(|near| Vector3::from(*near)).collect();
        if near.len() < FEWEST {
            return None;
        }
        let mean = near.iter().sum::<Vector3<f64>>() / near.len() as f64;
        let scatter = near.iter().fold(Matrix3::zeros(), |sum, point| sum + (point - mean) * (point - mean).transpose());
        let found = scatter.symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| found.eigenvalues[a].total_cmp(&found.eigenvalues[b]));
        let [thickness, width, length] = order.map(|axis| found.eigenvalues[axis].max(0.0).sqrt());
        (width > NARROW * length && thickness < THICK * width).then(|| found.eigenvectors.column(order[0]).into_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(z: impl Fn(f64, f64) -> f64) -> Vec<Point3<f64>> {
        (0..30).map(|i| (f64::from(i % 6), f64::from(i / 6))).map(|(x, y)| Point3::new(x, y, z(x, y))).collect()
    }

    #[test]
    fn the_normal_is_that_of_the_plane() {
        let points = grid(|x, y| 0.5 * x - 0.25 * y + 3.0);
        let neighbours = Neighbours::new(points.iter().copied());
        for point in &points {
            let normal = neighbours.normal(point).unwrap();
            let truth = Vector3::new(0.5, -0.25, -1.0).normalize();
            assert!(normal.cross(&truth).norm() < 1e-12, "{normal}");
        }
    }

    #[test]
    fn of_relief_a_line_or_three_points_there_is_no_plane() {
        let relief = grid(|x, y| 2.0 * ((1.7 * x).sin() + (2.3 * y).cos()));
        assert_eq!(Neighbours::new(relief.iter().copied()).normal(&relief[14]), None);
        let line: Vec<_> = (0..12).map(|i| Point3::new(f64::from(i), 2.0 * f64::from(i), 0.0)).collect();
        assert_eq!(Neighbours::new(line.iter().copied()).normal(&line[5]), None);
        let three = &grid(|_, _| 0.0)[4..7];
        assert_eq!(Neighbours::new(three.iter().copied()).normal(&three[0]), None);
    }
}
