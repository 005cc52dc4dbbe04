//! The catalogue of figures: what adjustments, recognitions and finders report, each once, with its name, group, unit and meaning.

mod catalogue;
mod name;
mod names;
mod pattern;
mod terms;
#[cfg(test)]
mod tests;

pub use catalogue::{Entry, Quantity};
pub use name::{FigureName, UnknownFigure};
pub use names::FigureNames;
pub use terms::{Better, Group, Kind, Units};
