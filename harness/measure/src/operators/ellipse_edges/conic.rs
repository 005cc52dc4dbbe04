//! The ellipse through points of an edge.

use nalgebra::{SMatrix, SVector};

use super::sectors::{Common, EdgePoint};
use crate::marquardt::Normal;

/// Centre, three of the shape, variance of the blur, grey value outside, contrast.
pub(super) const UNKNOWNS: usize = 8;

/// The normal equations of the ellipse of least weighted squared distances from edge points across the edge, together with what the points have in common.
///
/// The points are given by their offsets along the normals of an ellipse near the one sought.
pub(super) fn normal(points: &[EdgePoint], common: &Common) -> Normal<UNKNOWNS> {
    let (mut n, mut b) = (SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros(), SVector::<f64, UNKNOWNS>::zeros());
    n.fixed_view_mut::<3, 3>(5, 5).copy_from(&common.n);
    b.fixed_rows_mut::<3>(5).copy_from(&common.b);
    for point in points {
        add(&mut n, &mut b, point);
    }
    for row in 5..UNKNOWNS {
        for column in 0..5 {
            n[(row, column)] = n[(column, row)];
        }
    }
    Normal { n, b, omega: common.omega }
}

fn add(n: &mut SMatrix<f64, UNKNOWNS, UNKNOWNS>, b: &mut SVector<f64, UNKNOWNS>, point: &EdgePoint) {
    let (j, common) = (&point.moves, &point.common);
    for row in 0..5 {
        let weighted = point.weight * j[row];
        b[row] += weighted * point.offset;
        for column in 0..5 {
            n[(row, column)] += weighted * j[column];
        }
        for column in 0..3 {
            n[(row, 5 + column)] += weighted * common[column];
        }
    }
}
