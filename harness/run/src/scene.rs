//! Trials of a rendered scene.

use std::sync::Arc;

use calibench_images::encode_png_densely;
use calibench_measure::ImageId;
use calibench_model::{Image, Scene, Start};
use calibench_random::{Key, Purpose, stream};
use calibench_records::names::kept_image_name;
use calibench_records::results::{PointResult, Trial};
use calibench_scenario::{Phase, Pixels, SceneSubject, Starts};
use calibench_synth::bound::Work;
use calibench_synth::draw;
use calibench_synth::noise::{add_grey_noise, quantise};
use calibench_synth::raster::{Outlined, Picture, Renderer};
use calibench_synth::sensor::{Clipped, Exposure};
use rand::RngExt;

use super::bounded::TrialBounds;
use super::bounds::{BySet, TargetBounds};
use super::{Plan, RunError};
use crate::measured::{Asked, Pictured};

/// The name of the only view.
pub const VIEW: &str = "image";

/// What makes the trials of a scene, with what is the same in all of them.
pub(super) struct Trials<'a> {
    subject: &'a SceneSubject,
    renderer: Renderer,
    bounds: Option<TargetBounds>,
    /// The light of the image, where it is the same in several trials.
    light: Option<Image<'static>>,
}

impl<'a> Trials<'a> {
    pub(super) fn new(plan: &Plan<'_>, subject: &'a SceneSubject) -> Result<Self, RunError> {
        let (scene, quantised) = (&subject.scene, subject.bits.map_or(0.0, |bits| ((1_u64 << bits) - 1) as f64));
        let rounding = if quantised > 0.0 { 1.0 / (12.0 * quantised * quantised) } else { 0.0 };
        let variance = subject.grey_noise * subject.grey_noise + rounding;
        let size = [scene.width, scene.height];
        // Drawn pixels are not what a lens makes: the bound is of another image.
        let bounds = match subject.pixels {
            Pixels::Area if plan.bounds => TargetBounds::new(&subject.imaging, variance, size, plan.bound_windows(), plan.all_unknowns())?,
            _ => None,
        };
        let renderer = subject.renderer()?;
        let still = subject.phase == Phase::Fixed && subject.pixels == Pixels::Area && subject.imaging.has_steady_light();
        let light = (plan.span().count() > 1 && still).then(|| renderer.render(&Picture::from(scene), &[]));
        Ok(Self { subject, renderer, bounds, light })
    }
}

pub(super) fn run_trial(plan: &Plan<'_>, trials: &Trials<'_>, number: u64) -> Result<Trial, RunError> {
    let Trials { subject, renderer, bounds, light } = trials;
    let (subject, bounds) = (*subject, bounds.as_ref());
    let key = Key { seed: plan.seed, of: &plan.scenario.drawn, trial: number, view: VIEW, target: "" };
    let truth = trial_truth(subject, key);
    let image = match light {
        Some(light) => spoiled(subject, subject.imaging.expose_light(light, key)?, key),
        None => trial_picture(subject, renderer, &truth, key)?,
    };
    let image = image.image;
    if let Some(folder) = plan.images.filter(|_| number == 0) {
        folder.write(&kept_image_name(VIEW), |file| encode_png_densely(file, &image, subject.is_deep()))?;
    }
    let starts = starts(subject, &image, &truth, key);
    let view: Arc<str> = VIEW.into();
    let targets: Vec<Arc<str>> = truth.targets.iter().map(|target| target.id.as_str().into()).collect();
    let by_target = by_target(bounds, &truth);
    let mut points = Vec::new();
    let asked = truth.targets.iter().zip(starts).map(|(target, start)| Asked { name: &target.id, kind: target.kind, start });
    let which = Some(ImageId { trial: number, view: VIEW });
    let shown = Pictured { which, image: &image, board: None };
    for (method, answers) in plan.measure(shown, &asked.collect::<Vec<_>>()) {
        let unknowns = plan.unknowns(method);
        for (((target, truth), by_set), result) in targets.iter().zip(&truth.targets).zip(&by_target).zip(answers.results) {
            let Some(result) = result else { continue };
            let bound = by_set.get(&unknowns).copied().flatten();
            points.push(PointResult { bound, ..PointResult::scored(view.clone(), target.clone(), method, truth.at, result) });
        }
    }
    Ok(Trial { number, points, ..Trial::default() })
}

/// The bounds of trial `number`.
pub(super) fn bounds(plan: &Plan<'_>, trials: &Trials<'_>, number: u64) -> TrialBounds {
    let truth = trial_truth(trials.subject, Key { view: VIEW, ..plan.key(number) });
    let all = truth.targets.iter().zip(by_target(trials.bounds.as_ref(), &truth));
    all.map(|(target, bounds)| (VIEW.into(), target.id.as_str().into(), bounds)).collect()
}

/// The bounds of each target.
fn by_target(bounds: Option<&TargetBounds>, truth: &Scene) -> Vec<BySet> {
    let Some(bounds) = bounds else { return vec![BySet::new(); truth.targets.len()] };
    let picture = Picture::from(truth);
    let (outlined, mut work) = (Outlined::of(&picture), Work::default());
    truth.targets.iter().map(|target| bounds.of(&outlined, target.kind, target.at, &mut work)).collect()
}

/// The scene of a trial, where its phase put it.
pub fn trial_truth(subject: &SceneSubject, key: Key<'_>) -> Scene {
    match subject.phase {
        Phase::Fixed => subject.scene.clone(),
        Phase::Uniform => {
            let mut rng = stream(key, Purpose::Phase);
            let (dx, dy) = (rng.random::<f64>() - 0.5, rng.random::<f64>() - 0.5);
            subject.scene.shifted(dx, dy)
        }
    }
}

/// The image of a trial, rendered, spoiled, quantised, and what was clipped where a sensor says so. `renderer` is that of the subject.
///
/// # Errors
/// A size that the image's format cannot hold.
pub fn trial_picture(subject: &SceneSubject, renderer: &Renderer, truth: &Scene, key: Key<'_>) -> Result<Exposure, RunError> {
    let exposure = match subject.pixels {
        Pixels::Area => subject.imaging.expose(renderer, &Picture::from(truth), key)?,
        Pixels::Centre => Exposure { image: draw(truth), clipped: Clipped::default() },
    };
    Ok(spoiled(subject, exposure, key))
}

/// What the noise and the levels of the scene make of an image.
fn spoiled(subject: &SceneSubject, mut exposure: Exposure, key: Key<'_>) -> Exposure {
    add_grey_noise(&mut exposure.image, subject.grey_noise, &mut stream(key, Purpose::GreyNoise));
    if let Some(bits) = subject.bits {
        quantise(&mut exposure.image, bits);
    }
    exposure
}

/// Where measuring starts in the image of a trial: of each target of `truth`, `None` where the scenario's detector misses it.
pub fn starts(subject: &SceneSubject, image: &Image, truth: &Scene, key: Key<'_>) -> Vec<Option<Start>> {
    let positions: Vec<_> = match &subject.starts {
        Starts::Detected(detector) => return detector.starts(image, truth.targets.iter().map(|target| target.at)),
        Starts::Given(positions) => positions.clone(),
        Starts::Pointed(hand) => {
            let point = |target: &calibench_model::SceneTarget| {
                hand.point(target.at, &mut stream(Key { target: &target.id, ..key }, Purpose::Pointing))
            };
            truth.targets.iter().map(point).collect()
        }
    };
    let with_kind = |(position, target): (_, &calibench_model::SceneTarget)| Some(Start { kind: Some(target.kind), ..Start::at(position) });
    positions.into_iter().zip(&truth.targets).map(with_kind).collect()
}
