//! A compared set of parameters as JSON.

use calibench_calibrate::{ComparedSet, SetResult};
use schemars::JsonSchema;
use serde::Serialize;

#[derive(Serialize, JsonSchema)]
pub(super) struct Set {
    /// The parameters that are solved for.
    parameters: Vec<String>,
    /// Why there is no result, if so.
    undetermined: Option<String>,
    /// Estimated standard deviation of an image coordinate, px.
    sigma0_px: Option<f64>,
    /// Observations less unknowns.
    redundancy: Option<i64>,
    /// Akaike's criterion, corrected for few observations: differences count, less is better.
    aicc: Option<f64>,
    /// Number (from 1) of the largest other set that is a part of this one.
    against: Option<usize>,
    /// The test of what this set has more than that one.
    f: Option<f64>,
    /// Probability of such an F if the additional parameters are zero.
    f_p: Option<f64>,
    /// How far its camera is from the calibration's over the frame after the best rotation, px: RMS and most.
    change_px: Option<[f64; 2]>,
}

impl Set {
    pub(super) fn new(set: &ComparedSet) -> Self {
        let result: Option<&SetResult> = set.result.as_ref().ok();
        Self {
            parameters: set.names.clone(),
            undetermined: set.result.as_ref().err().cloned(),
            sigma0_px: result.map(|result| result.sigma0_px),
            redundancy: result.map(|result| result.counts.0 as i64 - result.counts.1 as i64),
            aicc: result.map(|result| result.aicc),
            against: set.against.map(|(other, _)| other + 1),
            f: set.against.map(|(_, test)| test.f),
            f_p: set.against.map(|(_, test)| test.p),
            change_px: result.and_then(|result| result.change_px),
        }
    }
}
