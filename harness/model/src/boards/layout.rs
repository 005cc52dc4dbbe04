//! What is printed on a board, and where its points are.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Point3;

use crate::TargetKind;
use crate::boards::Dictionary;
use crate::testfield::{Area, ObjectTarget, Outline, PlatePoint, axes};

/// A plane board as it is meant to be: u to the right, v upwards, seen from its front; object units.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Its points, in the order of their names.
    pub points: Vec<BoardPoint>,
    /// Its markers.
    pub markers: Vec<Marker>,
    /// What is dark or, within what is dark, light again.
    pub shapes: Vec<Shape>,
    /// Two opposite corners of what is printed, the lower values first.
    pub printed: [PlatePoint; 2],
}

/// A point of a board that is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct BoardPoint {
    /// Its name.
    pub id: String,
    /// What is pictured there.
    pub kind: TargetKind,
    /// Where, object units.
    pub at: PlatePoint,
    /// Its size as of any target, object units.
    pub size: f64,
    /// Quarter turns from u towards v of its own axes: of a chess corner whose dark squares lie at the lower right and the upper left, none.
    pub turns: u32,
    /// The half side of the largest upright square around it that holds nothing else, object units.
    pub room: f64,
}

/// A square marker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marker {
    /// Its id in the dictionary.
    pub id: u32,
    /// Its outer corners, clockwise as one reads it, from its own upper left; object units.
    pub corners: [PlatePoint; 4],
}

/// A shape that is printed, or left out of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Its border.
    pub outline: Outline,
    /// Whether it is dark; a light one lies in a dark one.
    pub dark: bool,
}

impl BoardPoint {
    /// The point as a target of plate `plate` that is printed at `at`.
    pub fn target(&self, plate: usize, at: PlatePoint) -> ObjectTarget {
        ObjectTarget {
            id: self.id.clone(),
            kind: self.kind,
            plate,
            at,
            size: self.size,
            axes: axes(f64::from(self.turns) * FRAC_PI_2),
            surveyed: Point3::new(self.at[0], self.at[1], 0.0),
            room: Some(self.room),
        }
    }
}

impl Shape {
    /// A dark one.
    pub const fn dark(outline: Outline) -> Self {
        Self { outline, dark: true }
    }

    /// A light one in a dark one.
    pub const fn light(outline: Outline) -> Self {
        Self { outline, dark: false }
    }

    /// As an area of these reflectances.
    pub fn area(self, paper: f64, ink: f64) -> Area {
        let (level, ground) = if self.dark { (ink, paper) } else { (paper, ink) };
        Area { outline: self.outline, level, ground }
    }
}

/// The shapes of a marker: its dark square and, row by row, the runs of white cells in it. `border` is how many cells wide its frame is.
///
/// # Panics
/// If the dictionary has no such id.
pub fn marker_shapes(marker: &Marker, dictionary: &Dictionary, border: usize) -> Vec<Shape> {
    let cells = dictionary.side + 2 * border;
    let [a, b, c, d] = marker.corners;
    // The cells' corners; (0, 0) is the marker's upper left.
    let at = |row: usize, column: usize| {
        let (s, t) = (column as f64 / cells as f64, row as f64 / cells as f64);
        [0, 1].map(|i| (1.0 - s) * (1.0 - t) * a[i] + s * (1.0 - t) * b[i] + s * t * c[i] + (1.0 - s) * t * d[i])
    };
    let mut shapes = vec![Shape::dark(Outline::polygon(&[a, d, c, b]))];
    for row in 0..dictionary.side {
        let white = |column: usize| dictionary.is_white(marker.id, row, column).expect("an id of the dictionary");
        let mut column = 0;
        while column < dictionary.side {
            let from = column;
            while column < dictionary.side && white(column) {
                column += 1;
            }
            if column > from {
                let ([r, r1], [c0, c1]) = ([row + border, row + border + 1], [from + border, column + border]);
                shapes.push(Shape::light(Outline::polygon(&[at(r, c0), at(r1, c0), at(r1, c1), at(r, c1)])));
            }
            column += 1;
        }
    }
    shapes
}

/// The corners of an upright square marker, clockwise from its upper left, `turns` quarter turns clockwise from upright.
pub fn square_marker([u, v]: PlatePoint, side: f64, turns: usize) -> [PlatePoint; 4] {
    let mut corners = [[u, v + side], [u + side, v + side], [u + side, v], [u, v]];
    corners.rotate_left(turns % 4);
    corners
}
