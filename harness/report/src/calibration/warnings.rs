//! What a user must know of a calibration.

use calibench_adjust::{Significance, Use};
use calibench_calibrate::{Calibration, GrossErrors, Risk};

use super::limits::{BASIC, CORRELATED, DOUBTFUL};
use super::{board, checks, discs, own_numbers, scale};
use crate::plain;

/// Times that the images may disagree with the standard deviations: from twenty groups a ratio is known to a sixth.
const OPTIMISTIC: f64 = 1.5;

/// The status of a photograph that is the same as another one.
const COPY: &str = "copy";

/// What a user must know.
pub fn warnings(calibration: &Calibration<'_>) -> Vec<String> {
    let names: Vec<String> = calibration.covariances.parameters.iter().map(|parameter| calibration.parameter_name(parameter)).collect();
    let correlated = calibration.covariances.correlated(CORRELATED);
    let mut warnings: Vec<String> = correlated
        .iter()
        .map(|found| format!("{} and {} are hardly told apart: correlation {:.3}", names[found.pair[0]], names[found.pair[1]], found.rho))
        .collect();
    let tests = calibration.significance();
    let observed = |test: &Significance| {
        calibration.prepared.settings.cameras[test.camera].priors.iter().any(|prior| prior.parameter == test.parameter)
    };
    for test in tests.iter().filter(|test| !observed(test) && test.p > DOUBTFUL && !BASIC.contains(&test.parameter)) {
        let name = calibration.parameter_name(&(test.camera, test.parameter));
        warnings.push(format!("{name} is not told from zero (t {:.1}); a set without it may do", test.t));
    }
    let doubts = calibration.doubts();
    let rivals = calibration.prepared.rivals.iter().map(|rival| rival.words(&calibration.of(rival.camera)));
    warnings.extend(rivals.filter(|words| doubts.iter().all(|doubt| doubt.words != *words)));
    warnings.extend(calibration.rims.iter().cloned());
    warnings.extend(board::warning(calibration));
    warnings.extend(discs::warnings(calibration));
    warnings.extend(own_numbers::warning(calibration));
    warnings.extend(held(calibration));
    warnings.extend(scale::warnings(calibration));
    warnings.extend(half(calibration));
    warnings.extend(checks::slight(calibration));
    warnings.extend(optimistic(calibration));
    warnings.extend(weights(calibration));
    let rejected = calibration.found.iter().filter(|found| found.left_out).count();
    if rejected > 0 {
        warnings.push(format!("{rejected} image points were rejected and left out{}", worst(calibration)));
    }
    let kept = calibration.found.len() - rejected;
    if kept > 0 {
        warnings.push(format!("{kept} image points were rejected and kept: the network needs them, or too many were left out"));
    }
    let weighted = calibration.solution.each_residual().filter(|r| matches!(r.used, Use::Downweighted(_))).count();
    if weighted > 0 {
        warnings.push(format!("{weighted} image points have less weight (Huber)"));
    }
    warnings.extend(lost(calibration.prepared.unmeasured.iter().map(|[_, target, status, _]| (target, status))));
    warnings.extend(calibration.prepared.notes.iter().cloned());
    let (far, disputed) = (&calibration.prepared.far, &calibration.prepared.disputed);
    for (points, why) in [(far, "their rays are as good as parallel"), (disputed, "the last two of their rays do not meet")] {
        if !points.is_empty() {
            warnings.push(format!("{} points take no part, since {why}: {}", points.len(), calibench_calibrate::few(points)));
        }
    }
    let absent = calibration.prepared.left_out.len();
    if absent > 0 && far.is_empty() && disputed.is_empty() {
        warnings.push(format!("{absent} image points take no part: they are of targets that are no control and cannot be intersected"));
    }
    warnings
}

/// What was not measured, by target and status: points that a method refused, photographs in which no board was found, and those that are copies.
fn lost<'t>(rows: impl Iterator<Item = (&'t str, &'t str)>) -> Vec<String> {
    let (mut points, mut without, mut copies) = (0, 0, 0);
    for (target, status) in rows {
        match (target, status) {
            ("", COPY) => copies += 1,
            ("", _) => without += 1,
            _ => points += 1,
        }
    }
    let count = |count: usize, one: &str, many: &str| match count {
        0 => None,
        1 => Some(format!("1 {one}")),
        count => Some(format!("{count} {many}")),
    };
    let said = [
        count(points, "point was not measured: the method rejected it", "points were not measured: the method rejected them"),
        count(
            without,
            "photograph shows no board that was found, and takes no part",
            "photographs show no board that was found, and take no part",
        ),
        count(copies, "photograph is a copy of another one, and takes no part", "photographs are copies of others, and take no part"),
    ];
    said.into_iter().flatten().collect()
}

/// The image point that was left out and is off most.
fn worst(calibration: &Calibration<'_>) -> String {
    let prepared = calibration.prepared;
    let left_out = calibration.solution.each_residual().filter(|residual| residual.used == Use::LeftOut);
    let lengths = left_out.filter_map(|residual| Some((residual.v.map(|[x, y]| x.hypot(y))?, prepared.sights[residual.observation])));
    let Some((length, sight)) = lengths.max_by(|a, b| a.0.total_cmp(&b.0)) else { return String::new() };
    let sight = prepared.survey.sight(sight as usize);
    let kept = if prepared.settings.gross == GrossErrors::Rejected(Risk::WholeSet) { " (--plain keeps all)" } else { "" };
    format!(
        ": the worst, {} in {}, is {} px off{kept}",
        prepared.survey.target(sight.target),
        prepared.survey.images[sight.image],
        plain(length)
    )
}

/// Coefficients that are held because nothing else does.
fn held(calibration: &Calibration<'_>) -> Option<String> {
    let held = &calibration.prepared.held;
    (!held.is_empty()).then(|| {
        format!(
            "the images do not determine {}: they are held near zero by weak priors (above); a model with fewer parameters, or --prior, decides otherwise",
            held.join(", ")
        )
    })
}

/// Photographs without a board.
fn half(calibration: &Calibration<'_>) -> Option<String> {
    let seen = &calibration.prepared.survey.images;
    let lost: std::collections::BTreeSet<&str> = calibration.prepared.unmeasured.iter().map(|[image, ..]| image).collect();
    let none = lost.iter().filter(|image| !seen.iter().any(|seen| seen == *image)).count();
    (none > seen.len()).then(|| {
        format!(
            "the board was found in fewer than half of the photographs, {} of {}: are its counts right (--board)?",
            seen.len(),
            seen.len() + none
        )
    })
}

/// Standard deviations that the images do not confirm.
fn optimistic(calibration: &Calibration<'_>) -> Option<String> {
    let found = calibration.resampled.as_ref()?.as_ref().ok()?;
    let interior = &calibration.covariances.interior;
    let ratio = found.ratio((0..interior.nrows()).map(|i| interior[(i, i)].sqrt())).filter(|ratio| *ratio > OPTIMISTIC)?;
    Some(format!(
        "leaving images out changes the parameters {ratio:.1} times as much as the standard deviations say (median): residuals within an image belong together"
    ))
}

/// Image points and weighted control share one variance factor: an assumed standard deviation must be about right.
fn weights(calibration: &Calibration<'_>) -> Option<String> {
    let settings = &calibration.prepared.settings;
    let weighted = calibration.solution.counts().observed > 0;
    let sigma0 = calibration.solution.sigma0().filter(|sigma0| *sigma0 > 0.0 && !(0.67..=1.5).contains(sigma0))?;
    let sigma = settings.sigma();
    (weighted && settings.sigma_px.is_none()).then(|| {
        format!(
            "control or distances are weighted against an assumed {sigma} px for image coordinates; try --sigma {}",
            plain(sigma * sigma0)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_and_photographs_are_counted_apart() {
        let said = |rows: &[(&'static str, &'static str)]| lost(rows.iter().copied());
        assert_eq!(said(&[]), Vec::<String>::new());
        assert_eq!(said(&[("r1c1", "rejected")]), ["1 point was not measured: the method rejected it"]);
        let rows = [("", "not_found"), ("r1c1", "rejected"), ("r1c2", "rejected"), ("", COPY), ("", "not_found")];
        assert_eq!(
            said(&rows),
            [
                "2 points were not measured: the method rejected them",
                "2 photographs show no board that was found, and take no part",
                "1 photograph is a copy of another one, and takes no part",
            ]
        );
    }
}
