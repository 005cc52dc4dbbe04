//! The board's share of what is not predicted.

use std::collections::BTreeMap;
use std::sync::Arc;

use calibench_model::upper_median;

use super::{Cell, Estimate, Trusted};
use crate::statistics::paired::paired_t;

/// The chance (0 to 1) at which other corners are said to predict better.
const ALPHA: f64 = 0.01;

/// Predictions with other corners of the board than those of the verdict.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherCorners {
    /// RMS with which unseen photographs are predicted with them, px.
    pub holdout: Estimate,
    /// The chance of as much of an improvement, photograph by photograph, if these corners predict no better than those of the verdict.
    pub p_better: f64,
    /// The same of as much of a loss if they predict no worse.
    pub p_worse: f64,
}

/// How far freed corners are from their places, object units: root mean squares over corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreedCorners {
    /// In the plane of the board (2D), what their standard deviations explain taken out.
    pub in_plane: f64,
    /// Along its normal, likewise.
    pub across: f64,
    /// The standard deviation in the plane (2D).
    pub sigma_in_plane: f64,
    /// The one along the normal.
    pub sigma_across: f64,
}

/// What of the error of predictions is the board's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardShare {
    /// With corners that are freed in the photographs that take part.
    pub freed: OtherCorners,
    /// What the board as it is said to be adds to it, px: the root of the difference of squares; 0 where free corners predict no better.
    pub board_px: f64,
    /// What separates the operators, px: the root of the difference of squares of the middle one of the others and the best; `None` of one alone.
    pub operators_px: Option<f64>,
    /// The same of the models.
    pub models_px: Option<f64>,
    /// How far the corners are from their places; `None` where that cannot be told.
    pub moved: Option<FreedCorners>,
    /// Of a board whose corners were measured: with its nominal corners; `None` of others.
    pub nominal: Option<OtherCorners>,
}

impl BoardShare {
    /// Whether the board decides: freed corners predict better for sure, and its share is larger than what separates the operators, or, of one alone, than all the rest.
    pub fn decides(&self) -> bool {
        self.freed.p_better < ALPHA && self.is_larger(self.board_px, self.freed.holdout.value)
    }

    /// What the nominal corners would add, px; `None` where none were measured or nominal ones predict as well.
    pub fn file_px(&self, holdout: f64) -> Option<f64> {
        let nominal = self.nominal.filter(|nominal| nominal.p_worse < ALPHA)?;
        Some(beyond(nominal.holdout.value, holdout)).filter(|px| *px > 0.0)
    }

    /// Whether the measured corners decide beside nominal ones, whose predictions with them are `holdout`, px.
    pub fn file_decides(&self, holdout: f64) -> bool {
        self.file_px(holdout).is_some_and(|px| self.is_larger(px, holdout))
    }

    /// Whether measured corners predict worse than nominal ones: they are of another board, or of this one before it changed.
    pub fn file_misfits(&self) -> bool {
        self.nominal.is_some_and(|nominal| nominal.p_better < ALPHA)
    }

    fn is_larger(&self, px: f64, rest: f64) -> bool {
        px > self.operators_px.unwrap_or(rest)
    }
}

/// The root of the difference of two squares, 0 where it has none.
fn beyond(large: f64, small: f64) -> f64 {
    (large * large - small * small).max(0.0).sqrt()
}

/// What was predicted with other corners, beside the cell's own predictions; `None` where not all the same photographs were.
pub(super) fn other_corners(
    own: &BTreeMap<Arc<str>, (f64, usize)>,
    others: &BTreeMap<Arc<str>, (f64, usize)>,
    pooled: impl Fn(&BTreeMap<Arc<str>, (f64, usize)>) -> Option<Estimate>,
) -> Option<OtherCorners> {
    if own.len() != others.len() || own.is_empty() {
        return None;
    }
    let gain = own.iter().map(|(view, (rms, _))| {
        let (other, _) = others.get(view)?;
        Some((rms / other).ln())
    });
    let gain = gain.collect::<Option<Vec<f64>>>()?;
    let gain: Vec<f64> = gain.into_iter().filter(|gain| gain.is_finite()).collect();
    let loss: Vec<f64> = gain.iter().map(|gain| -gain).collect();
    Some(OtherCorners { holdout: pooled(others)?, p_better: paired_t(&gain).growth, p_worse: paired_t(&loss).growth })
}

impl Trusted<'_> {
    /// What of the predictions' error is the board's, beside operators and models; `None` where its corners were not freed.
    pub fn board(&self) -> Option<BoardShare> {
        let (cell, freed) = (self.cell, self.cell.freed?);
        let own = cell.holdout?.value;
        let rms = |cell: &Cell| cell.holdout.map(|holdout| holdout.value);
        let best = rms(self.least)?;
        let operators_px = upper_median(self.operators.iter().filter_map(|(cell, _)| rms(cell))).map(|middle| beyond(middle, best));
        let models = self.models.iter().filter(|standing| standing.cell != cell).filter_map(|standing| rms(standing.cell));
        let models_px = upper_median(models).map(|middle| beyond(middle, own));
        let board_px = beyond(own, freed.holdout.value);
        Some(BoardShare { freed, board_px, operators_px, models_px, moved: cell.moved, nominal: cell.nominal })
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::{Row, measure};
    use super::super::Summary;
    use super::*;

    fn rows(own: &[f64], freed: &[f64], nominal: &[f64], others: &[f64]) -> Vec<Row> {
        let by = |name: &'static str, rms: &[f64]| {
            rms.iter().zip(1..).map(|(rms, view)| Row::px(name, &format!("v{view}"), *rms).of(10)).collect::<Vec<_>>()
        };
        let corners = |method: &str| Row::plain(measure::CORNERS, "v1", 9.0).beside(1.0).of(10).by(&method.into(), &"".into());
        let mut found = vec![corners("m"), corners("n")];
        let own = [
            vec![Row::plain(measure::PARAMETERS, "", 4.0)],
            by(measure::HOLDOUT, own),
            by(measure::BOARD_FREED, freed),
            by(measure::BOARD_NOMINAL, nominal),
            vec![
                Row::plain(measure::BOARD_MOVED, "in the plane", 0.05).beside(0.03),
                Row::plain(measure::BOARD_MOVED, "across", 0.01).beside(0.03),
            ],
        ];
        found.extend(own.concat().into_iter().map(|row| row.by(&"m".into(), &"a".into())));
        found.extend(by(measure::HOLDOUT, others).into_iter().map(|row| row.by(&"n".into(), &"a".into())));
        found
    }

    const OWN: [f64; 6] = [0.50, 0.51, 0.49, 0.50, 0.52, 0.48];

    fn share(rows: &[Row]) -> BoardShare {
        Summary::new(rows, 1).trusted().unwrap().board().unwrap()
    }

    /// 3, 4, 5: where free corners predict to 0.3 of 0.5 px the board adds 0.4.
    #[test]
    fn the_share_of_the_board_is_a_difference_of_squares() {
        let freed = OWN.map(|rms| 0.6 * rms);
        let larger = rows(&OWN, &freed, &[], &OWN.map(|rms| 1.1 * rms));
        let found = share(&larger);
        let own = Summary::new(&larger, 1).trusted().unwrap().cell.holdout.unwrap().value;
        assert!((found.board_px - 0.8 * own).abs() < 1e-12, "{found:?}");
        assert!((found.operators_px.unwrap() - (1.21_f64 - 1.0).sqrt() * own).abs() < 1e-12 && found.models_px.is_none());
        assert!(found.decides() && !found.file_misfits() && found.file_px(own).is_none());
        let moved = found.moved.unwrap();
        assert!((moved.in_plane - 0.04).abs() < 1e-12 && moved.across == 0.0, "{moved:?}");
        assert!(!share(&rows(&OWN, &freed, &[], &OWN.map(|rms| 1.5 * rms))).decides(), "operators differ by more");
        let worse = share(&rows(&OWN, &OWN.map(|rms| 1.05 * rms), &[], &OWN.map(|rms| 1.1 * rms)));
        assert!(!worse.decides() && worse.board_px == 0.0);
        // As large in the mean, from one photograph alone.
        let one = share(&rows(&OWN, &[0.1, 0.52, 0.48, 0.51, 0.5, 0.5], &[], &OWN.map(|rms| 1.01 * rms)));
        assert!(one.board_px > one.operators_px.unwrap() && !one.decides(), "{one:?}");
    }

    #[test]
    fn measured_corners_are_held_against_nominal_ones() {
        let as_good = OWN.map(|rms| 1.01 * rms);
        let helps = rows(&OWN, &as_good, &OWN.map(|rms| 1.6 * rms), &OWN.map(|rms| 1.1 * rms));
        let own = Summary::new(&helps, 1).trusted().unwrap().cell.holdout.unwrap().value;
        let found = share(&helps);
        assert!((found.file_px(own).unwrap() - (2.56_f64 - 1.0).sqrt() * own).abs() < 1e-12, "{found:?}");
        assert!(found.file_decides(own) && !found.file_misfits() && !found.decides());
        assert!(share(&rows(&OWN, &as_good, &OWN.map(|rms| 0.9 * rms), &as_good)).file_misfits());
        let unseen = rows(&OWN, &as_good[..5], &[], &as_good);
        assert!(Summary::new(&unseen, 1).trusted().unwrap().board().is_none(), "not all photographs were predicted");
    }
}
