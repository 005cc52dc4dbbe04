//! Whether a calibration in use still holds.

use super::Trusted;

/// The chance (0 to 1) that a difference of the camera in use is within what is stated of its error.
const SURE: f64 = 0.99;
/// Cameras that differ by no more over the frame, px, are one and the same calibration: no second one comes as near.
const SAME_PX: f64 = 1e-3;

/// What photographs say of a camera in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StillHolds {
    /// It differs from the camera of the photographs by no more than the margin, for sure.
    Holds,
    /// It differs by more than the margin, for sure.
    Moved,
    /// The photographs do not say.
    CannotTell,
}

/// A camera in use beside the one that the photographs determine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InUse {
    /// What the photographs say.
    pub verdict: StillHolds,
    /// RMS difference over the frame after the best rotation, px.
    pub apart: f64,
    /// Within which this difference is known in 99 of 100 cases, px. Infinite where the photographs are in doubt.
    pub error: f64,
    /// The difference up to which the camera holds, px.
    pub margin: f64,
}

impl InUse {
    /// Of two cameras that cannot be compared over the frame: the photographs cannot tell.
    pub const fn unknown(margin: f64) -> Self {
        Self { verdict: StillHolds::CannotTell, apart: f64::NAN, error: f64::INFINITY, margin }
    }
}

impl Trusted<'_> {
    /// The published camera as one that is in use, which may differ by `margin`, px RMS over the frame; `None` without one.
    ///
    /// A camera that is as before is said to have moved in at most one of 100 cases, since the true difference is within the error of the one found.
    pub fn in_use(&self, margin: f64) -> Option<InUse> {
        let published = self.cell.published?;
        let apart = published.beside.frame;
        let doubt = self.models.iter().find(|standing| standing.cell == self.cell).and_then(|standing| standing.doubt);
        let error = doubt
            .zip(self.cell.predicted)
            .and_then(|(doubt, predicted)| predicted.within(SURE, doubt.hypot(published.stated.unwrap_or(0.0))));
        let error = error.filter(|_| self.doubt().is_none()).unwrap_or(f64::INFINITY);
        let verdict = match () {
            () if apart + error <= margin || apart <= SAME_PX.min(margin) => StillHolds::Holds,
            () if apart - error > margin => StillHolds::Moved,
            () => StillHolds::CannotTell,
        };
        Some(InUse { verdict, apart, error, margin })
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::{Row, measure};
    use super::super::Summary;
    use super::*;

    fn rows(apart: f64, formal: f64, stated: Option<f64>) -> Vec<Row> {
        let mut rows = vec![
            Row::plain(measure::PARAMETERS, "", 4.0),
            Row::px(measure::HOLDOUT, "v1", 0.1).of(50),
            Row::px(measure::FRAME, "", formal),
            Row::plain(measure::FRAME_MODES, "", 2.0),
            Row::px(measure::PUBLISHED, "", apart).beside(formal),
            Row::px(measure::PUBLISHED_MOST, "", 2.0 * apart),
        ];
        rows.extend(stated.map(|sigma| Row::px(measure::PUBLISHED_SIGMA, "", sigma)));
        let corners = Row::plain(measure::CORNERS, "v1", 50.0).beside(50.0).of(50).by(&"m".into(), &"".into());
        [vec![corners], rows.into_iter().map(|row| row.by(&"m".into(), &"a".into())).collect()].concat()
    }

    fn found(rows: &[Row], margin: f64) -> InUse {
        Summary::new(rows, 1).trusted().unwrap().in_use(margin).unwrap()
    }

    /// Two modes: in 99 of 100 cases within sqrt(-ln 0.01) = 2.146 standard deviations.
    #[test]
    fn a_camera_holds_or_has_moved_only_beyond_its_error() {
        let of = |apart: f64| found(&rows(apart, 0.1, None), 0.5);
        assert!((of(0.2).error - 0.1 * (-0.01_f64.ln()).sqrt()).abs() < 1e-9);
        let verdicts = [0.28, 0.29, 0.71, 0.72].map(|apart| of(apart).verdict);
        assert_eq!(verdicts, [StillHolds::Holds, StillHolds::CannotTell, StillHolds::CannotTell, StillHolds::Moved]);
        let stated = found(&rows(0.28, 0.06, Some(0.08)), 0.5);
        assert!((stated.error - of(0.28).error).abs() < 1e-9, "what the file says of itself counts too: {stated:?}");
    }

    /// Photographs that hardly determine a camera give the one that was calibrated from them.
    #[test]
    fn the_calibration_of_the_photographs_themselves_holds() {
        let of = |apart: f64| found(&rows(apart, 9.0, None), 0.5).verdict;
        assert_eq!([1e-8, 0.9e-3, 1.1e-3].map(of), [StillHolds::Holds, StillHolds::Holds, StillHolds::CannotTell]);
    }

    #[test]
    fn where_the_photographs_are_in_doubt_nothing_can_be_told() {
        let mut doubtful = rows(9.0, 0.1, None);
        doubtful.retain(|row| &*row.measure != measure::FRAME);
        let found = found(&doubtful, 0.5);
        assert_eq!((found.verdict, found.error), (StillHolds::CannotTell, f64::INFINITY));
        let mut without = rows(9.0, 0.1, None);
        without.retain(|row| &*row.measure != measure::PUBLISHED);
        assert!(Summary::new(&without, 1).trusted().unwrap().in_use(0.5).is_none());
    }
}
