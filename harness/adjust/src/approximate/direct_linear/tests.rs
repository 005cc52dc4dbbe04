use super::*;
use crate::approximate::consensus::Tolerance;
use crate::approximate::tests::{Chance, SIZE, apart};

/// A camera with everything that the eleven parameters hold.
fn affine() -> Camera {
    Photogrammetric { size: SIZE, pitch_um: 5.15, c: 19.2, x0: 0.3, y0: -0.2, k: [0.0; 3], p: [0.0; 2], b: [3e-3, -2e-3] }.into()
}

fn interior(camera: &Photogrammetric) -> [f64; 5] {
    [camera.c, camera.x0, camera.y0, camera.b[0], camera.b[1]]
}

const TRUTH: [f64; 5] = [19.2, 0.3, -0.2, 3e-3, -2e-3];

#[test]
fn exact_points_give_the_exact_camera_and_pose() {
    let mut chance = Chance::new(51);
    for trial in 0..200 {
        let (pose, points) = (chance.pose(), chance.points(12));
        let control = chance.control(&affine(), &pose, &points, 0.0);
        let (camera, start) = linear(&control, &interior_from_data_sheet(SIZE, 5.15, 1.0).unwrap()).unwrap();
        let error = |found: &Photogrammetric| interior(found).iter().zip(TRUTH).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error(&camera) < 1e-6 && apart(&start, &pose) < 1e-6, "{trial}: {:e}", error(&camera));
        let found = direct_linear(&control, SIZE, 5.15, None).unwrap();
        assert!(error(&found.camera) < 1e-9 * 19.2 && apart(&found.pose, &pose) < 1e-9, "{trial}: {:e}", error(&found.camera));
        assert_eq!(found.redundancy, 13);
        assert!(found.sigma0.unwrap() < 1e-8 && found.rejected.is_empty());
    }
}

/// The other way: with the interior orientation given, the resection of the same points finds the pose within its standard deviations.
#[test]
fn the_resection_with_the_same_camera_agrees() {
    let mut chance = Chance::new(52);
    let (pose, points) = (chance.pose(), chance.points(40));
    let control = chance.control(&affine(), &pose, &points, 0.2);
    let found = direct_linear(&control, SIZE, 5.15, None).unwrap();
    let again = crate::approximate::resect(&found.camera.into(), &control, None).unwrap();
    assert!(apart(&again.pose, &found.pose) < 1e-8, "{:e}", apart(&again.pose, &found.pose));
    let sigma = found.sigma0.unwrap();
    assert!(sigma > 0.1 && sigma < 0.3, "{sigma}");
    for (i, (value, truth)) in interior(&found.camera).iter().zip(TRUTH).enumerate() {
        assert!((value - truth).abs() < 4.5 * sigma * found.cofactor[(i, i)].sqrt(), "{i}: {value} {truth}");
    }
}

#[test]
fn derivatives_are_differences() {
    let mut chance = Chance::new(53);
    let (pose, points) = (chance.pose(), chance.points(20));
    let control = chance.control(&affine(), &pose, &points, 1.0);
    let Camera::Photogrammetric(camera) = affine() else { unreachable!() };
    // The gradient of the squares is minus twice the right-hand side: a Gauss-Newton minimum has none.
    let found = direct_linear(&control, SIZE, 5.15, None).unwrap();
    let squares = |state: &Start| normal(state, &control).unwrap().squares;
    let least = squares(&(found.camera, found.pose));
    assert!(least < squares(&(camera, pose)));
    for i in 0..5 {
        let sigma = found.cofactor[(i, i)].sqrt();
        for step in [-0.01, 0.01] {
            let mut values: Vec<f64> = found.camera.parameters().iter().map(|p| p.value).collect();
            values[LINEAR[i]] += step * sigma;
            assert!(squares(&(found.camera.with_parameters(&values), found.pose)) > least);
        }
    }
}

#[test]
fn gross_errors_are_left_out() {
    let mut chance = Chance::new(54);
    let (pose, points) = (chance.pose(), chance.points(30));
    let mut control = chance.control(&affine(), &pose, &points, 0.1);
    for wrong in [4, 17, 23] {
        control[wrong].image.x += 40.0;
    }
    for tolerance in [Tolerance::Pixels(1.0), Tolerance::Unknown] {
        let search = Search { seed: 3, tolerance };
        let found = direct_linear(&control, SIZE, 5.15, Some(&search)).unwrap();
        assert!([4, 17, 23].iter().all(|wrong| found.rejected.contains(wrong)) && found.rejected.len() <= 4, "{:?}", found.rejected);
        assert!(apart(&found.pose, &pose) < 0.01);
        assert_eq!(direct_linear(&control, SIZE, 5.15, Some(&search)).unwrap(), found);
    }
}

#[test]
fn points_without_depth_are_named() {
    let mut chance = Chance::new(55);
    let pose = chance.pose();
    let flat: Vec<_> = chance.points(20).iter().map(|p| Point3::new(p.x, p.y, 0.3 * p.x + 0.2 * p.y)).collect();
    let control = chance.control(&affine(), &pose, &flat, 0.0);
    assert_eq!(direct_linear(&control, SIZE, 5.15, None), Err(ApproximateError::Coplanar));
    let line: Vec<_> = (0..8).map(|i| Point3::new(0.1 * f64::from(i), 0.0, 0.0)).collect();
    let control = chance.control(&affine(), &pose, &line, 0.0);
    assert_eq!(direct_linear(&control, SIZE, 5.15, None), Err(ApproximateError::Collinear));
    assert!(matches!(direct_linear(&control[..5], SIZE, 5.15, None), Err(ApproximateError::TooFew { needed: 6, found: 5, .. })));
    // A plane and one point beside it.
    let mut beside = flat;
    beside[0].z += 1.0;
    let control = chance.control(&affine(), &pose, &beside, 0.0);
    assert!(matches!(direct_linear(&control, SIZE, 5.15, None), Err(ApproximateError::Critical { .. })));
    assert_eq!(direct_linear(&control, SIZE, 0.0, None), Err(ApproximateError::DataSheet));
}
