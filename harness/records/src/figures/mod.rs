//! The catalogue of figures: what adjustments, recognitions and finders report, each once, with its name, group, unit and meaning.

mod catalogue;
mod entry;
mod name;
mod names;
mod pattern;
#[cfg(test)]
mod tests;

pub use catalogue::Quantity;
pub use entry::{Better, Entry, Group, Kind, Units};
pub use name::{FigureName, UnknownFigure};
pub use names::FigureNames;
