//! Redundancy numbers, tests of single observations, and the smallest errors that these would find.

use calibench_model::camera::CameraModel;
use nalgebra::{Matrix2, Matrix3, Vector2};
use statrs::distribution::{ContinuousCDF, Normal};

use crate::AdjustError;
use crate::network::{Attitude, Centre, Precision, Sight, Status};
use crate::normal::{Lost, Residual, Rows, Scratch, Stretch};
use crate::solution::Solution;
use crate::solve::{Coupling, Eliminated, Engine, Inverse, Member};
use crate::state::{rotation_vector, rotation_vector_slope};

use super::covariance::{Covariances, Variance};
use super::residual_length::length;

/// A test of single observations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Test {
    /// Probability (0 to 1) of rejecting a good observation.
    pub alpha: f64,
    /// Probability (0 to 1) of rejecting one that is wrong by its minimal detectable bias.
    pub power: f64,
    /// Whose variance factor counts: Baarda's test takes the a-priori one.
    pub variance: Variance,
}

impl Default for Test {
    fn default() -> Self {
        Self { alpha: 0.001, power: 0.8, variance: Variance::Apriori }
    }
}

/// How well an image point is checked by the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointReliability {
    /// Its index among the observations given.
    pub observation: usize,
    /// Redundancy numbers of x and y, from 0 (not checked) to 1: diagonal of `Q_vv P`.
    pub redundancy: [f64; 2],
    /// Normalised residuals of x and y, numbers: normal with variance 1 if nothing is wrong; zero where nothing checks.
    pub w: [f64; 2],
    /// Minimal detectable biases of x and y, px; infinite where nothing checks.
    pub detectable: [f64; 2],
    /// Length of the residual by its own covariance, a number: as that of two normal numbers if nothing is wrong. Where one direction alone is checked (a
    /// point in two images has the other one to itself), the length that is as rare. `None` where nothing checks.
    pub length: Option<f64>,
}

/// The same of an observed parameter, coordinate or orientation.
#[derive(Clone, Debug, PartialEq)]
pub struct ObservedReliability {
    /// Its name, as in "X of point 12".
    pub what: String,
    /// Adjusted less observed, in its unit.
    pub v: f64,
    /// Redundancy number, from 0 (not checked) to 1.
    pub redundancy: f64,
    /// Normalised residual, a number.
    pub w: f64,
    /// Minimal detectable bias, in its unit.
    pub detectable: f64,
}

/// Reliability of all observations in use.
#[derive(Clone, Debug, PartialEq)]
pub struct Reliability {
    /// The test that it was computed for.
    pub test: Test,
    /// Normalised residuals beyond it, in absolute value, are rejected: a number.
    pub critical: f64,
    /// Shift of the test's distribution that it detects with the power asked for, in standard deviations.
    pub noncentrality: f64,
    /// Image points, in the order given.
    pub points: Vec<PointReliability>,
    /// Observed parameters, centres, rotations and coordinates.
    pub observed: Vec<ObservedReliability>,
}

impl Reliability {
    /// Sum of all redundancy numbers: the redundancy of the network.
    pub fn redundancy(&self) -> f64 {
        let points: f64 = self.points.iter().map(|point| point.redundancy[0] + point.redundancy[1]).sum();
        points + self.observed.iter().map(|observed| observed.redundancy).sum::<f64>()
    }
}

/// Image points whose equations are in memory at a time.
const CHUNK: usize = 1 << 12;

/// A redundancy number below which an observation is not checked at all.
const UNCHECKED: f64 = 1e-9;

impl Solution<'_> {
    /// Redundancy numbers, normalised residuals and minimal detectable biases of all observations in use.
    ///
    /// # Errors
    /// [`AdjustError::NotAvailable`] for a test that is none, or if the variance is to be estimated without redundancy.
    ///
    /// Source: Baarda 1968.
    pub fn reliability(&self, test: Test) -> Result<Reliability, AdjustError> {
        let (mut found, scale) = self.untested(test)?;
        let inverse = self.engine.inverse(&self.solved);
        let of_members = self.image_points(&inverse, scale, &mut found.points)?;
        if self.counts().observed > 0 {
            found.observed = self.observed(&inverse, &self.cofactors(&inverse, &of_members)?, scale);
        }
        Ok(found)
    }

    /// [`Self::covariances`] and [`Self::reliability`] from one inverse.
    ///
    /// # Errors
    /// As these.
    pub fn quality(&self, variance: Variance, test: Test) -> Result<(Covariances, Reliability), AdjustError> {
        let (variance_factor, (mut found, scale)) = (self.variance_factor(variance)?, self.untested(test)?);
        let inverse = self.engine.inverse(&self.solved);
        let of_members = self.image_points(&inverse, scale, &mut found.points)?;
        let cofactors = self.cofactors(&inverse, &of_members)?;
        found.observed = self.observed(&inverse, &cofactors, scale);
        Ok((cofactors.scaled(variance_factor), found))
    }

    /// The test, of nothing as yet, and the scales of normalised residuals and detectable biases.
    fn untested(&self, test: Test) -> Result<(Reliability, [f64; 2]), AdjustError> {
        let (critical, sigma0) = self.bound(test)?;
        let noncentrality = critical + Normal::standard().inverse_cdf(test.power);
        let found = Reliability { test, critical, noncentrality, points: Vec::new(), observed: Vec::new() };
        Ok((found, [sigma0, noncentrality]))
    }

    /// Beyond which normalised residuals are rejected, and by which standard deviation of unit weight they are normalised.
    pub(super) fn bound(&self, test: Test) -> Result<(f64, f64), AdjustError> {
        let (critical, _) = critical(test)?;
        Ok((critical, self.residual_variance(test.variance)?.sqrt()))
    }

    /// Tests all image points, in the order given; returns the cofactors of what was eliminated, as they are needed on the way.
    fn image_points(&self, inverse: &Inverse, scale: [f64; 2], found: &mut Vec<PointReliability>) -> Result<Vec<f64>, AdjustError> {
        found.reserve_exact(self.engine.layout.sights.len());
        let all = match self.engine.plan.eliminated {
            Eliminated::Points => self.point_by_point(inverse, scale, found),
            Eliminated::Poses => self.image_by_image(inverse, scale, found),
        };
        found.sort_unstable_by_key(|point| point.observation);
        all.map_err(|_| AdjustError::NotAvailable("the result does not picture its points"))
    }

    fn image_by_image(&self, inverse: &Inverse, scale: [f64; 2], found: &mut Vec<PointReliability>) -> Result<Vec<f64>, Lost> {
        let Engine { network, layout, plan, loss, .. } = &self.engine;
        let (state, own) = (&self.end.state, &self.end.normals.own);
        let (ordered, mut coupling) = (self.engine.ordered(&self.end.state, &self.end.normals), Coupling::default());
        let (mut rows, mut scratch, mut of_members) = (Rows::default(), Scratch::default(), Vec::with_capacity(36 * plan.members.len()));
        for (image, range) in layout.of_image.iter().enumerate() {
            let place = plan.members.binary_search(&image).ok();
            let member = place.map(|place| inverse.member::<6>(&self.solved, ordered, place, &mut coupling));
            of_members.extend(member.iter().flat_map(|member| member.own.as_flattened()));
            for start in range.clone().step_by(CHUNK) {
                let chunk = start..(start + CHUNK).min(range.end);
                rows.fill((*network, layout), state, *loss, (image, own), chunk.clone(), &mut scratch)?;
                for sight in chunk {
                    let adjusted = self.adjusted(inverse, sight, rows.of(sight), member.as_ref()) + rows.beside(sight);
                    found.push(self.image_point(sight, adjusted, scale));
                }
            }
        }
        Ok(of_members)
    }

    /// Some points at a time, with all their sights: those of an image are in the order of their points.
    fn point_by_point(&self, inverse: &Inverse, scale: [f64; 2], found: &mut Vec<PointReliability>) -> Result<Vec<f64>, Lost> {
        let Engine { network, layout, plan, loss, .. } = &self.engine;
        let (state, own) = (&self.end.state, &self.end.normals.own);
        let (ordered, mut coupling) = (self.engine.ordered(&self.end.state, &self.end.normals), Coupling::default());
        let (count, mut next) = (layout.triple_free.len(), layout.of_image.iter().map(|range| range.start).collect::<Vec<_>>());
        let mut rows: Vec<Rows> = (0..layout.of_image.len()).map(|_| Rows::default()).collect();
        let (mut first, mut scratch, mut of_members) = (0, Scratch::default(), Vec::with_capacity(9 * plan.members.len()));
        while first < count {
            let (mut end, mut sights) = (first, 0);
            while end < count && (end == first || sights < CHUNK) {
                sights += layout.of_triple(end).len();
                end += 1;
            }
            for (image, range) in layout.of_image.iter().enumerate() {
                let start = next[image];
                next[image] += layout.sights[start..range.end].iter().take_while(|sight| sight.point() < end).count();
                if start < next[image] {
                    rows[image].fill((*network, layout), state, *loss, (image, own), start..next[image], &mut scratch)?;
                }
            }
            for point in first..end {
                let place = plan.members.binary_search(&point).ok();
                let member = place.map(|place| inverse.member::<3>(&self.solved, ordered, place, &mut coupling));
                of_members.extend(member.iter().flat_map(|member| member.own.as_flattened()));
                for sight in layout.of_triple(point) {
                    let rows = &rows[layout.sights[sight].image()];
                    let adjusted = self.adjusted(inverse, sight, rows.of(sight), member.as_ref()) + rows.beside(sight);
                    found.push(self.image_point(sight, adjusted, scale));
                }
            }
            first = end;
        }
        Ok(of_members)
    }

    /// `A Q A^T` of an image point, white.
    pub(super) fn adjusted<const D: usize>(
        &self,
        inverse: &Inverse,
        index: usize,
        row: &[[f64; 2]],
        member: Option<&Member<D>>,
    ) -> Matrix2<f64> {
        let (plan, layout, sight) = (&self.engine.plan, &self.engine.layout, &self.engine.layout.sights[index]);
        let camera = layout.camera_of[sight.image()];
        let width = layout.cameras[camera].free.len();
        let (of_pose, of_point) = (&row[width..width + 6], &row[width + 6..]);
        let own = if plan.eliminated == Eliminated::Points { of_point } else { of_pose };
        let point = layout.triples.of_point(sight.point());
        let parts: Vec<(usize, &[[f64; 2]])> =
            [(camera, &row[..width]), (plan.pose_block[sight.image()], of_pose), (plan.point_block[point], of_point)]
                .into_iter()
                .filter(|(block, part)| *block != usize::MAX && !part.is_empty())
                .collect();
        let mut sum = Matrix2::zeros();
        for (i, &(a, left)) in parts.iter().enumerate() {
            sum += inverse.between(plan, (a, left), (a, left));
            for &right in &parts[..i] {
                let cross = inverse.between(plan, (a, left), right);
                sum += cross + cross.transpose();
            }
        }
        let Some(member) = member else { return sum };
        let column = |by: [f64; 2]| Vector2::from(by);
        for d in 0..D {
            (0..D).for_each(|e| sum += column(own[d]) * column(own[e]).transpose() * member.own[d][e]);
        }
        let mut first = 0;
        for coupled in &member.coupled {
            if let Some((_, part)) = parts.iter().find(|(block, _)| *block == coupled.block) {
                for (d, own) in own.iter().enumerate() {
                    let by = member.cross(d, first, coupled.width).iter().zip(*part).map(|(q, by)| column(*by) * *q).sum::<Vector2<f64>>();
                    let cross = column(*own) * by.transpose();
                    sum += cross + cross.transpose();
                }
            }
            first += coupled.width;
        }
        sum
    }

    fn image_point(&self, index: usize, adjusted: Matrix2<f64>, scale: [f64; 2]) -> PointReliability {
        let (sight, residual): (&Sight, _) = (&self.engine.layout.sights[index], &self.end.normals.residuals[index]);
        let precision = sight.observed(&self.engine.network.observations).precision;
        image_point(sight.given as usize, (precision, residual), adjusted, scale)
    }

    fn observed(&self, inverse: &Inverse, cofactors: &Covariances, scale: [f64; 2]) -> Vec<ObservedReliability> {
        let (network, state) = (self.engine.network, &self.end.state);
        let mut found = Vec::new();
        let mut add = |what: String, v: f64, sigma: f64, cofactor: f64| found.push(observed(what, v, sigma, cofactor, scale));
        for (k, (camera, name)) in cofactors.parameters.iter().enumerate() {
            let parameters = state.cameras[*camera].parameters();
            let place = parameters.iter().position(|parameter| parameter.name == *name).unwrap_or_default();
            if let Status::Observed { value, sigma } = network.cameras[*camera].parameters[place] {
                let what = format!("{name} of {}", network.cameras[*camera].name);
                add(what, parameters[place].value - value, sigma, cofactors.interior[(k, k)]);
            }
        }
        for (i, image) in network.images.iter().enumerate() {
            let (pose, q) = (&state.poses[i], &cofactors.poses[i]);
            if let Centre::Observed { value, sigma } = image.centre {
                for k in 0..3 {
                    add(format!("{} of image {}", ["X0", "Y0", "Z0"][k], image.name), pose.centre[k] - value[k], sigma[k], q[(k, k)]);
                }
            }
            if let Attitude::Observed { value, sigma } = image.attitude {
                let off = rotation_vector(&(pose.rotation * value.transpose()));
                let slope = rotation_vector_slope(&off);
                let turned: Matrix3<f64> = slope * q.fixed_view::<3, 3>(3, 3) * slope.transpose();
                for k in 0..3 {
                    add(format!("rotation about {} of image {}", ["x", "y", "z"][k], image.name), off[k], sigma[k], turned[(k, k)]);
                }
            }
        }
        for (i, point) in network.points.iter().enumerate() {
            for (k, status) in point.coordinates.iter().enumerate() {
                if let Status::Observed { value, sigma } = *status {
                    let what = format!("{} of point {}", ["X", "Y", "Z"][k], point.name);
                    add(what, state.points[i][k] - value, sigma, cofactors.points[i][(k, k)]);
                }
            }
        }
        for (image, of, value, cofactor) in self.own_cofactors(inverse) {
            let own = &network.per_image[of];
            add(format!("{} of image {} as its own", own.name, network.images[image].name), value, own.sigma, cofactor);
        }
        for (i, (surface, values)) in network.surfaces.iter().zip(self.surfaces()).enumerate() {
            for (k, status) in surface.statuses.iter().enumerate() {
                if let Status::Observed { value, sigma } = *status {
                    let what = format!("coefficient {} of surface {}", k + 1, surface.name);
                    add(what, values[k] - value, sigma, cofactors.surfaces[i][(k, k)]);
                }
            }
        }
        for (index, distance) in network.distances.iter().enumerate() {
            let stretch = Stretch::of(&self.engine.layout, state, distance);
            add(
                network.name_of_distance(distance),
                stretch.length - distance.value,
                distance.sigma,
                self.of_distance(inverse, index, &stretch),
            );
        }
        found
    }
}

/// Beyond which normalised residuals are rejected, and the shift that is found with the power asked for.
pub(crate) fn critical(test: Test) -> Result<(f64, f64), AdjustError> {
    let possible = |p: f64| p > 0.0 && p < 1.0;
    if !(possible(test.alpha) && possible(test.power)) {
        return Err(AdjustError::NotAvailable("alpha and power of a test lie between 0 and 1"));
    }
    let critical = Normal::standard().inverse_cdf(1.0 - 0.5 * test.alpha);
    Ok((critical, critical + Normal::standard().inverse_cdf(test.power)))
}

/// The test of an image point, from `A Q A^T` of its white equations.
pub(crate) fn image_point(
    observation: usize,
    (precision, residual): (Precision, &Residual),
    adjusted: Matrix2<f64>,
    [sigma0, noncentrality]: [f64; 2],
) -> PointReliability {
    let [a, b, c] = precision.whitening().map(|w| w * residual.weight.sqrt());
    let white = Matrix2::new(a, 0.0, b, c);
    let rest = Matrix2::identity() - adjusted;
    // Q_vv P = W^-1 (1 - A Q A^T) W and P Q_vv P = W^T (1 - A Q A^T) W, with P = W^T W.
    let numbers = white.try_inverse().map_or_else(Matrix2::zeros, |inverse| inverse * rest * white);
    let test = white.transpose() * rest * white;
    let weighted = white.transpose() * (white * Vector2::from(residual.px));
    let root = |i: usize| (numbers[(i, i)] > UNCHECKED && test[(i, i)] > 0.0).then(|| test[(i, i)].sqrt());
    PointReliability {
        observation,
        redundancy: [0, 1].map(|i| numbers[(i, i)].clamp(0.0, 1.0)),
        w: [0, 1].map(|i| root(i).map_or(0.0, |root| weighted[i] / (sigma0 * root))),
        detectable: [0, 1].map(|i| root(i).map_or(f64::INFINITY, |root| noncentrality * sigma0 / root)),
        length: length(&rest, Vector2::from(precision.whitened(residual.px)) / sigma0),
    }
}

fn observed(what: String, v: f64, sigma: f64, cofactor: f64, [sigma0, noncentrality]: [f64; 2]) -> ObservedReliability {
    let redundancy = (1.0 - cofactor / (sigma * sigma)).clamp(0.0, 1.0);
    let deviation = sigma * redundancy.sqrt();
    let checked = redundancy > UNCHECKED;
    ObservedReliability {
        what,
        v,
        redundancy,
        w: if checked { v / (sigma0 * deviation) } else { 0.0 },
        detectable: if checked { noncentrality * sigma0 * sigma * sigma / deviation } else { f64::INFINITY },
    }
}
