//! The planar chessboard.

use std::f64::consts::FRAC_PI_2;

use calibench_model::TargetKind;
use calibench_model::testfield::{Area, ObjectTarget, Outline, Plate, PlatePoint, Testfield, axes};
use calibench_random::{Key, Purpose, stream};
use nalgebra::{Point3, Vector3};
use rand_distr::{Distribution, StandardNormal};

use super::{FieldError, Levels, SheetBend, check};

/// A chessboard, counted in inner corners, on a sheet in the plane z = 0 that faces +z.
///
/// The first inner corner, `r1c1`, is the origin; columns grow along x, rows against y, as one reads. The square at the upper left is of ink.
/// The targets are the inner corners, their size the square's side, `surveyed` their places on a flat board printed without error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chessboard {
    /// Rows of inner corners, 1 to 1000.
    pub rows: usize,
    /// Inner corners in a row, 1 to 1000.
    pub columns: usize,
    /// The side of a square, object units.
    pub square: f64,
    /// The width of blank paper around the squares, object units.
    pub margin: f64,
    /// The sheet's bend.
    pub bend: Option<SheetBend>,
    /// Standard deviation per axis of each printed corner, object units; at most a fiftieth of a square. The squares at a corner share its place.
    pub print_noise: f64,
    /// Reflectances.
    pub levels: Levels,
    /// The radiance behind the board, as a fraction of full scale.
    pub background: f64,
}

impl Chessboard {
    /// The board. `key` seeds the print noise; its `target` is not used.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn generate(&self, key: Key<'_>) -> Result<Testfield, FieldError> {
        self.check()?;
        let corners = self.corners();
        let printed = self.printed(key);
        let at = |row: usize, column: usize| printed[row * (self.columns + 2) + column];
        let squares = (0..=self.rows).flat_map(|row| (0..=self.columns).map(move |column| (row, column)));
        let dark = squares.filter(|(row, column)| (row + column) % 2 == 0);
        let area = |(row, column): (usize, usize)| Area {
            outline: Outline::polygon(&[at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)]),
            level: self.levels.ink,
            ground: self.levels.paper,
        };
        let plate = Plate {
            id: "board".into(),
            origin: Point3::origin(),
            u: Vector3::x(),
            v: Vector3::y(),
            bend: self.bend.map(|bend| bend.over(corners)),
            corners,
            level: self.levels.paper,
            areas: dark.map(area).collect(),
        };
        let inner = (1..=self.rows).flat_map(|row| (1..=self.columns).map(move |column| (row, column)));
        let target = |(row, column)| {
            let [u, v] = self.nominal(row, column);
            ObjectTarget {
                id: format!("r{row}c{column}"),
                kind: TargetKind::ChessCorner,
                plate: 0,
                at: at(row, column),
                size: self.square,
                // The dark squares lie at the lower right and the upper left of every other corner.
                axes: axes(if (row + column) % 2 == 0 { 0.0 } else { FRAC_PI_2 }),
                surveyed: Point3::new(u, v, 0.0),
                room: Some(self.square),
            }
        };
        Ok(Testfield { targets: inner.map(target).collect(), plates: vec![plate], background: self.background })
    }

    fn check(&self) -> Result<(), FieldError> {
        check::counted("rows", self.rows, 1..=1000)?;
        check::counted("columns", self.columns, 1..=1000)?;
        check::length("square", self.square)?;
        check::distance("margin", self.margin)?;
        check::within("print_noise", self.print_noise, 0.0..=0.02 * self.square)?;
        if self.margin < 8.0 * self.print_noise {
            let expected = format!("at least 8 times `print_noise`, {}: printed corners stay on the sheet", 8.0 * self.print_noise);
            return Err(FieldError::Parameter { parameter: "margin", value: self.margin, expected });
        }
        let [[u0, v0], [u1, v1]] = self.corners();
        check::bend(self.bend, [u1 - u0, v1 - v0])?;
        check::levels(self.levels)?;
        check::within("background", self.background, 0.0..=1.0)
    }

    /// Two opposite corners of the sheet.
    fn corners(&self) -> [PlatePoint; 2] {
        let ([u0, v1], [u1, v0]) = (self.nominal(0, 0), self.nominal(self.rows + 1, self.columns + 1));
        [[u0 - self.margin, v0 - self.margin], [u1 + self.margin, v1 + self.margin]]
    }

    /// Where the corner of squares is meant to be; (0, 0) is the outermost at the upper left, (1, 1) the first inner one.
    fn nominal(&self, row: usize, column: usize) -> PlatePoint {
        [(column as f64 - 1.0) * self.square, (1.0 - row as f64) * self.square]
    }

    /// Where all corners of squares are printed, row by row.
    fn printed(&self, key: Key<'_>) -> Vec<PlatePoint> {
        let corners = (0..self.rows + 2).flat_map(|row| (0..self.columns + 2).map(move |column| (row, column)));
        let place = |(row, column)| {
            let [u, v] = self.nominal(row, column);
            if self.print_noise == 0.0 {
                return [u, v];
            }
            let mut rng = stream(Key { target: &format!("r{row}c{column}"), ..key }, Purpose::PrintNoise);
            let mut error = || -> f64 { self.print_noise * Distribution::<f64>::sample(&StandardNormal, &mut rng) };
            [u + error(), v + error()]
        };
        corners.map(place).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::outline::polygon;
    use super::*;
    use crate::overlap::overlap;

    const KEY: Key<'_> = Key { seed: 11, of: "board", trial: 0, view: "", target: "" };

    fn board() -> Chessboard {
        let levels = Levels { paper: 0.9, ink: 0.1 };
        Chessboard { rows: 6, columns: 9, square: 30.0, margin: 15.0, bend: None, print_noise: 0.0, levels, background: 0.5 }
    }

    #[test]
    fn corners_are_counted_and_spaced_as_one_reads() {
        let field = board().generate(KEY).unwrap();
        assert_eq!((field.targets.len(), field.plates[0].areas.len()), (54, 35));
        let ids: Vec<&str> = field.targets.iter().map(|t| t.id.as_str()).collect();
        assert_eq!([ids[0], ids[8], ids[9], ids[53]], ["r1c1", "r1c9", "r2c1", "r6c9"]);
        assert_eq!(field.targets[53].surveyed, Point3::new(240.0, -150.0, 0.0));
        assert!(field.targets.iter().all(|t| field.position(t) == t.surveyed));
        assert_eq!(field.plates[0].corners, [[-45.0, -195.0], [285.0, 45.0]]);
    }

    #[test]
    fn every_inner_corner_is_a_vertex_of_two_squares_and_no_two_overlap() {
        let field = Chessboard { print_noise: 0.6, ..board() }.generate(KEY).unwrap();
        let plate = &field.plates[0];
        for target in &field.targets {
            let vertices = plate.areas.iter().flat_map(|area| &area.outline.0).filter(|curve| curve.at(0.0) == target.at);
            assert_eq!(vertices.count(), 2, "{}", target.id);
        }
        let polygons: Vec<_> = plate.areas.iter().map(|area| polygon(&area.outline)).collect();
        for (i, a) in polygons.iter().enumerate() {
            assert!(polygons[..i].iter().all(|b| overlap(a, b).is_none()));
        }
    }

    #[test]
    fn print_noise_has_its_standard_deviation_and_its_seed() {
        let noisy = Chessboard { rows: 60, columns: 80, print_noise: 0.3, ..board() };
        let field = noisy.generate(KEY).unwrap();
        let errors: Vec<f64> = field.targets.iter().flat_map(|t| [t.at[0] - t.surveyed.x, t.at[1] - t.surveyed.y]).collect();
        let n = errors.len() as f64;
        let variance = errors.iter().map(|e| e * e).sum::<f64>() / n / 0.09;
        // Five standard errors, of a seed fixed beforehand.
        assert!((variance - 1.0).abs() < 5.0 * (2.0 / n).sqrt(), "{variance}");
        assert!((errors.iter().sum::<f64>() / n).abs() < 5.0 * 0.3 / n.sqrt());
        assert_eq!(field, noisy.generate(KEY).unwrap());
        assert_ne!(field, noisy.generate(Key { seed: 12, ..KEY }).unwrap());
        let smaller = Chessboard { rows: 5, ..noisy }.generate(KEY).unwrap();
        assert_eq!(smaller.targets[..], field.targets[..400], "another row changes none of the others");
    }

    #[test]
    fn a_bent_board_is_highest_in_its_middle_and_is_surveyed_flat() {
        let bend = Some(SheetBend { peak: 0.8, across: 0.0 });
        let field = Chessboard { columns: 9, bend, ..board() }.generate(KEY).unwrap();
        let middle = field.targets.iter().find(|t| t.id == "r3c5").unwrap();
        assert_eq!(field.position(middle), Point3::new(120.0, -60.0, 0.8));
        assert_eq!(middle.surveyed.z, 0.0);
        let plate = &field.plates[0];
        assert!(plate.corners.iter().all(|&corner| plate.point(corner).z.abs() < 1e-12), "the edges across the bend are in the plane");
    }

    #[test]
    fn bad_parameters_are_named() {
        let b = board();
        let bent = |peak| Chessboard { bend: Some(SheetBend { peak, across: 0.0 }), ..b };
        let bad = [
            ("rows", Chessboard { rows: 0, ..b }),
            ("columns", Chessboard { columns: 1001, ..b }),
            ("square", Chessboard { square: -1.0, ..b }),
            ("square", Chessboard { square: f64::NAN, ..b }),
            ("margin", Chessboard { margin: f64::INFINITY, ..b }),
            ("margin", Chessboard { margin: 1.0, print_noise: 0.5, ..b }),
            ("print_noise", Chessboard { print_noise: 3.0, ..b }),
            ("print_noise", Chessboard { print_noise: -0.1, ..b }),
            ("bend", bent(100.0)),
            ("bend", bent(f64::NAN)),
            ("bend_across", Chessboard { bend: Some(SheetBend { peak: 1.0, across: f64::NAN }), ..b }),
            ("paper", Chessboard { levels: Levels { paper: 1.2, ink: 0.0 }, ..b }),
            ("ink", Chessboard { levels: Levels { paper: 0.5, ink: 0.5 }, ..b }),
            ("background", Chessboard { background: -0.1, ..b }),
        ];
        for (name, board) in bad {
            match board.generate(KEY) {
                Err(FieldError::Parameter { parameter, .. }) => assert_eq!(parameter, name),
                other => panic!("{name}: {other:?}"),
            }
        }
    }
}
