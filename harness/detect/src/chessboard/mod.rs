//! Chessboards without markers: saddles of the grey values, grown to a grid, completed to a rectangle and proved square by square.

mod board;
pub(crate) mod candidates;
pub(crate) mod complete;
pub(crate) mod grow;
pub(crate) mod level;
pub(crate) mod refine;
pub(crate) mod sectors;
pub(crate) mod sheet;
pub(crate) mod side;
mod straight;

use std::borrow::Cow;

use calibench_model::Image;
use calibench_model::boards::{BoardPoint, Chessboard, Layout};

use board::Board;
use candidates::Saddles;
use complete::complete;
use grow::Grids;
use level::{Level, Pyramid};
use refine::{Around, refined};
use side::Sides;

use crate::{Found, NotFound, corners};

/// What is looked at around corners that nothing is near.
pub(crate) const AROUND: Around = Around { share: 0.4, resolved: 0.0, smooth: 0.0 };
/// No larger board is looked for beside one that takes this share of the image.
const LARGE: f64 = 0.03;

/// The inner corners of a chessboard that is seen whole, to about 0.3 px.
///
/// A board that has more or fewer, or of which a part is hidden, is none; few corners are put where the others have them if the squares around them are seen.
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
    let seen = pyramid.levels().find_map(|level| largest(&pyramid, &level, columns, rows));
    let board = seen.ok_or(NotFound::NoChessboard { columns, rows })?;
    // Printed the other way round, light where the layout is dark, every corner is turned by a quarter.
    let turned = u32::from(!board.starts_dark(&image));
    let point = |(index, own): (usize, &BoardPoint)| {
        let linear = board.steps(index)?.linear(square);
        Some(corners::found(index, &BoardPoint { turns: own.turns + turned, ..own.clone() }, board.corners[index], linear))
    };
    let points = layout.points.iter().enumerate().filter_map(point).collect();
    Ok(Found { points, markers: 0, doubts: Vec::new() })
}

/// The largest such board at one level: pictures of boards may be in the picture, too.
fn largest(pyramid: &Pyramid, level: &Level, columns: usize, rows: usize) -> Option<Board> {
    let image = pyramid.image();
    let saddles = Saddles::of(level);
    let counts = |board: &Board| [(columns, rows), (rows, columns)].contains(&(board.columns, board.rows));
    let mut largest: Option<Board> = None;
    for grid in Grids::new(level, &saddles) {
        if 2 * grid.len() < columns * rows {
            continue;
        }
        let whole = complete(level, grid, columns.max(rows) + 1);
        let Some(mut board) = whole.and_then(|grid| Board::new(level, &grid)).filter(counts) else { continue };
        board.refine(pyramid, level.factor);
        // What was far off may be met from where it is now.
        if board.straighten() {
            board.refine(pyramid, level.factor);
            board.straighten();
        }
        if largest.as_ref().is_none_or(|other| other.area() < board.area()) && board.stands(image) {
            largest = board.ordered(image, columns, rows);
        }
        if largest.as_ref().is_some_and(|board| board.area() > LARGE * (image.width() * image.height()) as f64) {
            break;
        }
    }
    largest
}

impl Board {
    fn refine(&mut self, pyramid: &Pyramid, factor: f64) {
        let steps: Vec<f64> = (0..self.corners.len()).map(|index| self.step(index)).collect();
        self.corners = refined(pyramid, &self.corners, &steps, AROUND, factor);
    }
}

/// The image with numbers everywhere.
pub(crate) fn sound<'a>(image: &'a Image<'a>) -> Cow<'a, Image<'a>> {
    if image.grey().iter().all(|grey| grey.abs() <= 1e6) {
        return Cow::Borrowed(image);
    }
    let number = |grey: &f32| if grey.is_nan() { 0.0 } else { grey.clamp(-1e6, 1e6) };
    Cow::Owned(Image::new(image.width(), image.height(), image.grey().iter().map(number).collect()))
}
