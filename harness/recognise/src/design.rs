//! The design of a coded field, read off the plate.

mod printed;

use calibench_model::target::BAR;
use calibench_model::testfield::PlatePoint;
use calibench_model::{Plate, TargetKind, Testfield};
use thiserror::Error;

use printed::{Cell, rectangle, target};

/// Targets in a square.
pub(crate) const IN_SQUARE: usize = 16;
/// How far coordinates that are one may differ, in squares.
const SAME: f64 = 1e-6;

/// A testfield that is not a coded one.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NotCoded {
    /// Not one sheet.
    #[error("the testfield has {0} sheets: expected the one sheet of a coded field")]
    Sheets(usize),
    /// No squares between lines.
    #[error("the testfield's sheet has no square grid of lines: expected a coded field")]
    NoGrid,
    /// A square without the sixteen targets.
    #[error(
        "square (row {row}, column {column}) of the testfield holds {found} targets: expected two small and two large ones of each of square, \
         triangle, cross and disc"
    )]
    Square {
        /// Counted from 1 at the top.
        row: usize,
        /// Counted from 1 at the left.
        column: usize,
        /// How many there are.
        found: usize,
    },
    /// A listed target that is not on the sheet.
    #[error("target `{0}` is not printed on the testfield's sheet")]
    NotPrinted(String),
}

/// The design: what is where, in squares from the field's top left corner, x to the right and y down.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Design {
    /// Squares to a side.
    pub squares: usize,
    /// The width of the lines, in squares.
    pub line: f64,
    /// Its top left corner on the plate: where the middles of the outermost lines meet.
    pub corner: PlatePoint,
    /// The side of a square from line to line, in the plate's unit.
    pub spacing: f64,
    /// The squares, row by row.
    pub cells: Vec<[Printed; IN_SQUARE]>,
}

/// A target of the design; lengths in squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Printed {
    /// Its kind.
    pub kind: TargetKind,
    /// Its reference point, from the field's top left corner.
    pub at: [f64; 2],
    /// Its own axes u and v, as long as its size.
    pub axes: [[f64; 2]; 2],
    /// Whether it is one of the large ones of its kind.
    pub large: bool,
    /// An index into the testfield's targets, if it is listed.
    pub target: Option<usize>,
}

impl Printed {
    /// Its area, in squares.
    pub fn area(&self) -> f64 {
        let side = self.axes[0][0].hypot(self.axes[0][1]);
        let share = match self.kind {
            TargetKind::Triangle => 3_f64.sqrt() / 4.0,
            TargetKind::Cross => BAR * (2.0 - BAR),
            TargetKind::Disc => std::f64::consts::FRAC_PI_4,
            _ => 1.0,
        };
        share * side * side
    }
}

impl Design {
    pub fn of(field: &Testfield) -> Result<Self, NotCoded> {
        let [plate] = field.plates.as_slice() else { return Err(NotCoded::Sheets(field.plates.len())) };
        let grid = Grid::of(plate)?;
        let mut cells = vec![Vec::new(); grid.squares * grid.squares];
        for area in plate.areas.iter().filter(|area| area.level < area.ground) {
            if let Some(cell) = target(&area.outline).filter(|cell| cell.size < grid.spacing / 2.0) {
                let printed = grid.printed(&cell);
                if let Some(square) = grid.square(printed.at) {
                    cells[square].push(printed);
                }
            }
        }
        for (index, target) in field.targets.iter().enumerate() {
            let at = grid.local(target.at);
            let own = grid.square(at).and_then(|square| cells[square].iter_mut().find(|p| near(p.at, at) && p.kind == target.kind));
            let printed = own.ok_or_else(|| NotCoded::NotPrinted(target.id.clone()))?;
            printed.axes = target.axes.map(|axis| grid.direction(axis, target.size));
            printed.target = Some(index);
        }
        let squares = grid.squares;
        let whole = |(index, cell): (usize, Vec<Printed>)| {
            let wrong = NotCoded::Square { row: index / squares + 1, column: index % squares + 1, found: cell.len() };
            sized(cell).ok_or(wrong)
        };
        let cells = cells.into_iter().enumerate().map(whole).collect::<Result<_, _>>()?;
        let Grid { corner, spacing, line, .. } = grid;
        Ok(Self { squares, line: line / spacing, corner, spacing, cells })
    }

    /// The area of the smallest target, in squares.
    pub fn smallest(&self) -> f64 {
        self.cells.iter().flatten().map(Printed::area).fold(1.0, f64::min)
    }

    /// The square at this row and column.
    pub fn cell(&self, row: usize, column: usize) -> &[Printed; IN_SQUARE] {
        &self.cells[row * self.squares + column]
    }
}

/// Tells the large ones from the small ones; `None` unless there are two and two of each kind.
fn sized(mut cell: Vec<Printed>) -> Option<[Printed; IN_SQUARE]> {
    let size = |p: &Printed| p.axes[0][0].hypot(p.axes[0][1]);
    for kind in [TargetKind::Square, TargetKind::Triangle, TargetKind::Cross, TargetKind::Disc] {
        let mut of: Vec<&mut Printed> = cell.iter_mut().filter(|p| p.kind == kind).collect();
        of.sort_by(|a, b| size(a).total_cmp(&size(b)));
        let [a, b, c, d] = of.as_mut_slice() else { return None };
        if size(b) >= size(c) * (1.0 - SAME) {
            return None;
        }
        (a.large, b.large, c.large, d.large) = (false, false, true, true);
    }
    cell.try_into().ok()
}

fn near(a: [f64; 2], b: [f64; 2]) -> bool {
    (a[0] - b[0]).hypot(a[1] - b[1]) < SAME
}

/// The grid of lines on the plate.
struct Grid {
    /// Its top left corner: where the middles of the outermost lines meet.
    corner: PlatePoint,
    spacing: f64,
    line: f64,
    squares: usize,
}

impl Grid {
    /// From the outlines of the squares between the lines, which are lighter than what is around them.
    fn of(plate: &Plate) -> Result<Self, NotCoded> {
        let light = plate.areas.iter().filter(|area| area.level > area.ground);
        let inner: Vec<[PlatePoint; 2]> = light.map(|area| rectangle(&area.outline).ok_or(NotCoded::NoGrid)).collect::<Result<_, _>>()?;
        let squares = inner.len().isqrt();
        let dark = plate.areas.iter().filter(|area| area.level < area.ground);
        let outer = dark.filter_map(|area| rectangle(&area.outline)).max_by(|a, b| (a[1][0] - a[0][0]).total_cmp(&(b[1][0] - b[0][0])));
        let Some([low, high]) = outer.filter(|_| squares > 0 && squares * squares == inner.len()) else { return Err(NotCoded::NoGrid) };
        // The outer side is n spacings and a line, an inner one a spacing less a line.
        let (whole, side, n) = (high[0] - low[0], inner[0][1][0] - inner[0][0][0], squares as f64);
        let spacing = (whole + side) / (n + 1.0);
        let grid =
            Self { corner: [low[0] + 0.5 * (spacing - side), high[1] - 0.5 * (spacing - side)], spacing, line: spacing - side, squares };
        let sound = grid.line > 0.0 && inner.iter().all(|inner| grid.holds(inner));
        if sound { Ok(grid) } else { Err(NotCoded::NoGrid) }
    }

    /// Whether this is the inside of one of its squares.
    fn holds(&self, [low, high]: &[PlatePoint; 2]) -> bool {
        let [left, bottom] = self.local(*low);
        let [right, top] = self.local(*high);
        let half = 0.5 * self.line / self.spacing;
        let whole = |x: f64| (x - x.round()).abs() < SAME;
        whole(left - half)
            && whole(top - half)
            && (right - left - 1.0 + 2.0 * half).abs() < SAME
            && (bottom - top - 1.0 + 2.0 * half).abs() < SAME
    }

    fn local(&self, [u, v]: PlatePoint) -> [f64; 2] {
        [(u - self.corner[0]) / self.spacing, (self.corner[1] - v) / self.spacing]
    }

    fn direction(&self, [u, v]: PlatePoint, length: f64) -> [f64; 2] {
        [u * length / self.spacing, -v * length / self.spacing]
    }

    fn square(&self, [x, y]: [f64; 2]) -> Option<usize> {
        let within = |x: f64| (x > 0.0 && x < self.squares as f64).then_some(x as usize);
        Some(within(y)? * self.squares + within(x)?)
    }

    fn printed(&self, cell: &Cell) -> Printed {
        let axes = cell.axes.map(|axis| self.direction(axis, cell.size));
        Printed { kind: cell.kind, at: self.local(cell.at), axes, large: false, target: None }
    }
}

#[cfg(test)]
mod tests;
