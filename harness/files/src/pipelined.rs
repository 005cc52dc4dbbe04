//! Pieces that are made on all threads and taken one after the other.

use rayon::prelude::*;

/// Makes a piece of each of `given`, `batch` of them at a time on all threads, and hands them to `take` in their order; while some are taken the next are made.
///
/// What is in memory: two batches. Pieces are taken on the thread that calls.
///
/// # Errors
/// The first in the order of the pieces: of one that cannot be made, none of its batch is taken.
pub fn pipelined<G: Send, P: Send, E: Send>(
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

    /// What was taken of `given`, and how it ended; `last` is refused.
    fn taken<G: Send>(
        given: impl IntoIterator<Item = G>,
        batch: usize,
        make: impl Fn(G) -> Result<usize, usize> + Sync,
        last: usize,
    ) -> (Vec<usize>, Result<(), usize>) {
        let mut all = Vec::new();
        let take = |piece| {
            if piece == last {
                return Err(piece);
            }
            all.push(piece);
            Ok(())
        };
        let end = pipelined(given, batch, make, take);
        (all, end)
    }

    #[test]
    fn pieces_are_taken_in_their_order_up_to_the_first_failure() {
        for (count, batch) in [(0, 3), (1, 3), (3, 3), (4, 3), (100, 7), (100, 200)] {
            let squares = (0..count).map(|i| i * i).collect();
            assert_eq!(taken(0..count, batch, |i| Ok(i * i), usize::MAX), (squares, Ok(())), "{count} by {batch}");
        }
        let some = |i: usize| if i % 30 == 25 { Err(i) } else { Ok(i) };
        assert_eq!(taken(0..100, 10, some, usize::MAX), ((0..20).collect(), Err(25)));
        assert_eq!(taken(0..100, 10, Ok, 47), ((0..47).collect(), Err(47)));
    }

    /// Whoever ends once has ended: another look would begin again.
    #[test]
    fn what_is_given_is_not_asked_for_after_its_end() {
        let mut asked = 0;
        let given = std::iter::from_fn(|| {
            asked += 1;
            (asked % 4 != 0).then_some(asked)
        });
        assert_eq!(taken(given, 2, Ok, usize::MAX), (vec![1, 2, 3], Ok(())));
    }
}
