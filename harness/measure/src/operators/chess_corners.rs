//! `chess_corners`: the detector of the crate of that name, unchanged.

use std::sync::{Mutex, MutexGuard, PoisonError};

use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start};
use chess_corners::{Detector, DetectorConfig, ImageRefiner};

use crate::operator::{Operator, nearest_detected};
use crate::parameter::{Parameter, Settings};
use crate::registry::{Build, Method};

/// The crate's version, as locked.
const VERSION: &str = "2.1.0";
/// How far the detector's ring of samples reaches, and one px more.
const RING: i64 = 6;
/// Pixels of an image up to which the memory of its detection is kept for the next: with the Radon detector some 150 bytes each.
const KEPT: usize = 1 << 20;

/// The crate `chess-corners` (V. Vorobyev; MIT): corners are detected on the whole image, as 8-bit grey values, with the crate's own presets; a start is given the
/// nearest detection within `radius` px.
///
/// Nothing of it is tuned or changed. It sees 8 bits, whatever the image has. Many starts on one image share one detection.
///
/// Source: ChESS: Bennett & Lasenby 2014; Radon: Duda & Frese 2018.
pub struct ChessCorners {
    config: DetectorConfig,
    radius: f64,
    /// Detectors that nobody uses now: their memory is asked for once a thread, not once an image.
    idle: Mutex<Vec<Detector>>,
}

const PARAMETERS: &[Parameter] = &[
    Parameter::named("detector", "ChESS or Radon", &["chess", "radon"], 0),
    Parameter::named("refiner", "the detector's own position, or the crate's saddle point", &["own", "saddle"], 1),
    Parameter::real("radius", "how far a detection may be from the start, px", [0.5, 30.0], 5.0),
];

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "chess_corners",
        about: "the crate chess-corners: detection on the whole image, the nearest detection to the start",
        source: "crate chess-corners; Bennett & Lasenby 2014; Duda & Frese 2018",
        version: VERSION.into(),
        parameters: PARAMETERS,
        build: Build::With(|settings| Box::new(ChessCorners::new(settings))),
    }
}

impl ChessCorners {
    fn new(settings: &Settings) -> Self {
        let preset = if settings.get("detector") > 0.0 { DetectorConfig::radon() } else { DetectorConfig::chess() };
        let refined = settings.get("refiner") > 0.0;
        let config = if refined { preset.with_refiner(ImageRefiner::saddle_point()) } else { preset.without_refiner() };
        Self { config: config.without_orientation(), radius: settings.get("radius"), idle: Mutex::default() }
    }

    fn idle(&self) -> MutexGuard<'_, Vec<Detector>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// All detections, px.
    fn detect(&self, image: &Image) -> Option<Vec<PixelPoint>> {
        let waiting = self.idle().pop();
        let mut detector = waiting.map_or_else(|| Detector::new(self.config), Ok).ok()?;
        let found = detector.detect_u8(&image.to_u8(), image.width() as u32, image.height() as u32).ok()?;
        if image.width() * image.height() <= KEPT {
            self.idle().push(detector);
        }
        Some(found.iter().map(|corner| PixelPoint::new(f64::from(corner.x), f64::from(corner.y))).filter(|p| p.is_finite()).collect())
    }
}

impl Operator for ChessCorners {
    /// # Errors
    /// [`Rejection::Border`] when what the detector looks at within `radius` of the start leaves the image, [`Rejection::NotFinite`],
    /// [`Rejection::NoCorner`] when nothing is detected there.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        self.measure_all(image, std::slice::from_ref(start)).pop().unwrap_or(Err(Rejection::NoCorner))
    }

    fn measure_all(&self, image: &Image, starts: &[Start]) -> Vec<Result<Measurement, Rejection>> {
        let reach = RING + self.radius.ceil() as i64;
        nearest_detected((image, starts), (reach, self.radius), || self.detect(image).unwrap_or_default())
    }

    fn is_local(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance;
    use crate::registry::Registry;
    use crate::tests::closed_form_images::Picture;
    use calibench_model::{Affine, TargetKind};

    fn operator(spec: &str) -> Box<dyn Operator> {
        Registry::builtin().parse(spec).unwrap().operator.unwrap()
    }

    #[test]
    fn the_version_is_the_one_that_is_locked() {
        let mut above = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
        let lock = above.find_map(|folder| std::fs::read_to_string(folder.join("Cargo.lock")).ok()).expect("a lock file");
        assert!(lock.contains(&format!("name = \"chess-corners\"\nversion = \"{VERSION}\"")));
    }

    #[test]
    fn conforms() {
        // Eight bits: half the contrast has half the levels.
        for (spec, tolerance) in [("chess_corners", 0.01), ("chess_corners:refiner=0", 0.03), ("chess_corners:detector=1", 0.01)] {
            conformance::check_on(&*operator(spec), conformance::chess_corner, tolerance);
        }
    }

    #[test]
    fn a_right_chess_corner_is_found() {
        let (sin, cos) = 0.3_f64.sin_cos();
        let affine = Affine { axx: 60.0 * cos, axy: -60.0 * sin, ayx: 60.0 * sin, ayy: 60.0 * cos };
        let picture = Picture { kind: TargetKind::ChessCorner, at: [30.3, 29.8], affine, sigma: 0.8, ground: 0.8, contrast: -0.6 };
        let start = Start::at(PixelPoint::new(31.5, 28.0));
        for (spec, tolerance) in [("chess_corners", 0.02), ("chess_corners:refiner=0", 0.2), ("chess_corners:detector=1", 0.02)] {
            let found = operator(spec).measure(&picture.image(61), &start).unwrap();
            assert!(found.position.distance(PixelPoint::new(30.3, 29.8)) < tolerance, "{spec}: {found:?}");
        }
    }
}
