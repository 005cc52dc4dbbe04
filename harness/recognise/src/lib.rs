//! The coded field in an image: its squares, its targets and their approximate positions, from the field's design alone.
//!
//! No pose, no camera, no truth. A [`Recogniser`] is made of a testfield and asked about images.
//!
//! Source: Vosselman & Förstner 1988, sections 3.1 to 3.3.

mod adjust;
mod bank;
mod blobs;
mod contour;
mod design;
mod error;
mod found;
mod grid;
mod ground;
mod groups;
mod hough;
mod identify;
mod label;
mod level;
mod look;
mod mapping;
mod normal;
mod number;
mod order;
mod recogniser;
mod ridge;
mod sharpness;
mod smooth;
mod square;
mod steps;
mod table;

pub use design::NotCoded;
pub use error::NotRecognised;
pub use found::{Blob, GridFound, LineFound, Reason, Recognised, Recognition, Rejected, SizeGroup, SquareFound};
pub use recogniser::{Classifier, Recogniser, recognise_each};
pub use steps::Steps;
pub use table::{ContourTable, TableError};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
