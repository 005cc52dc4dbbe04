//! A board's points in photographs, by several methods.

use calibench_calibrate::choice::HALF;
use calibench_images::Reading;
use calibench_judge::{JudgementError, Material, usual_methods};
use calibench_model::TargetKind;
use calibench_model::boards::Board;
use calibench_photographs::{MeasuredBoards, measured_boards, method_info};

use super::super::context::{Context, finder};
use super::super::notes::say_notes;
use super::super::photos::of_one_camera;
use super::super::progress::Progress;
use super::Judge;
use crate::failure::Failure;

impl Judge {
    /// All points of all photographs in the hands of all methods, and what is in doubt of where the board was found.
    pub fn measured(&self, context: &Context<'_>, board: Board) -> Result<(Material, Vec<String>, Reading), Failure> {
        let finder = finder(board)?.of_each(self.all);
        let texts = if self.methods.is_empty() { usual_methods(finder.kind(), self.camera.is_some()) } else { self.methods.clone() };
        let methods = context.methods_of_boards(&texts, finder.kind())?;
        let needed = 2 * HALF;
        if self.photos.len() < needed {
            return Err(JudgementError::TooFewViews { found: self.photos.len(), needed }.into());
        }
        let progress = Progress::start("judge", self.photos.len() as u64, context.quiet);
        let reader = self.read.of_one_camera(&self.photos, self.only_size)?;
        let measured = measured_boards(&reader, &finder, &methods, &|| progress.step()).map_err(of_one_camera)?;
        let MeasuredBoards { trial, size, doubts } = measured;
        let seen = reader.photos().len() - trial.missed_views.len();
        progress.finish(&format!("the board was found in {seen} of {} photographs", reader.photos().len()));
        for (view, why) in &trial.missed_views {
            say!("{view}: {why}");
        }
        doubts.iter().for_each(|doubt| say!("in doubt: {doubt}"));
        if finder.kind() == TargetKind::Disc {
            say!("the centre of a disc's picture is not the picture of its centre, which is left in here: `calibrate` takes it out");
        }
        say_notes(&methods);
        let infos: Vec<_> = methods.iter().map(method_info).collect();
        Ok((Material::new(&trial, &infos, self.field_of(board)?, size), doubts, reader.reading()))
    }
}
