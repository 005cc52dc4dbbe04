//! `[tasks]`: cameras that are calibrated from a board that errs, and then measure.

mod read;
#[cfg(test)]
mod tests;
pub mod wire;

pub(crate) use read::read;

use super::plan::StudyPlan;

/// The name under which its figures stand in the records.
pub const SET: &str = "tasks";

/// A checked `[tasks]` table.
#[derive(Clone, Debug, PartialEq)]
pub struct Tasks {
    /// The camera model that is calibrated.
    pub model: String,
    /// The standard deviation of an image coordinate, px: of those of the board, and of those of what is measured.
    pub noise_px: f64,
    /// Of each method, in the scenario's order, the standard deviation per axis of its image coordinates, px: they are drawn.
    pub drawn: Vec<(String, Option<f64>)>,
    /// How the board errs.
    pub board: BoardErrors,
    /// Lengths that each calibrated camera measures.
    pub count: usize,
    /// The least of them, object units.
    pub length: f64,
    /// Standard deviation of each coordinate of a stated projection centre, object units.
    pub centre_sigma: f64,
    /// Standard deviation of a stated rotation about each axis, rad.
    pub angle_sigma: f64,
    /// Standard deviation of where a known plane lies along its normal, object units.
    pub plane_sigma: f64,
    /// Standard deviation of its tilt about either axis in it, rad.
    pub tilt_sigma: f64,
}

/// How a board errs, and is told to err: standard deviations, of which every trial draws its own board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardErrors {
    /// Of each coordinate of each corner, object units.
    pub print: f64,
    /// Of the scale of the print, a number.
    pub scale: f64,
    /// Of each of three bends of the second order, along it, across and twisted, object units.
    pub flatness: f64,
}

impl StudyPlan for Tasks {
    fn sets(&self) -> Vec<String> {
        vec![SET.to_owned()]
    }

    fn is_random(&self) -> bool {
        true
    }

    fn drawn(&self) -> Option<&[(String, Option<f64>)]> {
        Some(&self.drawn)
    }

    fn runs_apart(&self) -> bool {
        true
    }
}
