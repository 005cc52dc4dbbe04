//! Which points hold the frame of a free network.

use nalgebra::{Point3, Vector3};

/// The two horizontal and the three vertical control points: far from each other. Places in `points`; `None` where all lie on a line.
pub fn held(points: &[Point3<f64>]) -> Option<([usize; 2], [usize; 3])> {
    let middle = points.iter().map(|point| point.coords).sum::<Vector3<f64>>() / points.len().max(1) as f64;
    let farthest = |from: &dyn Fn(&Point3<f64>) -> f64| {
        (0..points.len()).map(|i| (from(&points[i]), i)).max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))
    };
    let (_, a) = farthest(&|point| (point.coords - middle).norm())?;
    let (length, b) = farthest(&|point| (point - points[a]).norm())?;
    let along = (points[b] - points[a]).try_normalize(0.0)?;
    let (across, c) = farthest(&|point| (point - points[a]).cross(&along).norm())?;
    (across > 1e-3 * length).then_some(([a, b], [a, b, c]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_the_longest_distance_and_what_lies_farthest_beside_it() {
        let points = [[0.0, 0.0], [9.0, 8.0], [1.0, 9.0], [-1.0, -2.0], [4.0, 1.0]].map(|[x, y]| Point3::new(x, y, 0.0));
        assert_eq!(held(&points), Some(([1, 3], [1, 3, 2])));
        assert_eq!(held(&[0.0, 1.0, 5.0].map(|x| Point3::new(x, 2.0 * x, 0.0))), None);
        assert_eq!(held(&[]), None);
    }
}
