//! Boards of squares of which a part is enough: grids of corners that tell by what lies between them where on the board they are.

use std::collections::BTreeMap;

use calibench_model::Image;
use calibench_model::boards::{BoardPoint, Layout};

use crate::chessboard::candidates::Saddles;
use crate::chessboard::grow::{Grids, Place};
use crate::chessboard::level::Pyramid;
use crate::chessboard::sectors::Steps;
use crate::chessboard::sheet::{Reading, Sheet};
use crate::chessboard::sound;
use crate::plane::{Point, distance};
use crate::{Doubt, Found, FoundPoint, NotFound, corners};

/// So many grids of a level are looked at.
const GRIDS: usize = 12;
/// Where squares are this long, px of the level, a finer one shows no more of them.
const ENOUGH: f64 = 10.0;
/// The same point seen by two grids, px.
const SAME: f64 = 3.0;

/// The points of the board that are seen, in whatever part of it. `read` tells what a grid shows of the board, or why not and how much there was to read.
///
/// # Errors
/// Of the grid that had most to read; `none` where there is no grid; [`NotFound::OtherArrangement`] of two such boards.
pub(crate) fn detect(
    image: &Image,
    layout: &Layout,
    reading: Reading,
    none: NotFound,
    read: impl Fn(&Sheet, &Image) -> Result<Sight, (usize, NotFound)>,
) -> Result<Found, NotFound> {
    let image = sound(image);
    let pyramid = Pyramid::new(&image, reading.sides);
    let mut best: Option<Found> = None;
    let mut why: Option<(usize, NotFound)> = None;
    for level in pyramid.levels() {
        let saddles = Saddles::of(&level);
        let grids = Grids::new(&level, &saddles).filter(|grid| grid.len() >= reading.fewest).take(GRIDS);
        let (mut seen, mut least) = (Vec::new(), f64::INFINITY);
        for grid in grids {
            let Some(sheet) = Sheet::new(&pyramid, &level, grid, &reading) else { continue };
            match read(&sheet, &image) {
                Ok(sight) => {
                    least = least.min(sheet.least_step() / level.factor);
                    seen.push(sight);
                }
                Err((marks, error)) if why.as_ref().is_none_or(|(most, _)| marks > *most) => why = Some((marks, error)),
                Err(_) => {}
            }
        }
        let together = seen.iter().map(|sight| sight.marks).max();
        let found = merged(seen, layout);
        if let Some(together) = together.filter(|_| found.points.is_empty()) {
            why = Some((usize::MAX, NotFound::OtherArrangement { marks: found.markers, together, instead: None }));
        }
        if found.points.len() > best.as_ref().map_or(0, |best| best.points.len()) {
            best = Some(found);
        }
        if best.as_ref().is_some_and(|found| found.points.len() == layout.points.len() || least > ENOUGH) {
            break;
        }
    }
    best.ok_or_else(|| why.map_or(none, |(_, why)| why))
}

/// What one grid shows of the board.
pub(crate) struct Sight {
    points: BTreeMap<usize, FoundPoint>,
    /// Marks as the board has them.
    pub marks: usize,
    /// Corners that what lies beside them contradicts.
    contradicted: usize,
    /// Corners of the grid beyond the board.
    pub beyond: usize,
}

/// How the board's corners are numbered.
pub(crate) struct Placing<I> {
    /// The side of a square, object units.
    pub square: f64,
    /// Printed the other way round, light where the layout is dark.
    pub exchanged: bool,
    /// Which of the layout's points a corner is.
    pub index: I,
}

impl Sight {
    /// `on_board`: where on the board a corner of the grid is. Corners that are `contradicted` are left out.
    pub(crate) fn new(
        sheet: &Sheet,
        on_board: impl Fn(Place) -> [i32; 2],
        placing: &Placing<impl Fn([i32; 2]) -> Option<usize>>,
        layout: &Layout,
        contradicted: impl Fn(&[i32; 2]) -> bool,
    ) -> Self {
        let corners: BTreeMap<[i32; 2], Point> = sheet.corners.iter().map(|(place, at)| (on_board(*place), *at)).collect();
        let mut sight = Self { points: BTreeMap::new(), marks: 0, contradicted: 0, beyond: 0 };
        for (place, at) in &corners {
            let Some(index) = (placing.index)(*place) else {
                sight.beyond += 1;
                continue;
            };
            if contradicted(place) {
                sight.contradicted += 1;
                continue;
            }
            let Some(steps) = Steps::among(&corners, *place) else { continue };
            // Printed the other way round every corner is turned by a quarter.
            let own = &layout.points[index];
            let own = BoardPoint { turns: own.turns + u32::from(placing.exchanged), ..own.clone() };
            sight.points.insert(index, corners::found(index, &own, *at, steps.linear(placing.square)));
        }
        sight
    }
}

/// All that the grids of one level show, the largest first; corners of two boards, at different places, are left out. Of the same board another grid adds corners.
fn merged(mut seen: Vec<Sight>, layout: &Layout) -> Found {
    seen.sort_by_key(|sight| std::cmp::Reverse(sight.points.len()));
    let (mut points, mut twice): (BTreeMap<usize, FoundPoint>, Vec<usize>) = (BTreeMap::new(), Vec::new());
    let (mut markers, mut contradicted, mut beyond) = (0, 0, 0);
    for sight in seen {
        // Two grids may be grown from the same corners.
        if sight.points.keys().any(|index| !points.contains_key(index)) {
            markers += sight.marks;
        }
        contradicted += sight.contradicted;
        beyond += sight.beyond;
        let elsewhere = |index: &usize, point: &FoundPoint| {
            let at = |point: &FoundPoint| [point.position.x, point.position.y];
            points.get(index).map(|other| distance(at(other), at(point)) > SAME)
        };
        let all: Vec<bool> = sight.points.iter().filter_map(|(index, point)| elsewhere(index, point)).collect();
        let is_other = 2 * all.iter().filter(|elsewhere| **elsewhere).count() > all.len();
        for (index, point) in sight.points {
            match points.get(&index) {
                Some(_) if is_other => twice.push(index),
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
