//! Methods that are programs of their own, in any language, or files of what such programs measured.
//!
//! A TOML file declares a plug-in; its program is started once a thread and is asked image by image. What it is given is what any operator gets: the grey values
//! and approximate positions, in an order that says nothing of the targets. Whatever it does, the run goes on: a point that it does not answer is rejected with
//! the reason, and other methods' rows do not change.

mod answer;
mod boards;
mod calibrator;
mod confine;
mod conformance;
mod declaration;
mod descendants;
mod error;
mod file;
mod folder;
mod method;
mod operator;
mod patience;
mod process;
mod program;
mod recorded;
mod request;
mod starts;
mod told;

pub use calibrator::{CalibratorDeclaration, CalibratorProgram, Said, Unanswered};
pub use confine::{Confinement, confine_and_execute};
pub use conformance::{Finding, check};
pub use declaration::{Declaration, Grey, Mode, is_name};
pub use error::PluginError;
pub use file::{Declared, calibrators, load, parse};
pub use method::method;
pub use program::Launcher;
pub use recorded::{Images, Origin, Positions, Recording};
pub use starts::{Boards, Starts};
pub use told::Teller;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;
