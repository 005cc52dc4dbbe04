//! What a file holds and no reader understands is refused where it speaks of the lens, and else said; `xi` makes a FileStorage another camera.

use calibench_model::camera::{Camera, CameraModel, ImageSize, Omni, OpenCvFisheye, Ray};

use super::super::ReadOptions;
use super::{read, read_with};

const XI: &str = "xi: 1.2\n";
const STORAGE: &str = "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   \
    data: [ 500., 0., 320., 0., 501., 240., 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 4\n   dt: d\n   \
    data: [ -1.0e-01, 2.0e-02, 1.0e-03, -2.0e-03 ]\nxi: 1.2\n";

#[test]
fn xi_is_read_as_omnidir_s_camera() {
    let camera = read(STORAGE).unwrap().cameras[0].camera;
    let Camera::Omni(Omni { xi: 1.2, k: [-0.1, 0.02], p: [1e-3, -2e-3], .. }) = camera else { panic!("{camera:?}") };
    // cv2.omnidir.projectPoints, by its documentation: to the unit sphere, then by xi to the plane, then Brown's distortion.
    let (x, y, z) = (0.7_f64, -0.4_f64, 1.1_f64);
    let d = (x * x + y * y + z * z).sqrt();
    let (u, v) = (x / d / (z / d + 1.2), y / d / (z / d + 1.2));
    let (r2, p1, p2) = (u * u + v * v, 1e-3, -2e-3);
    let s = 1.0 - 0.1 * r2 + 0.02 * r2 * r2;
    let expected = [
        500.0 * (u * s + 2.0 * p1 * u * v + p2 * (r2 + 2.0 * u * u)) + 320.0,
        501.0 * (v * s + p1 * (r2 + 2.0 * v * v) + 2.0 * p2 * u * v) + 240.0,
    ];
    let found = camera.project(Ray { x, y: -y, z: -z }).unwrap();
    assert!((found.x - expected[0]).abs() < 1e-9 && (found.y - expected[1]).abs() < 1e-9, "{found:?} {expected:?}");
    // The same number as a matrix, and in XML.
    let matrix = STORAGE.replace(XI, "xi: !!opencv-matrix\n   rows: 1\n   cols: 1\n   dt: d\n   data: [ 1.2 ]\n");
    let xml = "<?xml version=\"1.0\"?>\n<opencv_storage>\n<cameraResolution>640 480</cameraResolution>\n<camera_matrix type_id=\"opencv-matrix\">\n\
        <rows>3</rows><cols>3</cols><dt>d</dt><data>500. 0. 320. 0. 501. 240. 0. 0. 1.</data></camera_matrix>\n\
        <distortion_coefficients type_id=\"opencv-matrix\"><rows>1</rows><cols>4</cols><dt>d</dt><data>-0.1 0.02 1e-3 -2e-3</data>\
        </distortion_coefficients>\n<xi>1.2</xi></opencv_storage>\n";
    for text in [matrix.as_str(), xml] {
        assert_eq!(read(text).unwrap().cameras[0].camera, camera);
    }
}

#[test]
fn xi_beside_what_contradicts_it_is_refused() {
    for (from, to, expected) in [
        (XI, "xi: big\n", "f:15, `xi`: expected a finite number"),
        (XI, "xi: -0.5\n", "f:15, `xi`: expected a number from 0, found -0.5"),
        (XI, "xi: [1, 2]\n", "f:15, `xi`: expected one value"),
        (XI, "xi: 1.2\nfisheye_model: 1\n", "f:15, `xi`: is cv2.omnidir's: no camera has it and is a fisheye of cv2's both"),
        ("500., 0.,", "500., 2.,", "has a skew of 2, which is not known here beside `xi`"),
        (
            "   cols: 4\n   dt: d\n   data: [ ",
            "   cols: 5\n   dt: d\n   data: [ 0., ",
            "expected 4 coefficients beside `xi`, k1, k2, p1, p2, found 5",
        ),
    ] {
        let error = read(&STORAGE.replace(from, to)).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn sizes_under_their_usual_names_are_used() {
    let sized =
        |lines: &str| read(&STORAGE.replace("image_width: 640\nimage_height: 480\n", lines)).map(|file| file.cameras[0].camera.size());
    let size = ImageSize { width: 640, height: 480 };
    for lines in [
        "calibImageSize: [ 640, 480 ]\n",
        "cameraResolution: [ 640, 480 ]\n",
        "image_Width: 640\nimage_Height: 480\n",
        "width: 640\nheight: 480\n",
    ] {
        assert_eq!(sized(lines), Ok(size), "{lines}");
    }
    assert_eq!(sized("image_width: 640\nimage_height: 480\nimage_size: [ 640, 480 ]\n"), Ok(size));
    let error = sized("image_width: 640\nimage_height: 480\nimage_size: [ 640, 481 ]\n").unwrap_err();
    assert!(error.contains("f:5, `image_size`: says another size than `image_width` and `image_height`, 640 x 480 px"), "{error}");
    assert!(sized("calibImageSize: [ 640 ]\n").unwrap_err().contains("`calibImageSize`: expected columns and rows, found 1 values"));
    assert!(sized("calibImageSize: [ 640, 4.5 ]\n").unwrap_err().contains("f:3, `calibImageSize`"));
}

#[test]
fn keys_that_speak_of_the_lens_are_mistakes_unless_they_are_left_out_by_name() {
    let size = Some(ImageSize { width: 640, height: 480 });
    let seeds = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/calibench/fuzz/seeds/cameras/");
    for (seed, from, to) in [
        ("opencv.yml", "image_width", "camera_model_2: 1\nimage_width"),
        ("opencv.xml", "<image_width>", "<camera_model_2>1</camera_model_2><image_width>"),
        ("ros.yaml", "camera_name", "camera_model: fisheye\ncamera_name"),
        ("camodocal.yaml", "model_type", "camera_model: fisheye\nmodel_type"),
        ("camodocal.yaml", "   xi:", "   camera_model: 3\n   xi:"),
        ("kalibr.yaml", "  resolution", "  camera_model_2: 1\n  resolution"),
        ("mrcal.cameramodel", "'intrinsics'", "'camera_model': 1, 'intrinsics'"),
        ("basalt.json", "\"camera_type\"", "\"camera_model\": 1, \"camera_type\""),
        ("basalt.json", "{\"value0\"", "{\"camera_model\": 1, \"value0\""),
        ("nerfstudio.json", "\"frames\"", "\"camera_model_2\": 1, \"frames\""),
        ("nerfstudio.json", "[{\"file_path\"", "[{\"camera_model_2\": 1, \"file_path\""),
        ("openmvg.json", "{\"sfm_data_version\"", "{\"camera_model\": 1, \"sfm_data_version\""),
        ("theia.json", "{\"priors\"", "{\"camera_model\": 1, \"priors\""),
        ("theia.json", "\"width\"", "\"camera_model\": 1, \"width\""),
        ("opensfm.json", "\"width\"", "\"camera_model\": 1, \"width\""),
        ("bentley.xml", "<K1>", "<camera_model>1</camera_model><K1>"),
        ("bentley.xml", "<FocalLength>", "<camera_model>1</camera_model><FocalLength>"),
        ("micmac.xml", "<SzIm>", "<camera_model>1</camera_model><SzIm>"),
        ("micmac.xml", "<CDist>", "<camera_model>1</camera_model><CDist>"),
        ("caltech.m", "cc =", "camera_model = 1;\ncc ="),
        ("metashape.xml", "<f>", "<camera_model>a</camera_model><f>"),
        ("reality-capture.xmp", "<xcr:Rotation>", "<xcr:camera_model>1</xcr:camera_model><xcr:Rotation>"),
    ] {
        let text = std::fs::read_to_string(format!("{seeds}{seed}")).unwrap();
        assert!(text.contains(from), "{seed}: no {from}");
        let changed = text.replacen(from, to, 1);
        let options =
            |ignore: &[&str]| ReadOptions { size, ignore: ignore.iter().map(|&key| key.to_owned()).collect(), ..ReadOptions::default() };
        let error = read_with(&changed, options(&[])).expect_err(seed);
        assert!(error.contains("camera_model") && error.contains("--ignore-key") && error.starts_with("f:"), "{seed}: {error}");
        let notes =
            &read_with(&changed, options(&["camera_model", "camera_model_2"])).unwrap_or_else(|error| panic!("{seed}: {error}")).cameras[0]
                .notes;
        assert!(notes.iter().any(|note| note.contains("`camera_model")), "{seed}: {notes:?}");
    }
}

/// Within a lens's block any key that is not known is a mistake, whatever it is called; elsewhere it is noted.
#[test]
fn what_does_not_speak_of_the_lens_is_a_mistake_within_its_block_alone() {
    let size = Some(ImageSize { width: 640, height: 480 });
    let seeds = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/calibench/fuzz/seeds/cameras/");
    for (seed, from, to, within) in [
        ("camodocal.yaml", "   xi:", "   wobble: 3\n   xi:", true),
        ("kalibr.yaml", "  resolution", "  wobble: 1\n  resolution", true),
        ("basalt.json", "\"camera_type\"", "\"wobble\": 1, \"camera_type\"", true),
        ("opensfm.json", "\"width\"", "\"wobble\": 1, \"width\"", true),
        ("bentley.xml", "<K1>", "<Wobble>1</Wobble><K1>", true),
        ("metashape.xml", "<f>", "<wobble>0</wobble><f>", true),
        ("opencv.yml", "image_width", "wobble: 1\nimage_width", false),
        ("ros.yaml", "camera_name", "wobble: 1\ncamera_name", false),
        ("mrcal.cameramodel", "'intrinsics'", "'wobble': 1, 'intrinsics'", false),
        ("nerfstudio.json", "\"frames\"", "\"wobble\": 1, \"frames\"", false),
        ("basalt.json", "{\"value0\"", "{\"wobble\": 1, \"value0\"", false),
        ("caltech.m", "cc =", "wobble = 1;\ncc =", false),
    ] {
        let text = std::fs::read_to_string(format!("{seeds}{seed}")).unwrap();
        assert!(text.contains(from), "{seed}: no {from}");
        match (read_with(&text.replacen(from, to, 1), ReadOptions { size, ..ReadOptions::default() }), within) {
            (Err(error), true) => assert!(error.to_lowercase().contains("wobble"), "{seed}: {error}"),
            (Ok(file), false) => assert!(file.cameras[0].notes.iter().any(|note| note.contains("`wobble`")), "{seed}"),
            (found, _) => panic!("{seed}: {found:?}"),
        }
    }
}

#[test]
fn a_storage_says_what_kind_its_lens_is() {
    let four = STORAGE.replace(XI, "");
    let kind = |lines: &str| read(&four.replace("image_width", &format!("{lines}image_width"))).map(|file| file.cameras[0].camera);
    for line in [
        "distortion_model: \"equidistant\"\n",
        "camera_model: fisheye\n",
        "is_fisheye: 1\n",
        "lens_type: Kannala-Brandt\n",
        "fisheye: true\n",
    ] {
        assert!(matches!(kind(line), Ok(Camera::OpenCvFisheye(_))), "{line}: {:?}", kind(line));
    }
    for line in ["distortion_model: plumb_bob\n", "camera_model: pinhole\n", "is_fisheye: 0\n"] {
        assert!(matches!(kind(line), Ok(Camera::OpenCv(_))), "{line}: {:?}", kind(line));
    }
    for (line, expected) in [
        ("distortion_model: \"bent\"\n", "f:3, `distortion_model`: `bent` is not known"),
        ("camera_model: omnidir\n", "has no `xi`"),
        ("fisheye: perhaps\n", "f:3, `fisheye`: expected 0 or 1"),
        ("fisheye_model: 1\ncamera_model: pinhole\n", "f:4, `camera_model`: contradicts `fisheye_model`"),
        ("lens: wide\n", "f:3, `lens`: is no key that is known of a lens"),
    ] {
        let error = kind(line).unwrap_err();
        assert!(error.contains(expected), "{line}: {error}");
    }
    let pinhole = ReadOptions { fisheye: Some(false), ..ReadOptions::default() };
    let error = read_with(&four.replace("image_width", "camera_model: fisheye\nimage_width"), pinhole).unwrap_err();
    assert!(error.contains("contradicts the model that was asked for"), "{error}");
}

#[test]
fn a_transforms_file_says_whether_its_lens_is_a_fisheye() {
    let of = |model: &str| {
        read(&format!("{{{model}\"fl_x\": 500.0, \"w\": 1280, \"h\": 960, \"k1\": 0.02, \"k2\": -0.01, \"k3\": 0.001, \"k4\": 2e-4}}"))
            .map(|file| file.cameras[0].camera)
    };
    assert!(matches!(of("\"is_fisheye\": true, "), Ok(Camera::OpenCvFisheye(OpenCvFisheye { k: [0.02, -0.01, 0.001, 2e-4], .. }))));
    assert!(of("\"is_fisheye\": false, ").is_ok_and(|camera| !matches!(camera, Camera::OpenCvFisheye(_))));
    assert!(
        of("\"is_fisheye\": true, \"camera_model\": \"OPENCV\", ")
            .unwrap_err()
            .contains("`is_fisheye`: contradicts `camera_model`, OPENCV")
    );
    assert!(of("\"is_fisheye\": 2, ").unwrap_err().contains("expected true or false"));
}
