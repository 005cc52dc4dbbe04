//! Calibrated splines as a summary for a terminal.

use std::fmt::Write;

use calibench_calibrate::splined::SplinedCalibration;
use calibench_calibrate::{LeftOut, Shape, few};

use super::digits::rounded;
use crate::markdown::{MarkdownTable, plain};

/// The summary of splines: what is in doubt, the bookkeeping with the prior, how well the camera is known over its frame, and the core. Control points are in the files.
pub fn splined_summary(found: &SplinedCalibration<'_>) -> String {
    let mut text: String = found.doubts.iter().map(|doubt| format!("in doubt: {}\n", doubt.words)).collect();
    if !text.is_empty() {
        text.push('\n');
    }
    for line in facts(found) {
        let _ = writeln!(text, "{line}");
    }
    let _ = write!(text, "\n{}", core(found).render());
    text
}

/// What is to be known of the adjustment, a line each.
pub(super) fn facts(found: &SplinedCalibration<'_>) -> Vec<String> {
    let (prepared, solution) = (found.prepared, &found.solution);
    let (network, counts, prior) = (&prepared.splines.network, solution.counts(), &prepared.splines.prior);
    let mut lines = vec![format!(
        "{}: {} control points of splines; {} images, {} image points",
        prepared.asked.grid.name(),
        solution.camera().control.len(),
        network.images.len(),
        network.observations.len()
    )];
    lines.push(format!("start: {}, then a lean camera ({}); control points from zero", prepared.origin, prepared.lean.convention().name));
    lines.push(gauge(found));
    lines.push(format!(
        "prior as of mrcal: a control point's offset is 0 +- {} along the direction from the grid's middle, +- {} across (numbers, 1 is a radian at the axis)",
        plain(1.0 / prior.along),
        plain(1.0 / prior.across)
    ));
    lines.extend(left_out(found));
    if let Shape::Bent { .. } = prepared.shape {
        let surface = solution.surfaces().first().copied().unwrap_or_default();
        let bend = calibench_calibrate::Board::deflection(surface);
        lines.push(format!("the board is bent by {} (units of the control)", plain(bend)));
    }
    let sigma0 = found.quality.fit.sigma0.map_or_else(|| "none".into(), plain);
    lines.push(format!(
        "{} unknowns, redundancy {:.1} of {} image coordinates (the prior alone determines the rest of the unknowns), {} iterations",
        counts.unknowns,
        found.quality.fit.redundancy,
        counts.image_coordinates,
        solution.iterations()
    ));
    lines.push(format!(
        "cost {:.4} of image points and {:.4} of the prior, sigma0 {sigma0}",
        solution.cost() - solution.prior_cost(),
        solution.prior_cost()
    ));
    lines.push(format!("residuals {} px RMS", plain(found.rms_px())));
    lines.push(known(found));
    let alone = found.quality.control_points_without_image_points();
    if alone > 0 {
        lines.push(format!("{alone} control points have no image point near them: the prior alone holds them"));
    }
    lines
}

fn gauge(found: &SplinedCalibration<'_>) -> String {
    let of = &found.prepared.splines;
    let names: Vec<&str> = ["fx", "fy", "cx", "cy"].into_iter().zip(of.core).filter(|(_, free)| *free).map(|(name, _)| name).collect();
    let why = "control points can stand for fx, fy, cx and cy";
    if names.is_empty() {
        format!("the core is held, since {why}")
    } else {
        format!("solved for with the control points: {}; {why}, so that the prior alone tells them apart", names.join(", "))
    }
}

fn left_out(found: &SplinedCalibration<'_>) -> Vec<String> {
    let survey = &found.prepared.survey;
    let mut lines = Vec::new();
    if let Some(LeftOut { why, .. }) = found.prepared.left_out.first() {
        let target = |left: &LeftOut| {
            let sight = survey.sight(left.sight);
            format!("{} in {}", survey.target(sight.target), survey.images[sight.image])
        };
        let names: Vec<String> = found.prepared.left_out.iter().map(target).collect();
        lines.push(format!("take no part: {} ({why})", few(&names)));
    }
    if !found.found.is_empty() {
        let names: Vec<String> = found.found.iter().map(|left| found.prepared.splines.name_of(left.observation)).collect();
        lines.push(format!("gross errors: {} image points were left out: {}", names.len(), few(&names)));
    }
    lines
}

/// How well the camera is known over its frame.
pub(super) fn known(found: &SplinedCalibration<'_>) -> String {
    let px = |px: f64| if px.is_finite() { format!("{} px", plain(px)) } else { "nothing: a part of it has no ray".into() };
    let held = found.over_held_px().map_or_else(|| "nothing".to_owned(), px);
    format!(
        "known where image points hold the splines to {held}, over the whole frame to {} (RMS, a point far away, limit {}); {:.1} % of the frame has no image point in its cell of the splines: the uncertainty there is the prior's",
        px(found.over_frame_px()),
        plain(found.limit_px()),
        100.0 * found.share_unheld()
    )
}

pub(super) fn core(found: &SplinedCalibration<'_>) -> MarkdownTable {
    let mut table = MarkdownTable::new(&["parameter", "value", "sigma", "unit"]);
    let (camera, sigmas) = (found.solution.camera(), found.quality.core_sigmas());
    for (i, name) in ["fx", "fy", "cx", "cy"].into_iter().enumerate() {
        let (value, sigma) =
            if found.prepared.splines.core[i] { rounded(camera.core[i], sigmas[i]) } else { (plain(camera.core[i]), "held".into()) };
        table.row([name.to_owned(), value, sigma, "px".to_owned()]);
    }
    table
}
