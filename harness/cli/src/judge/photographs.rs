//! A chessboard's corners in photographs, by several methods.

use std::path::{Path, PathBuf};

use calibench_calibrate::choice::HALF;
use calibench_exchange::read_photo;
use calibench_judge::{Field, JudgementError, METHODS, Material, OF_CAMERA};
use calibench_measure::{Board, BoardDetector, Configured};
use calibench_model::camera::ImageSize;
use calibench_photographs::names::{names, once};
use calibench_photographs::{Chessboard, measured_board};
use calibench_records::results::{MethodInfo, Trial};
use rayon::prelude::*;

use super::super::context::Context;
use super::super::notes::say_notes;
use super::super::photos::{one_size, say_turns};
use super::super::progress::Progress;
use super::Judge;
use crate::failure::Failure;

impl Judge {
    /// All corners of all photographs in the hands of all methods.
    pub fn measured(&self, context: &Context<'_>, chessboard: Chessboard) -> Result<Material, Failure> {
        let methods = self.methods(context)?;
        let needed = 2 * HALF;
        if self.photos.len() < needed {
            return Err(JudgementError::TooFewViews { found: self.photos.len(), needed }.into());
        }
        once(&self.photos)?;
        let (trial, size) = self.measure(context, &methods, chessboard.board)?;
        let infos: Vec<MethodInfo> = methods.iter().map(info).collect();
        Ok(Material::new(&trial, &infos, Field::Board { board: chessboard.board, side: chessboard.side }, size))
    }

    fn methods(&self, context: &Context<'_>) -> Result<Vec<Configured>, Failure> {
        let texts: Vec<String> = match (self.methods.is_empty(), &self.camera) {
            (false, _) => self.methods.clone(),
            (true, Some(_)) => vec![OF_CAMERA.to_owned()],
            (true, None) => METHODS.map(str::to_owned).to_vec(),
        };
        let methods = texts.iter().map(|text| context.method_of_boards(text)).collect::<Result<Vec<_>, _>>()?;
        let twice = methods.iter().enumerate().find(|(i, method)| methods[..*i].iter().any(|earlier| earlier.label == method.label));
        match twice {
            Some((_, method)) => Err(Failure::input(format!("-m {}: asked for twice; expected each once", method.label))),
            None => Ok(methods),
        }
    }

    fn measure(&self, context: &Context<'_>, methods: &[Configured], board: Board) -> Result<(Trial, ImageSize), Failure> {
        let detector = context.toolbox.detector.as_deref();
        let detector = detector.ok_or_else(|| Failure::input("this build has no chessboard detector (it is built without OpenCV)"))?;
        let progress = Progress::start("judge", self.photos.len() as u64, context.quiet);
        say_turns(&self.photos)?;
        let names = names(&self.photos);
        let found = |(path, name): (&PathBuf, &String)| {
            let found = one(path, name, (detector, board), methods);
            progress.step();
            found
        };
        let found = self.photos.par_iter().zip(&names).map(found).collect::<Result<Vec<_>, Failure>>()?;
        let size = one_size(self.photos.iter().zip(found.iter().map(|(_, size)| *size)))?;
        let mut trial = Trial::default();
        for (view, _) in found {
            trial.points.extend(view.points);
            trial.missed_views.extend(view.missed_views);
        }
        let seen = self.photos.len() - trial.missed_views.len();
        progress.finish(&format!("the board was found in {seen} of {} photographs", self.photos.len()));
        for (view, why) in &trial.missed_views {
            say!("{view}: {why}");
        }
        say_notes(methods);
        Ok((trial, size))
    }
}

fn one(path: &Path, name: &str, board: (&dyn BoardDetector, Board), methods: &[Configured]) -> Result<(Trial, ImageSize), Failure> {
    let image = read_photo(path)?.image;
    let trial = measured_board(&image, name, board, methods);
    Ok((trial, ImageSize { width: image.width() as u32, height: image.height() as u32 }))
}

fn info(method: &Configured) -> MethodInfo {
    MethodInfo {
        label: method.label.as_str().into(),
        version: method.version.as_str().into(),
        unavailable: method.operator.as_ref().err().cloned(),
    }
}
