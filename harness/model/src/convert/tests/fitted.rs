//! Fits over the frame.

use super::super::fit::{Problem, State};
use super::super::grid::sights;
use super::super::{Conversion, ConvertError, ConvertOptions, Method, Region, Rotation, Target, Verdict, convert};
use super::{SIZE, mild, opencv, photogrammetric, values};
use crate::PixelPoint;
use crate::camera::{Camera, CameraModel, OpenCvFisheye, fold};

const PITCH: f64 = 4.7;

fn fit(source: &Camera, target: Target, options: &ConvertOptions) -> Conversion {
    let found = convert(source, target, options).unwrap();
    assert_eq!(found.method, Method::Fitted);
    found
}

#[test]
fn a_known_camera_is_found() {
    let truth = Camera::from(photogrammetric());
    let target = Target::photogrammetric(PITCH);
    let sights = sights(&truth, Region::Frame, 41).unwrap();
    let free = target.free(&truth);
    let turn = Rotation::from_vector([0.01, -0.02, 0.03]);
    let turned: Vec<_> = sights.iter().map(|s| super::super::grid::Sight { ray: turn.apply(s.ray), ..*s }).collect();
    let problem = Problem { sights: &turned, free: &free, rotation: true };
    let start = State { camera: target.plain(&truth).unwrap(), rotation: Rotation::identity() };
    let found = problem.solve(start).unwrap();
    assert!(problem.cost(&found).unwrap().sqrt() < 1e-9);
    for (found, truth) in values(&found.camera).iter().zip(values(&truth)) {
        assert!((found - truth).abs() < 1e-6 * truth.abs(), "{found} {truth}");
    }
    let left = [0.01, -0.02, 0.03].iter().zip(found.rotation.vector()).map(|(a, b)| (a + b).abs()).fold(0.0, f64::max);
    assert!(left < 1e-9, "{left:e}");
}

#[test]
fn residuals_are_those_between_the_nodes() {
    let source = mild();
    let found = fit(&source, Target::photogrammetric(PITCH), &ConvertOptions::default());
    assert_eq!(found.verdict, Verdict::Warning, "{:?}", found.residual);
    let (mut sum, mut max, count) = (0.0, 0.0_f64, 211 * 157);
    for i in 0..211 {
        for j in 0..157 {
            let point = PixelPoint::new((f64::from(i) + 0.5) * 1361.0 / 211.0, (f64::from(j) + 0.5) * 1020.0 / 157.0);
            let off = found.camera.project(source.unproject(point).unwrap()).unwrap().distance(point);
            sum += off * off;
            max = max.max(off);
        }
    }
    let rms = (sum / f64::from(count)).sqrt();
    assert!((rms / found.residual.rms_px - 1.0).abs() < 0.02, "{rms} {:?}", found.residual);
    assert!(max <= found.residual.max_px && max > 0.8 * found.residual.max_px, "{max} {:?}", found.residual);
}

#[test]
fn a_denser_grid_changes_nothing() {
    let source = Camera::from(opencv(5, &[-0.25, 0.12, 4e-4, -1.5e-3, -0.03]));
    let options = ConvertOptions { accept: true, ..ConvertOptions::default() };
    let found = fit(&source, Target::photogrammetric(PITCH), &options);
    let dense = fit(&source, Target::photogrammetric(PITCH), &ConvertOptions { columns: 81, ..options });
    assert!((found.residual.rms_px / dense.residual.rms_px - 1.0).abs() < 0.01, "{:?} {:?}", found.residual, dense.residual);
    let moved = |point| found.camera.project(dense.camera.unproject(point).unwrap()).unwrap().distance(point);
    let most = [(0.0, 0.0), (700.0, 30.0), (1361.0, 1020.0), (300.0, 800.0)].map(|(x, y)| moved(PixelPoint::new(x, y)));
    assert!(most.iter().all(|off| *off < 0.1 * dense.residual.max_px), "{most:?} {:?}", dense.residual);
}

#[test]
fn thresholds_judge() {
    let strong = Camera::from(opencv(5, &[-0.3, 0.12, 0.0, 0.0, -0.03]));
    let target = Target::Photogrammetric { pitch_um: PITCH, radial: 1, tangential: false, affinity: false };
    let options = ConvertOptions::default();
    assert!(matches!(convert(&strong, target, &options), Err(ConvertError::Residual { max_px, .. }) if max_px > 0.5));
    let weak = Camera::from(opencv(4, &[-0.02, 0.003, 1e-4, -2e-4]));
    assert_eq!(fit(&weak, Target::photogrammetric(PITCH), &options).verdict, Verdict::Good);
    let accepted = fit(&strong, target, &ConvertOptions { accept: true, ..options.clone() });
    assert_eq!(accepted.verdict, Verdict::Accepted);
    assert_eq!(&values(&accepted.camera)[4..], [0.0; 6]);
    let warned = fit(&strong, target, &ConvertOptions { error_px: 1e3, ..options });
    assert_eq!(warned.verdict, Verdict::Warning);
}

#[test]
fn a_fold_is_refused_for_the_frame_and_a_radius_before_it_is_not() {
    // x (1 - 0.9 r^2) turns round at r = 0.61, where x' = 0.41: 609 px; the corner is farther.
    let source = Camera::from(opencv(5, &[-0.9]));
    let edge = fold(&source).unwrap();
    let target = Target::photogrammetric(PITCH);
    let options = ConvertOptions { accept: true, ..ConvertOptions::default() };
    let refused = convert(&source, target, &options);
    assert_eq!(refused, Err(ConvertError::Fold { radius_px: edge.radius_px, share: edge.share }));
    assert!((edge.radius_px - 1500.0 * (1.0f64 / 2.7).sqrt() * 2.0 / 3.0).abs() < 1e-6 && edge.share > 0.05);
    let region = |px| ConvertOptions { region: Region::Radius { px }, ..options.clone() };
    let found = fit(&source, target, &region(400.0));
    assert_eq!(found.region, Region::Radius { px: 400.0 });
    assert!(found.residual.max_px < 0.5, "{:?}", found.residual);
    assert!(matches!(convert(&source, target, &region(700.0)), Err(ConvertError::Fold { .. })));
}

#[test]
fn a_rotation_only_helps() {
    let options = ConvertOptions { accept: true, ..ConvertOptions::default() };
    let target = Target::Photogrammetric { pitch_um: PITCH, radial: 3, tangential: false, affinity: false };
    let held = fit(&mild(), target, &options);
    let free = fit(&mild(), target, &ConvertOptions { rotation: true, ..options });
    assert_eq!(held.rotation.angle(), 0.0);
    assert!(free.rotation.angle() > 1e-4 && free.residual.rms_px <= held.residual.rms_px, "{:?} {:?}", held.residual, free.residual);
}

#[test]
fn other_families_are_reached() {
    let options = ConvertOptions { accept: true, ..ConvertOptions::default() };
    let centred = Camera::from(opencv(5, &[-0.06, 0.02]));
    let fisheye = fit(&centred, Target::OpenCvFisheye, &options);
    assert!(fisheye.residual.max_px < 0.05, "{:?}", fisheye.residual);
    let back = fit(&fisheye.camera, Target::OpenCv { coefficients: 8 }, &options);
    assert!(back.residual.max_px < 0.05, "{:?}", back.residual);
    let ebner = fit(&centred, Target::Ebner { pitch_um: PITCH, b_mm: 2.0 }, &options);
    assert!(ebner.residual.max_px > 0.05, "Ebner's have no radial distortion: {:?}", ebner.residual);
    let measured = Camera::from(photogrammetric());
    let metashape = fit(&measured, Target::metashape(), &options);
    assert!(metashape.residual.max_px < 0.05, "{:?}", metashape.residual);
}

#[test]
fn a_pinhole_cannot_picture_what_lies_behind() {
    let fisheye = OpenCvFisheye { size: SIZE, fx: 350.0, fy: 350.0, cx: 680.5, cy: 510.0, skew: 0.0, k: [0.0; 4] }.into();
    let options = ConvertOptions { accept: true, ..ConvertOptions::default() };
    let refused = convert(&fisheye, Target::OpenCv { coefficients: 5 }, &options);
    assert!(matches!(refused, Err(ConvertError::NotPictured { share }) if share > 0.1), "{refused:?}");
    let region = Region::Radius { px: 300.0 };
    fit(&fisheye, Target::OpenCv { coefficients: 8 }, &ConvertOptions { region, ..options });
}
