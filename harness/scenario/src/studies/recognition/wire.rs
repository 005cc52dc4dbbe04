//! The `[recognition]` table as it is written.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

/// Recognition of a coded field in every image, from its design alone: measuring starts there, and what was recognised is counted against the truth.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecognitionWire {
    /// Who tells the shapes apart: `modern`, `contours`, or `contours_few`, whose table was learned on three sharp frontal images alone. Measuring starts
    /// from the first; all are counted.
    #[schemars(with = "Vec<String>")]
    pub classifiers: Spanned<Vec<Spanned<String>>>,
}

/// Images that are counted together.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImagesWire {
    /// What they are called in tables, as in "phi 30".
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// Patterns of stations' names, as in "12*".
    #[schemars(with = "Vec<String>")]
    pub images: Spanned<Vec<Spanned<String>>>,
}
