//! The worked example of CONTRIBUTING, linked from `examples/`.

mod plan;
mod run;

pub use plan::Scale;
