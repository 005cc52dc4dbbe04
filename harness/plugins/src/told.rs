//! What a method from outside leaves to be known of how its results came about.

use std::sync::{Mutex, PoisonError};

use calibench_model::{Told, escape};

/// How long one is, characters.
const LONGEST_TOLD: usize = 200;

/// Things that are told of one method: each once, and few.
#[derive(Debug, Default)]
pub struct Teller(Mutex<Told>);

impl Teller {
    /// Keeps something to be told.
    pub fn tell(&self, what: &str) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).join(&Told::said([short(what)]));
    }

    /// All of it.
    pub fn all(&self) -> Told {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// A text of others in a line: no command to a terminal, and not long.
pub(crate) fn short(text: &str) -> String {
    let text = escape::name(text.trim());
    let start: String = text.chars().take(LONGEST_TOLD).collect();
    if start.len() < text.len() { format!("{start}...") } else { start }
}
