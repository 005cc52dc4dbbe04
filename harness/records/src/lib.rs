//! Records: what a run leaves, and the figures that are made of them. The only language between running and reporting.

pub mod adjustments;
mod cells;
pub mod compressor;
pub mod description;
mod digits;
mod errors;
pub mod figures;
mod interned;
pub mod judgement;
pub mod league;
mod limited;
pub mod names;
mod once;
mod order;
pub mod parts;
pub mod plain;
pub mod points;
pub mod results;
pub mod score;
pub mod spelling;
pub mod statistics;
pub mod stored;
pub mod theory;

pub use cells::RecordError;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;
