//! mrcal's splines: kept as they are, and fitted within half a pixel or not at all.

use calibench_model::camera::{CameraModel, ImageSize, Ray, Splined, TangentialOrder};
use calibench_model::convert::{ConvertOptions, Method};

use super::super::conversion::{ConversionError, converted};
use super::super::target::{Given, goal};
use super::super::{NamedCamera, ReadOptions, camera_text, format_named};
use super::{read, read_with};

/// A .cameramodel of 16 x 11 control points whose D are `rough` times a wave beside a smooth distortion.
fn text(rough: f64) -> String {
    let control = (0..16 * 11).map(|i| {
        let (x, y) = (f64::from(i % 16) - 7.5, f64::from(i / 16) - 5.0);
        let r2 = x * x + y * y;
        let wave = rough * (1.9 * x).sin() * (2.3 * y).cos();
        format!("{}, {}", -2e-4 * x * r2 + wave, -2e-4 * y * r2 - wave)
    });
    format!(
        "{{\n 'lensmodel': 'LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx=16_Ny=11_fov_x_deg=120',\n 'intrinsics': [ 1700.5, 1701.25, 1961.125, 1087.5, {} ],\n \
         'extrinsics': [ 0.1, -0.2, 0.3, 1, 2, 3 ],\n 'imagersize': [ 3900, 2190 ]\n}}\n",
        control.collect::<Vec<_>>().join(", ")
    )
}

fn source(rough: f64) -> NamedCamera {
    read(&text(rough)).unwrap().cameras.remove(0)
}

fn to(source: &NamedCamera, name: &str, options: &ConvertOptions) -> Result<super::super::conversion::Converted, ConversionError> {
    let given = Given { source, pitch_um: None, base_mm: None, order: TangentialOrder::OpenCv, output: None };
    converted(source, &goal(name, &given).unwrap(), None, None, options)
}

#[test]
fn splines_to_splines_are_the_same_to_the_last_bit() {
    let source = source(2e-3);
    let found = to(&source, "mrcal", &ConvertOptions::default()).unwrap();
    assert_eq!(found.conversion.method, Method::Exact);
    let written = camera_text(format_named("mrcal").unwrap(), &[found.camera]).unwrap();
    let again = read(&written).unwrap().cameras.remove(0);
    let splines = |named: &NamedCamera| named.splines.clone().unwrap().model;
    assert_eq!(splines(&again), splines(&source));
    let off = again.pose.unwrap().t().iter().zip(source.pose.unwrap().t()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-12, "{off}");
}

#[test]
fn other_models_are_fitted_to_the_splines_and_half_a_pixel_is_the_limit() {
    let smooth = source(0.0);
    assert!(smooth.splines.as_ref().unwrap().doubt().is_none(), "{:?}", smooth.notes);
    let found = to(&smooth, "opencv-fisheye", &ConvertOptions::default()).unwrap();
    assert_eq!(found.conversion.method, Method::Fitted);
    assert!(found.conversion.residual.max_px < 0.5 && found.camera.splines.is_none());
    let rough = source(2e-3);
    assert!(rough.splines.as_ref().unwrap().doubt().is_some_and(|doubt| doubt.contains("px off; convert it first")));
    for name in ["opencv-fisheye", "colmap", "ros"] {
        let error = to(&rough, name, &ConvertOptions::default()).unwrap_err().to_string();
        assert!(error.contains("differs by up to"), "{name}: {error}");
    }
    let accepted = to(&rough, "opencv-fisheye", &ConvertOptions { accept: true, ..ConvertOptions::default() }).unwrap();
    assert!(accepted.conversion.residual.max_px > 0.5);
}

/// Who takes splines as they are gets these and their pose, and a camera that nobody is to take for them, though without control points it is them.
#[test]
fn splines_alone_are_read_without_a_camera_that_is_near() {
    let fitted = source(0.0);
    let alone = read_with(&text(0.0), ReadOptions { splines_alone: true, ..ReadOptions::default() }).unwrap().cameras.remove(0);
    let model = |named: &NamedCamera| named.splines.as_ref().unwrap().model.clone();
    assert_eq!((model(&alone), &alone.pose), (model(&fitted), &fitted.pose));
    assert!(alone.doubt().is_some() && fitted.doubt().is_none() && alone.camera != fitted.camera);
    let flat = Splined::flat(ImageSize { width: 3900, height: 2190 }, [1700.5, 1701.25, 1961.125, 1087.5], 3, [16, 11], 120.0);
    let camera = NamedCamera::splined("", flat.clone()).camera;
    for (x, y) in [(0.0, 0.0), (0.5, -0.2), (-0.9, 0.6), (0.3, 0.8)] {
        let ray = Ray::from_tangent(x, y);
        let off = camera.project(ray).unwrap().distance(flat.project(ray).unwrap());
        assert!(off < 1e-9, "{x} {y}: {off}");
    }
}

/// Splines whose axis stands askew to that of the lens: after a rotation they are as near to other models as before, and the pose is turned with the camera.
#[test]
fn splines_that_stand_askew_are_fitted_with_a_rotation() {
    let shifted = |off: f64| {
        let control = (0..16 * 11).map(|i| {
            let (x, y) = (f64::from(i % 16) - 7.5, f64::from(i / 16) - 5.0);
            let r2 = x * x + y * y;
            format!("{}, {}", -2e-4 * x * r2 + off * (1.0 + 0.02 * x * x), -2e-4 * y * r2 + off * 0.02 * x * y)
        });
        let head = text(0.0);
        let (before, after) = (head.find("1087.5, ").unwrap() + 8, head.find(" ],\n 'extrinsics'").unwrap());
        format!("{}{}{}", &head[..before], control.collect::<Vec<_>>().join(", "), &head[after..])
    };
    let askew = read(&shifted(0.02)).unwrap().cameras.remove(0);
    let found = to(&askew, "opencv-fisheye", &ConvertOptions { accept: true, ..ConvertOptions::default() }).unwrap();
    let angle = found.conversion.rotation.angle();
    assert!(angle > 1e-3, "{angle}");
    let held = ConvertOptions { accept: true, ..ConvertOptions::default() };
    let without =
        calibench_model::convert::fit(&askew.splines.as_ref().unwrap().model, calibench_model::convert::Target::OpenCvFisheye, &held)
            .unwrap();
    assert!(found.conversion.residual.rms_px < 0.7 * without.residual.rms_px, "{:?} {:?}", found.conversion.residual, without.residual);
    assert!(found.camera.pose.unwrap().camera_from_world != askew.pose.unwrap().camera_from_world);
    assert!(askew.notes.iter().any(|note| note.contains("rotated by")), "{:?}", askew.notes);
}
