//! The bounds of a trial's points apart from measuring them: for points that are there already.

use std::borrow::Cow;

use crate::bounded::TrialBounds;
use crate::{Plan, RunError, scene, views};

/// What computes bounds, with what is the same in all trials.
pub(crate) enum Bounding<'a> {
    /// Nothing has any.
    Nothing,
    /// A scene, which may lie elsewhere in each trial.
    Scene(Box<scene::Trials<'a>>),
    /// Views that are the same in all trials, with their bounds.
    Fixed(TrialBounds),
    /// Views that change.
    Views(Box<views::Trials<'a>>),
}

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
            Self::Scene(trials) => Cow::Owned(scene::bounds(plan, trials, number)),
            Self::Fixed(bounds) => Cow::Borrowed(bounds),
            Self::Views(trials) => Cow::Owned(trials.bounds(plan, number)?),
        })
    }
}
