//! What was photographed: a board in a word, or object coordinates as an array or by names.

use std::path::{Path, PathBuf};

use calibench_calibrate::{Calibration as Solved, OtherBoard, with_corners};
use calibench_cameras::read_kalibr_target;
use calibench_exchange::{read_board_corners, write_board_corners};
use calibench_files::OutputFile;
use calibench_judge::{Field, field_of};
use calibench_model::{ControlRow, boards};
use calibench_photographs::{Finder, board_of};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::rows;
use crate::error::input;

/// The object coordinates of a board's points by their names: X to the right, Y upwards, Z towards the viewer, from the first point.
#[pyfunction]
pub fn board(text: &str) -> PyResult<Vec<(String, [f64; 3])>> {
    let finder = Finder::new(board_of(text, read_kalibr_target).map_err(input)?).map_err(input)?;
    Ok(finder.control().into_iter().map(|row| (row.target, row.position)).collect())
}

/// Points of known object coordinates, in the order in which arrays have them.
pub struct Board {
    /// Their names and coordinates.
    pub control: Vec<ControlRow>,
    /// As `judge` has it.
    pub field: Field,
    /// The board, if it was given in a word.
    pub pictured: Option<boards::Board>,
}

impl Board {
    /// Of `9x6:25` or another board in a word, of an array of (n, 3), or of a dict of names and coordinates.
    ///
    /// # Errors
    /// Anything else.
    pub fn of(board: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(text) = board.extract::<String>() {
            let pictured = board_of(&text, read_kalibr_target).map_err(input)?;
            let control = Finder::new(pictured).map_err(input)?.control();
            return Ok(Self { control, field: field_of(&pictured).map_err(input)?, pictured: Some(pictured) });
        }
        let control: Vec<ControlRow> = if let Ok(named) = board.cast::<PyDict>() {
            let row = |(name, xyz): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
                let wrong = || input("board: expected names and coordinates X, Y, Z, as in {\"P1\": (0.0, 0.0, 0.0)}");
                Ok(ControlRow::new(name.extract::<String>().map_err(|_| wrong())?, xyz.extract::<[f64; 3]>().map_err(|_| wrong())?))
            };
            named.iter().map(row).collect::<PyResult<_>>()?
        } else {
            let all = rows::<3>(board, "board (a text as 9x6:25, an array of (n, 3), or a dict)")?;
            all.into_iter().enumerate().map(|(index, xyz)| ControlRow::new(index.to_string(), xyz)).collect()
        };
        if let Some(row) = control.iter().find(|row| row.position.iter().any(|value| !value.is_finite())) {
            return Err(input(format!("board: the coordinates of point {} are not finite", row.target)));
        }
        Ok(Self { field: Field::Points(control.clone()), control, pictured: None })
    }

    /// The same with the corners that a file of a measured board has.
    ///
    /// # Errors
    /// A file that cannot be read, or is of another board.
    pub fn with_file(self, file: Option<PathBuf>) -> PyResult<Self> {
        let Some(path) = file else { return Ok(self) };
        let corners = read_board_corners(&path).map_err(input)?;
        let wrong = |error: OtherBoard| input(format!("board_file: {}: {error}", path.display()));
        let control = with_corners(&self.control, &corners).map_err(wrong)?;
        Ok(Self { control, field: self.field.measured(&corners).map_err(wrong)?, pictured: self.pictured })
    }

    /// Names of its points, in the order in which arrays have them.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.control.iter().map(|row| row.target.as_str())
    }
}

/// Writes the board that was measured.
pub fn save(path: &Path, calibration: &Solved<'_>, board: &Board) -> Result<(), String> {
    match &calibration.measured_board {
        Some(Ok(found)) => {
            let corners = found.all(&board.control, &calibration.prepared.settings.board);
            let output = OutputFile::open(path).map_err(|error| error.to_string())?;
            output.write(|file| write_board_corners(file, &corners)).map_err(|error| error.to_string())
        }
        Some(Err(why)) => Err(format!("save_board: the board cannot be measured: {why}")),
        None => Ok(()),
    }
}
