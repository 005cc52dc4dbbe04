//! Files of many tools: what is written is read again.

use calibench_model::camera::{
    Agisoft, AgisoftVersion, Camera, CameraModel, DoubleSphere, Eucm, Fov, ImageSize, MicMac, Omni, OpenCv, OpenCvFisheye, PrismFisheye,
    RadTanPrismFisheye, SixPrismFisheye,
};
use proptest::prelude::*;

use super::super::format::KeptPose;
use super::super::pose::of_rotation_vector;
use super::super::{NamedCamera, ParameterCovariance, Pose, PoseFrame, ReadOptions, camera_text, format_named};
use super::read_with;
use super::round_trip::{coefficients, focal, name, offset, size};

/// The formats of this file, in the order of the registry.
pub const ROUND_TRIPPED: [&str; 19] = [
    "camodocal",
    "ros",
    "kalibr",
    "micmac",
    "bentley",
    "reality-capture",
    "reality-scan-csv",
    "mrcal",
    "basalt",
    "nerfstudio",
    "openmvg",
    "theia",
    "opensfm",
    "colmap",
    "kapture",
    "bundler",
    "bal",
    "caltech",
    "anipose",
];

/// The values that decide what a camera pictures, whatever the number of its coefficients is called.
fn values(camera: &Camera) -> Vec<(&'static str, f64)> {
    match camera {
        Camera::OpenCv(camera) => OpenCv { coefficients: 14, ..*camera }.parameters(),
        other => other.parameters(),
    }
    .into_iter()
    .map(|p| (p.name, p.value))
    .collect()
}

fn near(a: f64, b: f64, scale: f64) -> bool {
    (a - b).abs() <= 1e-12 * scale.max(a.abs())
}

/// Asserts that a file's cameras are those written: values to 1e-12, lengths relative to 10^4 px, and all else.
fn comes_back(format: &str, cameras: &[NamedCamera]) {
    let format = format_named(format).unwrap();
    let text = camera_text(format, cameras).unwrap_or_else(|error| panic!("{error}\n{cameras:?}"));
    let found =
        read_with(&text, ReadOptions::of_written(format, cameras[0].camera.size())).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!((found.format, found.cameras.len()), (format, cameras.len()));
    for (a, b) in cameras.iter().zip(&found.cameras) {
        assert_eq!(a.camera.size(), b.camera.size());
        let (left, right) = (values(&a.camera), values(&b.camera));
        assert_eq!(left.len(), right.len(), "{:?} {:?}", a.camera, b.camera);
        for ((name, a), (other, b)) in left.into_iter().zip(right) {
            let length = ["fx", "fy", "cx", "cy", "f", "b1", "b2", "F", "PPx", "PPy", "ex", "ey"].contains(&name);
            assert!(name == other && near(a, b, if length { 1e4 } else { 0.0 }), "{name} {a} {other} {b}\n{text}");
        }
        let keeps_pose = format.keeps.pose != KeptPose::None;
        if format.keeps.name && !a.name.is_empty() {
            assert_eq!(a.name, b.name);
        }
        if let (true, Some(a), Some(b)) = (keeps_pose, a.pose, b.pose) {
            let size = a.position.iter().fold(1.0, |s: f64, v| s.max(v.abs()));
            assert!(a.position.iter().zip(b.position).all(|(a, b)| near(*a, b, 10.0 * size)), "{a:?} {b:?}");
            let (a, b) = (a.camera_from_world, b.camera_from_world);
            assert!(a.as_flattened().iter().zip(b.as_flattened()).all(|(a, b)| (a - b).abs() < 1e-13), "{a:?} {b:?}");
        }
        assert_eq!(b.pose.is_some(), keeps_pose && a.pose.is_some(), "{text}");
    }
}

fn plain() -> impl Strategy<Value = (ImageSize, [f64; 4])> {
    (size(), focal(), focal(), offset(), offset()).prop_map(|(size, fx, fy, cx, cy)| (size, [fx, fy, cx, cy]))
}

fn opencv(count: usize) -> impl Strategy<Value = Camera> {
    (plain(), coefficients::<14>()).prop_map(move |((size, [fx, fy, cx, cy]), mut distortion)| {
        distortion[count..].fill(0.0);
        OpenCv { size, fx, fy, cx, cy, distortion, coefficients: count }.into()
    })
}

fn fisheye() -> impl Strategy<Value = Camera> {
    (plain(), coefficients()).prop_map(|((size, [fx, fy, cx, cy]), k)| OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k }.into())
}

fn fov() -> impl Strategy<Value = Camera> {
    (plain(), 0.01..2.5_f64).prop_map(|((size, [fx, fy, cx, cy]), w)| Fov { size, fx, fy, cx, cy, w }.into())
}

fn eucm() -> impl Strategy<Value = Camera> {
    let camera = (plain(), 0.0..0.9_f64, 0.5..2.0_f64);
    camera.prop_map(|((size, [fx, fy, cx, cy]), alpha, beta)| Eucm { size, fx, fy, cx, cy, alpha, beta }.into())
}

fn double_sphere() -> impl Strategy<Value = Camera> {
    let camera = (plain(), -0.4..0.6_f64, 0.0..0.9_f64);
    camera.prop_map(|((size, [fx, fy, cx, cy]), xi, alpha)| DoubleSphere { size, fx, fy, cx, cy, xi, alpha }.into())
}

fn omni() -> impl Strategy<Value = Camera> {
    let camera = (plain(), 0.0..2.5_f64, coefficients(), coefficients());
    camera.prop_map(|((size, [fx, fy, cx, cy]), xi, k, p)| Omni { size, fx, fy, cx, cy, xi, k, p }.into())
}

fn prism() -> impl Strategy<Value = Camera> {
    let camera = (plain(), coefficients(), coefficients(), coefficients());
    camera.prop_map(|((size, [fx, fy, cx, cy]), k, p, s)| PrismFisheye { size, fx, fy, cx, cy, k, p, s }.into())
}

fn then_prism() -> impl Strategy<Value = Camera> {
    let camera = (plain(), coefficients(), coefficients(), coefficients());
    camera.prop_map(|((size, [fx, fy, cx, cy]), k, p, s)| RadTanPrismFisheye { size, fx, fy, cx, cy, k, p, s }.into())
}

fn six_prism() -> impl Strategy<Value = Camera> {
    let camera = (plain(), coefficients(), coefficients(), coefficients());
    camera.prop_map(|((size, [fx, fy, cx, cy]), k, p, s)| SixPrismFisheye { size, fx, fy, cx, cy, k, p, s }.into())
}

fn division() -> impl Strategy<Value = Camera> {
    let camera = (plain(), any::<bool>(), -0.5..2.0_f64);
    camera
        .prop_map(|((size, [fx, fy, cx, cy]), one, beta)| Eucm { size, fx, fy: if one { fx } else { fy }, cx, cy, alpha: 0.5, beta }.into())
}

fn equidistant() -> impl Strategy<Value = Camera> {
    let camera = (plain(), any::<bool>());
    camera.prop_map(|((size, [fx, fy, cx, cy]), one)| {
        OpenCvFisheye { size, fx, fy: if one { fx } else { fy }, cx, cy, skew: 0.0, k: [0.0; 4] }.into()
    })
}

/// One focal length, k1 to k3, p1, p2.
fn one_focal(tangential: bool) -> impl Strategy<Value = Camera> {
    (plain(), coefficients::<5>()).prop_map(move |((size, [f, _, cx, cy]), [k1, k2, p1, p2, k3])| {
        let mut distortion = [0.0; 14];
        let [p1, p2] = if tangential { [p1, p2] } else { [0.0; 2] };
        distortion[..5].copy_from_slice(&[k1, k2, p1, p2, k3]);
        OpenCv { size, fx: f, fy: f, cx, cy, distortion, coefficients: 5 }.into()
    })
}

/// k4 and a shear.
fn metashape(shear: bool) -> impl Strategy<Value = Camera> {
    (plain(), coefficients::<4>(), coefficients::<2>(), 0.1..5.0_f64).prop_map(move |((size, [f, _, cx, cy]), k, [p1, p2], b2)| {
        let k = if shear { [k[0], k[1], k[2], 0.0] } else { [k[0], k[1], k[2], k[3] + 0.01] };
        let b2 = if shear { b2 } else { 0.0 };
        Agisoft { size, version: AgisoftVersion::Metashape, f, cx, cy, b1: 0.0, b2, k, p: [p1, p2, 0.0, 0.0] }.into()
    })
}

fn centred() -> impl Strategy<Value = Camera> {
    (size(), focal(), coefficients::<2>()).prop_map(|(size, f, [k1, k2])| {
        let mut distortion = [0.0; 14];
        distortion[..2].copy_from_slice(&[k1, k2]);
        let (cx, cy) = (f64::from(size.width) / 2.0 - 0.5, f64::from(size.height) / 2.0 - 0.5);
        OpenCv { size, fx: f, fy: f, cx, cy, distortion, coefficients: 4 }.into()
    })
}

fn micmac() -> impl Strategy<Value = Camera> {
    let camera = (plain(), -50.0..50.0_f64, -50.0..50.0_f64, coefficients(), coefficients(), coefficients());
    camera.prop_map(|((size, [f, _, x, y]), ex, ey, k, p, b)| MicMac { size, f, pp: [x, y], offset: [ex, ey], k, p, b }.into())
}

fn pose() -> impl Strategy<Value = Pose> {
    (prop::array::uniform3(-1.8..1.8_f64), prop::array::uniform3(-1e3..1e3_f64))
        .prop_map(|(v, position)| Pose { camera_from_world: of_rotation_vector(v), position })
}

fn posed(camera: impl Strategy<Value = Camera>) -> impl Strategy<Value = NamedCamera> {
    (camera, name(), pose()).prop_map(|(camera, name, pose)| NamedCamera { pose: Some(pose), ..NamedCamera::new(name, camera) })
}

fn any_of_colmap_4() -> impl Strategy<Value = Camera> {
    prop_oneof![any_of_colmap(), then_prism(), division(), eucm()]
}

fn any_of_colmap() -> impl Strategy<Value = Camera> {
    prop_oneof![opencv(4), opencv(8), one_focal(false), fisheye(), equidistant(), fov(), prism(), centred()]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn colmap(cameras in prop::collection::vec(any_of_colmap_4(), 1..4)) {
        let named = |prefix: &'static str| cameras.iter().enumerate().map(move |(i, c)| NamedCamera::new(format!("{prefix}{}", i + 3), *c));
        comes_back("colmap", &named("").collect::<Vec<_>>());
    }

    #[test]
    fn kapture(cameras in prop::collection::vec(any_of_colmap(), 1..4)) {
        let named = |prefix: &'static str| cameras.iter().enumerate().map(move |(i, c)| NamedCamera::new(format!("{prefix}{}", i + 3), *c));
        comes_back("kapture", &named("left ").collect::<Vec<_>>());
    }

    #[test]
    fn ros(camera in prop_oneof![opencv(5), opencv(8), opencv(12), fisheye()], name in name()) {
        comes_back("ros", &[NamedCamera::new(name, camera)]);
    }

    #[test]
    fn kalibr(first in opencv(4), second in prop_oneof![fisheye(), fov(), omni(), eucm(), double_sphere()], a in pose(), b in pose(), imu in any::<bool>()) {
        let frame = if imu { PoseFrame::Imu } else { PoseFrame::FirstCamera };
        let place = |name: &str, camera, pose| NamedCamera { pose: Some(pose), pose_frame: frame, ..NamedCamera::new(name, camera) };
        comes_back("kalibr", &[place("cam0", first, if imu { a } else { Pose::IDENTITY }), place("right/image", second, b)]);
        comes_back("kalibr", &[NamedCamera::new("cam0", first), NamedCamera::new("cam1", second)]);
    }

    #[test]
    fn basalt(cameras in prop::collection::vec(posed(prop_oneof![opencv(8), opencv(0), fisheye(), fov(), eucm(), double_sphere()]), 1..3)) {
        comes_back("basalt", &cameras);
    }

    #[test]
    fn camodocal(camera in prop_oneof![opencv(4), fisheye(), omni()], name in name()) {
        comes_back("camodocal", &[NamedCamera::new(name, camera)]);
    }

    #[test]
    fn mrcal(camera in posed(prop_oneof![opencv(4), opencv(5), opencv(8), opencv(12)])) {
        comes_back("mrcal", &[camera]);
    }

    #[test]
    fn opensfm(cameras in prop::collection::vec(prop_oneof![centred(), opencv(5), fisheye(), six_prism()], 1..4)) {
        let cameras: Vec<_> = cameras.into_iter().enumerate().map(|(i, c)| NamedCamera::new(format!("v2 \"maker\" {i}"), c)).collect();
        comes_back("opensfm", &cameras);
    }

    #[test]
    fn nerfstudio(cameras in prop::collection::vec(posed(prop_oneof![opencv(5), metashape(false)]), 1..3), other in fisheye()) {
        comes_back("nerfstudio", &cameras);
        comes_back("nerfstudio", &[NamedCamera::new("", other)]);
    }

    #[test]
    fn openmvg(cameras in prop::collection::vec(prop_oneof![one_focal(true), one_focal(false), centred()], 1..5)) {
        let cameras: Vec<_> = cameras.into_iter().enumerate().map(|(i, c)| NamedCamera::new(format!("{}", i + 7), c)).collect();
        comes_back("openmvg", &cameras);
    }

    #[test]
    fn theia(cameras in prop::collection::vec(prop_oneof![opencv(5), metashape(true), fisheye(), fov(), opencv(2)], 1..3)) {
        let cameras: Vec<_> = cameras.into_iter().enumerate().map(|(i, c)| NamedCamera::new(format!("view_{i}.jpg"), c)).collect();
        comes_back("theia", &cameras);
    }

    #[test]
    fn anipose(cameras in prop::collection::vec(posed(prop_oneof![opencv(4), opencv(8), fisheye()]), 1..13)) {
        comes_back("anipose", &cameras);
    }

    #[test]
    fn bundler_and_bal(cameras in prop::collection::vec(posed(centred()), 1..3)) {
        // One size for all: the file does not state it.
        comes_back("bundler", &cameras[..1]);
        comes_back("bal", &cameras[..1]);
    }

    #[test]
    fn reality_capture(camera in posed(prop_oneof![one_focal(true), opencv(5), centred(), metashape(false), metashape(true), division()])) {
        comes_back("reality-capture", &[camera]);
    }

    #[test]
    fn reality_scan_csv(camera in posed(prop_oneof![one_focal(true), one_focal(false), centred(), metashape(false)]), other in pose()) {
        comes_back("reality-scan-csv", &[camera.clone(), NamedCamera { pose: Some(other), ..NamedCamera::new("a, \"b\"", camera.camera) }]);
    }

    #[test]
    fn bentley(camera in opencv(5), other in centred(), name in name()) {
        comes_back("bentley", &[NamedCamera::new(name, camera), NamedCamera::new("b", other)]);
    }

    #[test]
    fn micmac_s(camera in micmac()) {
        comes_back("micmac", &[NamedCamera::new("", camera)]);
    }

    #[test]
    fn caltech(camera in opencv(5), other in metashape(true), variance in 1e-9..1e3_f64) {
        let names = ["fx", "k1"].map(str::to_owned).to_vec();
        let covariance = ParameterCovariance::new(names, vec![variance, 0.0, 0.0, 2.0 * variance]).unwrap();
        let named = NamedCamera { covariance: Some(covariance.clone()), ..NamedCamera::new("", camera) };
        comes_back("caltech", std::slice::from_ref(&named));
        let text = camera_text(format_named("caltech").unwrap(), &[named]).unwrap();
        let found = read_with(&text, ReadOptions::default()).unwrap().cameras[0].covariance.clone().unwrap();
        prop_assert_eq!(&found.parameters, &covariance.parameters);
        prop_assert!(found.values.iter().zip(&covariance.values).all(|(a, b)| near(*a, *b, 0.0)));
        comes_back("caltech", &[NamedCamera::new("", other)]);
    }
}
