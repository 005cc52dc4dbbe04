//! `centroid`, `centroid_binary`: the centre of gravity of a target.

use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start};

use crate::blob::{Blob, Polarity, Segmentation};
use crate::operator::{Operator, window_centre};
use crate::parameter::{Parameter, Settings};
use crate::registry::{Build, Method};

/// Centroid of the connected pixels at the start that are beyond a threshold: plain, or weighted by how far they are beyond it.
///
/// The window of odd side, px, is centred on the pixel nearest to the start and must hold the target: what it cuts off is missing from the
/// centroid, too. Binary pixels may be enlarged first (bilinearly), as Vosselman & Förstner did by two. No covariance: what counts is the ragged
/// border, not the noise.
///
/// Source: grey: Trinder 1989; binary: Vosselman & Förstner 1988, Sect. 3.2 and 5; threshold: Otsu 1979.
pub struct Centroid {
    half: i64,
    segmentation: Segmentation,
    centre: fn(&Blob) -> PixelPoint,
}

const WINDOW: Parameter = Parameter::odd("window", "side of the window, px", [3, 101], 21.0).always_shown();
const THRESHOLD: Parameter = Parameter::real("threshold", "threshold, as a fraction of full scale; 0 for Otsu's", [0.0, 1.0], 0.0);
const POLARITY: Parameter = Parameter::named(
    "polarity",
    "the target is what most of the window's border is not, or it is dark or light",
    &["border", "dark", "light"],
    0,
);
const fn enlarge(default: f64) -> Parameter {
    Parameter::whole("enlarge", "how many times the window is enlarged before the threshold", [1, 4], default)
}

/// The entry of the grey centroid.
pub fn method() -> Method {
    Method {
        name: "centroid",
        about: "mean position of the target's pixels, weighted by how far their grey values are beyond the threshold",
        source: "Trinder 1989; Otsu 1979 (threshold)",
        version: "1".into(),
        parameters: const { &[WINDOW, THRESHOLD, POLARITY, enlarge(1.0)] },
        build: Build::With(|settings| Box::new(Centroid::new(settings, Blob::weighted_centre))),
    }
}

/// The entry of the binary centroid.
pub fn binary() -> Method {
    Method {
        name: "centroid_binary",
        about: "mean position of the target's pixels in the enlarged binary image",
        source: "Vosselman & Förstner 1988, Sect. 3.2 and 5; Otsu 1979 (threshold)",
        version: "1".into(),
        parameters: const { &[WINDOW, THRESHOLD, POLARITY, enlarge(2.0)] },
        build: Build::With(|settings| Box::new(Centroid::new(settings, Blob::centre))),
    }
}

impl Centroid {
    fn new(settings: &Settings, centre: fn(&Blob) -> PixelPoint) -> Self {
        let threshold = settings.get("threshold");
        let polarity = [Polarity::FromWindow, Polarity::Dark, Polarity::Light][settings.whole("polarity")];
        let threshold = (threshold > 0.0).then_some(threshold);
        let segmentation = Segmentation { threshold, polarity, enlarge: settings.whole("enlarge") };
        Self { half: settings.whole("window") as i64 / 2, segmentation, centre }
    }
}

impl Operator for Centroid {
    /// # Errors
    /// [`Rejection::Border`], [`Rejection::NotFinite`], [`Rejection::NoCorner`] when all grey values are on one side of the threshold.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        let centre = window_centre(image, start, self.half + i64::from(self.segmentation.enlarge > 1))?;
        let blob = self.segmentation.target(image, centre, self.half, start.position)?;
        Ok(Measurement { position: (self.centre)(&blob), covariance: None })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance;
    use crate::registry::Registry;

    fn operator(spec: &str) -> Box<dyn Operator> {
        Registry::builtin().parse(spec).unwrap().operator.unwrap()
    }

    #[test]
    fn conforms() {
        // Not with a given threshold, which does not follow grey values that are scaled.
        for spec in ["centroid", "centroid:polarity=1", "centroid_binary", "centroid_binary:enlarge=3", "centroid_binary:enlarge=1"] {
            conformance::check_on(&*operator(spec), conformance::disc, 1e-6);
        }
    }

    /// A disc of radius 6.3, its edge a smooth ramp.
    fn disc(cx: f64, cy: f64, dark: bool) -> Image<'static> {
        Image::from_fn(61, 61, |x, y| {
            let inside = 0.5 - 0.5 * ((x as f64 - cx).hypot(y as f64 - cy) - 6.3).tanh();
            (if dark { 0.8 - 0.6 * inside } else { 0.2 + 0.6 * inside }) as f32
        })
    }

    #[test]
    fn a_disc_is_found_at_its_centre_dark_or_light() {
        for (spec, tolerance) in
            [("centroid", 0.04), ("centroid_binary", 0.06), ("centroid:threshold=0.5", 0.04), ("centroid_binary:enlarge=1", 0.12)]
        {
            for (cx, cy) in [(30.0, 30.0), (30.37, 29.81), (29.5, 30.21)] {
                let [dark, light] = [true, false].map(|dark| {
                    let found = operator(spec).measure(&disc(cx, cy, dark), &Start::at(PixelPoint::new(28.0, 31.0))).unwrap();
                    found.position
                });
                let truth = PixelPoint::new(cx, cy);
                assert!(dark.distance(truth) < tolerance && dark.distance(light) < 1e-5, "{spec}: {dark:?} {light:?} {truth:?}");
            }
        }
    }

    #[test]
    fn enlargement_makes_the_binary_centroid_better() {
        let rms = |spec: &str| {
            let operator = operator(spec);
            let errors = (0..60).map(|i| {
                let centre = PixelPoint::new(30.0 + (f64::from(i) * 0.618).fract(), 30.0 + (f64::from(i) * 0.755).fract());
                operator.measure(&disc(centre.x, centre.y, true), &Start::at(centre)).unwrap().position.distance(centre).powi(2)
            });
            (errors.sum::<f64>() / 60.0).sqrt()
        };
        let (plain, enlarged, grey) = (rms("centroid_binary:enlarge=1"), rms("centroid_binary"), rms("centroid"));
        assert!(enlarged < 0.8 * plain && grey < enlarged, "{plain} {enlarged} {grey}");
    }

    #[test]
    fn a_threshold_beyond_all_grey_values_finds_nothing() {
        let image = disc(30.0, 30.0, true);
        let start = Start::at(PixelPoint::new(30.0, 30.0));
        for spec in ["centroid:threshold=0.05", "centroid:threshold=0.95,polarity=2"] {
            assert_eq!(operator(spec).measure(&image, &start), Err(Rejection::NoCorner), "{spec}");
        }
    }
}
