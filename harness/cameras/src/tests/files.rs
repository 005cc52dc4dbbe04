//! Files that the tools themselves wrote.

#![cfg_attr(not(camera_files), allow(dead_code, unused_imports))]

use std::path::{Path, PathBuf};

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, ImageSize, Pix4d};

use super::super::formats::pix4d_pmatrix::{PMatrix, pmatrix_text, read_offset, read_pmatrices};
use super::super::{CameraFile, ReadOptions, camera_text, read_camera, read_camera_with};
use super::{assert_same, read};

fn path(name: &str) -> PathBuf {
    Path::new(option_env!("CALIBENCH_CAMERA_FILES").unwrap_or("")).join(name)
}

fn file(name: &str) -> CameraFile {
    read_camera(&path(name)).unwrap_or_else(|error| panic!("{error}"))
}

fn pix4d(file: &CameraFile, index: usize) -> Pix4d {
    let Camera::Pix4d(camera) = file.cameras[index].camera else { panic!("{:?}", file.cameras[index]) };
    camera
}

fn k(camera: &Pix4d) -> [[f64; 3]; 3] {
    [[camera.f_px, 0.0, camera.px], [0.0, camera.f_px, camera.py], [0.0, 0.0, 1.0]]
}

#[test]
#[cfg_attr(not(camera_files), ignore = "no camera files")]
fn metashape_s_two_exports_are_one_camera() {
    let (metashape, opencv) = (file("metashape-24mm.xml"), file("opencv-24mm.xml"));
    assert_eq!((metashape.format.name, opencv.format.name), ("metashape", "opencv-xml"));
    let (a, b) = (metashape.cameras[0].camera, opencv.cameras[0].camera);
    let ImageSize { width, height } = a.size();
    assert_eq!(a.size(), b.size());
    let mut worst: f64 = 0.0;
    for y in 0..=40 {
        for x in 0..=60 {
            let point = PixelPoint::new(f64::from(width - 1) * f64::from(x) / 60.0, f64::from(height - 1) * f64::from(y) / 40.0);
            let ray = b.unproject(point).unwrap();
            worst = worst.max(a.project(ray).unwrap().distance(b.project(ray).unwrap()));
        }
    }
    assert!(worst < 1e-10 * f64::from(width), "{worst:e} px");
}

#[test]
#[cfg_attr(not(camera_files), ignore = "no camera files")]
fn pix4d_s_three_files_are_one_camera() {
    let (inpho, images) = (file("pix4d-inpho.cam"), file("pix4d-calibrated_camera_parameters.txt"));
    let (cam, matrices) = (pix4d(&inpho, 0), read_pmatrices(&path("pix4d-pmatrix.txt")).unwrap());
    assert_eq!((inpho.format.name, images.format.name), ("pix4d-inpho", "pix4d-parameters"));
    assert_eq!((images.cameras.len(), matrices.len()), (168, 168));
    for (index, (image, printed)) in images.cameras.iter().zip(&matrices).enumerate() {
        let camera = pix4d(&images, index);
        assert_eq!((cam.size, &image.name), (camera.size, &printed.name));
        for (a, b) in [(cam.f_px, camera.f_px), (cam.px, camera.px), (cam.py, camera.py)] {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
        // The .cam prints 20 decimals, of which SYM_DIST leaves 12 digits.
        for (a, b) in cam.r.iter().chain(&cam.t).zip(camera.r.iter().chain(&camera.t)) {
            assert!((a - b).abs() < 1e-11, "{a} {b}");
        }
        let ours = PMatrix::new(&image.name, &k(&camera), &image.pose.unwrap());
        for (a, b) in ours.matrix.as_flattened().iter().zip(printed.matrix.as_flattened()) {
            assert!((a - b).abs() < 0.6e-6, "{}: {a} {b}", image.name);
        }
    }
}

#[test]
#[cfg_attr(not(camera_files), ignore = "no camera files")]
fn p_matrices_come_apart_into_the_camera_they_were_made_of() {
    let (images, matrices) = (file("pix4d-calibrated_camera_parameters.txt"), read_pmatrices(&path("pix4d-pmatrix.txt")).unwrap());
    for (index, (image, printed)) in images.cameras.iter().zip(&matrices).enumerate() {
        let (expected, pose) = (k(&pix4d(&images, index)), image.pose.unwrap());
        // Six decimals of r3, times K: 0.5e-6 * 4471 px in the worst direction; a little more after both divisions.
        let (found, found_pose) = printed.decompose().unwrap();
        for (a, b) in found.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((a - b).abs() < 0.01, "{found:?} {expected:?}");
        }
        for (a, b) in found_pose.position.iter().zip(pose.position) {
            assert!((a - b).abs() < 1e-4, "{a} {b}");
        }
        for (a, b) in found_pose.camera_from_world.as_flattened().iter().zip(pose.camera_from_world.as_flattened()) {
            assert!((a - b).abs() < 2e-6, "{a} {b}");
        }
        // Of an exact matrix the camera comes back exactly.
        let (found, found_pose) = PMatrix::new("", &expected, &pose).decompose().unwrap();
        for (a, b) in found.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((a - b).abs() < 1e-9, "{found:?}");
        }
        assert!(found_pose.position.iter().zip(pose.position).all(|(a, b)| (a - b).abs() < 1e-11));
    }
    let size = Some(ImageSize { width: 5472, height: 3648 });
    let cameras = read_camera_with(&path("pix4d-pmatrix.txt"), &ReadOptions { size, ..ReadOptions::default() }).unwrap();
    assert_eq!((cameras.cameras.len(), cameras.format.name), (168, "pix4d-pmatrix"));
    assert!(read_camera(&path("pix4d-pmatrix.txt")).unwrap_err().to_string().contains("does not state the size of the images"));
    assert_eq!(pmatrix_text(&matrices), std::fs::read_to_string(path("pix4d-pmatrix.txt")).unwrap());
    assert_eq!(read_offset(&path("pix4d-offset.xyz")).unwrap(), [368_109.0, 3_956_043.0, 96.0]);
}

#[test]
#[cfg_attr(not(camera_files), ignore = "no camera files")]
#[allow(clippy::excessive_precision, reason = "the file's own digits")]
fn the_oldest_photoscan_is_read() {
    let cameras = file("photoscan-old-cameras.xml");
    assert_eq!(cameras.format.name, "photoscan-cameras");
    let first = &cameras.cameras[0];
    assert_eq!(first.name, "IMG_7618.jpg");
    let Camera::Agisoft(camera) = first.camera else { panic!() };
    assert_eq!(
        (camera.f + camera.b1, camera.f, camera.b2),
        (1_870.746_913_110_301_9, 1_873.861_612_863_476_9, -8.631_959_204_951_065_2e-1)
    );
    assert_eq!((camera.cx, camera.k[2], camera.p[1]), (525.865_798_738_456_19, -2.166_552_739_393_094_1, -5.291_219_180_017_106_6e-5));
    let pose = first.pose.unwrap();
    assert_eq!((pose.position[1], pose.camera_from_world[1][0]), (-4.002_576_368_284_950_8e-1, -3.155_826_481_745_586_6e-3));
}

#[test]
#[cfg_attr(not(camera_files), ignore = "no camera files")]
fn every_file_written_back_is_the_same_camera() {
    let exact = [
        ("metashape-24mm.xml", "metashape"),
        ("metashape-b1b2.xml", "metashape"),
        ("opencv-24mm.xml", "opencv-xml"),
        ("opencv-s10.yml", "opencv-yaml"),
        ("photoscan-old-cameras.xml", "photoscan-cameras"),
        ("pix4d-calibrated_camera_parameters.txt", "pix4d-parameters"),
    ];
    // Its px become mm and back.
    let rounded = [("pix4d-inpho.cam", "pix4d-inpho")];
    for ((name, format), tolerance) in exact.into_iter().map(|e| (e, 0.0)).chain(rounded.into_iter().map(|e| (e, 1e-14))) {
        let original = file(name);
        assert_eq!(original.format.name, format);
        let again = read(&camera_text(original.format, &original.cameras).unwrap()).unwrap();
        assert_eq!(again.format, original.format);
        assert_same(&original.cameras, &again.cameras, tolerance);
    }
}
