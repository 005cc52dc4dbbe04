//! Cameras: how rays and pixels belong together, in the conventions of several tools.
//!
//! Each model is data behind one trait, [`CameraModel`]; each convention states its direction, its signs, its units and its pixel origin in its
//! own file, and converts to [`Ray`] and [`PixelPoint`] there and nowhere else.

pub mod agisoft;
pub mod agisoft_fisheye;
pub mod conformance;
pub mod convention;
mod derivatives;
mod dispatch;
pub mod double_sphere;
pub mod ebner;
pub mod eucm;
pub mod fold;
pub mod fov;
mod measured_to_ideal;
pub mod micmac;
pub mod moniwa;
mod newton;
pub mod ocam;
pub mod omni;
pub mod opencv;
pub mod opencv_fisheye;
pub mod photogrammetric;
mod pinhole;
pub mod pix4d;
mod plane_map;
mod plausible;
pub mod prism_fisheye;
pub mod pt_lens;
pub mod rad_tan_prism_fisheye;
mod ray;
mod reframe;
pub mod six_prism_fisheye;
pub mod splined;
mod splined_image;
pub mod tool_conventions;
mod wide_angle;
mod without_ray;

use serde::{Deserialize, Serialize};

use thiserror::Error;

use crate::PixelPoint;

pub use agisoft::{Agisoft, AgisoftVersion};
pub use agisoft_fisheye::{AgisoftFisheye, FisheyeProjection};
pub use convention::{Convention, Direction, PixelOrigin, TangentialOrder, Verification, Vertical};
pub use derivatives::{DerivativeBuffer, Derivatives, MOST_PARAMETERS, Slopes};
pub use dispatch::{Camera, conventions};
pub use double_sphere::DoubleSphere;
pub use ebner::Ebner;
pub use eucm::Eucm;
pub use fold::{Fold, fold, fold_radius};
pub use fov::Fov;
pub use micmac::MicMac;
pub use moniwa::Moniwa;
pub use ocam::Ocam;
pub use omni::Omni;
pub use opencv::OpenCv;
pub use opencv_fisheye::OpenCvFisheye;
pub use photogrammetric::Photogrammetric;
pub use pix4d::Pix4d;
pub use plausible::{Implausible, implausible};
pub use prism_fisheye::PrismFisheye;
pub use pt_lens::{LensProjection, PtLens};
pub use rad_tan_prism_fisheye::RadTanPrismFisheye;
pub use ray::Ray;
pub use reframe::{Reframe, Resampling, Turn};
pub use six_prism_fisheye::SixPrismFisheye;
pub use splined::Splined;
pub use splined_image::SplinedImage;
pub use without_ray::without_ray;

/// Columns and rows of a camera's images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ImageSize {
    /// Columns, px.
    pub width: u32,
    /// Rows, px.
    pub height: u32,
}

/// A parameter of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraParameter {
    /// Its name in the convention.
    pub name: &'static str,
    /// Its unit, as in `mm^-2`; "" for a number.
    pub unit: &'static str,
    /// Its value, in this unit.
    pub value: f64,
}

/// Why a ray or a pixel has no counterpart.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum NoCounterpart {
    /// The ray points away from the image.
    #[error("the ray points behind the camera")]
    Behind,
    /// The model folds over before it gets there: the mapping is not one to one.
    #[error("the distortion folds over: the mapping is not one to one there")]
    Fold,
    /// A coordinate is not a number, or the iteration found no solution.
    #[error("no solution")]
    NoSolution,
}

/// A camera model. One conformance check serves all: derivatives against differences, round trips, corner values.
pub trait CameraModel {
    /// The size of its images.
    fn size(&self) -> ImageSize;

    /// Its parameters, in a fixed order.
    fn parameters(&self) -> Vec<CameraParameter>;

    /// The same camera with other values, in the order and the units of [`Self::parameters`].
    #[must_use]
    fn with_parameters(&self, values: &[f64]) -> Self
    where
        Self: Sized;

    /// Ray to pixel.
    ///
    /// # Errors
    /// A ray that the model does not picture: behind the camera, or beyond a fold.
    fn project(&self, ray: Ray) -> Result<PixelPoint, NoCounterpart>;

    /// [`Self::project`] for a ray near another one whose image is `near`: cheaper where the model is inverted by iteration, because what joins the two
    /// images is taken to be on one branch of the mapping.
    ///
    /// # Errors
    /// As [`Self::project`].
    fn project_near(&self, ray: Ray, near: PixelPoint) -> Result<PixelPoint, NoCounterpart> {
        let _ = near;
        self.project(ray)
    }

    /// Pixel to ray, to 1e-9 px or better.
    ///
    /// # Errors
    /// A pixel that no ray comes to on the branch of the mapping that holds the principal point.
    fn unproject(&self, point: PixelPoint) -> Result<Ray, NoCounterpart>;

    /// [`Self::project`] with its analytic derivatives, into memory that is used again. What `into` holds after an error means nothing.
    ///
    /// # Errors
    /// As [`Self::project`].
    fn derivatives_into(&self, ray: Ray, into: &mut DerivativeBuffer) -> Result<(), NoCounterpart>;

    /// [`Self::project`] with its analytic derivatives.
    ///
    /// # Errors
    /// As [`Self::project`].
    fn derivatives(&self, ray: Ray) -> Result<Derivatives, NoCounterpart> {
        DerivativeBuffer::owned(|buffer| self.derivatives_into(ray, buffer))
    }

    /// [`Self::project`] with its derivatives by the ray alone: of a camera that is held fixed those by its parameters are computed in vain.
    ///
    /// # Errors
    /// As [`Self::project`].
    fn slopes(&self, ray: Ray) -> Result<Slopes, NoCounterpart> {
        let mut buffer = DerivativeBuffer::default();
        self.derivatives_into(ray, &mut buffer)?;
        Ok(Slopes { point: buffer.point, by_ray: buffer.by_ray })
    }

    /// The image of the first fold on the way from the axis, where the mapping stops being one to one, inside or outside the frame; `angle` is that in
    /// the image at the axis, from x towards y, radians. See [`fold()`] for what is inside the frame.
    fn fold_towards(&self, angle: f64) -> Option<PixelPoint>;

    /// Whether there is certainly no fold inside the frame: a cheap bound that spares the search; `false` when in doubt.
    fn has_surely_no_fold(&self) -> bool {
        false
    }
}

fn named(names: &[(&'static str, &'static str)], values: &[f64]) -> Vec<CameraParameter> {
    names.iter().zip(values).map(|(&(name, unit), &value)| CameraParameter { name, unit, value }).collect()
}
