//! Reports: Markdown and PNG, a pure function of records and published tables.

pub mod acceptance;
mod answer;
pub mod atlas;
mod axes;
pub mod calibration;
mod camera_card;
mod canvas;
mod composed;
pub mod conventions;
mod corners;
mod detectors;
mod families;
mod family;
pub(crate) mod field;
mod field_panels;
mod figures;
mod first_screen;
mod frame;
mod html;
mod hull;
mod index;
pub mod json;
pub mod judgement;
mod labels;
mod league;
mod levels;
pub mod load;
pub(crate) mod markdown;
mod markup;
mod one_file;
pub mod orientation;
mod page;
mod papers;
mod photographs;
mod picture;
mod places;
mod plot;
mod poses;
mod predictions;
pub mod published;
mod room;
mod scene_figures;
mod scores_section;
mod sides;
pub mod speeds;
mod story;
mod studies;
pub mod sweep;
mod targets;
pub mod task;
pub(crate) mod ticks;
pub mod twin;
pub mod verdicts;
mod zhu;

pub use camera_card::camera_card;
pub use canvas::Canvas;
pub use composed::Composed;
pub use corners::{Corner, Pictured};
pub use families::{Filled, compose, fill};
pub use field::Field;
pub use html::{HELPERS, POLICY, STYLE};
pub use hull::Hull;
pub use index::write_index;
pub use load::{LoadError, Loaded, load, recorded};
pub use markdown::plain;
pub use markup::{escaped, json as in_script};
pub use one_file::{FamilyPages, ONE_FILE, family_pages, one_file};
pub use picture::PICTURES;
pub use places::{Places, ReportError, Written};
pub use scene_figures::{Look, found, preview};
pub use story::{Illustration, story};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;
