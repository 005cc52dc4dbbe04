//! From dots to the place in the pattern.
//!
//! The pattern is two tables: one of 3 x 167 for sides to the right, one for those downwards. A place (x, y) of 501 x 501 is (x mod 3, y mod 167) in the one and
//! (y mod 3, x mod 167) in the other, so what disagrees with each of 501 x 501 places in four turns is a sum of two numbers of two tables of 501.
//!
//! What is believed. Dots that are the same digit of a table are one vote, of their majority: a pattern of another make repeats, too. Of `n` votes a place
//! that is wrong agrees with each by chance. (1) The expected number of wrong places that agree as well as the best does and that would name a corner of the board is
//! below [`CHANCE`]. (2) Half of the belief is in the board that was asked for, spread over all ways to see a part of it, half in any part of the pattern,
//! spread over all of 501 x 501 x 8; how many dots are misread is not known ([`Binomial::likelihood`]). All other places together have less than [`RIVALS`] of the
//! belief. Both count places in all turns, and twice: light dots may be dark ones, of a print that is light
//! on dark. The squares' colours say nothing: another maker begins the pattern elsewhere, and where its end meets its beginning they are exchanged.

use std::collections::BTreeMap;

use calibench_model::boards::{Puzzle, PuzzleCodes};
use calibench_model::stop;

use super::chance::Binomial;
use super::dots::Dot;
use crate::NotFound;
use crate::chessboard::grow::Place;
use crate::chessboard::sheet::Sheet;

/// So many wrong places, expected, agree with dots that are no pattern's as well as one that is believed.
const CHANCE: f64 = 1e-6;
/// So large a share of the belief is left to all other places.
const RIVALS: f64 = 1e-5;

const SIDE: usize = PuzzleCodes::SIDE;
const LENGTH: usize = PuzzleCodes::LENGTH;

/// How a grid lies in the pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Decoded {
    middle: Place,
    turn: usize,
    mirrored: bool,
    /// Where its middle is in the pattern.
    at: [usize; 2],
    /// Whether its dots are light where the pattern's are dark.
    inverted: bool,
    /// Whether its squares are.
    pub exchanged: bool,
    /// Votes, and those that the pattern does not have.
    votes: usize,
    wrong: usize,
}

/// A place relative to the middle, mirrored if need be and turned by quarters.
fn turned(place: Place, middle: Place, mirrored: bool, turn: usize) -> Place {
    let [u, v] = [place[0] - middle[0], place[1] - middle[1]];
    let [u, v] = if mirrored { [v, u] } else { [u, v] };
    [[u, v], [-v, u], [-u, -v], [v, -u]][turn]
}

/// The residue of a place.
fn rest(value: i32, of: usize) -> usize {
    value.rem_euclid(of as i32) as usize
}

impl Decoded {
    /// The corner of the pattern at a place; it may lie beyond.
    pub(super) fn pattern(&self, place: Place) -> [i32; 2] {
        let [x, y] = turned(place, self.middle, self.mirrored, self.turn);
        [self.at[0] as i32 + x, self.at[1] as i32 + y]
    }

    /// Whether the pattern has a light dot there.
    pub(super) fn expects(&self, dot: &Dot) -> bool {
        let [a, b] = dot.ends().map(|place| self.pattern(place));
        let start = [a[0].min(b[0]), a[1].min(b[1])].map(|value| rest(value, SIDE));
        let codes = PuzzleCodes::published();
        (if a[1] == b[1] { codes.is_light_right(start) } else { codes.is_light_down(start) }) != self.inverted
    }
}

/// One way to take a grid: what of its dots disagrees with each place.
struct Way {
    turn: usize,
    inverted: bool,
    /// With (x mod 3, y mod 167), by sides to the right.
    right: [[u16; LENGTH]; 3],
    /// With (y mod 3, x mod 167), by sides downwards.
    down: [[u16; LENGTH]; 3],
    votes: usize,
    /// Whether its middle is a corner of the pattern whose x + y is even, by the colours of squares.
    even: bool,
    /// The extent of its corners around the middle.
    extent: [Place; 2],
}

impl Way {
    fn new(sheet: &Sheet, dots: &[Dot], mirrored: bool, turn: usize, inverted: bool) -> Self {
        let middle = sheet.middle();
        let place = |place: Place| turned(place, middle, mirrored, turn);
        let mut tables: [BTreeMap<[usize; 2], i32>; 2] = Default::default();
        for dot in dots {
            let [a, b] = dot.ends().map(place);
            let start = [a[0].min(b[0]), a[1].min(b[1])];
            let axis = usize::from(a[0] == b[0]);
            let vote = if dot.light == inverted { -1 } else { 1 };
            *tables[axis].entry([rest(start[axis], 3), rest(start[1 - axis], LENGTH)]).or_default() += vote;
        }
        let places = || sheet.corners.keys().map(|corner| place(*corner));
        let bound = |axis: usize| [places().map(|at| at[axis]).min().unwrap_or(0), places().map(|at| at[axis]).max().unwrap_or(0)];
        let [x, y] = [bound(0), bound(1)];
        let codes = PuzzleCodes::published();
        // A quarter turn exchanges the squares between steps of one sign with the others; at an even place those are dark.
        let even = (sheet.light(middle) < 0.0) == turn.is_multiple_of(2);
        let votes = tables.iter().flat_map(|table| table.values()).filter(|sum| **sum != 0).count();
        Self {
            turn,
            inverted,
            right: wrong(&tables[0], &codes.right),
            down: wrong(&tables[1], &codes.down),
            votes,
            even,
            extent: [[x[0], y[0]], [x[1], y[1]]],
        }
    }

    /// Votes that a place does not have.
    fn wrong(&self, [x, y]: [usize; 2]) -> usize {
        usize::from(self.right[x % 3][y % LENGTH] + self.down[y % 3][x % LENGTH])
    }

    /// No place disagrees with fewer.
    fn least(&self) -> usize {
        let least = |table: &[[u16; LENGTH]; 3]| table.iter().flatten().copied().min().map_or(0, usize::from);
        least(&self.right) + least(&self.down)
    }

    /// The places of the middle at which a corner may be one of the board's.
    fn asked(&self, puzzle: &Puzzle) -> impl Iterator<Item = [usize; 2]> + use<> {
        let range = |axis: usize, count: usize| {
            let first = puzzle.place[axis] as i32;
            let [low, high] = [first - self.extent[1][axis], first + count as i32 - 1 - self.extent[0][axis]];
            low.max(0) as usize..(high + 1).clamp(0, SIDE as i32) as usize
        };
        let (xs, ys) = (range(0, puzzle.columns), range(1, puzzle.rows));
        ys.flat_map(move |y| xs.clone().map(move |x| [x, y]))
    }
}

/// How many votes disagree with each beginning of a table.
fn wrong(votes: &BTreeMap<[usize; 2], i32>, codes: &[[u8; LENGTH]; 3]) -> [[u16; LENGTH]; 3] {
    let mut counts = [[0_u16; LENGTH]; 3];
    for ([line, digit], sum) in votes.iter().filter(|(_, sum)| **sum != 0) {
        let read = u8::from(*sum > 0);
        for (a, counts) in counts.iter_mut().enumerate() {
            let codes = &codes[(line + a) % 3];
            let (before, after) = codes.split_at(*digit);
            counts.iter_mut().zip(after.iter().chain(before)).for_each(|(count, code)| *count += u16::from(*code != read));
        }
    }
    counts
}

/// The best place of a grid of this handedness, how many places would name a corner of the board, and whether it is believed.
struct Verdict {
    best: Decoded,
    named: bool,
    /// Expected number of places that agree as well by chance.
    chance: f64,
    /// What is left to all other places.
    rivals: f64,
}

impl Verdict {
    fn is_sure(&self) -> bool {
        self.chance < CHANCE && self.rivals < RIVALS
    }
}

fn judged(sheet: &Sheet, dots: &[Dot], puzzle: &Puzzle, mirrored: bool) -> Verdict {
    stop::point();
    let ways = [false, true].into_iter().flat_map(|inverted| (0..4).map(move |turn| (turn, inverted)));
    let turns: Vec<Way> = ways.map(|(turn, inverted)| Way::new(sheet, dots, mirrored, turn, inverted)).collect();
    let votes = turns[0].votes;
    let binomial = Binomial::new(votes);
    let decoded = |index: usize, at: [usize; 2]| {
        let of: &Way = &turns[index];
        let exchanged = (at[0] + at[1]).is_multiple_of(2) != of.even;
        Decoded { middle: sheet.middle(), turn: of.turn, mirrored, at, inverted: of.inverted, exchanged, votes, wrong: of.wrong(at) }
    };
    let asked = || turns.iter().enumerate().flat_map(|(turn, of)| of.asked(puzzle).map(move |at| (turn, at)));
    let count = asked().count().max(1) as f64;
    let all = (turns.len() * SIDE * SIDE) as f64;
    // Where nothing can be believed the sum over all places is spared.
    let least = turns.iter().enumerate().min_by_key(|(_, turn)| turn.least());
    if least.as_ref().is_none_or(|(_, turn)| count * binomial.chance(turn.least(), votes) > CHANCE) {
        let (turn, wrong) = least.map_or((0, 0), |(index, turn)| (index, turn.least()));
        let best = Decoded { wrong, ..decoded(turn, [0, 0]) };
        return Verdict { best, named: false, chance: f64::INFINITY, rivals: 1.0 };
    }
    let likelihoods: Vec<f64> = (0..=votes).map(|wrong| binomial.likelihood(wrong, votes)).collect();
    let near = asked().min_by_key(|(turn, at)| turns[*turn].wrong(*at));
    let asked_sum: f64 = asked().map(|(turn, at)| likelihoods[turns[turn].wrong(at)]).sum();
    let (any, any_sum) = everywhere(&turns, &likelihoods);
    let total = asked_sum / count + any_sum / all;
    let far = decoded(any.0, any.1);
    let near = near.map(|(turn, at)| decoded(turn, at));
    let belief = |wrong: usize, prior: f64| likelihoods[wrong] * prior / total;
    let near = near.map(|near| (near, belief(near.wrong, 1.0 / count + 1.0 / all)));
    match near {
        Some((near, belief)) if near == far || belief > likelihoods[far.wrong] / (all * total) => {
            Verdict { best: near, named: true, chance: count * binomial.chance(near.wrong, votes), rivals: 1.0 - belief }
        }
        _ => {
            Verdict { best: far, named: false, chance: all * binomial.chance(far.wrong, votes), rivals: 1.0 - belief(far.wrong, 1.0 / all) }
        }
    }
}

/// The place of fewest wrong votes in all of the pattern, and the sum of the likelihoods of all.
fn everywhere(turns: &[Way], likelihoods: &[f64]) -> ((usize, [usize; 2]), f64) {
    let (mut best, mut least) = ((0, [0, 0]), usize::MAX);
    let mut counts = vec![0_u64; likelihoods.len()];
    for (index, turn) in turns.iter().enumerate() {
        for y in 0..SIDE {
            let (right, down) = ([0, 1, 2].map(|x| turn.right[x][y % LENGTH]), &turn.down[y % 3]);
            for x in 0..SIDE {
                let wrong = usize::from(right[x % 3] + down[x % LENGTH]);
                counts[wrong] += 1;
                if wrong < least {
                    (best, least) = ((index, [x, y]), wrong);
                }
            }
        }
    }
    (best, counts.iter().zip(likelihoods).map(|(count, likelihood)| *count as f64 * likelihood).sum())
}

/// Where the dots of a grid are in the pattern, if that is sure and names corners of the board.
///
/// # Errors
/// What they are instead.
pub(super) fn decode(sheet: &Sheet, dots: &[Dot], puzzle: &Puzzle) -> Result<Decoded, NotFound> {
    let verdict = judged(sheet, dots, puzzle, false);
    if verdict.is_sure() && verdict.named {
        return Ok(verdict.best);
    }
    let mirror = judged(sheet, dots, puzzle, true);
    if mirror.is_sure() && !verdict.is_sure() {
        let markers = dots.iter().filter(|dot| mirror.best.expects(dot) == dot.light).count();
        return Err(NotFound::Mirrored { markers });
    }
    let Decoded { votes, wrong, .. } = verdict.best;
    if verdict.is_sure() {
        let places = || sheet.corners.keys().map(|place| verdict.best.pattern(*place));
        let range = |axis: usize| [places().map(|at| at[axis]).min().unwrap_or(0), places().map(|at| at[axis]).max().unwrap_or(0)];
        let asked = |axis: usize, count: usize| [puzzle.place[axis], puzzle.place[axis] + count - 1];
        return Err(NotFound::OtherPlace { columns: range(0), rows: range(1), asked: [asked(0, puzzle.columns), asked(1, puzzle.rows)] });
    }
    let corners = sheet.corners.len();
    // Not even if all agreed.
    let few = 8.0 * ((puzzle.columns + 1) * (puzzle.rows + 1)) as f64 * 0.5_f64.powi(votes as i32) > CHANCE;
    Err(match verdict.chance < CHANCE {
        true => NotFound::UnsurePlace { dots: votes, agreeing: votes - wrong },
        false if few => NotFound::NoPuzzle { corners, dots: dots.len() },
        false => NotFound::OtherDots { dots: votes, agreeing: votes - wrong },
    })
}

#[cfg(test)]
mod tests;
