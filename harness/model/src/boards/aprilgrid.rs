//! The AprilGrid of Kalibr: rows of AprilTags whose corners touch small squares.

use super::layout::{BoardPoint, Layout, Marker, Shape, marker_shapes, square_marker};
use super::{BoardError, Dictionary, counted, length, within};
use crate::TargetKind;
use crate::testfield::{Outline, PlatePoint};

/// An AprilGrid as Kalibr numbers it: tags along the rows, the first at the lower left, rows upwards. Its tags stand upside down.
///
/// Its points are the tags' outer corners: `t0c0` is the lower left one of tag 0, which is the origin, `c1` the lower right, `c2` the upper
/// right, `c3` the upper left one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AprilGrid {
    /// Tags in a row, 1 to 100.
    pub columns: usize,
    /// Rows of tags, 1 to 100.
    pub rows: usize,
    /// The side of a tag, object units.
    pub tag: f64,
    /// The gap between two tags, as a fraction of a tag's side.
    pub spacing: f64,
    /// The tags' dictionary.
    pub dictionary: &'static Dictionary,
    /// The id of the first tag.
    pub first: u32,
    /// Cells of a tag's black frame: 2 as Kalibr prints it, 1 as others do.
    pub border: usize,
    /// How much is cut off the corners of the small squares, as a fraction of their side; `None` without small squares.
    pub squares: Option<f64>,
}

impl AprilGrid {
    /// What is printed.
    ///
    /// # Errors
    /// A parameter out of its range; a dictionary of too few tags.
    pub fn layout(&self) -> Result<Layout, BoardError> {
        self.check()?;
        let places = || (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (row, column)));
        let markers: Vec<Marker> = places().zip(self.first..).map(|((row, column), id)| self.marker(row, column, id)).collect();
        let mut shapes: Vec<Shape> = markers.iter().flat_map(|marker| marker_shapes(marker, self.dictionary, self.border)).collect();
        let between = (0..=self.rows).flat_map(|row| (0..=self.columns).map(move |column| (row, column)));
        if let Some(cut) = self.squares {
            shapes.extend(between.map(|(row, column)| self.square(row, column, cut)));
        }
        let points = places().zip(self.first..).flat_map(|((row, column), id)| self.points(row, column, id)).collect();
        let rim = if self.squares.is_some() { self.gap() } else { 0.0 };
        let [u, v] = self.at(self.rows - 1, self.columns - 1);
        Ok(Layout { points, markers, shapes, printed: [[-rim, -rim], [u + self.tag + rim, v + self.tag + rim]] })
    }

    fn check(&self) -> Result<(), BoardError> {
        counted("columns", self.columns, 1..=100)?;
        counted("rows", self.rows, 1..=100)?;
        length("tag", self.tag)?;
        within("spacing", self.spacing, 0.05..=2.0)?;
        counted("border", self.border, 1..=2)?;
        within("chamfer", self.squares.unwrap_or(0.0), 0.0..=0.4)?;
        super::ids(self.dictionary, self.first, self.rows * self.columns)
    }

    fn gap(&self) -> f64 {
        self.spacing * self.tag
    }

    /// The lower left corner of a tag; rows count upwards.
    fn at(&self, row: usize, column: usize) -> PlatePoint {
        let pitch = self.tag + self.gap();
        [column as f64 * pitch, row as f64 * pitch]
    }

    fn marker(&self, row: usize, column: usize, id: u32) -> Marker {
        Marker { id, corners: square_marker(self.at(row, column), self.tag, 2) }
    }

    /// The small square whose upper right corner is the lower left one of a tag. Its corners are those of the tags around it, to the last bit.
    fn square(&self, row: usize, column: usize, cut: f64) -> Shape {
        let [right, high] = self.at(row, column);
        let pitch = self.tag + self.gap();
        let [left, low] = [column, row].map(|count| (count as f64 - 1.0) * pitch + self.tag);
        let corners = [[left, low], [right, low], [right, high], [left, high]];
        let cut_off = |index: usize| {
            let [before, at, after] = [index + 3, index, index + 1].map(|corner| corners[corner % 4]);
            [before, after].map(|towards| [0, 1].map(|i| at[i] + cut * (towards[i] - at[i])))
        };
        let vertices: Vec<PlatePoint> = if cut == 0.0 { corners.to_vec() } else { (0..4).flat_map(cut_off).collect() };
        Shape::dark(Outline::polygon(&vertices))
    }

    fn points(&self, row: usize, column: usize, id: u32) -> [BoardPoint; 4] {
        let [u, v] = self.at(row, column);
        let corners = [[u, v], [u + self.tag, v], [u + self.tag, v + self.tag], [u, v + self.tag]];
        let chess = self.squares == Some(0.0);
        let frame = self.border as f64 * self.tag / (self.dictionary.side + 2 * self.border) as f64;
        [0, 1, 2, 3].map(|k| BoardPoint {
            id: format!("t{id}c{k}"),
            kind: if chess { TargetKind::ChessCorner } else { TargetKind::Corner },
            at: corners[k],
            size: if chess { self.gap().min(self.tag) } else { self.tag },
            // Of a chess corner: dark at the lower right and the upper left. Of a corner: its area at its own lower right.
            turns: if chess { [1, 0, 1, 0][k] } else { [1, 2, 3, 0][k] },
            room: frame.min(self.gap()),
        })
    }
}
