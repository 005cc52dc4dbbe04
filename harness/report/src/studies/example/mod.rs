//! The worked example of CONTRIBUTING, linked from `examples/`.

mod section;
mod tests;
