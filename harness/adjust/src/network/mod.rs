//! What is adjusted: cameras, images, object points and image coordinates, with start values and what is known of each.

mod check;
mod counts;
mod distance;
mod error;
mod layout;
mod per_image;
mod status;
mod surface;

use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{Covariance, PixelPoint, Pose};
use nalgebra::Point3;

pub use counts::Counts;
pub use distance::DistanceObservation;
pub use error::NetworkError;
pub(crate) use layout::{CameraPlace, Layout, Sight};
pub use per_image::PerImage;
pub use status::{Attitude, Centre, Status};
pub(crate) use surface::Triples;
pub use surface::{OnSurface, Surface};

/// A network of images.
#[derive(Clone, Debug, Default)]
pub struct Network {
    /// Interior orientations. Additional parameters of a group of images: a camera of its own for each group.
    pub cameras: Vec<Interior>,
    /// Images and their exterior orientations.
    pub images: Vec<Exterior>,
    /// Object points.
    pub points: Vec<ObjectPoint>,
    /// Image coordinates.
    pub observations: Vec<ImageObservation>,
    /// Observed distances between object points; none as a rule.
    pub distances: Vec<DistanceObservation>,
    /// What fixes the frame of the object beside what is known of points and images.
    pub datum: Datum,
    /// Shapes that move control points; none as a rule.
    pub surfaces: Vec<Surface>,
    /// What differs from image to image of a camera; nothing as a rule.
    pub per_image: Vec<PerImage>,
}

/// An interior orientation: start values, and what is known of each parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Interior {
    /// Its name in messages.
    pub name: String,
    /// Start values.
    pub camera: Camera,
    /// Of each parameter, in the order of [`CameraModel::parameters`].
    pub parameters: Vec<Status>,
}

/// An image and its exterior orientation.
#[derive(Clone, Debug, PartialEq)]
pub struct Exterior {
    /// Its name in messages.
    pub name: String,
    /// Index of its camera.
    pub camera: usize,
    /// Start values.
    pub pose: Pose,
    /// What is known of X0.
    pub centre: Centre,
    /// What is known of M.
    pub attitude: Attitude,
}

/// A point of the object.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectPoint {
    /// Its name in messages.
    pub name: String,
    /// Start values, object units.
    pub position: Point3<f64>,
    /// Of X, Y and Z.
    pub coordinates: [Status; 3],
}

/// A measured image point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageObservation {
    /// Index of its image.
    pub image: usize,
    /// Index of its object point.
    pub point: usize,
    /// What was measured.
    pub position: PixelPoint,
    /// Its precision.
    pub precision: Precision,
    /// The point lies behind the camera, as no point does that was seen: it is pictured by the line through the projection centre, as far as the camera's formula goes.
    pub behind: bool,
}

/// Of image coordinates, a priori.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Precision {
    /// Standard deviation of each coordinate, px.
    Sigma(f64),
    /// Covariance of both, px^2.
    Covariance(Covariance),
}

impl Precision {
    /// A residual (x, y), px, made white: two numbers of variance 1.
    pub fn whitened(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [a, b, c] = self.whitening();
        [a * x, b * x + c * y]
    }

    /// The inverse of the covariance's Cholesky factor, row by row, 1/px: `[a, b, c]` makes a residual white as `(a x, b x + c y)`.
    #[inline]
    pub(crate) fn whitening(self) -> [f64; 3] {
        match self {
            Self::Sigma(sigma) => [1.0 / sigma, 0.0, 1.0 / sigma],
            Self::Covariance(c) => {
                let first = c.sxx.sqrt();
                let lean = c.sxy / first;
                let second = (c.syy - lean * lean).sqrt();
                [1.0 / first, -lean / (first * second), 1.0 / second]
            }
        }
    }
}

/// What fixes origin, axes and scale of the object's frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Datum {
    /// What is fixed or observed of points and images, and nothing else.
    #[default]
    Control,
    /// Two horizontal (X, Y) and three vertical (Z) control points, whose coordinates are held at their start values: seven constraints.
    ///
    /// Source: Vosselman and Förstner 1988, section 4.
    Minimal {
        /// Indices of the points whose X and Y are held.
        horizontal: [usize; 2],
        /// Indices of the points whose Z is held.
        vertical: [usize; 3],
    },
    /// Inner constraints over all object points: those seven (six where distances give the scale) that leave the points, together, closest to their
    /// start values, with the smallest trace of their covariance (free network).
    ///
    /// Source: Meissl 1965; Baarda 1973.
    Inner,
    /// The same over some of the points, by their indices: these alone stay closest to their start values.
    InnerOver(Vec<usize>),
}

impl Interior {
    /// A camera that is known.
    pub fn fixed(name: impl Into<String>, camera: impl Into<Camera>) -> Self {
        let camera = camera.into();
        let parameters = vec![Status::Fixed; camera.parameters().len()];
        Self { name: name.into(), camera, parameters }
    }

    /// The same with the parameters `names` free.
    ///
    /// # Errors
    /// [`NetworkError::NoSuchParameter`].
    pub fn free(mut self, names: &[&str]) -> Result<Self, NetworkError> {
        for name in names {
            let place = self.place(name)?;
            self.parameters[place] = Status::Free;
        }
        Ok(self)
    }

    /// The same with the parameter `name` observed as `value`, standard deviation `sigma`, in its unit.
    ///
    /// # Errors
    /// [`NetworkError::NoSuchParameter`].
    pub fn observed(mut self, name: &str, value: f64, sigma: f64) -> Result<Self, NetworkError> {
        let place = self.place(name)?;
        self.parameters[place] = Status::Observed { value, sigma };
        Ok(self)
    }

    fn place(&self, name: &str) -> Result<usize, NetworkError> {
        let all = self.camera.parameters();
        let found = all.iter().position(|parameter| parameter.name == name);
        found.ok_or_else(|| {
            let known = all.iter().map(|parameter| parameter.name).collect::<Vec<_>>().join(", ");
            NetworkError::NoSuchParameter { camera: self.name.clone(), name: name.into(), known }
        })
    }
}

impl Exterior {
    /// An image whose exterior orientation is unknown but for a start value.
    pub fn free(name: impl Into<String>, camera: usize, pose: Pose) -> Self {
        Self { name: name.into(), camera, pose, centre: Centre::Free, attitude: Attitude::Free }
    }

    /// An image whose exterior orientation is known, in the object's frame.
    pub fn fixed(name: impl Into<String>, camera: usize, pose: Pose) -> Self {
        Self { name: name.into(), camera, pose, centre: Centre::Fixed, attitude: Attitude::Fixed }
    }
}

impl ObjectPoint {
    /// A tie point: unknown but for a start value, object units.
    pub fn free(name: impl Into<String>, position: Point3<f64>) -> Self {
        Self { name: name.into(), position, coordinates: [Status::Free; 3] }
    }

    /// Fixed control: known without error, object units.
    pub fn fixed(name: impl Into<String>, position: Point3<f64>) -> Self {
        Self { name: name.into(), position, coordinates: [Status::Fixed; 3] }
    }

    /// Weighted control: observed coordinates with standard deviations, object units.
    pub fn observed(name: impl Into<String>, position: Point3<f64>, sigmas: [f64; 3]) -> Self {
        let coordinates = std::array::from_fn(|axis| Status::Observed { value: position[axis], sigma: sigmas[axis] });
        Self { name: name.into(), position, coordinates }
    }
}

impl ImageObservation {
    /// Coordinates of a standard deviation `sigma`, px.
    pub const fn new(image: usize, point: usize, position: PixelPoint, sigma: f64) -> Self {
        Self { image, point, position, precision: Precision::Sigma(sigma), behind: false }
    }
}
