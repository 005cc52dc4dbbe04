//! What of a run a file has nothing of.

/// Cases of one sort: how many, and the first of them, whichever thread came first.
#[derive(Debug, Default)]
pub struct Cases<T> {
    count: u64,
    first: Option<T>,
}

impl<T: Ord + Clone> Cases<T> {
    /// Adds `count` cases, of which this is the first.
    pub fn add(&mut self, count: u64, first: &T) {
        self.count += count;
        if self.first.as_ref().is_none_or(|earlier| first < earlier) {
            self.first = Some(first.clone());
        }
    }

    /// How many and the first, if there are any.
    pub fn said<S>(&self, say: impl FnOnce(u64, &T) -> S) -> Option<S> {
        self.first.as_ref().map(|first| say(self.count, first))
    }
}
