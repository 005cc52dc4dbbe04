//! `detect`: what finds boards in photographs, by itself.

use calibench_detect::VERSION;
use calibench_model::boards::Board;
use calibench_model::{Image, Rejection};

use crate::finder::{BoardFinder, BoardPointFound, Sought};
use crate::operator::Finds;
use crate::registry::{Build, Method};

/// The points of a board as `calibench detect` finds them, before any operator measures them: of a board in view in part those that are seen, of every kind of board.
///
/// Source: our own.
pub struct Detect;

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "detect",
        about: "the points of a board in the whole image as `calibench detect` finds them, before an operator measures them",
        source: "calibench",
        version: VERSION.into(),
        parameters: &[],
        build: Build::With(|_| Box::new(Finds(Detect))),
    }
}

impl BoardFinder for Detect {
    fn unfit(&self, _: &Board) -> Option<String> {
        None
    }

    fn find(&self, image: &Image, sought: &Sought) -> Result<Vec<BoardPointFound>, Rejection> {
        let found = calibench_detect::detect(image, &sought.board).map_err(|_| Rejection::NotDetected)?;
        Ok(found.points.iter().map(|point| BoardPointFound { index: point.index, position: point.position }).collect())
    }
}
