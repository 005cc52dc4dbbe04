//! The grid of splines as users name it.

use std::str::FromStr;

use calibench_diagnostics::nearest;
use calibench_model::camera::{ImageSize, Splined};

/// Control points at most: their matrix is dense.
const MOST: usize = 5000;
const EXPECTED: &str = "expected splined:COLUMNSxROWS:DEGREES:ORDER, as in splined:30x20:170:3";

/// A grid of control points: `splined:30x20:170:3` has 30 columns and 20 rows over a horizontal field of view of 170 degrees, of cubic splines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplineGrid {
    /// Columns of control points.
    pub columns: usize,
    /// Rows of control points.
    pub rows: usize,
    /// Horizontal field of view that the grid spans, degrees.
    pub fov_x_deg: f64,
    /// Order of the splines: 2 or 3.
    pub order: usize,
}

impl SplineGrid {
    /// Whether a model's name is that of splines, right or wrong.
    pub fn is_meant(model: &str) -> bool {
        model.split(':').next() == Some("splined")
    }

    /// Splines over the grid without control points that differ from zero.
    pub fn flat(&self, size: ImageSize, core: [f64; 4]) -> Splined {
        Splined::flat(size, core, self.order, [self.columns, self.rows], self.fov_x_deg)
    }

    /// The name of the model.
    pub fn name(&self) -> String {
        let Self { columns, rows, fov_x_deg, order } = self;
        format!("splined:{columns}x{rows}:{fov_x_deg}:{order}")
    }
}

impl FromStr for SplineGrid {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = |why: String| format!("`{text}`: {why}; {EXPECTED}");
        let parts: Vec<&str> = text.split(':').collect();
        let ["splined", grid, fov, order] = parts[..] else { return Err(wrong("no grid of splines".into())) };
        let (columns, rows) = grid.split_once('x').ok_or_else(|| wrong(format!("`{grid}` is no grid")))?;
        let count = |text: &str| text.parse::<usize>().map_err(|_| wrong(format!("`{text}` is no number of control points")));
        let (columns, rows) = (count(columns)?, count(rows)?);
        let fov_x_deg = fov.parse::<f64>().map_err(|_| wrong(format!("`{fov}` is no field of view")))?;
        let order = order.parse::<usize>().map_err(|_| wrong(format!("`{order}` is no order")))?;
        if columns.saturating_mul(rows) > MOST {
            return Err(wrong(format!("{columns} x {rows} control points, of {MOST} at most")));
        }
        let grid = Self { columns, rows, fov_x_deg, order };
        let size = ImageSize { width: 1, height: 1 };
        grid.flat(size, [1.0, 1.0, 0.0, 0.0]).check().map_err(wrong)?;
        Ok(grid)
    }
}

/// What is done with the core: fx, fy, cx and cy, which control points may stand for as well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Core {
    /// Where it is held or starts; of those that are `None` at the stereographic camera that is nearest to the images.
    pub values: [Option<f64>; 4],
    /// Which are solved for.
    pub free: [bool; 4],
}

/// Names of the core's parameters.
pub(super) const NAMES: [&str; 4] = ["fx", "fy", "cx", "cy"];

impl Core {
    /// Held where the start is.
    pub const HELD: Self = Self { values: [None; 4], free: [false; 4] };

    /// With the parameters `names` solved for.
    ///
    /// # Errors
    /// A name that the core does not have or that is held already, in words.
    pub fn solving(mut self, names: &[String]) -> Result<Self, String> {
        for name in names {
            let place = place(name)?;
            if self.values[place].is_some() {
                return Err(format!("{name} is held: expected it held or solved for"));
            }
            self.free[place] = true;
        }
        Ok(self)
    }

    /// Held at a value, from `fx=2018.96`.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn holding(mut self, text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}`: expected a parameter of the core and its value, as in fx=2018.96");
        let (name, value) = text.split_once('=').ok_or_else(wrong)?;
        let place = place(name.trim())?;
        let value = value.trim().parse::<f64>().ok().filter(|value| value.is_finite()).ok_or_else(wrong)?;
        if place < 2 && value <= 0.0 {
            return Err(format!("`{text}`: {} is a positive number", NAMES[place]));
        }
        if self.values[place].replace(value).is_some() {
            return Err(format!("{name} is held twice"));
        }
        Ok(self)
    }
}

fn place(name: &str) -> Result<usize, String> {
    NAMES.iter().position(|known| *known == name).ok_or_else(|| {
        let near = nearest(name, NAMES).map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        format!("the core of splines has no `{name}`: it has {}{near}", NAMES.join(", "))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_is_read_and_named_alike() {
        let grid: SplineGrid = "splined:30x20:170:3".parse().unwrap();
        assert_eq!(grid, SplineGrid { columns: 30, rows: 20, fov_x_deg: 170.0, order: 3 });
        assert_eq!(grid.name(), "splined:30x20:170:3");
        assert!(SplineGrid::is_meant("splined:") && SplineGrid::is_meant("splined") && !SplineGrid::is_meant("splines"));
    }

    #[test]
    fn what_is_no_grid_says_why() {
        for (text, why) in [
            ("splined", "no grid of splines"),
            ("splined:30:170:3", "`30` is no grid"),
            ("splined:0x0:170:3", "0 x 0 control points; expected more than 3"),
            ("splined:30x3:170:3", "expected more than 3"),
            ("splined:-3x4:170:3", "`-3` is no number"),
            ("splined:30x20:0:3", "field of view of 0"),
            ("splined:30x20:400:3", "field of view of 400"),
            ("splined:30x20:nan:3", "field of view"),
            ("splined:30x20:wide:3", "`wide` is no field of view"),
            ("splined:30x20:170:4", "order 4"),
            ("splined:30x20:170:1", "order 1"),
            ("splined:300x200:170:3", "of 5000 at most"),
            ("splined:99999999999999999999x2:170:3", "is no number of control points"),
            ("splined:4294967296x4294967296:170:3", "of 5000 at most"),
        ] {
            let error = text.parse::<SplineGrid>().unwrap_err();
            assert!(error.contains(why) && error.contains("splined:30x20:170:3"), "{text}: {error}");
        }
    }

    #[test]
    fn a_core_is_held_at_values_or_solved_for() {
        let core = Core::HELD.holding("fx=2000").unwrap().holding("cy = -3.5").unwrap().solving(&["cx".into()]).unwrap();
        assert_eq!(core, Core { values: [Some(2000.0), None, None, Some(-3.5)], free: [false, false, true, false] });
        for (text, why) in
            [("fx", "expected a parameter"), ("fx=0", "positive"), ("k1=3", "no `k1`"), ("fx=x", "expected"), ("fx=1e999", "expected")]
        {
            let error = Core::HELD.holding(text).unwrap_err();
            assert!(error.contains(why), "{text}: {error}");
        }
        assert!(core.holding("fx=1").unwrap_err().contains("twice"));
        assert!(Core::HELD.solving(&["fxx".into()]).unwrap_err().contains("did you mean `fx`"));
        assert!(core.solving(&["fx".into()]).unwrap_err().contains("fx is held"));
    }
}
