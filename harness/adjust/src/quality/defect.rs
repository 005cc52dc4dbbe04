//! What the network does not determine.

use std::fmt;

/// What the network does not determine.
#[derive(Clone, Debug, PartialEq)]
pub struct Defect {
    /// In words.
    pub message: String,
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}
