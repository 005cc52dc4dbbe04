//! What puts splines in doubt.

use calibench_adjust::Use;
use calibench_model::camera::fold_radius;

use super::calibration::SplinedCalibration;
use super::doubted::{SplinedDoubt, SplinedSubject};
use super::gross::beyond_chance;
use crate::{GrossErrors, few};

/// Share of the image points from which those that are left out are worth a doubt.
const MANY: f64 = 0.01;

pub(super) fn doubts(found: &SplinedCalibration<'_>) -> Vec<SplinedDoubt> {
    [over_frame(found), folded(found), beyond(found), gross(found)].into_iter().flatten().collect()
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
    let outside: Vec<String> = ended
        .outside()
        .iter()
        .filter(|(index, _)| used[*index])
        .map(|(index, _)| {
            let o = &ended.network.observations[*index];
            format!("{} in {}", ended.network.points[o.point].name, ended.network.images[o.image].name)
        })
        .collect();
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

/// Many were left out, or there are some that were not to be.
fn gross(found: &SplinedCalibration<'_>) -> Option<SplinedDoubt> {
    let network = &found.prepared.splines.network;
    let all = network.observations.len();
    let name = |observation: usize| {
        let o = &network.observations[observation];
        format!("{} in {}", network.points[o.point].name, network.images[o.image].name)
    };
    let stay = beyond_chance(&found.solution).unwrap_or_default();
    let words = if !stay.is_empty() {
        let names: Vec<String> = stay.iter().map(|(observation, _)| name(*observation)).collect();
        let advice = if found.prepared.asked.settings.gross == GrossErrors::Kept { "; without --plain they are left out" } else { "" };
        format!("{} of {all} image points do not fit and were kept: {}{advice}", stay.len(), few(&names))
    } else if found.found.len() as f64 > MANY * all as f64 {
        let names: Vec<String> = found.found.iter().map(|found| name(found.observation)).collect();
        format!("{} of {all} image points do not fit and were left out: {}", found.found.len(), few(&names))
    } else {
        return None;
    };
    Some(SplinedDoubt { subject: SplinedSubject::GrossErrors, words })
}
