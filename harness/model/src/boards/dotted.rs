//! Chessboards with three dots.

use super::layout::{Layout, Shape};
use super::{BoardError, Chessboard, counted, within};
use crate::testfield::Outline;

/// A chessboard, numbered as [`Chessboard`], with a dot in the middle of three squares: one, the next to the right and the next below. Each is light in a dark square or
/// dark in a light one. They tell which corner is which where the board is seen in part, however it is turned.
///
/// Source: the markers of `findChessboardCornersSB`, OpenCV 4.3; there the first dot is in a light square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dotted {
    /// Inner corners in a row, 4 to 100.
    pub columns: usize,
    /// Rows of inner corners, 4 to 100.
    pub rows: usize,
    /// The side of a square, object units.
    pub square: f64,
    /// Column and row of the square with the first dot, from 0 at the upper left of the board.
    pub place: [usize; 2],
    /// The diameter of a dot, as a share of the square's side.
    pub dot: f64,
}

impl Dotted {
    /// The diameter of a dot as OpenCV draws it, as a share of the square's side.
    pub const DOT: f64 = 0.34;

    /// Where the first dot is unless it is said: in the light square in the middle, or to the left of it.
    pub const fn middle(columns: usize, rows: usize) -> [usize; 2] {
        let (column, row) = (columns.div_ceil(2), rows.div_ceil(2));
        [column - (column + row + 1) % 2, row]
    }

    /// The squares with dots: columns and rows from 0.
    pub const fn dots(&self) -> [[usize; 2]; 3] {
        let [column, row] = self.place;
        [[column, row], [column + 1, row], [column, row + 1]]
    }

    /// Column and row, from 1 for the inner ones, of the corner so many half squares to the right and down of the middle of the first dot; both are odd.
    pub const fn corner(&self, [right, down]: [i32; 2]) -> [i32; 2] {
        let [column, row] = self.place;
        [(2 * column as i32 + 1 + right) / 2, (2 * row as i32 + 1 + down) / 2]
    }

    /// Which point of the layout a corner is; none where the board has no inner corner.
    pub fn index(&self, [column, row]: [i32; 2]) -> Option<usize> {
        let inside = (1..=self.columns as i32).contains(&column) && (1..=self.rows as i32).contains(&row);
        inside.then(|| (row as usize - 1) * self.columns + column as usize - 1)
    }

    /// What is printed.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn layout(&self) -> Result<Layout, BoardError> {
        let Self { columns, rows, square, place, dot } = *self;
        counted("columns", columns, 4..=100)?;
        counted("rows", rows, 4..=100)?;
        let mut layout = Chessboard { columns, rows, square }.layout()?;
        // Dots of squares that touch the rim, which have no four corners, are not read.
        counted("place[0]", place[0], 1..=columns - 2)?;
        counted("place[1]", place[1], 1..=rows - 2)?;
        within("dot", dot, 0.2..=0.5)?;
        let middle = |[column, row]: [usize; 2]| [(column as f64 - 0.5) * square, (0.5 - row as f64) * square];
        for at in self.dots() {
            let outline = Outline::disc(middle(at), 0.5 * dot * square);
            layout.shapes.push(if (at[0] + at[1]).is_multiple_of(2) { Shape::light(outline) } else { Shape::dark(outline) });
        }
        for point in &mut layout.points {
            let clear = |at| (0..2).map(|i: usize| (middle(at)[i] - point.at[i]).abs()).fold(0.0, f64::max) - 0.5 * dot * square;
            point.room = self.dots().map(clear).into_iter().fold(point.room, f64::min);
        }
        Ok(layout)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Board;
    use super::*;

    /// Every point is found by the way to it from the first dot, and nothing beyond them is.
    #[test]
    fn corners_are_counted_from_the_first_dot() {
        let board = Dotted { columns: 7, rows: 5, square: 2.0, place: [4, 2], dot: Dotted::DOT };
        let layout = board.layout().unwrap();
        // The middle of the first dot is 3.5 squares to the right and 1.5 down from r1c1.
        let ways = |from: f64, at: f64| (2.0 * (at / 2.0 - from)).round() as i32;
        for (index, point) in layout.points.iter().enumerate() {
            let corner = board.corner([ways(3.5, point.at[0]), ways(1.5, -point.at[1])]);
            assert_eq!((board.index(corner), format!("r{}c{}", corner[1], corner[0])), (Some(index), point.id.clone()));
        }
        assert_eq!(board.corner([-9, -5]), [0, 0], "the upper left of the board");
        assert!([[0, 1], [1, 0], [8, 1], [1, 6], [-1, 3]].iter().all(|corner| board.index(*corner).is_none()));
    }

    #[test]
    fn dots_are_where_they_are_said_to_be_and_of_the_other_shade() {
        assert_eq!(Dotted::middle(9, 6), [4, 3], "of 10 x 7 squares (5, 3) is dark");
        assert_eq!(Dotted::middle(8, 6), [4, 3]);
        assert_eq!(Dotted::middle(4, 4), [1, 2]);
        assert!((4..20).all(|columns| (4..20).all(|rows| format!("dotted:{columns}x{rows}:1").parse::<Board>().is_ok())));
        let layout = "dotted:9x6:20:2,1".parse::<Board>().unwrap().layout().unwrap();
        let plain = "chessboard:9x6:20".parse::<Board>().unwrap().layout().unwrap();
        let [first, right, below] = &layout.shapes[plain.shapes.len()..] else { panic!() };
        assert_eq!((first.dark, right.dark, below.dark), (true, false, false), "the square (2, 1) is light");
        let middle = |shape: &Shape| {
            // At equal angles, whatever the number of arcs.
            let around: Vec<_> = shape.outline.0.iter().flat_map(|arc| [0.0, 0.5].map(|t| arc.at(t))).collect();
            [0, 1].map(|i| around.iter().map(|at| at[i]).sum::<f64>() / around.len() as f64)
        };
        let near = |at: [f64; 2], expected: [f64; 2]| (at[0] - expected[0]).hypot(at[1] - expected[1]) < 1e-9;
        // r1c2 is its upper left corner, r2c3 its lower right one.
        assert!(near(middle(first), [30.0, -10.0]) && near(middle(right), [50.0, -10.0]) && near(middle(below), [30.0, -30.0]));
        let room = |id: &str| layout.points.iter().find(|point| point.id == id).unwrap().room;
        assert!((room("r2c3") - 6.6).abs() < 1e-12 && room("r6c9") == 20.0, "half a square less the radius; a square");
        let error = |text: &str| text.parse::<Board>().unwrap_err().to_string();
        assert!(error("dotted:9x6:20:8,1").contains("`place[0]` is 8: expected a whole number from 1 to 7"));
        assert!(error("dotted:9x6:20:0,1").contains("`place[0]` is 0"));
    }
}
