//! What a section is.

use calibench_records::theory::Theory;

use crate::load::theory::theory;
use crate::{Canvas, LoadError, Loaded};

/// The operator of the paper, whatever its settings.
pub const OPERATOR: &str = "harris_paraboloid";

/// A section and the picture that it shows.
pub type Part = (String, Option<(String, Canvas)>);

/// The first method of the scenario that is the paper's, and what theory says of it; `None` without such a method or such records.
///
/// # Errors
/// What [`theory`] returns.
pub fn theory_of(loaded: &Loaded) -> Result<Option<(&str, Vec<Theory>)>, LoadError> {
    let Some(label) = loaded.scenario.methods.iter().find(|label| label.starts_with(OPERATOR)) else { return Ok(None) };
    let mine: Vec<Theory> = theory(&loaded.folder)?.into_iter().filter(|theory| theory.method == *label).collect();
    Ok((!mine.is_empty()).then_some((label, mine)))
}
