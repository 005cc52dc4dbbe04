//! Photographs of a chessboard: the detector gives the starts, every method measures.

use std::path::Path;
use std::sync::Arc;

use calibench_exchange::{read_photo, write_png};
use calibench_measure::{Board, BoardDetector, Configured};
use calibench_model::{Image, PixelPoint, Start, TargetKind};
use calibench_records::results::{Outcome, PointResult, Trial};
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
    let methods = plan.methods.len();
    for method in 0..methods {
        trial.points.extend(views.iter().flat_map(|view| view.points.iter().filter(|point| point.method == method).cloned()));
    }
    trial.missed_views = views.into_iter().flat_map(|view| view.missed_views).collect();
    Ok(trial)
}

fn view(plan: &Plan<'_>, subject: &PhotographsSubject, path: &Path, file: &str) -> Result<Trial, RunError> {
    let image = read_photo(path)?;
    let view: Arc<str> = file.into();
    if let Some(folder) = plan.images {
        write_png(&calibench_records::names::kept_image(folder, file), &image, false)?;
    }
    Ok(plan.detector.map_or_else(Trial::default, |detector| measured(&image, &view, (detector, subject.board), plan.methods)))
}

/// A board's corners in an image called `view`, in the hands of every available method, from the same whole pixels.
pub fn measured(image: &Image, view: &str, (detector, board): (&dyn BoardDetector, Board), methods: &[Configured]) -> Trial {
    let (mut trial, view): (Trial, Arc<str>) = (Trial::default(), view.into());
    let Some(corners) = detector.detect(image, board) else {
        trial.missed_views.push((view, format!("no board of {} x {} corners found", board.columns, board.rows)));
        return trial;
    };
    // Whole pixels, as a hand would point: no operator starts from another's result.
    let start = |corner: &PixelPoint| Start {
        kind: Some(TargetKind::ChessCorner),
        ..Start::at(PixelPoint::new(corner.x.round(), corner.y.round()))
    };
    let starts: Vec<Start> = corners.iter().map(start).collect();
    for (method, operator) in methods.iter().enumerate().filter_map(|(i, method)| Some((i, method.operator.as_deref().ok()?))) {
        for (index, result) in operator.measure_all(image, &starts).into_iter().enumerate() {
            let outcome = match result {
                Ok(found) => Outcome::Measured { position: found.position, error: None },
                Err(rejection) => Outcome::Rejected(rejection),
            };
            trial.points.push(PointResult::new(view.clone(), board.target(index), method, outcome));
        }
    }
    trial
}
