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
        Ok(search)
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
    let lengths: Vec<(usize, f64)> = solution.lengths()?.into_iter().filter_map(|(index, length)| Some((index, length?))).collect();
    let scale = scale_of(lengths.iter().map(|(_, length)| [*length, 0.0]));
    let Some(scale) = scale.filter(|scale| !is_rounding(Some(*scale))) else { return Ok(Vec::new()) };
    let critical = (2.0 * (lengths.len() as f64 / BY_CHANCE).ln()).sqrt();
    let found = |(observation, length): (usize, f64)| Found { observation, w: length / scale, critical, left_out: false };
    let mut beyond: Vec<Found> = lengths.into_iter().map(found).filter(|found| found.w > critical).collect();
    beyond.sort_by(|a, b| b.w.total_cmp(&a.w));
    Ok(beyond)
}

/// Whether image points of two cells depend on the same control points.
fn are_near(camera: &Splined, a: [usize; 2], b: [usize; 2]) -> bool {
    (0..2).all(|axis| a[axis].abs_diff(b[axis]) <= camera.order)
}
