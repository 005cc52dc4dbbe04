//! Discs: the centre of their picture is not the picture of their centre, and the adjustment is told so.

mod centred;
mod pictured;
mod plane;
mod which;

pub use pictured::{Offset, offsets};
pub(crate) use which::Known;

#[cfg(test)]
mod tests;
