//! Targets that are scored together.

use calibench_records::description::{Description, Subject};
use calibench_records::score::Groups;

/// More targets than this are scored by kind.
pub const MOST_TARGETS: usize = 24;

/// The kinds of a testfield's targets, if there are too many to be listed one by one.
pub fn groups(scenario: &Description) -> Groups {
    match &scenario.subject {
        Subject::Views(views) if views.targets.len() > MOST_TARGETS => {
            views.targets.iter().map(|target| (target.id.as_str().into(), target.kind.as_str().into())).collect()
        }
        _ => Groups::new(),
    }
}
