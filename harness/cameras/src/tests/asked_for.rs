//! OCamCalib's polynomial, VisualSFM's cameras, DJI's dewarp data, CAHVOR, Qualisys' calibrations and lensfun's acm: each by its own formula.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, ImageSize, Ocam, OpenCv, Ray};

use super::super::{NamedCamera, ReadOptions, camera_text, format_named};
use super::any_model::apart;
use super::{of_size, read, read_with, seed};

type Vector = [f64; 3];

fn one(text: &str, options: ReadOptions) -> NamedCamera {
    read_with(text, options).unwrap_or_else(|error| panic!("{error}\n{text}")).cameras.remove(0)
}

fn refused(text: &str, options: &ReadOptions, changes: &[(&str, &str, &str)]) {
    for (from, to, expected) in changes {
        assert!(text.contains(from), "{from}");
        let error = read_with(&text.replacen(from, to, 1), options.clone()).map(|file| file.cameras).unwrap_err();
        assert!(error.contains(expected) && error.starts_with("f:"), "{to}: {error}");
    }
}

fn dot(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The image of a point of the world, x right, y down, z forward in the camera.
fn image(named: &NamedCamera, point: Vector) -> PixelPoint {
    let pose = named.pose.unwrap();
    let from = std::array::from_fn(|i| point[i] - pose.position[i]);
    let [x, y, z] = pose.camera_from_world.map(|row| dot(row, from));
    named.camera.project(Ray { x, y: -y, z: -z }).unwrap()
}

/// Rows and columns of the toolbox's world2cam where the direct polynomial is inverted by halving, from its axes down, right, backwards.
#[test]
fn ocamcalib_pictures_by_its_direct_polynomial() {
    let text = seed("ocam.txt");
    let named = one(&text, ReadOptions::default());
    assert_eq!(named.camera.size(), ImageSize { width: 640, height: 480 });
    for ([down, right, back], [u, v]) in [
        ([0.2, 0.5, -1.0], [415.622_035_075_081_4, 278.691_545_829_562_13]),
        ([-0.4, 0.3, -0.5], [417.476_456_449_732_3, 110.871_203_905_784_68]),
        ([0.6, -1.0, 0.05], [56.954_725_201_339_386, 398.475_058_896_074_9]),
    ] {
        let found = named.camera.project(Ray { x: right, y: -down, z: back }).unwrap();
        assert!(found.distance(PixelPoint::new(u, v)) < 1e-9, "{found:?} {u} {v}");
    }
    assert_eq!(named.notes, Vec::<String>::new());
    // The polynomial back is looked at: one that leads elsewhere is said.
    let other = one(&text.replace("154.777426", "164.777426"), ReadOptions::default());
    assert!(other.notes[0].contains("px off, at (") && other.camera == named.camera, "{:?}", other.notes);
    refused(
        &text,
        &ReadOptions::default(),
        &[
            ("5 -2.1", "6 -2.1", "f:3, `ss`: expected the number of coefficients and as many"),
            ("-2.100000e+02", "2.100000e+02", "f:3, `ss`: begins with 210; expected a number below zero"),
            ("-2.100000e+02", "x", "f:3, `ss`: expected a finite number"),
            ("5 -2.1", "9 1 1 1 1 -2.1", "f:3, `ss`: has 9 coefficients; expected at most 7"),
            ("14 300", "15 300", "f:7, `invpol`: expected the number"),
            ("240.500000 320.250000", "240.5", "f:11, `center`: expected 2 numbers, found 1"),
            ("1.000500", "0", "f:15, `affine parameters`: expected c above zero"),
            ("480 640", "480.5 640", "f:19, `image size`: expected a whole number of pixels"),
            ("480 640", "", "`image size`: missing"),
        ],
    );
}

/// What is written has both polynomials, and they agree.
#[test]
fn ocamcalib_s_polynomials_come_back_and_agree() {
    let size = ImageSize { width: 752, height: 480 };
    let a = [-206.5, 0.0, 2.2e-3, -4.9e-6, 1.87e-8, 0.0, 0.0];
    for camera in [
        Ocam { size, cx: 394.6, cy: 241.8, c: 1.0003, d: 2.2e-4, e: -2.6e-4, a },
        Ocam { size, cx: 376.0, cy: 240.0, c: 1.0, d: 0.0, e: 0.0, a: [-500.0, 0.0, 1e-4, 0.0, 0.0, 1e-13, -1e-16] },
    ] {
        let text = camera_text(format_named("ocam").unwrap(), &[NamedCamera::new("", camera.into())]).unwrap();
        let found = one(&text, ReadOptions::default());
        assert_eq!((found.camera, found.notes.len()), (camera.into(), 0), "{text} {:?}", found.notes);
        // As the toolbox reads it: by the polynomial back alone.
        let line = text.lines().filter(|line| !line.starts_with('#') && !line.is_empty()).nth(1).unwrap();
        let back: Vec<f64> = line.split(' ').skip(1).map(|word| word.parse().unwrap()).collect();
        for (x, y) in [(0.0, 0.0), (751.0, 479.0), (400.0, 230.0), (100.0, 400.0)] {
            let ray = camera.unproject(PixelPoint::new(x, y)).unwrap();
            let norm = ray.x.hypot(ray.y);
            let theta = (ray.z / norm).atan();
            let rho: f64 = back.iter().enumerate().map(|(i, b)| b * theta.powi(i as i32)).sum();
            let (right, down) = (ray.x / norm * rho, -ray.y / norm * rho);
            let there = PixelPoint::new(right + camera.e * down + camera.cx, camera.d * right + camera.c * down + camera.cy);
            assert!(there.distance(PixelPoint::new(x, y)) < 1e-3, "{there:?} {x} {y}");
        }
    }
}

#[test]
fn visualsfm_corrects_what_was_measured() {
    let text = seed("nvm.nvm");
    let file = read_with(&text, of_size()).unwrap();
    assert_eq!(file.cameras.iter().map(|named| named.name.as_str()).collect::<Vec<_>>(), ["a b.jpg", "b.jpg", "c.jpg"]);
    let (f, r) = (1250.5, -0.03125);
    // A measurement from the middle of the frame, y down, and its ideal direction.
    for m in [[100.0, 50.0], [-319.5, 239.5]] {
        let factor = 1.0 + r * (m[0] * m[0] + m[1] * m[1]) / (f * f);
        let (x, y) = file.cameras[0].camera.unproject(PixelPoint::new(319.5 + m[0], 239.5 + m[1])).unwrap().tangent().unwrap();
        assert!((x - m[0] * factor / f).abs() < 1e-15 && (y + m[1] * factor / f).abs() < 1e-15);
    }
    assert!(matches!(file.cameras[2].camera, Camera::OpenCv(_)), "without distortion everybody's camera");
    assert_eq!(file.cameras[0].pose.unwrap().position, [1.5, -2.5, 0.5]);
    // The quaternion is w first, from the world to the camera.
    let turned = one(&text.replace("1250.5 0.92 0.1 -0.2 0.3", "1250.5 1 0 0 1"), of_size()).pose.unwrap();
    assert!((turned.camera_from_world[1][0] - 1.0).abs() < 1e-15, "{turned:?}");
    let fixed = text.replacen("NVM_V3 ", "NVM_V3 FixedK 1000 322 1001 238 0", 1);
    assert!(matches!(one(&fixed, of_size()).camera, Camera::OpenCv(OpenCv { fx: 1000.0, fy: 1001.0, cx: 322.0, cy: 238.0, .. })));
    let more = text.replace("\n0\n", "\n1\nd.jpg 1 1 0 0 0 0 0 0 0 0\n0\n0\n");
    assert_eq!(one(&more, of_size()).notes, ["holds more models than the first, which were left out"]);
    refused(
        &text,
        &of_size(),
        &[
            ("\n3\n", "\n4\n", "expected the name of an image and 10 numbers, found 1 words"),
            ("\n3\n", "\nx\n", "f:3: expected the number of cameras, found `x`"),
            ("1300 1 0", "0 1 0", "f:6, `c.jpg`: expected a number above zero, found 0"),
            ("1300 1 0 0 0", "1300 0 0 0 0", "f:6, `c.jpg`: expected a quaternion"),
            ("NVM_V3 ", "NVM_V3 FixedK 1 2", "f:1, `FixedK`: expected 5 numbers, found 2"),
            ("NVM_V3 ", "NVM_V3 FixedK 1000 322 1001 238 0.1", "has the radial coefficient 0.1 beside two focal lengths"),
        ],
    );
    let cut: String = text.lines().take(5).map(|line| format!("{line}\n")).collect();
    assert!(read_with(&cut, of_size()).unwrap_err().contains("ends before camera 3 of 3"));
    assert!(read(&text).unwrap_err().contains("does not state the size"));
}

#[test]
fn dji_s_dewarp_data_are_opencv_s_from_the_optical_centre() {
    let expected = |camera: &Camera| {
        let Camera::OpenCv(OpenCv { fx, fy, cx, cy, distortion, .. }) = *camera else { panic!("{camera:?}") };
        assert_eq!([fx, fy, cx, cy], [500.25, 501.5, 317.75, 243.5]);
        assert_eq!(distortion[..5], [-0.26, 0.11, 0.0006, -0.0004, -0.04]);
    };
    let text = seed("dji.xmp");
    let named = one(&text, of_size());
    expected(&named.camera);
    assert_eq!(named.notes, ["calibrated 2018-09-04"]);
    let printed = "ExifTool Version Number : 12.40\nImage Width                     : 640\nImage Height                    : 480\n\
                   Dewarp Data                     : 2018-09-04;500.25,501.5,-2.25,3.5,-0.26,0.11,0.0006,-0.0004,-0.04\nDewarp Flag                     : 1\n";
    let file = one(printed, ReadOptions::default());
    expected(&file.camera);
    assert!(file.notes[1].starts_with("`DewarpFlag` is 1: the distortion has been taken out"), "{:?}", file.notes);
    let json = "[{\"ImageWidth\": 640, \"ImageHeight\": 480, \"DewarpData\": \"2018-09-04;500.25,501.5,-2.25,3.5,-0.26,0.11,0.0006,-0.0004,-0.04\"}]";
    expected(&one(json, of_size()).camera);
    refused(
        &text,
        &of_size(),
        &[
            (",-0.04\"", "\"", "f:9, `DewarpData`: expected a date, `;` and 9 numbers"),
            ("500.25", "5x", "f:9, `DewarpData`: expected a finite number"),
            ("501.5", "-1", "`DewarpData`: expected a number above zero, found -1"),
            ("\"320.000000\"", "\"half\"", "f:6, `CalibratedOpticalCenterX`: expected a finite number"),
        ],
    );
}

/// Column and row of a point by the definition of CAHVOR.
fn by_definition(point: Vector, [c, a, h, v, o, r]: [Vector; 6]) -> PixelPoint {
    let from: Vector = std::array::from_fn(|i| point[i] - c[i]);
    let zeta = dot(from, o);
    let lambda: Vector = std::array::from_fn(|i| from[i] - zeta * o[i]);
    let tau = dot(lambda, lambda) / (zeta * zeta);
    let mu = r[0] + r[1] * tau + r[2] * tau * tau;
    let seen: Vector = std::array::from_fn(|i| from[i] + mu * lambda[i]);
    PixelPoint::new(dot(h, seen) / dot(a, seen), dot(v, seen) / dot(a, seen))
}

#[test]
fn cahvor_is_a_lens_before_a_tilted_sensor() {
    let text = seed("cahvor.cahvor");
    let plain = [[1.0, 2.0, 3.0], [0.0, 0.0, 1.0], [500.0, 0.0, 320.0], [0.0, 500.0, 240.0], [0.28, 0.0, 0.96], [0.25, -0.05, 0.01]];
    // Another axis of the lens, one that is tilted about both axes, a skew without a tilt, and rows that are not those of the world.
    let both = [plain[0], plain[1], plain[2], [0.0, 510.0, 240.0], [0.0, 0.6, 0.8], plain[5]];
    let twice = [plain[0], plain[1], plain[2], plain[3], [0.48, -0.36, 0.8], [0.0, -0.05, 0.01]];
    let skew = [plain[0], plain[1], plain[2], [7.0, 510.0, 240.0], plain[1], plain[5]];
    let turned = [[-2.0, 0.0, 1.0], [1.0, 0.0, 0.0], [300.0, -400.0, 0.0], [200.0, 0.0, -420.0], [1.0, 0.0, 0.0], [0.0, 0.1, 0.0]];
    let other_centre = [plain[0], plain[1], plain[2], plain[3], plain[1], [0.0; 3]];
    for (model, tilted) in [(plain, true), (both, true), (twice, true), (skew, false), (turned, false), (other_centre, false)] {
        let lines: String =
            ["C", "A", "H", "V", "O", "R"].iter().zip(model).map(|(name, [x, y, z])| format!("{name} = {x} {y} {z}\n")).collect();
        let named = one(&format!("Model = CAHVOR = perspective, distortion\nDimensions = 640 480\n{lines}"), ReadOptions::default());
        assert_eq!(matches!(named.camera, Camera::OpenCv(OpenCv { coefficients: 14, .. })), tilted, "{:?}", named.camera);
        let components: String = (1..).zip(model).map(|(i, [x, y, z])| format!("  MODEL_COMPONENT_{i} = ({x},\n    {y}, {z})\n")).collect();
        let label = one(
            &format!("PDS_VERSION_ID = PDS3\nGROUP = GEOMETRIC_CAMERA_MODEL\n  MODEL_TYPE = CAHVOR\n{components}END_GROUP\n"),
            of_size(),
        );
        assert_eq!(label.camera, named.camera);
        let again = one(&camera_text(format_named("cahvor").unwrap(), std::slice::from_ref(&named)).unwrap(), ReadOptions::default());
        let [c, a, _, _, o, _] = model;
        assert!(!named.notes.iter().any(|note| note.contains("perpendicular")), "{:?}", named.notes);
        for (i, j, k) in (0..27).map(|i| (i % 3, i / 3 % 3, i / 9)) {
            // Points before the camera, off the axes of both.
            let side: Vector = std::array::from_fn(|axis| 0.3 * (f64::from([i, j, k][axis]) - 1.0));
            let point: Vector = std::array::from_fn(|axis| c[axis] + 4.0 * (a[axis] + o[axis]) + side[axis]);
            let expected = by_definition(point, model);
            for named in [&named, &again] {
                let off = image(named, point).distance(expected);
                assert!(off < 1e-9, "{model:?}: {off} px at {expected:?}: {:?}", named.camera);
            }
        }
    }
    // A factor on the axis of a lens that is tilted about both axes shears: little of it is left out, and said, much is refused.
    let little = text.replace("O = 0.28 0 0.96", "O = 0.006 0.008 0.99995").replace("R = 0.25", "R = 0.001");
    let said = one(&little, ReadOptions::default());
    assert!(said.notes.iter().any(|note| note.contains("are taken to be perpendicular: up to")), "{:?}", said.notes);
    let more = one(&text.replace("R = 0.25", "Theta = -1.5707963\nwobble = 3\nR = 0.25"), ReadOptions::default());
    assert!(more.notes.iter().any(|note| note.contains("`wobble` was left out")), "{:?}", more.notes);
    refused(
        &text,
        &ReadOptions::default(),
        &[
            ("R = 0.25", "lens_type = 3\nR = 0.25", "f:10, `lens_type`: is no key that is known of a lens"),
            ("= CAHVOR =", "= CAHVORE =", "f:2, `Model`: `CAHVORE` is no camera model here; expected CAHV or CAHVOR"),
            ("H = 500 0 320", "H = 500 0", "f:7, `H`: expected 3 numbers, found 2"),
            ("H = 500 0 320", "H = 500 x 320", "f:7, `H`: expected a finite number"),
            ("V = 0 500 240", "V = 0 -500 240", "f:8, `V`: makes the image a mirror image"),
            ("V = 0 500 240", "V = 0 500 240\nV = 0 501 240", "f:9, `V`: stands twice, first on line 8"),
            ("V = 0 500 240", "V = 30 500 240", "`H`: is not perpendicular to V"),
            ("O = 0.28 0 0.96", "O = 0.48 -0.36 0.8", "`H`: is not perpendicular to V"),
            ("O = 0.28 0 0.96", "O = 0.96 0 -0.28", "`A`: looks away from the axis of the lens"),
            ("R = 0.25", "R = -1", "`O`: expected an axis O and a factor 1 + R[0] above zero"),
            ("R = 0.25", "E = 1 2 3\nR = 0.25", "f:10, `E`: is no part of CAHVOR"),
            ("640 480", "640", "f:3, `Dimensions`: expected columns and rows"),
        ],
    );
}

#[test]
fn qualisys_counts_in_parts_of_a_pixel() {
    let text = seed("qualisys.xml");
    let file = read(&text).unwrap();
    assert_eq!((file.format.name, file.cameras.len()), ("qualisys", 1));
    let named = &file.cameras[0];
    let Camera::OpenCv(OpenCv { size, fx, fy, cx, cy, distortion, .. }) = named.camera else { panic!("{file:?}") };
    assert_eq!((named.name.as_str(), size), ("10001", ImageSize { width: 640, height: 480 }));
    assert_eq!([fx, fy, cx, cy], [1680.0, 1681.0, 320.5, 239.5]);
    assert_eq!(distortion[..5], [-0.0625, 0.125, 0.0005, -0.00025, 0.0]);
    assert!(named.notes.iter().any(|note| note == "left out, since not calibrated: 10002"), "{:?}", named.notes);
    refused(
        &text,
        &ReadOptions::default(),
        &[
            ("107520", "x", "`focalLengthU`: expected a finite number"),
            ("107520", "-1", "`focalLengthU`: expected a number above zero"),
            ("40959.0", "40950.0", "`sensorMaxU`: expected a whole number of pixels"),
            ("skew=\"0.000000\"", "skew=\"3\"", "`skew`: is 3: in which unit is not publicly known"),
            ("tangentalDistortion2", "radialDistortion4", "`radialDistortion4`: is no key that is known of a lens"),
            ("calibrated=\"true\"", "calibrated=\"false\"", "qualisys without a camera"),
        ],
    );
}

/// Adobe's model is OpenCV's five coefficients in other names; lensfun's 0.3.4 does not know it.
#[test]
fn lensfun_s_acm_has_k4_beside_y_and_k5_beside_x() {
    let text = seed("lensfun.xml").replace(
        "model=\"poly3\" focal=\"55\" k1=\"0.004\"",
        "model=\"acm\" focal=\"55\" k1=\"-0.1\" k2=\"0.02\" k3=\"0.003\" k4=\"0.004\" k5=\"-0.005\"",
    );
    let file = read_with(&text, of_size()).unwrap();
    let Camera::OpenCv(OpenCv { size, fx, cx, cy, distortion, .. }) = file.cameras[1].camera else { panic!("{file:?}") };
    assert!(file.cameras[1].notes[0].starts_with("unverified: acm"), "{:?}", file.cameras[1].notes);
    let [k1, k2, k3, k4, k5] = [-0.1, 0.02, 0.003, 0.004, -0.005];
    let ours = OpenCv { size, fx, fy: fx, cx, cy, distortion, coefficients: 5 };
    let [x, y]: [f64; 2] = [0.2, -0.15];
    let r2 = x * x + y * y;
    let common = 1.0 + k1 * r2 + k2 * r2 * r2 + k3 * r2.powi(3) + 2.0 * (k4 * y + k5 * x);
    let expected = PixelPoint::new(cx + fx * (x * common + k5 * r2), cy + fx * (y * common + k4 * r2));
    assert!(ours.project(Ray { x, y: -y, z: -1.0 }).unwrap().distance(expected) < 1e-10);
    let round = |terms: &str| {
        seed("lensfun.xml")
            .replace("<type>stereographic</type>", "<type>fisheye</type>")
            .replace("model=\"ptlens\" focal=\"8\" a=\"0\" b=\"-0.01\" c=\"0.002\"", terms)
    };
    let fisheye = read_with(&round("model=\"acm\" focal=\"8\" k1=\"-0.1\" k2=\"0.02\""), of_size()).unwrap();
    assert!(matches!(fisheye.cameras[2].camera, Camera::OpenCvFisheye(_)), "{fisheye:?}");
    let error = read_with(&round("model=\"acm\" focal=\"8\" k1=\"-0.1\" k4=\"0.02\""), of_size()).unwrap_err();
    assert!(error.contains("`model`: acm on this type of lens is no model here"), "{error}");
}

/// Lenses of other models go into OCamCalib's polynomial, those of the division model exactly.
#[test]
fn wide_lenses_are_fitted_to_ocamcalib_s_polynomial() {
    use calibench_model::camera::{Eucm, OpenCvFisheye};
    use calibench_model::convert::{ConvertOptions, Method};
    let size = ImageSize { width: 1200, height: 900 };
    let (fx, fy, cx, cy) = (420.0, 421.0, 605.0, 445.0);
    let ocam = format_named("ocam").unwrap();
    let division: Camera = Eucm { size, fx, fy, cx, cy, alpha: 0.5, beta: 0.8 }.into();
    let (found, _) = super::super::fit::fit_to_format(ocam, &division, None, None, &ConvertOptions::default()).unwrap();
    assert_eq!(found.method, Method::Exact);
    assert!(apart(&division, &found.camera) < 1e-9);
    let fisheye: Camera = OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k: [-0.02, 0.003, -0.001, 1e-4] }.into();
    let (found, _) = super::super::fit::fit_to_format(ocam, &fisheye, None, None, &ConvertOptions::default()).unwrap();
    assert!(found.residual.max_px < 0.5 && apart(&fisheye, &found.camera) <= 1.1 * found.residual.max_px + 1e-7, "{:?}", found.residual);
}
