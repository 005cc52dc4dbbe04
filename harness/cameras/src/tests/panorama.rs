//! Lenses of lensfun's data base and of Hugin's projects, OpenSfM's reconstructions.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, ImageSize, LensProjection, PtLens, Ray};

use super::super::{NamedCamera, ReadOptions, camera_text, format_named};
use super::{read, read_with, seed, sized_options};

const SIZE: ImageSize = ImageSize { width: 1200, height: 900 };

/// Type of the lens, what is said of its distortion, a point x right, y down, z forward, and its image by lensfun.
type Pictured = (&'static str, &'static str, [f64; 3], [f64; 2]);

const LENSFUN_S: [Pictured; 20] = [
    (
        "rectilinear",
        "<distortion model=\"ptlens\" focal=\"18\" a=\"0.01\" b=\"-0.03\" c=\"0.008\"/>",
        [0.2, 0.1, 1.0],
        [792.846_7, 534.935_9],
    ),
    (
        "rectilinear",
        "<distortion model=\"ptlens\" focal=\"18\" a=\"0.01\" b=\"-0.03\" c=\"0.008\"/>",
        [-0.3, 0.15, 1.0],
        [321.967_3, 581.523_8],
    ),
    (
        "fisheye",
        "<distortion model=\"ptlens\" focal=\"18\" a=\"0.01\" b=\"-0.03\" c=\"0.008\"/><real-focal-length focal=\"18\" real-focal=\"18.5\"/>",
        [0.2, 0.1, 1.0],
        [792.688_2, 534.856_6],
    ),
    (
        "fisheye",
        "<distortion model=\"ptlens\" focal=\"18\" a=\"0.01\" b=\"-0.03\" c=\"0.008\"/><real-focal-length focal=\"18\" real-focal=\"18.5\"/>",
        [-0.3, 0.15, 1.0],
        [327.556_1, 578.729_5],
    ),
    ("rectilinear", "<distortion model=\"poly3\" focal=\"18\" k1=\"-0.02\"/>", [0.2, 0.1, 1.0], [793.825_5, 535.425_2]),
    ("rectilinear", "<distortion model=\"poly3\" focal=\"18\" k1=\"-0.02\"/>", [-0.3, 0.15, 1.0], [321.024_7, 581.995_1]),
    ("rectilinear", "<distortion model=\"poly5\" focal=\"18\" k1=\"-0.02\" k2=\"0.003\"/>", [0.2, 0.1, 1.0], [790.120_7, 533.572_9]),
    ("rectilinear", "<distortion model=\"poly5\" focal=\"18\" k1=\"-0.02\" k2=\"0.003\"/>", [-0.3, 0.15, 1.0], [326.362_8, 579.326_0]),
    ("fisheye", "<distortion model=\"ptlens\" focal=\"18\" a=\"0.01\" b=\"-0.03\" c=\"0.008\"/>", [0.2, 0.1, 1.0], [789.812_1, 533.418_5]),
    (
        "fisheye",
        "<distortion model=\"ptlens\" focal=\"18\" a=\"0.01\" b=\"-0.03\" c=\"0.008\"/>",
        [-0.3, 0.15, 1.0],
        [331.738_7, 576.638_1],
    ),
    ("fisheye", "<distortion model=\"poly5\" focal=\"18\" k1=\"-0.02\" k2=\"0.003\"/>", [0.2, 0.1, 1.0], [787.136_1, 532.080_6]),
    ("fisheye", "<distortion model=\"poly5\" focal=\"18\" k1=\"-0.02\" k2=\"0.003\"/>", [-0.3, 0.15, 1.0], [335.945_3, 574.534_8]),
    (
        "equisolid",
        "<distortion model=\"ptlens\" focal=\"18\" a=\"0.01\" b=\"-0.03\" c=\"0.008\"/>",
        [0.2, 0.1, 1.0],
        [789.440_2, 533.232_6],
    ),
    (
        "equisolid",
        "<distortion model=\"ptlens\" focal=\"18\" a=\"0.01\" b=\"-0.03\" c=\"0.008\"/>",
        [-0.3, 0.15, 1.0],
        [332.908_3, 576.053_3],
    ),
    ("stereographic", "<distortion model=\"poly3\" focal=\"18\" k1=\"-0.02\"/>", [0.2, 0.1, 1.0], [791.532_8, 534.278_9]),
    ("stereographic", "<distortion model=\"poly3\" focal=\"18\" k1=\"-0.02\"/>", [-0.3, 0.15, 1.0], [328.401_2, 578.306_9]),
    (
        "orthographic",
        "<distortion model=\"ptlens\" focal=\"18\" a=\"0.01\" b=\"-0.03\" c=\"0.008\"/>",
        [0.2, 0.1, 1.0],
        [788.327_3, 532.676_1],
    ),
    (
        "orthographic",
        "<distortion model=\"ptlens\" focal=\"18\" a=\"0.01\" b=\"-0.03\" c=\"0.008\"/>",
        [-0.3, 0.15, 1.0],
        [336.399_8, 574.307_6],
    ),
    (
        "fisheye_thoby",
        "<distortion model=\"ptlens\" focal=\"18\" a=\"0.01\" b=\"-0.03\" c=\"0.008\"/>",
        [0.2, 0.1, 1.0],
        [797.893_0, 537.459_0],
    ),
    (
        "fisheye_thoby",
        "<distortion model=\"ptlens\" focal=\"18\" a=\"0.01\" b=\"-0.03\" c=\"0.008\"/>",
        [-0.3, 0.15, 1.0],
        [321.324_9, 581.845_0],
    ),
];

/// The image of a point x right, y down, z forward.
fn image(camera: &Camera, [x, y, z]: [f64; 3]) -> PixelPoint {
    camera.project(Ray { x, y: -y, z: -z }).unwrap()
}

fn pt_lens(projection: LensProjection, [a, b, c]: [f64; 3]) -> Camera {
    PtLens { size: SIZE, projection, f: 1100.0, cx: 603.2, cy: 448.7, a, b, c }.into()
}

/// Every projection, with all terms, with b alone and with none, in both tools' files.
#[test]
fn lenses_come_back() {
    for projection in LensProjection::ALL {
        for terms in [[0.01, -0.06, 0.012], [0.0, -0.05, 0.0], [0.0; 3], [0.02, 0.0, 0.0]] {
            for format in ["lensfun", "panotools"].map(|name| format_named(name).unwrap()) {
                let camera = pt_lens(projection, terms);
                let named = NamedCamera { pitch_um: Some(4.3), ..NamedCamera::new("a \"b\" <c>", camera) };
                let text = camera_text(format, &[named]).unwrap();
                let found = read_with(&text, ReadOptions::of_written(format, SIZE)).unwrap_or_else(|error| panic!("{error}\n{text}"));
                assert_eq!(found.format, format);
                let off = super::any_model::apart(&camera, &found.cameras[0].camera);
                assert!(off < 1e-9, "{projection:?} {terms:?} {}: {off} px\n{text}", format.name);
                assert!(format.name == "panotools" || (found.cameras[0].pitch_um.unwrap() - 4.3).abs() < 1e-12, "{text}");
            }
        }
    }
}

/// Points that lensfun 0.3.4 pictures by the same lens, one at a time, in single precision: 1200 x 900 px, crop factor 1.5, 3:2, centre 0.01, -0.02.
#[test]
fn a_lens_pictures_as_lensfun_does() {
    let lens = |kind: &str, distortion: &str| {
        let text = format!(
            "<lensdatabase version=\"1\"><lens><maker>M</maker><model>L</model><mount>G</mount><cropfactor>1.5</cropfactor>\
             <aspect-ratio>3:2</aspect-ratio><type>{kind}</type><center x=\"0.01\" y=\"-0.02\"/><calibration>{distortion}</calibration></lens></lensdatabase>"
        );
        read_with(&text, sized_options(SIZE)).unwrap().cameras.remove(0).camera
    };
    for (kind, distortion, point, expected) in LENSFUN_S {
        let found = image(&lens(kind, distortion), point);
        assert!(found.distance(PixelPoint::new(expected[0], expected[1])) < 1e-3, "{kind} {distortion}: {found:?} {expected:?}");
    }
}

#[test]
fn a_data_base_is_read_with_a_camera_for_each_focal_length() {
    let sized = || sized_options(ImageSize { width: 640, height: 480 });
    let text = seed("lensfun.xml");
    let file = read_with(&text, sized()).unwrap();
    let names: Vec<&str> = file.cameras.iter().map(|named| named.name.as_str()).collect();
    assert_eq!(names, ["Zoom 18-55mm at 18 mm", "Zoom 18-55mm at 55 mm", "Fisheye 8mm"]);
    // The real focal length is that on the axis.
    let Camera::PtLens(first) = file.cameras[0].camera else { panic!("{file:?}") };
    assert!((first.f - 18_200.0 / file.cameras[0].pitch_um.unwrap()).abs() < 1e-9, "{first:?}");
    assert!(matches!(file.cameras[1].camera, Camera::OpenCv(_)));
    assert!(read(&text).unwrap_err().contains("does not state the size"));
    for (from, to, expected) in [
        ("a=\"0.01\"", "a=\"x\"", "f:11:13, `a`: expected a finite number"),
        ("model=\"poly3\"", "model=\"fov1\"", "f:12:13, `model`: `fov1` is not known here; expected ptlens, poly3, poly5, acm or none"),
        ("focal=\"55\"", "focal=\"0\"", "f:12:13, `focal`: expected a number above zero, found 0"),
        ("k1=\"0.004\"", "k1=\"0.004\" k9=\"1\"", "f:12:13, `k9`: is no key that is known of a lens"),
        ("3:2", "3:x", "f:2:5, `aspect-ratio`: expected 3:2 or 1.5"),
        ("<cropfactor>1.5</cropfactor>", "<cropfactor>0</cropfactor>", "f:2:5, `cropfactor`: expected a number above zero"),
        ("b=\"-0.03\"", "b=\"1.03\"", "leave -0.04"),
    ] {
        let error = read_with(&text.replacen(from, to, 1), sized()).unwrap_err();
        assert!(error.contains(expected), "{to}: {error}");
    }
    // What is no camera here is left out, and said.
    let file = read_with(&text.replace("stereographic", "panoramic"), sized()).unwrap();
    assert!(file.cameras[0].notes.iter().any(|note| note == "left out: Fisheye 8mm (panoramic)"), "{:?}", file.cameras[0].notes);
}

#[test]
fn a_project_is_read_with_a_camera_for_each_image() {
    let text = seed("panotools.pto");
    let file = read(&text).unwrap();
    let [first, second] = &file.cameras[..] else { panic!("{file:?}") };
    assert_eq!((first.name.as_str(), second.name.as_str()), ("a b.jpg", "b.jpg"));
    let (Camera::PtLens(first), Camera::PtLens(second)) = (first.camera, second.camera) else { panic!("{file:?}") };
    assert_eq!((first.cx, first.cy, second.cx), (319.5 + 3.5, 239.5 - 2.25, 323.0));
    assert!((first.f - 1.012 * 320.0 / 30_f64.to_radians().tan()).abs() < 1e-9, "{first:?}");
    assert!((second.f - 1.012 * 640.0 / 60_f64.to_radians()).abs() < 1e-9, "{second:?}");
    for (from, to, expected) in [
        ("f0 v60", "f0 v180", "f:7, `v`: no rectilinear lens sees 180 degrees across"),
        ("f0 v60", "f4 v60", "f:7, `f`: type of lens `4` is no camera here; expected 0 (rectilinear), 3 (fisheye)"),
        ("v=0", "v=7", "f:8, `v`: expected the number of an image after `=`, found `7`"),
        ("v60 ", "v=1 ", "f:7, `v`: is that of an image that takes it from this one"),
        ("g0 ", "g1.5 ", "f:7, `g`: is 1.5: a shear of the image"),
        ("a0.01", "a1.5", "f:7, `a`: a, b, c leave"),
        ("b-0.03", "b-0.x3", "f:7, `b`: expected a finite number"),
        ("w640 h480 f0", "w640 h0 f0", "f:7, `h`: expected a whole number of pixels"),
        ("j0", "j0 K3", "f:7, `K`: is no key that is known of a lens"),
        ("j0", "j0 S10,600,10,400", "f:7, `S`: a part of the image is used"),
    ] {
        assert!(text.contains(from), "{from}");
        let error = read(&text.replacen(from, to, 1)).unwrap_err();
        assert!(error.contains(expected), "{to}: {error}");
    }
}

/// Points that OpenSfM's own camera functions project, compiled from its source of July 2026: 640 x 480 px.
#[test]
fn opensfm_s_functions_picture_alike() {
    let camera = |projection: &str, terms: &str| {
        let text = format!("{{\"c\": {{\"projection_type\": \"{projection}\", \"width\": 640, \"height\": 480, {terms}}}}}");
        read(&text).unwrap_or_else(|error| panic!("{error}")).cameras.remove(0).camera
    };
    let six = "\"focal_x\": 0.5, \"focal_y\": 0.51, \"c_x\": 0.01, \"c_y\": -0.02, \"k1\": 0.01, \"k2\": -0.02, \"k3\": 0.03, \"k4\": -0.01, \"k5\": 0.005, \"k6\": 0.001, \
               \"p1\": 0.002, \"p2\": -0.003";
    let whole = format!("{six}, \"s0\": 0.004, \"s1\": -0.005, \"s2\": 0.006, \"s3\": -0.007");
    let four =
        "\"focal_x\": 0.5, \"focal_y\": 0.51, \"c_x\": 0.01, \"c_y\": -0.02, \"k1\": 0.01, \"k2\": -0.02, \"k3\": 0.03, \"k4\": -0.01";
    let brown = "\"focal_x\": 0.5, \"focal_y\": 0.51, \"c_x\": 0.01, \"c_y\": -0.02, \"k1\": -0.1, \"k2\": 0.02, \"k3\": 0.003, \"p1\": 0.002, \"p2\": -0.003";
    let points = [[0.3, -0.2, 1.0], [-1.5, 0.7, 1.5], [0.9, 1.1, 2.0]];
    for (projection, terms, expected) in [
        (
            "fisheye62",
            six,
            [
                [417.780_705_594_77, 164.221_120_195_557],
                [80.335_285_551_541_1, 343.725_209_858_572],
                [450.974_000_448_562, 383.331_598_326_968],
            ],
        ),
        (
            "fisheye624",
            whole.as_str(),
            [
                [417.911_040_130_175, 164.422_872_273_453],
                [80.450_610_345_588_6, 343.980_830_851_876],
                [451.229_465_219_023, 383.746_238_096_911],
            ],
        ),
        (
            "fisheye_opencv",
            four,
            [
                [418.125_569_597_124, 163.986_612_673_956],
                [82.669_742_109_964_8, 342.477_602_755_657],
                [451.389_404_491_179, 383.143_457_599_003],
            ],
        ),
        (
            "fisheye",
            "\"focal\": 0.5, \"k1\": 0.01, \"k2\": -0.02",
            [
                [411.721_012_639_6, 178.019_324_906_96],
                [78.153_438_427_902_6, 352.128_395_400_312],
                [444.807_097_837_166, 392.653_119_578_759],
            ],
        ),
        (
            "brown",
            brown,
            [[420.310_680_736, 162.500_737_099_52], [29.957_693_845_596_7, 367.807_027_329_496], [462.861_308_254, 398.379_145_623_32]],
        ),
        (
            "perspective",
            "\"focal\": 0.5, \"k1\": -0.1, \"k2\": 0.02",
            [[414.284_448, 176.310_368], [28.977_799_506_172_9, 375.077_026_897_119], [456.962_472, 407.509_688]],
        ),
    ] {
        let camera = camera(projection, terms);
        for (point, [x, y]) in points.into_iter().zip(expected) {
            let found = image(&camera, point);
            assert!(found.distance(PixelPoint::new(x, y)) < 1e-9, "{projection}: {found:?} {x} {y}");
        }
    }
}

#[test]
fn a_reconstruction_is_read_with_a_camera_for_each_shot() {
    let text = seed("opensfm-reconstruction.json");
    let file = read(&text).unwrap();
    assert_eq!(file.cameras.iter().map(|named| named.name.as_str()).collect::<Vec<_>>(), ["a.jpg", "b.jpg"]);
    assert!(matches!(file.cameras[0].camera, Camera::SixPrismFisheye(_)));
    let t = file.cameras[0].pose.unwrap().t();
    assert!(t.iter().zip([1.0, 2.0, 3.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{t:?}");
    // Without shots it holds its cameras, and many points are no reason to refuse it.
    let points: String = (0..150_000).map(|i| format!("\"{i}\": {{\"coordinates\": [1, 2, 3], \"color\": [1, 2, 3]}},")).collect();
    let many = text.replace("\"points\": {", &format!("\"points\": {{{points}"));
    assert_eq!(read(&many).unwrap().cameras.len(), 2);
    assert_eq!(read(&text.replace("\"shots\"", "\"nothing\"")).unwrap().cameras[0].name, "v2 a");
    for (from, to, expected) in [
        ("fisheye624", "spherical", "`v2 a.projection_type`: `spherical` is no camera model here; expected perspective"),
        (
            "\"camera\": \"v2 a\", \"rotation\": [0.1",
            "\"camera\": \"v2 b\", \"rotation\": [0.1",
            "`a.jpg.camera`: `v2 b` is not among the cameras",
        ),
        ("[0.1, -0.2, 1.5]", "[0.1, -0.2]", "`a.jpg.rotation`: expected 3 numbers, found 2"),
        ("\"k5\": 0.005", "\"k5\": \"x\"", "`v2 a.k5`: expected a finite number"),
        ("\"s3\"", "\"s4\"", "`v2 a.s4`: is no key that is known of a lens"),
    ] {
        let error = read(&text.replacen(from, to, 1)).unwrap_err();
        assert!(error.contains(expected) && error.starts_with("f:"), "{to}: {error}");
    }
}
