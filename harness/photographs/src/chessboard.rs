//! A chessboard in photographs: its corners, found and measured, and their object coordinates.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use calibench_exchange::{ControlRow, LostRow, PointRow, read_photo};
use calibench_measure::{Board, BoardDetector, Operator};
use calibench_model::Start;
use calibench_model::camera::ImageSize;
use rayon::prelude::*;

use crate::PhotographsError;
use crate::corners::corners_of;
use crate::names::{names, once};

/// The status of a photograph in which the board was not found.
pub const NOT_FOUND: &str = "not_found";

/// A photograph: the name of its image, where it is, and its size.
pub type Photo = (String, PathBuf, ImageSize);

/// A chessboard and the side of its squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chessboard {
    /// Its inner corners.
    pub board: Board,
    /// Side of a square, object units.
    pub side: f64,
}

impl FromStr for Chessboard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong =
            || format!("`{text}` is no chessboard: expected inner corners and the side of a square as COLUMNSxROWS:SIDE, as in 9x6:25");
        let (board, side) = text.split_once(':').ok_or_else(wrong)?;
        let board = board.parse().map_err(|_| wrong())?;
        let side = side.parse().ok().filter(|side: &f64| side.is_finite() && *side > 0.0).ok_or_else(wrong)?;
        Ok(Self { board, side })
    }
}

/// Measured points, and the photographs that they are of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Corners {
    /// Those with a position.
    pub points: Vec<PointRow>,
    /// Those without.
    pub lost: Vec<LostRow>,
    /// The photographs; none where the points were given.
    pub photos: Vec<Photo>,
}

impl FromIterator<Corners> for Corners {
    fn from_iter<I: IntoIterator<Item = Corners>>(all: I) -> Self {
        let mut whole = Self::default();
        for one in all {
            whole.points.extend(one.points);
            whole.lost.extend(one.lost);
            whole.photos.extend(one.photos);
        }
        whole
    }
}

impl Chessboard {
    /// Its inner corners, object units from the first: X along the rows, Y upwards, Z towards the viewer.
    pub fn control(&self) -> Vec<ControlRow> {
        let corner = |index: usize| {
            let (column, row) = (index % self.board.columns, index / self.board.columns);
            // Plus zero: a zero without a sign.
            let position = [column as f64 * self.side, -(row as f64 * self.side) + 0.0, 0.0];
            ControlRow::new(self.board.target(index), position)
        };
        (0..self.board.corners()).map(corner).collect()
    }

    /// The corners in photographs: approximately by the detector, then by the operator called `method`. Those that it rejects, and photographs without the
    /// board, are listed among the lost. One list a photograph; `step` is called after each, on any thread.
    ///
    /// # Errors
    /// A photograph that cannot be read, or that is given twice.
    pub fn measure(
        &self,
        photos: &[PathBuf],
        detector: &dyn BoardDetector,
        (method, operator): (&str, &dyn Operator),
        step: &(dyn Fn() + Sync),
    ) -> Result<Vec<Corners>, PhotographsError> {
        once(photos)?;
        let one = |(path, name): (&PathBuf, &String)| {
            let found = self.in_photo((path, name), detector, operator, method);
            step();
            found
        };
        photos.par_iter().zip(&names(photos)).map(one).collect()
    }

    fn in_photo(
        &self,
        (path, name): (&Path, &str),
        detector: &dyn BoardDetector,
        operator: &dyn Operator,
        method: &str,
    ) -> Result<Corners, PhotographsError> {
        let image = read_photo(path)?.image;
        let rows = corners_of(detector, &image, name, self.board);
        let starts: Vec<Start> = rows.iter().map(|row| row.start).collect();
        let measured = operator.measure_all(&image, &starts);
        let size = ImageSize { width: image.width() as u32, height: image.height() as u32 };
        let photo = (name.to_owned(), path.to_owned(), size);
        let mut corners = Corners { points: Vec::new(), lost: Vec::new(), photos: vec![photo] };
        let lost =
            |image: String, target: String, status: &str, reason: String| LostRow { image, target, status: status.to_owned(), reason };
        if rows.is_empty() {
            let reason = format!("no board of {} x {} inner corners found", self.board.columns, self.board.rows);
            corners.lost.push(lost(name.to_owned(), String::new(), NOT_FOUND, reason));
        }
        for (row, result) in rows.into_iter().zip(measured) {
            match result {
                Ok(found) => {
                    let start = Start { position: found.position, covariance: found.covariance, ..row.start };
                    corners.points.push(PointRow { start, ..row });
                }
                Err(rejection) => corners.lost.push(lost(row.image, row.target, "rejected", format!("{method}: {rejection}"))),
            }
        }
        Ok(corners)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chessboard_is_seen_from_its_front() {
        let board: Chessboard = "3x4:2.5".parse().unwrap();
        let control = board.control();
        assert_eq!(control.len(), 12);
        assert_eq!((control[4].target.as_str(), control[4].position), ("r2c2", [2.5, -2.5, 0.0]));
        for wrong in ["9x6", "9x6:", "9x6:0", "9x6:-1", "9x6:NaN", "9:25", "2x2:1"] {
            assert!(wrong.parse::<Chessboard>().is_err(), "{wrong}");
        }
    }
}
