//! The spread of edges by view, direction and distance from the middle of the frame.

use calibench_model::median;
use nalgebra::{Matrix3, Vector3};

use super::edge::EdgeFit;

/// Covariance of the line spread in the middle of the frame, with the pixel's own: xx, xy, yy, px^2.
pub type Spread = [f64; 3];

/// Views with fewer edges have no spread of their own.
const FEWEST: usize = 8;

/// The square of the distance from the middle of the frame as a share of that of its corners.
fn radius(edge: &EdgeFit, size: [f64; 2]) -> f64 {
    (edge.at[0].powi(2) + edge.at[1].powi(2)) / (0.25 * (size[0].powi(2) + size[1].powi(2)))
}

fn row([x, y]: [f64; 2]) -> Vector3<f64> {
    Vector3::new(x * x, 2.0 * x * y, y * y)
}

/// The variance across an edge whose normal this is.
pub fn across(spread: &Spread, normal: [f64; 2]) -> f64 {
    row(normal).dot(&Vector3::from(*spread))
}

/// By view the covariance in the middle of the frame, `None` of too few edges, and how much larger variances are in the corners, px^2.
pub fn spreads(views: &[&[EdgeFit]], size: [f64; 2]) -> (Vec<Option<Spread>>, f64) {
    let mut corner = 0.0;
    let mut found = Vec::new();
    for _ in 0..3 {
        found = views.iter().map(|edges| of_view(edges, size, corner)).collect::<Vec<_>>();
        corner += more(views, &found, size, corner);
    }
    (found, corner)
}

/// The standard deviation of a view's mean variance across edges, px^2, from their scatter.
pub fn variance_sigma(edges: &[EdgeFit], spread: &Spread, corner: f64, size: [f64; 2]) -> f64 {
    let misfits: Vec<f64> =
        edges.iter().map(|edge| (edge.spread.powi(2) - corner * radius(edge, size) - across(spread, edge.normal)).abs()).collect();
    let count = misfits.len().max(1) as f64;
    // The median of absolute normal errors is 0.6745 standard deviations.
    median(misfits).unwrap_or(f64::NAN) / 0.6745 / count.sqrt()
}

fn of_view(edges: &[EdgeFit], size: [f64; 2], corner: f64) -> Option<Spread> {
    if edges.len() < FEWEST {
        return None;
    }
    let value = |edge: &EdgeFit| edge.spread.powi(2) - corner * radius(edge, size);
    let first = solved(edges.iter().map(|edge| (row(edge.normal), value(edge))))?;
    let misfit = |edge: &EdgeFit| (value(edge) - across(&first, edge.normal)).abs();
    let usual = median(edges.iter().map(misfit))?;
    solved(edges.iter().filter(|edge| misfit(edge) <= 4.5 * usual + 1e-9).map(|edge| (row(edge.normal), value(edge))))
}

fn solved(rows: impl Iterator<Item = (Vector3<f64>, f64)>) -> Option<Spread> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (row, value) in rows {
        normal += row * row.transpose();
        right += row * value;
    }
    // Edges of two directions tell two variances: of the ellipses that have both, that nearest to a circle is taken.
    let weight = 1e-4 * normal.trace();
    for round in [Vector3::new(1.0, 0.0, -1.0), Vector3::new(0.0, 2.0, 0.0)] {
        normal += weight * round * round.transpose();
    }
    Some(normal.cholesky()?.solve(&right).into())
}

/// What the corners' share still misses: misfits against the radius, each view about its own mean.
fn more(views: &[&[EdgeFit]], found: &[Option<Spread>], size: [f64; 2], corner: f64) -> f64 {
    let (mut together, mut own) = (0.0, 0.0);
    for (edges, spread) in views.iter().zip(found) {
        let Some(spread) = spread else { continue };
        let misfits: Vec<[f64; 2]> = edges
            .iter()
            .map(|edge| [radius(edge, size), edge.spread.powi(2) - corner * radius(edge, size) - across(spread, edge.normal)])
            .collect();
        let bound = 4.5 * median(misfits.iter().map(|misfit| misfit[1].abs())).unwrap_or(0.0);
        let good: Vec<&[f64; 2]> = misfits.iter().filter(|misfit| misfit[1].abs() <= bound).collect();
        let mean = good.iter().map(|misfit| misfit[0]).sum::<f64>() / good.len().max(1) as f64;
        together += good.iter().map(|misfit| (misfit[0] - mean) * misfit[1]).sum::<f64>();
        own += good.iter().map(|misfit| (misfit[0] - mean).powi(2)).sum::<f64>();
    }
    if own > 1e-6 { together / own } else { 0.0 }
}
