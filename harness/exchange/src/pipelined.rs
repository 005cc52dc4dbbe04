//! Pieces that are made on all threads and taken one after the other.

use rayon::prelude::*;

/// Makes a piece of each of `given`, `batch` of them at a time on all threads, and hands them to `take` in their order; while some are taken the next are made.
///
/// What is in memory: two batches. Pieces are taken on the thread that calls.
///
/// # Errors
/// The first in the order of the pieces: of one that cannot be made, none of its batch is taken.
pub(crate) fn pipelined<G: Send, P: Send, E: Send>(
    given: impl IntoIterator<Item = G>,
    batch: usize,
    make: impl Fn(G) -> Result<P, E> + Sync,
    mut take: impl FnMut(P) -> Result<(), E>,
) -> Result<(), E> {
    let mut given = given.into_iter().fuse();
    let mut next_given = || given.by_ref().take(batch).collect::<Vec<G>>();
    let made = |batch: Vec<G>| batch.into_par_iter().map(&make).collect::<Vec<Result<P, E>>>().into_iter().collect::<Result<Vec<P>, E>>();
    let mut ready = made(next_given())?;
    while !ready.is_empty() {
        let (batch, mut next) = (next_given(), Ok(Vec::new()));
        rayon::in_place_scope(|scope| {
            scope.spawn(|_| next = made(batch));
            ready.into_iter().try_for_each(&mut take)
        })?;
        ready = next?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_taken_in_their_order_up_to_the_first_failure() {
        for (count, batch) in [(0, 3), (1, 3), (3, 3), (4, 3), (100, 7), (100, 200)] {
            let mut taken = Vec::new();
            pipelined(0..count, batch, |i| Ok::<_, ()>(i * i), |piece| Ok(taken.push(piece))).unwrap();
            assert_eq!(taken, (0..count).map(|i| i * i).collect::<Vec<usize>>(), "{count} by {batch}");
        }
        let mut taken = 0;
        let unmade = pipelined(0..100, 10, |i| if i % 30 == 25 { Err(i) } else { Ok(i) }, |_| Ok(taken += 1));
        assert_eq!((unmade, taken), (Err(25), 20));
        let mut taken = 0;
        let refused = pipelined(0..100, 10, Ok, |i| if i == 47 { Err(i) } else { Ok(taken += 1) });
        assert_eq!((refused, taken), (Err(47), 47));
    }

    /// Whoever ends once has ended: another look would begin again.
    #[test]
    fn what_is_given_is_not_asked_for_after_its_end() {
        let mut asked = 0;
        let given = std::iter::from_fn(|| {
            asked += 1;
            (asked % 4 != 0).then_some(asked)
        });
        let mut taken = Vec::new();
        pipelined(given, 2, Ok::<_, ()>, |piece| Ok(taken.push(piece))).unwrap();
        assert_eq!(taken, [1, 2, 3]);
    }
}
