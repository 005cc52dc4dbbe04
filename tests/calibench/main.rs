//! Tests that cross crates.

mod calibrate;
mod cameras;
mod cameras_of_tools;
mod cli;
mod covariance;
mod determinism;
mod diagnostics;
mod galo;
mod gate;
mod killed;
mod measure;
mod networks;
mod opencv_gate;
mod photographs;
mod project;
mod render;
mod schema;
mod sweeps;
