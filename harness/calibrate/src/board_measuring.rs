//! Measures a board: its corners from a calibration in which every one of them is free.

use calibench_adjust::{Datum, Network, ObjectPoint, Solution, adjust};
use nalgebra::{Matrix3, Point3, Vector3};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use crate::measured_board::{ENOUGH, in_parts, repeats};
use crate::shape::{board, surface, test};
use crate::{BoardShape, BoardTest, Calibration, MeasuredBoard, MeasuredCorner, Moved};

/// Photographs with fewer do not measure a board.
const LEAST: usize = 4;

impl Calibration<'_> {
    /// Measures the board: keeps its corners and what is to be said of them in [`Self::measured_board`].
    pub fn measure_board(&mut self) {
        self.measured_board = Some(self.board_of_corners());
    }

    fn board_of_corners(&self) -> Result<MeasuredBoard, String> {
        let photographs = self.solution.poses().len();
        if photographs < LEAST {
            return Err(format!(
                "{photographs} photographs; expected {LEAST} of it at least, and {ENOUGH} or more, tilted and turned, that hold it well"
            ));
        }
        let free = self.ended();
        if free.datum != Datum::Inner || self.solution.counts().redundancy() <= 0 {
            return Err("its corners are not free".into());
        }
        let nominal = self.nominal()?;
        let flat = network(&free, &nominal, ObjectPoint::fixed, Datum::Control);
        let board = board::board(&flat).map_err(str::to_owned)?;
        let against = adjust(&flat, &self.options()).map_err(|error| format!("no adjustment with its nominal corners: {error}"))?;
        let bend = test::bend(&flat, &board, &self.prepared.settings).ok().flatten();
        let beyond_bend = bend.and_then(|bend| {
            let surfaces = vec![surface(&flat, &board, BoardShape::Bent, bend.coefficients)];
            let bent = Network { surfaces, ..flat.clone() };
            adjust(&bent, &self.options()).ok().and_then(|bent| compared(&bent, &self.solution))
        });
        let mut photographs_of = vec![0; nominal.len()];
        free.observations.iter().for_each(|seen| photographs_of[seen.point] += 1);
        let found: Vec<Vector3<f64>> = self.solution.points().iter().zip(&nominal).map(|(at, nominal)| at - nominal).collect();
        let variances = self.variances();
        let sigma = in_parts(variances.iter().map(|block| [0, 1, 2].map(|k| (board.axes[k].transpose() * block * board.axes[k])[0])));
        let start = network(&free, &nominal, ObjectPoint::free, Datum::Inner);
        let repeats = repeats(&start, &self.options(), (&board, &nominal), sigma);
        let enlarged = repeats.as_ref().map_or(1.0, |repeats| repeats.sigmas.max(1.0));
        let corner = |(k, point): (usize, &ObjectPoint)| MeasuredCorner {
            name: point.name.clone(),
            nominal: nominal[k],
            position: nominal[k] + found[k],
            covariance: variances[k] * enlarged.powi(2),
            photographs: photographs_of[k],
        };
        Ok(MeasuredBoard {
            corners: free.points.iter().enumerate().map(corner).collect(),
            deviation: in_parts(found.iter().map(|moved| board.axes.map(|axis| moved.dot(&axis).powi(2)))),
            sigma: Moved { in_plane: sigma.in_plane * enlarged, across: sigma.across * enlarged },
            test: compared(&against, &self.solution).ok_or("its test has no redundancy")?,
            bend,
            beyond_bend,
            repeats,
            photographs,
        })
    }

    /// Covariances of the network's points without what the scale of the print adds, which belongs to all corners together.
    fn variances(&self) -> Vec<Matrix3<f64>> {
        let share = self.prepared.settings.board.scale.map_or(0.0, |scale| scale.share());
        let without = |(block, at): (&Matrix3<f64>, &Point3<f64>)| block - at.coords * at.coords.transpose() * share.powi(2);
        self.covariances.points.iter().zip(self.solution.points()).map(without).collect()
    }

    /// Nominal places of the network's points.
    fn nominal(&self) -> Result<Vec<Point3<f64>>, String> {
        let survey = &self.prepared.survey;
        let of = |point: &ObjectPoint| survey.target_called(&point.name).and_then(|target| survey.known(target));
        let known = |point: &ObjectPoint| of(point).ok_or_else(|| format!("`{}` is none of its corners", point.name));
        self.prepared.network.points.iter().map(known).collect()
    }
}

/// `whole` with its points at other places and of another status, and another datum.
fn network(whole: &Network, at: &[Point3<f64>], point: fn(String, Point3<f64>) -> ObjectPoint, datum: Datum) -> Network {
    let points = whole.points.iter().zip(at).map(|(old, at)| point(old.name.clone(), *at)).collect();
    Network { points, datum, surfaces: Vec::new(), ..whole.clone() }
}

/// The test of what the second solution has more of the same observations; `None` without redundancy.
fn compared(first: &Solution<'_>, second: &Solution<'_>) -> Option<BoardTest> {
    let redundancy = second.counts().redundancy();
    let more = usize::try_from(first.counts().redundancy() - redundancy).ok().filter(|more| *more > 0)?;
    let f = (first.cost() - second.cost()).max(0.0) / more as f64 / (second.cost() / redundancy as f64).max(f64::MIN_POSITIVE);
    let p = FisherSnedecor::new(more as f64, redundancy as f64).ok()?.sf(f);
    Some(BoardTest { f, more, redundancy, p })
}
