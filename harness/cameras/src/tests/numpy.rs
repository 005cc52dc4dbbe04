//! NumPy's archives, and matrices under names of one's own.

use std::path::Path;

use calibench_model::camera::{Camera, ImageSize, Omni, OpenCv, OpenCvFisheye};

use super::super::{
    CameraFile, NamedCamera, ParameterCovariance, ReadOptions, camera_bytes, format_named, npy, parse_camera, read_camera_with,
};
use super::{read_with, sized_options as sized};

const SIZE: ImageSize = ImageSize { width: 640, height: 480 };
const K: [f64; 9] = [500.0, 0.0, 320.0, 0.0, 501.0, 240.0, 0.0, 0.0, 1.0];
const D: [f64; 5] = [-0.1, 0.02, 1e-3, -2e-3, 0.0];

/// An archive of arrays, as the writer's own puts them together.
fn archive(arrays: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut archive = rawzip::ZipArchiveWriter::new(&mut bytes);
    for (name, array) in arrays {
        let file = archive.new_file(format!("{name}.npy")).compression_method(rawzip::CompressionMethod::STORE);
        let (mut entry, config) = file.start().unwrap();
        let mut writer = config.wrap(&mut entry);
        std::io::Write::write_all(&mut writer, array).unwrap();
        let (_, descriptor) = writer.finish().unwrap();
        entry.finish(descriptor).unwrap();
    }
    archive.finish().unwrap();
    bytes
}

fn named(matrix: Option<&str>, distortion: Option<&str>) -> ReadOptions {
    ReadOptions { matrix: matrix.map(str::to_owned), distortion: distortion.map(str::to_owned), ..sized(SIZE) }
}

fn opencv(file: &CameraFile) -> OpenCv {
    match file.cameras[0].camera {
        Camera::OpenCv(camera) => camera,
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_is_written_is_read_again() {
    let (size, fx, fy, cx, cy) = (SIZE, 500.0, 501.0, 320.0, 240.0);
    let mut distortion = [0.0; 14];
    distortion[..8].copy_from_slice(&[-0.1, 0.02, 1e-3, -2e-3, 0.003, 1e-9, 2e-2, 3e-2]);
    let cameras: [Camera; 4] = [
        OpenCv { size, fx, fy, cx, cy, distortion, coefficients: 8 }.into(),
        OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k: [0.01, -0.02, 0.003, 1e-4] }.into(),
        OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.01, k: [0.0; 4] }.into(),
        Omni { size, fx, fy, cx, cy, xi: 1.2, k: [-0.1, 0.02], p: [1e-3, -2e-3] }.into(),
    ];
    let covariance = ParameterCovariance::new(vec!["fx".into(), "k1".into()], vec![1.0, 0.0, 0.0, 0.25]).unwrap();
    for camera in cameras {
        let camera = NamedCamera { covariance: Some(covariance.clone()), ..NamedCamera::new("küche \"1\" a", camera) };
        let bytes = camera_bytes(format_named("numpy").unwrap(), std::slice::from_ref(&camera)).unwrap();
        let read = parse_camera("f", &bytes, &ReadOptions::default()).unwrap();
        super::assert_same(&read.cameras, std::slice::from_ref(&camera), 1e-15);
    }
}

/// What numpy 2.4 wrote with np.savez_compressed: float32, a scalar, vectors of rotation beside it.
#[test]
fn numpy_s_own_archive_is_read() {
    let seed = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/calibench/fuzz/seeds/cameras/numpy.npz");
    let file = parse_camera("f", &std::fs::read(seed).unwrap(), &ReadOptions::default()).unwrap();
    let camera = opencv(&file);
    assert_eq!((file.format.name, camera.size, camera.fy, camera.cx), ("numpy", SIZE, 501.0, 320.0));
    assert_eq!(camera.distortion[..5], D);
    assert_eq!(file.cameras[0].name, "mtx");
    assert_eq!(file.cameras[0].notes, ["`ret` was left out", "`rvecs` was left out"]);
}

#[test]
fn names_of_one_s_own_are_said() {
    let matrices = [("a", npy::floats(&[3, 3], &K)), ("first", npy::floats(&[1, 5], &D)), ("second", npy::floats(&[5, 1], &[0.5; 5]))];
    let bytes = archive(&matrices);
    let read = |options: ReadOptions| parse_camera("f", &bytes, &options).map_err(|error| error.to_string());
    assert_eq!(opencv(&read(named(Some("a"), Some("first"))).unwrap()).distortion[..5], D);
    assert_eq!(opencv(&read(named(Some("a"), Some("second"))).unwrap()).distortion[..5], [0.5; 5]);
    // The one that is the only one need not be said.
    assert_eq!(opencv(&read(named(None, Some("first"))).unwrap()).fx, 500.0);
    assert_eq!(opencv(&read(named(Some("a"), Some("none"))).unwrap()).distortion, [0.0; 14]);
    for (options, expected) in [
        (named(Some("b"), Some("first")), "f, `b`: is not there; there are `a` (3 x 3), `first` (1 x 5), `second` (1 x 5)"),
        (named(Some("first"), Some("second")), "f, `first`: expected 3 x 3, found 1 x 5"),
        (named(Some("a"), None), "which one belongs to it? Name it with --distortion; there are"),
        (named(None, None), "or say them: --matrix NAME --distortion NAME"),
    ] {
        let error = read(options).unwrap_err();
        assert!(error.contains(expected), "{expected}: {error}");
    }
    // A FileStorage too; a file whose numbers have names of its own, not.
    let storage = "%YAML:1.0\n---\nx: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 500, 0, 320, 0, 501, 240, 0, 0, 1 ]\n\
        y: !!opencv-matrix\n   rows: 1\n   cols: 4\n   dt: h\n   data: [ -0.28003, 0.090027, 0., 0. ]\n";
    // A half is the one that OpenCV holds, not the five digits that it prints.
    assert_eq!(
        opencv(&read_with(storage, named(Some("x"), Some("y"))).unwrap()).distortion[..2],
        [-0.280_029_296_875, 0.090_026_855_468_75]
    );
    let error = read_with("1 PINHOLE 640 480 500 501 320 240\n", named(Some("x"), None)).unwrap_err();
    assert!(error.contains("is a file of colmap") && error.contains("--matrix and --distortion are for"), "{error}");
}

/// What Python's json and yaml make of `mtx.tolist()`.
#[test]
fn lists_of_lists_are_matrices() {
    let json = "{\"camera_matrix\": [[500, 0, 320], [0, 501, 240], [0, 0, 1]], \"dist_coeff\": [[-0.1, 0.02, 0.001, -0.002, 0]], \"image_size\": [640, 480]}";
    let yaml = "camera_matrix:\n- - 500.0\n  - 0.0\n  - 320.0\n- - 0.0\n  - 501.0\n  - 240.0\n- - 0.0\n  - 0.0\n  - 1.0\n\
        dist_coeff:\n- - -0.1\n  - 0.02\n  - 0.001\n  - -0.002\n  - 0.0\nimage_size:\n- 640\n- 480\n";
    for (text, format) in [(json, "opencv-json"), (yaml, "opencv-yaml"), (json.replace("camera_matrix", "mtx").as_str(), "opencv-json")] {
        let file = read_with(text, ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((file.format.name, opencv(&file).distortion[..5].to_vec()), (format, D.to_vec()));
    }
    let error = read_with(&json.replace("[0, 501, 240]", "[0, 501]"), ReadOptions::default()).unwrap_err();
    assert!(error.contains("no camera file that is known") && error.contains("camera_matrix"), "{error}");
    let error = read_with(&yaml.replace("- - -0.1\n  - 0.02\n  - 0.001\n", "- - -0.1\n"), ReadOptions::default()).unwrap_err();
    assert!(error.contains("f:1: has no `distortion_coefficients`"), "{error}");
}

#[test]
fn what_is_no_camera_is_said() {
    let objects = {
        let head = "{'descr': '|O', 'fortran_order': False, 'shape': (), }\n";
        [&b"\x93NUMPY\x01\x00"[..], &(head.len() as u16).to_le_bytes(), head.as_bytes(), b"\x80\x04."].concat()
    };
    for (bytes, expected) in [
        (archive(&[("calib", objects.clone())]), "has no `camera_matrix`; matrices that may be a camera's are none"),
        (archive(&[("calib", objects)]), "`calib` holds Python objects, which only Python unpickles"),
        (archive(&[("mtx", npy::floats(&[3, 3], &K)[..100].to_vec())]), "f, `mtx`: "),
        (archive(&[("mtx", npy::floats(&[3, 3], &K)), ("dist", npy::floats(&[1, 5], &D))]), "does not state the size of the images"),
        (
            archive(&[("mtx", npy::floats(&[3, 3], &K)), ("dist", npy::floats(&[3], &[0.0; 3])), ("w", npy::integers(&[], &[3]))]),
            "coefficients none",
        ),
        (archive(&[("readme.txt", Vec::new())])[..40].to_vec(), "no camera file that is known: a ZIP archive that holds no .npy"),
    ] {
        let sized = if expected.contains("size") { ReadOptions::default() } else { sized(SIZE) };
        let error = parse_camera("f", &bytes, &sized).unwrap_err().to_string();
        assert!(error.contains(expected), "{expected}: {error}");
    }
}

#[test]
fn a_matrix_in_a_file_of_its_own_has_its_coefficients_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("K.npy"), npy::floats(&[3, 3], &K)).unwrap();
    std::fs::write(at("dist.npy"), npy::floats(&[5], &D)).unwrap();
    let read = |distortion: Option<&str>| read_camera_with(&at("K.npy"), &named(None, distortion)).map_err(|error| error.to_string());
    for name in ["dist.npy", "dist"] {
        assert_eq!(opencv(&read(Some(name)).unwrap()).distortion[..5], D);
    }
    assert_eq!(opencv(&read(Some("none")).unwrap()).distortion, [0.0; 14]);
    let error = read(None).unwrap_err();
    assert!(
        error.contains("K.npy: is one array: name the file of the coefficients") && error.contains("beside it is `dist.npy`"),
        "{error}"
    );
    let error = read(Some("D.npy")).unwrap_err();
    assert!(error.contains("D.npy: no such file beside the camera matrix"), "{error}");
    let error = read_camera_with(&at("dist.npy"), &named(None, Some("K.npy"))).unwrap_err().to_string();
    assert!(error.contains("`dist`: expected 3 x 3, found 1 x 5"), "{error}");
    assert!(parse_camera("K.npy", &std::fs::read(Path::new(&at("K.npy"))).unwrap(), &sized(SIZE)).is_err());
}
