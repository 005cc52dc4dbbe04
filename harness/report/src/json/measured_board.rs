//! A measured board as JSON.

use calibench_calibrate::{BoardTest, MeasuredBoard, MeasuredCorner, Part, Repeats};
use schemars::JsonSchema;
use serde::Serialize;

/// A scale of the print that was stated.
#[derive(Serialize, JsonSchema)]
pub(super) struct Scale {
    /// True over nominal length.
    pub(super) value: f64,
    /// Its standard deviation.
    pub(super) sigma: f64,
    /// Its part of the standard deviation of every length, as a share of it, and of each station's distance from the object's origin. No parameter of a camera has any.
    pub(super) of_lengths: f64,
}

/// The corners of a board as the images show them, in its own frame; lengths in object units.
#[derive(Serialize, JsonSchema)]
pub(super) struct MeasuredBoardAnswer {
    /// In how many photographs it was.
    photographs: usize,
    /// What fixes its frame: always `inner`, inner constraints over all its corners, which are as a whole where the nominal ones are, and as large.
    datum: &'static str,
    /// Whether it is told from a perfect one: by more than chance, and again in halves of the photographs.
    told: bool,
    /// How far corners are off in the plane, RMS (2D).
    in_plane: f64,
    /// The standard deviation of that.
    sigma_in_plane: f64,
    /// How far they are off along the normal, RMS.
    across: f64,
    /// The standard deviation of that.
    sigma_across: f64,
    /// All deviations against none.
    test: Test,
    /// All deviations against a bend alone; null where that was not tested.
    beyond_bend: Option<Test>,
    /// What halves of the photographs repeat; null where they were not adjusted.
    halves: Option<Halves>,
    /// Its corners.
    corners: Vec<Corner>,
}

#[derive(Serialize, JsonSchema)]
struct Test {
    /// Fisher's statistic.
    f: f64,
    /// Its degrees of freedom: deviations, and redundancy.
    freedom: [i64; 2],
    /// The chance of as much without deviations.
    p: f64,
}

#[derive(Serialize, JsonSchema)]
struct Halves {
    /// Splits that could be adjusted.
    splits: usize,
    /// In the plane.
    in_plane: Common,
    /// Along the normal.
    across: Common,
    /// How many times as far halves are apart as standard deviations say; those of the corners are enlarged by it where it is above 1.
    sigmas: f64,
    /// The share of rows and columns that are off as a whole in what is common in the plane; null of a board that is no raster.
    rows_and_columns: Option<f64>,
    /// The share that they have by chance.
    rows_and_columns_by_chance: Option<f64>,
}

#[derive(Serialize, JsonSchema)]
struct Common {
    /// Correlation of the deviations of two halves.
    correlation: f64,
    /// RMS of what is common.
    rms: f64,
    /// Its share in the variance of the deviations of all photographs.
    of_whole: f64,
}

#[derive(Serialize, JsonSchema)]
struct Corner {
    /// Its name.
    target: String,
    /// X, Y, Z.
    position: [f64; 3],
    /// X, Y, Z as nominal.
    nominal: [f64; 3],
    /// Its covariance, row by row.
    covariance: [[f64; 3]; 3],
    /// In how many photographs it is.
    photographs: usize,
}

impl MeasuredBoardAnswer {
    pub(super) fn new(board: &MeasuredBoard) -> Self {
        Self {
            photographs: board.photographs,
            datum: "inner",
            told: board.is_told(),
            in_plane: board.deviation.in_plane,
            sigma_in_plane: board.sigma.in_plane,
            across: board.deviation.across,
            sigma_across: board.sigma.across,
            test: test(&board.test),
            beyond_bend: board.beyond_bend.as_ref().map(test),
            halves: board.repeats.as_ref().ok().map(halves),
            corners: board.corners.iter().map(corner).collect(),
        }
    }
}

fn test(found: &BoardTest) -> Test {
    Test { f: found.f, freedom: [found.more as i64, found.redundancy], p: found.p }
}

fn halves(repeats: &Repeats) -> Halves {
    let common = |part: &Part| Common { correlation: part.correlation, rms: part.common, of_whole: part.of_whole };
    Halves {
        splits: repeats.splits,
        in_plane: common(&repeats.in_plane),
        across: common(&repeats.across),
        sigmas: repeats.sigmas,
        rows_and_columns: repeats.printer.map(|printer| printer.share),
        rows_and_columns_by_chance: repeats.printer.map(|printer| printer.by_chance),
    }
}

fn corner(corner: &MeasuredCorner) -> Corner {
    Corner {
        target: corner.name.clone(),
        position: corner.position.into(),
        nominal: corner.nominal.into(),
        covariance: [0, 1, 2].map(|row| [0, 1, 2].map(|column| corner.covariance[(row, column)])),
        photographs: corner.photographs,
    }
}
