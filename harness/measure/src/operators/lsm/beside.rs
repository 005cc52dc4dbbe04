//! What stands beside a target does not count: the pixels that do are around its outline, as far as the fit predicts it, and away from what else is seen there.

use calibench_model::Rejection;

use super::fit::{Fitted, Limits, Parameters, Work};
use super::mask::{Mask, Rule};
use super::planes::Derivatives;

/// Rows of bits, a pixel each, of the largest window.
type Words = [u64; 48];

/// Choices of pixels, at most, each followed by a fit: after the last, nothing more is changed.
const ROUNDS: usize = 4;
/// By what factor the blur is widened to see which pixels are around an outline, and the least coverage there of those that are.
const AROUND: (f64, f32) = (1.5, 0.01);
/// Standard deviation of a uniform distribution over a pixel, px.
const PIXEL: f64 = 0.29;
/// The largest coverage, by the target, of a pixel at which something else can be seen.
const APART: f32 = 0.02;
/// From how many standard deviations of the noise on something is seen, and between which parts of the contrast that is.
const SEEN: f64 = 5.0;
const BOUNDS: (f64, f64) = (0.08, 0.5);
/// The part of the ground's pixels that lie closest together: most of the others may be something else.
const CLOSEST: f64 = 0.35;
/// A blur, px, under which a target is where it is within the errors of a start.
const ASTRAY: f64 = 1.2;

/// The least-squares fit from `begin` on; where more than noise is left in the window of a target that is whole in itself, over the pixels that belong to it.
///
/// # Errors
/// Those of [`Work::fit`].
pub(super) fn fit(work: &mut Work, mask: &Mask, begin: Parameters, limits: Limits) -> Result<Fitted, Rejection> {
    let whole = work.fit(mask, begin, limits);
    if mask.is_open() || whole.is_ok() && work.planes.structure_of_all().is_white() {
        return whole;
    }
    let (mut found, mut last) = (whole, None);
    for _ in 0..ROUNDS {
        let (at, noise, blur) = match &found {
            Ok(fitted) => (fitted.parameters, last.map(|_| fitted.noise), fitted.parameters.sigma),
            Err(_) if last.is_none() => (begin, None, ASTRAY.max(begin.sigma)),
            Err(_) => break,
        };
        let Some(pixels) = choose(work, mask, &Parameters { sigma: blur, ..at }, noise) else { break };
        if last == Some(pixels) {
            break;
        }
        work.planes.count_only(&pixels);
        found = if found.is_ok() { work.fit_again(mask, at, limits) } else { work.fit(mask, at, limits) };
        last = Some(pixels);
    }
    found
}

/// The pixels around the target's outline from which nothing else is seen; `None` if nothing else is seen in the window. Without a `noise`, its standard deviation
/// is taken from the ground.
fn choose(work: &mut Work, mask: &Mask, at: &Parameters, noise: Option<f64>) -> Option<Words> {
    work.planes.count_all();
    work.draw(mask, at, (Derivatives::None, Rule::Coarse));
    let ground = Ground::of(work)?;
    let inside = inside(work)?;
    let contrast = (inside - ground.level).abs();
    let noise = noise.unwrap_or(ground.noise) / contrast;
    let seen = (SEEN * noise).clamp(BOUNDS.0, BOUNDS.1) * contrast;
    let mut others = [0; 48];
    for (word, (grey, coverage)) in others.iter_mut().zip(work.planes.rows()) {
        for (column, (grey, coverage)) in grey.iter().zip(coverage).enumerate() {
            let other = *coverage < APART && (f64::from(*grey) - ground.level).abs() > seen;
            *word |= u64::from(other) << column;
        }
    }
    if others.iter().all(|word| *word == 0) {
        return None;
    }
    let shadow = widened(&others, if noise > 0.02 { 2 } else { 4 });
    let wide = Parameters { sigma: AROUND.0 * at.sigma.hypot(PIXEL), ..*at };
    work.draw(mask, &wide, (Derivatives::None, Rule::Coarse));
    let mut chosen = [0; 48];
    for ((word, shadow), (_, coverage)) in chosen.iter_mut().zip(shadow).zip(work.planes.rows()) {
        let around = coverage.iter().enumerate().fold(0, |word, (column, coverage)| word | u64::from(*coverage > AROUND.1) << column);
        *word = around & !shadow;
    }
    Some(chosen)
}

/// The grey value of the target itself, as the mean where it covers all.
fn inside(work: &Work) -> Option<f64> {
    let most = work.planes.rows().flat_map(|(_, coverage)| coverage).fold(0.0_f32, |most, c| most.max(*c));
    let (mut sum, mut count) = (0.0, 0.0);
    for (grey, coverage) in work.planes.rows() {
        for (grey, coverage) in grey.iter().zip(coverage) {
            if *coverage > 0.9 * most {
                sum += f64::from(*grey);
                count += 1.0;
            }
        }
    }
    (count > 0.0).then(|| sum / count)
}

/// What surrounds the target.
struct Ground {
    level: f64,
    /// Standard deviation of a pixel, or more.
    noise: f64,
}

impl Ground {
    /// The middle of the [`CLOSEST`] grey values apart from the target; `None` if there are too few.
    fn of(work: &Work) -> Option<Self> {
        let pixels = work.planes.rows().flat_map(|(grey, coverage)| grey.iter().zip(coverage));
        let mut grey: Vec<f32> = pixels.filter(|(_, coverage)| **coverage < APART).map(|(grey, _)| *grey).collect();
        grey.sort_unstable_by(f32::total_cmp);
        let count = (CLOSEST * grey.len() as f64).ceil() as usize;
        if count < 4 {
            return None;
        }
        let spread = |first: &usize| grey[first + count - 1] - grey[*first];
        let first = (0..=grey.len() - count).min_by(|a, b| spread(a).total_cmp(&spread(b)))?;
        let level = grey[first..first + count].iter().map(|g| f64::from(*g)).sum::<f64>() / count as f64;
        Some(Self { level, noise: f64::from(spread(&first)) })
    }
}

/// With the pixels up to a distance, of this square, away.
fn widened(words: &Words, square: i32) -> Words {
    let mut wide = [0; 48];
    for (row, to) in wide.iter_mut().enumerate() {
        for down in -2_i32..=2 {
            let Some(word) = usize::try_from(row as i32 + down).ok().and_then(|row| words.get(row)) else { continue };
            for across in 0_i32..=2 {
                if across * across + down * down <= square {
                    *to |= word << across | word >> across;
                }
            }
        }
    }
    wide
}
