//! PuzzleBoards: a chessboard's saddles grown to grids, the dots on the sides of its squares, and where in the pattern they can be.

mod chance;
mod decode;
mod dots;

use std::collections::BTreeMap;

use calibench_model::Image;
use calibench_model::boards::{Layout, Puzzle};

use crate::NotFound;
use crate::chessboard::refine::Around;
use crate::chessboard::sheet::{Reading, Sheet};
use crate::chessboard::side::Sides;
use crate::parts::{self, Placing, Sight};

use decode::{Decoded, decode};
use dots::Dot;

/// Dots lie on the middles of sides; they begin at a third of a step from a corner, a blur brings them nearer and moves the corners beside them. Grids of fewer
/// corners hold too few.
const READING: Reading =
    Reading { sides: Sides::DOTTED, around: Around { share: 0.22, resolved: 20.0, smooth: 16.0 }, near: 40.0, even: 0.0, fewest: 20 };
/// A corner is left out if so many dots around it were read and most of them are not those of the pattern.
const AROUND: usize = 3;
/// So many dots beyond the board's rim, three quarters of them those of the pattern, are no chance: the pattern goes on there.
const BEYOND: usize = 8;

/// The corners of the board that are seen, in whatever part of it, to about 0.3 px.
///
/// A grid of corners is believed where its dots are those of one place of the pattern and of no other that is nearly as good (see [`decode`]). Of several
/// grids each is read by itself. A print that is light where the pattern is dark is found, too, and one
/// whose squares are exchanged.
///
/// # Errors
/// [`NotFound::NoPuzzle`], [`NotFound::OtherDots`], [`NotFound::UnsurePlace`], [`NotFound::OtherPlace`], [`NotFound::Mirrored`]; [`NotFound::OtherArrangement`] of two
/// such boards.
pub(crate) fn detect(image: &Image, puzzle: &Puzzle, layout: &Layout) -> Result<crate::Found, NotFound> {
    parts::detect(image, layout, READING, NotFound::NoPuzzle { corners: 0, dots: 0 }, |sheet, image| {
        let dots = sheet.dots(image);
        let decoded = decode(sheet, &dots, puzzle).map_err(|error| (dots.len(), error))?;
        Ok(sight(sheet, &dots, decoded, puzzle, layout))
    })
}

/// All boards that are seen, the largest first.
pub(crate) fn detect_all(image: &Image, puzzle: &Puzzle, layout: &Layout) -> Vec<crate::Found> {
    parts::detect_all(image, layout, READING, |sheet, image| {
        let dots = sheet.dots(image);
        decode(sheet, &dots, puzzle).map(|decoded| sight(sheet, &dots, decoded, puzzle, layout))
    })
}

/// What a grid shows of the board.
fn sight(sheet: &Sheet, dots: &[Dot], decoded: Decoded, puzzle: &Puzzle, layout: &Layout) -> Sight {
    let mut votes: BTreeMap<[i32; 2], [usize; 2]> = BTreeMap::new();
    let (mut agreeing, mut beyond) = (0, [0, 0]);
    for dot in dots {
        let ends = dot.ends().map(|place| decoded.pattern(place));
        let right = decoded.expects(dot) == dot.light;
        if ends.iter().all(|end| index(*end, puzzle).is_some()) {
            agreeing += usize::from(right);
            ends.iter().for_each(|end| votes.entry(*end).or_default()[usize::from(right)] += 1);
        } else {
            beyond[usize::from(right)] += 1;
        }
    }
    let contradicted = |place: &[i32; 2]| {
        let [wrong, right] = votes.get(place).copied().unwrap_or_default();
        wrong + right >= AROUND && wrong > right
    };
    let placing = Placing { square: puzzle.square, exchanged: decoded.exchanged, index: |place| index(place, puzzle) };
    let mut sight = Sight::new(sheet, |place| decoded.pattern(place), &placing, layout, contradicted);
    sight.marks = agreeing;
    if beyond[0] + beyond[1] < BEYOND || beyond[1] < 3 * beyond[0] {
        sight.beyond = 0;
    }
    sight
}

/// Which of the layout's points a corner of the pattern is.
fn index(place: [i32; 2], puzzle: &Puzzle) -> Option<usize> {
    let off = |axis: usize| usize::try_from(place[axis]).ok()?.checked_sub(puzzle.place[axis]);
    let [column, row] = [off(0)?, off(1)?];
    (column < puzzle.columns && row < puzzle.rows).then_some(row * puzzle.columns + column)
}
