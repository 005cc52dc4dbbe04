//! What methods from outside leave to be known, said on standard error.

use calibench_measure::Configured;
use calibench_measure::registry::notes;

/// Says the notes of methods after they have measured.
pub fn say_notes<'m>(methods: impl IntoIterator<Item = &'m Configured>) {
    for (name, note) in notes(methods) {
        say!("{name}: {note}");
    }
}
