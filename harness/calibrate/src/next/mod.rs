//! What to photograph next: the photographs that lower the uncertainty of a camera most.

mod candidates;
mod field;

use calibench_adjust::{Distance, Variance, frame_weight, image_information};
use calibench_model::{PixelPoint, Pose, upper_median};
use nalgebra::{DMatrix, Point3};
use rayon::prelude::*;

use crate::Calibration;
use crate::over_frame::GRID;
use candidates::{Candidate, candidates};
use field::Field;

/// Photographs that are proposed, each given the ones before.
const PROPOSED: usize = 3;

/// What further photographs would do to the uncertainty of a camera: its root mean square over the frame (2D, px), of points far away, after the rotation that
/// makes up for most.
#[derive(Clone, Debug, PartialEq)]
pub struct Next {
    /// Of the calibration as it is.
    pub before: f64,
    /// With one photograph more like those that there are: the median over them, each taken twice.
    pub usual: f64,
    /// The photographs that lower it most, the best first, each given the ones before.
    pub photographs: Vec<Photograph>,
    /// Whether all of the control must be in view, as it was in the photographs so far.
    pub whole: bool,
}

/// A photograph that was not taken yet.
#[derive(Clone, Debug, PartialEq)]
pub struct Photograph {
    /// Where the camera would stand.
    pub pose: Pose,
    /// Where the middle of the control is in the frame, px.
    pub middle: PixelPoint,
    /// Distance of that middle along the camera's axis, object units.
    pub depth: f64,
    /// Of the control's plane to the image plane, radians.
    pub tilt: f64,
    /// In which direction of the image, radians from its right to its top, the control comes nearer; `None` without a tilt.
    pub nearer: Option<f64>,
    /// The direction of the control's u axis (of a board: along its rows) in the image, radians from its right to its top.
    pub along: f64,
    /// Images of the control points in view, px.
    pub points: Vec<PixelPoint>,
    /// The uncertainty with it and the ones before, px.
    pub uncertainty: f64,
}

impl Calibration<'_> {
    /// Where in the frame, how tilted and from how far to photograph the control next.
    ///
    /// Out of several thousand photographs: the middle of the control all over the frame, tilts up to those that were taken (45 degrees at least), distances that
    /// were taken. It supposes that points are measured as precisely as they were so far, that a board keeps the shape that it has, and that the model is right: where
    /// the calibration is in doubt, that comes first.
    ///
    /// # Errors
    /// In words: an interior orientation that is fixed, control that is unknown.
    ///
    /// Source: the criterion is after the projection uncertainty of mrcal (Kogan 2022), its use for the next view after Peng and Sturm 2019.
    pub fn next(&self, camera: usize) -> Result<Next, String> {
        let (names, covariance) = self.covariances.of_camera(camera);
        if names.is_empty() {
            return Err("the interior orientation is not adjusted".into());
        }
        let field = Field::of(self, camera)?;
        let uncertain = Uncertain::of(self, (camera, &names), covariance)?;
        let sigma = self.sigma_of(camera);
        let information = |pose: &Pose, points: &[Point3<f64>]| image_information(self.camera(camera), &names, pose, points, sigma);
        let taken = self.taken(camera).filter_map(|(pose, points)| Some(uncertain.with(&information(&pose, &points)?)));
        let usual = upper_median(taken).ok_or("no photograph determines its pose")?;
        let all: Vec<(Candidate, DMatrix<f64>)> = candidates(self.camera(camera), &field)
            .into_par_iter()
            .filter_map(|candidate| {
                let (seen, _) = candidate.shown(self.camera(camera), &field, &field.sparse)?;
                let found = information(&candidate.pose, &seen)? * field.share();
                Some((candidate, found))
            })
            .collect();
        let mut sum = DMatrix::zeros(names.len(), names.len());
        let mut photographs: Vec<Photograph> = Vec::new();
        for _ in 0..PROPOSED {
            let mut ranked: Vec<(f64, &Candidate)> = all.par_iter().map(|(one, own)| (uncertain.with(&(&sum + own)), one)).collect();
            ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
            let whole = |&(_, one): &(f64, &'_ Candidate)| {
                let (seen, points) = one.shown(self.camera(camera), &field, &field.points)?;
                Some((information(&one.pose, &seen)?, one.photograph(&field, points, f64::NAN)))
            };
            let (own, best) = ranked.iter().find_map(whole).ok_or("no photograph has enough control points in view")?;
            sum += own;
            photographs.push(Photograph { uncertainty: uncertain.with(&sum), ..best });
        }
        Ok(Next { before: uncertain.with(&DMatrix::zeros(names.len(), names.len())), usual, photographs, whole: field.whole })
    }

    /// Standard deviation of an image coordinate of a camera as the residuals have it, px.
    fn sigma_of(&self, camera: usize) -> f64 {
        let own = self.prepared.network.observations.iter().filter(|o| self.owner(o.image) == camera);
        let variance = |o: &calibench_adjust::ImageObservation| match o.precision {
            calibench_adjust::Precision::Sigma(sigma) => sigma * sigma,
            calibench_adjust::Precision::Covariance(c) => (c.sxx + c.syy) / 2.0,
        };
        // The mean of weights, not of variances: what is imprecise tells little.
        let (weights, count) = own.fold((0.0, 0_usize), |(sum, count), o| (sum + 1.0 / variance(o), count + 1));
        let factor = self.solution.variance_factor(Variance::Estimated).unwrap_or(1.0);
        (factor * count.max(1) as f64 / weights).sqrt()
    }

    /// The photographs of a camera so far: pose and known points.
    fn taken(&self, camera: usize) -> impl Iterator<Item = (Pose, Vec<Point3<f64>>)> + '_ {
        let network = &self.prepared.network;
        let mut points = vec![Vec::new(); network.images.len()];
        for o in network.observations.iter().filter(|o| field::is_known(&network.points[o.point])) {
            points[o.image].push(self.solution.points()[o.point]);
        }
        let images = points.into_iter().enumerate().filter(move |(image, _)| self.owner(*image) == camera);
        images.map(|(image, points)| (self.solution.poses()[image], points))
    }
}

/// A covariance of interior parameters, and what it means over the frame.
struct Uncertain {
    /// Lower Cholesky factor of the covariance.
    factor: DMatrix<f64>,
    /// The weight of the frame between two of them.
    weight: DMatrix<f64>,
}

impl Uncertain {
    fn of(calibration: &Calibration<'_>, (camera, names): (usize, &[&str]), covariance: DMatrix<f64>) -> Result<Self, String> {
        let weight = frame_weight(calibration.camera(camera), names, GRID, Distance::Far).map_err(|error| error.to_string())?;
        let factor = covariance.cholesky().ok_or("the covariance of the interior orientation is not regular")?.unpack();
        Ok(Self { weight: factor.tr_mul(&weight) * &factor, factor })
    }

    /// The root mean square over the frame with so much more information, px.
    fn with(&self, information: &DMatrix<f64>) -> f64 {
        let n = self.factor.nrows();
        let more = self.factor.tr_mul(information) * &self.factor + DMatrix::identity(n, n);
        more.cholesky().map_or(f64::INFINITY, |more| more.solve(&self.weight).trace().max(0.0).sqrt())
    }
}
