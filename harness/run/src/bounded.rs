//! The bounds of a trial's points apart from measuring them: for points that are there already.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use calibench_records::results::PointResult;

use crate::bounds::BySet;
use crate::{Plan, RunError, scene, views};

/// What computes bounds, with what is the same in all trials.
pub(crate) enum Bounding<'a> {
    /// Nothing has any.
    Nothing,
    /// A scene, which may lie elsewhere in each trial.
    Scene(Box<scene::Prepared<'a>>),
    /// Views that are the same in all trials, with their bounds.
    Fixed(TrialBounds),
    /// Views that change.
    Views(Box<views::Trials<'a>>),
}

/// The bounds of a trial, by view and target.
#[derive(Clone, Default)]
pub(crate) struct TrialBounds(HashMap<Arc<str>, HashMap<Arc<str>, BySet>>);

impl<'a> Bounding<'a> {
    /// Of views.
    pub fn views(trials: views::Trials<'a>) -> Self {
        trials.fixed_bounds().map_or_else(|| Self::Views(Box::new(trials)), Self::Fixed)
    }

    /// Those of trial `number`.
    ///
    /// # Errors
    /// A view that cannot be pictured.
    pub fn of(&self, plan: &Plan<'_>, number: u64) -> Result<Cow<'_, TrialBounds>, RunError> {
        Ok(match self {
            Self::Nothing => Cow::Owned(TrialBounds::default()),
            Self::Scene(prepared) => Cow::Owned(scene::bounds(plan, prepared, number)),
            Self::Fixed(bounds) => Cow::Borrowed(bounds),
            Self::Views(trials) => Cow::Owned(trials.bounds(plan, number)?),
        })
    }
}

impl FromIterator<(Arc<str>, Arc<str>, BySet)> for TrialBounds {
    fn from_iter<I: IntoIterator<Item = (Arc<str>, Arc<str>, BySet)>>(all: I) -> Self {
        let mut found = Self::default();
        for (view, target, bounds) in all {
            found.0.entry(view).or_default().insert(target, bounds);
        }
        found
    }
}

impl TrialBounds {
    /// Gives those of `points` that are of a method that `plan` asks for their bounds.
    pub fn add_to(&self, points: &mut [PointResult], plan: &Plan<'_>) {
        for point in points.iter_mut().filter(|point| plan.asks_for(point.method)) {
            let bounds = self.0.get(&point.view).and_then(|targets| targets.get(&point.target));
            point.bound = bounds.and_then(|bounds| bounds.get(&plan.unknowns(point.method)).copied().flatten());
        }
    }
}
