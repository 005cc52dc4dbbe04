//! Whether the cameras of a rig still sit where they sat, as JSON.

use calibench_calibrate::rig::{Known, RigCalibration, Stand, Still};
use schemars::JsonSchema;
use serde::Serialize;

use super::Answer;

/// The cameras of a rig against where a file has them: each as the first one sees it.
#[derive(Serialize, JsonSchema)]
pub struct RigStandsAnswer {
    /// Why the adjustment of the new images is in doubt; with any the exit code is 3 where nothing moved.
    doubts: Vec<String>,
    /// The camera whose frame is that of the rig.
    origin: String,
    /// Moments at which the rig took images.
    moments: usize,
    /// Root mean square of the residuals in use (2D), px.
    rms_px: f64,
    /// The distance along the axis of the origin's camera at which points are compared, units of the control.
    distance: f64,
    /// Difference of pictured points up to which a camera stands, px RMS.
    margin_px: f64,
    /// The other cameras.
    cameras: Vec<CameraStands>,
}

#[derive(Serialize, JsonSchema)]
struct CameraStands {
    /// Its name.
    name: String,
    /// `stands`, `moved` or `cannot-tell`.
    verdict: &'static str,
    /// How far its projection centre has moved, units of the control.
    moved: ValueAndSigma,
    /// By what angle it has turned, degrees.
    turned_deg: ValueAndSigma,
    /// By how much points at the distance are elsewhere across its line of sight, units of the control, RMS.
    across: ValueAndSigma,
    /// By how much they are pictured elsewhere, px RMS (2D).
    px: ValueAndSigma,
    /// Fisher's statistic of the whole motion; null where it cannot be made.
    f: Option<f64>,
    /// Probability of so much by chance.
    p: f64,
    /// How often standard deviations count, as leaving moments out shows; 1 at least.
    times: f64,
}

#[derive(Serialize, JsonSchema)]
struct ValueAndSigma {
    /// The value.
    value: f64,
    /// Its standard deviation.
    sigma: f64,
}

impl From<Known> for ValueAndSigma {
    fn from(Known { value, sigma }: Known) -> Self {
        Self { value, sigma }
    }
}

impl Answer for RigStandsAnswer {
    const COMMAND: &'static str = "judge-rig";
    const SCHEMA: u32 = 1;
}

impl RigStandsAnswer {
    /// The answer; `before` are doubts about photographs.
    pub fn new(found: &RigCalibration<'_>, stands: &[Stand], (distance, margin_px): (f64, f64), before: &[String]) -> Self {
        let camera = |stand: &Stand| CameraStands {
            name: found.name_of(stand.camera).to_owned(),
            verdict: match stand.verdict(margin_px) {
                Still::Stands => "stands",
                Still::Moved => "moved",
                Still::CannotTell => "cannot-tell",
            },
            moved: stand.moved.into(),
            turned_deg: stand.turned_deg.into(),
            across: stand.across.into(),
            px: stand.px.into(),
            f: Some(stand.f).filter(|f| f.is_finite()),
            p: stand.p,
            times: stand.times,
        };
        Self {
            doubts: before.iter().cloned().chain(found.doubts.iter().map(|doubt| doubt.words.clone())).collect(),
            origin: found.origin().to_owned(),
            moments: found.prepared.rig.stations.len(),
            rms_px: found.rms_px(),
            distance,
            margin_px,
            cameras: stands.iter().map(camera).collect(),
        }
    }
}
