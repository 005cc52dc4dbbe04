//! Relative orientation of two pictures.

use calibench_model::camera::{Camera, CameraModel, Ray};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Matrix3, Point3, SMatrix, Vector3};
use rand::SeedableRng;
use rand::seq::index::sample;
use rand_chacha::ChaCha8Rng;

use super::ApproximateError;
use super::consensus::{Search, each, others, search};
use super::coplanarity::{Motion, Pair, Slopes, nearest, normal, sampson, slopes};
use super::error::at_least;
use super::essential::{distances, essential_matrices, motion};
use super::least_squares::minimise;
use super::planar::orthogonal;
use super::rival::is_worth;

/// Points that determine the five unknowns, up to ten solutions.
const NEEDED: usize = 5;
/// Samples from which a second solution is looked for, and the norm by which it must differ.
const RIVAL_SAMPLES: usize = 12;
const DIFFERENT: f64 = 1e-4;
/// A standard deviation that is none, px.
const ROUNDING: f64 = 1e-7;

/// The second of two pictures in the axes of the first.
#[derive(Clone, Debug, PartialEq)]
pub struct RelativeOrientation {
    /// The second camera's pose in the first camera's axes (x right, y up, z backwards); its projection centre is at distance one.
    pub pose: Pose,
    /// Two unit vectors across the base, along which its cofactors count.
    pub base_axes: [Vector3<f64>; 2],
    /// Cofactors of a small rotation about the second camera's axes (rad) and of the base along `base_axes` (base lengths), for 1 px.
    pub cofactor: SMatrix<f64, 5, 5>,
    /// The standard deviation of an image coordinate from the residuals, px.
    pub sigma0: f64,
    /// Points that agree minus five.
    pub redundancy: usize,
    /// Nearest coplanar minus measured: x and y in the first image, then in the second, px. `None` where there is none.
    pub residuals: Vec<Option<[f64; 4]>>,
    /// Points that did not fit.
    pub rejected: Vec<usize>,
    /// Another orientation whose sum of squares an F test does not tell from the best: the points are in a plane, or close to another critical surface.
    pub rival: Option<Pose>,
}

/// The relative orientation of two pictures from six points or more, interior orientations fixed: five points at a time against gross errors, then least
/// squares in both images under the coplanarity of rays.
///
/// # Errors
/// [`ApproximateError::TooFew`] below six, [`ApproximateError::NotFinite`], [`ApproximateError::NoSolution`], [`ApproximateError::NoConsensus`],
/// [`ApproximateError::NoBase`] when a rotation alone explains the pictures, [`ApproximateError::Critical`] when points on a critical surface leave an
/// unknown free.
///
/// Source: Nistér 2004; Fischler & Bolles 1981; the adjustment in the Gauss-Helmert model, Mikhail & Ackermann 1976.
pub fn orient_relatively(
    cameras: [&Camera; 2],
    points: &[[PixelPoint; 2]],
    against: &Search,
) -> Result<RelativeOrientation, ApproximateError> {
    at_least(NEEDED + 1, points.len(), "points", "a relative orientation")?;
    if let Some(index) = points.iter().position(|pair| !pair.iter().all(|point| point.is_finite())) {
        return Err(ApproximateError::NotFinite { index });
    }
    let network = Network::of(cameras, points);
    let propose = |chosen: &[usize]| network.motions(chosen);
    let refine = |motion: &Motion, chosen: &[usize]| network.fit(motion, chosen).map(|fit| fit.motion);
    let (start, agreeing) = search(points.len(), NEEDED, 1, against, propose, each(|motion, i| network.square(motion, i)), refine)?;
    let best = network.fit(&start, &agreeing).ok_or(ApproximateError::NoSolution)?;
    if network.is_rotation(&best, &agreeing) {
        return Err(ApproximateError::NoBase);
    }
    let cofactor = best.cofactor.ok_or(ApproximateError::Critical { what: "the relative orientation" })?;
    Ok(RelativeOrientation {
        pose: best.motion.pose(),
        base_axes: best.motion.axes(),
        cofactor,
        sigma0: best.variance().sqrt(),
        redundancy: best.redundancy,
        residuals: network.pairs.iter().map(|pair| network.residual(&best.motion, pair.as_ref())).collect(),
        rejected: others(points.len(), &agreeing),
        rival: network.rival(&best, &agreeing, against.seed),
    })
}

impl Motion {
    fn pose(&self) -> Pose {
        Pose { rotation: orthogonal(&self.rotation), centre: Point3::from(self.base) }
    }
}

/// A minimum.
struct Fit {
    motion: Motion,
    squares: f64,
    redundancy: usize,
    cofactor: Option<SMatrix<f64, 5, 5>>,
}

impl Fit {
    fn variance(&self) -> f64 {
        self.squares / self.redundancy.max(1) as f64
    }

    /// A ratio of variances that chance hardly exceeds: six standard deviations of a variance of this redundancy.
    fn chance(&self) -> f64 {
        1.0 + 6.0 * (2.0 / self.redundancy.max(1) as f64).sqrt()
    }
}

struct Network<'a> {
    cameras: [&'a Camera; 2],
    /// `None` where a camera pictures nothing.
    pairs: Vec<Option<(Pair, Slopes)>>,
}

impl<'a> Network<'a> {
    fn of(cameras: [&'a Camera; 2], points: &[[PixelPoint; 2]]) -> Self {
        let pair = |pixels: &[PixelPoint; 2]| {
            let pair = Pair::of(cameras, *pixels)?;
            Some((pair, slopes(cameras, &pair)?))
        };
        Self { cameras, pairs: points.iter().map(pair).collect() }
    }

    /// The motions that five points allow, with all five before both cameras.
    fn motions(&self, chosen: &[usize]) -> Vec<Motion> {
        let rays: Vec<_> = chosen.iter().filter_map(|&i| self.pairs[i].as_ref().map(|(pair, _)| pair.rays())).collect();
        let Ok(five) = <[_; NEEDED]>::try_from(rays) else { return Vec::new() };
        let (first, second) = (five.map(|pair| pair[0]), five.map(|pair| pair[1]));
        let matrices = essential_matrices(&first, &second);
        let of = |essential: &Matrix3<f64>| {
            let (rotation, t) = motion(essential, &first.iter().zip(&second))?;
            let before =
                |(a, b): (&Vector3<f64>, &Vector3<f64>)| distances(&(rotation * a), b, &t).is_some_and(|[s, r]| s > 0.0 && r > 0.0);
            let all = first.iter().zip(&second).all(before);
            all.then(|| Motion { rotation, base: -(rotation.transpose() * t) })
        };
        matrices.iter().filter_map(of).collect()
    }

    /// The squared distance of a point from coplanarity; infinite behind a camera.
    fn square(&self, motion: &Motion, index: usize) -> f64 {
        let Some((pair, slopes)) = &self.pairs[index] else { return f64::INFINITY };
        sampson(motion, pair, slopes)
    }

    fn residual(&self, motion: &Motion, pair: Option<&(Pair, Slopes)>) -> Option<[f64; 4]> {
        nearest(self.cameras, motion, &pair?.0).map(|near| near.residual.into())
    }

    fn fit(&self, start: &Motion, chosen: &[usize]) -> Option<Fit> {
        let pairs = || chosen.iter().filter_map(|&i| self.pairs[i].as_ref().map(|(pair, _)| pair));
        let (motion, normal) = minimise(*start, |motion| normal(self.cameras, motion, pairs()), Motion::moved)?;
        Some(Fit { motion, squares: normal.squares, redundancy: normal.redundancy(), cofactor: normal.cofactor() })
    }

    /// Whether a rotation without a base explains the pictures as well.
    fn is_rotation(&self, best: &Fit, chosen: &[usize]) -> bool {
        let pairs: Vec<_> = chosen.iter().filter_map(|&i| self.pairs[i].as_ref().map(|(pair, _)| pair)).collect();
        let products = pairs.iter().map(|pair| pair.rays()).map(|[a, b]| b.normalize() * a.normalize().transpose()).sum::<Matrix3<f64>>();
        let rotation = orthogonal(&products);
        let square = |pair: &&Pair| {
            let q = rotation * pair.rays()[0];
            let found = self.cameras[1].project(Ray { x: q.x, y: q.y, z: q.z }).ok()?;
            Some(found.distance(pair.pixels[1]).powi(2))
        };
        // Both pictures have errors: two of them are in each difference.
        let Some(squares) = pairs.iter().map(square).sum::<Option<f64>>() else { return false };
        let variance = 0.5 * squares / (2 * pairs.len() - 3) as f64;
        variance <= (best.variance() * best.chance()).max(ROUNDING * ROUNDING)
    }

    /// The best minimum that differs from `best` and fits as well.
    fn rival(&self, best: &Fit, chosen: &[usize], seed: u64) -> Option<Pose> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let limit = (best.squares * best.chance()).max(ROUNDING * ROUNDING);
        let mut rival: Option<Fit> = None;
        for _ in 0..RIVAL_SAMPLES {
            let sampled: Vec<_> = sample(&mut random, chosen.len(), NEEDED).iter().map(|i| chosen[i]).collect();
            for start in self.motions(&sampled) {
                let squares: f64 = chosen.iter().map(|&i| self.square(&start, i)).sum();
                if !is_worth(squares, limit, chosen.len()) {
                    continue;
                }
                let Some(fit) = self.fit(&start, chosen).filter(|fit| fit.squares <= limit) else { continue };
                let apart = (fit.motion.rotation - best.motion.rotation).norm() + (fit.motion.base - best.motion.base).norm();
                let better = rival.as_ref().is_none_or(|rival| fit.squares < rival.squares);
                if apart > DIFFERENT && better && self.is_before(&fit.motion, chosen) {
                    rival = Some(fit);
                }
            }
        }
        rival.map(|fit| fit.motion.pose())
    }

    /// Whether the points lie before both cameras.
    fn is_before(&self, motion: &Motion, chosen: &[usize]) -> bool {
        let t = -(motion.rotation * motion.base);
        let before = |(pair, _): &(Pair, Slopes)| {
            let [a, b] = pair.rays();
            distances(&(motion.rotation * a), &b, &t).is_some_and(|[s, r]| s > 0.0 && r > 0.0)
        };
        chosen.iter().filter_map(|&i| self.pairs[i].as_ref()).all(before)
    }
}

#[cfg(test)]
mod tests;
