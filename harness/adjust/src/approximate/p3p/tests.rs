use super::*;
use crate::approximate::tests::{Chance, apart, lens, see};

fn rays_of(pose: &Pose, points: &[Point3<f64>; 3]) -> [Vector3<f64>; 3] {
    points.map(|point| pose.camera_from_world(&point))
}

/// The largest sine between the given rays and those to the points.
fn misfit(pose: &Pose, rays: &[Vector3<f64>; 3], points: &[Point3<f64>; 3]) -> f64 {
    let sine = |(ray, point): (&Vector3<f64>, &Point3<f64>)| {
        let n = pose.camera_from_world(point);
        if n.dot(ray) > 0.0 { n.cross(ray).norm() / (n.norm() * ray.norm()) } else { 2.0 }
    };
    rays.iter().zip(points).map(sine).fold(0.0, f64::max)
}

#[test]
fn the_truth_is_among_the_solutions_of_ten_thousand_triangles() {
    let mut chance = Chance::new(11);
    let (mut most, mut worst_fit, mut errors) = (0, 0.0_f64, Vec::new());
    for trial in 0..10_000 {
        let (pose, points) = (chance.pose(), std::array::from_fn(|_| chance.point()));
        let rays = rays_of(&pose, &points);
        let found = p3p(&rays, &points);
        most = most.max(found.len());
        found.iter().for_each(|found| worst_fit = worst_fit.max(misfit(found, &rays, &points)));
        let error = found.iter().map(|found| apart(found, &pose)).fold(f64::INFINITY, f64::min);
        assert!(error < 1e-4, "trial {trial}: {error:e} {}", found.len());
        errors.push(error);
    }
    errors.sort_by(f64::total_cmp);
    assert!(most <= 4, "{most}");
    assert!(worst_fit < 1e-10, "{worst_fit:e}");
    // Close to the danger cylinder a pose is as good as the root of the rounding; that is rare.
    assert!(errors[5_000] < 1e-13 && errors[9_900] < 1e-10, "{:e} {:e} {:e}", errors[5_000], errors[9_900], errors[9_999]);
}

#[test]
fn short_sides_and_near_double_solutions_are_solved() {
    let mut chance = Chance::new(14);
    let mut errors = Vec::new();
    for _ in 0..20_000 {
        let (pose, first, second) = (chance.pose(), chance.point(), chance.point());
        let points = [first, second, second + chance.vector() * 0.05];
        let rays = rays_of(&pose, &points);
        let found = p3p(&rays, &points);
        let error = found.iter().map(|found| apart(found, &pose)).fold(f64::INFINITY, f64::min);
        errors.push(error);
    }
    errors.sort_by(f64::total_cmp);
    assert!(errors[10_000] < 1e-11 && errors[19_980] < 1e-7, "{:e} {:e}", errors[10_000], errors[19_980]);
    // A double solution is as good as the root of the rounding, and may be lost: one in twenty thousand of these.
    assert!(errors[19_998] < 1e-2, "{:?}", &errors[19_990..]);
}

/// Grunert's quartic, through other eliminations and another root finder's degree, has as many positive solutions.
#[test]
fn as_many_solutions_as_grunerts_quartic() {
    let mut chance = Chance::new(12);
    let mut differing = 0;
    for _ in 0..2_000 {
        let (pose, points) = (chance.pose(), std::array::from_fn(|_| chance.point()));
        let rays = rays_of(&pose, &points);
        differing += usize::from(p3p(&rays, &points).len() != grunert(&rays, &points));
    }
    // Double roots are told apart differently.
    assert!(differing <= 4, "{differing}");
}

/// The number of positive solutions of Grunert's quartic in v = s3 / s1, as in Haralick et al. 1994.
fn grunert(rays: &[Vector3<f64>; 3], points: &[Point3<f64>; 3]) -> usize {
    let square = |i: usize, j: usize| (points[i] - points[j]).norm_squared();
    let cosine = |i: usize, j: usize| rays[i].normalize().dot(&rays[j].normalize());
    let (a2, b2, c2) = (square(1, 2), square(0, 2), square(0, 1));
    let (ca, cb, cg) = (cosine(1, 2), cosine(0, 2), cosine(0, 1));
    let (d, s) = ((a2 - c2) / b2, (a2 + c2) / b2);
    let quartic = [
        (1.0 + d).powi(2) - 4.0 * a2 / b2 * cg * cg,
        4.0 * (-d * (1.0 + d) * cb + 2.0 * a2 / b2 * cg * cg * cb - (1.0 - s) * ca * cg),
        2.0 * (d * d - 1.0 + 2.0 * d * d * cb * cb + 2.0 * (b2 - c2) / b2 * ca * ca - 4.0 * s * ca * cb * cg
            + 2.0 * (b2 - a2) / b2 * cg * cg),
        4.0 * (d * (1.0 - d) * cb - (1.0 - s) * ca * cg + 2.0 * c2 / b2 * ca * ca * cb),
        (d - 1.0).powi(2) - 4.0 * c2 / b2 * ca * ca,
    ];
    let u = |v: f64| ((d - 1.0) * v * v - 2.0 * d * cb * v + 1.0 + d) / (2.0 * (cg - v * ca));
    real_roots(&quartic).into_iter().filter(|&v| v > 0.0 && u(v) > 0.0).count()
}

#[test]
fn symmetric_triangles_and_pictures_are_solved() {
    let triangle = [0.0, 1.0, 2.0].map(|i: f64| {
        let (s, c) = (i * std::f64::consts::TAU / 3.0).sin_cos();
        Point3::new(c, s, 0.0)
    });
    for height in [0.5, 1.0, 3.0, 40.0] {
        let pose = Pose { rotation: Matrix3::identity(), centre: Point3::new(0.0, 0.0, height) };
        let rays = rays_of(&pose, &triangle);
        let found = p3p(&rays, &triangle);
        let error = found.iter().map(|found| apart(found, &pose)).fold(f64::INFINITY, f64::min);
        assert!(error < 1e-6, "{height}: {error:e}");
        assert!(found.iter().all(|found| misfit(found, &rays, &triangle) < 1e-9));
    }
}

#[test]
fn a_lens_is_taken_into_account_and_bad_points_are_named() {
    let mut chance = Chance::new(13);
    let (camera, pose, points) = (lens(), chance.pose(), chance.points(3));
    let control = [0, 1, 2].map(|i| Control { object: points[i], image: see(&camera, &pose, &points[i]) });
    let found = poses_of_three(&camera, &control).unwrap();
    assert!(found.iter().any(|found| apart(found, &pose) < 1e-9));
    let line = [0.0, 1.0, 2.0].map(|t| Control { object: Point3::new(t, 2.0 * t, -t), ..control[0] });
    assert_eq!(poses_of_three(&camera, &line), Err(ApproximateError::Collinear));
    let mut broken = control;
    broken[1].image.x = f64::NAN;
    assert_eq!(poses_of_three(&camera, &broken), Err(ApproximateError::NotFinite { index: 1 }));
    let same = [control[0].image; 3];
    let nowhere = [0, 1, 2].map(|i| Control { image: same[i], ..control[i] });
    assert_eq!(poses_of_three(&camera, &nowhere), Ok(Vec::new()));
}
