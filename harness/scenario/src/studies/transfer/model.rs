//! The camera models of calibration methods, and where their parameters start.

use calibench_model::camera::{Agisoft, AgisoftVersion, Camera, ImageSize, OpenCv, Photogrammetric, Pix4d, TangentialOrder};
use calibench_model::{Frame, SensorPoint};
use schemars::JsonSchema;
use serde::Deserialize;

/// A camera model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Model {
    /// Metashape's: f, cx, cy, b1, b2, k1 to k4, p1 to p4.
    Metashape,
    /// Pix4D's: F, Px, Py, R1 to R3, T1, T2.
    Pix4d,
    /// OpenCV's with five coefficients: fx, fy, cx, cy, k1, k2, p1, p2, k3.
    Opencv,
    /// The canonical one, a correction of measured coordinates: c, x0, y0, k1 to k3, p1, p2, b1, b2.
    Photogrammetric,
}

impl Model {
    /// The camera of a data sheet: principal distance `c` (mm) through `pitch_um` (um), principal point in the middle of the frame, no distortion.
    ///
    /// `None` for a frame without size or pitch.
    pub fn start(self, size: ImageSize, pitch_um: f64, c: f64) -> Option<Camera> {
        let middle = Frame::new(size.width, size.height, pitch_um).ok()?.to_pixel(SensorPoint { x: 0.0, y: 0.0 });
        let (corner, f) = (middle.to_corner(), c * 1e3 / pitch_um);
        Some(match self {
            Self::Metashape => {
                let version = AgisoftVersion::Metashape;
                Agisoft { size, version, f, cx: 0.0, cy: 0.0, b1: 0.0, b2: 0.0, k: [0.0; 4], p: [0.0; 4] }.into()
            }
            Self::Pix4d => {
                let (sensor_width_mm, order) = (f64::from(size.width) * pitch_um * 1e-3, TangentialOrder::OpenCv);
                Pix4d { size, sensor_width_mm, f_px: f, px: corner.x, py: corner.y, r: [0.0; 3], t: [0.0; 2], order }.into()
            }
            Self::Opencv => OpenCv { size, fx: f, fy: f, cx: middle.x, cy: middle.y, distortion: [0.0; 14], coefficients: 5 }.into(),
            Self::Photogrammetric => Photogrammetric { size, pitch_um, c, x0: 0.0, y0: 0.0, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2] }.into(),
        })
    }

    /// Principal distance and point, three radial and two decentring coefficients.
    pub const fn full(self) -> &'static [&'static str] {
        match self {
            Self::Metashape => &["f", "cx", "cy", "k1", "k2", "k3", "p1", "p2"],
            Self::Pix4d => &["F", "Px", "Py", "R1", "R2", "R3", "T1", "T2"],
            Self::Opencv => &["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"],
            Self::Photogrammetric => &["c", "x0", "y0", "k1", "k2", "k3", "p1", "p2"],
        }
    }
}

#[cfg(test)]
mod tests {
    use calibench_model::camera::{CameraModel, Ray};

    use super::*;

    #[test]
    fn all_start_as_one_camera_and_have_the_parameters_of_the_full_set() {
        let size = ImageSize { width: 4272, height: 2848 };
        for model in [Model::Metashape, Model::Pix4d, Model::Opencv, Model::Photogrammetric] {
            let camera = model.start(size, 5.0, 18.0).unwrap();
            let seen = camera.project(Ray::from_tangent(0.1, -0.2)).unwrap();
            assert!((seen.x - 2495.5).abs() < 1e-9 && (seen.y - 2143.5).abs() < 1e-9, "{model:?}: {seen:?}");
            let known = camera.parameters();
            assert!(model.full().iter().all(|name| known.iter().any(|parameter| parameter.name == *name)), "{model:?}");
        }
        assert!(Model::Opencv.start(size, 0.0, 18.0).is_none());
    }
}
