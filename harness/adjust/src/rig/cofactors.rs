//! Cofactors of a rig's unknowns.

use nalgebra::{DMatrix, Matrix6};

use super::equations::RigNormals;

/// Cofactors of all unknowns, as far as they are kept.
#[derive(Clone, Debug)]
pub(super) struct Cofactors {
    /// Of interiors and mounts.
    pub(super) kept: DMatrix<f64>,
    /// Of each station: its own, and 6 x kept with the others.
    pub(super) stations: Vec<(Matrix6<f64>, DMatrix<f64>)>,
}

impl Cofactors {
    /// Of the normal equations; `None` if they are singular.
    pub(super) fn of(normals: &RigNormals) -> Option<Self> {
        let (reduced, scale) = (normals.reduced(0.0)?, normals.scale());
        let mut kept = reduced.factor(&scale)?.inverse();
        let size = kept.nrows();
        (0..size * size).for_each(|k| kept[(k / size, k % size)] /= scale[k / size] * scale[k % size]);
        let mut stations = Vec::with_capacity(normals.stations.len());
        for (station, factor) in normals.stations.iter().zip(&reduced.factors) {
            let Some(factor) = factor else {
                stations.push((Matrix6::zeros(), DMatrix::zeros(6, size)));
                continue;
            };
            let follow = factor.solve(&station.coupling);
            let rows = DMatrix::from_fn(station.columns.len(), size, |i, j| kept[(station.columns[i], j)]);
            let cross = -(&follow * rows);
            let own_columns = DMatrix::from_fn(6, station.columns.len(), |i, j| cross[(i, station.columns[j])]);
            let own = factor.inverse() - own_columns * follow.transpose();
            stations.push((own, DMatrix::from_column_slice(6, size, cross.as_slice())));
        }
        Some(Self { kept, stations })
    }
}
