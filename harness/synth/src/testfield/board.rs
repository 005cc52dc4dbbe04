//! Boards with markers, circles or ring codes on a sheet.

use std::collections::BTreeMap;

use calibench_model::boards::{Board, Layout, Shape};
use calibench_model::testfield::{Curve, Outline, Plate, PlatePoint, Testfield};
use calibench_random::{Key, Purpose, stream};
use nalgebra::{Point3, Vector3};
use rand_distr::{Distribution, StandardNormal};

use super::{FieldError, Levels, SheetBend, check};

/// A board on a sheet in the plane z = 0 that faces +z; its first point is the origin, x to the right, y upwards.
///
/// The targets are the board's points, `surveyed` their places on a flat board printed without error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardSheet {
    /// The board.
    pub board: Board,
    /// The width of blank paper around what is printed, object units.
    pub margin: f64,
    /// The sheet's bend.
    pub bend: Option<SheetBend>,
    /// Standard deviation per axis of each printed point, object units; at most a fiftieth of the smallest target. What meets in a point shares its place.
    pub print_noise: f64,
    /// Reflectances; with ink lighter than paper the board is light on dark.
    pub levels: Levels,
    /// The radiance behind the board, as a fraction of full scale.
    pub background: f64,
}

/// Errors of printing by the place that a point is meant to have.
type Errors = BTreeMap<[u64; 2], PlatePoint>;

impl BoardSheet {
    /// The board. `key` seeds the print noise; its `target` is not used.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn generate(&self, key: Key<'_>) -> Result<Testfield, FieldError> {
        let layout = self.board.layout()?;
        self.check(&layout)?;
        let errors = self.errors(&layout, key);
        let corners = self.corners(&layout);
        let areas = layout.shapes.iter().map(|shape| moved(shape, &errors).area(self.levels.paper, self.levels.ink));
        let plate = Plate {
            id: "board".into(),
            origin: Point3::origin(),
            u: Vector3::x(),
            v: Vector3::y(),
            bend: self.bend.map(|bend| bend.over(corners)),
            corners,
            level: self.levels.paper,
            areas: areas.collect(),
        };
        let targets = layout.points.iter().map(|point| point.target(0, displaced(point.at, &errors))).collect();
        Ok(Testfield { targets, plates: vec![plate], background: self.background })
    }

    fn check(&self, layout: &Layout) -> Result<(), FieldError> {
        check::distance("margin", self.margin)?;
        let smallest = layout.points.iter().map(|point| point.size).fold(f64::INFINITY, f64::min);
        check::within("print_noise", self.print_noise, 0.0..=0.02 * smallest)?;
        if self.margin < 8.0 * self.print_noise {
            let expected = format!("at least 8 times `print_noise`, {}: printed points stay on the sheet", 8.0 * self.print_noise);
            return Err(FieldError::Parameter { parameter: "margin", value: self.margin, expected });
        }
        let [[u0, v0], [u1, v1]] = self.corners(layout);
        check::bend(self.bend, [u1 - u0, v1 - v0])?;
        check::levels(self.levels)?;
        check::within("background", self.background, 0.0..=1.0)
    }

    /// Two opposite corners of the sheet.
    fn corners(&self, layout: &Layout) -> [PlatePoint; 2] {
        let [low, high] = layout.printed;
        [low.map(|value| value - self.margin), high.map(|value| value + self.margin)]
    }

    fn errors(&self, layout: &Layout, key: Key<'_>) -> Errors {
        if self.print_noise == 0.0 {
            return Errors::new();
        }
        let error = |id: &str| {
            let mut rng = stream(Key { target: id, ..key }, Purpose::PrintNoise);
            [(); 2].map(|()| -> f64 { self.print_noise * Distribution::<f64>::sample(&StandardNormal, &mut rng) })
        };
        layout.points.iter().map(|point| (bits(point.at), error(&point.id))).collect()
    }
}

/// A place as a key: layouts compute what meets in a point by one formula, so that it is the same to the last bit.
fn bits(at: PlatePoint) -> [u64; 2] {
    at.map(|value| (value + 0.0).to_bits())
}

fn displaced(at: PlatePoint, errors: &Errors) -> PlatePoint {
    errors.get(&bits(at)).map_or(at, |error| [at[0] + error[0], at[1] + error[1]])
}

/// A shape as it is printed: circles around a point move with it, polygons where they meet it.
fn moved(shape: &Shape, errors: &Errors) -> Shape {
    let centre = shape.outline.0.iter().find_map(|curve| match curve {
        Curve::Arc { centre, .. } => errors.get(&bits(*centre)),
        Curve::Line { .. } => None,
    });
    let place = |at: PlatePoint| centre.map_or_else(|| displaced(at, errors), |error| [at[0] + error[0], at[1] + error[1]]);
    let curve = |curve: &Curve| match *curve {
        Curve::Line { from, to } => Curve::Line { from: place(from), to: place(to) },
        Curve::Arc { centre, radius, start, sweep } => Curve::Arc { centre: place(centre), radius, start, sweep },
    };
    Shape { outline: Outline(shape.outline.0.iter().map(curve).collect()), dark: shape.dark }
}

#[cfg(test)]
mod tests {
    use calibench_model::TargetKind;
    use calibench_model::boards::examples;

    use super::*;

    const KEY: Key<'_> = Key { seed: 11, of: "board", trial: 0, view: "", target: "" };

    fn sheet(text: &str, print_noise: f64) -> BoardSheet {
        BoardSheet { board: text.parse().unwrap(), margin: 10.0, bend: None, print_noise, levels: Levels::default(), background: 0.2 }
    }

    /// Every kind of board: what is printed at a target is printed where the target is, with and without noise of printing.
    #[test]
    fn every_kind_of_board_is_printed_where_its_targets_are() {
        for (kind, example) in examples() {
            let smallest = example.parse::<Board>().unwrap().layout().unwrap().points.iter().map(|p| p.size).fold(f64::INFINITY, f64::min);
            for noise in [0.0, 0.01 * smallest] {
                let field = sheet(example, noise).generate(KEY).unwrap();
                for target in &field.targets {
                    let touches = |curve: &Curve| match curve {
                        Curve::Line { from, .. } => *from == target.at,
                        Curve::Arc { centre, .. } => *centre == target.at,
                    };
                    let touching = field.plates[0].areas.iter().filter(|area| area.outline.0.iter().any(touches)).count();
                    let expected = if target.kind == TargetKind::ChessCorner { 2 } else { 1 };
                    assert!(touching >= expected, "{kind} {}: {touching} shapes", target.id);
                    let off = [target.at[0] - target.surveyed.x, target.at[1] - target.surveyed.y];
                    assert_eq!(off == [0.0, 0.0], noise == 0.0, "{kind} {}", target.id);
                }
            }
        }
    }

    #[test]
    fn bad_parameters_are_named() {
        let good = sheet("charuco:8x5:30:21:DICT_4X4_50", 0.0);
        for (name, bad) in [
            ("margin", BoardSheet { margin: -1.0, ..good }),
            ("margin", BoardSheet { margin: 1.0, print_noise: 0.5, ..good }),
            ("print_noise", BoardSheet { print_noise: 1.0, ..good }),
            ("bend", BoardSheet { bend: Some(SheetBend { peak: 100.0, across: 0.0 }), ..good }),
            ("ink", BoardSheet { levels: Levels { paper: 0.5, ink: 0.5 }, ..good }),
            ("background", BoardSheet { background: 2.0, ..good }),
        ] {
            assert!(matches!(bad.generate(KEY), Err(FieldError::Parameter { parameter, .. }) if parameter == name), "{name}");
        }
    }
}
