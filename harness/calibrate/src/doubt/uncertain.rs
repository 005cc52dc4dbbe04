//! Cameras that are hardly known: over their frame, or beside another one that fits as well.

use calibench_adjust::adjust;
use calibench_diagnostics::plain;

use crate::search::{WITHIN, distance};
use crate::{Calibration, Doubt, Rival, SHARE, Subject, network, optics, start};

/// A standard deviation over the frame below which nothing is asked, px.
const LEAST_PX: f64 = 0.01;

/// What is not known well enough.
pub(super) fn found(calibration: &Calibration<'_>) -> Vec<Doubt> {
    let cameras = (0..calibration.cameras()).flat_map(|camera| [little(calibration, camera), together(calibration, camera)]).flatten();
    let rivals = calibration
        .prepared
        .rivals
        .iter()
        .filter(|rival| rival.is_beyond(calibration.limit_px(rival.camera)) && stands(calibration, rival) == Some(true));
    let told = |rival: &Rival| Doubt::of_camera(Subject::Rival, rival.camera, rival.words(&calibration.of(rival.camera)));
    cameras.chain(rivals.map(told)).collect()
}

fn little(calibration: &Calibration<'_>, camera: usize) -> Option<Doubt> {
    let known = calibration.over_frame[camera].filter(|known| !known.is_within())?;
    let whose = calibration.of(camera);
    let sigma = if known.px().is_finite() { format!("to {} px", plain(known.px())) } else { "to nothing that could be said".into() };
    let words = format!(
        "the camera{whose} is known {sigma} over the frame (standard deviation, RMS), beyond the limit of {} px: photographs from other directions, tilted and with points near the borders, or fewer parameters (--solve, --model); --limit sets another one",
        plain(known.limit_px)
    );
    Some(Doubt::of_camera(Subject::OverFrame, camera, words))
}

/// Errors that belong together in an image: leaving images out moves the camera by far more than its covariance says.
fn together(calibration: &Calibration<'_>, camera: usize) -> Option<Doubt> {
    let known = calibration.over_frame[camera]?;
    let times = known.by_images_px.filter(|px| *px > LEAST_PX)? / known.formal_px;
    (times > SHARE).then(|| {
        let words = format!(
            "leaving images out moves the camera{} {times:.1} times as much as its standard deviations say: points of an image are off together, as where the board or the focus changes",
            calibration.of(camera)
        );
        Doubt::of_camera(Subject::Together, camera, words)
    })
}

/// Whether a minimum that a sample of the images did not tell from the one found is as low with all of them, and still as far; `None` where it leads nowhere.
fn stands(calibration: &Calibration<'_>, rival: &Rival) -> Option<bool> {
    let prepared = calibration.prepared;
    let mut settings = prepared.settings.clone();
    settings.cameras[rival.camera].start = Some(rival.other);
    let owners = optics::owners(&settings.cameras, &prepared.survey.images).ok()?;
    let starts = start::starts(&prepared.survey, &owners, &settings).ok()?;
    let (mut other, ..) = network::network(&prepared.survey, &owners, &starts, &settings).ok()?;
    // The same observations of the same unknowns.
    let ended = calibration.ended();
    if other.observations.len() != ended.observations.len() {
        return None;
    }
    other.observations.clone_from(&ended.observations);
    (other.points, other.surfaces, other.datum, other.per_image) = (ended.points, ended.surfaces, ended.datum, ended.per_image);
    let found = adjust(&other, &calibration.options()).ok()?;
    let variance = calibration.covariances.variance_factor;
    let is_low = found.cost() - calibration.solution.cost() < WITHIN * variance;
    let apart = distance(calibration.camera(rival.camera), &found.cameras()[rival.camera]);
    Some(is_low && apart.is_none_or(|px| px > calibration.limit_px(rival.camera)))
}
