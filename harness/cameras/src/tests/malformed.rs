//! Files that are none, or not quite.

use std::time::{Duration, Instant};

use calibench_model::camera::Camera;

use super::super::{LARGEST_FILE, ReadOptions, parse_camera, read_camera, write_camera};
use super::{of_size, read, read_with};

const YAML: &str = "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   \
    data: [ 500., 0., 320., 0., 501., 240., 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n   \
    data: [ -1.0e-01, 2.0e-02, 1.0e-03,\n       -2.0e-03, 0. ]\n";
const OPENCV: &str = "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_width>640</image_width>\n<image_height>480</image_height>\n\
    <camera_matrix type_id=\"opencv-matrix\">\n<rows>3</rows>\n<cols>3</cols>\n<dt>d</dt>\n<data>500. 0. 320. 0. 501. 240. 0. 0. 1.</data></camera_matrix>\n\
    <distortion_coefficients type_id=\"opencv-matrix\">\n<rows>1</rows>\n<cols>4</cols>\n<dt>f</dt>\n<data>0.1 0. 0. 0.</data></distortion_coefficients>\n\
    </opencv_storage>\n";
const METASHAPE: &str =
    "<calibration>\n<projection>frame</projection>\n<width>640</width>\n<height>480</height>\n<f>500</f>\n<k1>0.1</k1>\n</calibration>";
const OLD: &str = "<calibration><projection>frame</projection><width>640</width><height>480</height><fx>500</fx><fy>501</fy><cx>320</cx><cy>240</cy></calibration>";
const DOCUMENT: &str = "<document version=\"2.0.0\"><chunk><sensors><sensor id=\"0\" label=\"a\" type=\"frame\">\n<property name=\"pixel_width\" value=\"0.0024\"/>\n\
    <property name=\"pixel_height\" value=\"0.0024\"/>\n<calibration type=\"frame\" class=\"adjusted\">\n<resolution width=\"640\" height=\"480\"/>\n<f>500</f>\n<k1>0.1</k1>\n\
    </calibration>\n<covariance>\n<params>f k1</params>\n<coeffs>4 0.1 0.1 1</coeffs>\n</covariance></sensor></sensors></chunk></document>";
const CAM: &str = "Pix4D camera calibration file 0\n#Focal Length mm assuming a sensor width of 17.5x13.125mm\nF 15.0\n#Principal Point mm\nPx 8.5\nPy 6.3\n\
    #Symmetrical Lens Distortion Coeffs\nK1 0.04\nK2 -0.02\nK3 0.02\n#Tangential Lens Distortion Coeffs\nT1 0.002\nT2 0.003\n";
const INPHO: &str = "camera_calibration_file 0\n#Focal Length (mm) assuming a sensor width of 12.8x8.6mm\n#Image size 640x480 pixel\nFOCAL 10\n\
    #Principal Point Offset xpoff ypoff in pixel\nXPOFF -7\nYPOFF 12\nSYM_DIST 0 1e-5 0 0\nDEC_DIST 1e-5 2e-5 0\n";
const PARAMETERS: &str = "fileName imageWidth imageHeight \ncamera matrix K [3x3]\nradial distortion [3x1]\ntangential distortion [2x1]\n\
    camera position t [3x1]\ncamera rotation R [3x3]\ncamera model m = K [R|-Rt] X\n\na b.JPG 640 480\n500 0 320\n0 500 240\n0 0 1\n0.1 0 0\n0 0\n\
    1 2 3\n1 0 0\n0 1 0\n0 0 1\n";
const OURS: &str = "format = \"calibench-camera\"\nversion = 1\nmodel = \"photogrammetric\"\n[image]\nwidth_px = 640\nheight_px = 480\npitch_um = 5.0\n\
    [interior_orientation]\nc_mm = 20.0\nx0_mm = 0.1\ny0_mm = 0.2\n";
const ALL: [&str; 9] = [YAML, OPENCV, METASHAPE, OLD, DOCUMENT, CAM, INPHO, PARAMETERS, OURS];

#[test]
fn the_samples_are_read() {
    for text in ALL {
        read_with(text, of_size()).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert!(read_with(&text.replace('\n', "\r\n"), of_size()).is_ok() && read_with(&format!("\u{feff}{text}"), of_size()).is_ok());
    }
    assert!(read(CAM).unwrap_err().contains("does not state the size of the images; give it"));
}

/// Sample, what is replaced, by what, and what the error must say.
#[rustfmt::skip]
const MISTAKES: [(&str, &str, &str, &str); 46] = [
    (YAML, "500., 0.,", "500.,", "f:9, `camera_matrix.data`: expected 9 numbers for 3 x 3, found 8"),
    (YAML, "rows: 5", "rows: 6", "f:14, `distortion_coefficients.data`: expected 6 numbers for 6 x 1, found 5"),
    (YAML, "rows: 5", "rows: 99999999", "is 99999999 x 1; expected no more than 14 numbers"),
    (YAML, "rows: 5", "rows: 18446744073709551615", "expected no more than 14 numbers"),
    (YAML, "-1.0e-01", ".nan", "f:14, `distortion_coefficients.data`: expected a finite number with a decimal point, found `.nan`"),
    (YAML, "-1.0e-01", "1e999", "found `1e999`"),
    (YAML, "YAML:1.0", "YAML:9.0", "f:1: YAML version `9.0` is not known; expected 1.0"),
    (YAML, "image_height: 480", "image_height: 480\nimage_height: 480", "f:5, `image_height`: stands twice, first on line 4"),
    (YAML, "image_height: 480", "image_Width: 480", "says again what `image_width` said"),
    (YAML, "image_height: 480\n", "", "expected `image_width` and `image_height`, found one of them"),
    (YAML, "image_width: 640", "image_width: 0", "f:3, `image_width`: expected a whole number of pixels"),
    (YAML, "dt: d", "dt: \"2d\"", "f:8, `camera_matrix.dt`: expected d, f or one kind of whole numbers, found `2d`"),
    (YAML, "500., 0.,", "500., 2.,", "has a skew of 2"),
    (YAML, "500., 0.,", "-500., 0.,", "expected focal lengths above zero"),
    (YAML, "data: [ 500.", "data: *a [ 500.", "f:9"),
    (YAML, "image_height: 480", "image_height: 480\nfisheye_model: 1", "expected 4 coefficients of the fisheye camera, found 5"),
    (YAML, "-2.0e-03, 0. ]\n", "-2.0e-03", "not well-formed YAML"),
    (OPENCV, "<cols>4", "<cols>3", "expected 3 numbers for 1 x 3, found 4"),
    (OPENCV, "<dt>f</dt>", "<dt>f</dt><dt>d</dt>", "`dt`: stands twice"),
    (OPENCV, "</opencv_storage>", "", "not well-formed XML"),
    (METASHAPE, "frame", "spherical", "f:2:1, `projection`: projection `spherical` is not known here; expected one of frame, equidistant_fisheye, fisheye"),
    (METASHAPE, "frame</projection>", "fisheye</projection>\n<p3>0.1</p3>", "f:3:1, `p3`: is no parameter of a fisheye"),
    (OLD, "frame", "fisheye", "is a fisheye with `fx`; expected `f`"),
    (METASHAPE, "<f>500</f>", "<f>500</f><f>500</f>", "f:5:11, `f`: stands in `calibration` twice; expected once"),
    (METASHAPE, "<f>500</f>", "", "`calibration`: has no element `f`"),
    (METASHAPE, "<f>500</f>", "<f>NaN</f>", "f:5:1, `f`: expected a finite number with a decimal point, found `NaN`"),
    (METASHAPE, "<f>500</f>", "<f>500</f><k5>0.2</k5>", "`k5`: is no key that is known of a lens"),
    (METASHAPE, "<f>500</f>", "<f>500</f><fx>500</fx>", "stands beside `fx`"),
    (METASHAPE, "<f>500</f>", "<f><a/></f>", "`a`: expected a value in `f`, found an element"),
    (OLD, "<fy>501</fy>", "", "has no element `fy`"),
    (OLD, "<fy>501</fy>", "<fy>501</fy><b1>1</b1>", "belongs to files with `f`"),
    (DOCUMENT, "\"2.0.0\"", "\"7.0\"", "version `7.0` is not known"),
    (DOCUMENT, "type=\"frame\">\n<prop", "type=\"spherical\">\n<prop", "projection `spherical` is not known here"),
    (DOCUMENT, "type=\"frame\">\n<prop", "type=\"fisheye\">\n<prop", "is of another type than its sensor"),
    (DOCUMENT, "4 0.1 0.1 1", "4 0.1 1", "`coeffs`: expected 2 x 2 numbers for the parameters above, at most 32, found 3"),
    (DOCUMENT, "4 0.1 0.1 1", "4 9 9 1", "not those of anything"),
    (DOCUMENT, "4 0.1 0.1 1", "4 0.1 0.1 -1", "variance of `k1` is -1"),
    (CAM, "K1 0.04", "K9 0.04", "f:8, `K9`: unknown"),
    (CAM, "K1 0.04", "K1 0.04\nK1 0.04", "f:9, `K1`: stands twice"),
    (CAM, "T2 0.003", "", "f:1, `T2`: missing"),
    (INPHO, "#Image size 640x480 pixel\n", "", "only the .cam that Pix4D writes is understood"),
    (INPHO, "SYM_DIST 0 1e-5 0 0", "SYM_DIST 0 1e-5 0", "f:8, `SYM_DIST`: expected 4 numbers, found 3"),
    (PARAMETERS, "0.1 0 0", "0.1 0", "f:13, `radial distortion`: expected 3 numbers, found 2"),
    (PARAMETERS, "0 1 0\n0 0 1\n", "0 1 0\n", "f:9, `rotation`: ends inside an image"),
    (OURS, "version = 1", "version = 2\nnew = 3", "version 2 is not known; expected 1"),
    (OURS, "c_mm = 20.0", "c_mm = 20.0\nk1 = 3.0", "f:10:1: unknown field `k1`, expected one of `c_mm`, `x0_mm`, `y0_mm`"),
];

#[test]
fn a_mistake_is_named_with_its_place() {
    for (sample, part, instead, expected) in MISTAKES {
        assert!(sample.contains(part), "{part}");
        let error = read_with(&sample.replacen(part, instead, 1), of_size()).unwrap_err();
        assert!(error.contains(expected), "`{part}` -> `{instead}`: {error}");
    }
    for (part, instead) in [
        ("c_mm = 20.0", "c_mm = nan"),
        ("pitch_um = 5.0", "pitch_um = -5.0"),
        ("x0_mm = 0.1", "x0_mm = inf"),
        ("model = \"p", "model = \"q"),
    ] {
        assert!(read(&OURS.replacen(part, instead, 1)).is_err(), "{instead}");
    }
}

#[test]
fn the_fisheye_is_told_by_its_mark_or_by_the_user() {
    let model = |text: &str, fisheye| {
        read_with(text, ReadOptions { size: None, fisheye, ..ReadOptions::default() })
            .map(|file| matches!(file.cameras[0].camera, Camera::OpenCvFisheye(_)))
    };
    assert_eq!(model(OPENCV, None), Ok(false));
    assert!(read(OPENCV).unwrap().cameras[0].notes[0].contains("read as the pinhole camera's"));
    assert_eq!(model(OPENCV, Some(true)), Ok(true));
    let marked = OPENCV.replace("<image_width>", "<fisheye_model>1</fisheye_model><image_width>");
    assert_eq!(model(&marked, None), Ok(true));
    assert!(model(&marked, Some(false)).unwrap_err().contains("contradicts"));
}

#[test]
fn numbers_of_single_precision_are_what_opencv_would_hold() {
    let Camera::OpenCv(camera) = read(OPENCV).unwrap().cameras[0].camera else { panic!() };
    assert_eq!(camera.distortion[0], f64::from(0.1_f32));
}

#[test]
fn cut_anywhere_or_changed_anywhere_nothing_panics() {
    for text in ALL {
        for end in 0..text.len() {
            let _ = read_with(&text[..end], of_size());
            let mut bytes = text.as_bytes().to_vec();
            for byte in [0, b'<', b'-', b'\n', b'9', 0xff] {
                bytes[end] = byte;
                let _ = parse_camera("f", &bytes, &of_size());
            }
        }
    }
}

#[test]
fn what_is_no_camera_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("camera.xml");
    let error = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        read_camera(&path).unwrap_err().to_string()
    };
    assert!(error(b"").ends_with("camera.xml: is empty; expected a camera"));
    assert!(error(b" \n").contains("is empty"));
    assert!(error(b"ab\n\xff\xfe").ends_with(":2: expected text in UTF-8, found other bytes"));
    assert!(error(b"ab\n\0").ends_with(":2: expected text, found a zero byte"));
    assert!(error(b"<svg/>").contains("no camera file that is known: XML of root `svg`; no reader comes near"));
    assert!(read_camera(folder.path()).unwrap_err().to_string().contains("is a folder; expected a camera file"));
    assert!(read_camera(&folder.path().join("none")).unwrap_err().to_string().contains("No such file"));
    let large = std::fs::File::create(&path).unwrap();
    large.set_len(1 << 30).unwrap();
    let start = Instant::now();
    assert!(read_camera(&path).unwrap_err().problem.contains("is larger than 64 MB"));
    assert!(start.elapsed() < Duration::from_secs(1));
}

#[test]
fn hostile_texts_are_refused_soon() {
    let bomb =
        "<!DOCTYPE c [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;\">]><calibration><f>&b;</f></calibration>";
    assert!(read(bomb).unwrap_err().contains("f:1:1: XML with a DTD is refused"), "{:?}", read(bomb));
    let outside = "<?xml version=\"1.0\"?><!DOCTYPE c SYSTEM \"file:///etc/passwd\"><calibration/>";
    assert!(read(outside).unwrap_err().contains("XML with a DTD is refused"));
    let length = LARGEST_FILE as usize / 8;
    let many = |head: &str, part: &dyn Fn(usize) -> String, count: usize| head.to_owned() + &(0..count).map(part).collect::<String>();
    let texts = [
        many("", &|_| "<a>".into(), length / 3),
        many("<a ", &|i| format!("a{i}='' "), length / 9),
        many("", &|i| format!("<a xmlns:n{i}='{i}'>"), 100_000),
        many("<opencv_storage>", &|_| "<a/>".into(), length / 4),
        many("<opencv_storage><camera_matrix><rows>3</rows><cols>3</cols><dt>d</dt><data>", &|_| "1 ".into(), length / 2),
        many("%YAML:1.0\n---\n", &|_| "[".into(), length),
        many("%YAML:1.0\n---\n", &|_| "- ".into(), length / 2),
        many("%YAML:1.0\n---\na: [", &|_| "1,".into(), length / 2),
        many("%YAML:1.0\n---\n", &|_| "a: ".into(), length / 3),
        many("%YAML:1.0\n---\n", &|_| "? ".into(), length / 2),
        many("%YAML:1.0\n---\n", &|i| format!("a{i}: &x{i} [*x{}]\n", i.max(1) - 1), 100_000),
        many("%YAML:1.0\n---\n\"", &|_| "x".into(), length),
        many("format = \"calibench-camera\"\nversion = 1\na = ", &|_| "[".into(), 500_000),
        many("format = \"calibench-camera\"\n", &|i| format!("a{i}=1\n"), length / 9),
        many("camera_calibration_file\n", &|_| "XPOFF 1\n".into(), length / 8),
        many("Pix4D camera calibration file\n", &|_| "Pix4D camera calibration file\n".into(), length / 30),
        many("", &|_| "a 1 2 3 4 5 6 7 8 9 1 2 3\n".into(), length / 26),
    ];
    for text in texts {
        let start = Instant::now();
        let error = read(&text).unwrap_err();
        let taken = start.elapsed();
        assert!(error.len() < 2000 && taken < Duration::from_secs(10), "{text:.40}: {taken:?} {error:.300}");
    }
}

#[test]
fn what_cannot_be_written_is_said_and_leaves_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("camera");
    let format = |name| super::super::format_named(name).unwrap();
    let mut cameras = read(METASHAPE).unwrap().cameras;
    write_camera(&path, format("metashape"), &cameras).unwrap();
    let before = std::fs::read(&path).unwrap();
    let fails = |name, cameras: &[_]| write_camera(&path, format(name), cameras).unwrap_err().to_string();
    assert!(fails("opencv-yaml", &cameras).contains("opencv-yaml holds a camera of OpenCV's models; convert the camera first"));
    assert!(fails("photoscan-cameras", &cameras).contains("convert the camera first"));
    assert!(fails("pix4d-pmatrix", &cameras).contains("is only read, not written"));
    assert!(fails("metashape", &[]).contains("no camera to write"));
    let Camera::Agisoft(inner) = &mut cameras[0].camera else { panic!() };
    inner.k[1] = f64::NAN;
    assert!(fails("metashape", &cameras).contains("`k2`: is NaN; expected a finite number"), "{}", fails("metashape", &cameras));
    let twice = [cameras[0].clone(), cameras[0].clone()];
    assert!(fails("metashape", &twice).contains("metashape holds one camera, found 2"));
    let mut old = read(OLD).unwrap().cameras;
    let Camera::Agisoft(inner) = &mut old[0].camera else { panic!() };
    inner.k[3] = 0.1;
    assert!(fails("metashape", &old).contains("`k4`: cannot be written as metashape: belongs to files with `f`"));
    let parameters = read(PARAMETERS).unwrap().cameras;
    assert!(fails("pix4d-inpho", &parameters).contains("the width of the sensor is not known"));
    assert_eq!(std::fs::read(&path).unwrap(), before);
}
