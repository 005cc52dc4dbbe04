//! Targets that are scored together, methods that are scored apart.

use std::collections::BTreeSet;

use calibench_records::description::{Description, is_limited};
use calibench_records::results::MethodInfo;
use calibench_records::score::Groups;

/// More targets than this are scored by kind.
pub const MOST_TARGETS: usize = 24;

/// The kinds of a testfield's targets, if there are too many to be listed one by one.
pub fn groups(scenario: &Description) -> Groups {
    match scenario.study.views() {
        Some(views) if views.targets.len() > MOST_TARGETS => {
            views.targets.iter().map(|target| (target.id.as_str().into(), target.kind.as_str().into())).collect()
        }
        _ => Groups::new(),
    }
}

/// The places of the methods that are limited to kinds of targets.
pub fn limited(methods: &[MethodInfo]) -> BTreeSet<usize> {
    methods.iter().enumerate().filter(|(_, method)| is_limited(&method.label)).map(|(place, _)| place).collect()
}
