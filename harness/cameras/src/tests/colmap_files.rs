//! COLMAP's binary list of cameras, and its lists of images.

use calibench_model::camera::Camera;

use super::super::{CameraFile, NamedCamera, ReadOptions, camera_bytes, camera_text, format_named, parse_camera, read_camera};
use super::{assert_same, read};

/// A camera of every model of COLMAP 4 but its panorama, with the numbers that pycolmap was given.
const CAMERAS: &str = "10 SIMPLE_PINHOLE 640 480 500 320 240\n13 PINHOLE 640 480 500 501 320 240\n16 SIMPLE_RADIAL 640 480 500 320 240 -0.1\n\
    19 RADIAL 640 480 500 320 240 -0.1 0.02\n22 OPENCV 640 480 500 501 320 240 -0.1 0.02 0.001 -0.002\n\
    25 OPENCV_FISHEYE 640 480 300 301 320 240 -0.02 0.01 0.001 -0.0005\n\
    28 FULL_OPENCV 640 480 500 501 320 240 -0.1 0.02 0.001 -0.002 0.003 0.01 0.002 -0.001\n31 FOV 640 480 300 301 320 240 0.8\n\
    34 SIMPLE_RADIAL_FISHEYE 640 480 300 320 240 -0.02\n37 RADIAL_FISHEYE 640 480 300 320 240 -0.02 0.01\n\
    40 THIN_PRISM_FISHEYE 640 480 300 310 320 240 -0.02 0.01 0.001 -0.002 0.003 -0.001 0.002 -0.001\n\
    43 RAD_TAN_THIN_PRISM_FISHEYE 640 480 300 310 320 240 0.01 -0.02 0.03 -0.01 0.005 0.001 0.002 -0.003 0.004 -0.005 0.006 -0.007\n\
    46 SIMPLE_DIVISION 640 480 500 320 240 -0.1\n49 DIVISION 640 480 500 510 320 240 -0.2\n52 SIMPLE_FISHEYE 640 480 300 320 240\n\
    55 FISHEYE 640 480 300 310 320 240\n58 EUCM 640 480 300 310 320 240 0.6 1.1\n";
/// Two images; the first has no point and spaces in its name.
const IMAGES: &str = "# Image list\n7 0.92338051687663869 0.10259783520851541 0.20519567041703082 -0.30779350562554619 1 -2 3 13 left/a 1.jpg\n\n\
    9 1 0 0 0 0 0 0 43 b.jpg\n1.5 2.5 -1 3 4 -1\n";

fn cameras() -> Vec<NamedCamera> {
    read(CAMERAS).unwrap().cameras
}

fn binary(cameras: &[NamedCamera]) -> Vec<u8> {
    camera_bytes(format_named("colmap-bin").unwrap(), cameras).unwrap()
}

fn parse(bytes: &[u8]) -> Result<CameraFile, String> {
    parse_camera("f", bytes, &ReadOptions::default()).map_err(|error| error.to_string())
}

/// The list of images as images.bin holds it: the second has two points.
fn images_bin() -> Vec<u8> {
    let mut out = 2_u64.to_le_bytes().to_vec();
    let q = [0.923_380_516_876_638_7, 0.102_597_835_208_515_41, 0.205_195_670_417_030_82, -0.307_793_505_625_546_2];
    for (id, numbers, camera, name, points) in [
        (7_u32, [q[0], q[1], q[2], q[3], 1.0, -2.0, 3.0], 13_u32, "left/a 1.jpg", 0_u64),
        (9, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], 43, "b.jpg", 2),
    ] {
        out.extend(id.to_le_bytes());
        out.extend(numbers.into_iter().flat_map(f64::to_le_bytes));
        out.extend(camera.to_le_bytes());
        out.extend(name.bytes().chain([0]));
        out.extend(points.to_le_bytes());
        out.extend(vec![0xff; 24 * points as usize]);
    }
    out
}

#[test]
fn the_two_lists_hold_the_same_cameras_and_models() {
    let cameras = cameras();
    let bytes = binary(&cameras);
    let found = parse(&bytes).unwrap();
    assert_eq!(found.format.name, "colmap-bin");
    assert_same(&found.cameras, &cameras, 0.0);
    // Ids and the names of models stay, but where COLMAP 3 holds the same camera under a name of its own.
    let text = camera_text(format_named("colmap").unwrap(), &found.cameras).unwrap();
    let words = |text: &str| -> Vec<(String, String)> {
        let lines = text.lines().filter(|line| !line.starts_with('#'));
        lines.map(|line| line.split_once(' ').map(|(id, rest)| (id.into(), rest.split(' ').next().unwrap().into())).unwrap()).collect()
    };
    let of_colmap_3 = CAMERAS.replace(" SIMPLE_FISHEYE", " SIMPLE_RADIAL_FISHEYE").replace(" FISHEYE", " OPENCV_FISHEYE");
    assert_eq!(words(&text), words(&of_colmap_3));
    // 8 bytes of the count, 24 of each head, 8 of each number.
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let numbers: usize = lines.map(|line| line.split(' ').count() - 4).sum();
    assert_eq!(bytes.len(), 8 + 17 * 24 + 8 * numbers);
    // The first record, byte by byte: id 10, model 0, 640, 480, 500.
    let head = [10, 0, 0, 0, 0, 0, 0, 0, 0x80, 2, 0, 0, 0, 0, 0, 0, 0xe0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x40, 0x7f, 0x40];
    assert_eq!(bytes[8..40], head);
    assert_eq!(bytes[8 + 24 + 24 + 4], 1, "the second model's number");
}

#[test]
fn a_binary_list_that_is_cut_or_changed_is_refused() {
    let two = &cameras()[..2];
    let bytes = binary(two);
    for end in 0..bytes.len() {
        assert!(parse(&bytes[..end]).is_err(), "{end}");
    }
    let changed = |at: usize, with: &[u8]| {
        let mut bytes = bytes.clone();
        bytes[at..at + with.len()].copy_from_slice(with);
        parse(&bytes).unwrap_err()
    };
    let big_endian = {
        let mut head: Vec<u8> = bytes[..8].iter().rev().copied().collect();
        for (from, to) in [(8, 12), (12, 16), (16, 24), (24, 32), (32, 40)] {
            head.extend(bytes[from..to].iter().rev());
        }
        parse(&head).unwrap_err()
    };
    for (found, expected) in [
        (changed(0, &3_u64.to_le_bytes()), "`camera 3 of 3`: the file of 112 bytes ends here: expected 4 more, found 0"),
        (changed(0, &u64::from(u32::MAX).to_le_bytes()), "`camera 3 of 4294967295`: the file of"),
        (changed(0, &1_u64.to_le_bytes()), "56 bytes follow the last of 1 cameras; expected none"),
        (changed(12, &99_i32.to_le_bytes()), "`camera 1 of 2`: model number 99 is not known; expected 0 to 17"),
        (changed(12, &(-1_i32).to_le_bytes()), "model number -1 is not known"),
        (changed(12, &17_i32.to_le_bytes()), "`camera 1 of 2, EQUIRECTANGULAR`: a whole panorama"),
        (changed(16, &0_u64.to_le_bytes()), "`camera 1 of 2, WIDTH`: expected a whole number of pixels"),
        (changed(32, &f64::NAN.to_le_bytes()), "`camera 1 of 2, PARAMS[]`: expected a finite number, found NaN"),
        (changed(32, &(-500.0_f64).to_le_bytes()), "expected a number above zero, found -500"),
        (changed(56, &10_u32.to_le_bytes()), "`camera 2 of 2`: the id 10 is another camera's"),
        (parse(&bytes[..60]).unwrap_err(), "it was cut off or its counts are wrong"),
        (big_endian, "its numbers have the greatest byte first"),
    ] {
        assert!(found.contains(expected), "{found}\nexpected {expected}");
    }
    for at in 0..bytes.len() {
        for byte in [0, 1, 0x7f, 0x80, 0xff] {
            let mut bytes = bytes.clone();
            bytes[at] = byte;
            let _ = parse(&bytes);
        }
    }
}

#[test]
fn the_format_asked_for_is_the_format_read() {
    let bytes = binary(&cameras());
    let from = |name, bytes: &[u8]| {
        let options = ReadOptions { from: format_named(name), ..ReadOptions::default() };
        parse_camera("f", bytes, &options).map_err(|error| error.to_string())
    };
    assert!(from("colmap-bin", &bytes).is_ok() && from("colmap", CAMERAS.as_bytes()).is_ok());
    assert!(from("colmap", &bytes).unwrap_err().contains("is no file of colmap: it is no text"));
    assert!(from("colmap-bin", CAMERAS.as_bytes()).unwrap_err().contains("is no file of colmap-bin: it is text"));
    assert!(from("colmap-bin", b"\0\0\0\0\0\0\0\0\0").unwrap_err().contains("is no file of colmap-bin: no count of cameras"));
    assert!(parse(b"\0\0\0\0\0\0\0\0\0").unwrap_err().contains("expected text, found a zero byte"));
    assert!(camera_text(format_named("colmap-bin").unwrap(), &cameras()).unwrap_err().to_string().contains("are no text"));
}

#[test]
fn images_are_cameras_with_poses() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("images.txt"), IMAGES).unwrap();
    std::fs::write(at("images.bin"), images_bin()).unwrap();
    let error = read_camera(&at("images.txt")).unwrap_err().to_string();
    assert!(error.contains("images.txt: is COLMAP's list of images, whose cameras stand in cameras.bin or cameras.txt"), "{error}");
    assert!(parse(IMAGES.as_bytes()).unwrap_err().contains("is COLMAP's list of images"));
    std::fs::write(at("cameras.txt"), CAMERAS).unwrap();
    let (text, bytes) = (read_camera(&at("images.txt")).unwrap(), read_camera(&at("images.bin")).unwrap());
    assert_same(&text.cameras, &bytes.cameras, 0.0);
    std::fs::write(at("cameras.bin"), binary(&cameras())).unwrap();
    assert_eq!((read_camera(&at("images.bin")).unwrap().format.name, text.format.name), ("colmap-bin", "colmap"));
    let [first, second] = &text.cameras[..] else { panic!() };
    assert_eq!((first.name.as_str(), second.name.as_str()), ("left/a 1.jpg", "b.jpg"));
    assert!(matches!(first.camera, Camera::OpenCv(_)) && matches!(second.camera, Camera::RadTanPrismFisheye(_)));
    assert_eq!(second.pose, Some(super::super::Pose::IDENTITY));
    // By hand: the rotation of q = (w, x, y, z), then -R^T t.
    let pose = first.pose.unwrap();
    let [w, x, y, z] = [0.923_380_516_876_638_7, 0.102_597_835_208_515_41, 0.205_195_670_417_030_82, -0.307_793_505_625_546_2];
    let expected = [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)];
    assert!(pose.camera_from_world[0].iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{pose:?}");
    let t: Vec<f64> = (0..3).map(|i| -(0..3).map(|j| pose.camera_from_world[i][j] * pose.position[j]).sum::<f64>()).collect();
    assert!(t.iter().zip([1.0, -2.0, 3.0]).all(|(a, b)| (a - b).abs() < 1e-14), "{t:?}");
}

#[test]
fn images_that_are_wrong_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("cameras.txt"), CAMERAS).unwrap();
    let fails = |name: &str, bytes: &[u8]| {
        std::fs::write(at(name), bytes).unwrap();
        read_camera(&at(name)).unwrap_err().to_string()
    };
    let text = |from: &str, to: &str| fails("images.txt", IMAGES.replacen(from, to, 1).as_bytes());
    for (found, expected) in [
        (text("43 b.jpg", "44 b.jpg"), "images.txt, `b.jpg`: camera 44 is not in "),
        (text("0 43 b.jpg", "0 x b.jpg"), "images.txt:4, `CAMERA_ID`: expected a whole number, found `x`"),
        (text(" 43 b.jpg", " 43"), "images.txt:4: expected IMAGE_ID, QW"),
        (text("9 1 0", "9 0 0"), "`b.jpg`: expected a quaternion, found one of no length"),
    ] {
        assert!(found.contains(expected), "{found}\nexpected {expected}");
    }
    let bytes = images_bin();
    for end in 44..bytes.len() {
        assert!(fails("images.bin", &bytes[..end]).contains("of 2`: "), "{end}");
    }
    let mut lying = bytes.clone();
    let points = bytes.len() - 2 * 24 - 8;
    lying[points..points + 8].copy_from_slice(&u64::MAX.to_le_bytes());
    assert!(fails("images.bin", &lying).contains("`image 2 of 2`: the file of"), "{}", fails("images.bin", &lying));
}

#[test]
fn a_long_list_is_whole_and_each_of_its_cameras_is_looked_at() {
    use calibench_model::camera::{ImageSize, OpenCv};
    let size = ImageSize { width: 640, height: 480 };
    let camera = |f: f64| OpenCv { size, fx: f, fy: f, cx: 320.0, cy: 240.0, distortion: [0.0; 14], coefficients: 4 };
    let named = |i: u32, f: f64| NamedCamera::new(i.to_string(), camera(f).into());
    let mut all: Vec<NamedCamera> = (1..=20_001).map(|i| named(i, 500.0 + f64::from(i))).collect();
    let format = format_named("colmap").unwrap();
    let found = parse_camera("f", &camera_bytes(format, &all).unwrap(), &ReadOptions::default()).unwrap();
    assert_eq!(found.cameras.len(), all.len());
    assert!(found.cameras.iter().zip(&all).all(|(a, b)| a.name == b.name && a.camera == b.camera));
    all[20_000] = named(20_001, -500.0);
    assert!(camera_bytes(format, &all).unwrap_err().to_string().contains("cannot be written as colmap: expected"));
}
