//! Long tasks side by side, so that the serial end of one does not leave a processor idle.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Tasks at a time: each uses every thread of the pool while it can, so that two suffice; one where there is one thread.
pub fn lanes() -> usize {
    rayon::current_num_threads().min(2)
}

/// Does `each` for all items, at most `lanes` at a time, begun in their order. After a failure none is begun any more.
///
/// # Errors
/// The first failure in the order of the items.
pub fn side_by_side<T: Sync, R: Send, E: Send>(items: &[T], lanes: usize, each: impl Fn(&T) -> Result<R, E> + Sync) -> Result<Vec<R>, E> {
    let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::with_capacity(items.len())));
    let lane = || {
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(place) else { return };
            let result = each(item);
            if result.is_err() {
                next.store(items.len(), Ordering::Relaxed);
            }
            done.lock().unwrap_or_else(PoisonError::into_inner).push((place, result));
        }
    };
    // Threads outside of the pool, which they feed: within it, one that waits would begin a third task.
    std::thread::scope(|scope| {
        for _ in 1..lanes.min(items.len()) {
            scope.spawn(lane);
        }
        lane();
    });
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|(place, _)| *place);
    done.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_the_items_and_no_more_run_than_lanes() {
        for lanes in 1..4 {
            let (now, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
            let square = |item: &usize| {
                most.fetch_max(now.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                std::thread::sleep(std::time::Duration::from_millis((7 * item % 5) as u64));
                now.fetch_sub(1, Ordering::SeqCst);
                Ok::<_, ()>(item * item)
            };
            let items: Vec<usize> = (0..20).collect();
            assert_eq!(side_by_side(&items, lanes, square), Ok(items.iter().map(|item| item * item).collect()));
            assert!(most.into_inner() <= lanes);
        }
        assert_eq!(side_by_side(&[], 2, |(): &()| Ok::<(), ()>(())), Ok(Vec::new()));
    }

    #[test]
    fn two_lanes_are_two_at_a_time() {
        let (met, deadline) = (AtomicUsize::new(0), std::time::Instant::now() + std::time::Duration::from_secs(20));
        // Each waits until the other has begun.
        let meet = |(): &()| {
            met.fetch_add(1, Ordering::SeqCst);
            while met.load(Ordering::SeqCst) < 2 {
                if std::time::Instant::now() > deadline {
                    return Err("alone");
                }
                std::thread::yield_now();
            }
            Ok(())
        };
        assert_eq!(side_by_side(&[(), ()], 2, meet), Ok(vec![(), ()]));
    }

    #[test]
    fn after_a_failure_nothing_is_begun() {
        let begun = AtomicUsize::new(0);
        let fails = |item: &usize| {
            begun.fetch_add(1, Ordering::SeqCst);
            if *item == 3 { Err("the fourth") } else { Ok(*item) }
        };
        assert_eq!(side_by_side(&(0..9).collect::<Vec<_>>(), 1, fails), Err("the fourth"));
        assert_eq!(begun.into_inner(), 4);
        let both = |item: &usize| if *item < 2 { Err(*item) } else { Ok(()) };
        assert_eq!(side_by_side(&[1, 0], 1, both), Err(1), "the first of the items, not of the numbers");
    }
}
