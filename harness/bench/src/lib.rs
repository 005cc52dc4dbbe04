//! Scenarios, runs, records, gates, reports and the command line.

pub mod calibration;
pub mod cli;
pub mod data;
mod imaging;
pub mod judgement;
pub mod network;
pub mod published;
pub mod report;
pub mod run;
pub mod scenario;
pub mod speeds;
pub mod store;
mod truth;
