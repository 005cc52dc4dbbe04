//! What methods from outside leave to be known, said on standard error.

use calibench_measure::Configured;
use calibench_measure::registry::notes;
use calibench_run::Plan;
use calibench_run::league::absent;
use calibench_scenario::{Study, Subject};

/// Says the notes of methods after they have measured.
pub fn say_notes<'m>(methods: impl IntoIterator<Item = &'m Configured>) {
    for (name, note) in notes(methods) {
        say!("{name}: {note}");
    }
}

/// Says which calibrators of a scenario cannot be asked here, and why.
pub fn say_absent_calibrators(plan: &Plan<'_>) {
    let Subject::Views(views) = &plan.scenario.subject else { return };
    let Study::Calibrators(study) = &views.study else { return };
    for (name, why) in absent(study, plan.tools) {
        say!("{}: the calibrator `{name}` is unavailable: {why}", plan.scenario.name);
    }
}
