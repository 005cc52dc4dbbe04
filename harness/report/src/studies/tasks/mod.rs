//! Cameras that measure: whether their intervals hold the truth.

mod section;
#[cfg(test)]
mod tests;

pub use section::Tasks;
