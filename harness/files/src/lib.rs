//! Files and folders that are whole or as they were, tables of CSV, and inputs within limits: what every reader and writer stands on.

pub mod atomic;
pub mod bounded;
pub mod folder;
pub mod inputs;
pub mod photograph;
pub mod pipelined;
pub mod table;

pub use atomic::{OutputFile, at};
pub use folder::{FilledFolder, NewFile, NewFolder, OutputFolder};
pub use inputs::Inputs;
pub use table::{Row, write_rows, write_table};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
