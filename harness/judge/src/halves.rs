//! Halves of the photographs: two cameras that should be one.

use std::collections::BTreeMap;

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, ImageSize};
use calibench_model::convert::{DifferenceOptions, difference};
use calibench_random::{Key, Purpose, stream};
use nalgebra::DVector;
use rand::seq::SliceRandom;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use super::calibrated::Calibrated;
use super::frame::{Frame, weights};

/// Places along the rows of the frame at which cameras are compared.
pub const COLUMNS: usize = 13;

/// The views of the two halves of split `split`: `views` shuffled, the first half the smaller if their number is odd. Both in the order of `views`.
pub fn halves(views: &[usize], (seed, scenario): (u64, &str), split: u64) -> [Vec<usize>; 2] {
    let mut order: Vec<usize> = views.to_vec();
    order.shuffle(&mut stream(Key { seed, of: scenario, trial: split, view: "", target: "" }, Purpose::Split));
    let (first, second) = order.split_at(views.len() / 2);
    [first, second].map(|half| {
        let mut half = half.to_vec();
        half.sort_unstable();
        half
    })
}

/// How far two cameras are apart, beside what their covariances say.
#[derive(Clone, Debug)]
pub struct Apart {
    /// By place: squared difference and predicted variance, px^2 (2D).
    pub places: Vec<(PixelPoint, f64, f64)>,
    /// Of each place in means over the area; their mean is 1.
    weights: Vec<f64>,
    /// The modes of the difference, squared and over their predicted variances: the sum, a number; and how many they are.
    pub chi_square: (f64, usize),
    /// The chance (0 to 1) of as large a sum, if the covariances are right.
    pub p: f64,
}

impl Apart {
    /// RMS over the frame of the difference, and the predicted one, px.
    pub fn rms(&self) -> (f64, f64) {
        let n = self.places.len() as f64;
        let all = || self.places.iter().zip(&self.weights);
        let root = |of: fn(&(PixelPoint, f64, f64)) -> f64| (all().map(|(place, weight)| weight * of(place)).sum::<f64>() / n).sqrt();
        (root(|place| place.1), root(|place| place.2))
    }
}

/// Compares the cameras of two sets of photographs that share none, after the best rotation.
///
/// # Errors
/// In words.
pub fn apart(first: &Calibrated, second: &Calibrated) -> Result<Apart, String> {
    let (at, vectors) = vectors(&first.camera, &second.camera)?;
    let frame = Frame::new(&first.camera, &first.names, &at).ok_or("a place of the frame has no ray")?;
    let vectors = frame.without_rotation(&vectors);
    let covariance = &first.covariance + &second.covariance;
    let (sum, modes) = frame.chi_square(&vectors, &covariance).ok_or("the covariance is not positive")?;
    let variances = frame.variances(&covariance);
    let places = at.iter().enumerate().map(|(k, at)| (*at, vectors[2 * k].powi(2) + vectors[2 * k + 1].powi(2), variances[k])).collect();
    let fisher = FisherSnedecor::new(modes as f64, (first.redundancy + second.redundancy) as f64).map_err(|error| error.to_string())?;
    let weights = weights(first.camera.size(), &at);
    Ok(Apart { places, weights, chi_square: (sum, modes), p: fisher.sf(sum / modes as f64) })
}

/// The difference from `first` to `second` over the frame after the best rotation: places, and x (right) and y (down) of each one's difference, px.
///
/// # Errors
/// In words.
pub fn vectors(first: &Camera, second: &Camera) -> Result<(Vec<PixelPoint>, DVector<f64>), String> {
    let options = DifferenceOptions { columns: COLUMNS, ..DifferenceOptions::default() };
    let found = difference(first, second, &options).map_err(|error| error.to_string())?;
    let at = found.vectors.iter().map(|vector| vector.at).collect();
    Ok((at, DVector::from_iterator(2 * found.vectors.len(), found.vectors.iter().flat_map(|vector| [vector.dx, vector.dy]))))
}

/// The mean square length (2D, px^2) over the area of vectors at the places `at` of a grid over a frame: x and y of each, px.
pub fn mean_square(size: ImageSize, at: &[PixelPoint], vectors: &DVector<f64>) -> f64 {
    let squares = vectors.as_slice().chunks(2).map(|v| v[0].powi(2) + v[1].powi(2));
    weights(size, at).iter().zip(squares).map(|(weight, square)| weight * square).sum::<f64>() / at.len() as f64
}

/// The places over the frame at which cameras are compared.
///
/// # Errors
/// In words: a camera that does not picture all of them.
pub fn places(camera: &Camera) -> Result<Vec<PixelPoint>, String> {
    let options = DifferenceOptions { columns: COLUMNS, rotation: false, ..DifferenceOptions::default() };
    let found = difference(camera, camera, &options).map_err(|error| error.to_string())?;
    if found.not_comparable > 0.0 {
        Err("parts of the frame have no rays".into())
    } else {
        Ok(found.vectors.iter().map(|vector| vector.at).collect())
    }
}

/// Differences of several splits, place by place.
#[derive(Clone, Debug, Default)]
pub struct Map(BTreeMap<[u64; 2], (f64, f64, usize)>);

impl Map {
    /// Adds a split.
    pub fn add(&mut self, apart: &Apart) {
        for (at, square, variance) in &apart.places {
            // Bits of numbers that are not negative are in the order of the numbers; + 0 takes the sign off a zero.
            let cell = self.0.entry([(at.y + 0.0).to_bits(), (at.x + 0.0).to_bits()]).or_default();
            *cell = (cell.0 + square, cell.1 + variance, cell.2 + 1);
        }
    }

    /// By place, row by row: RMS of the differences, and of what was predicted, px.
    pub fn places(&self) -> impl Iterator<Item = (PixelPoint, f64, f64)> + '_ {
        self.0.iter().map(|([y, x], (square, variance, count))| {
            let n = *count as f64;
            (PixelPoint::new(f64::from_bits(*x), f64::from_bits(*y)), (square / n).sqrt(), (variance / n).sqrt())
        })
    }
}
