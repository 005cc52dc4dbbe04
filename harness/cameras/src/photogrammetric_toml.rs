//! Our own camera file as it stands in TOML.

use calibench_model::camera::{Camera, Ebner, ImageSize, Photogrammetric};
use serde::{Deserialize, Serialize};

/// What is read before all else: a later version may hold other keys.
#[derive(Deserialize)]
pub(super) struct Head {
    pub version: u32,
}

/// The models that the file can hold.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Model {
    Photogrammetric,
    Ebner,
}

/// A whole file.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Wire {
    pub format: String,
    pub version: u32,
    pub model: Model,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    pub image: Image,
    pub interior_orientation: Orientation,
    #[serde(default)]
    pub distortion: Distortion,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ebner: Option<Twelve>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub covariance: Option<CovarianceRows>,
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Image {
    pub width_px: u32,
    pub height_px: u32,
    pub pitch_um: f64,
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
#[expect(clippy::struct_field_names, reason = "a key says its unit")]
pub(super) struct Orientation {
    pub c_mm: f64,
    pub x0_mm: f64,
    pub y0_mm: f64,
}

/// Terms that are not there are zero.
#[derive(Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Distortion {
    pub k1_per_mm2: f64,
    pub k2_per_mm4: f64,
    pub k3_per_mm6: f64,
    pub p1_per_mm: f64,
    pub p2_per_mm: f64,
    pub b1: f64,
    pub b2: f64,
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Twelve {
    pub spacing_mm: f64,
    pub b1: f64,
    pub b2: f64,
    pub b3_per_mm: f64,
    pub b4_per_mm: f64,
    pub b5_per_mm: f64,
    pub b6_per_mm: f64,
    pub b7_per_mm2: f64,
    pub b8_per_mm2: f64,
    pub b9_per_mm2: f64,
    pub b10_per_mm2: f64,
    pub b11_per_mm3: f64,
    pub b12_per_mm3: f64,
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CovarianceRows {
    pub parameters: Vec<String>,
    pub rows: Vec<Vec<f64>>,
}

impl Wire {
    /// The camera; `None` if the model and its tables do not belong together.
    pub fn camera(&self) -> Option<Camera> {
        let Image { width_px, height_px, pitch_um } = self.image;
        let Orientation { c_mm: c, x0_mm: x0, y0_mm: y0 } = self.interior_orientation;
        let d = &self.distortion;
        let (k, p, b) = ([d.k1_per_mm2, d.k2_per_mm4, d.k3_per_mm6], [d.p1_per_mm, d.p2_per_mm], [d.b1, d.b2]);
        let base = Photogrammetric { size: ImageSize { width: width_px, height: height_px }, pitch_um, c, x0, y0, k, p, b };
        match (self.model, &self.ebner) {
            (Model::Photogrammetric, None) => Some(Camera::Photogrammetric(base)),
            (Model::Ebner, Some(twelve)) => Some(Camera::Ebner(Ebner { base, b_mm: twelve.spacing_mm, parameters: twelve.parameters() })),
            _ => None,
        }
    }

    /// The tables of a camera.
    pub fn new(format: &str, version: u32, base: &Photogrammetric, ebner: Option<&Ebner>) -> Self {
        let ([k1_per_mm2, k2_per_mm4, k3_per_mm6], [p1_per_mm, p2_per_mm], [b1, b2]) = (base.k, base.p, base.b);
        Self {
            format: format.to_owned(),
            version,
            model: if ebner.is_some() { Model::Ebner } else { Model::Photogrammetric },
            name: None,
            image: Image { width_px: base.size.width, height_px: base.size.height, pitch_um: base.pitch_um },
            interior_orientation: Orientation { c_mm: base.c, x0_mm: base.x0, y0_mm: base.y0 },
            distortion: Distortion { k1_per_mm2, k2_per_mm4, k3_per_mm6, p1_per_mm, p2_per_mm, b1, b2 },
            ebner: ebner.map(Twelve::new),
            covariance: None,
        }
    }
}

impl Twelve {
    fn new(camera: &Ebner) -> Self {
        let [b1, b2, b3_per_mm, b4_per_mm, b5_per_mm, b6_per_mm, b7_per_mm2, b8_per_mm2, b9_per_mm2, b10_per_mm2, b11_per_mm3, b12_per_mm3] =
            camera.parameters;
        let spacing_mm = camera.b_mm;
        Self {
            spacing_mm,
            b1,
            b2,
            b3_per_mm,
            b4_per_mm,
            b5_per_mm,
            b6_per_mm,
            b7_per_mm2,
            b8_per_mm2,
            b9_per_mm2,
            b10_per_mm2,
            b11_per_mm3,
            b12_per_mm3,
        }
    }

    fn parameters(&self) -> [f64; 12] {
        let Self { b1, b2, b3_per_mm, b4_per_mm, b5_per_mm, b6_per_mm, b7_per_mm2, b8_per_mm2, b9_per_mm2, b10_per_mm2, .. } = *self;
        let Self { b11_per_mm3, b12_per_mm3, .. } = *self;
        [b1, b2, b3_per_mm, b4_per_mm, b5_per_mm, b6_per_mm, b7_per_mm2, b8_per_mm2, b9_per_mm2, b10_per_mm2, b11_per_mm3, b12_per_mm3]
    }
}
