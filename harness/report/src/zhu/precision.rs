//! Theoretical precision (Eq. 14 to 18) beside the scatter of the noisy images.

use calibench_measure::harris_paraboloid::HarrisParaboloid;
use calibench_measure::paraboloid::Weights;
use calibench_measure::paraboloid_precision::{Form, precision, white};
use calibench_measure::strength_noise::strength_covariance;
use calibench_model::{Image, PixelPoint, Start};
use calibench_records::score::Errors;

use super::part::{OPERATOR, Part};
use crate::load::Loaded;
use crate::markdown::{MarkdownTable, fixed};
use crate::scene_figures::targets;
use crate::sweep::LoadedSweep;

/// Theory is of first order: the least noise of the sweep is what it is compared with.
const CELL: usize = 0;

pub(super) fn section(images: &Loaded, noisy: &LoadedSweep) -> Option<Part> {
    let view = &images.first.points.first()?.view;
    let image = images.image(view)?;
    let configured = images.scenario.methods.iter().find(|method| method.label.starts_with(OPERATOR))?;
    let operator = HarrisParaboloid::of(&configured.settings);
    let sigma = noisy.sweep.values(CELL).first()?.number?;
    let method = noisy.methods.iter().position(|method| method.name == configured.label)?;
    let score = noisy.score(CELL, method)?;
    let weights = Weights::new(configured.settings.get("k"));
    let mut rows = MarkdownTable::new(&[
        "image",
        "Eq. 11 as printed",
        "Eq. 11 corrected",
        "nine samples",
        "the same, samples uncorrelated",
        "actual scatter",
        "95 %",
        "theory / actual",
        "points",
    ]);
    for (id, truth) in targets(images, view) {
        let Some(theory) = theory(&operator, weights, &image, truth, sigma) else { continue };
        let Some(target) = score.targets.iter().find(|target| *target.target == *id) else { continue };
        let actual = scatter(&target.whole);
        let mut cells = vec![format!("({id})")];
        cells.extend(theory.iter().map(|value| fixed(*value, 4)));
        cells.extend([
            actual.map_or("none".into(), |(value, _)| fixed(value, 4)),
            actual
                .and_then(|(_, interval)| interval)
                .map_or(String::new(), |(low, high)| format!("{} to {}", fixed(low, 4), fixed(high, 4))),
            actual.filter(|(value, _)| *value > 0.0).map_or(String::new(), |(value, _)| fixed(theory[2] / value, 2)),
            target.whole.dx.count().to_string(),
        ]);
        rows.row(cells);
    }
    let text = format!(
        "## Theoretical against actual precision\n\nStandard deviation `sqrt(sigma_x^2 + sigma_y^2)` in px of the refined position at grey-value noise of {sigma} (fraction of full scale), `{}`. Theory is \
         propagated from the noise-free image of `{}`: white noise of the grey values to the covariance of the 3 x 3 strengths (the paper does not say which it takes), then Eq. 14 to 18. *As \
         printed* and *corrected* propagate the six samples of Eq. 11; *nine samples* is the solution that the method delivers, the fourth column the same with equal variances and no \
         correlation. The actual scatter is about each target's own mean, from the trials of `{}`; its interval is that of the squares. Bias is in neither: it is what Table I shows. Theory takes the strongest pixel of the image without noise; where noise makes another pixel the strongest, \
         the paraboloid is another one, and the scatter is wider than theory.\n\n{}\n",
        configured.label,
        images.scenario.name,
        noisy.scenario.name,
        rows.render()
    );
    Some((text, None))
}

/// The theoretical standard deviation in four forms, px.
fn theory(operator: &HarrisParaboloid, weights: Weights, image: &Image, truth: PixelPoint, sigma: f64) -> Option<[f64; 4]> {
    let pixel = operator.strongest_pixel(image, &Start::at(truth)).ok()?;
    let f = operator.strengths_around(image, pixel, 1).ok()?.around(1, 1);
    let q_ff = strength_covariance(operator, image, pixel, sigma).ok()?;
    let mean = (0..9).map(|i| q_ff[i][i]).sum::<f64>() / 9.0;
    let of = |form, q_ff| Some(precision(form, &f, q_ff)?.sigma());
    Some([
        of(Form::Printed, &q_ff)?,
        of(Form::Corrected, &q_ff)?,
        of(Form::Adjusted(weights), &q_ff)?,
        of(Form::Adjusted(weights), &white(mean))?,
    ])
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
