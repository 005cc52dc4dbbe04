//! Targets that are scored together.

use calibench_records::score::Groups;
use calibench_scenario::{Scenario, Subject};

/// More targets than this are scored by kind.
pub const MOST_TARGETS: usize = 24;

/// The kinds of a testfield's targets, if there are too many to be listed one by one.
pub fn groups(scenario: &Scenario) -> Groups {
    match &scenario.subject {
        Subject::Views(views) if views.field.targets.len() > MOST_TARGETS => {
            views.field.targets.iter().map(|target| (target.id.as_str().into(), target.kind.name().into())).collect()
        }
        _ => Groups::new(),
    }
}
