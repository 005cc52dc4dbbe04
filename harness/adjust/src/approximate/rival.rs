//! Second minima: which start values are worth the way to the next minimum.

/// The sum of squares, relative to that of the minimum to be rivalled, above which no other is near.
const HOPELESS: f64 = 50.0;
/// A squared residual that is always worth it, px^2.
const NEARLY_EXACT: f64 = 1e-6;

/// Whether a start value whose residuals have the sum of squares `squares` may lead `points` points to a minimum that rivals one of `best`; px^2.
pub(super) fn is_worth(squares: f64, best: f64, points: usize) -> bool {
    squares <= HOPELESS * best + points as f64 * NEARLY_EXACT
}

#[cfg(test)]
mod tests {
    use super::is_worth;

    #[test]
    fn exact_points_leave_room_for_rounding_and_nothing_else() {
        assert!(is_worth(9e-6, 0.0, 10) && !is_worth(1.1e-5, 0.0, 10));
        assert!(is_worth(49.0, 1.0, 10) && !is_worth(51.0, 1.0, 10) && !is_worth(f64::INFINITY, 1.0, 10) && !is_worth(f64::NAN, 1.0, 10));
    }
}
