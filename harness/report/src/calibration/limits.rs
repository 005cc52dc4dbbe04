//! What is worth a word on the page.

/// Correlations beyond this are flagged.
pub(crate) const CORRELATED: f64 = 0.9;
/// A parameter that chance would make as large in more than this share of all cases is doubtful.
pub(super) const DOUBTFUL: f64 = 0.05;
/// Parameters of which a test against zero means nothing.
pub(super) const BASIC: [&str; 9] = ["c", "f", "F", "fx", "fy", "x0", "y0", "cx", "cy"];
