//! The bounds of a trial's points.

use std::collections::HashMap;
use std::sync::Arc;

use calibench_records::results::PointResult;

use crate::Plan;
use crate::bounds::BySet;

/// The bounds of a trial, by view and target.
#[derive(Clone, Default)]
pub(crate) struct TrialBounds(HashMap<Arc<str>, HashMap<Arc<str>, BySet>>);

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
