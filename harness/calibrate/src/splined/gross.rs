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

/// Residuals by their own covariances.
struct Lengths {
    /// By the index of the observation, in standard deviations of the set, the longest first.
    of: Vec<(usize, f64)>,
    critical: f64,
}

impl Lengths {
    /// `None` where residuals are no more than rounding.
    fn of(solution: &SplinedSolution<'_>) -> Result<Option<Self>, CalibrationError> {
        let mut of: Vec<(usize, f64)> = solution.lengths()?.into_iter().filter_map(|(index, length)| Some((index, length?))).collect();
        let scale = scale_of(of.iter().map(|(_, length)| [*length, 0.0]));
        let Some(scale) = scale.filter(|scale| !is_rounding(Some(*scale))) else { return Ok(None) };
        of.iter_mut().for_each(|(_, length)| *length /= scale);
        of.sort_by(|a, b| b.1.total_cmp(&a.1));
        let critical = (2.0 * (of.len() as f64 / BY_CHANCE).ln()).sqrt();
        Ok(Some(Self { of, critical }))
    }

    fn beyond(&self) -> impl Iterator<Item = (usize, f64)> {
        self.of.iter().copied().take_while(|(_, length)| *length > self.critical)
    }
}

/// The image points whose residuals no normal error would have, the longest first: by index and length.
pub(super) fn beyond_chance(solution: &SplinedSolution<'_>) -> Result<Vec<(usize, f64)>, CalibrationError> {
    Ok(Lengths::of(solution)?.map_or_else(Vec::new, |lengths| lengths.beyond().collect()))
}

/// Leaves out what no normal error would be, adjusts again, until there is nothing more; all are kept where these are too many.
///
/// Splines follow an image point that is wrong, and so do all image points about it: of those in one image, and of those that the same control points hold, the longest go at a time.
pub(super) fn without_gross_errors(all: SplinedSolution<'_>) -> Result<(SplinedSolution<'_>, Vec<Found>), CalibrationError> {
    let most = MOST_LEFT_OUT * all.network().network.observations.len() as f64;
    let (mut solution, mut found): (SplinedSolution<'_>, Vec<Found>) = (all.clone(), Vec::new());
    for _ in 0..ROUNDS {
        let Some(lengths) = Lengths::of(&solution)? else { break };
        let more = apart(&solution, &lengths);
        if more.is_empty() {
            break;
        }
        found.extend(more);
        let left_out: Vec<usize> = found.iter().map(|found| found.observation).collect();
        if found.len() as f64 > most {
            return Ok((all, Vec::new()));
        }
        match solution.without(&left_out) {
            Ok(better) => solution = better,
            Err(_) => return Ok((all, Vec::new())),
        }
    }
    Ok((solution, found))
}

/// Those beyond the critical length that are not long because of one that is longer.
fn apart(solution: &SplinedSolution<'_>, lengths: &Lengths) -> Vec<Found> {
    let observations = &solution.network().network.observations;
    let mut found: Vec<(Found, [usize; 2])> = Vec::new();
    for (observation, w) in lengths.beyond() {
        let Some(cell) = solution.camera().cell(solution.ray(observation)) else { continue };
        let follows = |(other, at): &(Found, [usize; 2])| {
            let is_near =
                observations[other.observation].image == observations[observation].image || are_near(solution.camera(), *at, cell);
            is_near && w < FOLLOWS * other.w
        };
        if !found.iter().any(follows) {
            found.push((Found { observation, w, critical: lengths.critical, left_out: true }, cell));
        }
    }
    found.into_iter().map(|(found, _)| found).collect()
}

/// Whether image points of two cells depend on the same control points.
fn are_near(camera: &Splined, a: [usize; 2], b: [usize; 2]) -> bool {
    (0..2).all(|axis| a[axis].abs_diff(b[axis]) <= camera.order)
}
