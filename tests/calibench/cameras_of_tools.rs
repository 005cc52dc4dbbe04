//! Cameras from tool to tool, as a user converts them.

use crate::cameras::{CAMERA, folder, good};
use crate::project::{data, root, run, stderr, stdout};

/// Two cameras of a rig, 11 cm apart.
const RIG: &str = "cam0:\n  camera_model: ds\n  intrinsics: [-0.24, 0.57, 350.0, 349.0, 366.0, 249.0]\n  distortion_model: none\n  distortion_coeffs: []\n  \
    resolution: [752, 480]\ncam1:\n  camera_model: pinhole\n  intrinsics: [460.0, 459.0, 379.0, 256.0]\n  distortion_model: radtan\n  \
    distortion_coeffs: [-0.28, 0.07, 2.0e-4, 1.0e-5]\n  resolution: [752, 480]\n  T_cn_cnm1:\n  - [1.0, 0.0, 0.0, -0.11]\n  - [0.0, 1.0, 0.0, 0.0]\n  \
    - [0.0, 0.0, 1.0, 0.0]\n  - [0.0, 0.0, 0.0, 1.0]\n";

/// A camera of mrcal's at a place; its axes are those of the world.
fn cameramodel(focal: f64, [x, y, z]: [f64; 3]) -> String {
    format!(
        "{{ 'lensmodel': 'LENSMODEL_OPENCV4',\n 'intrinsics': [ {focal}, 501, 320, 240, 0.1, 0, 0, 0,],\n 'extrinsics': [ 0, 0, 0, {}, {}, {} ],\n 'imagersize': [ 640, 480 ],\n}}\n",
        -x, -y, -z
    )
}

/// One file per camera becomes one chain, with the poses between the cameras where the files state them.
#[test]
fn several_files_become_one() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    for (name, focal, place) in [("left", 500.0, [1.0, 2.0, 3.0]), ("middle", 510.0, [1.25, 2.0, 3.0]), ("right", 520.0, [1.5, 2.0, 3.0])] {
        std::fs::write(at(&format!("{name}.cameramodel")), cameramodel(focal, place)).unwrap();
    }
    std::fs::write(at("again.cameramodel"), cameramodel(530.0, [1.0, 2.0, 3.0])).unwrap();
    std::fs::write(at("camera.yml"), CAMERA).unwrap();
    let models = ["left.cameramodel", "middle.cameramodel", "right.cameramodel"];
    let said = good(folder.path(), &[&["convert"][..], &models, &["--to", "kalibr", "-o", "chain.yaml"]].concat());
    assert!(said.contains("poses between the cameras as the files state them, in one world"), "{said}");
    let chain = calibench_cameras::read_camera(&at("chain.yaml")).unwrap().cameras;
    assert_eq!(chain.iter().map(|named| named.name.as_str()).collect::<Vec<_>>(), ["left", "middle", "right"]);
    for (named, x) in chain.iter().zip([0.0, 0.25, 0.5]) {
        assert!(named.pose.unwrap().position.iter().zip([x, 0.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{named:?}");
    }
    // COLMAP's list has no poses: that they are lost is said.
    let said = good(folder.path(), &["convert", models[0], "chain.yaml", "--to", "colmap", "-o", "cameras.txt"]);
    assert!(
        said.contains("no poses between the cameras are known: chain.yaml states them in another frame than left.cameramodel"),
        "{said}"
    );
    assert_eq!(calibench_cameras::read_camera(&at("cameras.txt")).unwrap().cameras.len(), 4);
    let said = good(folder.path(), &["convert", models[0], "again.cameramodel", "--to", "kalibr", "-o", "two.yaml"]);
    assert!(said.contains("left.cameramodel and again.cameramodel state the same pose, and no two cameras have the same"), "{said}");
    assert!(calibench_cameras::read_camera(&at("two.yaml")).unwrap().cameras.iter().all(|named| named.pose.is_none()));
    // A format of one camera a file has a folder, and a file each.
    good(folder.path(), &["convert", models[0], models[1], "--to", "opencv", "-o", "each"]);
    assert_eq!(
        std::fs::read_dir(at("each"))
            .unwrap()
            .filter(|entry| entry.as_ref().unwrap().file_name().to_string_lossy().ends_with(".yml"))
            .count(),
        2
    );
    let text = run(folder.path(), &["convert", models[0], models[1], "--to", "kalibr", "--json"]);
    let answer: serde_json::Value = serde_json::from_str(&stdout(&text)).unwrap();
    assert_eq!((&answer["file"], answer["cameras"].as_array().unwrap().len()), (&"left.cameramodel, middle.cameramodel".into(), 2));
    for (arguments, expected) in [
        (vec![models[0], models[1], "--scale", "0.5"], "expected --to, which names the convention of the new file"),
        (vec![models[0], models[1], "--to", "photogrammetric", "--naive"], "--naive and --plot are for one camera"),
        (vec![models[0], models[1], "--to", "opencv", "-o", "one.yaml"], "opencv-yaml holds one camera a file: name a folder with -o"),
        (vec![models[0], "gone.yaml", "--to", "kalibr"], "gone.yaml"),
        (vec![models[0], models[1], "--to", "kalibr", "-o", "left.cameramodel"], "left.cameramodel"),
    ] {
        let output = run(folder.path(), &[vec!["convert"], arguments].concat());
        assert!(!output.status.success() && stderr(&output).contains(expected), "{expected}: {}", stderr(&output));
    }
    assert!(std::fs::read_to_string(at("left.cameramodel")).unwrap().contains("LENSMODEL"));
}

#[test]
fn every_tool_s_file_is_written_and_read_again() {
    let folder = folder();
    std::fs::write(folder.path().join("camera.yml"), CAMERA.replace("1502.", "1500.")).unwrap();
    for (to, exact) in [
        ("colmap", true),
        ("kapture", true),
        ("ros", true),
        ("kalibr", true),
        ("mrcal", true),
        ("basalt", true),
        ("camodocal", true),
        ("opensfm", true),
        ("nerfstudio", true),
        ("openmvg", true),
        ("theia", true),
        ("reality-capture", true),
        ("bentley", true),
        ("caltech", true),
        ("micmac", true),
        ("numpy", true),
        ("anipose", true),
        ("gyroflow", true),
        ("matlab", true),
        ("usd", true),
        ("ocam", false),
        ("cahvor", false),
        ("lensfun", false),
        ("panotools", false),
        ("bundler", false),
        ("bal", false),
    ] {
        let said = good(folder.path(), &["convert", "camera.yml", "--to", to, "--accept", "-o", to]);
        assert_eq!(said.contains(": exact:"), exact, "{to}: {said}");
        let text = good(folder.path(), &["diff", "camera.yml", to, "--size", "1600x1200", "--no-rotation"]);
        let rms: f64 = text.split_whitespace().skip_while(|word| *word != "difference").nth(1).unwrap().parse().unwrap();
        assert_eq!(rms < 1e-9, exact, "{to}: {text}");
    }
}

#[test]
fn a_rig_is_listed_chosen_from_and_converted_whole() {
    let folder = folder();
    std::fs::write(folder.path().join("rig.yaml"), RIG).unwrap();
    let card = good(folder.path(), &["camera", "rig.yaml"]);
    assert!(card.contains("holds       2 cameras") && card.contains("1   cam0: double-sphere, 752 x 480 px"), "{card}");
    assert!(card.contains("2   cam1: opencv, 752 x 480 px") && card.contains("the first of 2 cameras, `cam0`"), "{card}");
    for name in ["cam1", "2"] {
        assert!(
            good(folder.path(), &["camera", "rig.yaml", "--camera", name])
                .contains("position    0.11, 0, 0 in the axes of the rig's first camera")
        );
    }
    // Both into one file, with the pose where it has a place ...
    let said = good(folder.path(), &["convert", "rig.yaml", "--all", "--to", "basalt", "-o", "rig.json"]);
    assert!(
        said.contains("cam0: ds: exact") && said.contains("cam1: pinhole-radtan8: exact") && said.contains("the name `cam1`"),
        "{said}"
    );
    assert!(!said.contains("lost: the pose"), "{said}");
    assert!(std::fs::read_to_string(folder.path().join("rig.json")).unwrap().contains("\"px\": 0.11"));
    // ... and named as lost where it has none.
    let said = good(folder.path(), &["convert", "rig.yaml", "--all", "--to", "colmap", "-o", "cameras.txt"]);
    assert!(
        said.contains("warning: lost: the pose in the rig: colmap has no place for it") && said.contains("cam0: OPENCV_FISHEYE: fitted"),
        "{said}"
    );
    assert!(good(folder.path(), &["camera", "cameras.txt"]).contains("holds       2 cameras"));
    // A file each where the format holds one camera.
    good(folder.path(), &["convert", "rig.yaml", "--all", "--to", "ros", "-o", "ros"]);
    let mut names: Vec<_> = std::fs::read_dir(folder.path().join("ros")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, [".calibench-manifest", "001-cam0.yaml", "002-cam1.yaml"]);
    let output = run(folder.path(), &["convert", "rig.yaml", "--all", "--to", "ros"]);
    assert!(stderr(&output).contains("ros holds one camera a file: name a folder with -o"), "{}", stderr(&output));
}

#[test]
fn an_open_origin_is_decided_by_a_flag() {
    let folder = folder();
    let convert = |origin: &str, file: &str| {
        good(folder.path(), &["convert", "camera.yml", "--to", "theia", "--origin", origin, "-o", file]);
        std::fs::read_to_string(folder.path().join(file)).unwrap()
    };
    assert!(convert("centre", "a.json").contains("[810.0, 590.0]") && convert("corner", "b.json").contains("[810.5, 590.5]"));
    let rms = |origin: &str| {
        let text = good(folder.path(), &["diff", "camera.yml", "b.json", "--no-rotation", "--origin", origin]);
        text.split_whitespace().skip_while(|word| *word != "difference").nth(1).unwrap().parse::<f64>().unwrap()
    };
    assert!(rms("corner") < 1e-9 && rms("centre") > 0.6);
    assert!(good(folder.path(), &["camera", "b.json"]).contains("--origin corner or --origin centre decides"));
}

#[test]
fn a_rotated_fit_turns_the_pose_as_well() {
    let folder = folder();
    let transforms = "{\"fl_x\": 1500, \"fl_y\": 1500, \"cx\": 815, \"cy\": 590, \"w\": 1600, \"h\": 1200, \"k1\": -0.1, \"frames\": [{\"file_path\": \"a\", \
        \"transform_matrix\": [[1, 0, 0, 5], [0, 1, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]}]}";
    std::fs::write(folder.path().join("t.json"), transforms).unwrap();
    good(folder.path(), &["convert", "t.json", "--to", "bundler", "--rotation", "--accept", "-o", "b.out"]);
    let said = good(folder.path(), &["camera", "b.out", "--size", "1600x1200"]);
    let (_, position) = said.split_once("position ").unwrap();
    let words = position.split(" in the axes of the world").next().unwrap().split(',');
    let position: Vec<f64> = words.map(|word| word.trim().parse().unwrap()).collect();
    assert!(position.iter().zip([5.0, 6.0, 7.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{said}");
    // The axis was pictured 15 px right of the middle; after the turn, with z backwards, -R (0, 0, 1) leads there still, to first order.
    let text = std::fs::read_to_string(folder.path().join("b.out")).unwrap();
    let row: Vec<f64> = text.lines().nth(3).unwrap().split_whitespace().map(|word| word.parse().unwrap()).collect();
    assert!((row[2] + 0.01).abs() < 0.002 && row[0] > 0.999, "{text}");
}

#[test]
fn the_docs_name_every_format_of_a_tool() {
    let page = std::fs::read_to_string(root().join("docs/cameras-and-conventions.md")).unwrap();
    for format in calibench_cameras::FORMATS {
        assert!(
            page.contains(&format!("`{}`", format.name)) || format.models(None).is_empty(),
            "{} has no row in docs/cameras-and-conventions.md",
            format.name
        );
    }
}

fn reports() -> std::path::PathBuf {
    data().join("reports")
}

/// Corners of a lens of 195 degrees: whatever the model, what was adjusted is shown, and written where it is asked for or beside.
#[test]
fn a_calibration_of_a_wide_lens_is_written() {
    let from = reports().join("12-omni-output");
    if !from.is_dir() {
        eprintln!("skipped: {} is absent", from.display());
        return;
    }
    let folder = folder();
    let [points, control] = ["points.csv", "control.csv"].map(|name| from.join(name).display().to_string());
    for model in ["omni", "eucm", "double-sphere"] {
        let file = format!("{model}.yaml");
        let all = ["calibrate", "-q", "--points", &points, "--control", &control, "--size", "1280x960", "--model", model];
        let output = run(folder.path(), &[&all[..], &["-o", &file]].concat());
        assert_ne!(output.status.code(), Some(2), "{model}: {}", stderr(&output));
        assert!(!output.stdout.is_empty(), "{model}");
        let card = good(folder.path(), &["camera", &file]);
        assert!(card.contains(&format!("convention  {model}:")), "{model}: {card}");
        // A convention that does not hold it is an error, and loses nothing.
        let output = run(folder.path(), &[&all[..], &["-o", "no.yaml", "--to", "opencv5"]].concat());
        let said = stderr(&output);
        assert!(output.status.code() == Some(2) && !output.stdout.is_empty() && !folder.path().join("no.yaml").exists(), "{model}: {said}");
        let beside = folder.path().join(if model == "omni" { "no-as-adjusted.yml" } else { "no-as-adjusted.yaml" });
        assert!(beside.is_file(), "{model}: {said}");
        std::fs::remove_file(beside).unwrap();
    }
}

#[test]
fn keys_of_a_lens_are_mistakes_and_can_be_left_out() {
    let folder = folder();
    std::fs::write(folder.path().join("a.yml"), CAMERA.replacen("image_width", "lens_type: wide\nimage_width", 1)).unwrap();
    let output = run(folder.path(), &["convert", "a.yml", "--to", "colmap"]);
    assert!(output.status.code() == Some(2) && stderr(&output).contains("`lens_type`"), "{}", stderr(&output));
    std::fs::write(folder.path().join("b.yml"), CAMERA.replacen("image_width", "wobble_of_lens: wide\nimage_width", 1)).unwrap();
    assert_eq!(run(folder.path(), &["camera", "b.yml"]).status.code(), Some(2));
    let card = good(folder.path(), &["camera", "b.yml", "--ignore-key", "wobble_of_lens"]);
    assert!(card.contains("`wobble_of_lens` was left out"), "{card}");
}

/// The camera matrix of images binned 4 x 4 beside the size of the whole sensor: all is written, and the exit code says that it is in doubt.
#[test]
fn a_camera_that_no_lens_has_ends_with_3_and_everything_written() {
    let folder = folder();
    let here = folder.path();
    std::fs::write(here.join("sensor.yml"), CAMERA.replace("1600", "6400").replace("1200", "4800")).unwrap();
    let codes = |file: &str, output: &str| {
        let answers = [vec!["camera", file], vec!["camera", file, "--json"], vec!["convert", file, "--to", "kalibr", "-o", output]];
        answers.map(|arguments| {
            let output = run(here, &arguments);
            assert!(!stdout(&output).is_empty() || arguments[0] == "convert", "{arguments:?}");
            (output.status.code(), stderr(&output).contains("reduced or binned 4 x 4 times"))
        })
    };
    assert_eq!(codes("sensor.yml", "sensor.yaml"), [(Some(3), true); 3]);
    assert!(here.join("sensor.yaml").is_file());
    assert_eq!(codes("camera.yml", "camera.yaml"), [(Some(0), false); 3]);
}
