//! Chessboards without markers: saddles of the grey values, grown to a grid, completed to a rectangle, seen corner by corner and proved square by square.

mod board;
pub(crate) mod candidates;
pub(crate) mod complete;
mod crossing;
mod forecast;
pub(crate) mod grow;
pub(crate) mod level;
mod peak;
pub(crate) mod refine;
pub(crate) mod sectors;
mod settle;
pub(crate) mod sheet;
pub(crate) mod side;
mod straight;

use std::borrow::Cow;

use calibench_model::Image;
use calibench_model::boards::{BoardPoint, Chessboard, Layout};

use board::Board;
use candidates::Saddles;
use complete::complete;
use grow::{Grid, Grids};
use level::{Level, Pyramid};
use refine::Around;
use side::Sides;

use crate::{Doubt, Found, NotFound, corners};

/// What is looked at around corners that nothing is near.
pub(crate) const AROUND: Around = Around { share: 0.4, resolved: 0.0, smooth: 0.0 };
/// No larger board is looked for beside one that takes this share of the image.
const LARGE: f64 = 0.03;
/// A board of other counts than those asked for is named if it has so many corners.
const FEWEST: usize = 12;

/// The inner corners of a chessboard that is seen whole, to about 0.3 px.
///
/// A board that has more or fewer, or of which a part is hidden, is none. A corner is seen where two of three agree: the edges that meet in it, the sides of the squares
/// around it, which may bow, and the other corners. Few that are not are left out, and said.
/// Squares may not be smaller than about 6 px. Of several such boards it is the largest. In bounded time.
///
/// Order: the board is taken as seen from its front, so each next row lies clockwise of the way along a row in the image. This leaves two starts for a board, and
/// four for one with as many rows as columns. Of these, the ones whose first corner has the dark one of the two squares that touch the board's own corner there are
/// taken if only some have: with `columns + rows` odd this is one start. Of several, the one whose first corner is nearest to the upper left of the image.
///
/// # Errors
/// [`NotFound::NoChessboard`].
pub(crate) fn detect(image: &Image, chessboard: &Chessboard, layout: &Layout) -> Result<Found, NotFound> {
    let Chessboard { columns, rows, square } = *chessboard;
    let image = sound(image);
    let pyramid = Pyramid::new(&image, Sides::PLAIN);
    let mut other = None;
    let seen = pyramid.levels().find_map(|level| largest(&pyramid, &level, [columns, rows], &mut other));
    let board = seen.ok_or_else(|| NotFound::NoChessboard { columns, rows, other: other.map(|other| other.counts()) })?;
    // Printed the other way round, light where the layout is dark, every corner is turned by a quarter.
    let turned = u32::from(!board.starts_dark);
    let seen = layout.points.iter().enumerate().filter(|(index, _)| board.seen[*index]);
    let point = |(index, own): (usize, &BoardPoint)| {
        let linear = board.steps(index)?.linear(square);
        Some(corners::found(index, &BoardPoint { turns: own.turns + turned, ..own.clone() }, board.corners[index], linear))
    };
    let points = seen.filter_map(point).collect();
    let unseen = board.seen.iter().filter(|seen| !**seen).count();
    let doubts = if unseen > 0 { vec![Doubt::Unseen { corners: unseen }] } else { Vec::new() };
    Ok(Found { points, markers: 0, doubts, light: false })
}

/// The largest such board at one level: pictures of boards may be in the picture, too. Where there is none, `other` becomes the board of other counts that the
/// largest grid of the level is, if it has more corners than what it was.
fn largest(pyramid: &Pyramid, level: &Level, [columns, rows]: [usize; 2], other: &mut Option<Board>) -> Option<Board> {
    let image = pyramid.image();
    let saddles = Saddles::of(level);
    let counts = |board: &Board| [(columns, rows), (rows, columns)].contains(&(board.columns, board.rows));
    let mut largest: Option<Board> = None;
    let mut most = Grid::new();
    for grid in Grids::new(level, &saddles) {
        if grid.len() > most.len() {
            most.clone_from(&grid);
        }
        if 2 * grid.len() < columns * rows {
            continue;
        }
        let whole = complete(level, grid, columns.max(rows) + 1);
        let Some(mut board) = whole.and_then(|grid| Board::new(level, &grid)).filter(counts) else { continue };
        board.settle(pyramid, level.factor);
        if largest.as_ref().is_none_or(|other| other.area() < board.area()) && board.stands(image) {
            largest = board.ordered(columns, rows);
        }
        if largest.as_ref().is_some_and(|board| board.area() > LARGE * (image.width() * image.height()) as f64) {
            break;
        }
    }
    if largest.is_none() && most.len() >= FEWEST.max(other.as_ref().map_or(0, |other| other.corners.len() + 1)) {
        *other = whole(pyramid, level, most).or_else(|| other.take());
    }
    largest
}

/// The board of any counts that a grid is, if it is seen with all of its squares.
fn whole(pyramid: &Pyramid, level: &Level, grid: Grid) -> Option<Board> {
    let mut board = Board::new(level, &complete(level, grid, usize::MAX)?)?;
    board.settle(pyramid, level.factor);
    (board.corners.len() >= FEWEST && board.stands(pyramid.image()) && board.is_inside(pyramid.image())).then_some(board)
}

/// The image with numbers everywhere.
pub(crate) fn sound<'a>(image: &'a Image<'a>) -> Cow<'a, Image<'a>> {
    if image.grey().iter().all(|grey| grey.abs() <= 1e6) {
        return Cow::Borrowed(image);
    }
    let number = |grey: &f32| if grey.is_nan() { 0.0 } else { grey.clamp(-1e6, 1e6) };
    Cow::Owned(Image::new(image.width(), image.height(), image.grey().iter().map(number).collect()))
}
