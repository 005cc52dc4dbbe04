//! Theoretical precision (Eq. 14 to 18) beside the scatter of the noisy images.

use calibench_records::score::{Errors, Score, TargetScore};
use calibench_records::theory::{Sigmas, Theory};

use super::part::{Part, theory_of};
use crate::load::{LoadError, Loaded};
use crate::markdown::{MarkdownTable, fixed};
use crate::sweep::LoadedSweep;

/// Theory is of first order: the least noise of the sweep is what it is compared with.
const CELL: usize = 0;

const HEADER: [&str; 9] = [
    "image",
    "Eq. 11 as printed",
    "Eq. 11 corrected",
    "nine samples",
    "the same, samples uncorrelated",
    "actual scatter",
    "95 %",
    "theory / actual",
    "points",
];

/// The section on the theory of `images` beside the scatter of `noisy`, where the records hold both.
///
/// # Errors
/// Records that cannot be read.
pub(super) fn section(images: &Loaded, noisy: &LoadedSweep) -> Result<Option<Part>, LoadError> {
    let Some((label, all)) = theory_of(images)? else { return Ok(None) };
    let sigma = noisy.sweep.values(CELL).first().and_then(|value| value.number);
    let method = noisy.methods.iter().position(|method| method.name == label);
    let score = method.and_then(|method| noisy.score(CELL, method));
    let found = sigma.zip(score).map(|(sigma, score)| part(images, noisy, (label, &all), (sigma, score)));
    Ok(found)
}

fn part(images: &Loaded, noisy: &LoadedSweep, (label, all): (&str, &[Theory]), (sigma, score): (f64, &Score)) -> Part {
    let mut rows = MarkdownTable::new(&HEADER);
    let named = |theory: &&Theory| Some((theory.sigmas?, score.targets.iter().find(|target| *target.target == *theory.target)?));
    all.iter().filter_map(|theory| named(&theory)).for_each(|(sigmas, target)| rows.row(row(sigmas, sigma, target)));
    let text = format!(
        "## Theoretical against actual precision\n\nStandard deviation `sqrt(sigma_x^2 + sigma_y^2)` in px of the refined position at grey-value noise of {sigma} (fraction of full scale), `{}`. Theory is \
         propagated from the noise-free image of `{}`: white noise of the grey values to the covariance of the 3 x 3 strengths (the paper does not say which it takes), then Eq. 14 to 18. *As \
         printed* and *corrected* propagate the six samples of Eq. 11; *nine samples* is the solution that the method delivers, the fourth column the same with equal variances and no \
         correlation. The actual scatter is about each target's own mean, from the trials of `{}`; its interval is that of the squares. Bias is in neither: it is what Table I shows. Theory takes the strongest pixel of the image without noise; where noise makes another pixel the strongest, \
         the paraboloid is another one, and the scatter is wider than theory.\n\n{}\n",
        label,
        images.name,
        noisy.name,
        rows.render()
    );
    (text, None)
}

/// The cells of one target at grey-value noise `sigma`, fraction of full scale.
fn row(Sigmas { printed, corrected, nine, uncorrelated }: Sigmas, sigma: f64, target: &TargetScore) -> Vec<String> {
    let theory = [printed, corrected, nine, uncorrelated].map(|value| value * sigma);
    let actual = scatter(&target.whole);
    let mut cells = vec![format!("({})", target.target)];
    cells.extend(theory.iter().map(|value| fixed(*value, 4)));
    cells.extend([
        actual.map_or("none".into(), |(value, _)| fixed(value, 4)),
        actual.and_then(|(_, interval)| interval).map_or(String::new(), |(low, high)| format!("{} to {}", fixed(low, 4), fixed(high, 4))),
        actual.filter(|(value, _)| *value > 0.0).map_or(String::new(), |(value, _)| fixed(theory[2] / value, 2)),
        target.whole.dx.count().to_string(),
    ]);
    cells
}

/// The 2D scatter about the mean error of one target with its 95 % interval, px. The trials are independent and each has one such point.
fn scatter(errors: &Errors) -> Option<(f64, Option<(f64, f64)>)> {
    let value = errors.scatter()?;
    let bias = errors.dx.mean()?.powi(2) + errors.dy.mean()?.powi(2);
    // The variances of both axes follow from the standard errors of the means.
    let interval = errors.dx.standard_error().zip(errors.dy.standard_error()).map(|(x, y)| {
        let n = errors.dx.count() as f64;
        let (vx, vy) = (x * x * n, y * y * n);
        // For Gaussian errors, x and y taken as independent: the variance of a sum of two scaled chi squares.
        let deviation = (2.0 * (vx * vx + vy * vy) / (n - 1.0)).sqrt();
        let sum = vx + vy;
        ((sum - 1.96 * deviation).max(0.0).sqrt(), (sum + 1.96 * deviation).sqrt())
    });
    Some((value, interval.filter(|_| bias.is_finite())))
}
