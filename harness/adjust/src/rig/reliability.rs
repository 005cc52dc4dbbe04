//! Tests of the image points of a rig.

use nalgebra::{DMatrix, Matrix2};

use super::frames::adjoint;
use super::solution::RigSolution;
use crate::AdjustError;
use crate::normal::{Rows, Scratch};
use crate::quality::{Reliability, Test, critical, image_point};

impl RigSolution<'_> {
    /// Redundancy numbers, normalised residuals and minimal detectable biases of all image points in use.
    ///
    /// # Errors
    /// [`AdjustError::NotAvailable`] for a test that is none, or if the variance is to be estimated without redundancy.
    ///
    /// Source: Baarda 1968.
    pub fn reliability(&self, test: Test) -> Result<Reliability, AdjustError> {
        let (critical, noncentrality) = critical(test)?;
        let sigma0 = self.variance(test.variance)?.sqrt();
        let (network, layout, state) = (&self.rig().network, &self.frame.layout, self.frame.whole(&self.state));
        let (mut rows, mut scratch, mut points) = (Rows::default(), Scratch::default(), Vec::with_capacity(layout.sights.len()));
        for (image, range) in layout.of_image.iter().enumerate().filter(|(_, range)| !range.is_empty()) {
            let filled = rows.fill((network, layout), &state, self.frame.loss, (image, &[]), range.clone(), &mut scratch);
            filled.map_err(|_| AdjustError::NotAvailable("the result does not picture its points"))?;
            let own = self.of_image(image);
            for sight in range.clone() {
                let row = &rows.of(sight)[..own.nrows()];
                let by = DMatrix::from_fn(2, row.len(), |i, j| row[j][i]);
                let adjusted = &by * &own * by.transpose();
                let adjusted = Matrix2::new(adjusted[(0, 0)], adjusted[(0, 1)], adjusted[(1, 0)], adjusted[(1, 1)]);
                let at = &layout.sights[sight];
                let precision = at.observed(&network.observations).precision;
                let residual = &self.normals.residuals[sight];
                points.push(image_point(at.given as usize, (precision, residual), adjusted, [sigma0, noncentrality]));
            }
        }
        points.sort_unstable_by_key(|point| point.observation);
        Ok(Reliability { test, critical, noncentrality, points, observed: Vec::new() })
    }

    /// Cofactors of the parameters of an image's camera and of its pose, a small rotation about the camera's axes and a shift along them.
    pub(super) fn of_image(&self, image: usize) -> DMatrix<f64> {
        let (frame, station) = (&self.frame, self.rig().station_of[image]);
        let camera = frame.layout.camera_of[image];
        let (columns, width) = (frame.columns(image), frame.layout.cameras[camera].free.len());
        let (own, cross) = &self.cofactors.stations[station];
        let (kept, adjoint) = (columns.len(), adjoint(&self.state.mounts[camera]));
        // Interior, mount, station.
        let all = DMatrix::from_fn(kept + 6, kept + 6, |i, j| match (i < kept, j < kept) {
            (true, true) => self.cofactors.kept[(columns[i], columns[j])],
            (false, true) => cross[(i - kept, columns[j])],
            (true, false) => cross[(j - kept, columns[i])],
            (false, false) => own[(i - kept, j - kept)],
        });
        // The pose moves with the mount, and through the adjoint with the station.
        let by = DMatrix::from_fn(width + 6, kept + 6, |i, j| match (i < width, j) {
            (true, j) => f64::from(u8::from(i == j)),
            (false, j) if j >= kept => adjoint[(i - width, j - kept)],
            (false, j) => f64::from(u8::from(j >= width && i == j)),
        });
        &by * all * by.transpose()
    }
}
