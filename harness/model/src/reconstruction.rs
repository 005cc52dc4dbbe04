//! What tools of structure from motion hand on: cameras, oriented images, object points and where the images show them.

use nalgebra::Point3;

use crate::{NamedCamera, PixelPoint, Pose};

/// A block of images that some tool has oriented. Which of its sights are right is not said.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reconstruction {
    /// Interior orientations, with the parameters that the tool's model has.
    pub cameras: Vec<ReconstructedCamera>,
    /// Images and their exterior orientations, in the file's order.
    pub images: Vec<OrientedImage>,
    /// Object points, in the file's order.
    pub points: Vec<TiePoint>,
    /// Where images show them, in the file's order.
    pub sights: Vec<TieSight>,
    /// What the user should know: what was assumed, what was left out.
    pub notes: Vec<String>,
}

/// A camera and what of it the tool's model lets vary.
#[derive(Clone, Debug, PartialEq)]
pub struct ReconstructedCamera {
    /// With the name that it has in the file.
    pub named: NamedCamera,
    /// Parameters of focal length and distortion that the tool's model has, by their names in [`crate::camera::CameraModel::parameters`].
    pub lens: Vec<&'static str>,
    /// The same of the principal point; empty where the model has none.
    pub principal_point: Vec<&'static str>,
}

/// An image and its exterior orientation.
#[derive(Clone, Debug, PartialEq)]
pub struct OrientedImage {
    /// The name that it has in the file.
    pub name: String,
    /// Index of its camera.
    pub camera: usize,
    /// In the frame of the reconstruction, whose units are the object units.
    pub pose: Pose,
}

/// An object point that was found by its images.
#[derive(Clone, Debug, PartialEq)]
pub struct TiePoint {
    /// The name or number that it has in the file.
    pub name: String,
    /// Object units.
    pub position: Point3<f64>,
}

/// An image shows a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TieSight {
    /// Index of the image.
    pub image: usize,
    /// Index of the point.
    pub point: usize,
    /// Where, px from the centre of the first pixel.
    pub position: PixelPoint,
}
