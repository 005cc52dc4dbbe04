//! Scenarios, runs, records, gates, reports and the command line.

pub mod calibration;
pub mod cli;
pub mod data;
pub mod gate;
mod imaging;
pub mod judgement;
pub mod network;
pub mod published;
pub mod records;
pub mod report;
pub mod results;
pub mod run;
pub mod scenario;
pub mod score;
pub mod speeds;
pub mod store;
mod truth;
