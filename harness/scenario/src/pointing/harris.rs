//! A Harris detector in place of a hand.

use calibench_measure::harris::{Detection, Harris, HarrisDetector, smooth};
use calibench_model::{Image, PixelPoint, Start};
use schemars::JsonSchema;
use serde::Deserialize;

use super::DetectorReach;
use crate::wire::bounded;

bounded! {
    /// The standard deviation of a detector's Gaussian, px.
    DetectorSigma(f64), f64 "f64", 0.1, 10.0;
    /// Weight of the squared trace.
    DetectorAlpha(f64), f64 "f64", 0.0, 0.24;
    /// A fraction of the largest strength.
    DetectorThreshold(f64), f64 "f64", 0.0, 1.0;
    /// How many detections are kept.
    DetectorStrongest(usize), i64 "i64", 1, 1_000_000;
    /// A distance in whole pixels.
    DetectorSeparation(usize), i64 "i64", 1, 100;
}

/// A detector in the place of a hand: operators start at its detections.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(inline)]
pub struct HarrisWire {
    /// `harris`: the pixels of largest Harris strength in the whole image, as Zhu, Wu & Wan start.
    pub detector: HarrisKind,
    /// A target takes the detection nearest to it within this distance, px; without one it is missed. Default 3.
    pub within: Option<DetectorReach>,
    /// Standard deviation of the integration Gaussian, px. Default 1.
    pub sigma: Option<DetectorSigma>,
    /// Standard deviation of the derivation Gaussian, px. Default: Sobel gradients of the image as it is.
    pub derivation: Option<DetectorSigma>,
    /// Weight of the squared trace. Default 0.04.
    pub alpha: Option<DetectorAlpha>,
    /// The least strength, as a fraction of the image's largest. Default 0.01.
    pub threshold: Option<DetectorThreshold>,
    /// The most detections, strongest first. Default 10000.
    pub strongest: Option<DetectorStrongest>,
    /// A detection is the strongest pixel within this many px of itself. Default 3.
    pub separation: Option<DetectorSeparation>,
}

/// Which detector.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum HarrisKind {
    /// The Harris detector.
    Harris,
}

/// A Harris detector and how its detections are told apart.
#[derive(Clone, Debug)]
pub struct HarrisPointing {
    harris: HarrisDetector,
    derivation: Option<f64>,
    /// A target takes the nearest detection within this distance, px.
    pub within: f64,
}

impl From<HarrisWire> for HarrisPointing {
    fn from(wire: HarrisWire) -> Self {
        let HarrisKind::Harris = wire.detector;
        let (alpha, sigma) = (wire.alpha.map_or(0.04, |alpha| alpha.0), wire.sigma.map_or(1.0, |sigma| sigma.0));
        let derivation = wire.derivation.map(|derivation| derivation.0);
        let harris = derivation.map_or_else(|| Harris::new(alpha, sigma), |derivation| Harris::scale_adapted(alpha, derivation, sigma));
        let harris = HarrisDetector {
            harris,
            radius: wire.separation.map_or(3, |separation| separation.0),
            threshold: wire.threshold.map_or(0.01, |threshold| threshold.0),
            strongest: wire.strongest.map_or(10_000, |strongest| strongest.0),
        };
        Self { harris, derivation, within: wire.within.map_or(3.0, |within| within.0) }
    }
}

impl HarrisPointing {
    /// The detections in an image, strongest first.
    pub fn detect(&self, image: &Image) -> Vec<Detection> {
        match self.derivation {
            None => self.harris.detect(image),
            Some(derivation) => self.harris.detect(&smooth(image, derivation)),
        }
    }

    /// The start that each target gets: the whole pixel of the detection nearest to its true position, `None` where none is within reach. The
    /// truth says which detection is meant and nothing more: neither it nor the kind of the target goes to the operators.
    pub fn starts(&self, image: &Image, truths: impl IntoIterator<Item = PixelPoint>) -> Vec<Option<Start>> {
        let found: Vec<PixelPoint> =
            self.detect(image).iter().map(|detection| PixelPoint::new(detection.pixel.0 as f64, detection.pixel.1 as f64)).collect();
        truths.into_iter().map(|truth| truth.nearest(&found, self.within).map(Start::at)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn detector(within: f64) -> HarrisPointing {
        let harris = HarrisDetector { harris: Harris::new(0.04, 1.0), radius: 3, threshold: 0.01, strongest: 10 };
        HarrisPointing { harris, derivation: None, within }
    }

    /// A light square on dark, its corners at the borders of pixels.
    fn square() -> Image<'static> {
        Image::from_fn(60, 60, |x, y| if (20..40).contains(&x) && (20..40).contains(&y) { 1.0 } else { 0.0 })
    }

    #[test]
    fn a_target_takes_its_nearest_detection_and_none_further_off() {
        let corners = [(19.5, 19.5), (39.5, 19.5), (19.5, 39.5), (30.0, 30.0)].map(|(x, y)| PixelPoint::new(x, y));
        let starts = detector(3.0).starts(&square(), corners);
        for (start, corner) in starts.iter().zip(corners).take(3) {
            let at = start.unwrap().position;
            assert!(at.distance(corner) < 2.0 && at.x.fract() == 0.0 && at.y.fract() == 0.0, "{at:?}");
            assert_eq!((start.unwrap().kind, start.unwrap().affine), (None, None));
        }
        assert_eq!(starts[3], None, "nothing is in the middle of the square");
        assert!(detector(0.2).starts(&square(), corners).iter().all(Option::is_none));
    }

    #[test]
    fn smoothing_before_the_derivative_is_part_of_it() {
        let smoothed = HarrisPointing {
            derivation: Some(1.0),
            harris: HarrisDetector { harris: Harris::scale_adapted(0.04, 1.0, 1.0), ..detector(3.0).harris },
            within: 3.0,
        };
        assert_eq!(smoothed.detect(&square()).len(), 4);
    }
}
