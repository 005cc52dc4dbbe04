//! Files of other tools: image coordinates and photographs.

pub mod atomic;
pub mod folder;
pub mod photo;
pub mod points;
pub mod points_write;

pub use folder::FolderWriter;
pub use photo::{PhotoError, read_photo, write_png};
pub use points::{PointFile, PointFileError, PointRow, read_points};
pub use points_write::{MeasuredRow, Outcome, write_measured, write_points};
