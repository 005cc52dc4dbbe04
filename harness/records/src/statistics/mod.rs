//! Tests, and sums over trials.

pub mod holm;
pub mod paired;
pub mod running;

pub use holm::holm;
pub use paired::paired_t;
