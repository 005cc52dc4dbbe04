//! PuzzleBoards: chessboards with a dot on every side of a square that tells where in a large pattern it is.

use std::f64::consts::PI;
use std::sync::OnceLock;

use super::layout::{BoardPoint, Layout, Shape};
use super::{BoardError, counted, length, within};
use crate::TargetKind;
use crate::testfield::{Curve, Outline, PlatePoint};

/// A part of the PuzzleBoard's pattern, counted in inner corners; `r1c1`, the first, is the origin.
///
/// On the middle of every side between two inner corners is a round dot, dark or light. The squares along the rim are halves, without dots there.
///
/// Source: Stelldinger, Schönherr & Biermann 2024.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Puzzle {
    /// Inner corners in a row, 6 to 501.
    pub columns: usize,
    /// Rows of inner corners, 6 to 501.
    pub rows: usize,
    /// The side of a square, object units.
    pub square: f64,
    /// Column and row of the first corner in the pattern, from 0; the last corner's are at most 500.
    pub place: [usize; 2],
    /// The diameter of a dot, as a share of the square's side: a third as published.
    pub dot: f64,
}

/// The dots of the whole pattern of 501 x 501 corners, x to the right, y downwards.
#[derive(Debug)]
pub struct PuzzleCodes {
    /// Of sides downwards from corner (x, y): row `y % 3`, column `x % 167`; 1 is light.
    pub down: [[u8; PuzzleCodes::LENGTH]; 3],
    /// Of sides to the right of corner (x, y): row `x % 3`, column `y % 167`; 1 is light.
    pub right: [[u8; PuzzleCodes::LENGTH]; 3],
}

impl PuzzleCodes {
    /// After how many corners across a side its dots begin anew; along it after three.
    pub const LENGTH: usize = 167;
    /// Corners to a side of the pattern.
    pub const SIDE: usize = 3 * Self::LENGTH;

    /// The codes that the makers published.
    ///
    /// # Panics
    /// Never: the file is our own.
    pub fn published() -> &'static Self {
        static READ: OnceLock<PuzzleCodes> = OnceLock::new();
        READ.get_or_init(|| {
            let text = include_str!("../../data/puzzle/codes.txt");
            let mut lines = text.lines().filter(|line| !line.starts_with('#'));
            let mut line = || -> [u8; Self::LENGTH] {
                let digits: Vec<u8> = lines.next().expect("our own file").bytes().map(|digit| digit - b'0').collect();
                digits.try_into().expect("our own file")
            };
            let down = [line(), line(), line()];
            Self { down, right: [line(), line(), line()] }
        })
    }

    /// Whether the dot between the corners (x, y) and (x, y + 1) is light.
    pub const fn is_light_down(&self, [x, y]: [usize; 2]) -> bool {
        self.down[y % 3][x % Self::LENGTH] == 1
    }

    /// Whether the dot between the corners (x, y) and (x + 1, y) is light.
    pub const fn is_light_right(&self, [x, y]: [usize; 2]) -> bool {
        self.right[x % 3][y % Self::LENGTH] == 1
    }
}

impl Puzzle {
    /// The diameter of a dot as published, as a share of the square's side.
    pub const DOT: f64 = 1.0 / 3.0;

    /// What is printed.
    ///
    /// # Errors
    /// A parameter out of its range; a board that reaches beyond the pattern.
    pub fn layout(&self) -> Result<Layout, BoardError> {
        self.check()?;
        let squares = (0..=self.rows).flat_map(|row| (0..=self.columns).map(move |column| (row, column)));
        let shapes = squares.filter(|(row, column)| self.is_dark(row + column)).map(|(row, column)| self.square(row, column));
        let inner = (1..=self.rows).flat_map(|row| (1..=self.columns).map(move |column| (row, column)));
        let point = |(row, column)| BoardPoint {
            id: format!("r{row}c{column}"),
            kind: TargetKind::ChessCorner,
            at: self.at(row, column),
            size: self.square,
            turns: u32::from(!self.is_dark(row + column)),
            room: (0.5 - 0.5 * self.dot) * self.square,
        };
        let ([u0, v1], [u1, v0]) = (self.at(0, 0), self.at(self.rows + 1, self.columns + 1));
        Ok(Layout { points: inner.map(point).collect(), markers: Vec::new(), shapes: shapes.collect(), printed: [[u0, v0], [u1, v1]] })
    }

    fn check(&self) -> Result<(), BoardError> {
        let side = PuzzleCodes::SIDE;
        counted("columns", self.columns, 6..=side)?;
        counted("rows", self.rows, 6..=side)?;
        length("square", self.square)?;
        within("dot", self.dot, 0.2..=0.4)?;
        for (parameter, place, count) in [("place[0]", self.place[0], self.columns), ("place[1]", self.place[1], self.rows)] {
            counted(parameter, place, 0..=side - count)?;
        }
        Ok(())
    }

    /// Whether a square is dark whose column and row, or those of the corner at its upper left, have this sum.
    const fn is_dark(&self, sum: usize) -> bool {
        (self.place[0] + self.place[1] + sum).is_multiple_of(2)
    }

    /// Where a line of corners is, squares; 0 and `count` + 1 are the rims.
    fn line(index: usize, count: usize) -> f64 {
        match index {
            0 => -0.5,
            _ if index > count => count as f64 - 0.5,
            _ => index as f64 - 1.0,
        }
    }

    /// A corner of squares; (0, 0) is the outermost at the upper left.
    fn at(&self, row: usize, column: usize) -> PlatePoint {
        // Plus zero: a zero without a sign.
        [Self::line(column, self.columns) * self.square, -Self::line(row, self.rows) * self.square + 0.0]
    }

    /// A dark square with the dots on its sides, counterclockwise.
    fn square(&self, row: usize, column: usize) -> Shape {
        let corners = [(row, column), (row + 1, column), (row + 1, column + 1), (row, column + 1)];
        let sides = (0..4).flat_map(|side| self.side(corners[side], corners[(side + 1) % 4]));
        Shape::dark(Outline(sides.collect()))
    }

    /// A side of a dark square that lies to the left of the way along it.
    fn side(&self, from: (usize, usize), to: (usize, usize)) -> Vec<Curve> {
        let [a, b] = [from, to].map(|(row, column)| self.at(row, column));
        let Some(light) = self.is_light(from, to) else { return vec![Curve::Line { from: a, to: b }] };
        let centre = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let start = (a[1] - b[1]).atan2(a[0] - b[0]);
        // A dark dot bulges out of the square, a light one into it.
        let sweep = if light { -PI } else { PI };
        let dot = Curve::Arc { centre, radius: 0.5 * self.dot * self.square, start, sweep };
        vec![Curve::Line { from: a, to: dot.at(0.0) }, dot, Curve::Line { from: dot.at(1.0), to: b }]
    }

    /// Whether the dot between two neighbouring corners is light; `None` where there is no dot.
    fn is_light(&self, a: (usize, usize), b: (usize, usize)) -> Option<bool> {
        let inner = |(row, column)| (1..=self.rows).contains(&row) && (1..=self.columns).contains(&column);
        if !inner(a) || !inner(b) {
            return None;
        }
        let (row, column) = (a.0.min(b.0), a.1.min(b.1));
        let at = [self.place[0] + column - 1, self.place[1] + row - 1];
        let codes = PuzzleCodes::published();
        Some(if a.0 == b.0 { codes.is_light_right(at) } else { codes.is_light_down(at) })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    fn board(text: &str) -> Layout {
        text.parse::<super::super::Board>().unwrap().layout().unwrap()
    }

    /// The beginning of the pattern as the makers' generator draws it: the upper left square is dark, the sides to the right of the first corner carry 1 1 0, those below it 0 0 0 0 1.
    #[test]
    fn the_pattern_begins_as_published() {
        let codes = PuzzleCodes::published();
        assert_eq!([0, 1, 2].map(|x| codes.is_light_right([x, 0])), [true, true, false]);
        assert_eq!([0, 1, 2, 3, 4].map(|x| codes.is_light_down([x, 0])), [false, false, false, false, true]);
        assert_eq!([0, 1, 2].map(|y| codes.is_light_down([1, y])), [false, true, true]);
        assert_eq!([3, 4].map(|y| codes.is_light_right([1, y])), [true, false], "10110: from the second line");
        assert_eq!(codes.down.iter().chain(&codes.right).flatten().map(|bit| u32::from(*bit)).sum::<u32>(), 501, "light ones, half of all");
        let layout = board("puzzle:8x6:30");
        assert_eq!(layout.printed, [[-15.0, -165.0], [225.0, 15.0]]);
        let darkest = layout.shapes[0].outline.0[0].at(0.0);
        assert_eq!(darkest, [-15.0, 15.0], "the upper left square is dark");
        assert_eq!((layout.points[0].turns, layout.points[1].turns), (0, 1));
        assert_eq!((layout.points[8].id.as_str(), layout.points[8].at), ("r2c1", [0.0, -30.0]));
        assert_eq!(board("puzzle:8x6:30:3,2").points[0].turns, 1, "an odd place begins with a light square");
    }

    /// Every dot is drawn once, into a dark square or out of it.
    #[test]
    fn dots_are_drawn_as_the_codes_say() {
        let puzzle = Puzzle { columns: 8, rows: 7, square: 1.0, place: [165, 499 - 7], dot: Puzzle::DOT };
        let mut drawn = BTreeMap::new();
        for shape in puzzle.layout().unwrap().shapes {
            let vertices: Vec<PlatePoint> = shape.outline.0.iter().map(|curve| curve.at(0.0)).collect();
            let middle = [0, 1].map(|i| {
                let all = vertices.iter().map(|at| at[i]);
                0.5 * (all.clone().fold(f64::INFINITY, f64::min) + all.fold(f64::NEG_INFINITY, f64::max))
            });
            for curve in &shape.outline.0 {
                let Curve::Arc { centre, radius, .. } = *curve else { continue };
                assert_eq!(radius, 1.0 / 6.0);
                let tip = curve.at(0.5);
                let far = |at: PlatePoint| (at[0] - middle[0]).hypot(at[1] - middle[1]);
                let key = centre.map(|value| (2.0 * value).round() as i64);
                assert_eq!(drawn.insert(key, far(tip) < far(centre)), None, "a dot twice");
            }
        }
        assert_eq!(drawn.len(), 7 * 7 + 6 * 8);
        let codes = PuzzleCodes::published();
        for ([u, v], light) in drawn {
            let at = [165 + u.div_euclid(2) as usize, 492 + (-v).div_euclid(2) as usize];
            let expected = if v % 2 == 0 { codes.is_light_right(at) } else { codes.is_light_down(at) };
            assert_eq!(light, expected, "({u}, {v}) halves");
        }
    }

    /// Every window of 5 x 5 corners is the only one with its dots, in whatever quarter turn: a claim of the makers.
    #[test]
    fn windows_of_five_by_five_corners_are_unique() {
        let codes = PuzzleCodes::published();
        let side = 5;
        let window = |x0: usize, y0: usize, turn: usize| {
            // The dots in the order in which a window that is turned has them.
            let across = |light: &dyn Fn(usize, usize) -> bool| {
                (0..side).flat_map(|v| (0..side - 1).map(move |u| (u, v))).fold(0_u64, |all, (u, v)| all << 1 | u64::from(light(u, v)))
            };
            let right = |u: usize, v: usize| codes.is_light_right([x0 + u, y0 + v]);
            let down = |u: usize, v: usize| codes.is_light_down([x0 + u, y0 + v]);
            let last = side - 1;
            match turn {
                0 => across(&|u, v| right(u, v)) << 20 | across(&|u, v| down(v, u)),
                1 => across(&|u, v| down(v, last - 1 - u)) << 20 | across(&|u, v| right(u, last - v)),
                2 => across(&|u, v| right(last - 1 - u, last - v)) << 20 | across(&|u, v| down(last - v, last - 1 - u)),
                _ => across(&|u, v| down(last - v, u)) << 20 | across(&|u, v| right(last - 1 - u, v)),
            }
        };
        let count = PuzzleCodes::SIDE - side + 1;
        let mut all = Vec::with_capacity(4 * count * count);
        for (x, y) in (0..count).flat_map(|y| (0..count).map(move |x| (x, y))) {
            all.extend((0..4).map(|turn| window(x, y, turn)));
        }
        assert_eq!(all.len(), 988_036);
        all.sort_unstable();
        assert!(all.windows(2).all(|pair| pair[0] != pair[1]));
    }
}
