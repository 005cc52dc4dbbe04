//! The twin that looks like the photographs.

use std::ops::Range;

use crate::design::Design;
use crate::look::{Figure, Look};

/// How often each kind of twin is changed before the better one is chosen, and how often that one after it.
const ROUNDS: [u64; 2] = [3, 4];

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
    let mut kinds = Vec::new();
    for demosaiced in [false, true] {
        let Some(first) = Design::first(real, demosaiced) else { return Ok(None) };
        let Some(steps) = nearer(real, (Step { design: first, before: None }, true), 0..ROUNDS[0], &mut look_of)? else { return Ok(None) };
        kinds.push(steps);
    }
    let misfit = |step: &Step| step.before.as_ref().map_or(f64::INFINITY, |(_, look)| misfit(real, look));
    let Some(best) = kinds.into_iter().min_by(|a, b| misfit(a).total_cmp(&misfit(b))) else { return Ok(None) };
    let last = ROUNDS[0] + ROUNDS[1];
    let Some(Step { design, .. }) = nearer(real, (best, false), ROUNDS[0]..last, &mut look_of)? else { return Ok(None) };
    Ok(look_of(&design, last)?.map(|look| Fitted { design, look }))
}

/// A design, and the one before it with its look.
struct Step {
    design: Design,
    before: Option<(Design, Look)>,
}

/// How far the look of a twin is from that of photographs, beside their scatter and a tenth of each figure: a number.
fn misfit(real: &Look, twin: &Look) -> f64 {
    let apart = |(real, twin): (Option<Figure>, Option<Figure>)| {
        let (real, twin) = (real?, twin?);
        let sigma = real.sigma.hypot(twin.sigma).min(1.0).hypot(0.1 * real.value);
        Some(((real.value - twin.value) / sigma).powi(2))
    };
    let [straight, askew] = [0, 1].map(|k| (real.raggedness_by[k], twin.raggedness_by[k]));
    [(real.correlation, twin.correlation), (real.halo, twin.halo), straight, askew].into_iter().filter_map(apart).sum()
}

/// So many steps on, with printed edges that stay `straight` or not: which chain makes edges ragged is told before the print may; `None` where the twin shows nothing that can be looked at.
fn nearer<E>(
    real: &Look,
    (mut step, straight): (Step, bool),
    rounds: Range<u64>,
    look_of: &mut impl FnMut(&Design, u64) -> Result<Option<Look>, E>,
) -> Result<Option<Step>, E> {
    for round in rounds {
        let Some(look) = look_of(&step.design, round)? else { return Ok(None) };
        let mut next = step.design.nearer(real, &look, step.before.as_ref().map(|(design, look)| (design, look)));
        if straight {
            next.raggedness = 0.0;
        }
        step = Step { before: Some((step.design, look)), design: next };
    }
    Ok(Some(step))
}
