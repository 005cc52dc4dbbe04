//! Camera files that we write are read by OpenCV's own FileStorage, and the other way round.

use calibench_cameras::{ReadOptions, camera_text, format_named, parse_camera};
use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, ImageSize, OpenCv, OpenCvFisheye};
use opencv::core::{
    FileStorage, FileStorage_FORMAT_XML, FileStorage_FORMAT_YAML, FileStorage_MEMORY, FileStorage_READ, FileStorage_WRITE, Mat,
};
use opencv::prelude::*;

const SIZE: ImageSize = ImageSize { width: 4272, height: 2848 };
const FORMATS: [(&str, i32); 2] = [("opencv-yaml", FileStorage_FORMAT_YAML), ("opencv-xml", FileStorage_FORMAT_XML)];

/// A pinhole camera with `coefficients` terms, none of which is a round number.
fn pinhole(coefficients: usize) -> OpenCv {
    let mut distortion = [0.0; 14];
    for (index, slot) in distortion[..coefficients].iter_mut().enumerate() {
        *slot = (-0.3_f64).powi(index as i32 + 1) / 7.0;
    }
    OpenCv { size: SIZE, fx: 3801.0 / 0.7, fy: 3799.0 / 0.7, cx: 6407.0 / 3.0, cy: 4271.0 / 3.0, distortion, coefficients }
}

fn fisheye() -> OpenCvFisheye {
    OpenCvFisheye {
        size: SIZE,
        fx: 2000.0 / 0.7,
        fy: 1999.0 / 0.7,
        cx: 6407.0 / 3.0,
        cy: 4271.0 / 3.0,
        skew: 0.0,
        k: [0.1 / 3.0, -0.01 / 3.0, 1e-9 / 7.0, -0.3],
    }
}

fn numbers(storage: &FileStorage, name: &str) -> Vec<f64> {
    storage.get(name).unwrap().mat().unwrap().data_typed::<f64>().unwrap().to_vec()
}

#[test]
fn opencv_reads_what_is_written() {
    let pinholes = [4, 5, 8, 12, 14].map(|coefficients| Camera::OpenCv(pinhole(coefficients)));
    for camera in pinholes.into_iter().chain([Camera::OpenCvFisheye(fisheye())]) {
        let (k, distortion) = match &camera {
            Camera::OpenCv(c) => ([c.fx, 0.0, c.cx, 0.0, c.fy, c.cy, 0.0, 0.0, 1.0], c.distortion[..c.coefficients].to_vec()),
            Camera::OpenCvFisheye(c) => ([c.fx, 0.0, c.cx, 0.0, c.fy, c.cy, 0.0, 0.0, 1.0], c.k.to_vec()),
            other => panic!("{other:?}"),
        };
        for (name, _) in FORMATS {
            let text = camera_text(format_named(name).unwrap(), &[NamedCamera::new("of \\ \"mine\"", camera)]).unwrap();
            let storage = FileStorage::new_def(&text, FileStorage_READ | FileStorage_MEMORY).unwrap();
            assert_eq!(numbers(&storage, "camera_matrix"), k);
            assert_eq!(numbers(&storage, "distortion_coefficients"), distortion);
            let side = |name| storage.get(name).unwrap().real().unwrap();
            assert_eq!((side("image_width"), side("image_height")), (4272.0, 2848.0));
            assert_eq!(side("fisheye_model") != 0.0, matches!(camera, Camera::OpenCvFisheye(_)));
        }
    }
}

#[test]
fn what_opencv_writes_is_read() {
    for coefficients in [4, 5, 8, 12, 14] {
        let camera = pinhole(coefficients);
        let k = Mat::from_slice_2d(&[[camera.fx, 0.0, camera.cx], [0.0, camera.fy, camera.cy], [0.0, 0.0, 1.0]]).unwrap();
        let row = Mat::from_slice_2d(&[&camera.distortion[..coefficients]]).unwrap();
        let column = row.reshape(1, coefficients as i32).unwrap().try_clone().unwrap();
        for ((name, format), distortion) in FORMATS.into_iter().flat_map(|format| [(format, &row), (format, &column)]) {
            let extension = if name == "opencv-xml" { ".xml" } else { ".yml" };
            let mut storage = FileStorage::new_def(extension, FileStorage_WRITE | FileStorage_MEMORY | format).unwrap();
            storage.write_i32("image_width", 4272).unwrap();
            storage.write_i32("image_height", 2848).unwrap();
            storage.write_mat("camera_matrix", &k).unwrap();
            storage.write_mat("distortion_coefficients", distortion).unwrap();
            let text = storage.release_and_get_string().unwrap();
            let file = parse_camera("opencv", text.as_bytes(), &ReadOptions::default()).unwrap();
            assert_eq!(file.format.name, name);
            assert_eq!(file.cameras[0].camera, Camera::OpenCv(camera));
        }
    }
}
