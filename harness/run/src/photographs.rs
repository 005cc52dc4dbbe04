//! Photographs of a chessboard: the detector gives the starts, every method measures.

use std::path::Path;
use std::sync::Arc;

use calibench_images::{encode_png, read_photo};
use calibench_photographs::{Chessboard, Finder, measured_board};
use calibench_records::names::kept_image_name;
use calibench_records::results::Trial;
use calibench_scenario::PhotographsSubject;
use rayon::prelude::*;

use super::{Plan, RunError};

pub(super) fn run(plan: &Plan<'_>, subject: &PhotographsSubject, step: &(dyn Fn() + Sync)) -> Result<Trial, RunError> {
    if plan.missing().is_some() {
        return Ok(Trial::default());
    }
    let folder = plan.folder_of(subject);
    let one = |file: &String| {
        let view = view(plan, subject, &folder.join(file), file);
        step();
        view
    };
    let views = subject.files.par_iter().map(one).collect::<Result<Vec<_>, RunError>>()?;
    let mut trial = Trial::default();
    for method in plan.available() {
        trial.points.extend(views.iter().flat_map(|view| view.points.iter().filter(|point| point.method == method).cloned()));
    }
    trial.missed_views = views.into_iter().flat_map(|view| view.missed_views).collect();
    Ok(trial)
}

fn view(plan: &Plan<'_>, subject: &PhotographsSubject, path: &Path, file: &str) -> Result<Trial, RunError> {
    let image = read_photo(path)?.image;
    let view: Arc<str> = file.into();
    if let Some(folder) = plan.images {
        folder.write(&kept_image_name(file), |file| encode_png(file, &image, false))?;
    }
    // The side of its squares is for the judgement alone.
    let board = Chessboard { board: subject.board, side: 1.0 };
    let finder = Finder::new(board.into()).map_err(|error| RunError::Asked(error.to_string()))?;
    let asked = plan.available().into_iter().map(|method| (method, &plan.methods[method]));
    Ok(measured_board(&image, &view, &finder, asked).0)
}
