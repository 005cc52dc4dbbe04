//! Which format a file is of, where more than one might be.

#![cfg_attr(not(camera_files), allow(dead_code, unused_imports))]

use std::path::Path;

use calibench_model::camera::{Camera, CameraModel, ImageSize};

use super::super::{ReadOptions, format_named, read_camera_with};
use super::read_with;

const SIZE: Option<ImageSize> = Some(ImageSize { width: 1280, height: 960 });

fn of(size: Option<ImageSize>, from: Option<&str>) -> ReadOptions {
    ReadOptions { size, from: from.map(|name| format_named(name).unwrap()), ..ReadOptions::default() }
}

fn focal(camera: &Camera) -> f64 {
    camera.parameters()[0].value
}

#[test]
fn colmap_s_list_needs_no_comment() {
    let distortion = "-0.1 0.02 1e-3 2e-3 0.01 0.02 -0.003 0.004";
    for model in ["FULL_OPENCV", "THIN_PRISM_FISHEYE"] {
        let text = format!("1 {model} 1280 960 900 901 640 480 {distortion}\n2 PINHOLE 1280 960 900 900 640 480\n");
        for size in [None, SIZE] {
            let file = read_with(&text, of(size, None)).unwrap();
            assert_eq!((file.format.name, file.cameras.len(), focal(&file.cameras[0].camera)), ("colmap", 2, 900.0));
        }
    }
}

#[test]
fn two_formats_that_read_different_cameras_are_an_error_that_lists_them() {
    // k3, k4, k5 of length one: the third row of a rotation.
    let text = "1 FULL_OPENCV 1280 960 900 901 640 480 -0.1 0.02 1e-3 2e-3 0 0 1 0\n";
    let error = read_with(text, of(SIZE, None)).unwrap_err();
    for said in ["f: may be a file of pix4d-pmatrix or colmap", "colmap: 1 of 1280 x 960 px, fx 900", "--from FORMAT"] {
        assert!(error.contains(said), "{error}");
    }
    // One of them cannot read it: that is no proof for the other.
    assert!(read_with(text, of(None, None)).unwrap_err().contains("pix4d-pmatrix: does not state the size"));
    for format in ["colmap", "pix4d-pmatrix"] {
        assert_eq!(read_with(text, of(SIZE, Some(format))).unwrap().format.name, format);
    }
    let error = read_with(text, of(SIZE, Some("ros"))).unwrap_err();
    assert!(error.contains("is no file of ros: no `distortion_model:`; it is one of pix4d-pmatrix or colmap"), "{error}");
}

#[test]
fn two_formats_that_read_the_same_cameras_are_no_doubt() {
    let text = |fc: &str| {
        format!(
            "image_width: 1280\nimage_height: 960\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [900, 0, 640, 0, 901, 480, 0, 0, 1]\n\
             distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.1, 0.02, 0, 0, 0]\n\
             matlab: |\n  fc = [ {fc} ; 901 ];\n  cc = [ 640 ; 480 ];\n  kc = [ -0.1 ; 0.02 ; 0 ; 0 ; 0 ];\n  nx = 1280;\n  ny = 960;\n"
        )
    };
    for same in ["900", "900.0000000001"] {
        assert_eq!(read_with(&text(same), of(None, None)).unwrap().format.name, "ros");
    }
    // 1e-5 px of the focal length are 7e-6 px at the side of the frame.
    let error = read_with(&text("900.00001"), of(None, None)).unwrap_err();
    assert!(error.contains("ros or caltech") && error.contains("caltech: 1 of 1280 x 960 px, fx 900.000010 px"), "{error}");
}

#[test]
#[cfg_attr(not(camera_files), ignore = "no camera files")]
fn the_tools_own_files_are_of_one_format() {
    let folder = Path::new(option_env!("CALIBENCH_CAMERA_FILES").unwrap_or(""));
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("");
        if ["md", "xyz"].contains(&extension) {
            continue;
        }
        let size = path.ends_with("pix4d-pmatrix.txt").then_some(ImageSize { width: 5472, height: 3648 });
        read_camera_with(&path, &of(size, None)).unwrap_or_else(|error| panic!("{error}"));
        count += 1;
    }
    assert!(count >= 17, "{count} files");
}
