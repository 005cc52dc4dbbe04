//! How well a camera is known over its frame.

use calibench_adjust::{Distance, frame_weight, image_information};
use calibench_model::camera::{CameraModel, ImageSize};
use nalgebra::{DMatrix, DVector, Point3, SymmetricEigen};

use crate::Calibration;

/// Columns and rows of the grid over the frame.
pub(crate) const GRID: (usize, usize) = (31, 21);
/// A camera that is known less well is in doubt: this share of the longer side of its frame,
const SHARE: f64 = 0.01;
/// or so many pixels, whichever is less.
const MOST_PX: f64 = 5.0;

/// The uncertainty of a camera: the standard deviation (2D, px) of the image of a point far away, root mean square over the whole frame, whether points were
/// measured there or not, after the rotation that makes up for most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverFrame {
    /// As the covariance of the adjustment has it, px.
    pub formal_px: f64,
    /// As leaving images out has it, px; `None` where that could not be done.
    pub by_images_px: Option<f64>,
    /// Beyond which the camera is in doubt, px.
    pub limit_px: f64,
}

impl OverFrame {
    /// Of a camera of a calibration; `None` where its interior orientation is not adjusted.
    pub(crate) fn of(calibration: &Calibration<'_>, camera: usize) -> Option<Self> {
        let (names, covariance) = calibration.covariances.of_camera(camera);
        if names.is_empty() {
            return None;
        }
        // Without rays nothing is known.
        let weight = frame_weight(calibration.camera(camera), &names, GRID, Distance::Far).ok();
        let root = |square: Option<f64>| square.filter(|square| !square.is_nan()).map_or(f64::INFINITY, |square| square.max(0.0).sqrt());
        let by_images = || Some(calibration.scatter(camera, &names)?.component_mul(weight.as_ref()?).sum().max(0.0).sqrt());
        Some(Self {
            formal_px: root(weight.as_ref().map(|weight| weight.component_mul(&covariance).sum())),
            by_images_px: by_images(),
            limit_px: calibration.limit_px(camera),
        })
    }

    /// The larger of the two, px.
    pub fn px(&self) -> f64 {
        self.by_images_px.map_or(self.formal_px, |own| own.max(self.formal_px))
    }

    /// Whether the camera is known well enough.
    pub fn is_within(&self) -> bool {
        self.px() <= self.limit_px
    }
}

/// The limit for frames of this size where none is given, px.
pub fn usual_limit_px(size: ImageSize) -> f64 {
    (SHARE * f64::from(size.width.max(size.height))).min(MOST_PX)
}

impl Calibration<'_> {
    /// Beyond which a camera is in doubt, px.
    pub(crate) fn limit_px(&self, camera: usize) -> f64 {
        self.prepared.settings.limit_px.unwrap_or_else(|| usual_limit_px(self.camera(camera).size()))
    }

    /// The covariance of a camera's parameters `names` that the images show, each group of which may have errors that belong together. Changes by leaving a group
    /// out count as much as makes the estimate free of bias where errors are independent, however few groups there are; the jackknife's is then too large.
    /// `None` where images were not left out.
    ///
    /// Source: the bias-reduced linearisation of Bell & McCaffrey 2002, from changes in place of residuals.
    fn scatter(&self, camera: usize, names: &[&str]) -> Option<DMatrix<f64>> {
        let found = self.resampled.as_ref()?.as_ref().ok()?;
        let shares = self.information(camera, names, found.groups);
        let own: Vec<f64> = {
            let all = self.camera(camera).parameters();
            names.iter().filter_map(|name| all.iter().find(|parameter| parameter.name == *name)).map(|parameter| parameter.value).collect()
        };
        let rows: Vec<usize> = (0..self.covariances.parameters.len()).filter(|&row| self.covariances.parameters[row].0 == camera).collect();
        let lower = shares.iter().sum::<DMatrix<f64>>().cholesky()?.l();
        let mut scatter = DMatrix::zeros(names.len(), names.len());
        for (share, without) in shares.iter().zip(&found.without) {
            let change = DVector::from_iterator(rows.len(), rows.iter().zip(&own).map(|(&row, own)| without[row] - own));
            let half = lower.solve_lower_triangular(share)?;
            let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(lower.solve_lower_triangular(&half.transpose())?);
            let mut along = eigenvectors.tr_mul(&lower.tr_mul(&change));
            along.iter_mut().zip(eigenvalues.iter()).for_each(|(along, value)| *along *= (1.0 - value).max(0.0).sqrt());
            let counted = lower.tr_solve_lower_triangular(&(eigenvectors * along))?;
            scatter.ger(1.0, &counted, &counted, 1.0);
        }
        Some(scatter)
    }

    /// What each of `groups` of images tells of a camera's parameters `names`.
    fn information(&self, camera: usize, names: &[&str], groups: usize) -> Vec<DMatrix<f64>> {
        let network = &self.prepared.network;
        let mut points: Vec<Vec<Point3<f64>>> = vec![Vec::new(); network.images.len()];
        network.observations.iter().for_each(|o| points[o.image].push(self.solution.points()[o.point]));
        let mut shares = vec![DMatrix::zeros(names.len(), names.len()); groups];
        for (image, points) in points.iter().enumerate().filter(|(image, _)| self.owner(*image) == camera) {
            // What does not determine its own pose tells nothing.
            let own = image_information(self.camera(camera), names, &self.solution.poses()[image], points, 1.0);
            own.into_iter().for_each(|own| shares[image % groups] += own);
        }
        shares
    }
}
