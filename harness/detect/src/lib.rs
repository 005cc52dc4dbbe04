//! Boards with coded or uncoded marks in an image: which of their points are seen, and where to about a pixel.
//!
//! [`detect`] takes an image and a [`Board`](calibench_model::boards::Board), and says which points it sees or, by name, why it sees no such board. It never numbers what contradicts the
//! board. No pose, no camera, no truth. One thread, the same bytes every time.
//!
//! Markers are looked for as dark quadrangles whose sides are adjusted to the edges of the image, discs as round dark areas, the corners of chessboards and PuzzleBoards as saddles. What is decoded has to stand as the board
//! has it, each mark to its neighbours; so lens distortion does no harm.

mod arrange;
mod cells;
mod chessboard;
mod circles;
mod codes;
mod corners;
mod dotted;
mod error;
mod found;
mod ground;
mod instead;
mod kinds;
mod lattice;
mod markers;
mod meeting;
mod parts;
mod patches;
mod plane;
mod puzzle;
mod quads;
mod reasons;
mod round;
mod saddle;
mod sectors;
mod several;
mod smooth;
mod unknown;
mod unknown_markers;
mod warps;

pub use error::NotFound;
pub use found::{Doubt, Found, FoundPoint};
pub use kinds::detect;
pub use several::{detect_all, seen_several};
pub use unknown::{Identified, identify};
pub use warps::warps;

/// The version of what finds boards, in records.
pub const VERSION: &str = "3";

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
