//! Orientations and object points of a survey whose interior orientations are known.

mod intersected;
mod pair;
mod pair_tables;
mod resected;

pub use intersected::{ObjectPoints, TOLD, poses_of};
pub use pair::{LeftOutOfPair, Pair, PairError, PairTarget, Seen, Side};
pub use resected::{ImageOrientation, resect_images, write_orientations};
