//! Tasks of simple geometry by hand, derivatives beside differences, budgets beside drawn measurements.

mod by_hand;
mod coverage;
mod drawn;
mod files;

use calibench_model::camera::{Camera, ImageSize, OpenCv};
use calibench_model::named_camera::ParameterCovariance;
use calibench_model::{ControlRow, NamedCamera};

use crate::{Budget, Source, Task, parse};

/// A camera of 2000 x 1500 px with a principal distance of 2000 px, and what is known of it.
fn camera(covariance: &[(&str, f64)]) -> NamedCamera {
    let size = ImageSize { width: 2000, height: 1500 };
    let mut camera = OpenCv { size, fx: 2000.0, fy: 2000.0, cx: 999.5, cy: 749.5, distortion: [0.0; 14], coefficients: 5 };
    camera.distortion[0] = -0.1;
    let names: Vec<String> = covariance.iter().map(|(name, _)| (*name).to_owned()).collect();
    let count = covariance.len();
    // Correlated by 0.6: what is taken as independent would be seen.
    let value = |place: usize| {
        let (row, column) = (place / count, place % count);
        covariance[row].1 * covariance[column].1 * if row == column { 1.0 } else { 0.6 }
    };
    let covariance = (count > 0).then(|| ParameterCovariance::new(names, (0..count * count).map(value).collect()).unwrap());
    NamedCamera { covariance, ..NamedCamera::new("", Camera::from(camera)) }
}

/// A board of 9 x 7 points, 25 apart, in the plane Z = 0.
fn board() -> Vec<ControlRow> {
    let at = |place: usize| [25.0 * (place % 9) as f64 - 100.0, 25.0 * (place / 9) as f64 - 75.0, 0.0];
    (0..63).map(|place| ControlRow { sigmas: Some([0.02; 3]), ..ControlRow::new(format!("p{place}"), at(place)) }).collect()
}

fn task(text: &str) -> Task {
    parse("t.toml", text).unwrap()
}

/// What a source makes of the first number; 0 of one that makes nothing.
fn of(budget: &Budget, source: Source) -> f64 {
    budget.components[0].parts.iter().find(|part| part.source == source).map_or(0.0, |part| part.sigma)
}

fn near(found: f64, by_hand: f64, share: f64) {
    assert!((found / by_hand - 1.0).abs() < share, "{found} and by hand {by_hand}");
}

/// A length of 100 below a camera that looks straight down on its plane.
const DOWN: &str = "sigma = 0.1\nscale_sigma = 2e-4\n[measure]\nlength = [[-50, 0, 0], [50, 0, 0]]\n[known_plane]\npoint = [0, 0, 0]\nnormal = [0, 0, 2]\nsigma = 0.4\nsigma_tilt = 0.5\n[[image]]\ncentre = [0, 0, 800]\nangles = [0, 0, 0]\nsigma_centre = 0.3\nsigma_angles = 0.02\n";
/// Two oblique images.
const PAIR: &str = "[[image]]\ncentre = [-200, 0, 750]\nangles = [0, -15, 3]\nsigma_centre = 0.1\nsigma_angles = 0.01\n[[image]]\ncentre = [220, 30, 800]\nangles = [-2, 16, 88]\nsigma_centre = 0.1\nsigma_angles = 0.01\n";
