//! A folder of results under digests of what they depend on.
//!
//! An entry is written beside its place and moved there when it is whole, so that several commands may use one store; its digest stands at its end and is
//! checked before anything of it is read.

mod entry;
mod key;
mod store;

pub use entry::{Found, NewEntry};
pub use key::Key;
pub use store::Store;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;
