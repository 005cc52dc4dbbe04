//! A chessboard's corners in photographs, with a word about what was not found.

use std::path::PathBuf;

use calibench_exchange::LostRow;
use calibench_photographs::chessboard::{Chessboard, Corners, NOT_FOUND};

use super::super::context::Context;
use super::super::notes::say_notes;
use super::super::photos::say_turns;
use super::super::progress::Progress;
use crate::failure::Failure;

/// The corners of `chessboard` in photographs, by the method of that name.
pub fn corners(context: &Context<'_>, chessboard: Chessboard, photos: &[PathBuf], method: &str) -> Result<Corners, Failure> {
    let detector = context.toolbox.detector.as_deref();
    let detector = detector.ok_or_else(|| Failure::input("this build has no chessboard detector (it is built without OpenCV)"))?;
    let method = context.method_of_boards(method)?;
    let operator = method.operator.as_ref().map_err(|why| Failure::input(format!("-m {}: unavailable: {why}", method.label)))?;
    let progress = Progress::start("calibrate", photos.len() as u64, context.quiet);
    say_turns(photos)?;
    let found = chessboard.measure(photos, detector, (&method.label, operator.as_ref()), &|| progress.step())?;
    let mut seen = 0;
    for (path, Corners { points, lost, .. }) in photos.iter().zip(&found) {
        seen += usize::from(!points.is_empty());
        match (lost.first(), lost.len()) {
            (Some(LostRow { status, reason, .. }), 1) if status == NOT_FOUND => say!("{}: {reason}", path.display()),
            (Some(_), count) => say!("{}: {count} corners were rejected by {}", path.display(), method.label),
            (None, _) => {}
        }
    }
    progress.finish(&format!("the board was found in {seen} of {} photographs, measured by {}", photos.len(), method.label));
    say_notes([&method]);
    if seen == 0 {
        return Err(Failure::input(
            "no corner was measured: no board was found (expected one whose inner corners are all visible, counted as COLUMNSxROWS), or the method \
             rejected every corner",
        ));
    }
    Ok(found.into_iter().collect())
}
