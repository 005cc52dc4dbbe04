//! Residuals, of every observation that was given.

use crate::network::{ImageObservation, Sight};
use crate::normal;
use crate::solution::Solution;

/// How an observation took part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Use {
    /// With the weight of its standard deviation.
    Full,
    /// With this share of it, 0 to 1 (Huber).
    Downweighted(f64),
    /// Not at all.
    LeftOut,
}

/// The residual of an image point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// Its index among the observations given.
    pub observation: usize,
    /// Its image.
    pub image: usize,
    /// Its point.
    pub point: usize,
    /// `v` of x and y: adjusted less observed, px; `None` if it was left out and the result does not picture it.
    pub v: Option<[f64; 2]>,
    /// How it took part.
    pub used: Use,
}

/// The residuals of all observations in the order given, of sights in use and theirs, and as `left_out` has them of the others.
pub(crate) fn each<'o>(
    given: &'o [ImageObservation],
    (sights, of): (&'o [Sight], &'o [normal::Residual]),
    left_out: impl Fn(&ImageObservation) -> Option<[f64; 2]> + 'o,
) -> impl ExactSizeIterator<Item = Residual> + 'o {
    const LEFT_OUT: u32 = u32::MAX;
    let mut place = vec![LEFT_OUT; given.len()];
    sights.iter().enumerate().for_each(|(i, sight)| place[sight.given as usize] = i as u32);
    place.into_iter().enumerate().map(move |(observation, place)| {
        let o = &given[observation];
        let (image, point) = (o.image, o.point);
        if place == LEFT_OUT {
            return Residual { observation, image, point, v: left_out(o), used: Use::LeftOut };
        }
        let residual = &of[place as usize];
        let used = if residual.weight < 1.0 { Use::Downweighted(residual.weight) } else { Use::Full };
        Residual { observation, image, point, v: Some(residual.px), used }
    })
}

impl Solution<'_> {
    /// The residuals of all observations, those that were left out as well, in the order given.
    pub fn residuals(&self) -> Vec<Residual> {
        self.each_residual().collect()
    }

    /// [`Self::residuals`], one after the other.
    pub fn each_residual(&self) -> impl ExactSizeIterator<Item = Residual> + '_ {
        let (network, sights) = (self.engine.network, &self.engine.layout.sights);
        each(&network.observations, (sights, &self.end.normals.residuals), |o| self.left_out(o))
    }

    /// Residuals in use, made white by the a-priori precisions: pairs of numbers of variance 1 but for the redundancy, image by image.
    pub fn each_white_residual(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let given = &self.engine.network.observations;
        let sights = self.engine.layout.sights.iter();
        sights.zip(&self.end.normals.residuals).map(|(sight, residual)| sight.observed(given).precision.whitened(residual.px))
    }

    /// The residual of an observation that took no part, where the result pictures it.
    fn left_out(&self, o: &ImageObservation) -> Option<[f64; 2]> {
        let pixel = self.end.state.pixel(self.engine.network, o)?;
        Some([pixel.x - o.position.x, pixel.y - o.position.y])
    }

    /// Root mean square of the residuals in use, px: `sqrt(mean(vx^2 + vy^2))`, of each image; `None` for an image without any.
    pub fn rms_by_image(&self) -> Vec<Option<f64>> {
        let residuals = &self.end.normals.residuals;
        let of = |range: &std::ops::Range<usize>| {
            let sum: f64 = residuals[range.clone()].iter().map(|r| r.px[0] * r.px[0] + r.px[1] * r.px[1]).sum();
            (!range.is_empty()).then(|| (sum / range.len() as f64).sqrt())
        };
        self.engine.layout.of_image.iter().map(of).collect()
    }
}
