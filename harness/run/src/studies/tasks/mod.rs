//! Cameras that measure, within a run: each trial calibrates one from a board that errs, as `calibrate` does it, and holds the intervals that `task` says of what
//! it then measures against the truth.
//!
//! The calibration and the intervals are told what a user would know: how far boards of the kind err, not how far this one does. Nothing of a measurement is the
//! budget's own: it comes from resections and intersections, with the camera that was estimated, of what the true camera sees.

mod board;
mod figures;
mod length;

use calibench_calibrate::{BoardScale, Settings, StatedBoard, calibrate, prepare};
use calibench_random::Key;
use calibench_records::results::{Calibrated, Figure, PointResult};
use calibench_scenario::ViewsSubject;
use calibench_scenario::studies::tasks::Tasks;

use super::adjust::Adjust;
use super::told::Trial;
use board::Board;

impl Adjust for Tasks {
    fn adjust(&self, subject: &ViewsSubject, points: &[PointResult], methods: &[usize], key: Key<'_>) -> Vec<Calibrated> {
        let of_method = |&method: &usize| {
            let outcome = figures_of(self, subject, (points, method), key);
            Calibrated { method, set: 0, outcome, check_failed: None }
        };
        methods.iter().map(of_method).collect()
    }
}

/// The figures of a calibration and of what its camera measures.
///
/// # Errors
/// Why it cannot be calibrated, in words.
fn figures_of(plan: &Tasks, subject: &ViewsSubject, points: (&[PointResult], usize), key: Key<'_>) -> Result<Vec<Figure>, String> {
    let mut trial = Trial::of((&plan.model, plan.noise_px), subject, points, key)?;
    let board = Board::draw(plan.board, &subject.field, key);
    trial.points = board.pictured(&trial)?;
    let settings = settings(plan, &trial)?;
    let prepared = prepare(trial.points.clone(), &board.told(plan.board), &settings).map_err(|error| error.to_string())?;
    let measured = |found: &calibench_calibrate::Calibration<'_>| figures::of(plan, &trial, &board, found, key);
    calibrate(&prepared, &[], measured).map_err(|error| error.to_string())?
}

fn settings(plan: &Tasks, trial: &Trial<'_>) -> Result<Settings, String> {
    let scale = Some(BoardScale { value: 1.0, sigma: plan.board.scale }).filter(|scale| scale.sigma > 0.0);
    Ok(Settings { board: StatedBoard { scale, ..StatedBoard::default() }, ..trial.settings(vec![trial.optics("camera", "*")?]) })
}
