//! What is known of a board beside its nominal corners, and its corners as photographs show them.

use std::path::{Path, PathBuf};

use calibench_calibrate::{BoardScale, BoardShape, Calibration, StatedBoard, with_corners};
use calibench_exchange::{read_board_corners, write_board_corners};
use calibench_files::{Inputs, OutputFile};
use calibench_model::ControlRow;
use clap::Args;

use super::super::convert::positive;
use super::super::output;
use crate::failure::Failure;

#[derive(Args)]
pub struct BoardArguments {
    /// The board's own corners, as --save-board writes them, in place of nominal ones: their standard deviations are their weights
    #[arg(long, value_name = "CSV", requires = "board")]
    board_file: Option<PathBuf>,
    /// Measures the board: its corners as these photographs show them, with covariance, for --board-file; every corner is free, as with --board-shape free
    #[arg(long, value_name = "CSV", conflicts_with_all = ["board_file", "distances", "poses", "names"])]
    save_board: Option<PathBuf>,
    /// Scale of the print, true over nominal length, with its standard deviation, as in 1.0003:2e-4 [default: 1, taken as exact]
    #[arg(long, value_name = "SCALE:SIGMA", conflicts_with_all = ["distances", "names"])]
    board_scale: Option<BoardScale>,
    /// Standard deviation of each coordinate of the board's corners, or of control that states none, object units [default: taken as exact]
    #[arg(long, value_name = "SIGMA", value_parser = positive, allow_negative_numbers = true, conflicts_with_all = ["save_board", "names"])]
    print_noise: Option<f64>,
}

impl BoardArguments {
    /// Files that are read.
    pub fn inputs(&self) -> impl Iterator<Item = &PathBuf> {
        self.board_file.iter()
    }

    /// Whether anything is.
    pub fn is_given(&self) -> bool {
        self.board_file.is_some() || self.save_board.is_some() || self.board_scale.is_some() || self.print_noise.is_some()
    }

    /// Where the board is written to, if it is.
    pub fn output(&self, inputs: &Inputs) -> Result<Option<OutputFile>, Failure> {
        output::table("--save-board", self.save_board.as_deref(), inputs)
    }

    /// What is stated of the board.
    pub fn stated(&self) -> StatedBoard {
        StatedBoard { scale: self.board_scale, noise: self.print_noise, is_measured: self.save_board.is_some() }
    }

    /// The shape that is asked for; a board that is measured is free.
    pub fn shape(&self, asked: Option<BoardShape>) -> Result<BoardShape, Failure> {
        match asked {
            Some(shape) if self.save_board.is_some() && shape != BoardShape::Free => {
                Err(Failure::input("--save-board: every corner is free when a board is measured; leave --board-shape out"))
            }
            Some(shape) => Ok(shape),
            None => Ok(if self.save_board.is_some() { BoardShape::Free } else { BoardShape::Tested }),
        }
    }

    /// The corners of the board: nominal, or those of the file.
    pub fn corners(&self, nominal: Vec<ControlRow>) -> Result<Vec<ControlRow>, Failure> {
        match &self.board_file {
            Some(path) => of_file(path, &nominal),
            None => Ok(nominal),
        }
    }

    /// Writes the board that was measured.
    pub fn deliver(output: Option<&OutputFile>, calibration: &Calibration<'_>, control: &[ControlRow]) -> Result<(), Failure> {
        let Some(output) = output else { return Ok(()) };
        match &calibration.measured_board {
            Some(Ok(board)) => {
                let corners = board.all(control, &calibration.prepared.settings.board);
                Ok(output.write(|file| write_board_corners(file, &corners))?)
            }
            Some(Err(why)) => Err(Failure::input(format!("--save-board {}: the board cannot be measured: {why}", output.path().display()))),
            None => Ok(()),
        }
    }
}

/// The corners of a file in the place of nominal ones.
fn of_file(path: &Path, nominal: &[ControlRow]) -> Result<Vec<ControlRow>, Failure> {
    let corners = read_board_corners(path)?;
    with_corners(nominal, &corners).map_err(|error| Failure::input(format!("{}: {error}", path.display())))
}
