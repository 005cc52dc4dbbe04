//! What puts splines in doubt.

use calibench_adjust::Use;
use calibench_model::camera::fold_radius;

use super::calibration::SplinedCalibration;
use super::doubted::{SplinedDoubt, SplinedSubject};
use crate::{GrossErrors, few};

/// Share of the image points from which those that are left out are worth a doubt.
const MANY: f64 = 0.01;

pub(super) fn doubts(found: &SplinedCalibration<'_>) -> Vec<SplinedDoubt> {
    [over_frame(found), folded(found), beyond(found), kept(found), left_out(found)].into_iter().flatten().collect()
}

fn over_frame(found: &SplinedCalibration<'_>) -> Option<SplinedDoubt> {
    let (px, limit) = (found.over_frame_px(), found.limit_px());
    if px <= limit {
        return None;
    }
    let far = if px.is_finite() { format!("to {px:.3} px RMS only") } else { "not at all, as a part of it has no ray".into() };
    let held = found.over_held_px().map_or_else(String::new, |px| format!("; where image points hold the splines to {px:.3} px"));
    let share = 100.0 * found.share_unheld();
    let words = format!(
        "over the whole frame the camera is known {far} (limit {limit:.3} px){held}. {share:.0} % of the frame has no image point in its cell of the splines: there the prior speaks; photograph the board there, or take fewer control points"
    );
    Some(SplinedDoubt { subject: SplinedSubject::OverFrame, words })
}

fn folded(found: &SplinedCalibration<'_>) -> Option<SplinedDoubt> {
    let radius = fold_radius(found.solution.camera())?;
    let words = format!(
        "the splines fold over inside the frame, {radius:.0} px from the axis: beyond it they picture nothing; photograph the board there, or take fewer control points"
    );
    Some(SplinedDoubt { subject: SplinedSubject::Fold, words })
}

fn beyond(found: &SplinedCalibration<'_>) -> Option<SplinedDoubt> {
    let ended = found.solution.ended();
    let used: Vec<bool> = found.solution.residuals().iter().map(|r| r.used != Use::LeftOut).collect();
    let outside: Vec<String> = ended.outside().iter().filter(|(index, _)| used[*index]).map(|(index, _)| ended.name_of(*index)).collect();
    if outside.is_empty() {
        return None;
    }
    let words = format!(
        "{} image points lie beyond the grid of the splines, which is only extended there: {}; expected a wider field of view",
        outside.len(),
        few(&outside)
    );
    Some(SplinedDoubt { subject: SplinedSubject::Grid, words })
}

/// Image points that do not fit and are in use.
fn kept(found: &SplinedCalibration<'_>) -> Option<SplinedDoubt> {
    let names: Vec<String> = found.kept.iter().map(|kept| found.prepared.splines.name_of(kept.observation)).collect();
    let advice = if found.prepared.asked.settings.gross == GrossErrors::Kept { "; without --plain they are left out" } else { "" };
    let words = || format!("{} of {} image points do not fit and were kept: {}{advice}", names.len(), all(found), few(&names));
    (!names.is_empty()).then(|| SplinedDoubt { subject: SplinedSubject::GrossErrors, words: words() })
}

/// More image points were left out than single ones.
fn left_out(found: &SplinedCalibration<'_>) -> Option<SplinedDoubt> {
    if found.found.len() as f64 <= MANY * all(found) as f64 {
        return None;
    }
    let names: Vec<String> = found.found.iter().map(|left| found.prepared.splines.name_of(left.observation)).collect();
    let words = format!("{} of {} image points do not fit and were left out: {}", names.len(), all(found), few(&names));
    Some(SplinedDoubt { subject: SplinedSubject::GrossErrors, words })
}

fn all(found: &SplinedCalibration<'_>) -> usize {
    found.prepared.splines.network.observations.len()
}
