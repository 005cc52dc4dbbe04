//! What a method from outside leaves to be known of how its results came about.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use calibench_model::escape;

/// How many different things are told of one plug-in.
const MOST_TOLD: usize = 8;
/// How long one is, characters.
const LONGEST_TOLD: usize = 200;

/// Things that are told of one method: each once, and few.
#[derive(Debug, Default)]
pub struct Told(Mutex<BTreeSet<String>>);

impl Told {
    /// Keeps something to be told.
    pub fn tell(&self, what: &str) {
        let mut told = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        told.insert(short(what));
        // The first in order stay, whichever thread came first.
        while told.len() > MOST_TOLD {
            told.pop_last();
        }
    }

    /// All of it, in order.
    pub fn all(&self) -> Vec<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }
}

/// A text of others in a line: no command to a terminal, and not long.
pub(crate) fn short(text: &str) -> String {
    let text = escape::name(text.trim());
    let start: String = text.chars().take(LONGEST_TOLD).collect();
    if start.len() < text.len() { format!("{start}...") } else { start }
}
