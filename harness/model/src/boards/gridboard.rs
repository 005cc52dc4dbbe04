//! The GridBoard of OpenCV's module `aruco`: rows of markers with gaps between them.

use super::layout::{BoardPoint, Layout, Marker, Shape, marker_shapes, square_marker};
use super::{BoardError, Dictionary, counted, length};
use crate::TargetKind;
use crate::testfield::PlatePoint;

/// The separation of two markers is within these, as shares of a marker's side.
const SEPARATION: [f64; 2] = [0.02, 10.0];

/// A GridBoard as OpenCV numbers it: upright markers along the rows from the upper left.
///
/// Its points are the markers' outer corners in ArUco's order: `t0c0` is the upper left one of marker 0, which is the origin, `c1` the upper right, `c2` the lower
/// right, `c3` the lower left one. OpenCV's object points, since 4.6, are (X, -Y, 0) of these: from the same corner with y downwards.
///
/// Source: OpenCV, `cv::aruco::GridBoard`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridBoard {
    /// Markers in a row, 1 to 100.
    pub columns: usize,
    /// Rows of markers, 1 to 100.
    pub rows: usize,
    /// The side of a marker, object units.
    pub marker: f64,
    /// The gap between two markers, object units.
    pub separation: f64,
    /// The markers' dictionary.
    pub dictionary: &'static Dictionary,
    /// The id of the first marker.
    pub first: u32,
    /// Cells of a marker's dark frame: 1, or 2 as `generateImage` has it with `borderBits = 2`.
    pub border: usize,
}

impl GridBoard {
    /// What is printed.
    ///
    /// # Errors
    /// A parameter out of its range; a dictionary of too few markers.
    pub fn layout(&self) -> Result<Layout, BoardError> {
        self.check()?;
        let places = || (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (row, column)));
        let marker =
            |((row, column), id): ((usize, usize), u32)| Marker { id, corners: square_marker(self.at(row, column), self.marker, 0) };
        let markers: Vec<Marker> = places().zip(self.first..).map(marker).collect();
        let shapes: Vec<Shape> = markers.iter().flat_map(|marker| marker_shapes(marker, self.dictionary, self.border)).collect();
        let points = markers.iter().flat_map(|marker| self.points(marker)).collect();
        let ([_, low], [right, _]) = (self.at(self.rows - 1, 0), self.at(0, self.columns - 1));
        Ok(Layout { points, markers, shapes, printed: [[0.0, low], [right + self.marker, 0.0]] })
    }

    fn check(&self) -> Result<(), BoardError> {
        counted("columns", self.columns, 1..=100)?;
        counted("rows", self.rows, 1..=100)?;
        length("marker", self.marker)?;
        let [least, most] = SEPARATION.map(|share| share * self.marker);
        if !(least..=most).contains(&self.separation) {
            let expected = format!("{least} to {most}, a fiftieth of `marker` to ten times it");
            return Err(BoardError::Parameter { parameter: "separation", value: self.separation, expected });
        }
        counted("border", self.border, 1..=2)?;
        super::ids(self.dictionary, self.first, self.rows * self.columns)
    }

    /// The lower left corner of a marker; rows count downwards.
    fn at(&self, row: usize, column: usize) -> PlatePoint {
        let pitch = self.marker + self.separation;
        [column as f64 * pitch, -(row as f64) * pitch - self.marker]
    }

    fn points(&self, marker: &Marker) -> [BoardPoint; 4] {
        let frame = self.border as f64 * self.marker / (self.dictionary.side + 2 * self.border) as f64;
        [0, 1, 2, 3].map(|k| BoardPoint {
            id: format!("t{}c{k}", marker.id),
            kind: TargetKind::Corner,
            at: marker.corners[k],
            size: self.marker,
            // The marker lies at the lower right of its own upper left corner, and so on clockwise.
            turns: [0, 3, 2, 1][k],
            room: frame.min(self.separation),
        })
    }
}
