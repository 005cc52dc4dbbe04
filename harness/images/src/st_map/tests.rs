use std::path::Path;

use calibench_model::camera::{Eucm, OpenCv, OpenCvFisheye};

use super::*;

const SIZE: ImageSize = ImageSize { width: 640, height: 480 };

fn barrel() -> Camera {
    let mut distortion = [0.0; 14];
    distortion[..5].copy_from_slice(&[-0.2, 0.05, 1e-3, -5e-4, -0.01]);
    OpenCv { size: SIZE, fx: 500.0, fy: 510.0, cx: 310.0, cy: 250.0, distortion, coefficients: 5 }.into()
}

fn fisheye(f: f64) -> Camera {
    OpenCvFisheye { size: SIZE, fx: f, fy: f, cx: 319.5, cy: 239.5, skew: 0.0, k: [0.01, 0.0, 0.0, 0.0] }.into()
}

fn all(camera: &Camera) -> Undistorted {
    Undistorted::of(camera, Overscan::All).unwrap()
}

/// The place of a map's pixel in the source, by bilinear interpolation, px; from the bottom.
fn look_up(map: &StMap, at: PixelPoint) -> PixelPoint {
    let (width, height) = (map.size.width as usize, map.size.height as usize);
    let (x0, y0) = ((at.x.floor() as usize).min(width - 2), (at.y.floor() as usize).min(height - 2));
    let (fx, fy) = (at.x - x0 as f64, at.y - y0 as f64);
    let value = |i: usize| {
        let of = |dx: usize, dy: usize| f64::from(map.pixels[(y0 + dy) * width + x0 + dx][i]);
        (of(0, 0) * (1.0 - fx) + of(1, 0) * fx) * (1.0 - fy) + (of(0, 1) * (1.0 - fx) + of(1, 1) * fx) * fy
    };
    PixelPoint::new(value(0) * f64::from(map.source.width) - 0.5, (1.0 - value(1)) * f64::from(map.source.height) - 0.5)
}

#[test]
fn there_and_back_is_where_one_was() {
    for camera in [barrel(), fisheye(400.0), Eucm { size: SIZE, fx: 450.0, fy: 450.0, cx: 320.0, cy: 240.0, alpha: 0.5, beta: 0.4 }.into()]
    {
        let picture = all(&camera);
        let undistort = StMap::new(&camera, &picture, Direction::Undistort, false);
        let redistort = StMap::new(&camera, &picture, Direction::Redistort, false);
        assert!((redistort.covered() - 1.0).abs() < 1e-12, "{}", redistort.covered());
        let mut worst: f64 = 0.0;
        for (x, y) in (0..=20).flat_map(|x| (0..=15).map(move |y| (f64::from(x) * 31.9 + 0.5, f64::from(y) * 31.9 + 0.5))) {
            let at = PixelPoint::new(x, y);
            worst = worst.max(look_up(&undistort, look_up(&redistort, at)).distance(at));
        }
        // What remains is that of straight lines between the pixels of the maps.
        assert!(worst < 2e-3, "{worst} px");
    }
}

#[test]
fn places_are_the_camera_s_from_outer_edge_to_outer_edge() {
    let camera = barrel();
    let picture = Undistorted::of(&camera, Overscan::Percent(10.0)).unwrap();
    assert_eq!((picture.size, picture.surplus), (ImageSize { width: 704, height: 528 }, [32, 24]));
    let map = StMap::new(&camera, &picture, Direction::Undistort, false);
    // The axis is pictured alike, 32 px to the right and 24 px down.
    let axis = look_up(&map, PixelPoint::new(342.0, 274.0));
    assert!(axis.distance(PixelPoint::new(310.0, 250.0)) < 1e-3, "{axis:?}");
    // OpenCV's formula for one pixel of the picture.
    let (x, y): (f64, f64) = ((600.0 - 342.0) / 500.0, (100.0 - 274.0) / 510.0);
    let r2 = x * x + y * y;
    let q = 1.0 + r2 * (-0.2 + r2 * (0.05 - 0.01 * r2));
    let u = 310.0 + 500.0 * (x * q + 2.0 * 1e-3 * x * y - 5e-4 * (r2 + 2.0 * x * x));
    let v = 250.0 + 510.0 * (y * q + 1e-3 * (r2 + 2.0 * y * y) - 2.0 * 5e-4 * x * y);
    let [s, t, inside] = map.pixels[100 * 704 + 600];
    assert!((f64::from(s) - (u + 0.5) / 640.0).abs() < 1e-7 && (f64::from(t) - (1.0 - (v + 0.5) / 480.0)).abs() < 1e-7 && inside == 1.0);
    let from_top = StMap::new(&camera, &picture, Direction::Undistort, true);
    assert!((from_top.pixels[100 * 704 + 600][1] + t - 1.0).abs() < 1e-6);
}

#[test]
fn overscan_holds_the_whole_frame_and_no_row_more() {
    let camera = fisheye(400.0);
    let picture = all(&camera);
    let covered = |surplus: [u32; 2]| {
        let size = ImageSize { width: SIZE.width + 2 * surplus[0], height: SIZE.height + 2 * surplus[1] };
        let principal = PixelPoint::new(319.5 + f64::from(surplus[0]), 239.5 + f64::from(surplus[1]));
        StMap::new(&camera, &Undistorted { size, principal, surplus, ..picture }, Direction::Redistort, false).covered()
    };
    let [x, y] = picture.surplus;
    assert!(x > 0 && y > 0);
    assert_eq!(covered([x, y]), 1.0);
    assert!(covered([x - 1, y]) < 1.0 && covered([x, y - 1]) < 1.0);
}

#[test]
fn what_no_plane_holds_is_refused_and_cut_off_on_request() {
    let camera = fisheye(200.0);
    let error = Undistorted::of(&camera, Overscan::All).unwrap_err().to_string();
    assert!(error.contains("off its axis") && error.contains("--overscan PERCENT"), "{error}");
    let cut = Undistorted::of(&camera, Overscan::Percent(50.0)).unwrap();
    let map = StMap::new(&camera, &cut, Direction::Redistort, false);
    assert!(map.covered() > 0.3 && map.covered() < 1.0, "{}", map.covered());
    // A corner more than 90 degrees off has no counterpart.
    assert_eq!(map.pixels[0], [-1.0, -1.0, 0.0]);
    assert!(matches!(Undistorted::of(&camera, Overscan::Percent(1e5)), Err(StMapError::TooLarge { .. })));
}

#[test]
fn files_come_back_and_are_ours() {
    let camera = barrel();
    let picture = all(&camera);
    let map = StMap::new(&camera, &picture, Direction::Redistort, false);
    let folder = tempfile::tempdir().unwrap();
    for (name, float) in [("a.exr", true), ("a.tif", true), ("b.tif", false), ("a.png", false)] {
        let path = folder.path().join(name);
        let kind = MapFile::of(&path, float).unwrap();
        let bytes = encode(&map, kind).unwrap();
        assert_eq!(bytes, encode(&map, kind).unwrap(), "{name}");
        std::fs::write(&path, &bytes).unwrap();
        assert!(!calibench_files::photograph::is_photograph(&path).unwrap(), "{name}");
        let (size, places) = read(&path).unwrap();
        assert_eq!(size, map.size);
        let step = if kind.is_of_sixteen_bits() { 0.5 / 65535.0 + 1e-7 } else { 0.0 };
        for (place, pixel) in places.iter().zip(&map.pixels).filter(|(_, pixel)| pixel[2] > 0.0) {
            assert!((place[0] - pixel[0]).abs() <= step && (place[1] - pixel[1]).abs() <= step, "{name}: {place:?} {pixel:?}");
        }
        // Against the camera itself nothing is left but the rounding.
        let found = check(&path, &camera, &picture, Direction::Redistort, false).unwrap();
        let most = kind.rounding(map.source) * 1.5 + 1e-4;
        assert!(found.as_it_is.unwrap().max_px < most && found.remaining.max_px < most, "{name}: {found:?}");
        assert!((found.pinhole.focal[0] - 500.0).abs() < 0.01 && (found.pinhole.focal[1] - 510.0).abs() < 0.01, "{found:?}");
    }
    assert_eq!(MapFile::of(Path::new("a.png"), true), None);
    assert_eq!(MapFile::of(Path::new("a.jpg"), false), None);
}

#[test]
fn a_check_finds_another_scale_another_camera_and_another_way_up() {
    let (camera, folder) = (barrel(), tempfile::tempdir().unwrap());
    let picture = Undistorted::of(&camera, Overscan::Percent(20.0)).unwrap();
    let path = folder.path().join("map.exr");
    let write = |picture: &Undistorted, camera: &Camera, direction, from_top| {
        let map = StMap::new(camera, picture, direction, from_top);
        std::fs::write(&path, encode(&map, MapFile::Exr).unwrap()).unwrap();
    };
    // Another program's picture, 1.1 times as large in scale and elsewhere.
    let other = Undistorted { focal: [550.0, 561.0], principal: PixelPoint::new(400.0, 260.0), ..picture };
    for direction in [Direction::Undistort, Direction::Redistort] {
        write(&other, &camera, direction, false);
        let found = check(&path, &camera, &picture, direction, false).unwrap();
        assert!(found.as_it_is.unwrap().rms_px > 10.0 && found.remaining.max_px < 1e-2, "{found:?}");
        assert!((found.pinhole.focal[0] - 550.0).abs() < 1e-3 && (found.pinhole.principal.x - 400.0).abs() < 1e-3, "{found:?}");
    }
    // Upside down.
    write(&picture, &camera, Direction::Redistort, true);
    let found = check(&path, &camera, &picture, Direction::Redistort, false).unwrap();
    assert!(found.pinhole.focal[1] < 0.0 && found.remaining.max_px < 1e-2, "{found:?}");
    // Another lens.
    write(&picture, &fisheye(500.0), Direction::Redistort, false);
    assert!(check(&path, &camera, &picture, Direction::Redistort, false).unwrap().remaining.rms_px > 1.0);
    // Another frame.
    let small = ImageSize { width: 320, height: 240 };
    let error = check(
        &path,
        &OpenCvFisheye { size: small, fx: 200.0, fy: 200.0, cx: 160.0, cy: 120.0, skew: 0.0, k: [0.0; 4] }.into(),
        &picture,
        Direction::Redistort,
        false,
    );
    assert!(error.unwrap_err().to_string().contains("is 640 x 480 px, the map of the camera 320 x 240 px"));
}

#[test]
fn what_is_no_map_is_refused() {
    let (camera, folder) = (barrel(), tempfile::tempdir().unwrap());
    let picture = all(&camera);
    let refused = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        check(&path, &camera, &picture, Direction::Redistort, false).unwrap_err().to_string()
    };
    assert!(refused("text.exr", b"no image").contains("not an ST-map that can be read"));
    let encoded = |image: image::DynamicImage| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        bytes.into_inner()
    };
    assert!(refused("eight.png", &encoded(image::DynamicImage::new_rgb8(640, 480))).contains("it has 8 bits"));
    assert!(refused("black.png", &encoded(image::DynamicImage::new_rgb16(640, 480))).contains("holds too few places"));
    let whole = encode(&StMap::new(&camera, &picture, Direction::Redistort, false), MapFile::Exr).unwrap();
    for end in [5, 100, whole.len() / 2, whole.len() - 1] {
        refused("cut.exr", &whole[..end]);
    }
}
