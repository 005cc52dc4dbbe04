//! The coded target field of Vosselman & Förstner: squares between straight lines, sixteen targets in each.

use calibench_model::target::BAR;
use calibench_model::testfield::{Area, ObjectTarget, Outline, Plate, PlatePoint, Testfield};
use calibench_random::{Key, Purpose, stream};
use nalgebra::{Point3, Vector3};
use rand::seq::SliceRandom;
use rayon::prelude::*;

use super::{FieldError, Levels, Shape, SheetBend, check};

mod cluster;

pub use calibench_model::coded::code;
use cluster::Cluster;

/// The four shapes, in the order of sizes and codes. The bars of crosses are a third of their length wide.
pub const SHAPES: [Shape; 4] = [Shape::Square, Shape::Triangle, Shape::Cross { bar: BAR }, Shape::Disc];

/// A plane field of 8 x 8 squares between straight lines; in each square two small and two large targets of each of four shapes.
///
/// What the text requires: every square is told from the others by topology, here by which of the segments between its four pairs of large targets cross
/// (six yes or no, 64 codes for 64 squares; the text has "combinations of intersections between imaginary lines through pairs of targets"), and its
/// squares and triangles are smaller than its crosses and discs. Where the text leaves freedom the field is random: which code is where, the places
/// within the square, the turn of each target. Two equal targets are told apart by their distance from the middle of the pair of the same shape and the
/// other size: the nearer is the first. (The text says "in a similar way".)
///
/// The sheet lies in the plane z = 0 with its middle at the origin and faces +z. `surveyed` are the places on the flat sheet.
///
/// Source: Vosselman & Förstner 1988, sections 2.1 and 3.3, tables 2 and 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coded {
    /// Squares to a side, 1 to 8.
    pub squares: usize,
    /// Squares to a side, around the middle, whose targets are listed; the others are printed only. As many more or less than `squares` as is even.
    pub measured: usize,
    /// The distance of the lines, object units.
    pub spacing: f64,
    /// The width of the lines, object units.
    pub line: f64,
    /// The side of the sheet, object units.
    pub sheet: f64,
    /// The sizes of the small targets, in the order of [`SHAPES`], object units.
    pub small: [f64; 4],
    /// The sizes of the large targets, in the order of [`SHAPES`], object units.
    pub large: [f64; 4],
    /// The sheet's bend.
    pub bend: Option<SheetBend>,
    /// Reflectances.
    pub levels: Levels,
    /// The radiance behind the sheet, as a fraction of full scale.
    pub background: f64,
}

impl Coded {
    /// The field of the paper, in mm: 1200 mm, lines of 2 mm every 125 mm, small targets of 9 to 15 mm, large ones of 17 to 25 mm, a bend of 0.8 mm
    /// and the central 16 squares measured. The sizes within those ranges, the reflectances and the bend's direction are ours.
    pub fn paper() -> Self {
        Self {
            squares: 8,
            measured: 4,
            spacing: 125.0,
            line: 2.0,
            sheet: 1200.0,
            small: [9.0, 13.0, 15.0, 13.0],
            large: [17.0, 25.0, 25.0, 24.0],
            bend: Some(SheetBend { peak: 0.8, across: 0.0 }),
            levels: Levels { paper: 0.85, ink: 0.05 },
            background: 0.2,
        }
    }

    /// The field; its targets are called as in `r3c5-large-disc-1`. `key` seeds what the text leaves free; its `target` is not used.
    ///
    /// # Errors
    /// A parameter out of its range; [`FieldError::Ambiguous`] if a square's targets leave no room for its code.
    pub fn generate(&self, key: Key<'_>) -> Result<Testfield, FieldError> {
        self.check()?;
        let Levels { paper, ink } = self.levels;
        let mut codes: Vec<u8> = (0..64).collect();
        codes.shuffle(&mut stream(Key { target: "", ..key }, Purpose::Layout));
        let mut areas = vec![Area { outline: self.square_at(0, 0, self.squares, self.line), level: ink, ground: paper }];
        let mut targets = Vec::new();
        let squares: Vec<(usize, usize)> = (0..self.squares).flat_map(|row| (0..self.squares).map(move |column| (row, column))).collect();
        let arrange = |&(row, column): &(usize, usize)| {
            let name = name_of(row, column);
            Cluster::arranged(self, codes[row * 8 + column], &mut stream(Key { target: &name, ..key }, Purpose::Layout))
        };
        // Each has its own stream of random numbers.
        let arranged: Vec<Option<Cluster>> = squares.par_iter().map(arrange).collect();
        for ((row, column), cluster) in squares.into_iter().zip(arranged) {
            areas.push(Area { outline: self.square_at(row, column, 1, -self.line), level: paper, ground: ink });
            let name = name_of(row, column);
            let cluster = cluster.ok_or_else(|| FieldError::Ambiguous(name.clone()))?;
            let listed = self.is_measured(row) && self.is_measured(column);
            let middle = self.middle(row, column);
            for printed in &cluster.targets {
                let at = [middle[0] + printed.at[0], middle[1] + printed.at[1]];
                let shape = SHAPES[printed.pair % 4];
                let size = self.size(printed.pair);
                let outlines = shape.outlines(at, size, printed.turn);
                areas.extend(outlines.into_iter().map(|outline| Area { outline, level: ink, ground: paper }));
                if listed {
                    let surveyed = Point3::new(at[0], at[1], 0.0);
                    let id = format!("{name}-{}", printed.name());
                    targets.push(ObjectTarget {
                        id,
                        kind: shape.kind(),
                        plate: 0,
                        at,
                        size,
                        axes: shape.axes(printed.turn),
                        surveyed,
                        room: None,
                    });
                }
            }
        }
        let half = 0.5 * self.sheet;
        let corners = [[-half, -half], [half, half]];
        let bend = self.bend.map(|bend| bend.over(corners));
        let (origin, u, v, level) = (Point3::origin(), Vector3::x(), Vector3::y(), self.levels.paper);
        let plate = Plate { id: "field".into(), origin, u, v, bend, corners, level, areas };
        Ok(Testfield { plates: vec![plate], targets, background: self.background })
    }

    fn check(&self) -> Result<(), FieldError> {
        check::counted("squares", self.squares, 1..=8)?;
        check::counted("measured", self.measured, 1..=self.squares)?;
        if !(self.squares - self.measured).is_multiple_of(2) {
            let expected = format!("as even or odd as `squares`, {}", self.squares);
            return Err(FieldError::Parameter { parameter: "measured", value: self.measured as f64, expected });
        }
        check::length("spacing", self.spacing)?;
        check::within("line", self.line, 1e-6 * self.spacing..=0.25 * self.spacing)?;
        let most = 0.5 * self.cell();
        for (name, sizes) in [("small", self.small), ("large", self.large)] {
            for (shape, size) in SHAPES.into_iter().zip(sizes) {
                check::length(name, size)?;
                let reach = shape.reach(size);
                if reach > most {
                    let expected = format!("a {} of at most {}: sixteen have room in a square", shape.kind(), size * most / reach);
                    return Err(FieldError::Parameter { parameter: name, value: size, expected });
                }
            }
        }
        check::within("sheet", self.sheet, self.squares as f64 * self.spacing + self.line..=1e6)?;
        check::bend(self.bend, [self.sheet; 2])?;
        check::levels(self.levels)?;
        check::within("background", self.background, 0.0..=1.0)
    }

    /// The side of the sixteenth of a square that is one target's.
    fn cell(&self) -> f64 {
        0.25 * (self.spacing - self.line)
    }

    fn size(&self, pair: usize) -> f64 {
        [self.small, self.large][pair / 4][pair % 4]
    }

    fn is_measured(&self, index: usize) -> bool {
        let first = (self.squares - self.measured) / 2;
        (first..first + self.measured).contains(&index)
    }

    /// The middle of a square; rows from the top.
    fn middle(&self, row: usize, column: usize) -> PlatePoint {
        let from_middle = |index: usize| (index as f64 - 0.5 * (self.squares as f64 - 1.0)) * self.spacing;
        [from_middle(column), -from_middle(row)]
    }

    /// A square of `count` squares to a side from (row, column) on, wider by `more`.
    fn square_at(&self, row: usize, column: usize, count: usize, more: f64) -> Outline {
        let (first, last) = (self.middle(row, column), self.middle(row + count - 1, column + count - 1));
        let half = 0.5 * (self.spacing + more);
        Outline::rectangle([first[0] - half, last[1] - half], [last[0] + half, first[1] + half])
    }
}

/// What a square is called.
fn name_of(row: usize, column: usize) -> String {
    format!("r{}c{}", row + 1, column + 1)
}

#[cfg(test)]
mod tests;
