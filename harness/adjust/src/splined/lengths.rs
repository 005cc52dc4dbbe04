//! How long the residuals of splines are, by their own covariances.

use nalgebra::{DMatrix, DMatrixView, Matrix2, Vector2};

use super::equations::{Frame, SightRow, SplinedNormals, SplinedState};
use super::reduced::Inverse;
use crate::quality::length;
use crate::solve::forward;

/// Of each sight, in the order of the layout: the length of its residual by its own covariance, in a-priori standard deviations of two normal numbers; `None` where nothing checks it.
///
/// Where few image points hold the splines these follow an image point that is wrong: its residual is small, and so is its standard deviation.
pub(super) fn lengths(frame: &Frame<'_>, state: &SplinedState, inverse: &Inverse, normals: &SplinedNormals) -> Vec<Option<f64>> {
    let mut found = vec![None; frame.layout.sights.len()];
    let n = frame.free.len();
    let precision = |sight: usize| frame.layout.sights[sight].observed(&frame.of.network.observations).precision;
    let cofactors = DMatrixView::from_slice(&inverse.cofactors, n, n);
    for (index, (image, range)) in normals.images.iter().zip(&frame.layout.of_image).enumerate() {
        let l = &inverse.solved.factors[index];
        let y = image.solved(l);
        let own = cofactors.select_columns(&image.columns).select_rows(&image.columns);
        let m = image.columns.len();
        // Of each image coordinate, white: its derivatives by what is kept as the pose follows, and what the pose adds for itself.
        let mut kept = DMatrix::<f64>::zeros(m, 2 * range.len());
        let mut poses = vec![[[0.0; 6]; 2]; range.len()];
        for (k, sight) in range.clone().enumerate() {
            let Ok(row) = SightRow::of(frame, state, (index, sight)) else { return found };
            let white = |by: [f64; 2]| precision(sight).whitened(by);
            for (axis, into) in poses[k].iter_mut().enumerate() {
                let mut pose = row.pose.map(|by| white(by)[axis]);
                forward(l, &mut pose);
                let mut column = kept.column_mut(2 * k + axis);
                for (place, value) in column.iter_mut().enumerate() {
                    *value = -(0..6).map(|d| y[d * m + place] * pose[d]).sum::<f64>();
                }
                for (of, by) in row.kept() {
                    if let Ok(place) = image.columns.binary_search(&of) {
                        column[place] += white(by)[axis];
                    }
                }
                *into = pose;
            }
        }
        let spread = &own * &kept;
        for (k, sight) in range.clone().enumerate() {
            let dot = |i: usize, j: usize| kept.column(2 * k + i).dot(&spread.column(2 * k + j));
            let pose = |i: usize, j: usize| (0..6).map(|d| poses[k][i][d] * poses[k][j][d]).sum::<f64>();
            let rest = Matrix2::from_fn(|i, j| f64::from(u8::from(i == j)) - dot(i, j) - pose(i, j));
            found[sight] = length(&rest, Vector2::from(precision(sight).whitened(normals.residuals[sight].px)));
        }
    }
    found
}
