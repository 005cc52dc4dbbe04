//! Pointing at targets in photographs: a page, as one file or from a server on this machine that measures what is pointed at.

mod page;
mod predict;
mod serve;
mod shown;

pub use page::{Content, Loaded, write_page};
pub use predict::{Predicted, predict};
pub use serve::{Kept, Served, Server};
pub use shown::{Shown, Stretch};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
