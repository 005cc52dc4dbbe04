//! What stands beside a target does not count: the pixels that do are around its outline, as far as the fit predicts it, and away from what else is seen there.

use calibench_model::{Image, Rejection};

use super::area::WIDEST;
use super::fit::{Fitted, Limits, Parameters, Work};
use super::mask::{Mask, Rule};
use super::planes::Derivatives;
use super::start::inside;

/// Rows of bits, a pixel each, of the largest window.
type Words = [u64; WIDEST];

/// Choices of pixels, at most, each followed by a fit: after the last, nothing more is changed.
const ROUNDS: usize = 6;
/// The window follows what is further than this from its middle pixel, px.
const BEYOND: f64 = 0.6;
/// By what factor the blur is widened to see which pixels are around an outline, and the least coverage there of those that are.
const AROUND: (f64, f32) = (1.5, 0.01);
/// Standard deviation of a uniform distribution over a pixel, px.
const PIXEL: f64 = 0.29;
/// The largest coverage, by the target, of a pixel at which something else can be seen: around what is only roughly known, and around what was fitted without
/// what stands beside it. There, what is seen must be more by this part of the coverage.
const APART: f32 = 0.02;
const NEAR: f32 = 0.6;
const TOLERANCE: f32 = 0.15;
/// From how many standard deviations of the noise on something is seen, and between which parts of the contrast that is.
const SEEN: f64 = 5.0;
const BOUNDS: (f64, f64) = (0.04, 0.5);
/// The part of the ground's pixels that lie closest together: most of the others may be something else.
const CLOSEST: f64 = 0.4;
/// How far a fit may be from its start to be believed where something stands beside the target: px, and a factor of its area.
const FAR: (f64, f64) = (2.0, 2.5);
/// The blur may be less than its start by this factor: a fit beside something else may make it too small.
const SHARPER: f64 = 0.8;
/// A blur that is not sought may be wrong by this factor.
const UNKNOWN: f64 = 2.0;
/// A blur, px, under which a target is where it is within the errors of a start.
const ASTRAY: f64 = 1.2;

/// A window in an image.
pub(super) struct Laid<'a> {
    /// The image.
    pub(super) image: &'a Image,
    /// The window's middle pixel.
    pub(super) centre: (i64, i64),
    /// Half its width, px.
    pub(super) half: i64,
}

impl Laid<'_> {
    /// Lays the window around the pose, where that is not in its middle; whether it did.
    fn follow(&mut self, work: &mut Work, at: &mut Parameters) -> bool {
        let off = at.pose.at.map(|p| p - self.half as f64);
        if off.iter().all(|d| d.abs() < BEYOND) {
            return false;
        }
        let (x, y) = self.centre;
        let Some(next) = inside(self.image, (x + off[0].round() as i64, y + off[1].round() as i64), self.half) else { return false };
        if next == self.centre {
            return false;
        }
        if work.observe(self.image, next, self.half).is_err() {
            // Not all of the next window is numbers: the old one again, in which they were.
            return work.observe(self.image, self.centre, self.half).is_err();
        }
        self.centre = next;
        at.pose.at = [at.pose.at[0] - (next.0 - x) as f64, at.pose.at[1] - (next.1 - y) as f64];
        true
    }
}

/// The least-squares fit from `begin` on. Where more than noise is left in the window of a target that is whole in itself, the window is laid around what is found,
/// and the fit goes on over the pixels that belong to the target.
///
/// # Errors
/// Those of [`Work::fit`].
pub(super) fn fit(work: &mut Work, mask: &Mask, begin: Parameters, limits: Limits, laid: &mut Laid<'_>) -> Result<Fitted, Rejection> {
    let whole = work.fit(mask, begin, limits);
    if mask.is_open() || whole.is_ok() && work.planes.structure_of_all().is_white() {
        return whole;
    }
    // Where much else is in the window, the fit may have gone anywhere.
    let whole = whole.and_then(|fitted| if fitted.parameters.is_near(&begin) { Ok(fitted) } else { Err(Rejection::NotConverged) });
    let (mut found, mut counted, mut least) = (whole, None, f64::INFINITY);
    for _ in 0..ROUNDS {
        let next = match found {
            Ok(Fitted { mut parameters, noise, .. }) => {
                let first = counted.is_none();
                if first {
                    parameters.sigma = if limits.blur { parameters.sigma.max(SHARPER * begin.sigma) } else { begin.sigma };
                } else {
                    // A fit over pixels that do not all belong to the target leaves more than noise.
                    least = noise.min(least);
                }
                let known = Known { blur: SHARPER * begin.sigma, noise: (!first).then_some(least), sought: limits.blur };
                let mut pixels = choose(work, mask, &parameters, &known);
                if first && pixels.is_none() {
                    work.count(None);
                    return work.fit(mask, begin, limits);
                }
                let followed = laid.follow(work, &mut parameters);
                if followed {
                    pixels = choose(work, mask, &parameters, &known);
                }
                if !followed && counted == pixels {
                    break;
                }
                work.count(pixels.as_ref());
                (pixels, again(work, mask, parameters, limits, Work::fit_again))
            }
            Err(_) if counted.is_none() => {
                let pixels = choose(work, mask, &Parameters { sigma: ASTRAY.max(begin.sigma), ..begin }, &Known { blur: SHARPER * begin.sigma, noise: None, sought: limits.blur });
                if pixels.is_none() {
                    break;
                }
                work.count(pixels.as_ref());
                (pixels, again(work, mask, begin, limits, Work::fit))
            }
            Err(_) => break,
        };
        (counted, found) = next;
    }
    found
}

impl Parameters {
    /// Whether these are within the errors of a start.
    fn is_near(&self, start: &Self) -> bool {
        let [dx, dy] = [0, 1].map(|i| self.pose.at[i] - start.pose.at[i]);
        let determinant = |of: &Self| of.pose.affine.axx * of.pose.affine.ayy - of.pose.affine.axy * of.pose.affine.ayx;
        dx.hypot(dy) < FAR.0 && (determinant(self) / determinant(start)).ln().abs() < FAR.1.ln()
    }
}

/// A fit over what is left of the pixels: where these do not tell the blur, it stays as it is.
fn again(
    work: &mut Work,
    mask: &Mask,
    begin: Parameters,
    limits: Limits,
    fit: fn(&mut Work, &Mask, Parameters, Limits) -> Result<Fitted, Rejection>,
) -> Result<Fitted, Rejection> {
    match fit(work, mask, begin, limits) {
        Err(_) if limits.blur => fit(work, mask, begin, Limits { blur: false, ..limits }),
        found => found,
    }
}

/// What is known before pixels are chosen.
struct Known {
    /// The least blur, px, that spreads the outline.
    blur: f64,
    /// Standard deviation of a grey value, if pixels of the target alone were fitted before: otherwise it is taken from the ground.
    noise: Option<f64>,
    /// The blur is an unknown.
    sought: bool,
}

/// The pixels around the target's outline from which nothing else is seen; `None` if nothing else is seen in the window.
fn choose(work: &mut Work, mask: &Mask, at: &Parameters, known: &Known) -> Option<Words> {
    work.planes.count_all();
    let wide = Parameters { sigma: AROUND.0 * at.sigma.max(known.blur).hypot(PIXEL), ..*at };
    work.draw(mask, &wide, (Derivatives::None, Rule::Coarse));
    let around = words(work, |_, coverage| coverage > AROUND.1);
    let sigma = if known.sought { at.sigma } else { UNKNOWN * at.sigma };
    work.draw(mask, &Parameters { sigma, ..*at }, (Derivatives::None, Rule::Coarse));
    let ground = Ground::of(work, &around)?;
    let contrast = own_level(work)? - ground.level;
    let seen = ((SEEN * known.noise.unwrap_or(ground.noise) / contrast.abs()).clamp(BOUNDS.0, BOUNDS.1) * contrast.abs()) as f32;
    let (level, contrast) = (ground.level as f32, contrast as f32);
    let (apart, more) = (if known.noise.is_some() && known.sought { NEAR } else { APART }, TOLERANCE * contrast.abs());
    let others = words(work, |grey, coverage| coverage < apart && (grey - level - contrast * coverage).abs() > seen + more * coverage);
    if others.iter().all(|word| *word == 0) {
        return None;
    }
    let shadow = widened(&others);
    Some(std::array::from_fn(|row| around[row] & !shadow[row]))
}

/// The pixels of which this holds, by grey value and coverage.
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
