//! `calibench control`: the control file of a chessboard.

use std::path::PathBuf;

use calibench_exchange::{Inputs, write_control};
use calibench_photographs::Chessboard;
use clap::Args;

use super::output;
use crate::deliver::deliver;
use crate::failure::Failure;

#[derive(Args)]
pub struct Control {
    /// The chessboard's inner corners and the side of a square in object units, as in 9x6:25
    #[arg(value_name = "COLUMNSxROWS:SIDE")]
    chessboard: Chessboard,
    /// The control file: CSV with target,X,Y,Z; targets are named as `detect` names them, r1c1 the first of the first row, X along it, Y up [default: standard output]
    #[arg(short, long, value_name = "CSV")]
    output: Option<PathBuf>,
}

impl Control {
    pub fn run(&self) -> Result<(), Failure> {
        let output = output::table("-o", self.output.as_deref(), &Inputs::default())?;
        deliver(output.as_ref(), |file| write_control(file, &self.chessboard.control()))
    }
}
