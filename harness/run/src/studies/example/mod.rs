//! The worked example of CONTRIBUTING, linked from `examples/`.

pub mod plan;
mod run;
