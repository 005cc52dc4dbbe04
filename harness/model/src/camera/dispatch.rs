//! All models behind one dispatch.

use serde::{Deserialize, Serialize};

use super::{
    Agisoft, AgisoftFisheye, CameraModel, CameraParameter, Convention, DerivativeBuffer, DoubleSphere, Ebner, Eucm, Fov, ImageSize, MicMac,
    NoCounterpart, Ocam, Omni, OpenCv, OpenCvFisheye, Photogrammetric, Pix4d, PrismFisheye, PtLens, RadTanPrismFisheye, Ray, Reframe,
    Resampling, SixPrismFisheye, Slopes, Turn, agisoft, agisoft_fisheye, double_sphere, ebner, eucm, fov, micmac, moniwa, ocam, omni,
    opencv, opencv_fisheye, photogrammetric, pix4d, prism_fisheye, pt_lens, rad_tan_prism_fisheye, six_prism_fisheye, tool_conventions,
};
use crate::PixelPoint;

/// Any camera. A new model is a variant here, a line in each of the two tables below, and its own file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Camera {
    /// The canonical interior orientation.
    Photogrammetric(Photogrammetric),
    /// With Ebner's additional parameters.
    Ebner(Ebner),
    /// OpenCV's pinhole camera.
    OpenCv(OpenCv),
    /// OpenCV's fisheye camera.
    OpenCvFisheye(OpenCvFisheye),
    /// Agisoft's.
    Agisoft(Agisoft),
    /// Metashape's fisheye.
    AgisoftFisheye(AgisoftFisheye),
    /// Pix4D's.
    Pix4d(Pix4d),
    /// Double sphere.
    DoubleSphere(DoubleSphere),
    /// Enhanced unified.
    Eucm(Eucm),
    /// Mei's unified camera with distortion.
    Omni(Omni),
    /// Field of view.
    Fov(Fov),
    /// Fisheye with decentring and thin prism.
    PrismFisheye(PrismFisheye),
    /// Fisheye, then decentring and thin prism.
    RadTanPrismFisheye(RadTanPrismFisheye),
    /// MicMac's.
    MicMac(MicMac),
    /// PanoTools'.
    PtLens(PtLens),
    /// Fisheye with six radial coefficients, decentring and thin prism.
    SixPrismFisheye(SixPrismFisheye),
    /// Scaramuzza's omnidirectional camera.
    Ocam(Ocam),
}

macro_rules! each {
    ($camera:expr, $model:ident => $work:expr) => {
        match $camera {
            Camera::Photogrammetric($model) => $work,
            Camera::Ebner($model) => $work,
            Camera::OpenCv($model) => $work,
            Camera::OpenCvFisheye($model) => $work,
            Camera::Agisoft($model) => $work,
            Camera::AgisoftFisheye($model) => $work,
            Camera::Pix4d($model) => $work,
            Camera::DoubleSphere($model) => $work,
            Camera::Eucm($model) => $work,
            Camera::Omni($model) => $work,
            Camera::Fov($model) => $work,
            Camera::PrismFisheye($model) => $work,
            Camera::RadTanPrismFisheye($model) => $work,
            Camera::MicMac($model) => $work,
            Camera::PtLens($model) => $work,
            Camera::SixPrismFisheye($model) => $work,
            Camera::Ocam($model) => $work,
        }
    };
}

/// All conventions, in the order of lists.
pub const fn conventions() -> &'static [&'static Convention] {
    &[
        &photogrammetric::CONVENTION,
        &moniwa::CONVENTION,
        &ebner::CONVENTION,
        &pix4d::CONVENTION,
        &agisoft::METASHAPE,
        &agisoft_fisheye::CONVENTION,
        &agisoft::PHOTOSCAN,
        &agisoft::LENS,
        &opencv::CONVENTION,
        &opencv_fisheye::CONVENTION,
        &prism_fisheye::CONVENTION,
        &rad_tan_prism_fisheye::CONVENTION,
        &double_sphere::CONVENTION,
        &eucm::CONVENTION,
        &omni::CONVENTION,
        &fov::CONVENTION,
        &micmac::CONVENTION,
        &pt_lens::CONVENTION,
        &six_prism_fisheye::CONVENTION,
        &ocam::CONVENTION,
        &tool_conventions::COLMAP,
        &tool_conventions::KAPTURE,
        &tool_conventions::ROS,
        &tool_conventions::KALIBR,
        &tool_conventions::MRCAL,
        &tool_conventions::OPENSFM,
        &tool_conventions::NERFSTUDIO,
        &tool_conventions::BASALT,
        &tool_conventions::CAMODOCAL,
        &tool_conventions::OPENMVG,
        &tool_conventions::THEIA,
        &tool_conventions::BUNDLER,
        &tool_conventions::REALITY_CAPTURE,
        &tool_conventions::BENTLEY,
        &tool_conventions::PHOTOMODELER,
        &tool_conventions::CALTECH,
        &tool_conventions::GYROFLOW,
        &tool_conventions::MATLAB,
        &tool_conventions::USD,
        &tool_conventions::NVM,
        &tool_conventions::DJI,
        &tool_conventions::CAHVOR,
        &tool_conventions::QUALISYS,
    ]
}

impl Camera {
    /// What its numbers mean.
    pub const fn convention(&self) -> &'static Convention {
        match self {
            Self::Photogrammetric(_) => &photogrammetric::CONVENTION,
            Self::Ebner(_) => &ebner::CONVENTION,
            Self::OpenCv(_) => &opencv::CONVENTION,
            Self::OpenCvFisheye(_) => &opencv_fisheye::CONVENTION,
            Self::Agisoft(camera) => camera.version.convention(),
            Self::AgisoftFisheye(_) => &agisoft_fisheye::CONVENTION,
            Self::Pix4d(_) => &pix4d::CONVENTION,
            Self::DoubleSphere(_) => &double_sphere::CONVENTION,
            Self::Eucm(_) => &eucm::CONVENTION,
            Self::Omni(_) => &omni::CONVENTION,
            Self::Fov(_) => &fov::CONVENTION,
            Self::PrismFisheye(_) => &prism_fisheye::CONVENTION,
            Self::RadTanPrismFisheye(_) => &rad_tan_prism_fisheye::CONVENTION,
            Self::MicMac(_) => &micmac::CONVENTION,
            Self::PtLens(_) => &pt_lens::CONVENTION,
            Self::SixPrismFisheye(_) => &six_prism_fisheye::CONVENTION,
            Self::Ocam(_) => &ocam::CONVENTION,
        }
    }
}

impl CameraModel for Camera {
    fn size(&self) -> ImageSize {
        each!(self, camera => camera.size())
    }

    fn parameters(&self) -> Vec<CameraParameter> {
        each!(self, camera => camera.parameters())
    }

    fn with_parameters(&self, values: &[f64]) -> Self {
        each!(self, camera => camera.with_parameters(values).into())
    }

    fn project(&self, ray: Ray) -> Result<PixelPoint, NoCounterpart> {
        each!(self, camera => camera.project(ray))
    }

    fn project_near(&self, ray: Ray, near: PixelPoint) -> Result<PixelPoint, NoCounterpart> {
        each!(self, camera => camera.project_near(ray, near))
    }

    fn unproject(&self, point: PixelPoint) -> Result<Ray, NoCounterpart> {
        each!(self, camera => camera.unproject(point))
    }

    fn derivatives_into(&self, ray: Ray, into: &mut DerivativeBuffer) -> Result<(), NoCounterpart> {
        each!(self, camera => camera.derivatives_into(ray, into))
    }

    fn slopes(&self, ray: Ray) -> Result<Slopes, NoCounterpart> {
        each!(self, camera => camera.slopes(ray))
    }

    fn fold_towards(&self, angle: f64) -> Option<PixelPoint> {
        each!(self, camera => camera.fold_towards(angle))
    }

    fn has_surely_no_fold(&self) -> bool {
        each!(self, camera => camera.has_surely_no_fold())
    }
}

impl Reframe for Camera {
    fn has_two_scales(&self) -> bool {
        each!(self, camera => camera.has_two_scales())
    }

    fn resampled(&self, by: &Resampling) -> Self {
        each!(self, camera => camera.resampled(by).into())
    }

    fn without_place(&self, turn: Turn) -> Option<&'static str> {
        each!(self, camera => camera.without_place(turn))
    }

    fn turned(&self, turn: Turn) -> Self {
        each!(self, camera => camera.turned(turn).into())
    }
}

macro_rules! from {
    ($($model:ident),*) => {
        $(impl From<$model> for Camera {
            fn from(camera: $model) -> Self {
                Self::$model(camera)
            }
        })*
    };
}

from!(
    Photogrammetric,
    Ebner,
    OpenCv,
    OpenCvFisheye,
    Agisoft,
    AgisoftFisheye,
    Pix4d,
    DoubleSphere,
    Eucm,
    Omni,
    Fov,
    PrismFisheye,
    RadTanPrismFisheye,
    MicMac,
    PtLens,
    SixPrismFisheye,
    Ocam
);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::conformance::{self, Shape};

    #[test]
    fn a_dispatched_camera_conforms() {
        let mut distortion = [0.0; 14];
        distortion[0] = 0.1;
        let size = ImageSize { width: 640, height: 480 };
        let camera = OpenCv { size, fx: 600.0, fy: 600.0, cx: 320.0, cy: 240.0, distortion, coefficients: 5 };
        conformance::check(&Camera::from(camera), Shape::Pincushion);
    }

    #[test]
    fn names_of_conventions_are_unique() {
        let mut names: Vec<_> = conventions().iter().map(|convention| convention.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), conventions().len());
    }
}
