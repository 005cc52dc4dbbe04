//! What we write, read and projected by the tools' own packages: `./bootstrap peers` installs them; where one is absent its test is skipped, by name.

#![cfg_attr(not(all(peer_pycolmap, peer_kapture, peer_opencv, peer_mrcal, peer_ros, peer_theia)), allow(dead_code, unused_imports))]

mod asked_for;

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use calibench_cameras::conversion::converted;
use calibench_cameras::target::{Given, goal};
use calibench_cameras::{read_camera, write_camera};
use calibench_images::st_map::{Direction, MapFile, Overscan, StMap, Undistorted, encode};
use calibench_model::camera::{
    Camera, CameraModel, Eucm, Fov, ImageSize, Omni, OpenCv, OpenCvFisheye, PrismFisheye, RadTanPrismFisheye, Ray, TangentialOrder, Turn,
};
use calibench_model::convert::{ConvertOptions, Method};
use calibench_model::reframing::{Crop, FrameChange, Scaling};
use calibench_model::{NamedCamera, PixelPoint};

use crate::project::root;

const SIZE: ImageSize = ImageSize { width: 1200, height: 900 };
/// The Python of Debian's packages.
const SYSTEM: &str = "/usr/bin/python3";

/// The Python into which `./bootstrap peers` puts packages.
fn own() -> String {
    format!("{}/bin/python", option_env!("CALIBENCH_PEERS").unwrap_or_default())
}

fn opencv(coefficients: usize) -> Camera {
    const ALL: [f64; 14] = [-0.08, 0.02, 3e-4, -6e-4, -0.002, 0.01, -0.002, 1e-3, 1e-4, 2e-5, -1e-4, 1e-5, 0.01, -0.02];
    let mut distortion = [0.0; 14];
    distortion[..coefficients].copy_from_slice(&ALL[..coefficients]);
    OpenCv { size: SIZE, fx: 1400.0, fy: 1403.0, cx: 610.0, cy: 440.0, distortion, coefficients }.into()
}

/// One focal length and so many radial coefficients.
fn radial(count: usize) -> Camera {
    let mut distortion = [0.0; 14];
    distortion[..count].copy_from_slice(&[-0.08, 0.02][..count]);
    OpenCv { size: SIZE, fx: 1400.0, fy: 1400.0, cx: 599.5, cy: 449.5, distortion, coefficients: 4 }.into()
}

fn fisheye(skew: f64, k: [f64; 4]) -> Camera {
    OpenCvFisheye { size: SIZE, fx: 620.0, fy: 621.0, cx: 605.0, cy: 445.0, skew, k }.into()
}

fn wide() -> [Camera; 6] {
    let (size, fx, fy, cx, cy) = (SIZE, 700.0, 701.0, 605.0, 445.0);
    let (k, p) = ([-0.01, 0.002, 0.0, 0.0], [2e-4, 1e-4]);
    [
        Fov { size, fx, fy, cx, cy, w: 0.8 }.into(),
        PrismFisheye { size, fx, fy, cx, cy, k, p, s: [1e-4, -2e-4] }.into(),
        RadTanPrismFisheye { size, fx, fy, cx, cy, k: [-0.01, 0.002, 0.0, 0.0, 1e-4, 0.0], p, s: [1e-4, -2e-4, 2e-4, 1e-4] }.into(),
        Eucm { size, fx, fy, cx, cy, alpha: 0.5, beta: -0.1 }.into(),
        Eucm { size, fx, fy, cx, cy, alpha: 0.5, beta: 0.4 }.into(),
        Eucm { size, fx, fy, cx, cy, alpha: 0.6, beta: 1.1 }.into(),
    ]
}

/// Rays of pixels over the frame that point forward, as points x right, y down, z forward, and their images.
fn sights(camera: &Camera) -> (Vec<[f64; 3]>, Vec<PixelPoint>) {
    let ImageSize { width, height } = camera.size();
    let places = (0..=10).flat_map(|x| (0..=8).map(move |y| (x, y)));
    let sight = |(x, y): (u32, u32)| {
        let at = PixelPoint::new(f64::from(width - 1) * f64::from(x) / 10.0, f64::from(height - 1) * f64::from(y) / 8.0);
        let ray = camera.unproject(at).ok().filter(|ray| ray.z < -0.2)?;
        Some(([2.0 * ray.x, -2.0 * ray.y, -2.0 * ray.z], at))
    };
    let found: Vec<_> = places.filter_map(sight).collect();
    assert!(found.len() > 60, "{camera:?}");
    found.into_iter().unzip()
}

/// The pixels that a tool finds for points by a file.
fn asked(python: &str, tool: &str, file: &Path, points: &[[f64; 3]], variables: &[(&str, &str)]) -> Vec<[f64; 2]> {
    answered(python, "project.py", tool, file, points, variables)
}

/// What one of the scripts answers of a tool and a file.
fn answered(python: &str, script: &str, tool: &str, file: &Path, points: &[[f64; 3]], variables: &[(&str, &str)]) -> Vec<[f64; 2]> {
    let script = root().join("tests/peers").join(script);
    let mut child = Command::new(python)
        .args([script.as_os_str(), tool.as_ref(), file.as_os_str()])
        .envs(variables.iter().copied())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap_or_else(|error| panic!("{python}: {error}"));
    child.stdin.take().unwrap().write_all(serde_json::to_string(points).unwrap().as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{tool} fails at {}: {}", file.display(), String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Converts, writes and asks: the tool pictures every ray where we do, within `tolerance`, px.
fn agrees(python: &str, tool: &str, (to, ending): (&str, &str), cameras: &[Camera], tolerance: f64) {
    let folder = tempfile::tempdir().unwrap();
    for (index, camera) in cameras.iter().enumerate() {
        let source = NamedCamera::new((index + 1).to_string(), *camera);
        let given = Given { source: &source, pitch_um: None, base_mm: None, order: TangentialOrder::OpenCv, output: None };
        let goal = goal(to, &given).unwrap();
        let found =
            converted(&source, &goal, None, None, &ConvertOptions::default()).unwrap_or_else(|error| panic!("{to}: {camera:?}: {error}"));
        assert_eq!(found.conversion.method, Method::Exact, "{to}: {camera:?}");
        let file = folder.path().join(format!("{index}.{ending}"));
        write_camera(&file, goal.format, &[found.camera]).unwrap();
        compare(python, tool, &file, camera, tolerance);
    }
}

fn compare(python: &str, tool: &str, file: &Path, camera: &Camera, tolerance: f64) {
    let (points, expected) = sights(camera);
    let size = format!("{}x{}", camera.size().width, camera.size().height);
    let found = asked(python, tool, file, &points, &[("SIZE", &size)]);
    assert_eq!(found.len(), points.len());
    for (found, expected) in found.iter().zip(&expected) {
        let off = PixelPoint::new(found[0], found[1]).distance(*expected);
        assert!(off < tolerance, "{tool}: {off} px at {expected:?}, {camera:?}");
    }
}

#[test]
#[cfg_attr(not(peer_pycolmap), ignore = "no pycolmap")]
fn pycolmap_reads_both_of_colmap_s_lists_in_every_model() {
    let few = [opencv(0), opencv(4), opencv(5), opencv(8), radial(0), radial(1), radial(2)];
    let round = [fisheye(0.0, [-0.02, 0.003, -0.001, 1e-4]), fisheye(0.0, [0.0; 4])];
    let cameras = [&few[..], &round, &wide()].concat();
    agrees(&own(), "colmap", ("colmap", "txt"), &cameras, 1e-8);
    agrees(&own(), "colmap", ("colmap-bin", "bin"), &cameras, 1e-8);
}

#[test]
#[cfg_attr(not(peer_pycolmap), ignore = "no pycolmap")]
fn pycolmap_reads_lists_that_were_written_in_pieces() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let line = |id: usize| format!("{id} OPENCV 1200 900 {} 1403 610.5 440.5 -0.08 0.02 0.0003 -0.0006\n", 1400.0 + 0.01 * id as f64);
    std::fs::write(at("list.txt"), (1..=9000).map(line).collect::<String>()).unwrap();
    for (from, to, file) in [("list.txt", "colmap-bin", "cameras.bin"), ("cameras.bin", "colmap", "cameras.txt")] {
        let output = crate::project::run(folder.path(), &["convert", from, "--all", "--to", to, "-o", file]);
        assert!(output.status.success(), "{}", crate::project::stderr(&output));
        for id in [1, 4096, 4097, 9000] {
            let Camera::OpenCv(camera) = opencv(4) else { panic!() };
            let camera = OpenCv { fx: 1400.0 + 0.01 * f64::from(id), ..camera }.into();
            let (points, expected) = sights(&camera);
            let found = asked(&own(), "colmap", &at(file), &points, &[("CAMERA", &id.to_string())]);
            let off = found.iter().zip(&expected).map(|(a, b)| PixelPoint::new(a[0], a[1]).distance(*b)).fold(0.0, f64::max);
            assert!(found.len() == points.len() && off < 1e-8, "{file}, camera {id}: {off} px");
        }
    }
}

#[test]
#[cfg_attr(not(all(peer_kapture, peer_pycolmap)), ignore = "no kapture or no pycolmap")]
fn kapture_reads_its_sensors() {
    let wide = wide();
    let cameras = [opencv(4), opencv(8), radial(0), radial(1), radial(2), fisheye(0.0, [-0.02, 0.003, -0.001, 1e-4]), wide[0], wide[1]];
    agrees(&own(), "kapture", ("kapture", "txt"), &cameras, 1e-8);
}

#[test]
#[cfg_attr(not(peer_opencv), ignore = "no opencv-contrib-python")]
fn opencv_reads_its_storage_and_projects_alike() {
    let omni = Omni { size: SIZE, fx: 1100.0, fy: 1101.0, cx: 605.0, cy: 445.0, xi: 1.3, k: [-0.1, 0.02], p: [2e-4, 1e-4] };
    for ending in ["yml", "xml"] {
        agrees(&own(), "opencv", ("opencv", ending), &[4, 5, 8, 12, 14].map(opencv), 1e-8);
        agrees(&own(), "opencv", ("opencv-fisheye", ending), &[fisheye(0.0, [-0.02, 0.003, -0.001, 1e-4]), fisheye(0.002, [0.0; 4])], 1e-8);
        agrees(&own(), "opencv", ("opencv-omnidir", ending), &[omni.into()], 1e-8);
    }
}

/// OpenCV projects with a camera of other images where the pixels of its images come to.
#[test]
#[cfg_attr(not(peer_opencv), ignore = "no opencv-contrib-python")]
fn opencv_projects_into_other_images_where_their_pixels_come_to() {
    let plain = FrameChange::default();
    let crop = Some(Crop { x: 101, y: 50, size: ImageSize { width: 1000, height: 750 } });
    let squeezed = Some(Scaling::Size(ImageSize { width: 600, height: 600 }));
    let mut changes = vec![FrameChange { crop, ..plain }, FrameChange { scaling: squeezed, ..plain }];
    changes.extend([Scaling::Binned(2), Scaling::Times(1.7)].map(|scaling| FrameChange { crop, scaling: Some(scaling), ..plain }));
    changes.extend(Turn::ALL.map(|turn| FrameChange { crop, scaling: Some(Scaling::Times(0.5)), turn: Some(turn) }));
    let omni = Omni { size: SIZE, fx: 1100.0, fy: 1101.0, cx: 605.0, cy: 445.0, xi: 1.3, k: [-0.1, 0.02], p: [2e-4, 1e-4] };
    let cameras = [opencv(4), opencv(5), opencv(8), opencv(12), fisheye(0.0, [-0.02, 0.003, -0.001, 1e-4]), omni.into()];
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("camera.yml");
    for (camera, change) in cameras.iter().flat_map(|camera| changes.iter().map(move |change| (camera, change))) {
        let by = change.of(SIZE).unwrap();
        let made = by.camera(camera).unwrap();
        write_camera(&file, calibench_cameras::format_named("opencv-yaml").unwrap(), &[NamedCamera::new("", made)]).unwrap();
        let (points, places) = sights(camera);
        let turned = |[x, y, z]: &[f64; 3]| {
            let ray = by.ray(Ray { x: *x, y: -*y, z: -*z });
            [ray.x, -ray.y, -ray.z]
        };
        let found = asked(&own(), "opencv", &file, &points.iter().map(turned).collect::<Vec<_>>(), &[]);
        for (found, place) in found.iter().zip(&places) {
            let off = PixelPoint::new(found[0], found[1]).distance(by.point(*place));
            assert!(off < 1e-9, "{off:e} px at {place:?}, {by}: {camera:?}");
        }
    }
}

#[test]
#[cfg_attr(not(peer_opencv), ignore = "no opencv-contrib-python")]
fn an_st_map_is_opencv_s_map() {
    let folder = tempfile::tempdir().unwrap();
    let (map, file) = (folder.path().join("map.tif"), folder.path().join("camera.yml"));
    for coefficients in [4, 5, 8, 12, 14] {
        let camera = opencv(coefficients);
        write_camera(&file, calibench_cameras::format_named("opencv-yaml").unwrap(), &[NamedCamera::new("", camera)]).unwrap();
        // OpenCV's picture has its camera matrix, ours the scale on the axis: another one where the sensor is tilted.
        let (on_axis, principal) = (Undistorted::of(&camera, Overscan::Percent(0.0)).unwrap(), PixelPoint::new(610.0, 440.0));
        let picture = Undistorted { focal: [1400.0, 1403.0], principal, ..on_axis };
        assert!(coefficients == 14 || on_axis.principal.distance(principal) < 1e-9);
        let ours = StMap::new(&camera, &picture, Direction::Undistort, true);
        std::fs::write(&map, encode(&ours, MapFile::TiffFloat).unwrap()).unwrap();
        let points: Vec<[f64; 3]> =
            (0..SIZE.width).step_by(7).flat_map(|x| (0..SIZE.height).step_by(9).map(move |y| [f64::from(x), f64::from(y), 1.0])).collect();
        let off = asked(&own(), "st_map", &file, &points, &[("MAP", map.to_str().unwrap())]);
        let worst = off.as_flattened().iter().fold(0.0_f64, |worst, off| worst.max(off.abs()));
        // Both hold floats of 32 bits.
        assert!(off.len() == points.len() && worst < 3e-4, "{coefficients}: {worst} px");
    }
}

#[test]
#[cfg_attr(not(peer_mrcal), ignore = "no mrcal")]
fn mrcal_reads_its_cameramodel() {
    agrees(SYSTEM, "mrcal", ("mrcal", "cameramodel"), &[4, 5, 8, 12].map(opencv), 1e-8);
}

#[test]
#[cfg_attr(not(peer_ros), ignore = "no camera_calibration_parsers")]
fn ros_parses_its_camera_info() {
    agrees(SYSTEM, "ros", ("ros", "yaml"), &[opencv(5), opencv(8), fisheye(0.0, [-0.02, 0.003, -0.001, 1e-4])], 1e-8);
}

#[test]
#[cfg_attr(not(peer_theia), ignore = "no pytheia")]
fn theia_s_own_cameras_picture_alike() {
    let cameras = [opencv(5), radial(2), fisheye(0.0, [-0.02, 0.003, -0.001, 1e-4]), wide()[0]];
    agrees(&own(), "theia", ("theia", "json"), &cameras, 1e-8);
}

#[test]
#[cfg_attr(not(peer_theia), ignore = "no pytheia")]
fn theia_reads_bundler_s_cameras() {
    // It holds floats of 32 bits.
    agrees(&own(), "bundler", ("bundler", "out"), &[radial(2), radial(1)], 2e-3);
}

/// mrcal's splines of a file, by mrcal and by ours.
#[test]
#[cfg_attr(not(all(peer_mrcal, camera_files)), ignore = "no mrcal or no camera files")]
fn mrcal_s_splines_are_evaluated_as_mrcal_does() {
    let folder = Path::new(option_env!("CALIBENCH_CAMERA_FILES").unwrap_or_default());
    let is_splined = |path: &Path| std::fs::read_to_string(path).is_ok_and(|text| text.contains("LENSMODEL_SPLINED"));
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    for path in files.filter(|path| path.is_file() && is_splined(path)) {
        let splines = read_camera(&path).unwrap().cameras.remove(0).splines.unwrap();
        let (width, height) = (splines.model.size.width, splines.model.size.height);
        let middle = |part: u32, side: u32| f64::from(side) * (0.25 + 0.5 * f64::from(part) / 8.0);
        let (mut points, mut expected) = (Vec::new(), Vec::new());
        for at in (0..=8).flat_map(|x| (0..=8).map(move |y| (x, y))).map(|(x, y)| PixelPoint::new(middle(x, width), middle(y, height))) {
            let Ok(ray) = splines.model.unproject(at) else { continue };
            points.push([ray.x, -ray.y, -ray.z]);
            expected.push(at);
        }
        assert!(points.len() > 50, "{}", path.display());
        for (found, expected) in asked(SYSTEM, "mrcal", &path, &points, &[]).iter().zip(expected) {
            assert!(PixelPoint::new(found[0], found[1]).distance(expected) < 1e-6, "{}: {found:?} {expected:?}", path.display());
        }
    }
}
