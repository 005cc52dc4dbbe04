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
use crate::plane::{Homography, Point, distance, mean};
use crate::{Doubt, Found, FoundPoint, NotFound, corners};

/// So many grids of a level are looked at.
const GRIDS: usize = 12;
/// Where squares are this long, px of the level, a finer one shows no more of them.
const ENOUGH: f64 = 10.0;
/// And so many where each of several boards counts.
const ALL_GRIDS: usize = 50;
/// The same point seen by two grids, px.
const SAME: f64 = 3.0;
/// A board goes on in a grid that has none of its points if that is at most so many squares away from where it would be.
const BESIDE: f64 = 2.0;

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

/// The points of each of several such boards, the largest first; one or none where one or none is seen.
///
/// All levels are looked at: a board that a coarse one shows whole hides no smaller one.
pub(crate) fn detect_all<E>(
    image: &Image,
    layout: &Layout,
    reading: Reading,
    read: impl Fn(&Sheet, &Image) -> Result<Sight, E>,
) -> Vec<Found> {
    let image = sound(image);
    let pyramid = Pyramid::new(&image, reading.sides);
    let mut seen: Vec<Vec<Sight>> = Vec::new();
    for level in pyramid.levels() {
        let saddles = Saddles::of(&level);
        let grids = Grids::new(&level, &saddles).filter(|grid| grid.len() >= reading.fewest).take(ALL_GRIDS);
        let sheets = grids.filter_map(|grid| Sheet::new(&pyramid, &level, grid, &reading));
        seen.extend(boards(sheets.filter_map(|sheet| read(&sheet, &image).ok()).collect(), layout));
    }
    // Levels see the same board better or worse.
    seen.sort_by_key(|board| std::cmp::Reverse(points_of(board).len()));
    let mut all: Vec<(Found, Points)> = Vec::new();
    for board in seen {
        let points = points_of(&board);
        if !all.iter().any(|(_, other)| is_of(&points, other, layout) || covers(other, &points)) {
            all.push((alone(&board), points));
        }
    }
    all.into_iter().map(|(found, _)| found).collect()
}

/// What grids show of each of several boards, the largest first: a grid that has points of a board elsewhere shows another one, or was misread where a board is.
fn boards(mut seen: Vec<Sight>, layout: &Layout) -> Vec<Vec<Sight>> {
    seen.sort_by_key(|sight| std::cmp::Reverse(sight.points.len()));
    let mut boards: Vec<(Points, Vec<Sight>)> = Vec::new();
    for sight in seen.into_iter().filter(|sight| !sight.points.is_empty()) {
        if let Some((points, board)) = boards.iter_mut().find(|(points, _)| is_of(&sight.points, points, layout)) {
            add(points, &sight.points);
            board.push(sight);
        } else if !boards.iter().any(|(points, _)| covers(points, &sight.points)) {
            boards.push((sight.points.clone(), vec![sight]));
        }
    }
    boards.into_iter().map(|(_, board)| board).collect()
}

/// Points of a board by their index.
type Points = BTreeMap<usize, FoundPoint>;

const fn place(point: &FoundPoint) -> Point {
    [point.position.x, point.position.y]
}

/// Whether points are those of the board of which a grid shows others: most of those in common are at the same places, or, where none are, the middle of them is
/// where the board goes on.
fn is_of(own: &Points, board: &Points, layout: &Layout) -> bool {
    let common = own.iter().filter_map(|(index, point)| Some(distance(place(point), place(board.get(index)?))));
    let apart: Vec<bool> = common.map(|apart| apart > SAME).collect();
    if !apart.is_empty() {
        return 2 * apart.iter().filter(|apart| **apart).count() <= apart.len();
    }
    let pairs: Vec<(Point, Point)> = board.iter().map(|(index, point)| (layout.points[*index].at, place(point))).collect();
    let middle = |of: &dyn Fn((&usize, &FoundPoint)) -> Point| mean(&own.iter().map(of).collect::<Vec<_>>());
    let there = middle(&|(_, point)| place(point));
    let steps = own.values().map(|FoundPoint { affine, .. }| affine.axx.hypot(affine.ayx).max(affine.axy.hypot(affine.ayy)));
    let square = steps.fold(0.0, f64::max);
    let goes_on = |map: Homography| distance(map.at(middle(&|(index, _)| layout.points[*index].at)), there) <= BESIDE * square;
    Homography::fitted(&pairs).is_some_and(goes_on)
}

/// Whether most points lie on such of a board, under whatever names.
fn covers(board: &Points, own: &Points) -> bool {
    let on = |point: &&FoundPoint| board.values().any(|other| distance(place(point), place(other)) <= SAME);
    2 * own.values().filter(on).count() > own.len()
}

fn points_of(board: &[Sight]) -> Points {
    let mut points = Points::new();
    board.iter().for_each(|sight| add(&mut points, &sight.points));
    points
}

/// Adds what is not there.
fn add(points: &mut Points, others: &Points) {
    for (index, point) in others {
        points.entry(*index).or_insert(*point);
    }
}

/// What one grid shows of the board.
pub(crate) struct Sight {
    points: Points,
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
        let mut sight = Self { points: Points::new(), marks: 0, contradicted: 0, beyond: 0 };
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

/// What grids of one board show of it, the largest first: another one adds corners.
fn alone(board: &[Sight]) -> Found {
    let (mut points, mut markers) = (Points::new(), 0);
    for sight in board {
        // Two grids may be grown from the same corners.
        if sight.points.keys().any(|index| !points.contains_key(index)) {
            markers += sight.marks;
        }
        add(&mut points, &sight.points);
    }
    let sum = |of: fn(&Sight) -> usize| board.iter().map(of).sum::<usize>();
    let (contradicted, beyond) = (sum(|sight| sight.contradicted), sum(|sight| sight.beyond));
    let mut doubts = Vec::new();
    if contradicted > 0 {
        doubts.push(Doubt::Dots { corners: contradicted });
    }
    if beyond > 0 {
        doubts.push(Doubt::Beyond { corners: beyond });
    }
    Found { points: points.into_values().collect(), markers, doubts, light: false }
}

/// The board that the grids of one level show, of several the largest: corners that another one has, too, are left out.
fn merged(seen: Vec<Sight>, layout: &Layout) -> Found {
    let boards = boards(seen, layout);
    let Some((first, others)) = boards.split_first() else { return alone(&[]) };
    let mut found = alone(first);
    let elsewhere: Points = others.iter().flat_map(|board| points_of(board)).collect();
    let (twice, once): (Vec<FoundPoint>, Vec<FoundPoint>) = found.points.iter().partition(|point| elsewhere.contains_key(&point.index));
    found.points = once;
    found.markers += others.iter().map(|board| alone(board).markers).sum::<usize>();
    if let Some(first) = twice.first() {
        found.doubts.insert(0, Doubt::TwiceCorners { first: layout.points[first.index].id.clone(), corners: twice.len() });
    }
    found
}
