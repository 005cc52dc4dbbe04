//! Scenarios: what is run, and why. TOML files, checked once into these types.

pub mod camera;
pub mod catalogue;
mod check;
pub mod data;
mod drawn;
mod figure;
mod imaging;
mod judgement;
mod methods;
mod optics;
mod photographs;
mod plan;
pub mod pointing;
mod resolved;
mod scene;
pub mod schema;
mod section;
pub mod sensor;
mod site;
pub mod stations;
pub mod studies;
mod study_tables;
mod subject;
pub mod sweep;
pub mod testfield;
mod views;
mod why;
mod wire;

pub use check::{parse, parse_cell};
pub use drawn::Drawn;
pub use imaging::{Imaging, ImagingError};
pub use judgement::JudgementPlan;
pub use methods::no_board;
pub use plan::Scenario;
pub use pointing::{Detector, HarrisPointing, Pointing};
pub use resolved::Resolved;
pub use stations::StationPlan;
pub use studies::StudyPlan;
pub use studies::blocks::{Block, Blocks, ResidualPairs};
pub use studies::network::Calibration;
pub use studies::networks::Networks;
pub use studies::printed::{Printed, Turned};
pub use studies::recognition::Recognition;
pub use studies::tasks::Tasks;
pub use studies::transfer::Transfer;
pub use subject::{PhotographsSubject, SceneSubject, Starts, Study, Subject, ViewsSubject};
pub use sweep::Sweep;
pub use testfield::Unit;
pub use wire::{Phase, Pixels};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
