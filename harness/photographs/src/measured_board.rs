//! A chessboard in an image, in the hands of many methods.

use std::sync::Arc;

use calibench_measure::{Board, BoardDetector, Configured, ImageId};
use calibench_model::{Image, PixelPoint, Start, TargetKind};
use calibench_records::results::{Outcome, PointResult, Trial};

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
