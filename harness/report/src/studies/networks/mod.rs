//! Free networks and rigs, held against the truth.

mod section;
#[cfg(test)]
mod tests;

pub use section::Networks;
