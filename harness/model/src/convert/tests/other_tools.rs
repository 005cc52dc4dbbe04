//! Models of other tools: which are the same, and which are fitted.

use super::super::{ConvertOptions, Method, Region, Target, convert, fit};
use super::{SIZE, mild, opencv};
use crate::PixelPoint;
use crate::camera::{
    Agisoft, AgisoftVersion, Camera, CameraModel, DoubleSphere, Eucm, Fov, MicMac, Omni, OpenCv, OpenCvFisheye, PrismFisheye,
    RadTanPrismFisheye, Splined,
};

const CENTRE: [f64; 2] = [690.0, 500.0];

fn wide() -> Vec<Camera> {
    let [cx, cy] = CENTRE;
    let (fx, fy) = (420.0, 421.0);
    vec![
        DoubleSphere { size: SIZE, fx, fy, cx, cy, xi: -0.2, alpha: 0.58 }.into(),
        Eucm { size: SIZE, fx, fy, cx, cy, alpha: 0.6, beta: 1.1 }.into(),
        Omni { size: SIZE, fx: 1100.0, fy: 1101.0, cx, cy, xi: 1.3, k: [0.0; 2], p: [0.0; 2] }.into(),
        OpenCvFisheye { size: SIZE, fx, fy, cx, cy, skew: 0.0, k: [-0.02, 0.003, -0.001, 1e-4] }.into(),
        PrismFisheye { size: SIZE, fx, fy, cx, cy, k: [-0.01, 0.002, 0.0, 0.0], p: [0.0; 2], s: [0.0; 2] }.into(),
    ]
}

/// The largest distance of the images of one camera's rays, px.
fn apart(a: &Camera, b: &Camera) -> f64 {
    let places = (0..9).flat_map(|x| (0..7).map(move |y| (x, y)));
    let off = |(x, y)| {
        let at = PixelPoint::new(f64::from(SIZE.width - 1) * f64::from(x) / 8.0, f64::from(SIZE.height - 1) * f64::from(y) / 6.0);
        b.project(a.unproject(at).unwrap()).unwrap().distance(at)
    };
    places.map(off).fold(0.0, f64::max)
}

fn exactly(source: Camera, target: Target) -> Camera {
    assert!(target.is_exact_for(&source), "{source:?} {target:?}");
    let found = convert(&source, target, &ConvertOptions::default()).unwrap();
    assert_eq!(found.method, Method::Exact);
    let off = apart(&source, &found.camera);
    assert!(off < 1e-8, "{off} px from {source:?} to {:?}", found.camera);
    found.camera
}

#[test]
fn the_unified_camera_has_three_names() {
    let [cx, cy] = CENTRE;
    let omni = Omni { size: SIZE, fx: 1100.0, fy: 1101.0, cx, cy, xi: 1.3, k: [0.0; 2], p: [0.0; 2] };
    for target in [Target::Eucm, Target::DoubleSphere] {
        let there = exactly(omni.into(), target);
        let Camera::Omni(back) = exactly(there, Target::Omni { distortion: false }) else { panic!() };
        assert!((back.xi - omni.xi).abs() < 1e-14 && (back.fx - omni.fx).abs() < 1e-11);
    }
    exactly(exactly(omni.into(), Target::Eucm), Target::DoubleSphere);
    let sphere = DoubleSphere { size: SIZE, fx: 900.0, fy: 901.0, cx, cy, xi: 0.4, alpha: 0.0 };
    exactly(sphere.into(), Target::Omni { distortion: true });
    // With distortion there is one name alone.
    let distorted = Camera::from(Omni { k: [-0.1, 0.0], ..omni });
    assert!(!Target::Eucm.is_exact_for(&distorted) && !Target::Omni { distortion: false }.is_exact_for(&distorted));
    assert!(Target::Omni { distortion: true }.is_exact_for(&distorted));
}

#[test]
fn a_pinhole_is_a_unified_camera_and_back() {
    let pinhole = Camera::from(opencv(4, &[]));
    for target in [Target::Eucm, Target::DoubleSphere, Target::Omni { distortion: true }, Target::Centred { radial: 0 }] {
        if matches!(target, Target::Centred { .. }) {
            assert!(!target.is_exact_for(&pinhole));
            continue;
        }
        let there = exactly(pinhole, target);
        assert_eq!(exactly(there, Target::OpenCv { coefficients: 4 }), pinhole);
    }
    let four = Camera::from(opencv(4, &[-0.06, 0.02, 4e-4, -1.5e-3]));
    assert_eq!(exactly(exactly(four, Target::Omni { distortion: true }), Target::OpenCv { coefficients: 4 }), four);
}

#[test]
fn fisheyes_with_and_without_prism_are_the_same() {
    let [cx, cy] = CENTRE;
    let fisheye = OpenCvFisheye { size: SIZE, fx: 420.0, fy: 421.0, cx, cy, skew: 0.0, k: [-0.02, 0.003, -0.001, 1e-4] };
    assert_eq!(exactly(exactly(fisheye.into(), Target::PrismFisheye), Target::OpenCvFisheye), fisheye.into());
    assert!(!Target::PrismFisheye.is_exact_for(&OpenCvFisheye { skew: 1e-3, ..fisheye }.into()));
}

#[test]
fn micmac_s_pixels_become_numbers() {
    let [x, y] = CENTRE;
    let (k, p) = ([-3e-8, 4e-15, 1e-22, 0.0, 0.0], [2e-7, -5e-7]);
    let micmac = MicMac { size: SIZE, f: 1500.0, pp: [x, y], offset: [0.0; 2], k, p, b: [0.0; 2] };
    let there = exactly(micmac.into(), Target::OpenCv { coefficients: 5 });
    let back = exactly(there, Target::MicMac { radial: 3, tangential: true, affinity: false });
    assert!(apart(&micmac.into(), &back) < 1e-8);
    exactly(micmac.into(), Target::metashape());
    for other in [MicMac { offset: [1.0, 0.0], ..micmac }, MicMac { b: [1e-3, 0.0], ..micmac }] {
        assert!(!Target::metashape().is_exact_for(&other.into()));
        let found = convert(&other.into(), Target::metashape(), &ConvertOptions::default()).unwrap();
        assert_eq!(found.method, Method::Fitted);
        assert!(!Target::MicMac { radial: 5, tangential: true, affinity: false }.is_exact_for(&other.into()));
        assert_eq!(exactly(other.into(), Target::MicMac { radial: 5, tangential: true, affinity: true }), other.into());
    }
    // Two focal lengths are b1 of a fit, skew b2.
    let skewed = Camera::from(Agisoft {
        version: AgisoftVersion::Metashape,
        size: SIZE,
        f: 1500.0,
        cx: 8.0,
        cy: -6.0,
        b1: 2.0,
        b2: 0.7,
        k: [-0.05, 0.01, 0.0, 0.0],
        p: [3e-4, -2e-4, 0.0, 0.0],
    });
    let fitted = |affinity| convert(&skewed, Target::MicMac { radial: 5, tangential: true, affinity }, &ConvertOptions::default());
    assert!(fitted(false).is_err() || fitted(false).unwrap().residual.max_px > 0.1);
    assert!(fitted(true).unwrap().residual.max_px < 0.01);
    // A fifth radial coefficient and two focal lengths have no place on either side.
    assert!(!Target::metashape().is_exact_for(&MicMac { k: [0.0, 0.0, 0.0, 0.0, 1e-36], ..micmac }.into()));
    let two = Camera::from(OpenCv { fy: 1501.0, ..opencv(5, &[0.1]) });
    assert!(!Target::MicMac { radial: 5, tangential: true, affinity: false }.is_exact_for(&two));
}

#[test]
fn what_is_centred_stays_centred() {
    let version = AgisoftVersion::Metashape;
    let camera = Agisoft { size: SIZE, version, f: 1500.0, cx: 0.0, cy: 0.0, b1: 0.0, b2: 0.0, k: [-0.1, 0.02, 0.0, 0.0], p: [0.0; 4] };
    assert_eq!(exactly(camera.into(), Target::Centred { radial: 2 }), camera.into());
    let found = convert(&mild(), Target::Centred { radial: 2 }, &ConvertOptions { accept: true, ..ConvertOptions::default() }).unwrap();
    let Camera::Agisoft(fitted) = found.camera else { panic!() };
    assert_eq!([fitted.cx, fitted.cy, fitted.b1, fitted.p[0], fitted.k[2]], [0.0; 5]);
    assert!(found.residual.max_px > 1.0);
    // A rotation stands in for the principal point.
    let options = ConvertOptions { accept: true, rotation: true, ..ConvertOptions::default() };
    let turned = convert(&mild(), Target::Centred { radial: 2 }, &options).unwrap();
    assert!(turned.residual.max_px < 0.5 * found.residual.max_px, "{:?} {:?}", turned.residual, found.residual);
}

#[test]
fn wide_cameras_are_fitted_by_each_other() {
    for source in wide() {
        for target in [
            Target::DoubleSphere,
            Target::Eucm,
            Target::Omni { distortion: true },
            Target::OpenCvFisheye,
            Target::PrismFisheye,
            Target::RadTanPrismFisheye,
        ] {
            // 80 degrees from the axis; beyond, towards the ends of their images, the models part.
            let options = ConvertOptions { region: Region::Radius { px: 560.0 }, columns: 21, ..ConvertOptions::default() };
            let found = convert(&source, target, &options).unwrap_or_else(|error| panic!("{source:?} {target:?}: {error}"));
            assert!(found.residual.max_px < 0.5, "{source:?} {target:?}: {:?}", found.residual);
        }
    }
    let [cx, cy] = CENTRE;
    let fov = Camera::from(Fov { size: SIZE, fx: 700.0, fy: 701.0, cx, cy, w: 0.8 });
    assert_eq!(exactly(fov, Target::Fov), fov);
    let options = ConvertOptions { accept: true, ..ConvertOptions::default() };
    let there = convert(&fov, Target::OpenCvFisheye, &options).unwrap();
    let back = convert(&there.camera, Target::Fov, &options).unwrap();
    assert!(apart(&fov, &back.camera) < 2.0 * there.residual.max_px + 1e-6, "{:?} {:?}", there.residual, back.residual);
}

#[test]
fn the_division_model_is_kept_and_fitted() {
    let [cx, cy] = CENTRE;
    let division = |beta| Camera::from(Eucm { size: SIZE, fx: 900.0, fy: 901.0, cx, cy, alpha: 0.5, beta });
    for beta in [1.0, 0.3, -0.2] {
        assert_eq!(exactly(division(beta), Target::Division), division(beta));
    }
    assert!(Target::Eucm.is_exact_for(&division(0.3)) && !Target::Eucm.is_exact_for(&division(-0.2)));
    exactly(exactly(division(1.0), Target::Omni { distortion: false }), Target::Division);
    // Of a camera made of it by a fit it comes back.
    let options = ConvertOptions { accept: true, ..ConvertOptions::default() };
    let radial = convert(&division(0.3), Target::OpenCv { coefficients: 8 }, &options).unwrap();
    let back = convert(&radial.camera, Target::Division, &options).unwrap();
    let Camera::Eucm(found) = back.camera else { panic!() };
    assert!(
        found.alpha == 0.5 && (found.beta - 0.3).abs() < 1e-3 && apart(&division(0.3), &back.camera) < 0.01,
        "{found:?} {:?}",
        radial.residual
    );
}

#[test]
fn a_fisheye_then_prism_holds_opencv_s() {
    let [cx, cy] = CENTRE;
    let fisheye = OpenCvFisheye { size: SIZE, fx: 420.0, fy: 421.0, cx, cy, skew: 0.0, k: [-0.02, 0.003, -0.001, 1e-4] };
    let there = exactly(fisheye.into(), Target::RadTanPrismFisheye);
    assert!(matches!(there, Camera::RadTanPrismFisheye(RadTanPrismFisheye { k: [-0.02, 0.003, -0.001, 1e-4, 0.0, 0.0], .. })));
    assert!(!Target::RadTanPrismFisheye.is_exact_for(&OpenCvFisheye { skew: 1e-3, ..fisheye }.into()));
}

#[test]
fn splines_of_zero_are_stereographic() {
    let [cx, cy] = CENTRE;
    let control = vec![[0.0; 2]; 16 * 12];
    let spline = Splined { size: SIZE, core: [500.0, 501.0, cx, cy], order: 3, columns: 16, rows: 12, fov_x_deg: 160.0, control };
    let found = fit(&spline, Target::Eucm, &ConvertOptions::default()).unwrap();
    let Camera::Eucm(camera) = found.camera else { panic!() };
    assert!(found.residual.max_px < 1e-6, "{:?}", found.residual);
    assert!((camera.alpha - 0.5).abs() < 1e-6 && (camera.beta - 1.0).abs() < 1e-6 && (camera.fx - 500.0).abs() < 1e-4, "{camera:?}");
}
