//! What methods from outside leave to be known, said on standard error.

use calibench_measure::Configured;

/// Says the notes of methods, each once, after they have measured.
pub fn say_notes<'m>(methods: impl IntoIterator<Item = &'m Configured>) {
    let mut said: Vec<String> = Vec::new();
    for method in methods {
        let notes = method.operator.as_ref().map_or_else(|_| Vec::new(), |operator| operator.notes());
        let name = method.label.split(':').next().unwrap_or(&method.label);
        for note in notes.into_iter().map(|note| format!("{name}: {note}")) {
            if !said.contains(&note) {
                say!("{note}");
                said.push(note);
            }
        }
    }
}
