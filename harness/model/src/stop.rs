//! Work that its user may end: loops that may be long ask at each turn whether they are to go on.
//!
//! A thread is told once, by [`heed`], whose wish it obeys; threads that were not told obey nobody, and to ask costs them nothing worth mention. Work that is ended
//! unwinds, as after a panic but without a word: half a result is never seen by anybody, and no function between has to hand the wish on.

use std::any::Any;
use std::cell::RefCell;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

thread_local! {
    static WISH: RefCell<Option<Arc<AtomicBool>>> = const { RefCell::new(None) };
}

/// What work that was ended unwinds with.
struct Ended;

/// From now on this thread ends what it does, at the next [`point`], while `wish` is true.
pub fn heed(wish: Arc<AtomicBool>) {
    WISH.set(Some(wish));
}

/// Ends the work here if its user wishes so.
pub fn point() {
    if WISH.with_borrow(|wish| wish.as_ref().is_some_and(|wish| wish.load(Ordering::Relaxed))) {
        resume_unwind(Box::new(Ended));
    }
}

/// Whether this is what work that was ended unwinds with, and no mistake of it.
pub fn is_end(payload: &(dyn Any + Send)) -> bool {
    payload.is::<Ended>()
}

#[cfg(test)]
mod tests {
    use std::thread;

    use super::*;

    #[test]
    fn a_thread_ends_at_the_wish_that_it_heeds_and_no_other() {
        let (mine, others) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicBool::new(true)));
        let turns = |wish: Option<Arc<AtomicBool>>, at: Option<u32>| {
            let mine = mine.clone();
            let work = move || {
                wish.into_iter().for_each(heed);
                (0..10_u32).for_each(|turn| {
                    point();
                    assert!(at.is_none_or(|at| turn <= at));
                    mine.store(at == Some(turn), Ordering::Relaxed);
                });
            };
            thread::spawn(work).join()
        };
        assert!(turns(None, None).is_ok() && turns(None, Some(9)).is_ok());
        mine.store(false, Ordering::Relaxed);
        assert!(turns(Some(mine.clone()), None).is_ok());
        let ended = turns(Some(mine.clone()), Some(3)).unwrap_err();
        assert!(is_end(&*ended));
        let at_once = turns(Some(others), None).unwrap_err();
        assert!(is_end(&*at_once) && !is_end(&"a mistake"));
    }
}
