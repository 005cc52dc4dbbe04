//! The corners of a board as photographs show them, in its own frame: deviations from their nominal places, whether these are more than chance, and how much of them
//! the photographs repeat.

mod halves;
mod printer;

use std::collections::HashMap;

use calibench_model::{BoardCorner, ControlRow};
use nalgebra::{Matrix3, Point3};

pub(crate) use halves::repeats;
pub use halves::{Part, Repeats};
pub use printer::Printer;

use crate::{Bend, StatedBoard, few};

/// Photographs with fewer hold it badly.
pub(crate) const ENOUGH: usize = 8;
/// Photographs of a corner with fewer hold it badly.
const LEAST_OF_CORNER: usize = 3;
/// Probability at which a board is taken for perfect.
const ALPHA: f64 = 1e-3;
/// The share of the variance of one half's deviations that the other must repeat.
const REPEATED: f64 = 0.5;

/// A corner of a board, in the board's own frame, object units.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredCorner {
    /// Its name.
    pub name: String,
    /// Where it is nominally: X, Y, Z.
    pub nominal: Point3<f64>,
    /// Where it is.
    pub position: Point3<f64>,
    /// Covariance of the position in the datum of all corners, object units squared; enlarged as halves of the photographs ask for.
    pub covariance: Matrix3<f64>,
    /// In how many photographs it is.
    pub photographs: usize,
}

/// A root mean square over corners, object units: the length in the board's plane (2D), and along its normal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moved {
    /// In the plane, 2D.
    pub in_plane: f64,
    /// Along the normal.
    pub across: f64,
}

/// Whether corners deviate by more than chance: the same observations adjusted without their deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardTest {
    /// Fisher's statistic, a number: about 1 where there is none.
    pub f: f64,
    /// Unknowns that the deviations are.
    pub more: usize,
    /// Redundancy of the free adjustment.
    pub redundancy: i64,
    /// The chance of as large a statistic if there is no deviation.
    pub p: f64,
}

/// A board as photographs show it.
///
/// The frame is that of the nominal coordinates: of all places of the board as a whole, its turns and its scales, the one is taken that brings its corners nearest to
/// them (inner constraints over all corners). Nothing here tells the scale of the print.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredBoard {
    /// The corners that were measured.
    pub corners: Vec<MeasuredCorner>,
    /// How far they are from their nominal places.
    pub deviation: Moved,
    /// How well that is known: root mean square of the standard deviations.
    pub sigma: Moved,
    /// All deviations against none.
    pub test: BoardTest,
    /// The bend alone, with its own test; `None` where it could not be tested.
    pub bend: Option<Bend>,
    /// All deviations against a bend alone.
    pub beyond_bend: Option<BoardTest>,
    /// What halves of the photographs, adjusted alone, repeat; or why they cannot be.
    pub repeats: Result<Repeats, String>,
    /// How many photographs there are.
    pub photographs: usize,
}

/// Root mean squares of squares along the board's axes.
pub(crate) fn in_parts(squares: impl Iterator<Item = [f64; 3]>) -> Moved {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for own in squares {
        sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        count += 1.0;
    }
    Moved { in_plane: ((sum[0] + sum[1]) / f64::max(count, 1.0)).max(0.0).sqrt(), across: (sum[2] / f64::max(count, 1.0)).max(0.0).sqrt() }
}

impl MeasuredBoard {
    /// Whether the board is told from a perfect one: its corners deviate by more than chance, and halves of the photographs repeat it. Only then is anything gained by its file.
    pub fn is_told(&self) -> bool {
        self.test.p < ALPHA && self.repeats.as_ref().is_ok_and(Self::repeated)
    }

    fn repeated(repeats: &Repeats) -> bool {
        repeats.in_plane.correlation.max(repeats.across.correlation) > REPEATED
    }

    /// What is in doubt of it, in words.
    pub fn doubts(&self) -> Vec<String> {
        let badly: Vec<String> =
            self.corners.iter().filter(|corner| corner.photographs < LEAST_OF_CORNER).map(|corner| corner.name.clone()).collect();
        let of_all = (self.photographs < ENOUGH).then(|| {
            format!("{} photographs hold the corners of the board: {ENOUGH} or more, tilted and turned, hold them well", self.photographs)
        });
        let of_corners =
            (!badly.is_empty()).then(|| format!("{} of the board are in fewer than {LEAST_OF_CORNER} photographs each", few(&badly)));
        let of_halves = match &self.repeats {
            Err(why) => Some(format!("whether the photographs repeat the corners of the board cannot be told: {why}")),
            Ok(repeats) if self.test.p < ALPHA && !Self::repeated(repeats) => Some(format!(
                "the corners of the board deviate by more than chance (p {:.1e}), and halves of the photographs do not repeat it (correlation {:.2} in the plane, \
                 {:.2} across): it is not the board",
                self.test.p, repeats.in_plane.correlation, repeats.across.correlation
            )),
            Ok(_) => None,
        };
        of_all.into_iter().chain(of_corners).chain(of_halves).collect()
    }

    /// The corners that were measured, as a file of the board holds them: in the nominal scale, whatever was `stated` of the print.
    pub fn measured(&self, stated: &StatedBoard) -> Vec<BoardCorner> {
        let scale = stated.scale.map_or(1.0, |scale| scale.value);
        let corner = |corner: &MeasuredCorner| {
            let covariance = corner.covariance / (scale * scale);
            BoardCorner {
                target: corner.name.clone(),
                position: (corner.position / scale).into(),
                sigmas: [0, 1, 2].map(|k| covariance[(k, k)].max(f64::MIN_POSITIVE).sqrt()),
                covariances: Some([(0, 1), (0, 2), (1, 2)].map(|at| covariance[at])),
                nominal: Some((corner.nominal / scale).into()),
                photographs: Some(corner.photographs),
            }
        };
        self.corners.iter().map(corner).collect()
    }

    /// The same of all corners of `control`, in its order: those that no photograph showed at their nominal places, known as badly as the others deviate.
    pub fn all(&self, control: &[ControlRow], stated: &StatedBoard) -> Vec<BoardCorner> {
        let measured = self.measured(stated);
        let by_name: HashMap<&str, &BoardCorner> = measured.iter().map(|corner| (corner.target.as_str(), corner)).collect();
        let most = [self.deviation.in_plane, self.deviation.across, self.sigma.in_plane, self.sigma.across].into_iter().fold(0.0, f64::max);
        let nominal = |row: &ControlRow| BoardCorner {
            target: row.target.clone(),
            position: row.position,
            sigmas: [most; 3],
            covariances: Some([0.0; 3]),
            nominal: Some(row.position),
            photographs: Some(0),
        };
        let corner = |row: &ControlRow| by_name.get(row.target.as_str()).map_or_else(|| nominal(row), |known| (*known).clone());
        control.iter().map(corner).collect()
    }
}
