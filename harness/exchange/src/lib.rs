//! Tables of other tools and of ours: image coordinates, control, distances, lengths, stations, and the list of rendered images.

pub mod board_corners;
pub mod control;
mod csv_named_rows;
pub mod distances;
pub mod fingerprint;
pub mod lengths;
pub mod points;
pub mod points_write;
pub mod rendered;
pub mod stations;
pub mod times;

pub use board_corners::{read_board_corners, write_board_corners};
pub use control::{POINT_QUALITY_COLUMNS, read_control, write_control};
pub use distances::read_distances;
pub use fingerprint::Fingerprint;
pub use lengths::read_lengths;
pub use points::{PointFile, PointFileError, read_points};
pub use points_write::{MeasuredRow, Outcome, write_measured, write_points};
pub use rendered::{RENDERED, RenderedImage, read_rendered, write_rendered};
pub use stations::{POSE_COLUMNS, POSE_SIGMA_COLUMNS, read_observed_stations, read_stations, station_numbers};
pub use times::read_times;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
