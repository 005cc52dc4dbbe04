//! A testfield seen by a camera: outlines in the image, and the truth about every target.

mod clip;
mod disc;
mod occlusion;
mod outline;
mod polygon;
#[cfg(test)]
mod tests;
mod trace;
mod truth;

use calibench_model::camera::{Camera, CameraModel, NoCounterpart, Ray, fold};
use calibench_model::{PixelPoint, Pose, Testfield};
use nalgebra::{Matrix2, Matrix2x3, Point3};
use rayon::prelude::*;
use thiserror::Error;

use crate::local::LocalDistortion;
use crate::raster::Picture;
use occlusion::Sheet;
use polygon::Convex;

pub use truth::{Ellipse, TargetTruth, Visibility};

/// A camera before a testfield.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// What is seen.
    pub field: &'a Testfield,
    /// With which interior orientation.
    pub camera: &'a Camera,
    /// What else displaces its images.
    pub local: Option<&'a LocalDistortion>,
    /// From where.
    pub pose: &'a Pose,
}

/// A view that cannot be pictured.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ViewError {
    /// Every plate is behind the camera.
    #[error("the testfield lies behind the camera")]
    Behind,
    /// The mapping is not one to one within the frame or its margin.
    #[error("the distortion folds over {radius_px:.0} px from the image of the axis, inside the image or within {margin_px:.0} px of it")]
    Fold {
        /// Where, px from the image of the axis: the fold, or a place of the border that has no ray.
        radius_px: f64,
        /// How far around the frame light matters, px.
        margin_px: f64,
    },
    /// A bent plate before another one.
    #[error("plate `{front}` is bent and hides part of plate `{back}`: only flat plates may stand before others")]
    BentBefore {
        /// The nearer plate.
        front: String,
        /// The other.
        back: String,
    },
    /// The camera sees half of all directions or more: what it pictures has no outline in a plane.
    #[error(
        "the camera sees {angle:.0} degrees from its axis within {margin_px:.0} px of its frame; expected less than 90: a longer focal length, or a smaller size"
    )]
    Wide {
        /// Angle from the axis, degrees.
        angle: f64,
        /// How far around the frame light matters, px.
        margin_px: f64,
    },
    /// Two plates that hide each other.
    #[error("plates `{0}` and `{1}` cut through each other")]
    Cut(String, String),
    /// The camera stands in a plate.
    #[error("the camera stands in the plane of plate `{0}`, or on it")]
    EdgeOn(String),
    /// A part of a plate in the frame to which the camera model gives no place.
    #[error("part of plate `{plate}` has no place in the image: {why}")]
    NoPlace {
        /// The plate.
        plate: String,
        /// What the model says.
        why: NoCounterpart,
    },
}

impl<'a> View<'a> {
    /// What of the testfield comes to the image: the ground of outlines and truth. `margin` is how far around the frame light matters, px: the reach of the optics.
    ///
    /// # Errors
    /// What cannot be pictured, by name.
    pub fn seen(&self, margin: f64) -> Result<Seen<'a>, ViewError> {
        let frame = self.frame(margin)?;
        let sheets = occlusion::sheets(self, &frame)?;
        Ok(Seen { view: *self, frame, sheets })
    }

    /// The outlines in the image: [`Seen::picture`] of [`Self::seen`] with this `margin`, px.
    ///
    /// # Errors
    /// What cannot be pictured, by name.
    pub fn picture(&self, margin: f64) -> Result<Picture, ViewError> {
        self.seen(margin)?.picture()
    }

    /// Where the image of an object point is, px.
    fn project(&self, point: &Point3<f64>) -> Result<PixelPoint, NoCounterpart> {
        self.image(self.pose.ray(point), None)
    }

    /// Where the image of a ray is, px; `near` is the image of a ray nearby, if one is known.
    fn image(&self, ray: Ray, near: Option<PixelPoint>) -> Result<PixelPoint, NoCounterpart> {
        let at = match near {
            Some(near) => self.camera.project_near(ray, near),
            None => self.camera.project(ray),
        }?;
        Ok(self.local.map_or(at, |local| local.displaced(at)))
    }

    /// How long a piece of an outline may be, px, whatever its own points say.
    fn longest(&self) -> f64 {
        self.local.map_or(f64::INFINITY, |local| local.longest(trace::TOLERANCE))
    }

    /// d(pixel) / d(object), px per object unit.
    fn by_object(&self, point: &Point3<f64>) -> Option<Matrix2x3<f64>> {
        let derivatives = self.camera.derivatives(self.pose.ray(point)).ok()?;
        let [[a, b, c], [d, e, f]] = derivatives.by_ray;
        let by_object = Matrix2x3::new(a, b, c, d, e, f) * self.pose.rotation;
        let Some(local) = self.local else { return Some(by_object) };
        let [[xx, xy], [yx, yy]] = local.at(derivatives.point).slope;
        Some(Matrix2::new(1.0 + xx, xy, yx, 1.0 + yy) * by_object)
    }

    fn frame(&self, margin: f64) -> Result<Frame, ViewError> {
        let size = self.camera.size();
        if let Some(fold) = fold(self.camera) {
            return Err(ViewError::Fold { radius_px: fold.radius_px, margin_px: margin });
        }
        // Two pixels more for the chords between the points of the border, and between them as much as the field displaces at most.
        let margin = margin + 2.0 + self.local.map_or(0.0, LocalDistortion::reach);
        let (right, bottom) = (f64::from(size.width) - 0.5 + margin, f64::from(size.height) - 0.5 + margin);
        let sides = [-0.5 - margin, -0.5 - margin, right, bottom];
        let directions = polygon::border(self, sides).map_err(|at| {
            let middle = PixelPoint::new((f64::from(size.width) - 1.0) / 2.0, (f64::from(size.height) - 1.0) / 2.0);
            let ahead = Ray { x: 0.0, y: 0.0, z: -1.0 };
            if let Ok(ray) = self.camera.unproject(at) {
                return ViewError::Wide { angle: ray.angle_to(ahead).to_degrees(), margin_px: margin };
            }
            let axis = self.camera.project(ahead).unwrap_or(middle);
            ViewError::Fold { radius_px: at.distance(axis), margin_px: margin }
        })?;
        Ok(Frame { sides, directions })
    }
}

/// The frame with its margin.
pub(crate) struct Frame {
    /// Left, top, right, bottom, px.
    pub sides: [f64; 4],
    /// A convex polygon around all directions that come to the frame, in tangents (right, up).
    pub directions: Convex,
}

/// What a camera sees of a testfield.
pub struct Seen<'a> {
    view: View<'a>,
    frame: Frame,
    /// In the order of the testfield's plates; `None` for one that does not come to the frame.
    sheets: Vec<Option<Sheet<'a>>>,
}

impl Seen<'_> {
    /// The outlines in the image.
    ///
    /// # Errors
    /// A testfield that is wholly behind the camera or outside the frame; a part of a plate to which the camera model gives no place.
    pub fn picture(&self) -> Result<Picture, ViewError> {
        let (field, size) = (self.view.field, self.view.camera.size());
        if !field.plates.is_empty() && self.sheets.iter().all(Option::is_none) {
            return Err(ViewError::Behind);
        }
        let mut pieces = Vec::new();
        for sheet in self.sheets.iter().flatten() {
            outline::sheet(&self.view, sheet, &self.frame, &mut pieces)?;
        }
        Ok(Picture { width: size.width as usize, height: size.height as usize, background: field.background, pieces })
    }

    /// The truth about every target, in the order of the testfield's.
    pub fn truth(&self) -> Vec<TargetTruth> {
        let targets = self.view.field.targets.par_iter();
        targets.map(|target| truth::truth(&self.view, target, self.sheets[target.plate].as_ref())).collect()
    }
}
