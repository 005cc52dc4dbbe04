//! What a camera is converted to.

use super::ConvertError;
use super::brown::BrownForm;
use crate::camera::{
    Agisoft, AgisoftFisheye, AgisoftVersion, Camera, CameraModel, DoubleSphere, Ebner, Eucm, FisheyeProjection, Fov, ImageSize,
    LensProjection, MicMac, Ocam, Omni, OpenCv, OpenCvFisheye, Photogrammetric, Pix4d, PrismFisheye, PtLens, RadTanPrismFisheye,
    SixPrismFisheye, TangentialOrder,
};

/// A convention with its shape. Terms that the shape leaves out are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// The canonical interior orientation.
    Photogrammetric {
        /// Pixel pitch, um.
        pitch_um: f64,
        /// Radial coefficients: 0 to 3.
        radial: usize,
        /// Holds p1 and p2.
        tangential: bool,
        /// Holds b1 and b2.
        affinity: bool,
    },
    /// Ebner's twelve parameters around c, x0, y0, without other distortion.
    Ebner {
        /// Pixel pitch, um.
        pitch_um: f64,
        /// Spacing of the grid, mm.
        b_mm: f64,
    },
    /// OpenCV's pinhole camera.
    OpenCv {
        /// 4, 5, 8, 12 or 14.
        coefficients: usize,
    },
    /// OpenCV's fisheye camera, without skew.
    OpenCvFisheye,
    /// Agisoft's frame camera.
    Agisoft {
        /// Whose formulas hold.
        version: AgisoftVersion,
        /// Radial coefficients: 0 to 4; 3 at most for the older versions.
        radial: usize,
        /// Decentring coefficients: 0, 2, 3 or 4; 2 at most for the older versions.
        tangential: usize,
        /// Holds b1 and b2.
        affinity: bool,
    },
    /// Pix4D's perspective camera.
    Pix4d {
        /// Width of the sensor, mm.
        sensor_width_mm: f64,
        /// Order of T1 and T2.
        order: TangentialOrder,
    },
    /// One focal length, the principal point in the middle of the frame, radial coefficients: what Bundler holds, as Metashape's camera.
    Centred {
        /// Radial coefficients: 0 to 4.
        radial: usize,
    },
    /// Double sphere.
    DoubleSphere,
    /// Enhanced unified.
    Eucm,
    /// The division model, as an enhanced unified camera with alpha 1/2.
    Division,
    /// Mei's unified camera.
    Omni {
        /// Holds k1, k2, p1, p2.
        distortion: bool,
    },
    /// Field of view.
    Fov,
    /// Fisheye with decentring and thin prism.
    PrismFisheye,
    /// Fisheye, then decentring and thin prism.
    RadTanPrismFisheye,
    /// Fisheye with six radial coefficients, decentring and thin prism.
    SixPrismFisheye {
        /// Holds s0 to s3.
        prism: bool,
    },
    /// PanoTools' a, b, c.
    PtLens {
        /// How the lens pictures angles.
        projection: LensProjection,
    },
    /// Scaramuzza's omnidirectional camera, without a1.
    Ocam {
        /// Degree of the polynomial: 2 to 6.
        degree: usize,
    },
    /// Metashape's fisheye.
    MetashapeFisheye {
        /// How it pictures angles.
        projection: FisheyeProjection,
    },
    /// MicMac's.
    MicMac {
        /// Radial coefficients: 0 to 5.
        radial: usize,
        /// Holds P1 and P2.
        tangential: bool,
        /// Holds b1 and b2, and a centre of the distortion that is not the principal point.
        affinity: bool,
    },
}

impl Target {
    /// The canonical orientation with all its terms, for a pitch in um.
    pub const fn photogrammetric(pitch_um: f64) -> Self {
        Self::Photogrammetric { pitch_um, radial: 3, tangential: true, affinity: true }
    }

    /// Metashape with k1 to k3, p1, p2, b1, b2.
    pub const fn metashape() -> Self {
        Self::Agisoft { version: AgisoftVersion::Metashape, radial: 3, tangential: 2, affinity: true }
    }

    /// Whether a formula leads from `camera` to this convention, with nothing left out.
    pub fn is_exact_for(&self, camera: &Camera) -> bool {
        self.check().is_ok() && super::closed_form::exact(camera, self).is_some()
    }

    pub(super) fn check(&self) -> Result<(), ConvertError> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let fault = match *self {
            Self::Photogrammetric { pitch_um, .. } | Self::Ebner { pitch_um, .. } if !positive(pitch_um) => {
                "the pixel pitch is not positive"
            }
            Self::Photogrammetric { radial: 4.., .. } => "more than three radial coefficients",
            Self::Ebner { b_mm, .. } if !positive(b_mm) => "the spacing of the grid is not positive",
            Self::OpenCv { coefficients } if ![4, 5, 8, 12, 14].contains(&coefficients) => "OpenCV has 4, 5, 8, 12 or 14 coefficients",
            Self::Agisoft { version, radial, tangential, .. }
                if radial > 4 || tangential > 4 || (version != AgisoftVersion::Metashape && (radial > 3 || tangential > 2)) =>
            {
                "more coefficients than the version has"
            }
            Self::Agisoft { tangential: 1, .. } => "p1 without p2",
            Self::Pix4d { sensor_width_mm, .. } if !positive(sensor_width_mm) => "the width of the sensor is not positive",
            Self::Pix4d { order: TangentialOrder::Without, .. } => "the order of T1 and T2 is open",
            Self::Ocam { degree: 0..2 | 7.. } => "the degree of the polynomial is 2 to 6",
            Self::Centred { radial: 5.. } | Self::MicMac { radial: 6.., .. } => "more radial coefficients than the model has",
            _ => return Ok(()),
        };
        Err(ConvertError::Target { fault })
    }

    /// The camera of this convention without distortion.
    pub(super) fn blank(&self, size: ImageSize) -> Camera {
        let photogrammetric =
            |pitch_um| Photogrammetric { size, pitch_um, c: 1.0, x0: 0.0, y0: 0.0, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2] };
        match *self {
            Self::Photogrammetric { pitch_um, .. } => photogrammetric(pitch_um).into(),
            Self::Ebner { pitch_um, b_mm } => Ebner { base: photogrammetric(pitch_um), b_mm, parameters: [0.0; 12] }.into(),
            Self::OpenCv { coefficients } => {
                OpenCv { size, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0, distortion: [0.0; 14], coefficients }.into()
            }
            Self::OpenCvFisheye => OpenCvFisheye { size, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0, skew: 0.0, k: [0.0; 4] }.into(),
            Self::Centred { .. } => {
                let version = AgisoftVersion::Metashape;
                Agisoft { size, version, f: 1.0, cx: 0.0, cy: 0.0, b1: 0.0, b2: 0.0, k: [0.0; 4], p: [0.0; 4] }.into()
            }
            Self::DoubleSphere => DoubleSphere { size, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0, xi: 0.0, alpha: 0.0 }.into(),
            Self::Eucm => Eucm { size, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0, alpha: 0.0, beta: 1.0 }.into(),
            Self::Division => Eucm { size, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0, alpha: 0.5, beta: 0.0 }.into(),
            Self::Omni { .. } => Omni { size, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0, xi: 0.0, k: [0.0; 2], p: [0.0; 2] }.into(),
            Self::Fov => Fov { size, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0, w: 0.0 }.into(),
            Self::PrismFisheye => PrismFisheye { size, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0, k: [0.0; 4], p: [0.0; 2], s: [0.0; 2] }.into(),
            Self::RadTanPrismFisheye => {
                RadTanPrismFisheye { size, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0, k: [0.0; 6], p: [0.0; 2], s: [0.0; 4] }.into()
            }
            Self::SixPrismFisheye { .. } => {
                SixPrismFisheye { size, fx: 1.0, fy: 1.0, cx: 0.0, cy: 0.0, k: [0.0; 6], p: [0.0; 2], s: [0.0; 4] }.into()
            }
            Self::PtLens { projection } => PtLens { size, projection, f: 1.0, cx: 0.0, cy: 0.0, a: 0.0, b: 0.0, c: 0.0 }.into(),
            Self::Ocam { .. } => Ocam::round(size, [0.0; 2], [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).into(),
            Self::MetashapeFisheye { projection } => {
                AgisoftFisheye { size, projection, f: 1.0, cx: 0.0, cy: 0.0, b1: 0.0, b2: 0.0, k: [0.0; 4], p: [0.0; 2] }.into()
            }
            Self::MicMac { .. } => MicMac { size, f: 1.0, pp: [0.0; 2], offset: [0.0; 2], k: [0.0; 5], p: [0.0; 2], b: [0.0; 2] }.into(),
            Self::Agisoft { version, .. } => {
                Agisoft { size, version, f: 1.0, cx: 0.0, cy: 0.0, b1: 0.0, b2: 0.0, k: [0.0; 4], p: [0.0; 4] }.into()
            }
            Self::Pix4d { sensor_width_mm, order } => {
                Pix4d { size, sensor_width_mm, f_px: 1.0, px: 0.0, py: 0.0, r: [0.0; 3], t: [0.0; 2], order }.into()
            }
        }
    }

    /// Names of the parameters that the convention has and this shape leaves out or holds.
    fn left_out(&self) -> Vec<&'static str> {
        const K: [&str; 4] = ["k1", "k2", "k3", "k4"];
        const P: [&str; 4] = ["p1", "p2", "p3", "p4"];
        const B: [&str; 2] = ["b1", "b2"];
        let affinity = |has: bool| if has { &B[2..] } else { &B[..] };
        match *self {
            Self::Photogrammetric { radial, tangential, affinity: b, .. } => {
                [&K[radial..], &P[if tangential { 2 } else { 0 }..], affinity(b)].concat()
            }
            Self::Ebner { .. } => [&K[..], &P[..], &B[..]].concat(),
            Self::Agisoft { radial, tangential, affinity: b, .. } => [&K[radial..], &P[tangential..], affinity(b)].concat(),
            Self::OpenCvFisheye => vec!["skew", "alpha"],
            Self::Ocam { degree } => {
                const A: [&str; 7] = ["a1", "a0", "a2", "a3", "a4", "a5", "a6"];
                [&A[..1], &A[degree + 1..]].concat()
            }
            Self::Division => vec!["alpha"],
            Self::Centred { radial } => [&["cx", "cy"], &K[radial..], &P[..], &B[..]].concat(),
            Self::SixPrismFisheye { prism: false } => vec!["s0", "s1", "s2", "s3"],
            Self::Omni { distortion: false } => [&K[..2], &P[..2]].concat(),
            Self::MicMac { radial, tangential, affinity: b } => {
                const FIVE: [&str; 5] = ["k1", "k2", "k3", "k4", "k5"];
                let centre = if b { &[][..] } else { &["ex", "ey"] };
                [centre, &FIVE[radial..], &P[if tangential { 2 } else { 0 }..], affinity(b)].concat()
            }
            Self::OpenCv { .. }
            | Self::Pix4d { .. }
            | Self::DoubleSphere
            | Self::Eucm
            | Self::Omni { distortion: true }
            | Self::Fov
            | Self::PrismFisheye
            | Self::RadTanPrismFisheye
            | Self::SixPrismFisheye { prism: true }
            | Self::PtLens { .. }
            | Self::MetashapeFisheye { .. } => Vec::new(),
        }
    }

    /// Indices of the parameters that a fit may change.
    pub(super) fn free(&self, camera: &Camera) -> Vec<usize> {
        let left_out = self.left_out();
        camera.parameters().iter().enumerate().filter(|(_, p)| !left_out.contains(&p.name)).map(|(i, _)| i).collect()
    }

    /// Whether every parameter that this shape leaves out is zero in `camera`.
    pub(super) fn holds(&self, camera: &Camera) -> bool {
        let left_out = self.left_out();
        camera.parameters().iter().all(|p| !left_out.contains(&p.name) || p.value == 0.0)
    }

    /// Cameras that agree with `source` on the axis and beside it: for most models one without distortion.
    pub(super) fn starts(&self, source: &dyn CameraModel) -> Result<Vec<Camera>, ConvertError> {
        let wide = super::wide_angle::starts(&BrownForm::at_axis(source)?, self);
        if wide.is_empty() { self.plain(source).map(|plain| vec![plain]) } else { Ok(wide) }
    }

    /// The camera without distortion that agrees with `source` on the axis and beside it.
    pub(super) fn plain(&self, source: &dyn CameraModel) -> Result<Camera, ConvertError> {
        let form = BrownForm::at_axis(source)?;
        form.to_target(self).or_else(|| BrownForm { b: 0.0, ..form }.to_target(self)).ok_or(ConvertError::NotConverged)
    }
}
