//! What printed figures are of, as pages tell and draw it.

use calibench_model::camera::{Camera, ImageSize, Photogrammetric};
use calibench_model::convert::{ConvertError, Tangential, Tool, from_naive};
use serde::{Deserialize, Serialize};

/// What printed figures are of. Sets are named as in the records.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Printed {
    /// The set of the sensor.
    pub sensor: String,
    /// Columns and rows of an image, px.
    pub size: [u32; 2],
    /// The pixel pitch, um.
    pub pitch_um: f64,
    /// The object unit, `mm` or `m`.
    pub unit: String,
    /// Cameras, in the order of their columns; each is a set.
    pub cameras: Vec<PrintedCamera>,
    /// Cameras through which a square grid is shown.
    pub grids: Vec<PrintedCamera>,
    /// Check points.
    pub points: Vec<CheckPoint>,
    /// The network, if one is fitted.
    pub network: Option<PlacedNetwork>,
    /// Sets of changed cameras in that network.
    pub variants: Vec<String>,
    /// Sets of changed cameras with which it is fitted again.
    pub again: Vec<String>,
}

/// A printed camera: a correction of measured coordinates, mm, y up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrintedCamera {
    /// Its name.
    pub name: String,
    /// The tool that it was converted from, if it is a tool's: a name of [`Tool`].
    pub tool: Option<String>,
    /// Principal distance, mm.
    pub c: f64,
    /// Principal point, x and y, mm.
    pub principal_point: [f64; 2],
    /// k1, k2, k3, mm^-2, mm^-4, mm^-6.
    pub k: [f64; 3],
    /// p1, p2, mm^-1.
    pub p: [f64; 2],
}

/// A check point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckPoint {
    /// Its name.
    pub name: String,
    /// X, Y, Z, object units.
    pub at: [f64; 3],
}

/// A network whose stations stand in the records.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlacedNetwork {
    /// Its set.
    pub set: String,
    /// Direction from the points to the stations, of unit length, object axes.
    pub from: [f64; 3],
}

impl Printed {
    /// A camera as printed.
    pub fn camera(&self, printed: &PrintedCamera) -> Photogrammetric {
        let [width, height] = self.size;
        let [x0, y0] = printed.principal_point;
        let size = ImageSize { width, height };
        Photogrammetric { size, pitch_um: self.pitch_um, c: printed.c, x0, y0, k: printed.k, p: printed.p, b: [0.0; 2] }
    }

    /// A camera without its distortion: the same principal distance and point.
    pub fn undistorted(&self, printed: &PrintedCamera) -> Photogrammetric {
        Photogrammetric { k: [0.0; 3], p: [0.0; 2], ..self.camera(printed) }
    }

    /// The tool's own camera, ideal to distorted, of which the direct conversion makes the printed one. `None` for one that is no tool's.
    ///
    /// # Errors
    /// A camera that is none of the tool's.
    pub fn own(&self, printed: &PrintedCamera) -> Option<Result<Camera, ConvertError>> {
        let camera = self.camera(printed);
        let tool = Tool::named(printed.tool.as_deref()?)?;
        Some(from_naive(&camera, tool.target(camera.size, camera.pitch_um), Tangential::Converted))
    }
}

impl PrintedCamera {
    /// Whether it has any distortion.
    pub fn is_distorted(&self) -> bool {
        self.k != [0.0; 3] || self.p != [0.0; 2]
    }
}

#[cfg(test)]
mod tests {
    use calibench_model::PixelPoint;
    use calibench_model::camera::CameraModel;
    use calibench_model::convert::naive;

    use super::*;

    fn printed(tool: Option<&str>) -> Printed {
        let camera = PrintedCamera {
            name: "a".into(),
            tool: tool.map(str::to_owned),
            c: 19.2,
            principal_point: [-0.04, -0.13],
            k: [-4.6e-4, 1.2e-6, -4e-10],
            p: [8.6e-5, 8.9e-5],
        };
        Printed {
            sensor: "sensor".into(),
            size: [4272, 2848],
            pitch_um: 5.38,
            unit: "m".into(),
            cameras: vec![camera],
            grids: Vec::new(),
            points: vec![CheckPoint { name: "V1".into(), at: [149_451.194, 259_275.648, 616.191] }],
            network: Some(PlacedNetwork { set: "network".into(), from: [1.0, 0.0, 0.0] }),
            variants: Vec::new(),
            again: Vec::new(),
        }
    }

    #[test]
    fn the_tools_own_camera_is_that_whose_direct_conversion_was_printed() {
        for (_, name) in Tool::ALL {
            let printed = printed(Some(name));
            let camera = printed.camera(&printed.cameras[0]);
            let back = naive(&printed.own(&printed.cameras[0]).unwrap().unwrap(), 5.38, Tangential::Converted).unwrap();
            let close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-12 * b.abs());
            assert!(close(&back.k, &camera.k) && close(&back.p, &camera.p) && (back.c - 19.2).abs() < 1e-12, "{name}: {back:?}");
        }
        let plain = printed(None);
        assert!(plain.own(&plain.cameras[0]).is_none());
    }

    #[test]
    fn what_is_written_is_read_again_to_the_last_bit() {
        let printed = printed(Some("pix4d"));
        let text = serde_json::to_string(&printed).unwrap();
        assert_eq!(serde_json::from_str::<Printed>(&text).unwrap(), printed);
    }

    /// Without distortion a ray at a tangent of 0.1 to the right is 0.1 c from the principal point, and none of the rest stays.
    #[test]
    fn without_distortion_principal_distance_and_point_stay() {
        let printed = printed(None);
        let camera = printed.undistorted(&printed.cameras[0]);
        let at = camera.project(calibench_model::camera::Ray::from_tangent(0.1, 0.0)).unwrap();
        let expected = PixelPoint::new(2135.5 + (1.92 - 0.04) / 5.38e-3, 1423.5 + 0.13 / 5.38e-3);
        assert!(at.distance(expected) < 1e-9, "{at:?} {expected:?}");
        assert!(printed.cameras[0].is_distorted());
        assert!(!PrintedCamera { k: [0.0; 3], p: [0.0; 2], ..printed.cameras[0].clone() }.is_distorted());
    }
}
