//! Calibration systems that were told the same points.

mod section;
#[cfg(test)]
mod tests;

pub use section::Calibrators;
