//! Interest points with their own scale.

use calibench_model::Image;

use super::detector::{Detection, HarrisDetector};
use super::{Harris, smooth};

/// Detection on several scales: a point is kept on the scale on which the normalised Laplacian of its surroundings is largest.
///
/// On scale `n` the integration Gaussian has `first ratio^n` px and the derivation Gaussian `derivation` times that.
///
/// Source: Zhu et al. 2007, Eq. 2; Mikolajczyk & Schmid 2004 (Harris-Laplace; there ratio 1.4 and derivation 0.7).
#[derive(Clone, Debug, PartialEq)]
pub struct HarrisLaplace {
    /// Integration scale of the finest level, px.
    pub first: f64,
    /// Integration scale of a level over that of the finer one before it, a number.
    pub ratio: f64,
    /// How many levels.
    pub levels: usize,
    /// Derivation scale over integration scale.
    pub derivation: f64,
    /// Weight of the squared trace, a number.
    pub alpha: f64,
    /// The least strength, as a fraction of the largest on the same level.
    pub threshold: f64,
    /// The most detections.
    pub strongest: usize,
}

/// An interest point with its scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledDetection {
    /// The point and its scale-adapted strength: grey values (fractions of full scale) to the fourth power.
    pub point: Detection,
    /// Its integration scale, px.
    pub scale: f64,
}

impl Default for HarrisLaplace {
    fn default() -> Self {
        Self { first: 1.5, ratio: 1.4, levels: 7, derivation: 0.7, alpha: 0.04, threshold: 0.01, strongest: 10_000 }
    }
}

impl HarrisLaplace {
    /// The detections, strongest first.
    pub fn detect(&self, image: &Image) -> Vec<ScaledDetection> {
        // One level more on either side to compare with: a Laplacian that still grows there has its maximum elsewhere.
        let scales: Vec<f64> = (0..self.levels + 2).map(|n| self.first * self.ratio.powf(n as f64 - 1.0)).collect();
        let smoothed: Vec<Image<'static>> = scales.iter().map(|scale| smooth(image, *scale)).collect();
        let mut found = Vec::new();
        for level in 1..=self.levels {
            let scale = scales[level];
            let points = self.on_level(image, scale);
            let is_largest = |point: &Detection| {
                let response = |n: usize| laplacian(&smoothed[n], point.pixel, scales[n]);
                let here = response(level);
                here > response(level - 1) && here >= response(level + 1)
            };
            found.extend(points.into_iter().filter(is_largest).map(|point| ScaledDetection { point, scale }));
        }
        found.sort_by(|a, b| b.point.strength.total_cmp(&a.point.strength));
        found.truncate(self.strongest);
        found
    }

    fn on_level(&self, image: &Image, scale: f64) -> Vec<Detection> {
        let derivation = self.derivation * scale;
        let harris = Harris::scale_adapted(self.alpha, derivation, scale);
        let detector = HarrisDetector { harris, radius: scale.ceil() as usize, threshold: self.threshold, strongest: usize::MAX };
        detector.detect(&smooth(image, derivation))
    }
}

/// `scale^2 |Lxx + Lyy|` of the smoothed image at a pixel; 0 on its border.
fn laplacian(image: &Image, (x, y): (usize, usize), scale: f64) -> f64 {
    if !image.holds(x as i64, y as i64, 1) {
        return 0.0;
    }
    let at = |x: usize, y: usize| f64::from(image.at(x, y));
    scale * scale * (at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1) - 4.0 * at(x, y)).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_model::PixelPoint;

    fn blob(spread: f64) -> Image<'static> {
        Image::from_fn(121, 121, |x, y| (-((x as f64 - 60.3).powi(2) + (y as f64 - 59.8).powi(2)) / (2.0 * spread * spread)).exp() as f32)
    }

    #[test]
    fn the_scale_grows_with_the_blob() {
        // The normalised Laplacian of a Gaussian blob, s^2 / (spread^2 + s^2)^2 at its middle, is largest at s = spread.
        for spread in [2.1, 2.94, 4.12, 5.76] {
            let found = HarrisLaplace::default().detect(&blob(spread));
            let nearest = found.iter().find(|d| d.point.position.distance(PixelPoint::new(60.3, 59.8)) < 0.3).unwrap();
            assert!((nearest.scale / spread).ln().abs() < 1.01 * 1.4_f64.ln() / 2.0, "{spread}: {nearest:?}");
        }
    }

    #[test]
    fn strengths_of_the_same_shape_are_the_same_on_its_own_scale() {
        let strength = |spread: f64| {
            let found = HarrisLaplace { first: spread, levels: 1, ..HarrisLaplace::default() }.detect(&blob(spread));
            found[0].point.strength
        };
        // Two sizes of one shape; central differences weaken the gradients of the smaller one a little more.
        let (small, large) = (strength(5.5), strength(11.0));
        assert!((small / large - 1.0).abs() < 0.03, "{small} {large}");
    }
}
