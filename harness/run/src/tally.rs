//! The store of a run, and what of it was there.

use std::io;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use calibench_store::Store;

/// A store, and what is to be known of it.
#[derive(Clone, Copy)]
pub struct Reuse<'a> {
    /// Where results are.
    pub store: &'a Store,
    /// A digest of all code that has none of its own: of the program, or of what it has beside calibench's crates.
    pub program: &'a str,
    /// What was found there, and what was not.
    pub tally: &'a Tally,
}

/// Results of methods in scenarios and cells: how many were in the store, and how many were computed.
#[derive(Debug, Default)]
pub struct Tally {
    found: AtomicUsize,
    computed: AtomicUsize,
    unchanged: AtomicUsize,
    refused: Mutex<Option<String>>,
}

impl Tally {
    /// How many were in the store.
    pub fn found(&self) -> usize {
        self.found.load(Ordering::Relaxed)
    }

    /// How many were computed.
    pub fn computed(&self) -> usize {
        self.computed.load(Ordering::Relaxed)
    }

    /// Why something was computed and could not be put into the store, if so.
    pub fn refused(&self) -> Option<String> {
        self.refused.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// How many runs had nothing to do: their records are as they would write them.
    pub fn unchanged(&self) -> usize {
        self.unchanged.load(Ordering::Relaxed)
    }

    /// Counts a run that has nothing to do.
    pub(crate) fn leave(&self) {
        self.unchanged.fetch_add(1, Ordering::Relaxed);
    }

    /// Counts one of each that is computed, or found.
    pub(crate) fn count(&self, computed: usize, found: usize) {
        self.computed.fetch_add(computed, Ordering::Relaxed);
        self.found.fetch_add(found, Ordering::Relaxed);
    }

    /// What `result` gives; what stands in the way is kept, and costs no more than the entry.
    pub(crate) fn unless_refused<T>(&self, result: io::Result<T>) -> Option<T> {
        let why = match result {
            Ok(value) => return Some(value),
            Err(why) => why,
        };
        self.refused.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(why.to_string());
        None
    }
}
