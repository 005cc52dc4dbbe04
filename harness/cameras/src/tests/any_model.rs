//! Any camera of the workspace in any tool's format: exact, fitted or refused, and what is lost is named.

use calibench_model::PixelPoint;
use calibench_model::camera::{
    Agisoft, AgisoftFisheye, AgisoftVersion, Camera, CameraModel, DoubleSphere, Ebner, Eucm, FisheyeProjection, Fov, ImageSize,
    LensProjection, MicMac, Ocam, Omni, OpenCv, OpenCvFisheye, Photogrammetric, Pix4d, PrismFisheye, PtLens, RadTanPrismFisheye,
    SixPrismFisheye, TangentialOrder,
};
use calibench_model::convert::{ConvertOptions, Method, WARNING_PX};

use super::super::fit::{fit_to_format, losses};
use super::super::{
    CameraFormat, FORMATS, NamedCamera, ParameterCovariance, Pose, PoseFrame, ReadOptions, camera_bytes, format_named, parse_camera,
};

/// One camera of each model of the workspace, of little and of much distortion.
pub(super) fn all_models() -> Vec<Camera> {
    const SIZE: ImageSize = ImageSize { width: 1200, height: 900 };
    let mut distortion = [0.0; 14];
    distortion[..5].copy_from_slice(&[-0.08, 0.02, 3e-4, -6e-4, -0.002]);
    let opencv = OpenCv { size: SIZE, fx: 1400.0, fy: 1403.0, cx: 610.0, cy: 440.0, distortion, coefficients: 5 };
    let mut rich = OpenCv { coefficients: 14, ..opencv };
    rich.distortion[5..].copy_from_slice(&[0.01, -0.002, 1e-3, 1e-4, 2e-5, -1e-4, 1e-5, 0.01, -0.02]);
    let base =
        Photogrammetric { size: SIZE, pitch_um: 5.0, c: 7.0, x0: 0.03, y0: -0.02, k: [-1e-3, 5e-6, 0.0], p: [1e-5, -2e-5], b: [1e-4, 0.0] };
    let (k, p) = ([-0.08, 0.02, 0.001, -5e-4], [2e-4, 1e-4, 0.1, 0.0]);
    let metashape = Agisoft { size: SIZE, version: AgisoftVersion::Metashape, f: 1400.0, cx: 7.0, cy: -3.0, b1: 1.0, b2: 0.5, k, p };
    let pix4d = Pix4d {
        size: SIZE,
        sensor_width_mm: 6.0,
        f_px: 1400.0,
        px: 610.0,
        py: 440.0,
        r: [-0.08, 0.02, 0.0],
        t: [2e-4, 1e-4],
        order: TangentialOrder::OpenCv,
    };
    let (fx, fy, cx, cy) = (700.0, 701.0, 605.0, 445.0);
    vec![
        base.into(),
        Ebner { base: Photogrammetric { k: [0.0; 3], p: [0.0; 2], b: [0.0; 2], ..base }, b_mm: 2.0, parameters: [1e-5; 12] }.into(),
        opencv.into(),
        rich.into(),
        OpenCvFisheye { size: SIZE, fx: 420.0, fy: 421.0, cx, cy, skew: 0.0, k: [-0.02, 0.003, -0.001, 1e-4] }.into(),
        OpenCvFisheye { size: SIZE, fx, fy, cx, cy, skew: 0.002, k: [0.0; 4] }.into(),
        metashape.into(),
        AgisoftFisheye {
            size: SIZE,
            projection: FisheyeProjection::Equisolid,
            f: 420.0,
            cx: 7.0,
            cy: -3.0,
            b1: 1.0,
            b2: 0.5,
            k: [-0.02, 0.003, 0.0, 0.0],
            p: [2e-4, 1e-4],
        }
        .into(),
        Agisoft {
            version: AgisoftVersion::PhotoScan,
            cx: 610.0,
            cy: 440.0,
            k: [-0.08, 0.02, 0.0, 0.0],
            p: [2e-4, 1e-4, 0.0, 0.0],
            ..metashape
        }
        .into(),
        pix4d.into(),
        DoubleSphere { size: SIZE, fx: 400.0, fy: 401.0, cx, cy, xi: -0.2, alpha: 0.58 }.into(),
        Eucm { size: SIZE, fx: 450.0, fy: 451.0, cx, cy, alpha: 0.6, beta: 1.1 }.into(),
        Omni { size: SIZE, fx: 1100.0, fy: 1101.0, cx, cy, xi: 1.3, k: [-0.1, 0.02], p: [2e-4, 1e-4] }.into(),
        Fov { size: SIZE, fx, fy, cx, cy, w: 0.8 }.into(),
        PrismFisheye { size: SIZE, fx, fy, cx, cy, k: [-0.01, 0.002, 0.0, 0.0], p: [2e-4, 1e-4], s: [1e-4, -2e-4] }.into(),
        Eucm { size: SIZE, fx, fy, cx, cy, alpha: 0.5, beta: -0.1 }.into(),
        RadTanPrismFisheye {
            size: SIZE,
            fx,
            fy,
            cx,
            cy,
            k: [-0.01, 0.002, 0.0, 0.0, 1e-4, 0.0],
            p: [2e-4, 1e-4],
            s: [1e-4, -2e-4, 2e-4, 1e-4],
        }
        .into(),
        PtLens { size: SIZE, projection: LensProjection::Stereographic, f: 700.0, cx, cy, a: 0.01, b: -0.03, c: 0.005 }.into(),
        SixPrismFisheye {
            size: SIZE,
            fx,
            fy,
            cx,
            cy,
            k: [-0.01, 0.002, 0.0, 0.0, 1e-4, 0.0],
            p: [2e-4, 1e-4],
            s: [1e-4, -2e-4, 2e-4, 1e-4],
        }
        .into(),
        Ocam { size: SIZE, cx, cy, c: 1.002, d: 1e-3, e: -2e-3, a: [-420.0, 0.0, 7e-4, -1e-7, 4e-10, 0.0, 0.0] }.into(),
        MicMac {
            size: SIZE,
            f: 1400.0,
            pp: [610.0, 440.0],
            offset: [5.0, -4.0],
            k: [-4e-8, 5e-15, 0.0, 0.0, 0.0],
            p: [1e-7, 0.0],
            b: [0.0; 2],
        }
        .into(),
    ]
}

/// The largest distance of the two cameras' images of the rays of `a`'s pixels.
pub(super) fn apart(a: &Camera, b: &Camera) -> f64 {
    let ImageSize { width, height } = a.size();
    let mut worst: f64 = 0.0;
    for (x, y) in (0..=12).flat_map(|x| (0..=9).map(move |y| (x, y))) {
        let at = PixelPoint::new(f64::from(width - 1) * f64::from(x) / 12.0, f64::from(height - 1) * f64::from(y) / 9.0);
        let there = a.unproject(at).and_then(|ray| b.project(ray)).unwrap_or_else(|error| panic!("{at:?} {a:?} {b:?}: {error}"));
        worst = worst.max(there.distance(at));
    }
    worst
}

fn into_format(format: &CameraFormat, camera: &Camera) -> &'static str {
    let options = ConvertOptions { columns: 7, ..ConvertOptions::default() };
    let (found, model) = match fit_to_format(format, camera, None, None, &options) {
        Ok(found) => found,
        Err(error) => {
            assert!(error.to_string().starts_with(&format!("{} cannot hold the camera: ", format.name)), "{error}");
            return "refused";
        }
    };
    let bytes = camera_bytes(format, &[NamedCamera::new("7", found.camera)])
        .unwrap_or_else(|error| panic!("{} {}: {error}\n{:?}", format.name, model.name, found.camera));
    let read = parse_camera("f", &bytes, &ReadOptions::of_written(format, camera.size()));
    let read = read.unwrap_or_else(|error| panic!("{error}\n{}", String::from_utf8_lossy(&bytes)));
    // What the conversion says of itself is what the file pictures.
    let off = apart(camera, &read.cameras[0].camera);
    match found.method {
        Method::Exact => assert!(off < 1e-8, "{} {}: {off} px, said to be exact", format.name, model.name),
        Method::Fitted => assert!(off <= 1.1 * found.residual.max_px + 1e-7, "{} {}: {off} {:?}", format.name, model.name, found.residual),
    }
    if found.method == Method::Exact {
        "exact"
    } else if found.residual.max_px <= WARNING_PX {
        "fitted"
    } else {
        "fitted with a warning"
    }
}

#[test]
fn any_camera_is_exact_fitted_or_refused_by_name() {
    // kapture's models are COLMAP's, and those of its two files the same; BAL's are Bundler's.
    let formats =
        FORMATS.iter().filter(|format| !format.models(None).is_empty() && !["kapture", "bal", "colmap-bin"].contains(&format.name));
    let answers: Vec<&str> = std::thread::scope(|scope| {
        let threads: Vec<_> = formats
            .map(|format| scope.spawn(|| all_models().iter().map(|camera| into_format(format, camera)).collect::<Vec<_>>()))
            .collect();
        threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect()
    });
    // Each of the answers is given: the test looks at something.
    for answer in ["exact", "fitted", "fitted with a warning", "refused"] {
        assert!(answers.iter().filter(|found| **found == answer).count() > 5, "{answer}: {answers:?}");
    }
}

#[test]
fn a_model_is_chosen_by_name() {
    let camera = all_models()[2];
    let format = format_named("colmap").unwrap();
    let options = ConvertOptions { accept: true, ..ConvertOptions::default() };
    let (found, model) = fit_to_format(format, &camera, Some("radial"), None, &options).unwrap();
    assert_eq!((model.name, found.method), ("RADIAL", Method::Fitted));
    let error = fit_to_format(format, &camera, Some("RADIAL9"), None, &options).unwrap_err().to_string();
    assert!(error.starts_with("colmap holds no model `RADIAL9`; it holds SIMPLE_RADIAL, RADIAL, OPENCV"), "{error}");
    assert!(fit_to_format(format_named("pix4d").unwrap(), &camera, None, None, &options).is_err());
}

#[test]
fn what_is_lost_is_named() {
    let pose = Some(Pose { position: [1.0, 0.0, 0.0], ..Pose::IDENTITY });
    let covariance = Some(ParameterCovariance::new(vec!["fx".into(), "fy".into()], vec![1.0, 0.5, 0.5, 1.0]).unwrap());
    let camera =
        NamedCamera { pitch_um: Some(5.0), pose, pose_frame: PoseFrame::Imu, covariance, ..NamedCamera::new("left", all_models()[2]) };
    let lost = |name| losses(format_named(name).unwrap(), &camera);
    let all = lost("bundler");
    assert_eq!(all.len(), 3, "{all:?}");
    assert!(all[0].starts_with("the name `left`: bundler has no place") && all[1].starts_with("the pixel pitch, 5 um"), "{all:?}");
    assert_eq!(lost("colmap").len(), 3);
    assert!(lost("colmap")[1].contains("the pose against the inertial sensor"));
    assert!(lost("caltech").iter().any(|what| what.starts_with("the correlations of the parameters")));
    assert!(lost("photogrammetric").iter().all(|what| what.contains("pose")));
    let of_images = NamedCamera { pose_frame: PoseFrame::World, ..camera.clone() };
    let lost = losses(format_named("basalt").unwrap(), &of_images);
    assert!(lost.iter().any(|what| what.starts_with("the world of the pose: basalt holds poses of a rig")), "{lost:?}");
}
