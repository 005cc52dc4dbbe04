//! Files of today's versions, and FileStorages whose matrices have names of their own.

use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv};

use super::super::{Pose, PoseFrame, ReadOptions, camera_text, format_named};
use super::{read, read_with};

const SIZE: ImageSize = ImageSize { width: 640, height: 480 };

fn sized(text: &str) -> Result<super::CameraFile, String> {
    read_with(text, ReadOptions { size: Some(SIZE), ..ReadOptions::default() })
}

fn matrix(name: &str, focal: f64) -> String {
    format!("{name}: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ {focal}, 0., 320., 0., {focal}, 240., 0., 0., 1. ]\n")
}

fn row(name: &str, k1: f64) -> String {
    format!("{name}: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   data: [ {k1}, 0.02, 0.001, -0.002, 0. ]\n")
}

/// Names and, per camera, its focal length and k1.
fn cameras(text: &str) -> Vec<(String, f64, f64)> {
    let file = sized(&format!("%YAML:1.0\n---\n{text}")).unwrap();
    let of = |camera: &Camera| match camera {
        Camera::OpenCv(OpenCv { fx, distortion, .. }) => (*fx, distortion[0]),
        other => panic!("{other:?}"),
    };
    file.cameras.iter().map(|named| (named.name.clone(), of(&named.camera).0, of(&named.camera).1)).collect()
}

#[test]
fn matrices_are_found_by_what_they_are() {
    for [k, d] in
        [["K", "D"], ["mtx", "dist"], ["intrinsic_matrix", "distortion_coeffs"], ["cameraIntrinsics", "camDist"], ["M", "distCoeffs"]]
    {
        assert_eq!(cameras(&(row(d, -0.1) + &matrix(k, 500.0))), [(k.to_owned(), 500.0, -0.1)], "{k}, {d}");
    }
    // Two cameras, of which each matrix has coefficients whose name says the same beside what they are, in any order.
    for [k1, d1, k2, d2] in [
        ["M1", "D1", "M2", "D2"],
        ["cam_int", "cam_dist", "proj_int", "proj_dist"],
        ["left_camera_matrix", "left_distortion", "right_camera_matrix", "right_distortion"],
        ["K_0", "dist_0", "K_1", "dist_1"],
    ] {
        let others = matrix("R", 1.0) + &row("T", 0.5).replace("cols: 5", "cols: 3").replace(", 0.02, 0.001", "");
        let text = row(d2, -0.2) + &matrix(k1, 500.0) + &others.replace(", -0.002, 0.", ", 0.1, 0.2") + &matrix(k2, 600.0) + &row(d1, -0.1);
        assert_eq!(cameras(&text), [(k1.to_owned(), 500.0, -0.1), (k2.to_owned(), 600.0, -0.2)], "{text}");
    }
}

#[test]
fn matrices_that_do_not_belong_together_are_named() {
    let text = matrix("Kl", 500.0) + &matrix("Kr", 600.0) + &row("first", -0.1) + &row("second", -0.2);
    let error = sized(&format!("%YAML:1.0\n---\n{text}")).unwrap_err();
    for part in ["has no `camera_matrix`", "`Kl`, `Kr`", "`first`, `second`", "K1 and D1"] {
        assert!(error.contains(part), "{part}: {error}");
    }
}

#[test]
fn opencv_5_writes_matrices_of_one_dimension_and_json() {
    let head = "%YAML 1.2\n---\nimage_width: 640\nimage_height: 480\n".to_owned() + &matrix("camera_matrix", 500.0);
    let two = read(&(head.clone() + &row("distortion_coefficients", -0.1))).unwrap().cameras.remove(0);
    let nd = |sizes: &str| {
        let data = "data: [ -0.1, 0.02, 0.001, -0.002, 0. ]";
        read(&format!("{head}distortion_coefficients: !!opencv-nd-matrix\n   sizes: {sizes}\n   dt: d\n   {data}\n"))
    };
    for sizes in ["[ 5 ]", "[ 1, 5 ]", "[ 5, 1 ]"] {
        assert_eq!(nd(sizes).unwrap().cameras[0].camera, two.camera, "{sizes}");
    }
    for (sizes, expected) in
        [("[ 1, 5, 1 ]", "expected one or two sizes, found 3"), ("[ 0 ]", "whole number from 1"), ("[ 4 ]", "expected 4 numbers for 4 x 1")]
    {
        let error = nd(sizes).unwrap_err();
        assert!(error.contains(expected), "{sizes}: {error}");
    }
    let json = camera_text(format_named("opencv-json").unwrap(), std::slice::from_ref(&two)).unwrap();
    let read = read(&json).unwrap();
    assert_eq!((read.format.name, read.cameras[0].camera), ("opencv-json", two.camera));
}

#[test]
fn whole_numbers_are_numbers() {
    let text = matrix("camera_matrix", 500.0).replace("dt: d", "dt: i").replace('.', "") + &row("distortion_coefficients", -0.1);
    let found = sized(&format!("%YAML:1.0\n---\n{text}")).unwrap().cameras[0].camera;
    assert!(matches!(found, Camera::OpenCv(OpenCv { fx: 500.0, cy: 240.0, .. })), "{found:?}");
    let error = sized(&format!("%YAML:1.0\n---\n{}", text.replace("dt: i", "dt: 2i"))).unwrap_err();
    assert!(error.contains("found `2i`"), "{error}");
}

const MESSAGE: &str = "header:\n  seq: 3\n  frame_id: \"cam\"\nheight: 480\nwidth: 640\ndistortion_model: \"plumb_bob\"\nD: [-0.1, 0.02, 0.001, 0.002, 0.0]\n\
    K: [500.0, 0.0, 320.0, 0.0, 501.0, 240.0, 0.0, 0.0, 1.0]\nR: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]\n\
    P: [490.0, 0.0, 320.0, 0.0, 0.0, 490.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0]\nbinning_x: 0\nbinning_y: 0\nroi:\n  x_offset: 0\n  y_offset: 0\n  \
    height: 0\n  width: 0\n  do_rectify: False\n---\n";

#[test]
fn a_camera_info_message_is_read_as_it_is_printed() {
    let file = read(MESSAGE).unwrap();
    let named = &file.cameras[0];
    assert_eq!((file.format.name, named.camera.size()), ("ros-message", SIZE));
    assert!(
        matches!(named.camera, Camera::OpenCv(OpenCv { fx: 500.0, fy: 501.0, cx: 320.0, cy: 240.0, coefficients: 5, .. })),
        "{named:?}"
    );
    assert_eq!(named.notes, ["`P` is that of the rectified image, not of this one: left out"]);
    // ROS 2 prints small letters and lists line by line.
    let list = |name: &str, text: &str| {
        let (at, end) = (text.find(&format!("{name}: [")).unwrap(), text[text.find(&format!("{name}: [")).unwrap()..].find(']').unwrap());
        let numbers = text[at + 4..at + end].split(", ").map(|number| format!("- {number}\n")).collect::<String>();
        text.replace(&text[at..=at + end], &format!("{}:\n{}", name.to_lowercase(), numbers.trim_end()))
    };
    let small = ["D", "K", "R", "P"].iter().fold(MESSAGE.to_owned(), |text, name| list(name, &text));
    assert_eq!(read(&small).unwrap().cameras[0].camera, named.camera);
    let fisheye = MESSAGE.replace("plumb_bob", "equidistant").replace(", 0.0]\nK", "]\nK");
    assert!(matches!(read(&fisheye).unwrap().cameras[0].camera, Camera::OpenCvFisheye(_)));
    let binned = read(&MESSAGE.replace("binning_x: 0", "binning_x: 4")).unwrap().cameras.remove(0);
    assert!(binned.notes[0].contains("`binning_x: 4`, `binning_y: 1`: the images have 160 x 480 px"), "{:?}", binned.notes);
    let part = read(&MESSAGE.replace("  width: 0", "  width: 320")).unwrap().cameras.remove(0);
    assert!(part.notes[0].contains("`roi`: the images are 320 x 0 px"), "{:?}", part.notes);
    for (from, to, expected) in [
        ("K: [500.0", "K: [0.0", "f:8, `K`"),
        ("plumb_bob", "bent", "model `bent` is not known"),
        ("binning_x: 0", "binning_x: -1", "f:11, `binning_x`: expected a whole number from 0"),
        ("binning_x", "lens_binning", "`lens_binning`: is no key that is known of a lens"),
    ] {
        let error = read(&MESSAGE.replace(from, to)).unwrap_err();
        assert!(error.contains(expected), "{to}: {error}");
    }
}

#[test]
fn both_names_of_mrcal_s_pose_say_the_same() {
    let of = |rt: &str| {
        read(&format!(
            "{{\n 'lensmodel': 'LENSMODEL_OPENCV4',\n 'intrinsics': [ 501, 502, 320, 240, -0.1, 0.02, 0.001, 0.002,],\n 'rt_cam_ref': [ 0, 0, 0, 0.3, 0, 0,],\n \
             'extrinsics': [ 0, 0, 0, {rt}, 0, 0,], # for compatibility\n 'imagersize': [ 640, 480,],\n}}\n"
        ))
    };
    assert_eq!(of("0.3").unwrap().cameras[0].pose.unwrap().position, [-0.3, 0.0, 0.0]);
    let error = of("0.4").unwrap_err();
    assert!(error.contains("f:5, `extrinsics`: says another pose than `rt_cam_ref`"), "{error}");
}

#[test]
fn the_first_camera_of_a_chain_may_have_a_pose_of_its_own() {
    let camera = |index: usize, x: f64| {
        format!(
            "cam{index}:\n  camera_model: pinhole\n  intrinsics: [500.0, 502.0, 320.0, 240.0]\n  distortion_model: radtan\n  \
             distortion_coeffs: [-0.1, 0.02, 0.001, 0.002]\n  T_cn_cnm1:\n  - [1.0, 0.0, 0.0, {x}]\n  - [0.0, 1.0, 0.0, 0.0]\n  - [0.0, 0.0, 1.0, 0.0]\n  \
             - [0.0, 0.0, 0.0, 1.0]\n  resolution: [640, 480]\n"
        )
    };
    let text = camera(0, 0.1) + &camera(1, 0.2);
    let file = read(&text).unwrap();
    let of = |file: &super::CameraFile| {
        file.cameras.iter().map(|named| (named.pose.map(|pose: Pose| pose.position[0]), named.pose_frame)).collect::<Vec<_>>()
    };
    let [(Some(first), PoseFrame::Rig), (Some(second), PoseFrame::Rig)] = of(&file)[..] else { panic!("{:?}", of(&file)) };
    assert!((first + 0.1).abs() < 1e-12 && (second + 0.3).abs() < 1e-12, "{first} {second}");
    // Written, it is there again.
    let again = read(&camera_text(format_named("kalibr").unwrap(), &file.cameras).unwrap()).unwrap();
    assert_eq!(of(&again), of(&file));
}

#[test]
fn a_fisheye_file_is_asked_for_and_no_other_is_called_exact() {
    use super::super::conversion::converted;
    use super::super::target::{Given, goal};
    use calibench_model::camera::{Omni, OpenCvFisheye, TangentialOrder};
    use calibench_model::convert::{ConvertOptions, Method};
    let mut distortion = [0.0; 14];
    distortion[0] = -0.1;
    let (fx, fy, cx, cy) = (500.0, 501.0, 320.0, 240.0);
    let pinhole = OpenCv { size: SIZE, fx, fy, cx, cy, distortion, coefficients: 4 };
    let mei = Omni { size: SIZE, fx: 900.0, fy, cx, cy, xi: 0.9, k: [-0.1, 0.02], p: [0.0; 2] };
    let to = |camera: Camera| {
        let source = super::super::NamedCamera::new("", camera);
        let given = Given { source: &source, pitch_um: None, base_mm: None, order: TangentialOrder::OpenCv, output: None };
        converted(
            &source,
            &goal("opencv-fisheye", &given).unwrap(),
            None,
            None,
            &ConvertOptions { accept: true, ..ConvertOptions::default() },
        )
    };
    for camera in [pinhole.into(), mei.into()] {
        if let Ok(found) = to(camera) {
            assert!(
                found.conversion.method == Method::Fitted && matches!(found.camera.camera, Camera::OpenCvFisheye(_)),
                "{:?}",
                found.camera
            );
        }
    }
    let skewed = OpenCvFisheye { size: SIZE, fx, fy, cx, cy, skew: 0.01, k: [0.01, 0.0, 0.0, 0.0] };
    assert_eq!(to(skewed.into()).unwrap().conversion.method, Method::Exact);
}

#[test]
fn rays_beyond_90_degrees_are_said_where_the_tool_does_not_picture_them() {
    use super::super::fit::losses;
    let size = ImageSize { width: 1000, height: 1000 };
    let of = |f: f64| calibench_model::camera::OpenCvFisheye { size, fx: f, fy: f, cx: 499.5, cy: 499.5, skew: 0.0, k: [0.0; 4] };
    let wide = super::super::NamedCamera::new("", of(300.0).into());
    for (name, is_said) in [
        ("opencv-yaml", true),
        ("opencv-xml", true),
        ("opencv-json", true),
        ("colmap", true),
        ("kapture", true),
        ("ros", true),
        ("basalt", false),
    ] {
        let lost = losses(format_named(name).unwrap(), &wide);
        assert_eq!(lost.iter().any(|lost| lost.starts_with("30.") && lost.contains("942 px elsewhere")), is_said, "{name}: {lost:?}");
    }
    let narrow = super::super::NamedCamera::new("", of(500.0).into());
    assert!(losses(format_named("opencv-yaml").unwrap(), &narrow).is_empty());
}

#[test]
fn a_camera_matrix_that_is_not_of_the_whole_sensor_is_said() {
    let text = MESSAGE.replace("height: 480\nwidth: 640", "height: 1920\nwidth: 2560");
    let notes = read(&text).unwrap().cameras.remove(0).notes;
    assert!(
        notes.iter().any(|note| note.contains("principal point") && note.contains("37 % of the width") && note.contains("4 x 4")),
        "{notes:?}"
    );
    assert!(!read(MESSAGE).unwrap().cameras[0].notes.iter().any(|note| note.contains("principal point")));
}
