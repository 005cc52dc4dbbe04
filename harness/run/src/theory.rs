//! What theory says of the operator of Zhu, Wu & Wan on a scene without noise, beside its records.

use calibench_images::read_photo;
use calibench_measure::Configured;
use calibench_measure::harris_paraboloid::HarrisParaboloid;
use calibench_measure::paraboloid::{Paraboloid, Weights};
use calibench_measure::paraboloid_precision::{Form, precision, white};
use calibench_measure::strength_noise::strength_covariance;
use calibench_model::{Image, PixelPoint, SceneTarget, Start};
use calibench_random::Key;
use calibench_records::description::operator;
use calibench_records::names::kept_image;
use calibench_records::points::RunInfo;
use calibench_records::theory::{HALF, Sigmas, Strengths, THEORY, Theory, write};
use calibench_scenario::Subject;

use crate::{Plan, RunError, VIEW, trial_truth};

/// The operator whose theory is known.
const OPERATOR: &str = "harris_paraboloid";

/// Writes what theory says of the operator at every target of the kept image, if the scene has nothing random in it: theory is of first order and starts
/// from an image without noise.
///
/// # Errors
/// An image that cannot be read again, and what the file system refuses.
pub fn write_theory(plan: &Plan<'_>, run: &RunInfo) -> Result<(), RunError> {
    let (Subject::Scene(subject), Some(folder)) = (&plan.scenario.subject, plan.images) else { return Ok(()) };
    let methods: Vec<&Configured> = plan.methods.iter().filter(|method| operator(&method.label) == OPERATOR).collect();
    if methods.is_empty() || !plan.scenario.is_deterministic() || !plan.span().holds(0) {
        return Ok(());
    }
    let image = read_photo(&kept_image(folder.path(), VIEW))?.image;
    let truth = trial_truth(subject, Key { seed: plan.seed, of: &plan.scenario.drawn, trial: 0, view: VIEW, target: "" });
    let pairs = methods
        .iter()
        .flat_map(|method| truth.targets.iter().filter(|target| method.measures(Some(target.kind))).map(move |target| (method, target)));
    let all: Vec<Theory> = pairs.map(|(method, target)| theory(method, target, &image)).collect();
    Ok(folder.write(THEORY, |file| write(file, run, &all))?)
}

fn theory(method: &Configured, target: &SceneTarget, image: &Image) -> Theory {
    let (of, weights) = (HarrisParaboloid::of(&method.settings), method.settings.get("k"));
    let none = Theory { method: method.label.clone(), target: target.id.clone(), strengths: None, sigmas: None };
    let Ok(pixel) = of.strongest_pixel(image, &Start::at(target.at)) else { return none };
    Theory { strengths: strengths(&of, weights, image, pixel), sigmas: sigmas(&of, Weights::new(weights), image, pixel), ..none }
}

/// The strengths around the strongest pixel, `k` being that of the paraboloid's weights.
fn strengths(operator: &HarrisParaboloid, k: f64, image: &Image, pixel: (i64, i64)) -> Option<Strengths> {
    let found = operator.strengths_around(image, pixel, HALF).ok()?;
    let peak = Paraboloid::fit(&found.around(HALF, HALF), k).maximum();
    let maximum = peak.map(|(dx, dy)| PixelPoint::new(pixel.0 as f64 + dx, pixel.1 as f64 + dy));
    Some(Strengths { pixel, values: std::array::from_fn(|row| std::array::from_fn(|column| found.at(column, row))), maximum })
}

/// Theoretical standard deviations in four forms, px for white noise of the grey values with a standard deviation of 1 (full scale).
///
/// Source: Zhu et al. 2007, Eq. 14 to 18.
fn sigmas(operator: &HarrisParaboloid, weights: Weights, image: &Image, pixel: (i64, i64)) -> Option<Sigmas> {
    let f = operator.strengths_around(image, pixel, 1).ok()?.around(1, 1);
    let q_ff = strength_covariance(operator, image, pixel, 1.0).ok()?;
    let mean = (0..9).map(|i| q_ff[i][i]).sum::<f64>() / 9.0;
    let of = |form, q_ff| Some(precision(form, &f, q_ff)?.sigma());
    Some(Sigmas {
        printed: of(Form::Printed, &q_ff)?,
        corrected: of(Form::Corrected, &q_ff)?,
        nine: of(Form::Adjusted(weights), &q_ff)?,
        uncorrelated: of(Form::Adjusted(weights), &white(mean))?,
    })
}
