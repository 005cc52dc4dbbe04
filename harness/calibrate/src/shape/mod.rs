//! Whether the board on which control lies is flat, and how it is bent.

pub(crate) mod board;
pub(crate) mod test;

use calibench_adjust::{AdjustError, Network, Status, Surface};

pub use board::Board;
pub(crate) use board::is_flat;
pub use test::Bend;

use crate::{BoardShape, CalibrationError, Settings};

/// What is held of the shape of the board.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// It was not asked for.
    Untouched,
    /// It could not be tested, in words.
    Untested(String),
    /// It is flat, as far as the observations tell.
    Flat {
        /// Where it lies.
        board: Board,
        /// The bend that was not told from none.
        bend: Bend,
    },
    /// It is bent: [`Network::surfaces`] holds it.
    Bent {
        /// Where it lies.
        board: Board,
        /// What says so; `None` where nothing was tested.
        bend: Option<Bend>,
    },
}

/// Puts the shape that was asked for, or found, into `network`.
///
/// # Errors
/// A shape that was asked for without a board.
pub(crate) fn shape(network: &mut Network, settings: &Settings) -> Result<Shape, CalibrationError> {
    let wanted = settings.shape;
    if matches!(wanted, BoardShape::Flat | BoardShape::Free) {
        return Ok(Shape::Untouched);
    }
    let board = match board::board(network) {
        Ok(board) => board,
        Err(why) if wanted == BoardShape::Tested => return Ok(Shape::Untested(why.into())),
        Err(why) => return Err(CalibrationError::NoBoard { why }),
    };
    if wanted != BoardShape::Tested {
        network.surfaces = vec![surface(network, &board, wanted, [0.0; 3])];
        return Ok(Shape::Bent { board, bend: None });
    }
    match test::bend(network, &board, settings) {
        Ok(Some(bend)) if bend.is_significant() => {
            network.surfaces = vec![surface(network, &board, BoardShape::Bent, bend.coefficients)];
            Ok(Shape::Bent { board, bend: Some(bend) })
        }
        Ok(Some(bend)) => Ok(Shape::Flat { board, bend }),
        Ok(None) => Ok(Shape::Untested("the residuals are no more than rounding".into())),
        // What is wrong with the network is said by its adjustment.
        Err(error) => Ok(Shape::Untested(untested(&error))),
    }
}

fn untested(error: &AdjustError) -> String {
    match error {
        AdjustError::Undetermined(_) => "these images do not determine the bend of the board beside the camera".into(),
        other => format!("no adjustment with a bent board: {other}"),
    }
}

/// The bent board of `network`, from `start`.
pub(crate) fn surface(network: &Network, board: &Board, shape: BoardShape, start: [f64; 3]) -> Surface {
    let third = if shape == BoardShape::BentAxes { Status::Fixed } else { Status::Free };
    Surface {
        name: "the bend of the board".into(),
        coefficients: start,
        statuses: [Status::Free, Status::Free, third],
        points: board.on(network),
    }
}
