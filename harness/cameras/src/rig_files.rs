//! Files of rigs that are no camera files: OpenCV's stereo matrices with their rectification, COLMAP's rig configuration.

use calibench_model::NamedCamera;
use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::named_camera::Pose;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::formats::yaml_matrix as matrix;
use crate::number::shortest;
use crate::opencv;
use crate::pose::quaternion;
use crate::{CameraFileError, format_named};

/// Two cameras as OpenCV's stereo sample writes them: K1, D1, K2, D2 and the size of the images, then R and T of the second against the first, E, F, and the
/// rectification of `stereoRectify` with its usual flags: R1, R2, P1, P2, Q. Both need poses in one frame.
///
/// # Errors
/// A camera that is not OpenCV's pinhole camera, or has no pose.
pub fn opencv_stereo(first: &NamedCamera, second: &NamedCamera) -> Result<String, CameraFileError> {
    let format = format_named("opencv-yaml").ok_or_else(|| CameraFileError::new("OpenCV's format is not there"))?;
    let written = |named: &NamedCamera| match named.camera {
        Camera::OpenCv(_) => opencv::written(&named.camera, format),
        _ => Err(CameraFileError::new("expected pinhole cameras of OpenCV's: other lenses have no stereo matrices")),
    };
    let pose = |named: &NamedCamera| named.pose.ok_or_else(|| CameraFileError::new(format!("camera {} has no pose", named.name)));
    let (a, b) = (written(first)?, written(second)?);
    let between = pose(second)?.seen_from(&pose(first)?);
    let (r, t) = (of_rows(&between), Vector3::from(between.t()));
    let [k1, k2] = [&a.matrix, &b.matrix].map(|k| Matrix3::from_row_slice(k));
    let essential = t.cross_matrix() * r;
    let inverse = |k: &Matrix3<f64>| k.try_inverse().ok_or_else(|| CameraFileError::new("a focal length is zero"));
    let mut fundamental = inverse(&k2)?.transpose() * essential * inverse(&k1)?;
    if fundamental[(2, 2)].abs() > 0.0 {
        fundamental /= fundamental[(2, 2)];
    }
    let size = a.size;
    if b.size != size {
        let problem =
            format!("the images are {} x {} and {} x {} px; expected the same size", size.width, size.height, b.size.width, b.size.height);
        return Err(CameraFileError::new(problem));
    }
    let mut out = format!("%YAML:1.0\n---\nimage_width: {}\nimage_height: {}\n", size.width, size.height);
    for (name, rows, data) in [("K1", 3, a.matrix.to_vec()), ("D1", 1, a.distortion), ("K2", 3, b.matrix.to_vec()), ("D2", 1, b.distortion)]
    {
        out.push_str(&matrix(name, rows, &data));
    }
    out.push_str(&matrix("R", 3, &rows(&r)));
    out.push_str(&matrix("T", 3, t.as_slice()));
    out.push_str(&matrix("E", 3, &rows(&essential)));
    out.push_str(&matrix("F", 3, &rows(&fundamental)));
    if let Some(rectified) = rectified((&first.camera, &second.camera), (&k1, &k2), (&r, &t)) {
        rectified.iter().for_each(|(name, rows, data)| out.push_str(&matrix(name, *rows, data)));
    }
    Ok(out)
}

fn of_rows(pose: &Pose) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| pose.camera_from_world[i][j])
}

fn rows(m: &Matrix3<f64>) -> Vec<f64> {
    m.transpose().as_slice().to_vec()
}

/// R1, R2, P1, P2 and Q: half of the rotation to each camera, then both so that the baseline lies along the rows, or along the columns; the same principal point
/// for both. `None` where a corner of an image has no ray.
///
/// Source: Bouguet's method as OpenCV's `stereoRectify` has it (flags `CALIB_ZERO_DISPARITY`, alpha -1).
fn rectified(
    cameras: (&Camera, &Camera),
    (k1, k2): (&Matrix3<f64>, &Matrix3<f64>),
    (r, t): (&Matrix3<f64>, &Vector3<f64>),
) -> Option<Vec<(&'static str, usize, Vec<f64>)>> {
    let half = Rotation3::new(UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*r)).scaled_axis() * -0.5);
    let turned = half * t;
    let axis = usize::from(turned.x.abs() <= turned.y.abs());
    let mut along = Vector3::zeros();
    along[axis] = if turned[axis] > 0.0 { 1.0 } else { -1.0 };
    let across = turned.cross(&along);
    let angle = (turned[axis].abs() / turned.norm()).min(1.0).acos();
    let level = if across.norm() > 0.0 { Rotation3::new(across / across.norm() * angle) } else { Rotation3::identity() };
    let (r1, r2) = (level * half.inverse(), level * half);
    let shift = r2 * t;
    let other = 1 - axis;
    let size = cameras.0.size();
    let (width, height) = (f64::from(size.width), f64::from(size.height));
    let fc = f64::midpoint(k1[(other, other)], k2[(other, other)]);
    let middle = |camera: &Camera, turn: &Rotation3<f64>| -> Option<[f64; 2]> {
        let mut sum = [0.0; 2];
        for (x, y) in [(0.0, 0.0), (width - 1.0, 0.0), (0.0, height - 1.0), (width - 1.0, height - 1.0)] {
            let ray = camera.unproject(PixelPoint::new(x, y)).ok()?;
            // Axes y down, z forward.
            let to = turn * Vector3::new(ray.x, -ray.y, -ray.z);
            (sum[0], sum[1]) = (sum[0] + fc * to.x / to.z / 4.0, sum[1] + fc * to.y / to.z / 4.0);
        }
        Some([(width - 1.0) / 2.0 - sum[0], (height - 1.0) / 2.0 - sum[1]])
    };
    let (a, b) = (middle(cameras.0, &r1)?, middle(cameras.1, &r2)?);
    let [cx, cy] = [0, 1].map(|i| f64::midpoint(a[i], b[i]));
    let p1 = vec![fc, 0.0, cx, 0.0, 0.0, fc, cy, 0.0, 0.0, 0.0, 1.0, 0.0];
    let mut p2 = p1.clone();
    p2[4 * axis + 3] = fc * shift[axis];
    let q = vec![1.0, 0.0, 0.0, -cx, 0.0, 1.0, 0.0, -cy, 0.0, 0.0, 0.0, fc, 0.0, 0.0, -1.0 / shift[axis], 0.0];
    Some(vec![("R1", 3, rows(r1.matrix())), ("R2", 3, rows(r2.matrix())), ("P1", 3, p1), ("P2", 3, p2), ("Q", 4, q)])
}

/// COLMAP's rig configuration, as `colmap rig_configurator` reads it: the first camera is the reference sensor, images of a camera lie in a folder of its name.
///
/// # Errors
/// No camera, or one without a pose.
pub fn colmap_rig(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let origin = cameras.first().and_then(|named| named.pose).ok_or_else(|| CameraFileError::new("the first camera has no pose"))?;
    let mut parts = Vec::new();
    for (index, named) in cameras.iter().enumerate() {
        let prefix: String = named.name.chars().map(|c| if c == '"' || c == '\\' || c.is_control() { '_' } else { c }).collect();
        if index == 0 {
            parts.push(format!("      {{\"image_prefix\": \"{prefix}/\", \"ref_sensor\": true}}"));
            continue;
        }
        let pose = named.pose.ok_or_else(|| CameraFileError::new(format!("camera {} has no pose", named.name)))?.seen_from(&origin);
        let [x, y, z, w] = quaternion(pose.camera_from_world);
        let row = |values: &[f64]| values.iter().map(|&v| shortest(v)).collect::<Vec<_>>().join(", ");
        parts.push(format!(
            "      {{\n        \"image_prefix\": \"{prefix}/\",\n        \"cam_from_rig_rotation\": [{}],\n        \"cam_from_rig_translation\": [{}]\n      }}",
            row(&[w, x, y, z]),
            row(&pose.t())
        ));
    }
    Ok(format!("[\n  {{\n    \"cameras\": [\n{}\n    ]\n  }}\n]\n", parts.join(",\n")))
}

#[cfg(test)]
mod tests {
    use calibench_model::camera::{ImageSize, OpenCv};
    use calibench_model::named_camera::PoseFrame;

    use super::*;
    use crate::{ReadOptions, parse_camera};

    /// Of OpenCV 5.0's `stereoCalibrate`, on examples/rig.
    fn pair() -> [NamedCamera; 2] {
        let camera = |[fx, fy, cx, cy]: [f64; 4], d: [f64; 5]| {
            let mut distortion = [0.0; 14];
            distortion[..5].copy_from_slice(&d);
            Camera::from(OpenCv { size: ImageSize { width: 1280, height: 960 }, fx, fy, cx, cy, distortion, coefficients: 5 })
        };
        let left = camera(
            [1_069.748_499_7, 1_071.826_091_7, 643.448_211_23, 472.432_935_37],
            [-0.276_167_891_31, 0.071_704_180_653, 1.891_116_295_3e-4, -3.532_492_969_1e-4, 0.014_954_820_005],
        );
        let right = camera(
            [1_058.158_945_6, 1_058.886_975_2, 631.437_769_91, 487.686_537_7],
            [-0.269_064_578_84, 0.085_320_418_165, -1.195_954_629_5e-4, 5.464_651_538_4e-4, -0.011_059_160_542],
        );
        let r = [
            [0.977_589_664_6, -0.020_793_218_9, -0.209_490_070_6],
            [0.018_877_520_2, 0.999_759_739_1, -0.011_140_167_5],
            [0.209_671_378_3, 0.006_935_859_6, 0.977_747_312_4],
        ];
        let pose = Pose::of_rt(r, [-0.236_693_024_6, -0.008_635_189_7, -0.040_507_265_8]);
        let named = |name: &str, camera, pose| NamedCamera {
            pose: Some(pose),
            pose_frame: PoseFrame::FirstCamera,
            ..NamedCamera::new(name, camera)
        };
        [named("left", left, Pose::IDENTITY), named("right", right, pose)]
    }

    /// The numbers of a matrix of a file.
    fn numbers(text: &str, name: &str) -> Vec<f64> {
        let inside = text.split(&format!("\n{name}: !!opencv-matrix")).nth(1).unwrap();
        let inside = inside.split("data: [").nth(1).unwrap().split(']').next().unwrap();
        inside.split(',').map(|number| number.trim().parse().unwrap()).collect()
    }

    #[test]
    fn the_rectification_is_opencvs() {
        let [left, right] = pair();
        let text = opencv_stereo(&left, &right).unwrap();
        let near = |name: &str, expected: &[f64], within: f64| {
            let found = numbers(&text, name);
            assert_eq!(found.len(), expected.len(), "{name}");
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < within), "{name}: {found:?} {expected:?}");
        };
        let r1 = [0.998_982_416_7, 0.016_615_206_3, -0.041_929_297_9, -0.016_760_412_9, 0.999_854_685_4, -0.003_113_954, 0.041_871_466];
        near("R1", &[&r1[..], &[0.003_813_537_6, 0.999_115_727_7]].concat(), 1e-9);
        let r2 = [0.985_033_173_67, 0.035_936_624_458, 0.168_577_002_55, -0.036_522_661_331, 0.999_332_754_3, 3.760_127_458_6e-4];
        near("R2", &[&r2[..], &[-0.168_451_007_65, -0.006_527_265_800_9, 0.985_688_415_69]].concat(), 1e-9);
        // Its principal point is 0.04 px off where corners are brought back in five iterations, as `stereoRectify` does; this is of a thousand.
        let p1 = [1_065.356_533_4, 0.0, 528.496_044_61, 0.0, 0.0, 1_065.356_533_4, 483.467_858_01, 0.0, 0.0, 0.0, 1.0, 0.0];
        near("P1", &p1, 1e-3);
        let mut p2 = p1;
        p2[3] = -255.993_876_01;
        near("P2", &p2, 1e-3);
        let q =
            [1.0, 0.0, 0.0, -528.496_044_61, 0.0, 1.0, 0.0, -483.467_858_01, 0.0, 0.0, 0.0, 1_065.356_533_4, 0.0, 0.0, 4.161_648_513, 0.0];
        near("Q", &q, 1e-3);
        // A point that both see lies on the line that F makes of the other.
        let f = Matrix3::from_row_slice(&numbers(&text, "F"));
        let [a, b] = [numbers(&text, "K1"), numbers(&text, "K2")].map(|k| Matrix3::from_row_slice(&k));
        let point = Vector3::new(0.1, 0.05, 0.8);
        let other = of_rows(&right.pose.unwrap()) * point + Vector3::from(right.pose.unwrap().t());
        assert!(((b * other / other.z).transpose() * f * (a * point / point.z))[0].abs() < 1e-9);
    }

    #[test]
    fn a_stereo_file_comes_back_with_its_pose() {
        let [left, right] = pair();
        let text = opencv_stereo(&left, &right).unwrap();
        let read = parse_camera("stereo.yml", text.as_bytes(), &ReadOptions::default()).unwrap().cameras;
        assert_eq!((read.len(), read[0].camera, read[1].camera), (2, left.camera, right.camera));
        let (pose, own) = (read[1].pose.unwrap(), right.pose.unwrap());
        assert!(pose.position.iter().zip(own.position).all(|(a, b)| (a - b).abs() < 1e-9) && read[1].pose_frame == PoseFrame::FirstCamera);
        let alone = NamedCamera { pose: None, ..right };
        assert!(opencv_stereo(&left, &alone).is_err() && colmap_rig(&[left, alone]).is_err());
    }

    #[test]
    fn colmaps_rotation_is_a_quaternion_with_w_first() {
        let text = colmap_rig(&pair()).unwrap();
        let numbers = |key: &str| -> Vec<f64> {
            let inside = text.split(&format!("\"{key}\": [")).nth(1).unwrap().split(']').next().unwrap();
            inside.split(", ").map(|number| number.parse().unwrap()).collect()
        };
        let (q, t) = (numbers("cam_from_rig_rotation"), numbers("cam_from_rig_translation"));
        let turn = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]));
        assert!(
            (turn.to_rotation_matrix().matrix() - of_rows(&pair()[1].pose.unwrap())).amax() < 1e-9 && (t[0] + 0.236_693_024_6).abs() < 1e-9
        );
        assert!(text.contains("\"image_prefix\": \"left/\", \"ref_sensor\": true"), "{text}");
    }
}
