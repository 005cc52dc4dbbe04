//! Views left out: what a camera predicts of photographs that it has not seen.

use calibench_adjust::approximate::Control;
use calibench_model::camera::{Camera, CameraModel};

use super::material::Material;
use crate::calibration::pose_of;

/// With fewer corners in the half that it is resected from, a view says nothing.
const FEWEST: usize = 6;

/// Sum of squares, and of how many points.
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

    /// How many.
    pub fn count(self) -> usize {
        self.count
    }

    /// The root mean square; `None` of nothing.
    pub fn rms(self) -> Option<f64> {
        (self.count > 0).then(|| (self.sum / self.count as f64).sqrt())
    }
}

/// Predicts corners of a view that took no part in the calibration of `camera`: the pose from one part of the corners, the errors (2D) of the others.
/// Each of `parts` says which corners the pose comes from; all others of `chosen` are predicted.
///
/// # Errors
/// In words: too few corners, no pose, a corner that is not pictured.
pub fn predict(
    material: &Material,
    operator: usize,
    view: usize,
    camera: &Camera,
    chosen: &[bool],
    parts: &[&dyn Fn(usize, usize) -> bool],
) -> Result<Squares, String> {
    let mut squares = Squares::default();
    for part in parts {
        let inside = |corner: usize| {
            let (column, row) = material.place(corner);
            part(column, row)
        };
        let known = material.seen(operator, view, &|corner| chosen[corner] && inside(corner));
        let others = material.seen(operator, view, &|corner| chosen[corner] && !inside(corner));
        if known.len() < FEWEST || others.is_empty() {
            return Err(format!("{} corners to resect from, at least {FEWEST} are needed", known.len()));
        }
        let pose = pose_of(camera, &known)?;
        for Control { object, image } in &others {
            let predicted = camera.project(pose.ray(object)).map_err(|_| "a corner is not pictured by the camera".to_owned())?;
            squares.add(predicted.distance(*image).powi(2));
        }
    }
    Ok(squares)
}

/// Every other corner, as the fields of a chessboard: the pose comes from among the corners that it predicts.
pub fn interleaved(material: &Material, operator: usize, view: usize, camera: &Camera, chosen: &[bool]) -> Result<Squares, String> {
    predict(material, operator, view, camera, chosen, &[&|c, r| (c + r) % 2 == 0, &|c, r| (c + r) % 2 == 1])
}

/// One side of the board from the other, left, right, top and bottom: the pose is carried on, and errors of the camera with it.
pub fn across(material: &Material, operator: usize, view: usize, camera: &Camera, chosen: &[bool]) -> Result<Squares, String> {
    let (columns, rows) = (material.board.columns, material.board.rows);
    let sides: [&dyn Fn(usize, usize) -> bool; 4] =
        [&|c, _| 2 * c < columns, &|c, _| 2 * c >= columns, &|_, r| 2 * r < rows, &|_, r| 2 * r >= rows];
    predict(material, operator, view, camera, chosen, &sides)
}

/// The RMS of the residuals (2D) of a view resected from all its corners, the camera held.
///
/// # Errors
/// As [`predict`].
pub fn resected(material: &Material, operator: usize, view: usize, camera: &Camera) -> Result<Squares, String> {
    let all = material.seen(operator, view, &|_| true);
    let pose = pose_of(camera, &all)?;
    let mut squares = Squares::default();
    for Control { object, image } in &all {
        let predicted = camera.project(pose.ray(object)).map_err(|_| "a corner is not pictured by the camera".to_owned())?;
        squares.add(predicted.distance(*image).powi(2));
    }
    Ok(squares)
}
