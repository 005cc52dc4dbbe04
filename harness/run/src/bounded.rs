//! The bounds of a trial's points.

use std::collections::HashMap;
use std::sync::Arc;

use calibench_model::Unknowns;
use calibench_records::results::PointResult;

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
    /// Gives `points` their bounds, each for what its method leaves unknown; `unknowns` are those of a method, `None` of one that is not asked for.
    pub fn add_to(&self, points: &mut [PointResult], unknowns: impl Fn(usize) -> Option<Unknowns>) {
        for point in points {
            let Some(unknowns) = unknowns(point.method) else { continue };
            let bounds = self.0.get(&point.view).and_then(|targets| targets.get(&point.target));
            point.bound = bounds.and_then(|bounds| bounds.get(&unknowns).copied().flatten());
        }
    }
}
