//! Control that is a raster of columns and rows.

use calibench_model::ControlRow;

/// Coordinates that differ by less than this share of the extent are the same.
const SAME: f64 = 1e-6;

/// A raster, every place of which is a control point.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Raster {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// X of the columns and Y of the rows, object units, ascending.
    pub(crate) at: [Vec<f64>; 2],
    /// The column and the row of each control point.
    pub(crate) places: Vec<[usize; 2]>,
}

impl Raster {
    /// That of control in a plane of constant Z; `None` where it is none.
    pub(crate) fn of(control: &[ControlRow]) -> Option<Self> {
        let at = [0, 1].map(|axis| distinct(control.iter().map(|row| row.position[axis]).collect()));
        let (columns, rows) = (at[0].len(), at[1].len());
        let flat = control.first().is_some_and(|first| control.iter().all(|row| row.position[2] == first.position[2]));
        if !flat || columns < 2 || rows < 2 || columns * rows != control.len() {
            return None;
        }
        let place = |row: &ControlRow| [0, 1].map(|axis| nearest(&at[axis], row.position[axis]));
        let places: Vec<[usize; 2]> = control.iter().map(place).collect();
        let mut taken = vec![false; control.len()];
        places.iter().for_each(|[column, row]| taken[row * columns + column] = true);
        taken.into_iter().all(|taken| taken).then_some(Self { columns, rows, at, places })
    }

    /// The control if its points, in their order, fill as many rows as there are columns; `None` of a square raster and of uneven steps.
    pub(crate) fn exchanged(&self, control: &[ControlRow]) -> Option<Vec<ControlRow>> {
        let steps = [0, 1].map(|axis| even(&self.at[axis]));
        let [Some(dx), Some(dy)] = steps else { return None };
        if self.columns == self.rows {
            return None;
        }
        let by_rows = self.places.iter().enumerate().all(|(k, [column, row])| {
            let row = if self.places[0][1] == 0 { *row } else { self.rows - 1 - row };
            k == row * self.columns + column
        });
        let turned = |(k, row): (usize, &ControlRow)| {
            let (column, line) = (k % self.rows, k / self.rows);
            ControlRow { position: [column as f64 * dx, line as f64 * dy, row.position[2]], ..row.clone() }
        };
        by_rows.then(|| control.iter().enumerate().map(turned).collect())
    }

    /// The control with other columns and rows.
    pub(crate) fn with(&self, at: &[Vec<f64>; 2], control: &[ControlRow]) -> Vec<ControlRow> {
        let moved = |(row, place): (&ControlRow, &[usize; 2])| {
            let position = [at[0][place[0]], at[1][place[1]], row.position[2]];
            ControlRow { position, ..row.clone() }
        };
        control.iter().zip(&self.places).map(moved).collect()
    }
}

/// Ascending, each once.
pub(crate) fn distinct(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    let extent = values.last().zip(values.first()).map_or(0.0, |(last, first)| last - first);
    values.dedup_by(|a, b| (*a - *b).abs() <= SAME * extent);
    values
}

/// The place of the value that is nearest to `value`.
pub(crate) fn nearest(values: &[f64], value: f64) -> usize {
    (0..values.len()).min_by(|&a, &b| (values[a] - value).abs().total_cmp(&(values[b] - value).abs())).unwrap_or(0)
}

/// The step of coordinates that are as far apart each from the next.
fn even(at: &[f64]) -> Option<f64> {
    let step = (at.last()? - at.first()?) / (at.len() - 1) as f64;
    at.windows(2).all(|pair| ((pair[1] - pair[0]) / step - 1.0).abs() < 1e-3).then_some(step)
}
