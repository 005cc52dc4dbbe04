//! A board's points in photographs, with a word about what was not found.

use calibench_images::Reading;
use calibench_model::LostRow;
use calibench_photographs::measured::Corners;
use calibench_photographs::{Finder, Reader};

use super::super::context::Context;
use super::super::notes::say_notes;
use super::super::progress::Progress;
use crate::failure::Failure;

/// The points of a board in photographs, and how these were read, by the method of that name, or by the usual one for their kind.
pub fn corners(
    context: &Context<'_>,
    finder: &Finder,
    reader: &dyn Fn() -> Result<Reader, Failure>,
    method: Option<&str>,
) -> Result<(Corners, Reading), Failure> {
    let method = context.method_of_boards(method.unwrap_or(finder.usual_method()), finder.kind())?;
    let operator = method.operator.as_ref().map_err(|why| Failure::input(format!("-m {}: unavailable: {why}", method.label)))?;
    let reader = reader()?;
    let photos = reader.photos();
    let progress = Progress::start("calibrate", photos.len() as u64, context.quiet);
    let found = finder.measure(&reader, (&method.label, operator.as_ref()), &|| progress.step())?;
    let (mut seen, mut views) = (0, 0);
    for (path, Corners { points, lost, doubts, photos }) in photos.iter().zip(&found) {
        doubts.iter().for_each(|doubt| say!("in doubt: {doubt}"));
        seen += usize::from(!points.is_empty());
        views += if points.is_empty() { 0 } else { photos.len() };
        match (lost.first(), lost.len()) {
            (Some(LostRow { target, reason, .. }), 1) if target.is_empty() => say!("{}: {reason}", path.display()),
            (Some(_), count) => say!("{}: {count} points were rejected by {}", path.display(), method.label),
            (None, _) => {}
        }
    }
    let times = if finder.is_of_each() { format!(", {views} times") } else { String::new() };
    progress.finish(&format!("the board was found in {seen} of {} photographs{times}, measured by {}", photos.len(), method.label));
    say_notes([&method]);
    if seen == 0 {
        return Err(Failure::input(
            "no point was measured: no board was found (of a chessboard all inner corners must be visible, counted as COLUMNSxROWS; `calibench detect \
             PHOTO --board unknown` says what board is there), or the method rejected every point",
        ));
    }
    Ok((found.into_iter().collect(), reader.reading()))
}
