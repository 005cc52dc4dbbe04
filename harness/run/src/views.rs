//! Trials of a testfield that is seen from several stations.

use std::sync::Arc;

use calibench_model::Measurement;
use calibench_model::camera::CameraModel;
use calibench_random::Key;
use calibench_records::results::{Calibrated, PointResult, Trial};
use calibench_scenario::{Imaging, Study, ViewsSubject};

use super::bounded::TrialBounds;
use super::bounds::TargetBounds;
use super::prepared::{Prepared, kind_of, seen};
use super::viewed::run_views;
use super::{Plan, RunError};
use crate::made::Made;
use crate::setups::Setups;
use crate::studies::{self, network};

/// Pixels of light that are kept at most, 4 bytes each.
const MOST_LIGHT: usize = 50_000_000;

/// What bounds the methods of `plan` in images that the camera of `subject` takes with this lens and sensor.
fn bounds(plan: &Plan<'_>, subject: &ViewsSubject, imaging: &Imaging) -> Result<Option<TargetBounds>, RunError> {
    let size = subject.camera.size();
    let size = [size.width as usize, size.height as usize];
    Ok(TargetBounds::new(imaging, 0.0, size, plan.bound_windows(), plan.all_unknowns())?)
}

/// What makes the trials of views, with what is the same in all of them.
pub(crate) struct Trials<'a> {
    prepared: Prepared<'a>,
}

impl<'a> Trials<'a> {
    /// Those of `plan`.
    pub fn new(plan: &Plan<'_>, subject: &'a ViewsSubject) -> Result<Self, RunError> {
        // Drawn coordinates are those of no image.
        let drawn = subject.study.plan().drawn().is_some();
        let bounded = plan.bounds && !drawn;
        let setups = Setups::new(subject, &subject.stations, |imaging| if bounded { bounds(plan, subject, imaging) } else { Ok(None) })?;
        // What is drawn anew in each trial has its bounds there.
        let mut prepared = Prepared::with(subject, &subject.stations, plan.key(0), !subject.changes(), Arc::new(setups))?;
        let pixels = subject.camera.size().width as usize * subject.camera.size().height as usize;
        let fits = subject.stations.len().saturating_mul(pixels) <= MOST_LIGHT;
        prepared.keeps_light = plan.span().count() > 1 && fits && !drawn && !subject.changes() && subject.imaging.has_steady_light();
        Ok(Self { prepared })
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
        let kept = number == 0 || !matches!(subject.study, Study::Blocks(_)) || subject.keeps_points();
        made(&Prepared::with(subject, &subject.stations_of(key)?, key, kept, self.prepared.setups.clone())?)
    }

    /// The points of trial `number`, of which nothing is made.
    pub fn points(&self, plan: &Plan<'_>, number: u64) -> Result<Vec<PointResult>, RunError> {
        let key = plan.key(number);
        if !self.prepared.subject.changes() {
            return Ok(pointed(plan, &self.prepared, key)?.trial.points);
        }
        self.changed(plan, number, |prepared| Ok(pointed(plan, prepared, key)?.trial.points))
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

fn pointed(plan: &Plan<'_>, prepared: &Prepared<'_>, key: Key<'_>) -> Result<Made, RunError> {
    Ok(match prepared.subject.study.plan().drawn() {
        Some(sigmas) => draw_views(plan, prepared, sigmas, key).into(),
        None => run_views(plan, prepared, key)?,
    })
}

fn measured(plan: &Plan<'_>, prepared: &Prepared<'_>, key: Key<'_>) -> Result<Made, RunError> {
    let subject = prepared.subject;
    let mut made = pointed(plan, prepared, key)?;
    if subject.study.network().is_some() {
        made.counted.clear();
    }
    if !is_adjusted_apart(subject) {
        made.trial.calibrations = adjusted(plan, subject, &made.trial.points, key);
    }
    if key.trial > 0 && !subject.keeps_points() {
        made.trial.points.clear();
    }
    Ok(made)
}

/// Whether what is made of points is made apart from them: where all of them are kept.
pub(super) fn is_adjusted_apart(subject: &ViewsSubject) -> bool {
    subject.study.is_adjusted() && subject.keeps_points() && subject.study.plan().drawn().is_none()
}

/// What is made of the points of the trial of `key`: what is adjusted for the methods that `plan` asks for.
pub(super) fn adjusted(plan: &Plan<'_>, subject: &ViewsSubject, points: &[PointResult], key: Key<'_>) -> Vec<Calibrated> {
    studies::of(&subject.study, plan.tools).map_or_else(Vec::new, |study| study.adjust(subject, points, &plan.available(), key))
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
