//! How long a program is borne with that does nothing in time.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// So many images may take too long before any is done in time.
const PATIENCE: usize = 5;

/// What is told with every image that took too long: the same words in whatever order images come, so that parts of a run tell what the whole tells.
pub const TOLD: &str = "time decides what is too slow, not the seed: other runs may have other rows; a program that is in time for none of its first 5 images is asked no more";

/// What is known of how fast a program is.
///
/// Which images it is asked for first is for threads and parts of runs to choose, and what is recorded of an image must not depend on that: so a program that was ever
/// in time is waited for at every image, and only one that never was is given up, as it would answer none of the others either.
#[derive(Debug, Default)]
pub struct Patience {
    slow: AtomicUsize,
    in_time: AtomicBool,
}

impl Patience {
    /// Whether it is asked no more.
    pub fn is_over(&self) -> bool {
        self.slow.load(Ordering::Relaxed) >= PATIENCE && !self.in_time.load(Ordering::Relaxed)
    }

    /// An image took too long, or it did not, whatever else came of it.
    pub fn image(&self, slow: bool) {
        if slow {
            self.slow.fetch_add(1, Ordering::Relaxed);
        } else {
            self.in_time.store(true, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_was_ever_in_time_is_always_asked() {
        let after = |images: &[bool]| {
            let patience = Patience::default();
            images.iter().for_each(|&slow| patience.image(slow));
            patience.is_over()
        };
        assert!(!after(&[]) && !after(&[true; 4]) && after(&[true; 5]) && after(&[true; 9]));
        assert!(!after(&[false, true, true, true, true, true]));
        // Asked by another thread meanwhile.
        assert!(!after(&[true, true, true, true, true, false]));
        assert!(TOLD.contains(&PATIENCE.to_string()));
    }

    #[test]
    fn what_is_told_is_not_cut_off() {
        let told = format!("{}: {TOLD}", calibench_model::Rejection::TooSlow.meaning());
        assert_eq!(crate::told::short(&told), told);
    }
}
