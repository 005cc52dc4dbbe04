//! Which pixels of a window belong to a target: those around its outline, as far as a fit predicts it, and away from what else is seen there.

use super::area::WIDEST;
use super::fit::{BLURS, Parameters, Work};
use super::mask::{Mask, Rule};
use super::planes::Derivatives;

/// Rows of bits, a pixel each, of the largest window.
pub(super) type Words = [u64; WIDEST];

/// By what factors the blur is widened to see which pixels are around an outline, those of the ground next to it and all that count, and the least coverage there
/// of those that are.
const AROUND: [f64; 2] = [1.5, 3.0];
const LEAST: f32 = 0.01;
/// Standard deviation of a uniform distribution over a pixel, px.
const PIXEL: f64 = 0.29;
/// The largest coverage, by the target, of a pixel at which something else can be seen while the outline is known roughly,
const APART: f32 = 0.02;
/// and after a fit without what stands beside it. There it must be seen by so much of the coverage more.
const NEAR: f32 = 0.6;
const TOLERANCE: f32 = 0.15;
/// From how many standard deviations of the noise on something is seen, and between which parts of the contrast that is.
const SEEN: f64 = 5.0;
const BOUNDS: (f64, f64) = (0.04, 0.5);
/// The part of the ground's pixels that lie closest together: most of the others may be something else.
const CLOSEST: f64 = 0.4;
/// A blur that is not sought may be wrong by this factor.
const UNKNOWN: f64 = 2.0;

/// What is known before pixels are chosen.
#[derive(Clone, Copy)]
pub(super) struct Known {
    /// The least blur, px, that spreads the outline.
    pub(super) blur: f64,
    /// Standard deviation of a grey value, if pixels of the target alone were fitted before: otherwise it is taken from the ground.
    pub(super) noise: Option<f64>,
    /// The blur is an unknown.
    pub(super) sought: bool,
}

/// Pixels that are chosen.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Chosen {
    pub(super) pixels: Words,
    /// The share of the target's outline that is in them.
    pub(super) outline: f32,
}

/// The pixels around the target's outline from which nothing else is seen; `None` if nothing else is seen in the window.
pub(super) fn choose(work: &mut Work, mask: &Mask, at: &Parameters, known: &Known) -> Option<Chosen> {
    work.planes.count_all();
    let [next, around] = AROUND.map(|factor| {
        let wide = Parameters { sigma: (factor * at.sigma.max(known.blur).hypot(PIXEL)).min(BLURS.1), ..*at };
        work.draw(mask, &wide, (Derivatives::None, Rule::Coarse));
        words(work, |_, coverage| coverage > LEAST)
    });
    let sigma = if known.sought { at.sigma } else { (UNKNOWN * at.sigma).min(BLURS.1) };
    work.draw(mask, &Parameters { sigma, ..*at }, (Derivatives::None, Rule::Coarse));
    let ground = Ground::of(work, &next)?;
    let contrast = own_level(work)? - ground.level;
    let seen = ((SEEN * known.noise.unwrap_or(ground.noise) / contrast.abs()).clamp(BOUNDS.0, BOUNDS.1) * contrast.abs()) as f32;
    let (level, contrast) = (ground.level as f32, contrast as f32);
    let (apart, more) = (if known.noise.is_some() && known.sought { NEAR } else { APART }, TOLERANCE * contrast.abs());
    let others = words(work, |grey, coverage| coverage < apart && (grey - level - contrast * coverage).abs() > seen + more * coverage);
    if others.iter().all(|word| *word == 0) {
        return None;
    }
    let shadow = widened(&others);
    let pixels = std::array::from_fn(|row| around[row] & !shadow[row]);
    Some(Chosen { pixels, outline: of_outline(work, &pixels) })
}

/// The share of the outline that lies in `pixels`: where they are covered in part.
fn of_outline(work: &Work, pixels: &Words) -> f32 {
    let (mut inside, mut all) = (0.0, f32::MIN_POSITIVE);
    for (word, (_, coverage)) in pixels.iter().zip(work.planes.rows()) {
        for (column, covered) in coverage.iter().enumerate() {
            let edge = covered * (1.0 - covered);
            all += edge;
            inside += if word >> column & 1 == 1 { edge } else { 0.0 };
        }
    }
    inside / all
}

/// The pixels of which something holds, by grey value and coverage.
fn words(work: &Work, holds: impl Fn(f32, f32) -> bool) -> Words {
    let mut words = [0; WIDEST];
    for (word, (grey, coverage)) in words.iter_mut().zip(work.planes.rows()) {
        let pixels = grey.iter().zip(coverage).enumerate();
        *word = pixels.fold(0, |word, (column, (grey, coverage))| word | u64::from(holds(*grey, *coverage)) << column);
    }
    words
}

/// The grey value of the target itself, as the mean where it covers most.
fn own_level(work: &Work) -> Option<f64> {
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
    /// The middle of the [`CLOSEST`] grey values around the target; `None` if there are too few.
    fn of(work: &Work, around: &Words) -> Option<Self> {
        let mut grey: Vec<f32> = Vec::new();
        for (word, (values, coverage)) in around.iter().zip(work.planes.rows()) {
            let pixels = values.iter().zip(coverage).enumerate();
            grey.extend(pixels.filter(|(column, (_, coverage))| word >> column & 1 == 1 && **coverage < APART).map(|(_, (grey, _))| *grey));
        }
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

/// With the eight pixels around each.
fn widened(words: &Words) -> Words {
    let across = words.map(|word| word << 1 | word | word >> 1);
    std::array::from_fn(|row| across[row.saturating_sub(1)..(row + 2).min(WIDEST)].iter().fold(0, |sum, word| sum | word))
}
