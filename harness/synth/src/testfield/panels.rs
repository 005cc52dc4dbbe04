//! The sheets of a wall with relief: panels side by side, each at a depth and a tilt of its own.

use calibench_random::{Key, Purpose, stream};
use nalgebra::{Point3, Rotation3, Unit, Vector3};
use rand::RngExt;

use super::wall::Sheet;
use super::{FieldError, Levels, check};

/// Panels in rows and columns, around the origin in the plane of x and y, facing +z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Panels {
    /// Rows, from the top; 1 to 100.
    pub rows: usize,
    /// Columns, from the left; 1 to 100.
    pub columns: usize,
    /// Width and height of a panel, object units.
    pub size: [f64; 2],
    /// The gap between panels, object units. At least `width sin^2(tilt)`: tilted panels then never cut through each other.
    pub gap: f64,
    /// Depths are uniform from minus to plus this, object units.
    pub relief: f64,
    /// Tilts about both axes are uniform from minus to plus this, radians, at most 60 degrees.
    pub tilt: f64,
    /// Reflectances.
    pub levels: Levels,
}

impl Panels {
    /// The sheets, `p1-1` at the upper left. `key` seeds depths and tilts.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub fn sheets(&self, key: Key<'_>) -> Result<Vec<Sheet>, FieldError> {
        self.check()?;
        let panels = (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (row, column)));
        Ok(panels.map(|(row, column)| self.sheet(row, column, key)).collect())
    }

    fn check(&self) -> Result<(), FieldError> {
        check::counted("rows", self.rows, 1..=100)?;
        check::counted("columns", self.columns, 1..=100)?;
        check::length("width", self.size[0])?;
        check::length("height", self.size[1])?;
        check::distance("relief", self.relief)?;
        check::within("tilt", self.tilt.to_degrees(), 0.0..=60.0)?;
        check::distance("gap", self.gap)?;
        let least = self.size[0] * self.tilt.sin().powi(2);
        if self.gap < least {
            let expected = format!("at least {least}, for panels tilted by {} degrees", self.tilt.to_degrees());
            return Err(FieldError::Parameter { parameter: "gap", value: self.gap, expected });
        }
        check::levels(self.levels)
    }

    fn sheet(&self, row: usize, column: usize, key: Key<'_>) -> Sheet {
        let id = format!("p{}-{}", row + 1, column + 1);
        let mut rng = stream(Key { target: &id, ..key }, Purpose::Relief);
        let mut within = |most: f64| (2.0 * rng.random::<f64>() - 1.0) * most;
        let depth = within(self.relief);
        let about = |axis: Unit<Vector3<f64>>, angle| Rotation3::from_axis_angle(&axis, angle);
        let turned = about(Vector3::x_axis(), within(self.tilt)) * about(Vector3::y_axis(), within(self.tilt));
        let from_middle = |index: usize, count: usize| index as f64 - 0.5 * (count as f64 - 1.0);
        let x = from_middle(column, self.columns) * (self.size[0] + self.gap);
        let y = -from_middle(row, self.rows) * (self.size[1] + self.gap);
        Sheet {
            id,
            middle: Point3::new(x, y, depth),
            u: turned * Vector3::x(),
            v: turned * Vector3::y(),
            size: self.size,
            bend: None,
            levels: self.levels,
            shift: Vector3::zeros(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEY: Key<'_> = Key { seed: 5, of: "wall", trial: 0, view: "", target: "" };

    fn panels() -> Panels {
        let levels = Levels::default();
        Panels { rows: 3, columns: 4, size: [1.0, 0.7], gap: 0.3, relief: 0.4, tilt: 0.5, levels }
    }

    #[test]
    fn panels_stay_in_their_cells_and_within_their_bounds() {
        let sheets = panels().sheets(KEY).unwrap();
        assert_eq!((sheets.len(), sheets[0].id.as_str(), sheets[11].id.as_str()), (12, "p1-1", "p3-4"));
        assert!((sheets[0].middle.x + 1.95).abs() < 1e-12 && (sheets[0].middle.y - 1.0).abs() < 1e-12);
        for sheet in &sheets {
            assert!(sheet.middle.z.abs() <= 0.4 && sheet.u.cross(&sheet.v).z >= 0.5_f64.cos().powi(2));
            for corner in [[-0.5, -0.35], [0.5, -0.35], [0.5, 0.35], [-0.5, 0.35]] {
                let off = sheet.u * corner[0] + sheet.v * corner[1];
                assert!(off.x.abs() <= 0.5 + 1e-12 && off.y.abs() < 0.35 + 0.15, "{off}");
            }
        }
        assert_eq!(sheets, panels().sheets(KEY).unwrap());
        assert_ne!(sheets, panels().sheets(Key { seed: 6, ..KEY }).unwrap());
        assert!(sheets.windows(2).all(|pair| pair[0].middle.z != pair[1].middle.z));
    }

    #[test]
    fn bad_parameters_are_named() {
        let p = panels();
        let bad = [
            ("rows", Panels { rows: 0, ..p }),
            ("columns", Panels { columns: 101, ..p }),
            ("width", Panels { size: [0.0, 1.0], ..p }),
            ("height", Panels { size: [1.0, f64::NAN], ..p }),
            ("gap", Panels { gap: -0.1, ..p }),
            ("gap", Panels { gap: 0.1, ..p }),
            ("relief", Panels { relief: -1.0, ..p }),
            ("tilt", Panels { tilt: 1.2, ..p }),
            ("ink", Panels { levels: Levels { paper: 0.1, ink: 0.1 }, ..p }),
        ];
        for (name, panels) in bad {
            match panels.sheets(KEY) {
                Err(FieldError::Parameter { parameter, .. }) => assert_eq!(parameter, name),
                other => panic!("{name}: {other:?}"),
            }
        }
    }
}
