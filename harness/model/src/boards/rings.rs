//! Ring codes: a disc, and around it a ring of sectors that says which it is.

use super::layout::{BoardPoint, Layout, Shape};
use super::{BoardError, counted, length, within};
use crate::TargetKind;
use crate::testfield::{Curve, Outline, PlatePoint};

/// A grid of ring codes.
///
/// The sectors of a code read clockwise are a binary number; which of its rotations is the smallest is the code, whatever way it is turned. Codes are used in
/// ascending order; their ids count them from 1, the points are called `1`, `2`, ... The origin is the middle of the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rings {
    /// Sectors of a ring: 12, 14, 16 or 20.
    pub bits: usize,
    /// Codes in a row, 1 to 100.
    pub columns: usize,
    /// Rows of codes, 1 to 100.
    pub rows: usize,
    /// Distance of the middles of neighbouring codes, object units.
    pub spacing: f64,
    /// The diameter of the centre disc, object units.
    pub diameter: f64,
    /// Inner and outer diameter of the ring, in diameters of the disc.
    pub ring: [f64; 2],
    /// Whether the number of dark sectors is even: what differs by one sector is no code.
    pub even: bool,
    /// The first id that is used.
    pub first: usize,
}

/// The codes of `bits` sectors in ascending order: the smallest of their rotations, neither none nor all dark, `even` or any number dark.
///
/// # Panics
/// For more than 20 sectors.
pub fn ring_codes(bits: usize, even: bool) -> Vec<u32> {
    assert!(bits <= 20, "{bits} sectors");
    (1..(1_u32 << bits) - 1).filter(|&code| (!even || code.count_ones() % 2 == 0) && least_rotation(code, bits) == code).collect()
}

/// The smallest of the rotations of a ring's sectors.
///
/// # Panics
/// For a ring without sectors.
pub fn least_rotation(code: u32, bits: usize) -> u32 {
    let all = (1_u32 << bits) - 1;
    (0..bits).map(|turn| (code << turn | code >> (bits - turn)) & all).min().expect("at least one sector")
}

impl Rings {
    /// What is printed.
    ///
    /// # Errors
    /// A parameter out of its range; fewer codes than places.
    pub fn layout(&self) -> Result<Layout, BoardError> {
        self.check()?;
        let codes = ring_codes(self.bits, self.even);
        let (count, first) = (self.rows * self.columns, self.first);
        if first == 0 || first + count - 1 > codes.len() {
            let expected = format!("ids from 1 to {}: rings of {} sectors have no more", codes.len(), self.bits);
            return Err(BoardError::Parameter { parameter: "first", value: (first + count - 1) as f64, expected });
        }
        let places = (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (row, column)));
        let (mut points, mut shapes) = (Vec::new(), Vec::new());
        for ((row, column), id) in places.zip(first..) {
            let at = self.at(row, column);
            shapes.push(Shape::dark(Outline::disc(at, 0.5 * self.diameter)));
            shapes.extend(self.sectors(at, codes[id - 1]));
            let room = (0.5 * self.ring[0] - 0.5) * self.diameter;
            points.push(BoardPoint { id: id.to_string(), kind: TargetKind::Disc, at, size: self.diameter, turns: 0, room });
        }
        let (reach, [u, v]) = (0.5 * self.ring[1] * self.diameter, self.at(self.rows - 1, self.columns - 1));
        Ok(Layout { points, markers: Vec::new(), shapes, printed: [[-reach, v - reach], [u + reach, reach]] })
    }

    fn check(&self) -> Result<(), BoardError> {
        if ![12, 14, 16, 20].contains(&self.bits) {
            return Err(BoardError::Parameter { parameter: "bits", value: self.bits as f64, expected: "12, 14, 16 or 20".into() });
        }
        counted("columns", self.columns, 1..=100)?;
        counted("rows", self.rows, 1..=100)?;
        length("diameter", self.diameter)?;
        within("inner ring", self.ring[0], 1.2..=10.0)?;
        within("outer ring", self.ring[1], self.ring[0] + 0.1..=20.0)?;
        within("spacing", self.spacing, 1.1 * self.ring[1] * self.diameter..=1e6)
    }

    fn at(&self, row: usize, column: usize) -> PlatePoint {
        [column as f64 * self.spacing, -(row as f64 * self.spacing) + 0.0]
    }

    /// The runs of dark sectors; the highest bit begins at the top and runs clockwise.
    fn sectors(&self, centre: PlatePoint, code: u32) -> Vec<Shape> {
        let is_dark = |sector: usize| code >> (self.bits - 1 - sector % self.bits) & 1 == 1;
        let begins = (0..self.bits).filter(|&sector| is_dark(sector) && !is_dark(sector + self.bits - 1));
        begins
            .map(|from| {
                let count = (0..self.bits).take_while(|step| is_dark(from + step)).count();
                Shape::dark(self.sector(centre, from, count))
            })
            .collect()
    }

    fn sector(&self, centre: PlatePoint, from: usize, count: usize) -> Outline {
        let angle = |sector: usize| std::f64::consts::FRAC_PI_2 - sector as f64 * std::f64::consts::TAU / self.bits as f64;
        let (start, sweep) = (angle(from), angle(from + count) - angle(from));
        let [inner, outer] = self.ring.map(|diameters| 0.5 * diameters * self.diameter);
        let there = Curve::Arc { centre, radius: outer, start, sweep };
        let back = Curve::Arc { centre, radius: inner, start: start + sweep, sweep: -sweep };
        let line = |from: &Curve, to: &Curve| Curve::Line { from: from.at(1.0), to: to.at(0.0) };
        let (first, second) = (line(&there, &back), line(&back, &there));
        Outline(vec![there, first, back, second])
    }
}
