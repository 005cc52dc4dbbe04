//! The ChArUco board: a chessboard whose light squares hold markers.

use super::layout::{BoardPoint, Layout, Marker, Shape, marker_shapes, square_marker};
use super::{BoardError, Dictionary, counted, length};
use crate::TargetKind;
use crate::testfield::{Outline, PlatePoint};

/// A ChArUco board, counted in squares, as OpenCV numbers it: markers and corners along the rows from the upper left.
///
/// Its points are the inner corners, `r1c1` the first, which is the origin. OpenCV's id of `rRcC` is (R - 1) (columns - 1) + C - 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Charuco {
    /// Squares in a row, 2 to 100.
    pub columns: usize,
    /// Rows of squares, 2 to 100.
    pub rows: usize,
    /// The side of a square, object units.
    pub square: f64,
    /// The side of a marker, object units.
    pub marker: f64,
    /// The markers' dictionary.
    pub dictionary: &'static Dictionary,
    /// The id of the first marker.
    pub first: u32,
    /// As OpenCV made it before 4.6: with an even number of rows the square at the upper left is light. Otherwise it is dark.
    pub legacy: bool,
}

impl PartialEq for Dictionary {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Charuco {
    /// What is printed.
    ///
    /// # Errors
    /// A parameter out of its range; a dictionary of too few markers.
    pub fn layout(&self) -> Result<Layout, BoardError> {
        self.check()?;
        let squares = || (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (row, column)));
        let dark = squares().filter(|(row, column)| self.is_dark(*row, *column));
        let mut shapes: Vec<Shape> = dark.map(|(row, column)| self.dark(row, column)).collect();
        let light = squares().filter(|(row, column)| !self.is_dark(*row, *column));
        let markers: Vec<Marker> = light.zip(self.first..).map(|((row, column), id)| self.marker(row, column, id)).collect();
        shapes.extend(markers.iter().flat_map(|marker| marker_shapes(marker, self.dictionary, 1)));
        let inner = (1..self.rows).flat_map(|row| (1..self.columns).map(move |column| (row, column)));
        let points = inner.map(|(row, column)| self.point(row, column)).collect();
        let ([u0, v1], [u1, v0]) = (self.at(0, 0), self.at(self.rows, self.columns));
        Ok(Layout { points, markers, shapes, printed: [[u0, v0], [u1, v1]] })
    }

    fn check(&self) -> Result<(), BoardError> {
        counted("columns", self.columns, 2..=100)?;
        counted("rows", self.rows, 2..=100)?;
        length("square", self.square)?;
        if !(0.1 * self.square..0.95 * self.square).contains(&self.marker) {
            let expected = "a tenth to 19 twentieths of `square`".into();
            return Err(BoardError::Parameter { parameter: "marker", value: self.marker, expected });
        }
        super::ids(
            self.dictionary,
            self.first,
            self.columns * self.rows / 2 + usize::from(self.columns * self.rows % 2 == 1 && !self.is_dark(0, 0)),
        )
    }

    fn is_dark(&self, row: usize, column: usize) -> bool {
        (row + column).is_multiple_of(2) != (self.legacy && self.rows.is_multiple_of(2))
    }

    /// A corner of squares; (0, 0) is the outermost at the upper left.
    fn at(&self, row: usize, column: usize) -> PlatePoint {
        [(column as f64 - 1.0) * self.square, (1.0 - row as f64) * self.square]
    }

    fn dark(&self, row: usize, column: usize) -> Shape {
        let corners = [(row, column), (row + 1, column), (row + 1, column + 1), (row, column + 1)];
        Shape::dark(Outline::polygon(&corners.map(|(row, column)| self.at(row, column))))
    }

    fn marker(&self, row: usize, column: usize, id: u32) -> Marker {
        let ([u, v], gap) = (self.at(row + 1, column), 0.5 * (self.square - self.marker));
        Marker { id, corners: square_marker([u + gap, v + gap], self.marker, 0) }
    }

    fn point(&self, row: usize, column: usize) -> BoardPoint {
        BoardPoint {
            id: format!("r{row}c{column}"),
            kind: TargetKind::ChessCorner,
            at: self.at(row, column),
            size: self.square,
            turns: u32::from(!self.is_dark(row, column)),
            room: 0.5 * (self.square - self.marker),
        }
    }
}
