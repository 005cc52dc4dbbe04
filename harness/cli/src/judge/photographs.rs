//! A chessboard's corners in photographs, by several methods.

use calibench_calibrate::choice::HALF;
use calibench_judge::{Field, JudgementError, Material, usual_methods};
use calibench_photographs::{Chessboard, measured_boards, method_info};

use super::super::context::Context;
use super::super::notes::say_notes;
use super::super::photos::{of_one_camera, say_turns};
use super::super::progress::Progress;
use super::Judge;
use crate::failure::Failure;

impl Judge {
    /// All corners of all photographs in the hands of all methods.
    pub fn measured(&self, context: &Context<'_>, chessboard: Chessboard) -> Result<Material, Failure> {
        let texts = if self.methods.is_empty() { usual_methods(self.camera.is_some()) } else { self.methods.clone() };
        let methods = context.methods_of_boards(&texts)?;
        let needed = 2 * HALF;
        if self.photos.len() < needed {
            return Err(JudgementError::TooFewViews { found: self.photos.len(), needed }.into());
        }
        let Chessboard { board, side } = chessboard;
        let detector = context.toolbox.detector.as_deref();
        let detector = detector.ok_or_else(|| Failure::input("this build has no chessboard detector (it is built without OpenCV)"))?;
        let progress = Progress::start("judge", self.photos.len() as u64, context.quiet);
        say_turns(&self.photos)?;
        let (trial, size) = measured_boards(&self.photos, (detector, board), &methods, &|| progress.step()).map_err(of_one_camera)?;
        let seen = self.photos.len() - trial.missed_views.len();
        progress.finish(&format!("the board was found in {seen} of {} photographs", self.photos.len()));
        for (view, why) in &trial.missed_views {
            say!("{view}: {why}");
        }
        say_notes(&methods);
        let infos: Vec<_> = methods.iter().map(method_info).collect();
        Ok(Material::new(&trial, &infos, Field::Board { board, side }, size))
    }
}
