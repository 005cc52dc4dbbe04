//! What the result is worth.

mod defect;

pub use defect::Defect;
