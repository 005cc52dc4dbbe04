//! Files of other tools that are not quite files of theirs.

use calibench_model::camera::ImageSize;

use super::super::{ReadOptions, parse_camera};
use super::{of_size, read_with};

const COLMAP: &str = "# Camera list\n1 OPENCV 640 480 500 501 320 240 -0.1 0.02 1e-3 2e-3\n2 PINHOLE 640 480 500 501 320 240\n";
const KAPTURE: &str = "# kapture format: 1.1\ngps, , gnss, EPSG:4326\ncam, left, camera, RADIAL, 640, 480, 500, 320, 240, -0.1, 0.02\n";
const ROS: &str = "image_width: 640\nimage_height: 480\ncamera_name: a\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [500, 0, 320, 0, 501, 240, 0, 0, 1]\n\
    distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.1, 0.02, 1.0e-3, 0, 0]\nroi: 3\n";
const KALIBR: &str = "cam0:\n  camera_model: pinhole\n  intrinsics: [500, 501, 320, 240]\n  distortion_model: radtan\n  distortion_coeffs: [0.1, 0, 0, 0]\n  \
    resolution: [640, 480]\ncam1:\n  camera_model: omni\n  intrinsics: [1.2, 500, 501, 320, 240]\n  distortion_model: radtan\n  distortion_coeffs: [0.1, 0, 0, 0]\n  \
    resolution: [640, 480]\n  T_cn_cnm1:\n  - [1, 0, 0, -0.1]\n  - [0, 1, 0, 0]\n  - [0, 0, 1, 0]\n  - [0, 0, 0, 1]\n";
const MRCAL: &str = "# made\n{ 'lensmodel': 'LENSMODEL_OPENCV4',\n 'intrinsics': [ 500, 501, 320, 240, 0.1, 0, 0, 0,],\n 'extrinsics': [ 0, 0, 0, 1, 2, 3 ],\n \
    'imagersize': [ 640, 480 ],\n}\n";
const BASALT: &str = "{\"value0\": {\n\"T_imu_cam\": [{\"px\": 1, \"py\": 0, \"pz\": 0, \"qx\": 0, \"qy\": 0, \"qz\": 0, \"qw\": 1}],\n\"intrinsics\": [{\"camera_type\": \"ds\",\n\
    \"intrinsics\": {\"fx\": 300, \"fy\": 301, \"cx\": 320, \"cy\": 240, \"xi\": -0.2, \"alpha\": 0.6}}],\n\"resolution\": [[640, 480]]}}\n";
const CAMODOCAL: &str = "%YAML:1.0\n---\nmodel_type: MEI\ncamera_name: a\nimage_width: 640\nimage_height: 480\nmirror_parameters:\n   xi: 1.2\n\
    distortion_parameters:\n   k1: 0.1\n   k2: 0.\n   p1: 0.\n   p2: 0.\nprojection_parameters:\n   gamma1: 700.\n   gamma2: 701.\n   u0: 320.\n   v0: 240.\n";
const OPENSFM: &str = "{\n\"v2 a\": {\n\"projection_type\": \"brown\", \"width\": 640, \"height\": 480,\n\"focal_x\": 0.8, \"focal_y\": 0.81, \"c_x\": 0.01,\n\
    \"c_y\": 0, \"k1\": -0.1, \"k2\": 0, \"k3\": 0, \"p1\": 0, \"p2\": 0.001}}\n";
const NERFSTUDIO: &str = "{\"camera_model\": \"OPENCV\", \"fl_x\": 500, \"fl_y\": 501, \"cx\": 320, \"cy\": 240, \"w\": 640, \"h\": 480, \"k1\": 0.1,\n\
    \"frames\": [{\"file_path\": \"a.png\",\n\"transform_matrix\": [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]}]}\n";
const OPENMVG: &str = "{\"sfm_data_version\": \"0.3\", \"views\": [],\n\"intrinsics\": [{\"key\": 4, \"value\": {\"polymorphic_id\": 2147483649,\n\
    \"polymorphic_name\": \"pinhole_radial_k3\", \"ptr_wrapper\": {\"id\": 2147483649, \"data\": {\"width\": 640, \"height\": 480,\n\"focal_length\": 500, \
    \"principal_point\": [320, 240], \"disto_k3\": [-0.1, 0.02, 0]}}}},\n{\"key\": 5, \"value\": {\"polymorphic_id\": 1, \"ptr_wrapper\": {\"id\": 2147483650, \
    \"data\": {\"width\": 640,\n\"height\": 480, \"focal_length\": 501, \"principal_point\": [320, 240], \"disto_k3\": [-0.1, 0.02, 0]}}}}]}\n";
const THEIA: &str = "{\"priors\": [{\"CameraIntrinsicsPrior\": {\n\"image_name\": \"a.jpg\", \"width\": 640, \"height\": 480, \"focal_length\": 500,\n\
    \"principal_point\": [320, 240], \"radial_distortion_coeffs\": [0.1, 0.01], \"camera_intrinsics_type\": \"PINHOLE\"}}]}\n";
const BUNDLER: &str = "# Bundle file v0.3\n1 0\n500 -0.1 0.02\n1 0 0\n0 1 0\n0 0 1\n1 2 3\n";
const BAL: &str = "1 1 1\n0 0 1.5 -2.5\n0.1\n0.2\n0.3\n1\n2\n3\n500\n-0.1\n0.02\n1\n2\n3\n";
const XMP: &str = "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n\
    <rdf:Description xcr:Version=\"3\" xcr:DistortionModel=\"brown3t2\" xcr:FocalLength35mm=\"28\" xcr:PrincipalPointU=\"0.01\"\n\
    xmlns:xcr=\"http://www.capturingreality.com/ns/xcr/1.1#\">\n<xcr:Rotation>1 0 0 0 1 0 0 0 1</xcr:Rotation>\n<xcr:Position>1 2 3</xcr:Position>\n\
    <xcr:DistortionCoeficients>-0.1 0.02 0 0 0.001 0.002</xcr:DistortionCoeficients>\n</rdf:Description>\n</rdf:RDF>\n</x:xmpmeta>\n";
const SCAN: &str = "#cameras 2\n#name,x,y,alt,yaw,pitch,roll,f_35mm,px_norm,py_norm,k1,k2,k3,k4,t1,t2\n\
    a.jpg,1,2,3,0,0,0,28,0.01,0,-0.1,0.02,0,0,0.001,0.002\nb.jpg,1,2,3,30,80,-10,28,0.01,0,0,0,0,0,0,0\n";
const BENTLEY: &str = "<BlocksExchange version=\"2.1\"><Block><Photogroups><Photogroup>\n<ImageDimensions><Width>640</Width><Height>480</Height></ImageDimensions>\n\
    <CameraModelType>Perspective</CameraModelType>\n<FocalLength>10</FocalLength>\n<SensorSize>12.8</SensorSize>\n\
    <PrincipalPoint><x>320</x><y>240</y></PrincipalPoint>\n<Distortion><K1>-0.1</K1><P1>0.001</P1></Distortion>\n\
    <Photo><Id>1</Id></Photo></Photogroup></Photogroups></Block></BlocksExchange>\n";
const MICMAC: &str = "<?xml version=\"1.0\" ?>\n<ExportAPERO>\n<CalibrationInternConique>\n<KnownConv>eConvApero_DistM2C</KnownConv>\n<PP>320 240</PP>\n<F>500</F>\n\
    <SzIm>640 480</SzIm>\n<CalibDistortion>\n<ModPhgrStd>\n<RadialePart>\n<CDist>321 239</CDist>\n<CoeffDist>-1e-07</CoeffDist>\n</RadialePart>\n<P1>1e-7</P1>\n\
    </ModPhgrStd>\n</CalibDistortion>\n</CalibrationInternConique>\n</ExportAPERO>\n";
const CALTECH: &str = "% Intrinsic\n%-- Focal length:\nfc = [ 500.0 ; 501.0 ];\ncc = [ 320.0 ; 240.0 ];\nalpha_c = 0.000000;\nkc = [ -0.1 ; 0.02 ; 0.001 ; 0.0 ; 0.0 ];\n\
    fc_error = [ 3.0 ; 3.0 ];\ncc_error = [ 1.5 ; 1.5 ];\nkc_error = [ 0.01 ; 0.02 ; 0.001 ; 0.001 ; 0.0 ];\nnx = 640;\nny = 480;\nn_ima = 2;\nomc_1 = [ 1 ; 2 ; 3 ];\n";
const ALL: [(&str, &str); 18] = [
    ("colmap", COLMAP),
    ("kapture", KAPTURE),
    ("ros", ROS),
    ("kalibr", KALIBR),
    ("mrcal", MRCAL),
    ("basalt", BASALT),
    ("camodocal", CAMODOCAL),
    ("opensfm", OPENSFM),
    ("nerfstudio", NERFSTUDIO),
    ("openmvg", OPENMVG),
    ("theia", THEIA),
    ("bundler", BUNDLER),
    ("bal", BAL),
    ("reality-capture", XMP),
    ("reality-scan-csv", SCAN),
    ("bentley", BENTLEY),
    ("micmac", MICMAC),
    ("caltech", CALTECH),
];

#[test]
fn the_samples_are_read_as_what_they_are() {
    for (format, text) in ALL {
        for text in [text.to_owned(), text.replace('\n', "\r\n"), format!("\u{feff}{text}")] {
            let file = read_with(&text, of_size()).unwrap_or_else(|error| panic!("{error}\n{text}"));
            assert_eq!(file.format.name, format, "{text}");
        }
        // A size that contradicts the file is refused, one that the file leaves open is asked for.
        let other = ReadOptions { size: Some(ImageSize { width: 641, height: 480 }), ..ReadOptions::default() };
        let states_size = super::super::format_named(format).unwrap().states_size;
        assert_eq!(read_with(text, other).is_err(), states_size, "{format}");
        assert_eq!(read_with(text, ReadOptions::default()).is_ok(), states_size, "{format}");
    }
}

#[test]
fn a_division_model_without_coefficients_is_a_pinhole() {
    let zeros = XMP.replace("-0.1 0.02 0 0 0.001 0.002", "0 0 0 0 0 0");
    let read = |text: &str| read_with(text, of_size()).unwrap().cameras[0].camera;
    assert_eq!(read(&zeros.replace("brown3t2", "division")), read(&zeros.replace("brown3t2", "perspective")));
}

#[test]
fn an_id_that_stands_twice_is_refused() {
    let colmap = "1 PINHOLE 640 480 500 501 320 240\n01 PINHOLE 640 480 900 901 320 240\n";
    let kapture = "cam0, left, camera, RADIAL, 640, 480, 500, 320, 240, -0.1, 0.02\ncam0, right, camera, RADIAL, 640, 480, 900, 320, 240, -0.1, 0.02\n";
    for (text, id) in [(colmap, "01"), (kapture, "cam0")] {
        let error = read_with(text, of_size()).unwrap_err();
        assert!(error.contains(&format!("f:2, `{id}`: the id of two cameras, first on line 1")), "{error}");
    }
    let two = OPENMVG.replacen("\"intrinsics\": [", "\"intrinsics\": [ENTRY, ", 1);
    let (entry, _) = OPENMVG.split_once("\"intrinsics\": [").and_then(|(_, rest)| rest.rsplit_once(']')).unwrap();
    let error = read_with(&two.replacen("ENTRY", entry, 1), of_size()).unwrap_err();
    assert!(error.contains("the id of two cameras"), "{error}");
    let camera = "<camera id=\"3\" label=\"LABEL\"><calibration><projection>frame</projection><width>640</width><height>480</height><fx>500</fx><fy>501</fy>\
        <cx>320</cx><cy>240</cy></calibration></camera>\n";
    let old = format!("<collection><cameras>\n{}{}</cameras></collection>\n", camera.replace("LABEL", "a"), camera.replace("LABEL", "b"));
    let error = read_with(&old, ReadOptions::default()).unwrap_err();
    assert!(error.contains("`3`: the id of two cameras, first on line 2"), "{error}");
    // A camera without a name has one in ROS.
    let named = super::super::NamedCamera::new("", read_with(ROS, of_size()).unwrap().cameras[0].camera);
    let text = super::super::camera_text(super::super::format_named("ros").unwrap(), &[named]).unwrap();
    assert!(text.contains("camera_name: \"camera\"\n"), "{text}");
}

#[test]
fn what_is_left_out_is_said() {
    for (text, expected) in [
        (ROS, "`roi` was left out"),
        (KAPTURE, "`gps`, a sensor of kind gnss, was left out"),
        (BENTLEY, "1 photos with their poses were left out"),
        (CALTECH, "the poses of the calibration images were left out"),
    ] {
        let notes = &read_with(text, of_size()).unwrap().cameras[0].notes;
        assert!(notes.iter().any(|note| note == expected), "{notes:?}");
    }
    let covariance = read_with(CALTECH, of_size()).unwrap().cameras[0].covariance.clone().unwrap();
    // Three standard deviations are printed; what was not estimated is not named.
    assert_eq!((covariance.parameters.len(), covariance.values[0]), (8, 1.0));
}

/// Sample, what is replaced, by what, and what the error must say.
#[rustfmt::skip]
const MISTAKES: [(&str, &str, &str, &str); 56] = [
    (COLMAP, "OPENCV 640", "OPENGL 640", "f:2, `OPENGL`: model `OPENGL` is not known; expected SIMPLE_PINHOLE, PINHOLE"),
    (COLMAP, "PINHOLE 640 480 500 501 320 240", "EUCM 640 480 500 501 320 240 0.5 -1", "f:3, `EUCM`: expected a number above zero, found -1"),
    (COLMAP, "PINHOLE 640 480 500 501 320 240", "EUCM 640 480 500 501 320 240 1.5 1", "`EUCM`: expected alpha from 0 to 1, found 1.5"),
    (COLMAP, "PINHOLE 640 480 500 501 320 240", "EQUIRECTANGULAR 640 480 640 480", "`EQUIRECTANGULAR`: a whole panorama"),
    (COLMAP, "2 PINHOLE 640 480 500", "2 PINHOLE 640 480", "f:3, `PINHOLE`: expected 4 numbers for PINHOLE, found 3"),
    (COLMAP, "2 PINHOLE 640 480 500", "2 PINHOLE 640 480 -500", "expected a number above zero, found -500"),
    (COLMAP, "2 PINHOLE 640", "2 PINHOLE 0", "f:3, `WIDTH`: expected a whole number of pixels"),
    (COLMAP, "1e-3", "nan", "f:2, `PARAMS[]`: expected a finite number"),
    (KAPTURE, "RADIAL", "UNKNOWN_CAMERA", "f:3, `UNKNOWN_CAMERA`: model `UNKNOWN_CAMERA` is not known"),
    (KAPTURE, "camera, RADIAL, 640, 480", "camera, RADIAL", "f:3"),
    (ROS, "plumb_bob", "plum_bob", "f:10, `distortion_coefficients`: model `plum_bob` is not known; expected plumb_bob"),
    (ROS, "plumb_bob", "equidistant", "expected 4 coefficients for equidistant, found 5"),
    (ROS, "500, 0, 320", "500, 2, 320", "f:5, `camera_matrix`: expected fx, 0, cx; 0, fy, cy; 0, 0, 1"),
    (ROS, "500, 0, 320, ", "500, 0, ", "`camera_matrix`: expected 9 numbers, found 8"),
    (KALIBR, "omni", "omnius", "f:8, `cam1.camera_model`: `omnius` with `radtan` is not known; expected pinhole with radtan"),
    (KALIBR, "[500, 501, 320, 240]", "[500, 501, 320]", "f:3, `cam0.intrinsics`: expected 4 numbers, found 3"),
    (KALIBR, "[0, 1, 0, 0]", "[0, 2, 0, 0]", "`cam1`: expected a rotation, found a matrix that is none"),
    (KALIBR, "  - [0, 0, 0, 1]\n", "  - [0, 0, 0, 2]\n", "expected 4 x 4 numbers with 0 0 0 1 as the last row"),
    (KALIBR, "[640, 480]", "[640]", "`cam0.resolution`: expected columns and rows, found 1 values"),
    (MRCAL, "OPENCV4", "CAHVOR", "f:2, `lensmodel`: `LENSMODEL_CAHVOR` is not known; expected LENSMODEL_PINHOLE"),
    (MRCAL, "240, 0.1,", "240,", "f:3, `intrinsics`: expected 8 numbers for OPENCV4, found 7"),
    (MRCAL, "LENSMODEL_OPENCV4", "LENSMODEL_SPLINED_STEREOGRAPHIC_order=3_Nx=16", "expected order=3_Nx=16_Ny=11_fov_x_deg=120 or alike, found `order=3_Nx=16`"),
    (MRCAL, "OPENCV4", "SPLINED_STEREOGRAPHIC_order=3_Nx=4_Ny=5_fov_x_deg=120", "`lensmodel`: expected 44 intrinsics, found 8"),
    (MRCAL, "'intrinsics'", "intrinsics", "f:3: expected a name in quotes"),
    (BASALT, "\"ds\"", "\"dss\"", "f:3, `intrinsics[0].camera_type`: `dss` is not known; expected ds, eucm"),
    (BASALT, "\"xi\": -0.2, ", "", "f:4, `intrinsics[0]`: has no `xi`"),
    (BASALT, "[[640, 480]]", "[[640, 480], [640, 480]]", "`resolution`: expected 1 sizes, one for each camera, found 2"),
    (BASALT, "\"qw\": 1", "\"qw\": 0", "f:2: expected a quaternion, found one of no length"),
    (CAMODOCAL, "MEI", "SCARAMUZZA", "f:3, `model_type`: `SCARAMUZZA` is not known; expected MEI"),
    (CAMODOCAL, "   gamma2: 701.\n", "", "`projection_parameters`: has no `gamma2`"),
    (OPENSFM, "\"brown\"", "\"spherical\"", "f:3, `v2 a.projection_type`: `spherical` is no camera model here; expected perspective"),
    (OPENSFM, "0.8,", "-0.8,", "`v2 a.focal_x`: expected a number above zero"),
    (NERFSTUDIO, "\"OPENCV\"", "\"EQUIRECTANGULAR\"", "f:1, `frames[0].camera_model`: `EQUIRECTANGULAR` is not known"),
    (NERFSTUDIO, "[0, 1, 0, 2]", "[0, 1, 2]", "f:3, `frames[0].transform_matrix`: expected 4 x 4 numbers"),
    (OPENMVG, "pinhole_radial_k3", "spherical", "`spherical` is not known; expected pinhole"),
    (OPENMVG, "\"polymorphic_id\": 1,", "\"polymorphic_id\": 2,", "`intrinsics 5`: has no `polymorphic_name`"),
    (THEIA, "\"PINHOLE\"", "\"DOUBLE_SPHERE\"", "`priors[0].camera_intrinsics_type`: `DOUBLE_SPHERE` is not known; expected PINHOLE"),
    (THEIA, "[0.1, 0.01]", "[0.1, 0.01, 0.2]", "has more coefficients than PINHOLE"),
    (BUNDLER, "0 0 1\n1 2 3\n", "0 0 1\n", "ends inside camera 0 of 1"),
    (BUNDLER, "500 -0.1", "-500 -0.1", "f:3: expected a focal length above zero, found -500"),
    (BAL, "0.02\n1\n2\n3\n", "", "ends before the nine numbers of camera 0"),
    (XMP, "brown3t2", "fisheye", "`DistortionModel`: `fisheye` is not known; expected perspective, division"),
    (XMP, "brown3t2", "division", "`DistortionCoeficients`: has coefficients that the model has not"),
    (XMP, "brown3t2", "brown3", "`DistortionCoeficients`: has coefficients that the model has not"),
    (XMP, "xcr:PrincipalPointU=\"0.01\"", "xcr:AspectRatio=\"-1.01\"", "`AspectRatio`: expected a number above zero, found -1.01"),
    (SCAN, ",28,", ",-28,", "f:3, `f`: expected a number above zero, found -28"),
    (SCAN, "-0.1,0.02", "-0.1,x", "f:3, `k2`: expected a finite number"),
    (SCAN, "-0.1,0.02", "-0.1", "f:3: expected 16 columns, found 15"),
    (SCAN, "k3,k4", "k3,k3", "f:2: column `k3` stands twice"),
    (SCAN, "-0.1,0.02,0,0,0.001,0.002", "-0.1,0,0,0,0,0", "f:3, `k1`: has k1 alone, which is the division model's as likely as Brown's; say which with --lens"),
    (BENTLEY, "Perspective", "Fisheye", "f:3:1, `CameraModelType`: `Fisheye` is not known here; expected Perspective"),
    (BENTLEY, "<SensorSize>12.8</SensorSize>\n", "", "has neither `FocalLengthPixels` nor `SensorSize`"),
    (MICMAC, "eConvApero_DistM2C", "eConvApero_DistC2M", "f:4:1, `KnownConv`: `eConvApero_DistC2M` is not known here"),
    (MICMAC, "ModPhgrStd", "ModUnif", "not well-formed XML"),
    (MICMAC, "<CDist>321 239</CDist>\n", "", "`RadialePart`: has no element `CDist`"),
    (CALTECH, "[ 500.0 ; 501.0 ]", "[ 500.0 ]", "f:3, `fc`: expected 2 numbers, found 1"),
];

#[test]
fn a_mistake_is_named_with_its_place() {
    let mut wrong = Vec::new();
    for (sample, part, instead, expected) in MISTAKES {
        assert!(sample.contains(part), "{part}");
        match read_with(&sample.replacen(part, instead, 1), of_size()) {
            Err(error) if error.contains(expected) => {}
            Err(error) => wrong.push(format!("`{part}` -> `{instead}`: {error}")),
            Ok(_) => wrong.push(format!("`{part}` -> `{instead}` is read")),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn cut_anywhere_or_changed_anywhere_nothing_panics() {
    for (_, text) in ALL {
        for end in 0..text.len() {
            let _ = read_with(&text[..end], of_size());
            let mut bytes = text.as_bytes().to_vec();
            for byte in [0, b'<', b'-', b'\n', b'9', b'}', b'"', 0xff] {
                bytes[end] = byte;
                let _ = parse_camera("f", &bytes, &of_size());
            }
        }
    }
}
