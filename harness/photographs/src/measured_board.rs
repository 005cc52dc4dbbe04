//! A chessboard in an image, in the hands of many methods.

use std::path::PathBuf;
use std::sync::Arc;

use calibench_exchange::read_photo;
use calibench_measure::{Board, BoardDetector, Configured, ImageId};
use calibench_model::camera::ImageSize;
use calibench_model::{Image, PixelPoint, Start, TargetKind};
use calibench_records::results::{MethodInfo, Outcome, PointResult, Trial};
use rayon::prelude::*;

use crate::PhotographsError;
use crate::names::{names, once, same_size};

/// A board's corners in photographs, all of one size, in the hands of every available method: by photograph, in the order given; and that size. `step` is called
/// after each photograph, on any thread.
///
/// # Errors
/// A photograph that cannot be read, or that is given twice; photographs of several sizes.
pub fn measured_boards(
    photos: &[PathBuf],
    board: (&dyn BoardDetector, Board),
    methods: &[Configured],
    step: &(dyn Fn() + Sync),
) -> Result<(Trial, ImageSize), PhotographsError> {
    once(photos)?;
    let one = |(path, name): (&PathBuf, &String)| {
        let image = read_photo(path)?.image;
        let trial = measured_board(&image, name, board, methods);
        step();
        Ok((trial, ImageSize { width: image.width() as u32, height: image.height() as u32 }))
    };
    let found = photos.par_iter().zip(&names(photos)).map(one).collect::<Result<Vec<_>, PhotographsError>>()?;
    let size = same_size(photos.iter().zip(found.iter().map(|(_, size)| *size)))?;
    let mut whole = Trial::default();
    for (view, _) in found {
        whole.points.extend(view.points);
        whole.missed_views.extend(view.missed_views);
    }
    Ok((whole, size))
}

/// A method as results list it.
pub fn method_info(method: &Configured) -> MethodInfo {
    MethodInfo {
        label: method.label.as_str().into(),
        version: method.version.as_str().into(),
        unavailable: method.operator.as_ref().err().cloned(),
    }
}

/// A board's corners in an image called `view`, in the hands of every available method, from the same whole pixels.
pub fn measured_board(image: &Image, view: &str, (detector, board): (&dyn BoardDetector, Board), methods: &[Configured]) -> Trial {
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
    let names: Vec<String> = (0..starts.len()).map(|index| board.target(index)).collect();
    for (method, operator) in methods.iter().enumerate().filter_map(|(i, method)| Some((i, method.operator.as_deref().ok()?))) {
        let results = match operator.recorded() {
            Some(recorded) => {
                recorded.recall(ImageId { trial: 0, view: &view }, image, &names.iter().map(String::as_str).collect::<Vec<_>>())
            }
            None => operator.measure_all(image, &starts),
        };
        for (index, result) in results.into_iter().enumerate() {
            let outcome = match result {
                Ok(found) => Outcome::Measured { position: found.position, error: None },
                Err(rejection) => Outcome::Rejected(rejection),
            };
            trial.points.push(PointResult::new(view.clone(), names[index].clone(), method, outcome));
        }
    }
    trial
}
