//! Which trials belong to which part.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// More parts than this are refused.
pub const MOST_PARTS: u64 = 100_000;

/// Consecutive trials, counted from 0: from the first to the one before `to`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Span {
    /// The first.
    pub from: u64,
    /// The one after the last.
    pub to: u64,
}

impl Span {
    /// How many trials.
    pub const fn count(self) -> u64 {
        self.to.saturating_sub(self.from)
    }

    /// Whether `trial` is one of them.
    pub const fn holds(self, trial: u64) -> bool {
        self.from <= trial && trial < self.to
    }
}

/// One of the parts of a run, as in `3/8`: counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    number: u64,
    of: u64,
}

/// What is no part.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("expected K/N, as in 3/8: part K of N, N from 1 to {MOST_PARTS}, K from 1 to N")]
pub struct PartError;

impl Part {
    /// Part `number` of `of`.
    ///
    /// # Errors
    /// [`PartError`] where there is no such part.
    pub fn new(number: u64, of: u64) -> Result<Self, PartError> {
        if (1..=MOST_PARTS).contains(&of) && (1..=of).contains(&number) { Ok(Self { number, of }) } else { Err(PartError) }
    }

    /// Which part, from 1.
    pub const fn number(self) -> u64 {
        self.number
    }

    /// Of how many.
    pub const fn of(self) -> u64 {
        self.of
    }

    /// The name of the folder of such parts, as in `3-of-8`.
    pub fn folder(self) -> String {
        format!("{}-of-{}", self.number, self.of)
    }

    /// The share of `work` trials in one row: as many as every other part has, or one fewer or more; the first is never the smaller one, so that a single trial
    /// is part 1.
    fn share(self, work: u64) -> Span {
        let end = |parts: u64| (u128::from(work) * u128::from(parts)).div_ceil(u128::from(self.of)) as u64;
        Span { from: end(self.number - 1), to: end(self.number) }
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Part {
    type Err = PartError;

    fn from_str(text: &str) -> Result<Self, PartError> {
        let (number, of) = text.split_once('/').ok_or(PartError)?;
        let count = |digits: &str| digits.bytes().all(|byte| byte.is_ascii_digit()).then(|| digits.parse().ok()).flatten().ok_or(PartError);
        Self::new(count(number)?, count(of)?)
    }
}

/// Trials of one cell of a sweep; a scenario without a sweep is one cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Piece {
    /// The cell, counted from 0.
    pub cell: usize,
    /// Its trials.
    pub trials: Span,
}

/// What `part` has of a run whose cells have so many trials: all trials stand in one row, cell after cell, and the row is cut into pieces of equal length.
/// At most the first and the last cell of a part are shared with others. Nothing, where there are more parts than trials.
pub fn pieces(cells: &[u64], part: Part) -> Vec<Piece> {
    let share = part.share(cells.iter().sum());
    let (mut before, mut found) = (0, Vec::new());
    for (cell, &count) in cells.iter().enumerate() {
        let within = |at: u64| at.clamp(before, before + count) - before;
        let trials = Span { from: within(share.from), to: within(share.to) };
        if trials.count() > 0 {
            found.push(Piece { cell, trials });
        }
        before += count;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(cells: &[u64], of: u64) -> Vec<Vec<Piece>> {
        (1..=of).map(|number| pieces(cells, Part::new(number, of).unwrap())).collect()
    }

    #[test]
    fn parts_hold_every_trial_once_in_order_and_are_of_equal_size() {
        for cells in [&[1000][..], &[1], &[3], &[12, 1, 12, 12], &[7, 7, 7, 7, 7], &[0, 5], &[1_000_000; 50]] {
            let work: u64 = cells.iter().sum();
            for of in [1, 2, 3, 7, 8, 64] {
                let parts = all(cells, of);
                let sizes: Vec<u64> = parts.iter().map(|part| part.iter().map(|piece| piece.trials.count()).sum()).collect();
                assert!(sizes.iter().all(|size| size.abs_diff(work / of) <= 1), "{sizes:?}");
                let mut next: Vec<(usize, u64)> = Vec::new();
                for piece in parts.concat() {
                    match next.last_mut() {
                        Some((cell, to)) if *cell == piece.cell => {
                            assert_eq!(piece.trials.from, *to);
                            *to = piece.trials.to;
                        }
                        _ => {
                            assert_eq!(piece.trials.from, 0);
                            next.push((piece.cell, piece.trials.to));
                        }
                    }
                }
                let expected: Vec<(usize, u64)> = cells.iter().copied().enumerate().filter(|(_, count)| *count > 0).collect();
                assert_eq!(next, expected);
            }
        }
    }

    #[test]
    fn what_cannot_be_cut_is_part_1() {
        let counts: Vec<usize> = all(&[1], 4).iter().map(Vec::len).collect();
        assert_eq!(counts, [1, 0, 0, 0]);
    }

    #[test]
    fn a_part_is_written_as_it_is_read() {
        assert_eq!("3/8".parse::<Part>().unwrap().to_string(), "3/8");
        assert_eq!("3/8".parse::<Part>().unwrap().folder(), "3-of-8");
        for text in ["", "3", "0/8", "9/8", "3/0", "a/b", "-1/8", "+3/8", "3/8/1", "1/100001", " 3/8", "3/", "/8", "1/99999999999999999999"]
        {
            assert_eq!(text.parse::<Part>(), Err(PartError), "{text}");
        }
    }
}
