//! Lengths and volumes from measured points.

use std::collections::HashMap;

use calibench_model::{ControlRow, TestLength};

/// Fills in the lengths that were not measured otherwise: the distances between measured points of these names, in their unit.
pub fn fill(lengths: &mut [TestLength], points: &[ControlRow]) {
    let places: HashMap<&str, &[f64; 3]> = points.iter().map(|point| (point.target.as_str(), &point.position)).collect();
    for length in lengths.iter_mut().filter(|length| length.measured.is_none()) {
        let [a, b] = [0, 1].map(|end| places.get(length.targets[end].as_str()));
        length.measured = a.zip(b).map(|(a, b)| norm(between(a, b)));
    }
}

/// The largest distance between two points, in their unit: the diagonal of the box that they fill, whichever way its sides lie; 0 of fewer than two points.
pub fn extent(points: &[ControlRow]) -> f64 {
    let count = points.len().max(1) as f64;
    let centre = [0, 1, 2].map(|axis| points.iter().map(|point| point.position[axis]).sum::<f64>() / count);
    let mut outwards: Vec<(f64, &[f64; 3])> =
        points.iter().map(|point| (norm(between(&point.position, &centre)), &point.position)).collect();
    outwards.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut most = 0.0_f64;
    for (place, (radius, at)) in outwards.iter().enumerate() {
        for (other_radius, other) in &outwards[..place] {
            // Those that follow are nearer to the centre.
            if radius + other_radius <= most {
                break;
            }
            most = most.max(norm(between(at, other)));
        }
    }
    most
}

fn between(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

/// The length of a vector, as of the diagonal of a volume with these sides.
pub fn norm(sides: [f64; 3]) -> f64 {
    sides[0].hypot(sides[1]).hypot(sides[2])
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn lengths_are_distances_between_points_and_none_is_made_up() {
        let points = [ControlRow::new("a", [1.0, 1.0, 1.0]), ControlRow::new("b", [3.0, 4.0, 7.0]), ControlRow::new("c", [1.0, 1.0, 2.0])];
        let length = |from: &str, to: &str, measured| TestLength {
            line: "1".into(),
            targets: [from.into(), to.into()],
            calibrated: 7.0,
            sigma: 0.0,
            measured,
        };
        let mut lengths = [length("a", "b", None), length("a", "c", Some(0.9)), length("a", "d", None)];
        fill(&mut lengths, &points);
        assert_eq!(lengths.map(|length| length.measured), [Some(7.0), Some(0.9), None]);
    }

    /// Against every pair, of points that lie anyhow.
    #[test]
    fn the_extent_is_the_largest_of_all_distances() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        for count in [0, 1, 2, 3, 10, 200] {
            let mut draw = || random.random_range(-1.0..1.0);
            let points: Vec<ControlRow> = (0..count).map(|_| ControlRow::new("p", [5.0 * draw(), draw(), 100.0 + draw()])).collect();
            let pairs = points.iter().flat_map(|a| points.iter().map(|b| norm(between(&a.position, &b.position))));
            assert_eq!(extent(&points), pairs.fold(0.0, f64::max), "{count}");
        }
    }
}
