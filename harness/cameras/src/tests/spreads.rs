//! Standard deviations in files of OpenCV's interactive calibration.

use super::super::{NamedCamera, camera_text, format_named};
use super::read;

fn matrix(name: &str, rows: usize, columns: usize, data: &str) -> String {
    format!("<{name} type_id=\"opencv-matrix\"><rows>{rows}</rows><cols>{columns}</cols><dt>d</dt><data>{data}</data></{name}>\n")
}

/// A file as the tool writes it, with these standard deviations.
fn file(of_matrix: &str, of_lens: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<opencv_storage>\n<framesCount>21</framesCount>\n<cameraResolution>1280 720</cameraResolution>\n{}{}{}{}\
         <avg_reprojection_error>0.3</avg_reprojection_error>\n</opencv_storage>\n",
        matrix("cameraMatrix", 3, 3, "1250 0 660 0 1250 360 0 0 1"),
        matrix("cameraMatrix_std_dev", 4, 1, of_matrix),
        matrix("dist_coeffs", 1, 5, "0.1 -0.8 0 0 1.6"),
        matrix("dist_coeffs_std_dev", 5, 1, of_lens),
    )
}

fn camera(text: &str) -> NamedCamera {
    read(text).unwrap_or_else(|error| panic!("{error}")).cameras.remove(0)
}

#[test]
fn they_are_the_roots_of_variances_and_zeros_are_held() {
    let camera = camera(&file("0 12.5 2 3", "0.25 0.5 0 0 4"));
    let covariance = camera.covariance.unwrap();
    assert_eq!(covariance.parameters, ["fx", "fy", "cx", "cy", "k1", "k2", "k3"]);
    let n = covariance.parameters.len();
    let variances: Vec<f64> = (0..n).map(|i| covariance.values[i * n + i]).collect();
    assert_eq!(variances, [156.25, 156.25, 4.0, 9.0, 0.0625, 0.25, 16.0]);
    assert!(camera.notes.iter().any(|note| note.contains("fx has no standard deviation of its own")), "{:?}", camera.notes);
    assert!(!camera.notes.iter().any(|note| note.contains("std_dev")), "{:?}", camera.notes);
}

/// With the ratio of the focal lengths held, fx is fy times it and nothing else.
#[test]
fn an_fx_that_is_tied_to_fy_has_its_variance() {
    let wide = file("0 12.5 2 3", "0.25 0.5 0 0 4").replace("1250 0 660", "2500 0 660");
    let flagged = |keys: &str| wide.replace("<framesCount>21</framesCount>", keys);
    for keys in [
        "",
        "<flags>2</flags>",
        "<flags>6</flags>",
        "<fix_aspect_ratio>2.</fix_aspect_ratio>",
        "<aspectRatio>2.</aspectRatio><flags>2</flags>",
    ] {
        let found = camera(&flagged(keys));
        let covariance = found.covariance.clone().unwrap();
        let n = covariance.parameters.len();
        assert_eq!(covariance.parameters[..2], ["fx", "fy"], "{keys}");
        assert_eq!(
            [covariance.values[0], covariance.values[1], covariance.values[n], covariance.values[n + 1]],
            [625.0, 312.5, 312.5, 156.25]
        );
        assert_eq!(covariance.values.iter().filter(|value| **value != 0.0).count(), n + 2, "{keys}");
        for format in ["opencv-yaml", "opencv-xml"] {
            let text = camera_text(format_named(format).unwrap(), std::slice::from_ref(&found)).unwrap();
            assert_eq!(camera(&text).covariance, found.covariance, "{text}");
        }
    }
    let free = camera(&flagged("<flags>4</flags>"));
    assert_eq!(free.covariance.unwrap().parameters[0], "fy");
    assert!(free.notes.iter().any(|note| note.contains("the flags do not tie it to fy")), "{:?}", free.notes);
}

#[test]
fn they_go_into_opencv_s_files() {
    let source = camera(&file("10 12.5 2 3", "0.25 0.5 0.125 0 4"));
    for format in ["opencv-yaml", "opencv-xml"] {
        let text = camera_text(format_named(format).unwrap(), std::slice::from_ref(&source)).unwrap();
        assert_eq!(camera(&text).covariance, source.covariance, "{text}");
    }
}

#[test]
fn wrong_ones_are_refused() {
    let error = read(&file("0 -12.5 2 3", "0 0 0 0 0")).unwrap_err();
    assert!(error.contains("`cameraMatrix_std_dev`: expected standard deviations from 0, found -12.5"), "{error}");
    let error = read(
        &file("1 2 2 3", "0 0 0 0 0")
            .replace("<rows>5</rows><cols>1</cols><dt>d</dt><data>0 0 0 0 0", "<rows>6</rows><cols>1</cols><dt>d</dt><data>0 0 0 0 0 1"),
    );
    assert!(error.unwrap_err().contains("has 6 standard deviations, the camera 5 such parameters"));
}
