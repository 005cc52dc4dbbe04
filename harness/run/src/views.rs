//! Trials of a testfield that is seen from several stations.

use std::sync::Arc;

use calibench_measure::Sought;
use calibench_model::camera::CameraModel;
use calibench_model::{Image, Measurement, ObjectTarget, PixelPoint, Start, TargetKind};
use calibench_random::{Key, Purpose, stream};
use calibench_records::results::{PointResult, Trial};
use calibench_scenario::{Blocks, Calibration, ViewsSubject};
use calibench_synth::bound::Work;
use calibench_synth::raster::{Outlined, Picture, Renderer};
use calibench_synth::sensor::Exposure;
use calibench_synth::stations::Station;
use calibench_synth::view::{TargetTruth, View, Visibility};
use rayon::prelude::*;

use super::bounds::{BySet, TargetBounds};
use super::viewed::run_views;
use super::{Plan, RunError};
use crate::network::Job;
use crate::{blocks, network};

/// What is the same in all trials.
pub struct Prepared<'a> {
    /// The scenario's subject.
    pub subject: &'a ViewsSubject,
    /// The views, in the order of the stations.
    pub views: Vec<PreparedView<'a>>,
    renderer: Arc<Renderer>,
    pub(super) targets: Vec<Arc<str>>,
    /// The board that is seen, if it is one.
    pub(super) sought: Option<Sought>,
}

/// A station's outlines and truth.
pub struct PreparedView<'a> {
    /// Where the camera stands.
    pub station: &'a Station,
    /// The outlines in the image.
    pub picture: Picture,
    /// The truth about each target of the field.
    pub truth: Vec<TargetTruth>,
    /// The bound of each target that is measured.
    pub(super) bounds: Vec<BySet>,
    pub(super) name: Arc<str>,
}

impl<'a> Prepared<'a> {
    /// Projects the field for the stations of all trials, or of the first, with the camera of the trial of `key`.
    ///
    /// # Errors
    /// A view that cannot be pictured, by the name of its station.
    pub fn new(subject: &'a ViewsSubject, key: Key<'_>) -> Result<Self, RunError> {
        Self::of(subject, &subject.stations, key)
    }

    /// As [`Self::new`], for other stations.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of(subject: &'a ViewsSubject, stations: &'a [Station], key: Key<'_>) -> Result<Self, RunError> {
        Self::with(subject, stations, key, None, renderer(subject)?)
    }

    /// As [`Self::of`], with the bounds of methods, by the `renderer` of the subject.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(super) fn with(
        subject: &'a ViewsSubject,
        stations: &'a [Station],
        key: Key<'_>,
        bounds: Option<&TargetBounds>,
        renderer: Arc<Renderer>,
    ) -> Result<Self, RunError> {
        let margin = subject.imaging.optics.reach();
        let local = subject.local_of(key)?;
        let view = |station: &'a Station| {
            let field = station.field(&subject.field);
            let view = View { field: &field, camera: &subject.camera, local: local.as_ref(), pose: &station.pose };
            let failed = |source| RunError::View { station: station.name.clone(), source };
            let seen = view.seen(margin).map_err(failed)?;
            let (picture, truth) = (seen.picture().map_err(failed)?, seen.truth());
            let bounds = bounds.map(|bounds| (bounds, Outlined::of(&picture)));
            let bound = |work: &mut Work, (target, truth): (&ObjectTarget, &TargetTruth)| match (&bounds, truth.at) {
                // About the reference point turning a disc would be moving it.
                (Some((bounds, outlined)), Some(at)) if is_pointed_at(subject, truth) => {
                    bounds.of(outlined, target.kind, truth.ellipse.map_or(at, |ellipse| ellipse.centre), work)
                }
                _ => BySet::new(),
            };
            let bounds = subject.field.targets.par_iter().zip(&truth).map_init(Work::default, bound).collect();
            Ok(PreparedView { station, picture, truth, bounds, name: station.name.as_str().into() })
        };
        // The first station's error is the one that is said, whichever comes first.
        let views = stations.par_iter().map(view).collect::<Vec<_>>().into_iter().collect::<Result<Vec<_>, RunError>>()?;
        let targets = subject.field.targets.iter().map(|target| target.id.as_str().into()).collect();
        let sought = subject.sheet.and_then(|board| Sought::new(board).ok());
        Ok(Self { subject, views, renderer, targets, sought })
    }

    /// The image of a view.
    ///
    /// # Errors
    /// A size that the image's format cannot hold.
    pub fn image(&self, view: &PreparedView<'_>, key: Key<'_>) -> Result<Exposure, RunError> {
        Ok(self.subject.imaging.expose(&self.renderer, &view.picture, Key { view: &view.station.name, ..key })?)
    }

    /// The image of a view before the sensor, without noise and without row jitter.
    pub fn irradiance(&self, view: &PreparedView<'_>) -> Image<'static> {
        self.renderer.render(&view.picture, &[])
    }

    /// Whether the image is kept with 16 bits.
    pub fn is_deep(&self) -> bool {
        self.subject.imaging.is_deep()
    }
}

/// Renders the images of `subject`, in all trials.
pub(super) fn renderer(subject: &ViewsSubject) -> Result<Arc<Renderer>, RunError> {
    let size = subject.camera.size();
    Ok(Arc::new(subject.imaging.renderer(size.width as usize, size.height as usize)?))
}

/// What bounds the methods of `plan` in the images of `subject`.
pub(super) fn bounds(plan: &Plan<'_>, subject: &ViewsSubject) -> Result<Option<TargetBounds>, RunError> {
    let size = subject.camera.size();
    let size = [size.width as usize, size.height as usize];
    Ok(TargetBounds::new(&subject.imaging, 0.0, size, plan.bound_windows(), plan.all_unknowns())?)
}

pub(super) fn run_trial(plan: &Plan<'_>, prepared: &Prepared<'_>, bounds: Option<&TargetBounds>, number: u64) -> Result<Trial, RunError> {
    let key = Key { seed: plan.seed, scenario: &plan.scenario.name, trial: number, view: "", target: "" };
    let subject = prepared.subject;
    if !subject.changes() {
        return run_prepared(plan, prepared, key);
    }
    // Of points that are not kept nobody asks for the bound.
    let bounds = bounds.filter(|_| number == 0 || subject.blocks.as_ref().is_none_or(|blocks| blocks.keep_points));
    run_prepared(plan, &Prepared::with(subject, &subject.stations_of(key)?, key, bounds, prepared.renderer.clone())?, key)
}

fn run_prepared(plan: &Plan<'_>, prepared: &Prepared<'_>, key: Key<'_>) -> Result<Trial, RunError> {
    let subject = prepared.subject;
    match (&subject.calibration, &subject.blocks) {
        (Some(calibration), _) => calibrated(plan, prepared, calibration, key),
        (None, Some(blocks)) => in_blocks(plan, prepared, blocks, key),
        (None, None) => {
            let mut trial = run_views(plan, prepared, key)?;
            if key.trial > 0 && subject.recognition.is_some() {
                // What is counted of all trials is in their figures.
                trial.points.clear();
            }
            Ok(trial)
        }
    }
}

/// A trial whose points go through the adjustment. Stations are the same in all of them.
fn calibrated(plan: &Plan<'_>, prepared: &Prepared<'_>, calibration: &Calibration, key: Key<'_>) -> Result<Trial, RunError> {
    let subject = prepared.subject;
    let mut trial = match &calibration.drawn {
        Some(sigmas) => draw_views(plan, prepared, sigmas, key),
        None => run_views(plan, prepared, key)?,
    };
    let ViewsSubject { camera, field, unit, stations, .. } = subject;
    let available = plan.available();
    let job = Job { calibration, field, unit: *unit, camera, stations };
    trial.calibrations = network::calibrate(&job, &trial.points, &available, key);
    if key.trial > 0 && !calibration.keep_points {
        trial.points.clear();
    }
    Ok(trial)
}

/// A trial whose points go through free networks.
fn in_blocks(plan: &Plan<'_>, prepared: &Prepared<'_>, blocks: &Blocks, key: Key<'_>) -> Result<Trial, RunError> {
    let subject = prepared.subject;
    let mut trial = run_views(plan, prepared, key)?;
    let available = plan.available();
    let job = blocks::Job { blocks, field: &subject.field, unit: subject.unit, stations: &subject.stations, key };
    let recognised = std::mem::replace(&mut trial.calibrations, blocks::adjust_blocks(&job, &trial.points, &available, key.trial == 0));
    trial.calibrations.extend(recognised);
    if key.trial > 0 && !blocks.keep_points {
        trial.points.clear();
    }
    Ok(trial)
}

/// Coordinates that are drawn from the truth: by the hand, or with the standard deviation that the scenario gives.
fn draw_views(plan: &Plan<'_>, prepared: &Prepared<'_>, sigmas: &[(String, Option<f64>)], key: Key<'_>) -> Trial {
    let mut by_method: Vec<Vec<PointResult>> = vec![Vec::new(); plan.methods.len()];
    for view in &prepared.views {
        let key = Key { view: &view.station.name, ..key };
        for point in seen(prepared, view, key) {
            let target = &prepared.targets[point.target];
            let kind = Some(kind_of(prepared, &point));
            let methods =
                plan.methods.iter().enumerate().filter(|(_, configured)| configured.operator.is_ok() && configured.measures(kind));
            for (method, configured) in methods {
                let measured = match sigmas.iter().find(|(label, _)| *label == configured.label) {
                    Some((label, Some(sigma))) => network::draw(point.truth, *sigma, label, Key { target, ..key }),
                    Some((_, None)) => Measurement { position: point.start.position, covariance: None },
                    // A method of the command line, of which the scenario says nothing.
                    None => continue,
                };
                by_method[method].push(PointResult::scored(view.name.clone(), target.clone(), method, point.truth, Ok(measured)));
            }
        }
    }
    Trial { number: key.trial, points: by_method.into_iter().flatten().collect(), ..Trial::default() }
}

/// The image of the first view in the first trial, and where measuring starts in it.
///
/// # Errors
/// A view that cannot be pictured, or an image that the sensor cannot write.
pub fn first_image(scenario: &str, seed: u64, subject: &ViewsSubject) -> Result<(Image<'static>, Vec<Start>), RunError> {
    let key = Key { seed, scenario, trial: 0, view: "", target: "" };
    let stations = subject.stations_of(key)?;
    let prepared = Prepared::of(subject, &stations, key)?;
    let Some(view) = prepared.views.first() else { return Err(RunError::NothingToRender) };
    let starts = seen(&prepared, view, Key { view: &view.station.name, ..key }).into_iter().map(|point| point.start).collect();
    Ok((prepared.image(view, key)?.image, starts))
}

/// Where measuring starts in `image`, that of `view`: of each target that is wholly in it and that the scenario's detector, if it has one, does not miss.
pub fn starts<'p>(prepared: &'p Prepared<'_>, view: &PreparedView<'_>, image: &Image, key: Key<'_>) -> Vec<(&'p str, Start)> {
    pointed(prepared, view, image, key).into_iter().filter_map(|(point, start)| Some((&*prepared.targets[point.target], start?))).collect()
}

pub(super) fn started(prepared: &Prepared<'_>, image: &Image, seen: &[Pointed]) -> Vec<Option<Start>> {
    match &prepared.subject.detector {
        Some(detector) => detector.starts(image, seen.iter().map(|point| (&*prepared.targets[point.target], point.truth))),
        None => seen.iter().map(|point| Some(point.start)).collect(),
    }
}

pub(super) fn kind_of(prepared: &Prepared<'_>, point: &Pointed) -> TargetKind {
    prepared.subject.field.targets[point.target].kind
}

/// A target that is pointed at in an image.
pub(crate) struct Pointed {
    /// Its place in the field.
    pub target: usize,
    /// Where it is, px.
    pub truth: PixelPoint,
    /// Where a hand points.
    pub start: Start,
}

/// The targets that are pointed at in `image`, that of `view`, with where measuring starts; `None` where nobody found it.
pub(crate) fn pointed(prepared: &Prepared<'_>, view: &PreparedView<'_>, image: &Image, key: Key<'_>) -> Vec<(Pointed, Option<Start>)> {
    let seen = seen(prepared, view, Key { view: &view.station.name, ..key });
    let starts = started(prepared, image, &seen);
    seen.into_iter().zip(starts).collect()
}

/// Whether somebody points at a target: it is wholly in view, or, where the scenario says so, its reference point is.
pub fn is_pointed_at(subject: &ViewsSubject, truth: &TargetTruth) -> bool {
    truth.visibility == Visibility::Visible || (subject.clipped && truth.visibility == Visibility::Clipped)
}

pub(super) fn seen(prepared: &Prepared<'_>, view: &PreparedView<'_>, key: Key<'_>) -> Vec<Pointed> {
    let targets = &prepared.subject.field.targets;
    let pointed_at = view.truth.iter().enumerate().filter(|(_, truth)| is_pointed_at(prepared.subject, truth));
    let point = |(index, truth): (usize, &TargetTruth)| {
        let target = &targets[index];
        let at = truth.at?;
        let (hand, mut rng) = (prepared.subject.hand, stream(Key { target: &target.id, ..key }, Purpose::Pointing));
        let pointed = hand.point(at, &mut rng);
        let affine = truth.affine.map(|map| hand.map.apply(map, &mut rng));
        let start = Start { kind: Some(target.kind), affine, ..Start::at(pointed) };
        Some(Pointed { target: index, truth: at, start })
    };
    pointed_at.filter_map(point).collect()
}
