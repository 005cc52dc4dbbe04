//! Scenarios: what is run, and why. TOML files, checked once into these types.

pub mod blocks;
pub mod calibration;
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
pub mod printed;
pub mod recognition;
mod resolved;
mod scene;
pub mod schema;
mod section;
pub mod sensor;
mod site;
pub mod stations;
mod subject;
pub mod sweep;
pub mod testfield;
pub mod transfer;
mod views;
mod why;
mod wire;

pub use blocks::{Block, Blocks, ResidualPairs};
pub use calibration::Calibration;
pub use check::{parse, parse_cell};
pub use drawn::Drawn;
pub use imaging::Imaging;
pub use judgement::JudgementPlan;
pub use methods::no_board;
pub use plan::Scenario;
pub use pointing::{Detector, HarrisPointing, Pointing};
pub use printed::Printed;
pub use recognition::Recognition;
pub use resolved::Resolved;
pub use stations::StationPlan;
pub use subject::{PhotographsSubject, SceneSubject, Starts, Subject, ViewsSubject};
pub use sweep::Sweep;
pub use testfield::Unit;
pub use transfer::Transfer;
pub use wire::{Phase, Pixels};

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
