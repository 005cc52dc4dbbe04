//! The twin that looks like the photographs.

use crate::design::Design;
use crate::look::{Figure, Look};

/// How often the twin is changed.
const ROUNDS: u64 = 7;

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
    let plain = fitted_from(real, Design::first(real, false), &mut look_of)?;
    let mosaic = fitted_from(real, Design::first(real, true), &mut look_of)?;
    Ok(match (plain, mosaic) {
        (Some(plain), Some(mosaic)) => Some(if mosaic.misfit(real) < plain.misfit(real) { mosaic } else { plain }),
        (plain, mosaic) => plain.or(mosaic),
    })
}

impl Fitted {
    /// How far the twin's look is from that of photographs, beside their scatter and a tenth of each figure: a number.
    fn misfit(&self, real: &Look) -> f64 {
        let apart = |(real, twin): (Option<Figure>, Option<Figure>)| {
            let (real, twin) = (real?, twin?);
            let sigma = real.sigma.hypot(twin.sigma).min(1.0).hypot(0.1 * real.value);
            Some(((real.value - twin.value) / sigma).powi(2))
        };
        let [straight, askew] = [0, 1].map(|k| (real.raggedness_by[k], self.look.raggedness_by[k]));
        [(real.correlation, self.look.correlation), (real.halo, self.look.halo), straight, askew].into_iter().filter_map(apart).sum()
    }
}

/// From one first design.
fn fitted_from<E>(
    real: &Look,
    first: Option<Design>,
    look_of: &mut impl FnMut(&Design, u64) -> Result<Option<Look>, E>,
) -> Result<Option<Fitted>, E> {
    let Some(mut design) = first else { return Ok(None) };
    let mut before: Option<(Design, Look)> = None;
    for round in 0..ROUNDS {
        let Some(look) = look_of(&design, round)? else { return Ok(None) };
        let next = design.nearer(real, &look, before.as_ref().map(|(design, look)| (design, look)));
        before = Some((std::mem::replace(&mut design, next), look));
    }
    Ok(look_of(&design, ROUNDS)?.map(|look| Fitted { design, look }))
}
