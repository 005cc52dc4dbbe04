//! Grids of circles.

use super::layout::{BoardPoint, Layout, Shape};
use super::{BoardError, counted, length, within};
use crate::TargetKind;
use crate::testfield::{Outline, PlatePoint};

/// A grid of discs or rings, symmetric or asymmetric, as OpenCV numbers it: along the rows from the upper left, `r1c1` the first, which is the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circles {
    /// Circles in a row, 2 to 100.
    pub columns: usize,
    /// Rows of circles, 2 to 100.
    pub rows: usize,
    /// The distance of rows, object units. In a row circles of the symmetric grid are as far apart, of the asymmetric one twice as far.
    pub spacing: f64,
    /// The diameter, object units.
    pub diameter: f64,
    /// The diameter of what is left out in the middle of each, object units: rings.
    pub hole: Option<f64>,
    /// Every other row is moved by the spacing to the right.
    pub asymmetric: bool,
}

impl Circles {
    /// What is printed.
    ///
    /// # Errors
    /// A parameter out of its range; circles that touch.
    pub fn layout(&self) -> Result<Layout, BoardError> {
        self.check()?;
        let places = || (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (row, column)));
        let radius = 0.5 * self.diameter;
        let shapes = places().flat_map(|(row, column)| {
            let at = self.at(row, column);
            let hole = self.hole.map(|hole| Shape::light(Outline::disc(at, 0.5 * hole)));
            std::iter::once(Shape::dark(Outline::disc(at, radius))).chain(hole)
        });
        let point = |(row, column)| BoardPoint {
            id: format!("r{}c{}", row + 1, column + 1),
            kind: TargetKind::Disc,
            at: self.at(row, column),
            size: self.diameter,
            turns: 0,
            room: self.apart() - radius,
        };
        let last = (0..self.rows).map(|row| self.at(row, self.columns - 1)[0]).fold(0.0, f64::max);
        let printed = [[-radius, -((self.rows - 1) as f64 * self.spacing) - radius], [last + radius, radius]];
        Ok(Layout { points: places().map(point).collect(), markers: Vec::new(), shapes: shapes.collect(), printed })
    }

    /// Distance of the nearest two, object units.
    fn apart(&self) -> f64 {
        if self.asymmetric { std::f64::consts::SQRT_2 * self.spacing } else { self.spacing }
    }

    fn check(&self) -> Result<(), BoardError> {
        counted("columns", self.columns, 2..=100)?;
        counted("rows", self.rows, 2..=100)?;
        length("spacing", self.spacing)?;
        within("diameter", self.diameter, 0.05 * self.spacing..=0.95 * self.apart())?;
        self.hole.map_or(Ok(()), |hole| within("hole", hole, 0.1 * self.diameter..=0.9 * self.diameter))
    }

    fn at(&self, row: usize, column: usize) -> PlatePoint {
        let steps = if self.asymmetric { (2 * column + row % 2) as f64 } else { column as f64 };
        // Plus zero: a zero without a sign.
        [steps * self.spacing, -(row as f64 * self.spacing) + 0.0]
    }
}
