//! From measured points to a calibrated camera, for users: start values without truth, the adjustment, and what is to be said of it.

mod against_gross;
mod allowed;
mod board_file;
mod board_measuring;
mod board_shape;
mod board_solver;
mod calibration;
mod checked;
pub mod choice;
mod compared;
mod datum;
mod discs;
mod distances;
mod doubt;
mod doubted;
mod eccentricity;
mod ended;
mod error;
mod far;
mod finding;
mod from_images;
mod gross_errors;
mod measured_board;
mod model;
mod neighbours;
mod network;
mod next;
mod optics;
pub mod orientation;
mod over_frame;
mod own_numbers;
mod own_parameter;
mod part;
mod per_image;
mod placed;
mod prepared;
mod prior;
mod raster;
mod reconstructed;
mod resampled;
pub mod rig;
mod rival;
mod search;
mod sets;
mod settings;
mod shape;
pub mod splined;
mod stages;
mod start;
mod stated_board;
mod survey;
mod suspect;
mod taken_as_exact;
mod weak;
mod whole;

#[cfg(test)]
extern crate self as calibench_calibrate;
#[cfg(test)]
#[allow(dead_code, reason = "the tests beside the crate use the rest")]
#[path = "../tests/surveys/network.rs"]
mod scenes;

pub use board_file::{OtherBoard, with_corners};
pub use board_shape::{BoardShape, NoShape};
pub use board_solver::{BoardSolution, BoardSolver};
pub use calibration::Calibration;
pub use checked::{Checked, SHARE, Verdict};
pub use compared::{Compared, ComparedSet, SetResult};
pub use datum::{DatumChoice, NoDatum};
pub use discs::{Offset, offsets};
pub use distances::{AdjustedLength, CheckedDistance};
pub use doubted::{Doubt, Subject};
pub use eccentricity::{Discs, Eccentricity, NoDiscs};
pub use error::{CalibrationError, few};
pub use finding::Finding;
pub use from_images::prepare_free;
pub use gross_errors::{GrossErrors, Risk};
pub use measured_board::{BoardTest, MeasuredBoard, MeasuredCorner, Moved, Part, Printer, Repeats};
pub use model::{MODELS, parameters};
pub use next::{Next, Photograph};
pub use optics::Optics;
pub use over_frame::{OverFrame, usual_limit_px};
pub use own_numbers::OwnNumber;
pub use own_parameter::{NoOwnParameter, OwnParameter};
pub use part::part_of;
pub use per_image::Scatter;
pub use prepared::{Prepared, prepare};
pub use prior::{NoPrior, Prior};
pub use reconstructed::{Behind, Reconstructed, Solved, prepare_reconstruction};
pub use resampled::Resampled;
pub use rival::Rival;
pub use sets::compare_sets;
pub use settings::{Settings, USUAL_SIGMA};
pub use shape::{Bend, Board, Shape};
pub use start::{control_of, pose_of, robust_pose_of};
pub use stated_board::{BoardScale, NoBoardScale, StatedBoard};
pub use survey::{Known, LeftOut, Sight, Survey};
pub use suspect::{MOST_TRIED, Suspected, suspected};
pub use whole::calibrate;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
