//! Cameras: how rays and pixels belong together, in the conventions of several tools.
//!
//! Each model is data behind one trait, [`CameraModel`]; each convention states its direction, its signs, its units and its pixel origin in its
//! own file, and converts to [`Ray`] and [`PixelPoint`] there and nowhere else.

pub mod agisoft;
pub mod convention;
pub mod ebner;
mod newton;
pub mod opencv;
pub mod opencv_fisheye;
pub mod photogrammetric;
pub mod pix4d;
mod ray;

use thiserror::Error;

use crate::PixelPoint;

pub use agisoft::{Agisoft, AgisoftVersion};
pub use convention::{Convention, Direction, PixelOrigin, TangentialOrder, Verification, Vertical};
pub use ebner::Ebner;
pub use opencv::OpenCv;
pub use opencv_fisheye::OpenCvFisheye;
pub use photogrammetric::Photogrammetric;
pub use pix4d::Pix4d;
pub use ray::Ray;

/// Columns and rows of a camera's images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    /// Its value.
    pub value: f64,
}

/// A projection with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivatives {
    /// The projected point.
    pub point: PixelPoint,
    /// d(x, y) / d(ray), px per unit of the ray's components: rows x, y.
    pub by_ray: [[f64; 3]; 2],
    /// d(x, y) / d(parameter), in the order of [`CameraModel::parameters`].
    pub by_parameters: Vec<[f64; 2]>,
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

/// Any camera: the models behind one dispatch.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// Pix4D's.
    Pix4d(Pix4d),
}

/// A camera model. One conformance check serves all: derivatives against differences, round trips, corner values.
pub trait CameraModel {
    /// The size of its images.
    fn size(&self) -> ImageSize;

    /// Its parameters, in a fixed order.
    fn parameters(&self) -> Vec<CameraParameter>;

    /// The same camera with other values, in the order of [`Self::parameters`].
    #[must_use]
    fn with_parameters(&self, values: &[f64]) -> Self
    where
        Self: Sized;

    /// Ray to pixel.
    ///
    /// # Errors
    /// A ray that the model does not picture.
    fn project(&self, ray: Ray) -> Result<PixelPoint, NoCounterpart>;

    /// Pixel to ray, to 1e-9 px or better.
    ///
    /// # Errors
    /// A pixel that no ray comes to on the branch of the mapping that holds the principal point.
    fn unproject(&self, point: PixelPoint) -> Result<Ray, NoCounterpart>;

    /// [`Self::project`] with its analytic derivatives.
    ///
    /// # Errors
    /// As [`Self::project`].
    fn derivatives(&self, ray: Ray) -> Result<Derivatives, NoCounterpart>;
}
