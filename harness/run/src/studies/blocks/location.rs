//! How well the points of a block were located: their errors against the truth beside what operator and block say of them.

use std::collections::HashSet;

use calibench_records::figures::Quantity;
use calibench_records::results::{Figure, Outcome, PointResult};
use calibench_scenario::Block;

use super::Job;
use super::network::Solved;

/// Root mean square error and own standard deviation of a coordinate (px), the former over sigma0, and the shares that were lost or rejected.
pub fn figures(job: &Job<'_>, block: &Block, one: &Solved, points: &[PointResult], method: usize) -> Vec<Figure> {
    let images: HashSet<&str> = one.chosen.iter().map(|&image| job.stations[image].name.as_str()).collect();
    let targets: HashSet<&str> = block.targets.iter().map(|&target| job.field.targets[target].id.as_str()).collect();
    let mine: Vec<&PointResult> =
        points.iter().filter(|p| p.method == method && images.contains(&*p.view) && targets.contains(&*p.target)).collect();
    let of_all = |count: usize| count as f64 / mine.len().max(1) as f64;
    let kept: Vec<(f64, f64)> = mine.iter().filter_map(|point| point.outcome.kept_error()).collect();
    // The parameters of a block are no error of its points: what all of them have in common with their neighbours is.
    let rms = (kept.iter().map(|(dx, dy)| dx * dx + dy * dy).sum::<f64>() / (2 * kept.len().max(1)) as f64).sqrt();
    let own: Vec<f64> = mine.iter().filter_map(|point| point.predicted).map(|sigma| sigma * sigma).collect();
    let internal = (!own.is_empty()).then(|| (own.iter().sum::<f64>() / (2 * own.len()) as f64).sqrt());
    let mut figures = vec![
        Figure::plain(Quantity::CoordinateError, rms, "px"),
        Figure::plain(Quantity::Lost, of_all(mine.iter().filter(|point| point.outcome.is_lost()).count()), ""),
        Figure::plain(Quantity::Rejected, of_all(mine.iter().filter(|point| matches!(point.outcome, Outcome::Rejected(_))).count()), ""),
    ];
    figures.extend(internal.map(|sigma| Figure::plain(Quantity::OwnSigma, sigma, "px")));
    figures.extend(internal.zip(one.sigma0_px).map(|(sigma, sigma0)| Figure::plain(Quantity::OwnSigmaOverSigma0, sigma / sigma0, "")));
    figures
}
