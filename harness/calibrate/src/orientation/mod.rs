//! Orientations and object points of a survey whose interior orientations are known.

mod doubted;
mod intersected;
mod misfit;
mod pair;
mod pair_tables;
mod precision;
mod resected;

pub use intersected::{ObjectPoints, TOLD, poses_of};
pub use misfit::Misfit;
pub use pair::{LeftOutOfPair, Pair, PairError, PairTarget, Seen, Side};
pub use precision::StatedPrecision;
pub use resected::{ImageOrientation, Orientations, resect_images};
