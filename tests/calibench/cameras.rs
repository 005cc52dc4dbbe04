//! Cameras as a user converts them.

use std::path::{Path, PathBuf};

use crate::project::{copy, data, root, run, stderr, stdout};

/// OpenCV's YAML of a camera with barrel distortion and decentring coefficients that differ.
pub const CAMERA: &str = "%YAML:1.0\n---\nimage_width: 1600\nimage_height: 1200\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   \
    data: [ 1500., 0., 810., 0., 1502., 590., 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   \
    data: [ -1.0e-01, 4.0e-02, 1.0e-03, -3.0e-04, 0. ]\n";

pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("camera.yml"), CAMERA).unwrap();
    folder
}

pub fn good(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
    stdout(&output) + &stderr(&output)
}

#[test]
fn there_and_back_is_the_same_camera() {
    let folder = folder();
    assert!(good(folder.path(), &["convert", "camera.yml", "--to", "metashape", "-o", "m.xml"]).contains("exact"));
    assert!(good(folder.path(), &["convert", "m.xml", "--to", "opencv", "-o", "back.xml"]).contains("exact"));
    let text = good(folder.path(), &["diff", "camera.yml", "back.xml"]);
    let rms: f64 = text.split_whitespace().nth(1).unwrap().parse().unwrap();
    assert!(rms < 1e-9, "{text}");
    assert!(good(folder.path(), &["camera", "back.xml"]).contains("opencv-xml"));
}

#[test]
fn older_agisoft_files_are_written_and_read_again() {
    let folder = folder();
    for (to, file) in [("photoscan", "old.xml"), ("agisoft-lens", "lens.xml")] {
        assert!(good(folder.path(), &["convert", "camera.yml", "--to", to, "-o", file]).contains("exact"), "{to}");
        let text = good(folder.path(), &["diff", "camera.yml", file]);
        let rms: f64 = text.split_whitespace().nth(1).unwrap().parse().unwrap();
        assert!(rms < 1e-9, "{to}: {text}");
    }
}

#[test]
fn a_difference_is_told_apart_where_points_were_measured() {
    let folder = folder();
    good(folder.path(), &["convert", "camera.yml", "--to", "photogrammetric", "--pitch", "4", "-o", "p.toml"]);
    let row = |i: i32| format!("a.png,t{i},{},{}\n", 300 + 40 * (i % 7), 250 + 40 * (i / 7));
    std::fs::write(folder.path().join("points.csv"), format!("image,target,x,y\n{}", (0..49).map(row).collect::<String>())).unwrap();
    let text = good(folder.path(), &["diff", "camera.yml", "p.toml", "--points", "points.csv", "--plot", "d.png"]);
    let after = |word: &str| -> f64 { text.split(word).nth(1).and_then(|t| t.split_whitespace().next()).unwrap().parse().unwrap() };
    assert!(text.contains("the best at the points") && after("inside ") < after("outside "), "{text}");
    assert!(image::open(folder.path().join("d.png")).unwrap().width() > 800);
}

#[test]
fn a_fitted_conversion_says_how_far_it_is_off_and_draws_it() {
    let folder = folder();
    let arguments = ["convert", "camera.yml", "--to", "photogrammetric", "--pitch", "4", "-o", "p.toml", "--plot", "p.png"];
    let text = good(folder.path(), &arguments);
    assert!(text.contains("fitted") && text.contains("px RMS"), "{text}");
    assert!(image::open(folder.path().join("p.png")).unwrap().width() > 800);
    let stated: f64 = text.split(": residuals ").nth(1).and_then(|t| t.split_whitespace().next()).map(|t| t.parse().unwrap()).unwrap();
    // The difference of the two files, found on its own way, is what the conversion stated.
    let diff = good(folder.path(), &["diff", "camera.yml", "p.toml", "--no-rotation"]);
    let found: f64 = diff.split_whitespace().nth(1).unwrap().parse().unwrap();
    assert!((found - stated).abs() < 0.2 * stated + 1e-6, "{stated} {diff}");
    assert!(stated < 0.5, "{text}");
}

#[test]
fn the_direct_conversion_costs_more_than_the_fit() {
    let folder = folder();
    let naive = good(folder.path(), &["convert", "camera.yml", "--to", "photogrammetric", "--pitch", "4", "--naive", "-o", "n.toml"]);
    let rms: f64 = naive.split_whitespace().nth(1).unwrap().parse().unwrap();
    assert!(rms > 0.5, "{naive}");
}

#[test]
fn a_fold_is_shown_and_refused() {
    let folder = folder();
    std::fs::write(folder.path().join("fold.yml"), CAMERA.replace("-1.0e-01, 4.0e-02", "-9.0e-01, 0.0e-00")).unwrap();
    assert!(good(folder.path(), &["camera", "fold.yml"]).contains("folds over"));
    let output = run(folder.path(), &["convert", "fold.yml", "--to", "photogrammetric", "--pitch", "4"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("folds over") && stderr(&output).contains("--radius PX"), "{}", stderr(&output));
    good(folder.path(), &["convert", "fold.yml", "--to", "photogrammetric", "--pitch", "4", "--radius", "500", "--accept"]);
    // The same camera in other units folds as well, and that is said.
    assert!(
        good(folder.path(), &["convert", "fold.yml", "--to", "metashape", "-o", "fold.xml"]).contains("warning: the camera folds over")
    );
}

#[test]
fn bad_input_is_named() {
    let folder = folder();
    std::fs::write(folder.path().join("short.yml"), CAMERA.replace(", 0. ]\n", " ]\n")).unwrap();
    std::fs::write(folder.path().join("text"), "no camera").unwrap();
    std::fs::write(folder.path().join("small.yml"), CAMERA.replace("1600", "1500")).unwrap();
    for (arguments, expected) in [
        (&["camera", "none.yml"][..], "none.yml"),
        (&["camera", "text"], "no camera file that is known: text that begins with `no camera`; no reader comes near"),
        (&["camera", "short.yml"], "short.yml"),
        (&["convert", "camera.yml", "--to", "metashap"], "did you mean `metashape`?"),
        (&["convert", "camera.yml", "--to", "opencv7"], "no such target"),
        (&["convert", "camera.yml", "--to", "photogrammetric"], "--pitch UM"),
        (&["convert", "camera.yml", "--to", "photogrammetric", "--pitch", "-4"], "expected a positive number"),
        (&["convert", "camera.yml", "--to", "ebner", "--pitch", "4"], "--base MM"),
        (&["convert", "camera.yml", "--to", "opencv", "--naive"], "--naive converts to photogrammetric only"),
        (&["convert", "camera.yml", "--to", "metashape", "--camera", "x"], "no camera is called x"),
        (&["convert", "camera.yml", "--to", "metashape", "--camera", "2"], "no camera is called 2"),
        (&["convert", "camera.yml", "--to", "colmp"], "did you mean `colmap`?"),
        (&["convert", "camera.yml", "--to", "colmap", "--model", "OPENGL"], "colmap holds no model `OPENGL`; it holds SIMPLE_RADIAL"),
        (&["convert", "camera.yml", "--to", "metashape", "--model", "OPENCV"], "no --model"),
        (&["convert", "camera.yml", "--to", "colmap", "--all", "--camera", "1"], "--all and --camera NAME exclude each other"),
        (&["convert", "camera.yml", "--to", "bundler"], "bundler cannot hold the camera: the target differs by up to"),
        (&["diff", "camera.yml", "small.yml"], "differ in size: 1600 x 1200 px and 1500 x 1200 px"),
    ] {
        let output = run(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stdout(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: expected {expected}\n{}", stderr(&output));
    }
}

#[test]
fn a_format_that_is_named_is_read_and_no_other() {
    let folder = folder();
    let ours = good(folder.path(), &["camera", "camera.yml", "--from", "opencv-yaml"]);
    assert_eq!(ours, good(folder.path(), &["camera", "camera.yml"]));
    good(folder.path(), &["convert", "camera.yml", "--from", "opencv-yaml", "--to", "opencv", "-o", "same.yml"]);
    // Of both files of `diff`.
    good(folder.path(), &["diff", "camera.yml", "same.yml", "--from", "opencv-yaml"]);
    good(folder.path(), &["convert", "camera.yml", "--to", "metashape", "-o", "m.xml"]);
    for (arguments, expected) in [
        (&["camera", "camera.yml", "--from", "colmap"][..], "camera.yml: is no file of colmap: "),
        (&["camera", "camera.yml", "--from", "opencv"], "did you mean `opencv-"),
        (&["diff", "camera.yml", "m.xml", "--from", "opencv-yaml"], "m.xml: is no file of opencv-yaml: "),
        (&["convert", "m.xml", "--from", "colmap-bin", "--to", "opencv", "-o", "x.yml"], "m.xml: is no file of colmap-bin: it is text"),
    ] {
        let output = run(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stdout(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: expected {expected}\n{}", stderr(&output));
    }
    assert!(!folder.path().join("x.yml").exists());
}

#[test]
fn k4_p3_and_p4_stay_and_a_frame_as_tall_as_a_tower_is_refused() {
    let folder = folder();
    let rich = "<?xml version=\"1.0\"?>\n<calibration>\n<projection>frame</projection>\n<width>6000</width>\n<height>4000</height>\n<f>4000.5</f>\n<cx>12.5</cx>\n<cy>-7.25</cy>\n\
        <b1>1.5</b1>\n<b2>-0.7</b2>\n<k1>-0.05</k1>\n<k2>0.02</k2>\n<k3>-0.004</k3>\n<k4>0.003</k4>\n<p1>0.0004</p1>\n<p2>-0.0003</p2>\n<p3>0.1</p3>\n<p4>-0.05</p4>\n\
        </calibration>\n";
    std::fs::write(folder.path().join("rich.xml"), rich).unwrap();
    assert!(good(folder.path(), &["convert", "rich.xml", "--to", "metashape", "-o", "again.xml"]).contains("exact"));
    let again = std::fs::read_to_string(folder.path().join("again.xml")).unwrap();
    assert!(again.contains("<k4>") && again.contains("<p3>") && again.contains("<p4>"), "{again}");
    // A fit that goes nowhere ends: 752 x 1,000,000 px took half a minute.
    let tall = CAMERA.replace("image_width: 1600", "image_width: 752").replace("image_height: 1200", "image_height: 1000000");
    std::fs::write(folder.path().join("tall.yml"), tall.replace("-1.0e-01, 4.0e-02", "4.4e-01, -3.0")).unwrap();
    let output = run(folder.path(), &["convert", "tall.yml", "--to", "micmac", "-o", "tall.xml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("micmac cannot hold the camera"), "{}", stderr(&output));
}

#[test]
fn what_is_unverified_is_said_and_can_be_decided() {
    let folder = folder();
    std::fs::write(folder.path().join("camera.yml"), CAMERA.replace("1502.", "1500.")).unwrap();
    let said = good(folder.path(), &["convert", "camera.yml", "--to", "pix4d-inpho", "--pitch", "4", "-o", "p.cam"]);
    assert!(said.contains("unverified") && said.contains("--order"), "{said}");
    let read = |order: &str| good(folder.path(), &["diff", "camera.yml", "p.cam", "--order", order]);
    let rms = |text: &str| text.split_whitespace().nth(1).unwrap().parse::<f64>().unwrap();
    assert!(rms(&read("opencv")) < 1e-6, "{}", read("opencv"));
    assert!(rms(&read("brown")) > 0.1, "{}", read("brown"));
}

#[test]
fn conventions_are_listed_with_what_is_verified() {
    let text = good(&root(), &["list", "conventions"]);
    for part in ["photogrammetric", "ebner", "pix4d", "metashape", "opencv-fisheye", "unverified:", "verified:"] {
        assert!(text.contains(part), "{part}");
    }
}

#[test]
fn formats_are_listed_with_what_convert_can_be_told() {
    let text = good(&root(), &["list", "formats"]);
    for format in calibench_cameras::FORMATS {
        assert!(text.contains(&format!("  {} (.{}): {}", format.name, format.extension, format.tool)), "{}: {text}", format.name);
    }
    assert!(
        text.contains("targets of `convert --to`\n  photogrammetric: ") && text.contains("; --model chooses among plumb_bob"),
        "{text}"
    );
}

#[test]
fn every_mistake_has_its_price() {
    let project = copy();
    good(project.path(), &["report", "conventions", "-q"]);
    let folder = project.path().join("reports/conventions");
    let page = std::fs::read_to_string(folder.join("README.md")).unwrap();
    assert_eq!(page.matches("folds over inside the frame").count(), 2, "OpenCV's and Lens's polynomials");
    let figures = |camera: &str, mistake: &str| -> Vec<f64> {
        let section = page.split(&format!("### {camera}\n")).nth(1).unwrap();
        let row = section.lines().find(|line| line.contains(mistake)).unwrap();
        row.split('|').skip(2).filter_map(|cell| cell.trim().parse().ok()).collect()
    };
    // As measured elsewhere: the direct conversion of PhotoScan's camera, 3.88 and 9.95 px in the image.
    let naive = figures("PhotoScan", "Table 2");
    assert!((naive[0] - 3.88).abs() < 0.01 && (naive[1] - 9.95).abs() < 0.01, "{naive:?}");
    // Half a pixel along both axes is 0.71 px before a rotation, and next to nothing after it.
    let half = figures("PhotoScan", "half a pixel");
    assert!((half[0] - 0.5_f64.sqrt()).abs() < 0.03 && half[2] < 0.15, "{half:?}");
    // A swap hardly shows where p1 is near p2, and does where it is not.
    assert!(figures("PhotoScan", "swapped")[0] < 0.2 && figures("p1 far from p2", "swapped")[0] > 10.0);
    for picture in ["photoscan.png", "pix4d.png", "opencv.png", "lens.png", "p1-far-from-p2.png"] {
        assert!(image::open(folder.join(picture)).is_ok() && page.contains(&format!("({picture})")), "{picture}");
    }
}

#[test]
#[cfg_attr(not(camera_files), ignore = "the camera files of other tools are absent: docs/scenarios.md says where they are looked for")]
fn the_open_points_of_old_photoscan_are_decided_by_flags() {
    let file = cameras().join("photoscan-old-cameras.xml");
    let file = file.to_str().unwrap();
    let value = |arguments: &[&str], name: &str| -> f64 {
        let text = good(&root(), &[&["camera", file], arguments].concat());
        let line = text.lines().find(|line| line.trim_start().starts_with(&format!("{name} "))).unwrap_or_else(|| panic!("{name}\n{text}"));
        line.split_whitespace().nth(1).unwrap().parse().unwrap()
    };
    assert!((value(&["--origin", "centre"], "cx") - value(&[], "cx") - 0.5).abs() < 1e-12);
    assert_eq!(value(&["--order", "brown"], "p1"), value(&[], "p2"));
    assert!(good(&root(), &["camera", file]).contains("--order and --origin decide"));
}

fn cameras() -> PathBuf {
    data().join("cameras")
}

#[test]
#[cfg_attr(not(camera_files), ignore = "the camera files of other tools are absent: docs/scenarios.md says where they are looked for")]
fn two_exports_of_one_adjustment_are_one_camera() {
    let file = |name: &str| cameras().join(name).to_str().unwrap().to_owned();
    let text = good(&root(), &["diff", &file("metashape-24mm.xml"), &file("opencv-24mm.xml")]);
    let rms: f64 = text.split_whitespace().nth(1).unwrap().parse().unwrap();
    assert!(rms < 1e-9 && text.contains("after a rotation of 0.000000"), "{text}");
    assert!(good(&root(), &["camera", &file("pix4d-calibrated_camera_parameters.txt")]).contains("168 cameras"));
}
