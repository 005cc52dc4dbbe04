//! What is said of a file that no format recognises.

use super::super::{ReadOptions, format_named, parse_camera};
use super::read;

#[test]
fn an_unknown_file_gets_one_line_with_the_two_nearest_readers() {
    for (text, looks, near) in [
        (
            "cam0:\n  camera_modell: pinhole\n  intrinsics: [500, 501, 320, 240]\n  distortion_coeffs: [0.1, 0, 0, 0]\n  resolution: [640, 480]\n",
            "lines with the names `cam0`, `camera_modell`, `intrinsics`, `distortion_coeffs`, `resolution`",
            &["kalibr (no `cam0:` with"][..],
        ),
        (
            "{\"fx\": 500, \"w\": 640, \"h\": 480, \"cx\": 3, \"frames\": [{\"file_path\": \"a\", \"transform_matrix\": []}]}",
            "JSON with the keys `fx`, `w`, `h`, `cx`, `frames`",
            &["the nearest readers are nerfstudio (no JSON with `fl_x`) and "],
        ),
        (
            "<calib><f>500</f><k1>0.1</k1><projection>frame</projection></calib>",
            "XML of root `calib`",
            &["metashape (the root element is `calib`, not `calibration`)"],
        ),
        (
            "[{\"focal_length\": 3, \"principal_point\": [1, 2]}, {}]",
            "a JSON list of 2, the first with the keys `focal_length`, `principal_point`",
            &["theia"],
        ),
        ("{\"a\": 1,}", "text that begins as JSON does and is none: line 1: expected a name in quotes", &["no reader comes near"]),
        ("This is a note about\nsomething else\n", "text that begins with `This is a note about`", &["no reader comes near"]),
    ] {
        let error = read(text).unwrap_err();
        assert!(error.starts_with(&format!("f: no camera file that is known: {looks}")), "{error}");
        assert!(near.iter().all(|near| error.contains(near)), "{near:?}: {error}");
        assert!(error.ends_with("; `calibench list formats` lists all") && !error.contains('\n') && error.len() < 400, "{error}");
    }
}

/// Files that lack what makes them one of a format are near it.
#[test]
fn what_is_nearly_a_file_of_a_format_is_near_it() {
    for (text, near) in [
        (
            "<calibration><cameras><camera serial=\"1\"><intrinsic centerPointU=\"1\" focallength=\"9\"/></camera></cameras></calibration>",
            "qualisys (no `intrinsic` with",
        ),
        ("Model = CAHVOR = perspective\nDimensions = 640 480\nC = 1 2 3\nA = 0 0 1\nH = 500 0 320\n", "cahvor (no `C = `, "),
        (
            "polynomial coefficients, DIRECT mapping function\n5 -200 0 0 0 0\ncenter\n240 320\naffine parameters\n1 0 0\n",
            "ocam (no `#polynomial",
        ),
        ("NVM_V2\nFixedK 1 2 3 4 5\n", "nvm (no `NVM_V3`)"),
        ("CalibratedFocalLength = 3666\nDewarpFlag = 0\nGimbalYawDegree = 3\n", "dji (no `DewarpData`)"),
    ] {
        let error = read(text).unwrap_err();
        assert!(error.contains(near) && !error.contains('\n'), "{near}: {error}");
    }
}

#[test]
fn bytes_are_called_what_they_are() {
    for (bytes, expected) in [
        (&b"\x89PNG\r\n\x1a\n\0\0"[..], "f: no camera file that is known: a PNG picture: `calibrate` and `judge` take photographs"),
        (&b"MATLAB 5.0 MAT-file\0\0\xff"[..], "a MAT-file: write jsonencode"),
        (&b"\x80\x04\x95\0\0"[..], "a Python pickle: save arrays with np.savez"),
        (&b"\xc3\x28\0\x01\x02"[..], "expected text in UTF-8"),
    ] {
        let error = parse_camera("f", bytes, &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains(expected), "{expected}: {error}");
    }
}

/// A format that is asked for says its own reason.
#[test]
fn a_format_that_was_asked_for_says_why_it_is_none() {
    let options = ReadOptions { from: format_named("kalibr"), ..ReadOptions::default() };
    let error = super::read_with("{\"a\": 1}", options).unwrap_err();
    assert!(error.starts_with("f: is no file of kalibr: ") && !error.contains("nearest"), "{error}");
}

/// Every format whose files have names says them.
#[test]
fn formats_have_words() {
    let without: Vec<&str> = super::super::FORMATS.iter().filter(|format| format.words.is_empty()).map(|format| format.name).collect();
    assert_eq!(without, ["numpy", "pix4d-pmatrix", "colmap-bin", "bal"]);
}
