//! Views left out: what a camera predicts of photographs that it has not seen.

use calibench_adjust::approximate::{Control, fit_pose};
use calibench_model::Pose;
use calibench_model::camera::{Camera, CameraModel};

use super::bend::Bend;
use super::material::Material;

/// With fewer corners in the half that it is resected from, a view says nothing.
const FEWEST: usize = 6;

/// Sum of squared distances in the image (2D), px^2, and of how many points.
#[derive(Clone, Copy, Debug, Default)]
pub struct Squares {
    sum: f64,
    count: usize,
}

impl Squares {
    fn add(&mut self, square: f64) {
        self.sum += square;
        self.count += 1;
    }

    /// The number of points.
    pub fn count(self) -> usize {
        self.count
    }

    /// The root mean square (2D), px; `None` of nothing.
    pub fn rms(self) -> Option<f64> {
        (self.count > 0).then(|| (self.sum / self.count as f64).sqrt())
    }
}

/// A view and the camera that predicts it.
#[derive(Clone, Copy)]
pub struct Unseen<'a> {
    /// All corners.
    pub material: &'a Material,
    /// The place of the operator that measured them.
    pub operator: usize,
    /// The view.
    pub view: usize,
    /// The camera, which is held.
    pub camera: &'a Camera,
    /// How the board is bent.
    pub bend: &'a Bend,
    /// A pose to start from, in the board's frame.
    pub near: &'a Pose,
}

impl Unseen<'_> {
    /// Predicts corners from others: the pose from one part of the corners, the errors (2D) of the others. Each of `parts` says which corners the pose
    /// comes from; all others of `chosen` are predicted.
    fn predict(&self, chosen: &[bool], parts: &[Vec<bool>]) -> Result<Squares, String> {
        let mut squares = Squares::default();
        for part in parts {
            let known = self.material.seen(self.operator, self.view, self.bend, &|corner| chosen[corner] && part[corner]);
            let others = self.material.seen(self.operator, self.view, self.bend, &|corner| chosen[corner] && !part[corner]);
            if known.len() < FEWEST || others.is_empty() {
                return Err(format!("{} corners to resect from, at least {FEWEST} are needed", known.len()));
            }
            self.add(&known, &others, &mut squares)?;
        }
        Ok(squares)
    }

    fn add(&self, known: &[Control], others: &[Control], squares: &mut Squares) -> Result<(), String> {
        let pose = fit_pose(self.camera, self.near, known).map_err(|error| error.to_string())?.pose;
        for Control { object, image } in others {
            let predicted = self.camera.project(pose.ray(object)).map_err(|_| "a corner is not pictured by the camera".to_owned())?;
            squares.add(predicted.distance(*image).powi(2));
        }
        Ok(())
    }

    /// Every other corner, as the fields of a chessboard: the pose comes from among the corners that it predicts.
    ///
    /// # Errors
    /// In words: too few corners, no pose, a corner that is not pictured.
    pub fn interleaved(&self, chosen: &[bool]) -> Result<Squares, String> {
        self.predict(chosen, &self.material.field.interleaved())
    }

    /// One side of the board from the other, left, right, top and bottom: the pose is carried on, and errors of the camera with it.
    ///
    /// # Errors
    /// As [`Self::interleaved`].
    pub fn across(&self, chosen: &[bool]) -> Result<Squares, String> {
        self.predict(chosen, &self.material.field.sides())
    }

    /// The residuals (2D) of the view resected from all its corners.
    ///
    /// # Errors
    /// As [`Self::interleaved`].
    pub fn resected(&self) -> Result<Squares, String> {
        let (all, mut squares) = (self.material.seen(self.operator, self.view, self.bend, &|_| true), Squares::default());
        self.add(&all, &all, &mut squares)?;
        Ok(squares)
    }
}
