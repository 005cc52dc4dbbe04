//! Scenarios, runs, records, gates, reports and the command line.

pub mod data;
pub mod gate;
pub mod records;
pub mod results;
pub mod run;
pub mod scenario;
