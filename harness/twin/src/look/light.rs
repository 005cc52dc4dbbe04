//! The light of a view: what paper and ink send.

use nalgebra::{Matrix4, Vector4};

use super::edge::EdgeFit;
use crate::tone::Tone;

/// Reflectance of the twin's paper.
pub const PAPER: f64 = 0.9;
/// Reflectance of the twin's ink.
pub const INK: f64 = 0.05;

/// Light = veil + exposure x reflectance x (1 + gradient . place), place as a share of the frame from its middle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Light {
    /// That of reflectance 1 in the middle of the frame, without the veil; in the linear part of the curve a fraction of full scale.
    pub exposure: f64,
    /// That of reflectance 0.
    pub veil: f64,
    /// Change of the light across the whole frame along x and y, as a share of that in its middle.
    pub gradient: [f64; 2],
}

impl Light {
    /// That of the edges of a view of `size`, px, under a curve; `None` where they do not tell.
    pub fn of(edges: &[EdgeFit], size: [f64; 2], tone: Tone) -> Option<Self> {
        let rows: Vec<(Vector4<f64>, f64)> = edges.iter().flat_map(|edge| rows(edge, size, tone)).collect();
        let first = solved(rows.iter())?;
        let misfit = |row: &&(Vector4<f64>, f64)| (row.1 - row.0.dot(&first)).abs();
        let usual = calibench_model::median(rows.iter().map(|row| misfit(&row)))?;
        let state = solved(rows.iter().filter(|row| misfit(row) <= 4.5 * usual))?;
        let [veil, exposure] = [state[0], state[1]];
        (exposure > 0.01).then(|| Self { exposure, veil, gradient: [state[2] / exposure, state[3] / exposure] })
    }
}

fn rows(edge: &EdgeFit, size: [f64; 2], tone: Tone) -> [(Vector4<f64>, f64); 2] {
    let row = |reflectance: f64, grey: f64| {
        let [x, y] = [edge.at[0] / size[0], edge.at[1] / size[1]];
        (Vector4::new(1.0, reflectance, reflectance * x, reflectance * y), tone.light(grey))
    };
    [row(INK, edge.levels[0]), row(PAPER, edge.levels[1])]
}

fn solved<'r>(rows: impl Iterator<Item = &'r (Vector4<f64>, f64)>) -> Option<Vector4<f64>> {
    let (mut normal, mut right, mut count) = (Matrix4::zeros(), Vector4::zeros(), 0);
    for (row, grey) in rows {
        normal += row * row.transpose();
        right += row * *grey;
        count += 1;
    }
    (count >= 12).then(|| normal.cholesky().map(|factor| factor.solve(&right))).flatten()
}
