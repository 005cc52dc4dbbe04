//! Tests that cross crates.

mod cli;
mod determinism;
mod diagnostics;
mod galo;
mod gate;
mod killed;
mod measure;
mod photographs;
mod project;
mod schema;
