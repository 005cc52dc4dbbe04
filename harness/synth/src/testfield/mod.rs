//! Testfields: generators of the plates and targets that cameras are pointed at.
//!
//! Each generator is a struct of checked parameters with `generate`, in a file of its own. Lengths are in the object unit of the scenario, angles in
//! radians. What is random is keyed by the target that it concerns: another target more or less moves none of the others.

pub mod board;
mod check;
pub mod chessboard;
pub mod coded;
mod fill;
pub mod house;
mod join;
mod outline;
pub mod panels;
pub mod pen;
mod print;
pub mod shape;
mod sheet_layout;
pub mod tags;
pub mod wall;
mod zhu;

use calibench_model::PixelPoint;
use calibench_model::boards::BoardError;
use calibench_model::testfield::{Bend, PlatePoint};
use thiserror::Error;

pub use board::BoardSheet;
pub use chessboard::Chessboard;
pub use coded::Coded;
pub use fill::{Arrangement, Fill, Turn};
pub use house::House;
pub use join::Join;
pub use panels::Panels;
pub use print::Print;
pub use shape::Shape;
pub use tags::{Tag, Tags};
pub use wall::{Sheet, Wall, WallTarget};
pub use zhu::{Figure4, Zhu};

/// Reflectances of a sheet and of what is printed on it, fractions of what makes full scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Levels {
    /// Of the sheet, 0 to 1.
    pub paper: f64,
    /// Of the ink, 0 to 1.
    pub ink: f64,
}

impl Default for Levels {
    fn default() -> Self {
        Self { paper: 0.85, ink: 0.05 }
    }
}

/// How much and in which direction a sheet is bent; its crest passes through the middle, its height is zero at the sheet's ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetBend {
    /// The height at the crest, object units; negative bends away from the viewer.
    pub peak: f64,
    /// The direction across the crest, from u towards v, radians.
    pub across: f64,
}

impl SheetBend {
    /// The bend of the sheet between these two corners (object units), the lower values first.
    pub fn over(&self, [[u0, v0], [u1, v1]]: [PlatePoint; 2]) -> Bend {
        let (sine, cosine) = self.across.sin_cos();
        let reach = 0.5 * ((u1 - u0) * cosine.abs() + (v1 - v0) * sine.abs());
        Bend { peak: self.peak, middle: [0.5 * (u0 + u1), 0.5 * (v0 + v1)], across: self.across, reach, along: 0.0 }
    }
}

/// Why a testfield cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FieldError {
    /// A parameter out of its range.
    #[error("`{parameter}` is {value}: expected {expected}")]
    Parameter {
        /// Its name in scenarios.
        parameter: &'static str,
        /// The value that was given.
        value: f64,
        /// Values that are allowed.
        expected: String,
    },
    /// Two things of one name.
    #[error("{what} `{id}` stands here a second time; expected each id once")]
    Twice {
        /// Plate or target.
        what: &'static str,
        /// The name.
        id: String,
    },
    /// A plate whose axes are not at right angles or have no length.
    #[error("the axes of plate `{0}` are not two directions at a right angle")]
    Axes(String),
    /// A target on a plate that there is not.
    #[error("target `{target}` is on plate `{plate}`, and there is no such plate")]
    UnknownPlate {
        /// The target.
        target: String,
        /// The plate that it names.
        plate: String,
    },
    /// A target that is not wholly on its plate.
    #[error("target `{target}` does not lie wholly on plate `{plate}`")]
    OffPlate {
        /// The target.
        target: String,
        /// Its plate.
        plate: String,
    },
    /// Two targets on one place.
    #[error("targets `{first}` and `{second}` overlap at ({:.6}, {:.6}) of plate `{plate}`", at.x, at.y)]
    Overlap {
        /// One target.
        first: String,
        /// The other.
        second: String,
        /// Their plate.
        plate: String,
        /// Where, in the plate's axes: x is u, y is v, object units.
        at: PixelPoint,
    },
    /// No room for all targets.
    #[error("{placed} of {wanted} targets found a place on plate `{plate}`: expected fewer, smaller or nearer ones")]
    Crowded {
        /// How many did.
        placed: usize,
        /// How many should have.
        wanted: usize,
        /// The plate.
        plate: String,
    },
    /// A square of a coded field for which no unambiguous arrangement was found.
    #[error("no arrangement of targets tells square {0} from the others")]
    Ambiguous(String),
    /// A text that describes no board.
    #[error("{0}")]
    Board(String),
    /// A field without plates or targets.
    #[error("the testfield has no {0}")]
    Nothing(&'static str),
}

impl From<BoardError> for FieldError {
    fn from(error: BoardError) -> Self {
        match error {
            BoardError::Parameter { parameter, value, expected } => Self::Parameter { parameter, value, expected },
            BoardError::Text(text) => Self::Board(text),
        }
    }
}
