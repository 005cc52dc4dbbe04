//! `calibench detect`: a chessboard's corners as approximate positions.

use std::path::PathBuf;

use calibench_exchange::{Inputs, PointRef, write_points};
use calibench_measure::Board;
use calibench_photographs::corners::detect_corners;
use calibench_photographs::names::once;
use clap::Args;

use super::context::Context;
use super::output;
use super::photos::say_turns;
use super::progress::Progress;
use crate::deliver::deliver;
use crate::failure::Failure;

#[derive(Args)]
pub struct Detect {
    /// Photographs: PNG, JPEG, TIFF or PNM, 8 or 16 bits
    #[arg(required = true, value_name = "PHOTO")]
    photos: Vec<PathBuf>,
    /// The chessboard's inner corners, as in 9x6
    #[arg(long, value_name = "COLUMNSxROWS")]
    chessboard: Board,
    /// Where the points go [default: standard output]
    #[arg(short, long, value_name = "CSV")]
    output: Option<PathBuf>,
}

impl Detect {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let output = output::table("-o", self.output.as_deref(), &Inputs::new(&self.photos))?;
        let detector = context.toolbox.detector.as_deref();
        let detector = detector.ok_or_else(|| Failure::input("this build has no chessboard detector (it is built without OpenCV)"))?;
        let progress = Progress::start("detect", self.photos.len() as u64, context.quiet);
        once(&self.photos)?;
        say_turns(&self.photos)?;
        let found = detect_corners(&self.photos, self.chessboard, detector, &|| progress.step())?;
        let seen = found.iter().filter(|rows| !rows.is_empty()).count();
        progress.finish(&format!("the board was found in {seen} of {} photographs", found.len()));
        for (path, rows) in self.photos.iter().zip(&found) {
            if rows.is_empty() {
                say!("{}: no board of {} x {} inner corners found", path.display(), self.chessboard.columns, self.chessboard.rows);
            }
        }
        if seen == 0 {
            return Err(Failure::input("no board was found; expected one whose inner corners are all visible, counted as COLUMNSxROWS"));
        }
        deliver(output.as_ref(), |file| write_points(file, found.iter().flatten().map(PointRef::from)))
    }
}
