//! Tests that cross crates.

mod atlas;
mod calibrate;
mod cameras;
mod cameras_of_tools;
mod cli;
mod covariance;
mod determinism;
mod diagnostics;
mod galo;
mod gate;
mod judge;
mod killed;
mod measure;
mod models;
mod networks;
mod opencv_gate;
mod operators;
mod orient;
mod photographs;
mod priors;
mod project;
mod render;
mod schema;
mod several;
mod sweeps;
mod zhu;
