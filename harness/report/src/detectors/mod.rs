//! Detectors of boards, scored whole: what they find, what they take for something else, how far off it is.

mod load;
mod offsets;
mod page;

pub use load::Detectors;
pub use page::{FILE, page};
