//! Gyroflow's lens profiles, MATLAB's structs and USD's cameras.

use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv, OpenCvFisheye};

use super::super::{NamedCamera, ReadOptions, camera_text, format_named};
use super::{read, read_with, seed};

const SIZE: ImageSize = ImageSize { width: 640, height: 480 };

fn one(text: &str) -> NamedCamera {
    read(text).unwrap_or_else(|error| panic!("{error}")).cameras.remove(0)
}

fn refused(text: &str, changes: &[(&str, &str, &str)]) {
    for (from, to, expected) in changes {
        assert!(text.contains(from), "{from}");
        let error = read(&text.replacen(from, to, 1)).unwrap_err();
        assert!(error.contains(expected) && error.starts_with("f:"), "{to}: {error}");
    }
}

#[test]
fn a_lens_profile_is_read() {
    let text = seed("gyroflow.json");
    let named = one(&text);
    assert_eq!(named.name, "Maker X1 Wide");
    assert!(matches!(named.camera, Camera::OpenCvFisheye(OpenCvFisheye { cx: 322.5, cy: 238.0, k: [0.05, -0.02, 0.01, -0.003], .. })));
    // Without the switch Gyroflow takes the middle, and so do we; that is said.
    let named = one(&text.replace("\"asymmetrical\": true", "\"asymmetrical\": false"));
    assert!(matches!(named.camera, Camera::OpenCvFisheye(OpenCvFisheye { cx: 320.0, cy: 240.0, .. })));
    assert!(named.notes[0].starts_with("`asymmetrical` is not set"), "{:?}", named.notes);
    let of = |model: &str, d: &str| {
        let text = text.replace("\"digital_lens\": null", &format!("\"distortion_model\": \"{model}\""));
        read(&text.replace("0.05, -0.02, 0.01, -0.003", d).replace("301.0", "300.0")).map(|file| file.cameras[0].camera)
    };
    assert!(matches!(of("opencv_standard", "-0.1, 0.02, 0.001, 0.002, 0.003"), Ok(Camera::OpenCv(OpenCv { coefficients: 5, .. }))));
    assert!(matches!(of("poly5", "-0.1, 0.02, 0.0, 0.0"), Ok(Camera::OpenCv(_))));
    assert!(matches!(of("ptlens", "0.01, -0.03, 0.005"), Ok(Camera::PtLens(_))));
    assert!(of("gopro", "1, 2, 3, 4").unwrap_err().contains("`distortion_model`: `gopro` is no model here"));
    assert!(of("poly3", "1, 2").unwrap_err().contains("expected 1 coefficients of poly3, found 2"));
    refused(
        &text,
        &[
            ("\"digital_lens\": null", "\"digital_lens\": \"gopro_superview\"", "f:20, `digital_lens`: the camera warps its pictures"),
            (
                "\"input_horizontal_stretch\": 1.0",
                "\"input_horizontal_stretch\": 1.33",
                "f:8, `input_horizontal_stretch`: the pictures are stretched 1.33 times",
            ),
            ("[300.0, 0.0, 322.5]", "[0.0, 0.0, 322.5]", "f:16, `fisheye_params.camera_matrix`: expected focal lengths above zero"),
            ("0.05, ", "", "f:17, `fisheye_params.distortion_coeffs`: expected 4 coefficients of the fisheye camera, found 3"),
            ("\"w\": 640", "\"w\": 0", "`calib_dimension.w`: expected a whole number of pixels"),
            ("\"RMS_error\"", "\"wobble\"", "`fisheye_params.wobble`: is no key that is known of a lens"),
        ],
    );
}

#[test]
fn a_struct_of_matlab_s_counts_from_one() {
    let text = seed("matlab.json");
    let expected = OpenCv { size: SIZE, fx: 500.0, fy: 501.0, cx: 320.0, cy: 240.0, distortion: [0.0; 14], coefficients: 4 };
    let named = one(&text);
    let Camera::OpenCv(found) = named.camera else { panic!("{named:?}") };
    assert_eq!((found.cx, found.cy, found.size), (expected.cx, expected.cy, SIZE));
    assert_eq!(found.distortion[..4], [-0.1, 0.02, 0.001, -0.002]);
    // The older matrix is the transpose; newer structs hold the lens as a part.
    let older = text.replace("\"K\":[[500,0,321],[0,501,241],[0,0,1]]", "\"IntrinsicMatrix\":[[500,0,0],[0,501,0],[321,241,1]]");
    assert_eq!(one(&older).camera, named.camera);
    let newer = "{\"Intrinsics\": {\"FocalLength\": [500, 501], \"PrincipalPoint\": [321, 241], \"ImageSize\": [480, 640], \"Skew\": 0,\n\
        \"RadialDistortion\": [-0.1, 0.02], \"TangentialDistortion\": [0.001, -0.002]}, \"WorldUnits\": \"mm\"}";
    assert_eq!(one(newer).camera, named.camera);
    let open = text.replace("[480,640]", "[]");
    assert!(read(&open).unwrap_err().contains("does not state the size"));
    assert_eq!(read_with(&open, super::sized_options(SIZE)).unwrap().cameras[0].camera, named.camera);
    refused(
        &text,
        &[
            ("[0,501,241]", "[3,501,241]", "f:3, `K`: expected fx, s, cx; 0, fy, cy; 0, 0, 1"),
            ("[-0.1,0.02]", "[-0.1,0.02,1,2]", "f:1, `RadialDistortion`: expected 2 or 3 numbers, found 4"),
            ("[0.001,-0.002]", "[0.001]", "f:1, `TangentialDistortion`: expected 2 numbers, found 1"),
            ("[480,640]", "[480]", "f:1, `ImageSize`: expected rows and columns, found 1 values"),
            ("\"NumPatterns\"", "\"MappingCoefficients\"", "`MappingCoefficients`: is no key that is known of a lens"),
        ],
    );
}

#[test]
fn cameras_of_a_stage_are_read() {
    let text = seed("usd.usda");
    let file = read(&text).unwrap();
    let [left, right] = &file.cameras[..] else { panic!("{file:?}") };
    assert_eq!((left.name.as_str(), right.name.as_str()), ("left", "right"));
    let Camera::OpenCv(camera) = left.camera else { panic!("{left:?}") };
    assert_eq!((camera.fy, camera.distortion[..5].to_vec(), camera.coefficients), (501.0, vec![-0.1, 0.0, 0.0, 0.002, 0.0], 5));
    assert!(matches!(right.camera, Camera::OpenCvFisheye(OpenCvFisheye { k: [0.02, 0.0, 0.0, 0.0], .. })));
    refused(
        &text,
        &[
            (
                "\"opencvPinhole\"",
                "\"ftheta\"",
                "f:16, `World/left.model`: `ftheta` is no model here; expected opencvPinhole or opencvFisheye",
            ),
            ("fx = 500", "fx = 0", "`World/left.opencvPinhole:fx`: expected a number above zero"),
            ("k1 = -0.1", "k1 = x", "f:22, `World/left.opencvPinhole:k1`: expected a finite number"),
            ("(640, 480)", "(640)", "f:21, `World/left.opencvPinhole:imageSize`: expected columns and rows"),
            ("opencvPinhole:p2", "opencvPinhole:k9", "f:23, `World/left.opencvPinhole:k9`: is no key that is known of a lens"),
        ],
    );
}

#[test]
fn they_are_written_and_read_again() {
    let mut distortion = [0.0; 14];
    distortion[..5].copy_from_slice(&[-0.1, 0.02, 1e-3, -2e-3, 1e-9]);
    let five = OpenCv { size: SIZE, fx: 500.1, fy: 501.0, cx: 320.25, cy: 240.0, distortion, coefficients: 5 };
    let round = OpenCvFisheye { size: SIZE, fx: 500.1, fy: 501.0, cx: 320.25, cy: 240.0, skew: 0.0, k: [0.1, -0.02, 3e-9, 1e-4] };
    for (format, camera) in
        [("gyroflow", Camera::from(five)), ("gyroflow", round.into()), ("matlab", five.into()), ("usd", five.into()), ("usd", round.into())]
    {
        let format = format_named(format).unwrap();
        let text = camera_text(format, &[NamedCamera::new("left_1", camera)]).unwrap();
        let found = read_with(&text, ReadOptions::default()).unwrap_or_else(|error| panic!("{error}\n{text}")).cameras.remove(0);
        assert!(super::difference(&camera, &found.camera) < 1e-15, "{text}");
        assert!(format.name == "matlab" || found.name == "left_1", "{text}");
    }
    assert_eq!(one(&seed("matlab.json")).camera.size(), SIZE);
}
