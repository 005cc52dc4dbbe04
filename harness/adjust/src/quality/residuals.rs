//! Residuals, of every observation that was given.

use calibench_model::camera::CameraModel;

use crate::solution::Solution;

/// How an observation took part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Use {
    /// With the weight of its standard deviation.
    Full,
    /// With this share of it (Huber).
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
    /// `v`: adjusted less observed, px; `None` if it was left out and the result does not picture it.
    pub v: Option<[f64; 2]>,
    /// How it took part.
    pub used: Use,
}

impl Solution<'_> {
    /// The residuals of all observations, those that were left out as well, in the order given.
    pub fn residuals(&self) -> Vec<Residual> {
        let (network, state) = (self.engine.network, &self.end.state);
        let mut found: Vec<Option<Residual>> = vec![None; network.observations.len()];
        for (sight, residual) in self.engine.layout.sights.iter().zip(&self.end.normals.residuals) {
            let used = if residual.weight < 1.0 { Use::Downweighted(residual.weight) } else { Use::Full };
            let (observation, image, point) = (sight.given, sight.image, sight.point);
            found[observation] = Some(Residual { observation, image, point, v: Some(residual.px), used });
        }
        let left_out = |observation: usize| {
            let o = &network.observations[observation];
            let ray = state.poses[o.image].ray(&state.points[o.point]);
            let pixel = state.cameras[network.images[o.image].camera].project(ray).ok();
            let v = pixel.map(|pixel| [pixel.x - o.position.x, pixel.y - o.position.y]);
            Residual { observation, image: o.image, point: o.point, v, used: Use::LeftOut }
        };
        found.into_iter().enumerate().map(|(i, found)| found.unwrap_or_else(|| left_out(i))).collect()
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
