//! The worked example of CONTRIBUTING, linked from `examples/`.

mod plan;
mod read;
mod tests;

pub use plan::Scale;
