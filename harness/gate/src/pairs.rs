//! The points of two runs side by side, by trial and target, for statistics.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::point_entry::Entry;
use super::table::MethodTable;

/// A point of both runs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    /// The place of its trial among all trials.
    pub trial: usize,
    /// The place of its target in [`Pairs::targets`].
    pub target: usize,
    /// What was blessed.
    pub old: Entry,
    /// What is now.
    pub new: Entry,
}

/// The points of two runs of one method.
#[derive(Clone, Debug, Default)]
pub(super) struct Pairs {
    /// How many trials: the units that are independent of each other.
    pub trials: usize,
    /// The names of the targets, as `view/target`.
    pub targets: Vec<String>,
    /// By trial.
    pub items: Vec<Item>,
}

impl Pairs {
    /// The points that both have. With `single`, every point is a unit of its own, for runs that are not repeated.
    pub fn of(base: &MethodTable, now: &MethodTable, single: bool) -> Self {
        let mut pairs = Self::default();
        let mut targets: BTreeMap<(Arc<str>, Arc<str>), usize> = BTreeMap::new();
        let mut last = None;
        for (place, old) in &base.points {
            let Some(new) = now.points.get(place) else { continue };
            if single || last != Some(place.trial) {
                pairs.trials += 1;
                last = Some(place.trial);
            }
            let next = pairs.targets.len();
            let target = *targets.entry((place.view.clone(), place.target.clone())).or_insert(next);
            if target == next {
                pairs.targets.push(format!("{}/{}", place.view, place.target));
            }
            pairs.items.push(Item { trial: pairs.trials - 1, target, old: *old, new: *new });
        }
        pairs
    }
}
