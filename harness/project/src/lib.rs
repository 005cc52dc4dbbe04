//! Where a project is and what belongs to it: scenarios, methods with the plug-ins, folders of records and reports. What the command line and other languages
//! share.

mod answered;
mod error;
mod methods;
mod project;
mod reports;
mod scenarios;
mod toolbox;

pub use answered::answered_camera;
pub use error::ProjectError;
pub use methods::Pictured;
pub use project::{Project, here};
pub use scenarios::origin;
pub use toolbox::Toolbox;

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
