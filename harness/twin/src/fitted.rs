//! The twin that looks like the photographs.

use crate::design::Design;
use crate::look::Look;

/// How often the twin is changed.
const ROUNDS: u64 = 5;

/// A twin and what it looks like.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// What it is made of.
    pub design: Design,
    /// What it looks like, with chance that had no part in finding it.
    pub look: Look,
}

/// The twin of photographs that look like `real`. `look_of` says what a design looks like under a number of its own for chance; `None` where nothing can be told.
///
/// # Errors
/// Those of `look_of`.
pub fn fitted<E>(real: &Look, mut look_of: impl FnMut(&Design, u64) -> Result<Option<Look>, E>) -> Result<Option<Fitted>, E> {
    let Some(mut design) = Design::first(real) else { return Ok(None) };
    let mut before: Option<(Design, Look)> = None;
    for round in 0..ROUNDS {
        let Some(look) = look_of(&design, round)? else { return Ok(None) };
        let next = design.nearer(real, &look, before.as_ref().map(|(design, look)| (design, look)));
        before = Some((std::mem::replace(&mut design, next), look));
    }
    Ok(look_of(&design, ROUNDS)?.map(|look| Fitted { design, look }))
}
