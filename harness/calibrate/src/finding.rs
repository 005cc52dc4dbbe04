//! What was found in the residuals.

/// How strong a structure is, and what it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finding {
    /// Probability of residuals as uneven by chance.
    pub p: f64,
    /// By how many of its standard deviations over the frame the camera moves when the structure is allowed for; `None` if that cannot be said.
    pub moves: Option<f64>,
    /// Share of the variance of unit weight, 0 to 1, that goes when the structure is allowed for; 0 where nothing more was allowed for.
    pub explains: f64,
}
