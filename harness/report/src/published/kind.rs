//! What kind of evidence a verdict is.

use schemars::JsonSchema;
use serde::Deserialize;

/// How our figure behind a printed one is obtained, from the least evidence to the most.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Put into ours, or ours was fitted to it: it comes out by construction, and is `not_comparable`.
    Input,
    /// Follows from printed figures or from definitions alone: a check of the print, or of our reading of it.
    Definition,
    /// Settings were searched, or read off a drawing, with the printed figures in sight.
    Reconstruction,
    /// Follows from other printed figures, to which ours was fitted or into which they were put; this one had no part in it.
    Consequence,
    /// Follows from what the paper says of its experiment alone, and was stated before it was compared.
    Prediction,
}

impl Kind {
    /// Those that are counted, the most evidence first.
    pub const COUNTED: [Self; 4] = [Self::Prediction, Self::Consequence, Self::Reconstruction, Self::Definition];

    /// In reports.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Input => "put in",
            Self::Definition => "definition or arithmetic",
            Self::Reconstruction => "reconstruction",
            Self::Consequence => "consequence",
            Self::Prediction => "prediction",
        }
    }
}
