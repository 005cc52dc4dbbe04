//! What is done to a camera on its way to where it is applied.

use calibench_model::camera::{Agisoft, Camera, CameraModel, OpenCv, Photogrammetric, Pix4d, Ray};
use calibench_model::convert::{Tangential, naive};
use calibench_model::{Frame, SensorPoint};
use calibench_scenario::studies::transfer::Conditions;

/// Why a camera of another model is not changed.
const OTHER_MODEL: &str = "the camera's model is none whose focus, pitch or principal point is changed here";

/// Principal distance and principal point (x0, y0; y up) of any camera through `pitch_um`, mm, and the frame's middle as origin.
///
/// # Errors
/// In words: a camera that does not picture its own axis.
pub fn interior(camera: &Camera, pitch_um: f64) -> Result<[f64; 3], String> {
    let on_axis = camera.derivatives(Ray::from_tangent(0.0, 0.0)).map_err(|error| error.to_string())?;
    let size = camera.size();
    let frame = Frame::new(size.width, size.height, pitch_um).map_err(|error| error.to_string())?;
    let SensorPoint { x, y } = frame.to_sensor(on_axis.point);
    let [u, v] = on_axis.by_ray;
    Ok([(u[0] * v[1] - u[1] * v[0]).abs().sqrt() * pitch_um * 1e-3, x, y])
}

/// The camera with its image enlarged `factor` times about its principal point: another principal distance, and the same distortion of the same rays.
///
/// # Errors
/// In words: another model than Metashape's, OpenCV's, Pix4D's or the photogrammetric one.
pub fn enlarged(camera: &Camera, factor: f64) -> Result<Camera, String> {
    Ok(match *camera {
        Camera::Agisoft(c) => Agisoft { f: c.f * factor, b1: c.b1 * factor, b2: c.b2 * factor, ..c }.into(),
        Camera::OpenCv(c) => OpenCv { fx: c.fx * factor, fy: c.fy * factor, ..c }.into(),
        Camera::Pix4d(c) => Pix4d { f_px: c.f_px * factor, ..c }.into(),
        Camera::Photogrammetric(c) => {
            let k = [c.k[0] / factor.powi(2), c.k[1] / factor.powi(4), c.k[2] / factor.powi(6)];
            Photogrammetric { c: c.c * factor, k, p: c.p.map(|p| p / factor), ..c }.into()
        }
        _ => return Err(OTHER_MODEL.into()),
    })
}

/// The camera with its principal point moved by `by`, mm to the right and upwards, through `pitch_um`.
///
/// # Errors
/// As of [`enlarged`].
pub fn moved(camera: &Camera, [x, y]: [f64; 2], pitch_um: f64) -> Result<Camera, String> {
    let (right, down) = (x * 1e3 / pitch_um, -y * 1e3 / pitch_um);
    Ok(match *camera {
        Camera::Agisoft(c) => Agisoft { cx: c.cx + right, cy: c.cy + down, ..c }.into(),
        Camera::OpenCv(c) => OpenCv { cx: c.cx + right, cy: c.cy + down, ..c }.into(),
        Camera::Pix4d(c) => Pix4d { px: c.px + right, py: c.py + down, ..c }.into(),
        Camera::Photogrammetric(c) => Photogrammetric { x0: c.x0 + x, y0: c.y0 + y, ..c }.into(),
        _ => return Err(OTHER_MODEL.into()),
    })
}

/// The camera refocused: its principal distance longer by `mm`.
///
/// # Errors
/// As of [`enlarged`] and [`interior`].
pub fn refocused(camera: &Camera, mm: f64, pitch_um: f64) -> Result<Camera, String> {
    let [c, ..] = interior(camera, pitch_um)?;
    if mm == 0.0 { Ok(*camera) } else { enlarged(camera, 1.0 + mm / c) }
}

/// What is applied of a calibrated camera: in mm through a wrong pitch, converted, with another principal point, as `conditions` say.
///
/// # Errors
/// As of [`enlarged`]; a model that the naive conversion does not hold for.
pub fn applied(calibrated: &Camera, conditions: &Conditions, pitch_um: f64) -> Result<Camera, String> {
    let mut camera = *calibrated;
    if let Some(wrong) = conditions.pitch_um {
        let (factor, [_, x0, y0]) = (wrong / pitch_um, interior(&camera, pitch_um)?);
        camera = moved(&enlarged(&camera, factor)?, [(factor - 1.0) * x0, (factor - 1.0) * y0], pitch_um)?;
    }
    if conditions.naive && !matches!(camera, Camera::Photogrammetric(_)) {
        camera = naive(&camera, pitch_um, Tangential::Converted).map_err(|error| error.to_string())?.into();
    }
    if conditions.principal_point == [0.0; 2] { Ok(camera) } else { moved(&camera, conditions.principal_point, pitch_um) }
}

#[cfg(test)]
mod tests {
    use calibench_model::PixelPoint;
    use calibench_model::camera::ImageSize;
    use calibench_model::convert::Mistake;
    use calibench_scenario::studies::transfer::Model;

    use super::*;

    const SIZE: ImageSize = ImageSize { width: 4272, height: 2848 };
    const PITCH: f64 = 5.38;

    fn cameras() -> Vec<Camera> {
        let models = [Model::Metashape, Model::Pix4d, Model::Opencv, Model::Photogrammetric];
        let distorted = |model: Model| {
            let start = model.start(SIZE, PITCH, 19.0).unwrap();
            let values = start.parameters();
            let value = |name: &str, value: f64| match name {
                "k1" | "R1" => -1e-4 * if model == Model::Photogrammetric { 1.0 } else { 361.0 },
                "p1" | "T1" => 1e-4,
                _ => value,
            };
            let values: Vec<f64> = values.iter().map(|p| value(p.name, p.value)).collect();
            moved(&start.with_parameters(&values), [-0.05, 0.13], PITCH).unwrap()
        };
        models.into_iter().map(distorted).collect()
    }

    fn close(a: PixelPoint, b: PixelPoint) {
        assert!(a.distance(b) < 1e-6, "{a:?} {b:?}");
    }

    #[test]
    fn the_interior_orientation_is_that_of_every_model() {
        for camera in cameras() {
            let [c, x0, y0] = interior(&camera, PITCH).unwrap();
            assert!((c - 19.0).abs() < 1e-9 && (x0 + 0.05).abs() < 1e-9 && (y0 - 0.13).abs() < 1e-9, "{camera:?}");
        }
    }

    /// The image of every ray goes away from that of the axis by the same factor.
    #[test]
    fn a_refocused_camera_is_enlarged_about_its_principal_point() {
        for camera in cameras() {
            let changed = refocused(&camera, 0.5, PITCH).unwrap();
            let axis = camera.project(Ray::from_tangent(0.0, 0.0)).unwrap();
            for (x, y) in [(0.3, 0.1), (-0.2, 0.25), (0.0, -0.3)] {
                let ray = Ray::from_tangent(x, y);
                let [before, after] = [&camera, &changed].map(|camera| camera.project(ray).unwrap());
                let factor = 19.5 / 19.0;
                close(after, PixelPoint::new(axis.x + factor * (before.x - axis.x), axis.y + factor * (before.y - axis.y)));
            }
            assert_eq!(refocused(&camera, 0.0, PITCH).unwrap(), camera);
        }
    }

    /// All of a camera through a wrong pitch is what `convert` calls that mistake.
    #[test]
    fn a_wrong_pitch_is_the_known_mistake() {
        let conditions = Conditions { pitch_um: Some(5.15), ..Conditions::none() };
        for camera in cameras() {
            let found = applied(&camera, &conditions, PITCH).unwrap();
            let [c, x0, y0] = interior(&found, PITCH).unwrap();
            let factor = 5.15 / PITCH;
            assert!((c - 19.0 * factor).abs() < 1e-9 && (x0 + 0.05 * factor).abs() < 1e-9 && (y0 - 0.13 * factor).abs() < 1e-9);
            if let Camera::Photogrammetric(right) = camera {
                let wrong: Camera = Mistake::WrongPitch { pitch_um: 5.15 }.of(&right).unwrap().into();
                for (a, b) in found.parameters().iter().zip(wrong.parameters()) {
                    assert!((a.value - b.value).abs() < 1e-9 * b.value.abs().max(1.0), "{}: {} {}", a.name, a.value, b.value);
                }
            }
        }
    }

    #[test]
    fn a_naive_conversion_makes_a_photogrammetric_camera_and_leaves_one_alone() {
        let conditions = Conditions { naive: true, principal_point: [0.0, -0.5], ..Conditions::none() };
        for camera in cameras() {
            let found = applied(&camera, &conditions, PITCH).unwrap();
            let Camera::Photogrammetric(found) = found else { panic!("{found:?}") };
            assert!((found.y0 + 0.37).abs() < 1e-9 && (found.c - 19.0).abs() < 1e-9, "{found:?}");
            assert!((found.k[0] + 1e-4).abs() < 1e-12, "{found:?}");
        }
    }
}
