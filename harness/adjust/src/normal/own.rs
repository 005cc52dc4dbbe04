//! What is left of the numbers of each image's own.

use nalgebra::{DMatrix, DVector};

use super::projection::POSE;

/// What is left of the numbers of an image's own once they are eliminated: how they follow from the rest.
#[derive(Clone, Debug, Default)]
pub(crate) struct Own {
    /// Their changes by those of the parameters: shares along each unknown parameter of the camera, n x p.
    pub(super) along: DMatrix<f64>,
    /// Their cofactors where all else is known, p x p.
    pub(crate) cofactors: DMatrix<f64>,
    /// By how much they fall with pose, parameters of the camera and surface: p x (6 + n + 3).
    pub(crate) follow: DMatrix<f64>,
    /// Their step where all else stays.
    pub(super) alone: DVector<f64>,
}

impl Own {
    pub(crate) fn is_none(&self) -> bool {
        self.alone.is_empty()
    }

    /// White derivatives of a sight by the image's own numbers, from those by the unknown parameters of its camera.
    pub(super) fn columns(&self, by_parameters: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let along = |own: usize, axis: usize| by_parameters.iter().enumerate().map(|(i, by)| self.along[(i, own)] * by[axis]).sum();
        (0..self.along.ncols()).map(|own| [along(own, 0), along(own, 1)]).collect()
    }

    /// What makes a number of pose, parameters and surface, as the row of a sight on the surface whose x it is.
    pub(crate) fn row(&self, own: usize) -> Vec<[f64; 2]> {
        let width = self.along.nrows();
        let columns = (POSE..POSE + width).chain(0..POSE).chain(POSE + width..self.follow.ncols());
        let mut row: Vec<[f64; 2]> = columns.map(|column| [self.follow[(own, column)], 0.0]).collect();
        row.resize(POSE + width + 3, [0.0; 2]);
        row
    }

    /// Takes off a sight's derivatives by n parameters, its pose and, if that moves it, the surface, what goes with the image's own numbers.
    pub(super) fn take_off(&self, by_own: &[[f64; 2]], (width, on_surface): (usize, bool), row: &mut [[f64; 2]]) {
        let (of_pose, of_surface) = (POSE + width, if on_surface { self.follow.ncols() } else { POSE + width });
        let columns = (POSE..of_pose).chain(0..POSE).chain(of_pose..of_surface);
        for (value, column) in row.iter_mut().zip(columns) {
            for (own, by) in by_own.iter().enumerate() {
                (0..2).for_each(|axis| value[axis] -= by[axis] * self.follow[(own, column)]);
            }
        }
    }
}
