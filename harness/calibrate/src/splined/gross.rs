//! Image points that are wrong, before splines that follow them.

use calibench_adjust::{Found, SplinedSolution, scale_of};
use calibench_model::camera::Splined;

use crate::CalibrationError;
use crate::doubt::gross::is_rounding;

/// How many good image points are left out by chance, over all.
const BY_CHANCE: f64 = 1e-3;
/// Rounds of leaving out at most.
const ROUNDS: usize = 30;
/// Share of a length below which another in the same image, or of the same control points, may be long because of it.
const FOLLOWS: f64 = 0.8;
/// Share of the image points that is left out at most: more are no errors of single points.
const MOST_LEFT_OUT: f64 = 0.1;

/// Splines with what became of the image points that do not fit.
pub(super) struct Search<'n> {
    pub(super) solution: SplinedSolution<'n>,
    /// Left out.
    pub(super) left_out: Vec<Found>,
    /// In use.
    pub(super) kept: Vec<Found>,
}

impl<'n> Search<'n> {
    /// Leaves nothing out.
    pub(super) fn keeping(solution: SplinedSolution<'n>) -> Result<Self, CalibrationError> {
        let kept = beyond(&solution)?;
        Ok(Self { solution, left_out: Vec::new(), kept })
    }

    /// Leaves out what no normal error would be, adjusts again, until there is nothing more; all are kept where these are too many.
    ///
    /// Splines follow an image point that is wrong, and so do all image points about it: of those in one image, and of those that the same control points hold, the longest go at a time.
    pub(super) fn leaving_out(all: SplinedSolution<'n>) -> Result<Self, CalibrationError> {
        let most = MOST_LEFT_OUT * all.network().network.observations.len() as f64;
        let kept = beyond(&all)?;
        let mut search = Self { solution: all.clone(), left_out: Vec::new(), kept };
        for _ in 0..ROUNDS {
            let more = search.apart();
            if more.is_empty() {
                break;
            }
            search.left_out.extend(more);
            let left_out: Vec<usize> = search.left_out.iter().map(|found| found.observation).collect();
            let better = if left_out.len() as f64 > most { None } else { search.solution.without(&left_out).ok() };
            let Some(better) = better else { return Self::keeping(all) };
            search.kept = beyond(&better)?;
            search.solution = better;
        }
        search.taking_back()
    }

    /// Takes those back that fit what was found without them, as some do that were long because of others, if all that is in use fits then as well.
    fn taking_back(mut self) -> Result<Self, CalibrationError> {
        let Some((scale, critical)) = limits(&self.solution.lengths()?) else { return Ok(self) };
        let (observations, residuals) = (&self.solution.network().network.observations, self.solution.residuals());
        // What is predicted is less certain than what is measured: below the limit by its own error alone it is below it.
        let fits = |found: &Found| {
            let white = residuals[found.observation].v.map(|v| observations[found.observation].precision.whitened(v));
            white.is_some_and(|[x, y]| x.hypot(y) < critical * scale)
        };
        let (back, out): (Vec<Found>, Vec<Found>) = self.left_out.iter().copied().partition(fits);
        if back.is_empty() {
            return Ok(self);
        }
        let left_out: Vec<usize> = out.iter().map(|found| found.observation).collect();
        if let Ok(solution) = self.solution.without(&left_out) {
            let kept = beyond(&solution)?;
            if kept.len() <= self.kept.len() {
                self = Self { solution, left_out: out, kept };
            }
        }
        Ok(self)
    }

    /// Those in use that are not long because of one that is longer.
    fn apart(&self) -> Vec<Found> {
        let (observations, camera) = (&self.solution.network().network.observations, self.solution.camera());
        let mut apart: Vec<(Found, [usize; 2])> = Vec::new();
        for found in &self.kept {
            let Some(cell) = camera.cell(self.solution.ray(found.observation)) else { continue };
            let follows = |(other, at): &(Found, [usize; 2])| {
                let is_of_image = observations[other.observation].image == observations[found.observation].image;
                (is_of_image || are_near(camera, *at, cell)) && found.w < FOLLOWS * other.w
            };
            if !apart.iter().any(follows) {
                apart.push((Found { left_out: true, ..*found }, cell));
            }
        }
        apart.into_iter().map(|(found, _)| found).collect()
    }
}

/// The image points whose residuals, by their own covariances, no normal error would have, the longest first; none where residuals are no more than rounding.
fn beyond(solution: &SplinedSolution<'_>) -> Result<Vec<Found>, CalibrationError> {
    let lengths = solution.lengths()?;
    let Some((scale, critical)) = limits(&lengths) else { return Ok(Vec::new()) };
    let of = |(observation, length): (usize, Option<f64>)| Some(Found { observation, w: length? / scale, critical, left_out: false });
    let mut beyond: Vec<Found> = lengths.into_iter().filter_map(of).filter(|found| found.w > critical).collect();
    beyond.sort_by(|a, b| b.w.total_cmp(&a.w));
    Ok(beyond)
}

/// The scale of lengths by their median, and the length in units of it that one of [`BY_CHANCE`] sets of as many has; `None` where residuals are no more than rounding.
fn limits(lengths: &[(usize, Option<f64>)]) -> Option<(f64, f64)> {
    let known = || lengths.iter().filter_map(|(_, length)| *length);
    let scale = scale_of(known().map(|length| [length, 0.0])).filter(|scale| !is_rounding(Some(*scale)))?;
    Some((scale, (2.0 * (known().count() as f64 / BY_CHANCE).ln()).sqrt()))
}

/// Whether image points of two cells depend on the same control points.
fn are_near(camera: &Splined, a: [usize; 2], b: [usize; 2]) -> bool {
    (0..2).all(|axis| a[axis].abs_diff(b[axis]) <= camera.order)
}
