//! What a section is.

use crate::Canvas;

/// The operator of the paper, whatever its settings.
pub const OPERATOR: &str = "harris_paraboloid";

/// A section and the picture that it shows.
pub type Part = (String, Option<(String, Canvas)>);
