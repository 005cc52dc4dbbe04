//! Chessboards with three dots: which squares of a grid have one, and what that says of their place.

use std::collections::BTreeMap;

use calibench_model::Image;
use calibench_model::boards::{Dotted, Layout};

use crate::chessboard::AROUND;
use crate::chessboard::grow::Place;
use crate::chessboard::sheet::{Reading, Sheet};
use crate::chessboard::side::Sides;
use crate::ground::grey;
use crate::parts::{self, Placing, Sight};
use crate::plane::{Homography, Point};
use crate::{Found, NotFound};

const READING: Reading = Reading { sides: Sides::PLAIN, around: AROUND, near: 0.0, even: 0.5, fewest: 12 };
/// Where in a square its dot is looked at, and what is around the largest one, as shares of the side from the middle.
const WITHIN: [Point; 5] = [[0.0, 0.0], [0.06, 0.0], [-0.06, 0.0], [0.0, 0.06], [0.0, -0.06]];
const OUTSIDE: f64 = 0.33;
/// A dot differs from its square by more than the second, a square without one by less than the first; as shares of the contrast of all squares.
const UNCLEAR: [f64; 2] = [0.2, 0.35];
/// Of so many squares one may seem to have a dot that has none: dirt, a reflection.
const STRAY: usize = 20;
/// So many corners beyond the board's are no chance.
const BEYOND: usize = 3;
/// Right, below, left, above in the grid, whose second axis is clockwise of the first.
const WAYS: [[i32; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];

/// The corners of the board that are seen with its dots, to about 0.3 px.
///
/// A grid of corners is believed where three of its squares have a dot, one beside and one below another, and hardly any other has. A print that is light where the
/// layout is dark is found, too.
///
/// # Errors
/// [`NotFound::NoDots`], [`NotFound::OtherCounts`], [`NotFound::Mirrored`]; [`NotFound::OtherArrangement`] of more dots, or of two such boards.
pub(crate) fn detect(image: &Image, board: &Dotted, layout: &Layout) -> Result<Found, NotFound> {
    let none = NotFound::NoDots { corners: 0, dots: 0 };
    parts::detect(image, layout, READING, none, |sheet, image| {
        sight(sheet, image, board, layout).map_err(|error| (sheet.corners.len(), error))
    })
}

/// All boards that are seen, the largest first.
pub(crate) fn detect_all(image: &Image, board: &Dotted, layout: &Layout) -> Vec<Found> {
    parts::detect_all(image, layout, READING, |sheet, image| sight(sheet, image, board, layout))
}

fn sight(sheet: &Sheet, image: &Image, board: &Dotted, layout: &Layout) -> Result<Sight, NotFound> {
    let squares = sheet.squares(image);
    let placed = Placed::by(&squares, sheet, board)?;
    let placing = Placing { square: board.square, exchanged: placed.exchanged, index: |corner| board.index(corner) };
    let mut sight = Sight::new(sheet, |place| placed.on_board(place), &placing, layout, |_| false);
    sight.marks = 3;
    if sight.beyond < BEYOND {
        return Ok(sight);
    }
    let mirrored = Placed { mirrored: true, ..placed };
    if sheet.corners.keys().all(|place| board.index(mirrored.on_board(*place)).is_some()) {
        return Err(NotFound::Mirrored { markers: 3 });
    }
    let span = |axis: usize| {
        let all = || sheet.corners.keys().map(|place| placed.on_board(*place)[axis]);
        [all().min().unwrap_or(0), all().max().unwrap_or(0)]
    };
    Err(NotFound::OtherCounts { columns: span(0), rows: span(1), asked: [board.columns, board.rows] })
}

impl Sheet {
    /// Whether squares have a dot, by their corner before both axes; those that are not clear are left out.
    fn squares(&self, image: &Image) -> BTreeMap<Place, bool> {
        self.corners.keys().filter_map(|place| Some((*place, self.has_dot(image, *place)?))).collect()
    }

    fn has_dot(&self, image: &Image, [u, v]: Place) -> Option<bool> {
        let corner = |by: [i32; 2]| Some(([0, 1].map(|i| f64::from(by[i]) - 0.5), *self.corners.get(&[u + by[0], v + by[1]])?));
        let pairs = [corner([0, 0])?, corner([1, 0])?, corner([1, 1])?, corner([0, 1])?];
        let map = Homography::fitted(&pairs)?;
        let mean = |places: &[Point]| places.iter().map(|place| grey(image, map.at(*place))).sum::<f64>() / places.len() as f64;
        let diagonal = 0.8 * OUTSIDE;
        let around = [[OUTSIDE, 0.0], [-OUTSIDE, 0.0], [0.0, OUTSIDE], [0.0, -OUTSIDE]];
        let corners = [[diagonal, diagonal], [-diagonal, diagonal], [diagonal, -diagonal], [-diagonal, -diagonal]];
        let own = 0.5 * (mean(&around) + mean(&corners));
        let differs = self.light([u, v]) * (own - mean(&WITHIN)) / self.contrast;
        if differs < UNCLEAR[0] {
            Some(false)
        } else if differs > UNCLEAR[1] {
            Some(true)
        } else {
            None
        }
    }
}

/// How a grid lies on the board.
#[derive(Clone, Copy)]
struct Placed<'b> {
    board: &'b Dotted,
    /// The square of the grid with the first dot.
    first: Place,
    /// Which of [`WAYS`] is the board's way to the right; the next is its way down.
    turn: usize,
    mirrored: bool,
    /// Whether its squares are light where the layout's are dark.
    exchanged: bool,
}

impl<'b> Placed<'b> {
    fn by(squares: &BTreeMap<Place, bool>, sheet: &Sheet, board: &'b Dotted) -> Result<Self, NotFound> {
        let has_dot = |place: &Place| squares.get(place) == Some(&true);
        let dots: Vec<Place> = squares.keys().copied().filter(has_dot).collect();
        let beside = |[u, v]: Place, turn: usize| [u + WAYS[turn % 4][0], v + WAYS[turn % 4][1]];
        let turned = |first: &Place, turn: usize| has_dot(&beside(*first, turn)) && has_dot(&beside(*first, turn + 1));
        let mut all = dots.iter().flat_map(|first| (0..4).filter(move |turn| turned(first, *turn)).map(|turn| (*first, turn)));
        let Some((first, turn)) = all.next() else {
            return Err(NotFound::NoDots { corners: sheet.corners.len(), dots: dots.len() });
        };
        if all.next().is_some() || dots.len() - 3 > squares.len() / STRAY {
            return Err(NotFound::OtherArrangement { marks: dots.len(), together: 3, instead: None });
        }
        let [column, row] = board.place;
        let exchanged = (sheet.light(first) < 0.0) != (column + row).is_multiple_of(2);
        Ok(Self { board, first, turn, mirrored: false, exchanged })
    }

    /// Column and row of the board's corner at a place, from 1 for the inner ones.
    fn on_board(&self, place: Place) -> [i32; 2] {
        // Twice the way from the middle of the first square.
        let way = [0, 1].map(|i| 2 * (place[i] - self.first[i]) - 1);
        let along = |turn: usize| way[0] * WAYS[turn % 4][0] + way[1] * WAYS[turn % 4][1];
        let (right, down) = (along(self.turn), along(self.turn + 1));
        self.board.corner(if self.mirrored { [down, right] } else { [right, down] })
    }
}
