//! PuzzleBoards: a chessboard's saddles grown to grids, the dots on the sides of its squares, and where in the pattern they can be.

mod chance;
mod decode;
mod dots;
mod sheet;

use std::collections::BTreeMap;

use calibench_model::Image;
use calibench_model::boards::{BoardPoint, Layout, Puzzle};

use crate::chessboard::candidates::Saddles;
use crate::chessboard::grow::Grids;
use crate::chessboard::level::Pyramid;
use crate::chessboard::sectors::Steps;
use crate::chessboard::side::Sides;
use crate::chessboard::sound;
use crate::plane::{Point, distance};
use crate::{Doubt, Found, FoundPoint, NotFound, corners};

use decode::{Decoded, decode};
use dots::Dot;
use sheet::Sheet;

/// Grids of fewer corners hold too few dots.
const FEWEST: usize = 20;
/// So many grids of a level are looked at.
const GRIDS: usize = 12;
/// Where squares are this long, px of the level, a finer one shows no more of them.
const ENOUGH: f64 = 10.0;
/// A corner is left out if so many dots around it were read and most of them are not those of the pattern.
const AROUND: usize = 3;
/// So many dots beyond the board's rim, three quarters of them those of the pattern, are no chance: the pattern goes on there.
const BEYOND: usize = 8;
/// The same point seen by two grids, px.
const SAME: f64 = 3.0;

/// The corners of the board that are seen, in whatever part of it, to about 0.3 px.
///
/// A grid of corners is believed where its dots are those of one place of the pattern and of no other that is nearly as good (see [`decode`]). Of several
/// grids each is read by itself. A print that is light where the pattern is dark is found, too, and one
/// whose squares are exchanged.
///
/// # Errors
/// [`NotFound::NoPuzzle`], [`NotFound::OtherDots`], [`NotFound::UnsurePlace`], [`NotFound::OtherPlace`], [`NotFound::Mirrored`]; [`NotFound::OtherArrangement`] of two
/// such boards.
pub(crate) fn detect(image: &Image, puzzle: &Puzzle, layout: &Layout) -> Result<Found, NotFound> {
    let image = sound(image);
    let pyramid = Pyramid::new(&image, Sides::DOTTED);
    let mut best: Option<Found> = None;
    let mut why: Option<(usize, NotFound)> = None;
    for level in pyramid.levels() {
        let saddles = Saddles::of(&level);
        let grids = Grids::new(&level, &saddles).filter(|grid| grid.len() >= FEWEST).take(GRIDS);
        let (mut seen, mut least) = (Vec::new(), f64::INFINITY);
        for grid in grids {
            let Some(sheet) = Sheet::new(&pyramid, &level, grid) else { continue };
            let dots = sheet.dots(&image);
            match decode(&sheet, &dots, puzzle) {
                Ok(decoded) => {
                    least = least.min(sheet.least_step() / level.factor);
                    seen.push(Sight::new(&sheet, &dots, decoded, puzzle, layout));
                }
                Err(error) if why.as_ref().is_none_or(|(most, _)| dots.len() > *most) => why = Some((dots.len(), error)),
                Err(_) => {}
            }
        }
        let together = seen.iter().map(|sight| sight.agreeing).max();
        let found = merged(seen, layout);
        if let Some(together) = together.filter(|_| found.points.is_empty()) {
            why = Some((usize::MAX, NotFound::OtherArrangement { marks: found.markers, together }));
        }
        if found.points.len() > best.as_ref().map_or(0, |best| best.points.len()) {
            best = Some(found);
        }
        if best.as_ref().is_some_and(|found| found.points.len() == layout.points.len() || least > ENOUGH) {
            break;
        }
    }
    best.ok_or_else(|| why.map_or(NotFound::NoPuzzle { corners: 0, dots: 0 }, |(_, why)| why))
}

/// What one grid shows of the board.
struct Sight {
    points: BTreeMap<usize, FoundPoint>,
    /// Dots as the pattern has them.
    agreeing: usize,
    /// Corners between dots that the pattern does not have there.
    contradicted: usize,
    /// Corners of the pattern beyond the board.
    beyond: usize,
}

impl Sight {
    fn new(sheet: &Sheet, dots: &[Dot], decoded: Decoded, puzzle: &Puzzle, layout: &Layout) -> Self {
        let corners: BTreeMap<[i32; 2], Point> = sheet.corners.iter().map(|(place, at)| (decoded.pattern(*place), *at)).collect();
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
        let (mut points, mut contradicted) = (BTreeMap::new(), 0);
        for (place, at) in &corners {
            let Some(index) = index(*place, puzzle) else { continue };
            let [wrong, right] = votes.get(place).copied().unwrap_or_default();
            if wrong + right >= AROUND && wrong > right {
                contradicted += 1;
                continue;
            }
            let steps = Steps::at(*at, |by| corners.get(&[place[0] + by[0], place[1] + by[1]]).copied());
            let Some(steps) = steps else { continue };
            // Printed the other way round, light where the layout is dark, every corner is turned by a quarter.
            let own = &layout.points[index];
            let own = BoardPoint { turns: own.turns + u32::from(decoded.exchanged), ..own.clone() };
            points.insert(index, corners::found(index, &own, *at, steps.linear(puzzle.square)));
        }
        let goes_on = beyond[0] + beyond[1] >= BEYOND && beyond[1] >= 3 * beyond[0];
        let outside = corners.keys().filter(|place| index(**place, puzzle).is_none()).count();
        Self { points, agreeing, contradicted, beyond: if goes_on { outside } else { 0 } }
    }
}

/// Which of the layout's points a corner of the pattern is.
fn index(place: [i32; 2], puzzle: &Puzzle) -> Option<usize> {
    let off = |axis: usize| usize::try_from(place[axis]).ok()?.checked_sub(puzzle.place[axis]);
    let [column, row] = [off(0)?, off(1)?];
    (column < puzzle.columns && row < puzzle.rows).then_some(row * puzzle.columns + column)
}

/// All that the grids of one level show; corners that two of them have at different places are left out.
fn merged(seen: Vec<Sight>, layout: &Layout) -> Found {
    let (mut points, mut twice): (BTreeMap<usize, FoundPoint>, Vec<usize>) = (BTreeMap::new(), Vec::new());
    let (mut markers, mut contradicted, mut beyond) = (0, 0, 0);
    for sight in seen {
        // Two grids may be grown from the same corners.
        if sight.points.keys().any(|index| !points.contains_key(index)) {
            markers += sight.agreeing;
        }
        contradicted += sight.contradicted;
        beyond += sight.beyond;
        for (index, point) in sight.points {
            let at = |point: &FoundPoint| [point.position.x, point.position.y];
            match points.get(&index) {
                Some(other) if distance(at(other), at(&point)) > SAME => twice.push(index),
                Some(_) => {}
                None => drop(points.insert(index, point)),
            }
        }
    }
    twice.sort_unstable();
    twice.dedup();
    points.retain(|index, _| twice.binary_search(index).is_err());
    let mut doubts = Vec::new();
    if let Some(first) = twice.first() {
        doubts.push(Doubt::TwiceCorners { first: layout.points[*first].id.clone(), corners: twice.len() });
    }
    if contradicted > 0 {
        doubts.push(Doubt::Dots { corners: contradicted });
    }
    if beyond > 0 {
        doubts.push(Doubt::Beyond { corners: beyond });
    }
    Found { points: points.into_values().collect(), markers, doubts }
}
