//! What is written is read again, for any camera.

use calibench_model::camera::{
    Agisoft, AgisoftFisheye, AgisoftVersion, Camera, Ebner, FisheyeProjection, ImageSize, OpenCv, OpenCvFisheye, Photogrammetric, Pix4d,
    TangentialOrder,
};
use proptest::prelude::*;

use super::super::{NamedCamera, ParameterCovariance, Pose, ReadOptions, camera_text, format_named};
use super::{assert_same, read_with};

pub(super) fn size() -> impl Strategy<Value = ImageSize> {
    (1_u32..60_000, 1_u32..60_000).prop_map(|(width, height)| ImageSize { width, height })
}

pub(super) fn focal() -> impl Strategy<Value = f64> {
    10.0..50_000.0_f64
}

pub(super) fn offset() -> impl Strategy<Value = f64> {
    -5000.0..5000.0_f64
}

/// Coefficients of any magnitude, zero among them.
pub(super) fn coefficient() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 5 => (-1.0..1.0_f64, -20..4_i32).prop_map(|(mantissa, exponent)| mantissa * 10_f64.powi(exponent))]
}

pub(super) fn coefficients<const N: usize>() -> impl Strategy<Value = [f64; N]> {
    prop::collection::vec(coefficient(), N).prop_map(|v| v.try_into().unwrap())
}

fn opencv() -> impl Strategy<Value = Camera> {
    let count = prop::sample::select(vec![4_usize, 5, 8, 12, 14]);
    (size(), focal(), focal(), offset(), offset(), coefficients::<14>(), count).prop_map(
        |(size, fx, fy, cx, cy, mut distortion, coefficients)| {
            distortion[coefficients..].fill(0.0);
            Camera::OpenCv(OpenCv { size, fx, fy, cx, cy, distortion, coefficients })
        },
    )
}

fn fisheye() -> impl Strategy<Value = Camera> {
    let camera = (size(), focal(), focal(), offset(), offset(), coefficient(), coefficients());
    camera.prop_map(|(size, fx, fy, cx, cy, skew, k)| Camera::OpenCvFisheye(OpenCvFisheye { size, fx, fy, cx, cy, skew, k }))
}

fn metashape() -> impl Strategy<Value = Camera> {
    let camera = (size(), focal(), offset(), offset(), offset(), offset(), coefficients(), coefficients());
    camera.prop_map(|(size, f, cx, cy, b1, b2, k, p)| {
        Camera::Agisoft(Agisoft { size, version: AgisoftVersion::Metashape, f, cx, cy, b1, b2, k, p })
    })
}

fn metashape_fisheye() -> impl Strategy<Value = Camera> {
    let camera = (size(), focal(), offset(), offset(), offset(), offset(), coefficients(), coefficients(), any::<bool>());
    camera.prop_map(|(size, f, cx, cy, b1, b2, k, p, equisolid)| {
        let projection = if equisolid { FisheyeProjection::Equisolid } else { FisheyeProjection::Equidistant };
        Camera::AgisoftFisheye(AgisoftFisheye { size, projection, f, cx, cy, b1, b2, k, p })
    })
}

fn photoscan() -> impl Strategy<Value = Camera> {
    let camera = (size(), focal(), 0.5..2.0_f64, offset(), offset(), offset(), coefficients::<3>(), coefficients::<2>());
    camera.prop_map(|(size, f, ratio, cx, cy, b2, [k1, k2, k3], [p1, p2])| {
        let (k, p) = ([k1, k2, k3, 0.0], [p1, p2, 0.0, 0.0]);
        Camera::Agisoft(Agisoft { size, version: AgisoftVersion::PhotoScan, f, cx, cy, b1: f * ratio - f, b2, k, p })
    })
}

fn pix4d(sensor: bool) -> impl Strategy<Value = Camera> {
    let width = if sensor { 1.0..100.0_f64 } else { 0.0..f64::MIN_POSITIVE };
    (size(), width, focal(), offset(), offset(), coefficients(), coefficients()).prop_map(move |(size, width, f_px, px, py, r, t)| {
        let sensor_width_mm = if sensor { width } else { 0.0 };
        Camera::Pix4d(Pix4d { size, sensor_width_mm, f_px, px, py, r, t, order: TangentialOrder::OpenCv })
    })
}

fn base() -> impl Strategy<Value = Photogrammetric> {
    let camera = (size(), 0.5..20.0_f64, 1.0..500.0_f64, -5.0..5.0_f64, -5.0..5.0_f64, coefficients(), coefficients(), coefficients());
    camera.prop_map(|(size, pitch_um, c, x0, y0, k, p, b)| Photogrammetric { size, pitch_um, c, x0, y0, k, p, b })
}

fn ours() -> impl Strategy<Value = Camera> {
    prop_oneof![
        base().prop_map(Camera::Photogrammetric),
        (base(), 0.1..20.0_f64, coefficients()).prop_map(|(base, b_mm, parameters)| Camera::Ebner(Ebner { base, b_mm, parameters })),
    ]
}

pub(super) fn name() -> impl Strategy<Value = String> {
    prop_oneof![Just(String::new()), "[A-Za-z0-9_.-]{1,12}"]
}

fn pose() -> impl Strategy<Value = Pose> {
    (prop::array::uniform3(prop::array::uniform3(-1.0..1.0_f64)), prop::array::uniform3(-1e7..1e7_f64))
        .prop_map(|(camera_from_world, position)| Pose { camera_from_world, position })
}

/// The covariance of two parameters, or none.
fn covariance(names: [&'static str; 2]) -> impl Strategy<Value = Option<ParameterCovariance>> {
    prop::option::of((1e-6..1e6_f64, 1e-9..1.0_f64, -0.99..0.99_f64)).prop_map(move |parts| {
        let (a, b, rho) = parts?;
        let parameters = names.iter().map(ToString::to_string).collect();
        let mixed = rho * (a * b).sqrt();
        Some(ParameterCovariance::new(parameters, vec![a, mixed, mixed, b]).unwrap())
    })
}

fn comes_back(format: &str, cameras: &[NamedCamera]) {
    let format = format_named(format).unwrap();
    let text = camera_text(format, cameras).unwrap();
    let size = calibench_model::camera::CameraModel::size(&cameras[0].camera);
    let found = read_with(&text, ReadOptions::of_written(format, size)).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(found.format, format);
    assert_same(cameras, &found.cameras, 1e-12);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn opencv_yaml_and_xml(camera in prop_oneof![opencv(), fisheye()], name in name(), sigmas in prop::option::of((0.0..10.0_f64, 1e-6..1.0_f64))) {
        // Squares of numbers with few digits have exact roots.
        let variances = sigmas.map(|(a, b)| [a, b].map(|sigma| f64::from((sigma * 1024.0).ceil() as u32) / 1024.0).map(|sigma| sigma * sigma));
        let covariance = variances.map(|[a, b]| ParameterCovariance::new(vec!["cx".into(), "k2".into()], vec![a.max(1.0), 0.0, 0.0, b]).unwrap());
        for format in ["opencv-yaml", "opencv-xml"] {
            comes_back(format, &[NamedCamera { covariance: covariance.clone(), ..NamedCamera::new(name.clone(), camera) }]);
        }
    }

    #[test]
    fn metashape_calibration(camera in prop_oneof![metashape(), metashape_fisheye(), photoscan()]) {
        comes_back("metashape", &[NamedCamera::new("", camera)]);
    }

    #[test]
    fn metashape_cameras(cameras in prop::collection::vec((name(), prop_oneof![metashape(), metashape_fisheye()], prop::option::of(0.5..20.0_f64), covariance(["f", "k1"])), 1..4)) {
        let cameras: Vec<_> = cameras.into_iter().map(|(name, camera, pitch_um, covariance)| {
            NamedCamera { pitch_um, covariance, ..NamedCamera::new(name, camera) }
        }).collect();
        comes_back("metashape-cameras", &cameras);
    }

    #[test]
    fn photoscan_cameras(cameras in prop::collection::vec((name(), photoscan(), prop::option::of(pose())), 1..4)) {
        let cameras: Vec<_> = cameras.into_iter().map(|(name, camera, pose)| NamedCamera { pose, ..NamedCamera::new(name, camera) }).collect();
        comes_back("photoscan-cameras", &cameras);
    }

    #[test]
    fn pix4d_cams(camera in pix4d(true)) {
        let Camera::Pix4d(inner) = camera else { unreachable!() };
        let pitch_um = Some(inner.sensor_width_mm / f64::from(inner.size.width) * 1e3);
        comes_back("pix4d-inpho", &[NamedCamera { pitch_um, ..NamedCamera::new("", camera) }]);
        comes_back("pix4d", &[NamedCamera { pitch_um, ..NamedCamera::new("0", camera) }]);
    }

    #[test]
    fn pix4d_parameters(cameras in prop::collection::vec(("[A-Z][a-z _]{0,8}[0-9]", pix4d(false), pose()), 1..4)) {
        let cameras: Vec<_> = cameras.into_iter().map(|(name, camera, pose)| {
            NamedCamera { pose: Some(pose), ..NamedCamera::new(name, camera) }
        }).collect();
        comes_back("pix4d-parameters", &cameras);
    }

    #[test]
    fn our_own(camera in ours(), name in name(), covariance in covariance(["c", "k1"])) {
        let (Camera::Photogrammetric(base) | Camera::Ebner(Ebner { base, .. })) = camera else { unreachable!() };
        comes_back("photogrammetric", &[NamedCamera { pitch_um: Some(base.pitch_um), covariance, ..NamedCamera::new(name, camera) }]);
    }
}

#[test]
fn every_written_format_is_round_tripped() {
    let here = [
        "photogrammetric",
        "opencv-yaml",
        "opencv-xml",
        "opencv-json",
        "metashape",
        "metashape-cameras",
        "photoscan-cameras",
        "pix4d-inpho",
        "pix4d",
        "pix4d-parameters",
    ];
    let listed = [&here[..], &super::tool_formats::ROUND_TRIPPED].concat();
    let written = || super::super::FORMATS.iter().filter(|format| format.is_written());
    assert!(listed.iter().all(|name| written().any(|format| format.name == *name)), "{listed:?}");
    // A format with models is written and read again with cameras of every model, in `any_model`.
    let left: Vec<&str> =
        written().filter(|format| !listed.contains(&format.name) && format.models(None).is_empty()).map(|format| format.name).collect();
    assert_eq!(left, Vec::<&str>::new(), "nobody reads again what these write");
}

#[test]
fn the_convention_of_every_format_is_listed() {
    let listed = |name: &str| calibench_model::camera::conventions().iter().any(|convention| convention.name == name);
    let of = super::super::FORMATS.iter().filter_map(|format| Some((format.name, format.convention?.name)));
    let missing: Vec<(&str, &str)> = of.filter(|(_, convention)| !listed(convention)).collect();
    assert_eq!(missing, [], "`conventions()` of the model's dispatch.rs lacks them");
}

#[test]
fn names_that_would_break_a_file_are_escaped() {
    let camera = NamedCamera::new(
        "a\"<&>'\\",
        Camera::Agisoft(Agisoft {
            size: ImageSize { width: 10, height: 10 },
            version: AgisoftVersion::Metashape,
            f: 10.0,
            cx: 0.0,
            cy: 0.0,
            b1: 0.0,
            b2: 0.0,
            k: [0.0; 4],
            p: [0.0; 4],
        }),
    );
    comes_back("metashape-cameras", &[camera]);
}
