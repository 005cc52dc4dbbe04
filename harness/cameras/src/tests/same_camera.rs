//! Files of several tools that describe one camera, and the tools' own samples.

#![cfg_attr(not(camera_files), allow(dead_code, unused_imports))]

use std::path::{Path, PathBuf};

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, DoubleSphere, ImageSize, OpenCvFisheye, Ray, Splined};

use super::super::formats::mrcal;
use super::super::{CameraFile, PoseFrame, ReadOptions, camera_text, json, read_camera};
use super::{read, read_with};

fn path(name: &str) -> PathBuf {
    Path::new(option_env!("CALIBENCH_CAMERA_FILES").unwrap_or("")).join(name)
}

fn file(name: &str) -> CameraFile {
    read_camera(&path(name)).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
#[cfg_attr(not(camera_files), ignore = "no camera files")]
#[allow(clippy::excessive_precision, reason = "the files' own digits")]
fn the_tools_samples_are_read() {
    let colmap = file("colmap-t265-cameras.txt");
    let Camera::OpenCvFisheye(camera) = colmap.cameras[1].camera else { panic!() };
    assert_eq!((colmap.format.name, colmap.cameras.len(), camera.k), ("colmap", 2, [-0.002, 0.039, -0.038, 0.007]));
    // The corner of the first pixel is COLMAP's origin.
    assert!((camera.cx - 416.746).abs() < 1e-12 && (camera.cy - 399.902).abs() < 1e-12);
    assert_eq!(file("colmap-simple-radial-cameras.txt").cameras.len(), 11);
    let ros = file("ros-pymvg.yaml");
    let Camera::OpenCv(camera) = ros.cameras[0].camera else { panic!() };
    assert_eq!(
        (ros.format.name, ros.cameras[0].name.as_str(), camera.distortion[3]),
        ("ros", "Basler_21029382", -0.003_935_978_428_520_19)
    );
    assert!(ros.cameras[0].notes[0].contains("`projection_matrix` is that of the rectified image"));
    let basalt = file("basalt-euroc-ds.json");
    let Camera::DoubleSphere(camera) = basalt.cameras[1].camera else { panic!() };
    assert_eq!((camera.xi, camera.alpha), (-0.213_008_353_848_093_28, 0.576_700_862_503_702_3));
    assert!(basalt.cameras[0].notes.iter().any(|note| note.contains("`vignette`")), "{:?}", basalt.cameras[0].notes);
    let kalibr = file("kalibr-4seasons-camchain.yaml");
    assert_eq!((kalibr.format.name, kalibr.cameras[0].pose_frame), ("kalibr", PoseFrame::Imu));
    let text = kalibr.cameras[0].notes.join("\n");
    assert!(text.contains("timeshift_cam_imu") && text.contains("differ by up to 4.19e-3"), "{text}");
    // 30 cm of baseline, which the file states as well.
    let [a, b] = [&kalibr.cameras[0], &kalibr.cameras[1]].map(|camera| camera.pose.unwrap());
    let baseline = a.position.iter().zip(b.position).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    assert!((baseline - 0.300_514).abs() < 1e-3, "{baseline}");
}

#[test]
#[cfg_attr(not(camera_files), ignore = "no camera files")]
fn samples_written_back_are_the_same_cameras() {
    for name in [
        "colmap-t265-cameras.txt",
        "colmap-simple-radial-cameras.txt",
        "ros-pymvg.yaml",
        "ros-utbm-bb2.yaml",
        "basalt-euroc-ds.json",
        "kalibr-4seasons-camchain.yaml",
        "mrcal-opencv5.cameramodel",
        "mrcal-opencv8.cameramodel",
    ] {
        let original = file(name);
        let again = read(&camera_text(original.format, &original.cameras).unwrap()).unwrap();
        assert_eq!((again.format, again.cameras.len()), (original.format, original.cameras.len()));
        for (a, b) in original.cameras.iter().zip(&again.cameras) {
            let values = |camera: &Camera| camera.parameters().iter().map(|p| p.value).collect::<Vec<_>>();
            let (x, y) = (values(&a.camera), values(&b.camera));
            let same = x.iter().zip(&y).all(|(x, y)| (x - y).abs() <= 1e-12 * x.abs());
            assert!(same && a.name == b.name && a.pose.is_some() == b.pose.is_some(), "{name}: {x:?} {y:?}");
        }
    }
}

/// The linear system's solution, by elimination.
fn solved(mut a: Vec<Vec<f64>>) -> Vec<f64> {
    let n = a.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&x, &y| a[x][i].abs().total_cmp(&a[y][i].abs())).unwrap();
        a.swap(i, pivot);
        for row in (0..n).filter(|row| *row != i) {
            let share = a[row][i] / a[i][i];
            let own = a[i].clone();
            a[row].iter_mut().zip(own).for_each(|(value, other)| *value -= share * other);
        }
    }
    (0..n).map(|i| a[i][n] / a[i][i]).collect()
}

/// Residuals, px, of the splines against a camera whose centre is moved by `v[3..]`, in units of the distance of the points, and turned by `v[..3]`.
fn residuals(spline: &Splined, camera: &Camera, v: &[f64]) -> Vec<f64> {
    let ImageSize { width, height } = camera.size();
    let mut out = Vec::new();
    for (x, y) in (0..20).flat_map(|x| (0..12).map(move |y| (x, y))) {
        let at = PixelPoint::new(f64::from(width - 1) * f64::from(x) / 19.0, f64::from(height - 1) * f64::from(y) / 11.0);
        let ray = camera.unproject(at).unwrap();
        let length = (ray.x * ray.x + ray.y * ray.y + ray.z * ray.z).sqrt();
        let p = [ray.x / length, ray.y / length, ray.z / length];
        let r = super::super::pose::of_rotation_vector([v[0], v[1], v[2]]);
        let [x, y, z] = std::array::from_fn(|i| (0..3).map(|k| r[i][k] * p[k]).sum::<f64>() + v[3 + i]);
        let found = spline.project(Ray { x, y, z }).unwrap();
        out.extend([found.x - at.x, found.y - at.y]);
    }
    out
}

#[test]
#[cfg_attr(not(camera_files), ignore = "no camera files")]
fn mrcal_s_splines_are_its_opencv8_camera() {
    // mrcal made the splines of this camera for points at 5 m, with the centre free: six parameters are the pose's.
    let camera = file("mrcal-opencv8.cameramodel").cameras[0].camera;
    let text = std::fs::read_to_string(path("mrcal-splined.cameramodel")).unwrap();
    let values = json::python(&text).unwrap().required("intrinsics").unwrap().row().unwrap();
    let spline = mrcal::splined("order=3_Nx=16_Ny=11_fov_x_deg=120", camera.size(), &values).unwrap();
    let mut v = vec![0.0; 6];
    for _ in 0..8 {
        let e = residuals(&spline, &camera, &v);
        let columns: Vec<Vec<f64>> = (0..6)
            .map(|i| {
                let mut moved = v.clone();
                moved[i] += 1e-6;
                residuals(&spline, &camera, &moved).iter().zip(&e).map(|(a, b)| (a - b) / 1e-6).collect()
            })
            .collect();
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let rows = columns.iter().map(|a| columns.iter().map(|b| product(a, b)).chain([-product(a, &e)]).collect()).collect();
        v.iter_mut().zip(solved(rows)).for_each(|(v, step)| *v += step);
    }
    let e = residuals(&spline, &camera, &v);
    let worst = e.chunks(2).map(|e| e[0].hypot(e[1])).fold(0.0, f64::max);
    assert!(worst < 0.2, "{worst} px after {v:?}");
}

#[test]
#[cfg_attr(not(camera_files), ignore = "no camera files")]
fn a_splined_camera_is_read_and_its_residual_said() {
    let found = file("mrcal-splined.cameramodel");
    let note = &found.cameras[0].notes[0];
    assert!(note.starts_with("a splined model, fitted by ") && note.contains("residuals 0."), "{note}");
    let splines = found.cameras[0].splines.as_ref().unwrap();
    // With the axes of the splines held it is 3.37 px.
    assert!(splines.residual_px < 3.38, "{note}");
    assert_eq!(splines.doubt().is_some_and(|doubt| doubt.contains("px off")), splines.residual_px > 0.5);
}

#[test]
#[cfg_attr(not(camera_files), ignore = "no camera files")]
fn a_rig_keeps_its_poses_from_tool_to_tool() {
    let kalibr = file("kalibr-4seasons-camchain.yaml");
    let basalt = super::super::format_named("basalt").unwrap();
    let there = read(&camera_text(basalt, &kalibr.cameras).unwrap()).unwrap();
    for (a, b) in kalibr.cameras.iter().zip(&there.cameras) {
        let (a, b) = (a.pose.unwrap(), b.pose.unwrap());
        // The file's rotations are none to the last bits; quaternions are.
        assert!(a.camera_from_world.as_flattened().iter().zip(b.camera_from_world.as_flattened()).all(|(a, b)| (a - b).abs() < 1e-5));
        assert!(a.position.iter().zip(b.position).all(|(a, b)| (a - b).abs() < 1e-12));
    }
}

/// One double sphere camera as Kalibr and as basalt write it, and one fisheye as ROS, COLMAP, kapture, Kalibr, camodocal, OpenSfM and OpenMVG do.
#[test]
fn one_camera_in_the_files_of_many_tools() {
    let size = ImageSize { width: 640, height: 480 };
    let sphere = Camera::from(DoubleSphere { size, fx: 300.0, fy: 301.0, cx: 319.5, cy: 239.0, xi: -0.2, alpha: 0.6 });
    let kalibr = "cam0:\n  camera_model: ds\n  intrinsics: [-0.2, 0.6, 300.0, 301.0, 319.5, 239.0]\n  distortion_model: none\n  \
                  distortion_coeffs: []\n  resolution: [640, 480]\n";
    let basalt = "{\"value0\": {\"intrinsics\": [{\"camera_type\": \"ds\", \"intrinsics\": {\"fx\": 300, \"fy\": 301, \"cx\": 319.5, \"cy\": 239, \
                  \"xi\": -0.2, \"alpha\": 0.6}}], \"resolution\": [[640, 480]]}}";
    for text in [kalibr, basalt] {
        assert_eq!(read(text).unwrap().cameras[0].camera, sphere, "{text}");
    }
    let fisheye = OpenCvFisheye { size, fx: 300.0, fy: 300.0, cx: 319.5, cy: 239.5, skew: 0.0, k: [0.1, -0.02, 0.0, 0.0] };
    let matrix = "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [300, 0, 319.5, 0, 300, 239.5, 0, 0, 1]\n";
    for text in [
        format!("image_width: 640\nimage_height: 480\n{matrix}distortion_model: equidistant\ndistortion_coefficients:\n  data: [0.1, -0.02, 0, 0]\n"),
        "# Camera list\n1 RADIAL_FISHEYE 640 480 300 320 240 0.1 -0.02\n".into(),
        "1 OPENCV_FISHEYE 640 480 300 300 320 240 0.1 -0.02 0 0\n".into(),
        "# kapture format: 1.1\ncam, left, camera, OPENCV_FISHEYE, 640, 480, 300, 300, 320, 240, 0.1, -0.02, 0, 0\n".into(),
        "cam0:\n  camera_model: pinhole\n  intrinsics: [300, 300, 319.5, 239.5]\n  distortion_model: equidistant\n  \
         distortion_coeffs: [0.1, -0.02, 0, 0]\n  resolution: [640, 480]\n"
            .into(),
        "%YAML:1.0\n---\nmodel_type: KANNALA_BRANDT\ncamera_name: a\nimage_width: 640\nimage_height: 480\nprojection_parameters:\n   k2: 0.1\n   \
         k3: -0.02\n   k4: 0.\n   k5: 0.\n   mu: 300.\n   mv: 300.\n   u0: 319.5\n   v0: 239.5\n"
            .into(),
        "{\"a\": {\"projection_type\": \"fisheye\", \"width\": 640, \"height\": 480, \"focal\": 0.46875, \"k1\": 0.1, \"k2\": -0.02}}".into(),
        "{\"camera_model\": \"OPENCV_FISHEYE\", \"w\": 640, \"h\": 480, \"fl_x\": 300, \"fl_y\": 300, \"cx\": 320, \"cy\": 240, \"k1\": 0.1, \
         \"k2\": -0.02}"
            .into(),
        "{\"sfm_data_version\": \"0.3\", \"intrinsics\": [{\"key\": 0, \"value\": {\"polymorphic_id\": 2147483649, \"polymorphic_name\": \"fisheye\", \
         \"ptr_wrapper\": {\"id\": 2147483649, \"data\": {\"value0\": {\"width\": 640, \"height\": 480, \"focal_length\": 300, \"principal_point\": \
         [319.5, 239.5]}, \"fisheye\": [0.1, -0.02, 0, 0]}}}}]}"
            .into(),
    ] {
        assert_eq!(read(&text).unwrap().cameras[0].camera, fisheye.into(), "{text}");
    }
}

#[test]
fn bundler_s_formula_is_what_is_read() {
    // P = R X + t, p = -P / P_z, p' = f (1 + k1 |p|^2 + k2 |p|^4) p from the middle, y up.
    let text = "# Bundle file v0.3\n2 0\n500 -0.1 0.02\n1 0 0\n0 1 0\n0 0 1\n1 2 -3\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n";
    let size = ImageSize { width: 640, height: 480 };
    let file = read_with(text, ReadOptions { size: Some(size), ..ReadOptions::default() }).unwrap();
    assert_eq!((file.cameras.len(), file.cameras[0].notes.len()), (1, 1));
    let (camera, pose) = (file.cameras[0].camera, file.cameras[0].pose.unwrap());
    let (world, t) = ([0.3, -0.2, -1.0], [1.0, 2.0, -3.0]);
    let p: [f64; 3] = std::array::from_fn(|i| world[i] + t[i]);
    let (u, v) = (-p[0] / p[2], -p[1] / p[2]);
    let s = 500.0 * (1.0 - 0.1 * (u * u + v * v) + 0.02 * (u * u + v * v).powi(2));
    let expected = PixelPoint::new(319.5 + s * u, 239.5 - s * v);
    // By the pose: y down, z forward.
    let d: [f64; 3] = std::array::from_fn(|i| world[i] - pose.position[i]);
    let c: [f64; 3] = std::array::from_fn(|row| (0..3).map(|k| pose.camera_from_world[row][k] * d[k]).sum());
    let found = camera.project(Ray { x: c[0], y: -c[1], z: -c[2] }).unwrap();
    assert!(found.distance(expected) < 1e-9, "{found:?} {expected:?}");
}
