//! Whether there is anything to show.

use calibench_records::figures::Quantity;

use crate::load::adjustments::Summaries;

/// Whether any calibration could be applied: check points then have an error in space.
pub fn has_check_points(found: &Summaries) -> bool {
    found.figures.keys().any(|(.., name)| name.quantity() == Quantity::RmseXyz)
}
