//! What a file holds and no reader understands is said; `xi` makes a FileStorage another camera.

use calibench_model::camera::{Camera, CameraModel, ImageSize, Omni, Ray};

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
        (XI, "xi: 1.2\nfisheye_model: 1\n", "f:15, `xi`: is cv2.omnidir's: no camera has it and `fisheye_model` both"),
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
fn keys_that_are_not_understood_are_said() {
    let size = Some(ImageSize { width: 640, height: 480 });
    let seeds = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/calibench/fuzz/seeds/cameras/");
    for (seed, from, to) in [
        ("opencv.yml", "image_width", "camera_model: fisheye\nimage_width"),
        ("opencv.xml", "<image_width>", "<camera_model>fisheye</camera_model><image_width>"),
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
        let options = ReadOptions { size, ..ReadOptions::default() };
        let changed = text.replacen(from, to, 1);
        let notes = &read_with(&changed, options).unwrap_or_else(|error| panic!("{seed}: {error}")).cameras[0].notes;
        assert!(notes.iter().any(|note| note.contains("`camera_model")), "{seed}: {notes:?}");
    }
}
