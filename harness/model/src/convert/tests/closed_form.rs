//! Closed forms.

use proptest::prelude::*;

use super::super::{ConvertError, ConvertOptions, Method, Target, convert};
use super::{SIZE, mild, opencv, photogrammetric, values};
use crate::PixelPoint;
use crate::camera::{AgisoftVersion, Camera, CameraModel, Ebner, OpenCv, Photogrammetric, Ray, TangentialOrder};

fn exactly(source: &Camera, target: Target) -> Camera {
    let found = convert(source, target, &ConvertOptions::default()).unwrap();
    assert_eq!(found.method, Method::Exact, "{target:?}");
    found.camera
}

fn assert_same(a: &Camera, b: &Camera) {
    for (a, b) in a.parameters().iter().zip(b.parameters()) {
        assert!((a.value - b.value).abs() <= 1e-12 * a.value.abs().max(if a.unit == "px" { 1.0 } else { 0.0 }), "{a:?} {b:?}");
    }
}

fn assert_same_pixels(a: &Camera, b: &Camera) {
    for (x, y) in [(0.0, 0.0), (0.2, -0.15), (-0.3, 0.25), (0.35, 0.2)] {
        let ray = Ray::from_tangent(x, y);
        assert!(a.project(ray).unwrap().distance(b.project(ray).unwrap()) < 1e-9);
    }
}

fn pix4d(order: TangentialOrder) -> Target {
    Target::Pix4d { sensor_width_mm: 6.4, order }
}

fn agisoft(version: AgisoftVersion) -> Target {
    Target::Agisoft { version, radial: 3, tangential: 2, affinity: true }
}

proptest! {
    #[test]
    fn brown_cameras_come_back(
        (fx, ratio) in (800.0..4000.0f64, prop_oneof![Just(1.0), 0.99..1.01f64]),
        (cx, cy) in (600.0..750.0f64, 450.0..550.0f64),
        k in prop::array::uniform3(-0.1..0.1f64),
        p in prop::array::uniform2(-2e-3..2e-3f64),
    ) {
        let distortion = [k[0], k[1], p[0], p[1], k[2]];
        let camera = Camera::from(OpenCv { fx, fy: fx * ratio, cx, cy, ..opencv(5, &distortion) });
        let mut targets = vec![Target::metashape(), agisoft(AgisoftVersion::PhotoScan), agisoft(AgisoftVersion::Lens), Target::OpenCv { coefficients: 14 }];
        if ratio == 1.0 {
            targets.extend([pix4d(TangentialOrder::OpenCv), pix4d(TangentialOrder::Brown)]);
        }
        for target in targets {
            let there = exactly(&camera, target);
            assert_same_pixels(&camera, &there);
            assert_same(&camera, &exactly(&there, Target::OpenCv { coefficients: 5 }));
        }
    }

    #[test]
    fn a_pitch_comes_back(pitch_um in 1.0..10.0f64, k in prop::array::uniform3(-1.0..1.0f64)) {
        let camera = Camera::from(Photogrammetric { k: [k[0] * 1e-3, k[1] * 1e-5, k[2] * 1e-8], ..photogrammetric() });
        let there = exactly(&camera, Target::photogrammetric(pitch_um));
        assert_same_pixels(&camera, &there);
        assert_same(&camera, &exactly(&there, Target::photogrammetric(4.7)));
    }
}

#[test]
fn metashape_and_opencv_differ_as_their_exports_do() {
    // icepy4d's two exports of one adjustment: cx_cv = W/2 + cx - 1/2, p1 and p2 in the other order.
    let Camera::Agisoft(camera) = exactly(&mild(), Target::metashape()) else { panic!() };
    assert_eq!((camera.cx, camera.cy), (690.0 - 680.5, 500.0 - 510.0));
    assert_eq!((camera.p[0], camera.p[1], camera.f, camera.b1), (-1.5e-3, 4e-4, 1500.0, 0.0));
}

#[test]
fn structure_decides() {
    let method = |source: &Camera, target| {
        let options = ConvertOptions { accept: true, ..ConvertOptions::default() };
        convert(source, target, &options).unwrap().method
    };
    let rational = |k4: f64| Camera::from(opencv(8, &[-0.06, 0.02, 4e-4, -1.5e-3, -0.004, k4]));
    assert_eq!(method(&rational(0.0), Target::metashape()), Method::Exact);
    assert_eq!(method(&rational(1e-3), Target::metashape()), Method::Fitted);
    assert_eq!(method(&rational(1e-3), Target::OpenCv { coefficients: 14 }), Method::Exact);
    assert_eq!(method(&mild(), Target::OpenCv { coefficients: 4 }), Method::Fitted);
    assert_eq!(method(&mild(), Target::photogrammetric(4.7)), Method::Fitted);
    let other_scales = Camera::from(OpenCv { fy: 1501.0, ..opencv(4, &[-0.06]) });
    assert_eq!(method(&other_scales, Target::metashape()), Method::Exact);
    assert_eq!(method(&other_scales, pix4d(TangentialOrder::OpenCv)), Method::Fitted);
}

#[test]
fn a_camera_without_distortion_is_exact_across_directions() {
    let camera = Camera::from(Photogrammetric { k: [0.0; 3], p: [0.0; 2], ..photogrammetric() });
    let there = exactly(&camera, Target::metashape());
    assert_same_pixels(&camera, &there);
    for (a, b) in values(&camera).iter().zip(values(&exactly(&there, Target::photogrammetric(4.7)))) {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }
}

#[test]
fn ebner_takes_another_pitch_with_its_grid() {
    let base = Photogrammetric { k: [0.0; 3], p: [0.0; 2], b: [0.0; 2], ..photogrammetric() };
    let parameters = [1e-4, -2e-4, 1e-5, 2e-5, -3e-5, 1e-5, 2e-5, 1e-5, -1e-5, 2e-5, 1e-6, -1e-6];
    let camera = Camera::from(Ebner { base, b_mm: 2.0, parameters });
    let there = exactly(&camera, Target::Ebner { pitch_um: 9.4, b_mm: 4.0 });
    assert_same_pixels(&camera, &there);
    assert_same(&camera, &exactly(&there, Target::Ebner { pitch_um: 4.7, b_mm: 2.0 }));
    let other_grid = convert(&camera, Target::Ebner { pitch_um: 4.7, b_mm: 1.5 }, &ConvertOptions::default()).unwrap();
    assert_eq!(other_grid.method, Method::Fitted);
    assert!(other_grid.residual.max_px < 0.5, "{:?}", other_grid.residual);
}

#[test]
fn impossible_targets_say_why() {
    for target in [
        Target::photogrammetric(0.0),
        Target::Photogrammetric { pitch_um: 5.0, radial: 4, tangential: true, affinity: true },
        Target::OpenCv { coefficients: 6 },
        Target::Agisoft { version: AgisoftVersion::Lens, radial: 4, tangential: 2, affinity: true },
        Target::Ebner { pitch_um: 5.0, b_mm: f64::NAN },
        pix4d(TangentialOrder::Without),
    ] {
        assert!(matches!(convert(&mild(), target, &ConvertOptions::default()), Err(ConvertError::Target { .. })), "{target:?}");
    }
    assert!(mild().unproject(PixelPoint::new(f64::from(SIZE.width), 0.0)).is_ok());
}
