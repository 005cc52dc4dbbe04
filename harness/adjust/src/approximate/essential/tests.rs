use super::*;
use crate::approximate::tests::Chance;

/// Rays of five points in two cameras, and the essential matrix.
fn case(chance: &mut Chance) -> ([Vector3<f64>; 5], [Vector3<f64>; 5], Matrix3<f64>) {
    let (a, b) = (chance.pose(), chance.pose());
    let points: [_; 5] = std::array::from_fn(|_| chance.point());
    let rotation = b.rotation * a.rotation.transpose();
    let t = b.rotation * (a.centre - b.centre);
    let essential = t.cross_matrix() * rotation;
    (points.map(|p| a.camera_from_world(&p)), points.map(|p| b.camera_from_world(&p)), essential / essential.norm())
}

#[test]
fn the_truth_is_among_the_solutions_of_ten_thousand_samples() {
    let mut chance = Chance::new(81);
    let (mut errors, mut most) = (Vec::new(), 0);
    for _ in 0..10_000 {
        let (first, second, truth) = case(&mut chance);
        let found = essential_matrices(&first, &second);
        most = most.max(found.len());
        errors.push(found.iter().map(|e| (e - truth).norm().min((e + truth).norm())).fold(f64::INFINITY, f64::min));
    }
    errors.sort_by(f64::total_cmp);
    assert!(most <= 10, "{most}");
    assert!(
        errors[5_000] < 1e-11 && errors[9_900] < 1e-7,
        "{:e} {:e} {:e} {:e}",
        errors[5_000],
        errors[9_900],
        errors[9_990],
        errors[9_999]
    );
    let lost = errors.iter().filter(|error| **error > 1e-3).count();
    assert!(lost <= 2, "{lost}");
}

#[test]
fn every_solution_is_an_essential_matrix_of_the_five_pairs() {
    let mut chance = Chance::new(82);
    let (mut worst, mut count) = (Vec::new(), 0);
    for _ in 0..500 {
        let (first, second, _) = case(&mut chance);
        for e in essential_matrices(&first, &second) {
            let values = e.singular_values();
            let shape = (values[0] - values[1]).abs().max(values[2]);
            let product = |(a, b): (&Vector3<f64>, &Vector3<f64>)| b.normalize().dot(&(e * a.normalize())).abs();
            worst.push(first.iter().zip(&second).map(product).fold(shape, f64::max));
            count += 1;
        }
    }
    worst.sort_by(f64::total_cmp);
    assert!(count > 1000);
    assert!(worst[count / 2] < 1e-10 && worst[count * 98 / 100] < 1e-5, "{:e} {:e}", worst[count / 2], worst[count * 98 / 100]);
}

#[test]
fn the_motion_has_the_points_before_both_cameras() {
    let mut chance = Chance::new(83);
    for _ in 0..200 {
        let (first, second, essential) = case(&mut chance);
        let (rotation, t) = motion(&essential, &first.iter().zip(&second)).unwrap();
        assert!(
            ((t.cross_matrix() * rotation).normalize() - essential)
                .norm()
                .min(((t.cross_matrix() * rotation).normalize() + essential).norm())
                < 1e-9
        );
        for (a, b) in first.iter().zip(&second) {
            let [s, r] = distances(a, b, &t).unwrap();
            // Rays as long as the points are far: both are stretched by the same.
            let closing = ((rotation * a) * s + t - b * r).norm();
            let [s, r] = distances(&(rotation * a), b, &t).unwrap_or([s, r]);
            assert!(s > 0.0 && r > 0.0 && closing.is_finite());
            assert!(((rotation * a) * s + t - b * r).norm() < 1e-6 * t.norm().max(1.0));
        }
    }
}

#[test]
fn the_same_point_five_times_has_no_solution() {
    let (first, second, _) = case(&mut Chance::new(84));
    assert!(essential_matrices(&[first[0]; 5], &[second[0]; 5]).is_empty());
    let nothing = [Vector3::repeat(f64::NAN); 5];
    assert!(essential_matrices(&nothing, &second).is_empty());
}
