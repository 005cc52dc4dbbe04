//! Parts of a run, computed apart and put together again: which trials a part has, what its folder tells of it, and tables joined row by row.

mod cut;
mod join;
mod manifest;

pub use cut::{MOST_PARTS, Part, PartError, Piece, Span, pieces};
pub use join::{JoinError, Joiner};
pub use manifest::{FORMAT, Manifest, ManifestError, Method, ToldBy, write};
