//! `calibench control`: the control file of a board.

use std::path::PathBuf;

use calibench_exchange::write_control;
use calibench_files::Inputs;
use calibench_model::boards::Board;
use clap::Args;

use super::context::finder;
use super::output;
use crate::board::board_of;
use crate::deliver::deliver;
use crate::failure::Failure;

#[derive(Args)]
pub struct Control {
    /// The board: a chessboard's inner corners and the side of a square in object units, as in 9x6:25, or another, as in aprilgrid:6x6:0.088:0.3 or Kalibr's target.yaml
    #[arg(value_name = "BOARD", value_parser = board_of)]
    board: Board,
    /// The control file: CSV with target,X,Y,Z; targets are named as `detect` names them, of a chessboard r1c1 the first of the first row, X along it, Y up [default: standard output]
    #[arg(short, long, value_name = "CSV")]
    output: Option<PathBuf>,
}

impl Control {
    pub fn run(&self) -> Result<(), Failure> {
        let output = output::table("-o", self.output.as_deref(), &Inputs::default())?;
        let finder = finder(self.board)?;
        deliver(output.as_ref(), |file| write_control(file, &finder.control()))
    }
}
