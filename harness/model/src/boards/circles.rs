//! Grids of circles.

use super::layout::{BoardPoint, Layout, Shape};
use super::marks::{Form, Mark, Marks};
use super::{BoardError, counted, length, within};
use crate::TargetKind;
use crate::testfield::{Outline, PlatePoint};

/// By how much the diameter of a disc has to differ from that of the others at least, as a factor.
const UNLIKE: f64 = 1.2;

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
    /// Circles unlike the others.
    pub marks: Marks,
}

impl Circles {
    /// What is printed.
    ///
    /// # Errors
    /// A parameter out of its range; circles that touch; a mark that is none or of no place.
    pub fn layout(&self) -> Result<Layout, BoardError> {
        self.check()?;
        let circles = || self.places().filter_map(|place| Some((place, self.circle(place)?)));
        let shapes = circles().flat_map(|(place, (diameter, hole))| {
            let at = self.at(place);
            let hole = hole.map(|hole| Shape::light(Outline::disc(at, 0.5 * hole)));
            std::iter::once(Shape::dark(Outline::disc(at, 0.5 * diameter))).chain(hole)
        });
        let point = |(place, (diameter, _)): ([usize; 2], (f64, _))| BoardPoint {
            id: id(place),
            kind: TargetKind::Disc,
            at: self.at(place),
            size: diameter,
            turns: 0,
            room: self.room(place),
        };
        let mut printed = [[0.0_f64; 2]; 2];
        for (place, (diameter, _)) in circles() {
            for (axis, at) in self.at(place).into_iter().enumerate() {
                printed[0][axis] = printed[0][axis].min(at - 0.5 * diameter);
                printed[1][axis] = printed[1][axis].max(at + 0.5 * diameter);
            }
        }
        Ok(Layout { points: circles().map(point).collect(), markers: Vec::new(), shapes: shapes.collect(), printed })
    }

    /// Columns and rows of all places, from 0, in the order of the points.
    pub fn places(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let columns = self.columns;
        (0..self.rows).flat_map(move |row| (0..columns).map(move |column| [column, row]))
    }

    /// How many half steps to the right of the first circle a place is and how many rows below, in an asymmetric grid; otherwise steps and rows.
    pub const fn steps(&self, [column, row]: [usize; 2]) -> [i32; 2] {
        if self.asymmetric { [(2 * column + row % 2) as i32, row as i32] } else { [column as i32, row as i32] }
    }

    /// The place so many [`Self::steps`] from the first; `None` where the grid has none.
    pub fn place(&self, [x, y]: [i32; 2]) -> Option<[usize; 2]> {
        let (x, row) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
        let column = if self.asymmetric { x.checked_sub(row % 2).filter(|twice| twice.is_multiple_of(2))? / 2 } else { x };
        (column < self.columns && row < self.rows).then_some([column, row])
    }

    /// Whether its marks say which circle is which: no turn of the whole grid maps them onto themselves.
    pub fn is_coded(&self) -> bool {
        let [right, below] = self.places().map(|place| self.steps(place)).fold([0, 0], |most, at| [most[0].max(at[0]), most[1].max(at[1])]);
        let turned = |[x, y]: [i32; 2], turn: usize| match turn {
            1 => [y, right - x],
            2 => [right - x, below - y],
            _ => [below - y, x],
        };
        let maps = |turn: usize| {
            let to = |place: [usize; 2]| self.place(turned(self.steps(place), turn));
            self.places().all(|place| to(place).is_some_and(|other| self.marks.at(place) == self.marks.at(other)))
        };
        !self.marks.is_empty() && !(1..4).any(maps)
    }

    /// The diameter and the hole of the circle at a place; `None` where there is none.
    fn circle(&self, place: [usize; 2]) -> Option<(f64, Option<f64>)> {
        match self.marks.at(place) {
            None => Some((self.diameter, self.hole)),
            Some(Form::Disc(diameter)) => Some((diameter, None)),
            Some(Form::Ring(diameter, hole)) => Some((diameter, Some(hole))),
            Some(Form::Gap) => None,
        }
    }

    /// How far the nearest circle is from a place, less its radius.
    fn room(&self, place: [usize; 2]) -> f64 {
        let at = self.at(place);
        let clear = |mark: Mark| {
            let there = self.at(mark.place);
            self.circle(mark.place)
                .filter(|_| mark.place != place)
                .map(|(diameter, _)| (at[0] - there[0]).hypot(at[1] - there[1]) - 0.5 * diameter)
        };
        self.marks.iter().filter_map(clear).fold(self.apart() - 0.5 * self.diameter, f64::min)
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
        self.hole.map_or(Ok(()), |hole| within("hole", hole, 0.1 * self.diameter..=0.9 * self.diameter))?;
        self.marks.iter().try_for_each(|mark| self.check_mark(mark))
    }

    fn check_mark(&self, mark: Mark) -> Result<(), BoardError> {
        let wrong = |why: &str| Err(BoardError::Text(format!("`{}@{}` {why}", mark.form, id(mark.place))));
        if mark.place[0] >= self.columns || mark.place[1] >= self.rows {
            return wrong(&format!("is beyond {} columns and {} rows", self.columns, self.rows));
        }
        if self.marks.iter().filter(|other| other.place == mark.place).count() > 1 {
            return wrong("is there twice");
        }
        let Some((diameter, hole)) = self.circle(mark.place) else {
            return if mark.place == [0, 0] { wrong("is the origin: turn the board so that r1c1 is a circle") } else { Ok(()) };
        };
        let most = 2.0 * self.room(mark.place) - 0.1 * self.apart();
        if !(0.05 * self.spacing..=most).contains(&diameter) {
            return wrong(&format!("has a diameter of {diameter}: expected {} to {most}", 0.05 * self.spacing));
        }
        if let Some(hole) = hole {
            within("hole", hole, 0.1 * diameter..=0.9 * diameter)?;
        }
        let differs = diameter.max(self.diameter) / diameter.min(self.diameter) >= UNLIKE || hole.is_some() != self.hole.is_some();
        if differs {
            Ok(())
        } else {
            wrong(&format!("is like the others: expected a ring beside discs, or {UNLIKE} times as large or small"))
        }
    }

    fn at(&self, place: [usize; 2]) -> PlatePoint {
        let [x, y] = self.steps(place);
        // Plus zero: a zero without a sign.
        [f64::from(x) * self.spacing, -(f64::from(y) * self.spacing) + 0.0]
    }
}

/// The name of the point at a place.
fn id([column, row]: [usize; 2]) -> String {
    format!("r{}c{}", row + 1, column + 1)
}
