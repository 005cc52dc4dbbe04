//! What a testfield looks like from its stations: outlines, truth, images, and where measuring starts in them.

use std::sync::{Arc, OnceLock};

use calibench_measure::Sought;
use calibench_model::camera::CameraModel;
use calibench_model::{Image, ObjectTarget, PixelPoint, Start, TargetKind};
use calibench_random::{Key, Purpose, stream};
use calibench_scenario::{Recognition, Scenario, ViewsSubject};
use calibench_synth::bound::Work;
use calibench_synth::raster::{Outlined, Picture};
use calibench_synth::sensor::Exposure;
use calibench_synth::stations::Station;
use calibench_synth::view::{TargetTruth, View, Visibility};
use rayon::prelude::*;

use crate::RunError;
use crate::bounded::TrialBounds;
use crate::bounds::BySet;
use crate::setups::{Setup, Setups};

/// What is the same in all trials.
pub struct Prepared<'a> {
    /// The scenario's subject.
    pub subject: &'a ViewsSubject,
    /// The views, in the order of the stations.
    pub views: Vec<PreparedView<'a>>,
    pub(super) setups: Arc<Setups>,
    /// Whether the light of views is kept: where it is the same in several trials.
    pub(super) keeps_light: bool,
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
    /// Where the lines of a field that is to be recognised meet: (column, row) from its top left corner, and the place, px; those in the frame.
    pub nodes: Vec<([usize; 2], PixelPoint)>,
    /// The bound of each target that is measured.
    pub(super) bounds: Vec<BySet>,
    pub(super) name: Arc<str>,
    setup: Arc<Setup>,
    light: OnceLock<Image<'static>>,
}

impl PreparedView<'_> {
    /// How far from a point its light falls, px.
    pub fn reach(&self) -> f64 {
        self.setup.imaging.optics.reach()
    }
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
        let setups = Setups::new(subject, stations, |_| Ok(None))?;
        Self::with(subject, stations, key, false, Arc::new(setups))
    }

    /// As [`Self::of`], with the lenses and sensors of the run, and the bounds of methods if they are wanted.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(super) fn with(
        subject: &'a ViewsSubject,
        stations: &'a [Station],
        key: Key<'_>,
        bounds: bool,
        setups: Arc<Setups>,
    ) -> Result<Self, RunError> {
        let local = subject.local_of(key)?;
        let view = |station: &'a Station| {
            let setup = setups.of(subject, station.own)?;
            let field = station.field(&subject.field);
            let view = View { field: &field, camera: &subject.camera, local: local.as_ref(), pose: &station.pose };
            let failed = |source| RunError::View { station: station.name.clone(), source };
            let seen = view.seen(setup.imaging.optics.reach()).map_err(failed)?;
            let (picture, truth) = (seen.picture().map_err(failed)?, seen.truth());
            let bounds = setup.bounds.as_ref().filter(|_| bounds).map(|bounds| (bounds, Outlined::of(&picture)));
            let bound = |work: &mut Work, (target, truth): (&ObjectTarget, &TargetTruth)| match (&bounds, truth.at) {
                // About the reference point turning a disc would be moving it.
                (Some((bounds, outlined)), Some(at)) if is_pointed_at(subject, truth) => {
                    bounds.of(outlined, target.kind, truth.ellipse.map_or(at, |ellipse| ellipse.centre), work)
                }
                _ => BySet::new(),
            };
            let bounds = subject.field.targets.par_iter().zip(&truth).map_init(Work::default, bound).collect();
            let nodes = subject.recognition.iter().flat_map(|plan| nodes(plan, &view)).collect();
            let name = station.name.as_str().into();
            Ok(PreparedView { station, picture, truth, nodes, bounds, name, setup, light: OnceLock::new() })
        };
        // The first station's error is the one that is said, whichever comes first.
        let views = stations.par_iter().map(view).collect::<Vec<_>>().into_iter().collect::<Result<Vec<_>, RunError>>()?;
        let targets = subject.field.targets.iter().map(|target| target.id.as_str().into()).collect();
        let sought = subject.sheet.and_then(|board| Sought::new(board).ok());
        Ok(Self { subject, views, setups, keeps_light: false, targets, sought })
    }

    /// The image of a view.
    ///
    /// # Errors
    /// A size that the image's format cannot hold.
    pub fn image(&self, view: &PreparedView<'_>, key: Key<'_>) -> Result<Exposure, RunError> {
        let (imaging, key) = (&view.setup.imaging, Key { view: &view.station.name, ..key });
        if self.keeps_light {
            return Ok(imaging.expose_light(view.light.get_or_init(|| self.irradiance(view)), key)?);
        }
        Ok(imaging.expose(&view.setup.renderer, &view.picture, key)?)
    }

    /// The image of a view before the sensor, without noise and without row jitter.
    pub fn irradiance(&self, view: &PreparedView<'_>) -> Image<'static> {
        view.setup.renderer.render(&view.picture, &[])
    }

    /// The bounds of what is seen in each view.
    pub(super) fn bounds(&self) -> TrialBounds {
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

/// Where the lines of the field meet in the frame of `view`.
fn nodes(plan: &Recognition, view: &View<'_>) -> Vec<([usize; 2], PixelPoint)> {
    let (Some(recogniser), [plate]) = (plan.recognisers.first(), view.field.plates.as_slice()) else { return Vec::new() };
    let size = view.camera.size();
    let within = |v: f64, side: u32| v >= 0.0 && v <= f64::from(side) - 1.0;
    let seen = |(node, at)| {
        let at = view.camera.project(view.pose.ray(&plate.point(at))).ok()?;
        let at = view.local.map_or(at, |local| local.displaced(at));
        (within(at.x, size.width) && within(at.y, size.height)).then_some((node, at))
    };
    recogniser.nodes().filter_map(seen).collect()
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
