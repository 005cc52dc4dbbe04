//! What the gate takes for no change, and how often it may be wrong.

/// The family-wise error rate of a check: the chance that it fails although nothing became worse, over all its tests together.
///
/// At most one of a hundred runs may be a false alarm. A rate of 0.01 would hold that in expectation only, and break it every
/// fourth time; at 0.001 the expectation is 0.1, and two or more false alarms in a hundred have a chance below 0.01.
/// Counts, means, spread and reported standard deviations have a quarter of it each, whatever the number of their tests.
pub const ALPHA: f64 = 0.001;

/// What is no change at all, px: last bits that differ between machines.
pub const TOLERANCE: f64 = 1e-6;

/// Fewer trials than this are not put to a t-test, whose differences of a handful would look certain; their figures are compared directly.
pub const LEAST_PAIRS: usize = 10;

/// Errors count in means and mean squares as no more than this in each coordinate, px: what is further off is simply elsewhere.
pub const BOUND: f64 = 3.0;
