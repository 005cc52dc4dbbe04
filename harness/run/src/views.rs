//! Trials of a testfield that is seen from several stations.

use std::sync::{Arc, OnceLock};

use calibench_measure::Sought;
use calibench_model::camera::CameraModel;
use calibench_model::{Image, Measurement, ObjectTarget, PixelPoint, Start, TargetKind};
use calibench_random::{Key, Purpose, stream};
use calibench_records::results::{Calibrated, PointResult, Trial};
use calibench_scenario::{Scenario, ViewsSubject};
use calibench_synth::bound::Work;
use calibench_synth::raster::{Outlined, Picture, Renderer};
use calibench_synth::sensor::Exposure;
use calibench_synth::stations::Station;
use calibench_synth::view::{TargetTruth, View, Visibility};
use rayon::prelude::*;

use super::bounded::TrialBounds;
use super::bounds::{BySet, TargetBounds};
use super::viewed::run_views;
use super::{Plan, RunError};
use crate::made::Made;
use crate::network::Job;
use crate::{blocks, network};

/// Pixels of light that are kept at most, 4 bytes each.
const MOST_LIGHT: usize = 50_000_000;

/// What is the same in all trials.
pub struct Prepared<'a> {
    /// The scenario's subject.
    pub subject: &'a ViewsSubject,
    /// The views, in the order of the stations.
    pub views: Vec<PreparedView<'a>>,
    renderer: Arc<Renderer>,
    /// Whether the light of views is kept: where it is the same in several trials.
    keeps_light: bool,
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
    light: OnceLock<Image<'static>>,
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
            Ok(PreparedView { station, picture, truth, bounds, name: station.name.as_str().into(), light: OnceLock::new() })
        };
        // The first station's error is the one that is said, whichever comes first.
        let views = stations.par_iter().map(view).collect::<Vec<_>>().into_iter().collect::<Result<Vec<_>, RunError>>()?;
        let targets = subject.field.targets.iter().map(|target| target.id.as_str().into()).collect();
        let sought = subject.sheet.and_then(|board| Sought::new(board).ok());
        Ok(Self { subject, views, renderer, keeps_light: false, targets, sought })
    }

    /// The image of a view.
    ///
    /// # Errors
    /// A size that the image's format cannot hold.
    pub fn image(&self, view: &PreparedView<'_>, key: Key<'_>) -> Result<Exposure, RunError> {
        let (imaging, key) = (&self.subject.imaging, Key { view: &view.station.name, ..key });
        if self.keeps_light {
            return Ok(imaging.expose_light(view.light.get_or_init(|| self.irradiance(view)), key)?);
        }
        Ok(imaging.expose(&self.renderer, &view.picture, key)?)
    }

    /// The image of a view before the sensor, without noise and without row jitter.
    pub fn irradiance(&self, view: &PreparedView<'_>) -> Image<'static> {
        self.renderer.render(&view.picture, &[])
    }

    /// The bounds of what is seen in each view.
    fn bounds(&self) -> TrialBounds {
        let of = |view: &PreparedView<'_>| {
            let all = self.targets.iter().zip(&view.bounds).filter(|(_, bounds)| !bounds.is_empty());
            all.map(|(target, bounds)| (view.name.clone(), target.clone(), bounds.clone())).collect::<Vec<_>>()
        };
        self.views.iter().flat_map(of).collect()
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

/// What makes the trials of views, with what is the same in all of them.
pub(crate) struct Trials<'a> {
    prepared: Prepared<'a>,
    bounds: Option<TargetBounds>,
}

impl<'a> Trials<'a> {
    /// Those of `plan`.
    pub fn new(plan: &Plan<'_>, subject: &'a ViewsSubject) -> Result<Self, RunError> {
        // Drawn coordinates are those of no image.
        let drawn = subject.calibration.as_ref().is_some_and(|calibration| calibration.drawn.is_some());
        let bounds = if plan.bounds && !drawn { bounds(plan, subject)? } else { None };
        // What is drawn anew in each trial has its bounds there.
        let fixed = bounds.as_ref().filter(|_| !subject.changes());
        let mut prepared = Prepared::with(subject, &subject.stations, plan.key(0), fixed, renderer(subject)?)?;
        let pixels = subject.camera.size().width as usize * subject.camera.size().height as usize;
        let fits = subject.stations.len().saturating_mul(pixels) <= MOST_LIGHT;
        prepared.keeps_light = plan.span().count() > 1 && fits && !drawn && !subject.changes() && subject.imaging.has_steady_light();
        Ok(Self { prepared, bounds })
    }

    /// The bounds of all trials, where they are the same in all.
    pub fn fixed_bounds(&self) -> Option<TrialBounds> {
        (!self.prepared.subject.changes()).then(|| self.prepared.bounds())
    }

    /// The bounds of trial `number`.
    pub fn bounds(&self, plan: &Plan<'_>, number: u64) -> Result<TrialBounds, RunError> {
        self.changed(plan, number, |prepared| Ok(prepared.bounds()))
    }

    /// What `made` makes of what is to be seen in trial `number`, where that is another in each.
    fn changed<T>(&self, plan: &Plan<'_>, number: u64, made: impl FnOnce(&Prepared<'_>) -> Result<T, RunError>) -> Result<T, RunError> {
        let (key, subject) = (plan.key(number), self.prepared.subject);
        // Of points that are not kept nobody asks for the bound.
        let kept = number == 0 || subject.blocks.as_ref().is_none_or(|blocks| blocks.keep_points);
        let bounds = self.bounds.as_ref().filter(|_| kept);
        made(&Prepared::with(subject, &subject.stations_of(key)?, key, bounds, self.prepared.renderer.clone())?)
    }

    /// Measures trial `number`, and adjusts what is not adjusted apart.
    pub fn measured(&self, plan: &Plan<'_>, number: u64) -> Result<Made, RunError> {
        let (key, subject) = (plan.key(number), self.prepared.subject);
        if !subject.changes() {
            return measured(plan, &self.prepared, key);
        }
        self.changed(plan, number, |prepared| measured(plan, prepared, key))
    }
}

fn measured(plan: &Plan<'_>, prepared: &Prepared<'_>, key: Key<'_>) -> Result<Made, RunError> {
    let subject = prepared.subject;
    let drawn = subject.calibration.as_ref().and_then(|calibration| calibration.drawn.as_ref());
    let mut made = match drawn {
        Some(sigmas) => draw_views(plan, prepared, sigmas, key).into(),
        None => run_views(plan, prepared, key)?,
    };
    if subject.calibration.is_some() {
        made.counted.clear();
    }
    if !is_adjusted_apart(subject) {
        made.trial.calibrations = adjusted(plan, subject, &made.trial.points, key);
    }
    if key.trial > 0 && !keeps_points(subject) {
        made.trial.points.clear();
    }
    Ok(made)
}

/// Whether the points of all trials are kept, and not those of the first alone.
fn keeps_points(subject: &ViewsSubject) -> bool {
    match (&subject.calibration, &subject.blocks) {
        (Some(calibration), _) => calibration.keep_points,
        (None, Some(blocks)) => blocks.keep_points,
        // What is counted of all trials is in their figures.
        (None, None) => subject.recognition.is_none(),
    }
}

/// Whether what is made of points is made apart from them: where all of them are kept.
pub(super) fn is_adjusted_apart(subject: &ViewsSubject) -> bool {
    let is_drawn = subject.calibration.as_ref().is_some_and(|calibration| calibration.drawn.is_some());
    (subject.calibration.is_some() || subject.blocks.is_some()) && keeps_points(subject) && !is_drawn
}

/// What is made of the points of the trial of `key`: what is adjusted for the methods that `plan` asks for. Stations are the same in all trials.
pub(super) fn adjusted(plan: &Plan<'_>, subject: &ViewsSubject, points: &[PointResult], key: Key<'_>) -> Vec<Calibrated> {
    let ViewsSubject { camera, field, unit, stations, .. } = subject;
    match (&subject.calibration, &subject.blocks) {
        (Some(calibration), _) => {
            network::calibrate(&Job { calibration, field, unit: *unit, camera, stations }, points, &plan.available(), key)
        }
        (None, Some(blocks)) => {
            let job = blocks::Job { blocks, field, unit: *unit, stations, key };
            blocks::adjust_blocks(&job, points, &plan.available(), key.trial == 0)
        }
        (None, None) => Vec::new(),
    }
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
                plan.methods.iter().enumerate().filter(|(index, one)| one.operator.is_ok() && one.measures(kind) && plan.asks_for(*index));
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
pub fn first_image(scenario: &Scenario, subject: &ViewsSubject) -> Result<(Image<'static>, Vec<Start>), RunError> {
    let key = Key { seed: scenario.seed, of: &scenario.drawn, trial: 0, view: "", target: "" };
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
