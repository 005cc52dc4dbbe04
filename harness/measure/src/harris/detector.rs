//! Interest points of a whole image.

use calibench_model::{Image, PixelPoint};

use super::{Harris, StrengthMap};
use crate::paraboloid::Weights;

/// The Harris detector: pixels whose strength is the largest around them, strongest first.
#[derive(Clone, Debug, PartialEq)]
pub struct HarrisDetector {
    /// How the strength is computed.
    pub harris: Harris,
    /// A detection is the strongest pixel within this many px of itself in both axes; at least 1.
    pub radius: usize,
    /// The least strength, as a fraction of the image's largest.
    pub threshold: f64,
    /// The most detections.
    pub strongest: usize,
}

/// An interest point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detection {
    /// The pixel, column and row.
    pub pixel: (usize, usize),
    /// Its strength (grey values, fractions of full scale, to the fourth power per px^4).
    pub strength: f64,
    /// The maximum of the paraboloid through its 3 x 3 strengths, `k = 0.2`; the pixel's own centre where that has none within a px.
    pub position: PixelPoint,
}

impl HarrisDetector {
    /// The detections in an image, strongest first; of equal strength, in the order of the rows. Grey values that are not numbers have none around them.
    ///
    /// Source: Zhu et al. 2007, Eq. 1; Harris & Stephens 1988.
    pub fn detect(&self, image: &Image) -> Vec<Detection> {
        self.maxima(&self.harris.map(image))
    }

    /// The detections among given strengths.
    pub fn maxima(&self, map: &StrengthMap) -> Vec<Detection> {
        let largest = map.values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f32::max);
        let least = (self.threshold * f64::from(largest)) as f32;
        let radius = self.radius.max(1);
        let weights = Weights::new(0.2);
        let mut found = Vec::new();
        for row in 1..map.rows.saturating_sub(1) {
            for column in candidates(map, row, least.max(0.0)) {
                if is_strongest(map, column, row, radius) {
                    found.push(detection(map, column, row, weights));
                }
            }
        }
        found.sort_by(|a, b| b.strength.total_cmp(&a.strength));
        found.truncate(self.strongest);
        found
    }
}

/// Columns of a row that exceed `least` and are not exceeded by the pixels beside and above or below them.
fn candidates(map: &StrengthMap, row: usize, least: f32) -> impl Iterator<Item = usize> + '_ {
    let line = |row: usize| &map.values[row * map.columns..(row + 1) * map.columns];
    let (above, here, below) = (line(row - 1), line(row), line(row + 1));
    let inner = 1..map.columns.saturating_sub(1);
    inner.filter(move |&x| {
        let value = here[x];
        value > least && value >= here[x - 1] && value >= here[x + 1] && value >= above[x] && value >= below[x]
    })
}

/// Of equally strong pixels the first in the order of the rows counts.
fn is_strongest(map: &StrengthMap, column: usize, row: usize, radius: usize) -> bool {
    let value = map.values[row * map.columns + column];
    let columns = column.saturating_sub(radius)..(column + radius + 1).min(map.columns);
    (row.saturating_sub(radius)..(row + radius + 1).min(map.rows)).all(|y| {
        columns.clone().all(|x| {
            let other = map.values[y * map.columns + x];
            if (y, x) < (row, column) { other < value } else { other <= value }
        })
    })
}

fn detection(map: &StrengthMap, column: usize, row: usize, weights: Weights) -> Detection {
    let pixel = (column + map.margin, row + map.margin);
    let maximum = weights.fit(&map.around(column, row)).maximum();
    let (dx, dy) = maximum.filter(|(dx, dy)| dx.abs() <= 1.0 && dy.abs() <= 1.0).unwrap_or((0.0, 0.0));
    let position = PixelPoint::new(pixel.0 as f64 + dx, pixel.1 as f64 + dy);
    Detection { pixel, strength: f64::from(map.values[row * map.columns + column]), position }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blobs of different contrast: (x, y, contrast).
    const BLOBS: [(f64, f64, f64); 4] = [(20.3, 25.1, 0.5), (50.0, 18.8, 0.8), (70.6, 45.4, 0.3), (33.2, 50.5, 0.65)];

    fn blobs() -> Image<'static> {
        Image::from_fn(90, 70, |x, y| {
            let at = |(bx, by, contrast): (f64, f64, f64)| contrast * (-((x as f64 - bx).powi(2) + (y as f64 - by).powi(2)) / 8.0).exp();
            BLOBS.into_iter().map(at).sum::<f64>() as f32
        })
    }

    fn detector() -> HarrisDetector {
        HarrisDetector { harris: Harris::new(0.04, 2.0), radius: 4, threshold: 1e-3, strongest: 100 }
    }

    #[test]
    fn blobs_are_found_strongest_first() {
        let found = detector().detect(&blobs());
        assert_eq!(found.len(), 4, "{found:?}");
        for (detection, (x, y, _)) in found.iter().zip([BLOBS[1], BLOBS[3], BLOBS[0], BLOBS[2]]) {
            assert!(detection.position.distance(PixelPoint::new(x, y)) < 0.05, "{detection:?}");
        }
        assert!(found.windows(2).all(|pair| pair[0].strength > pair[1].strength));
        assert_eq!(HarrisDetector { strongest: 2, ..detector() }.detect(&blobs()), found[..2]);
        // The strength grows with the fourth power of the contrast: (5/8)^4 = 0.15.
        assert_eq!(HarrisDetector { threshold: 0.2, ..detector() }.detect(&blobs()), found[..2]);
    }

    #[test]
    fn equally_strong_neighbours_are_one_detection() {
        // Symmetric about a line between two columns: two columns have the same strength.
        let image = Image::from_fn(60, 60, |x, y| (-((x as f64 - 29.5).powi(2) + (y as f64 - 30.0).powi(2)) / 8.0).exp() as f32);
        let found = detector().detect(&image);
        assert_eq!(found.len(), 1);
        assert!((found[0].position.x - 29.5).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn nothing_is_found_where_nothing_is() {
        assert!(detector().detect(&Image::new(50, 50, vec![0.5; 2500])).is_empty());
        assert!(detector().detect(&Image::new(50, 50, vec![f32::NAN; 2500])).is_empty());
        assert!(detector().detect(&Image::new(3, 3, vec![0.5; 9])).is_empty());
        let edge = Image::from_fn(50, 50, |x, _| if x > 24 { 1.0 } else { 0.0 });
        assert!(detector().detect(&edge).is_empty());
    }

    #[test]
    fn a_bad_pixel_hides_only_its_surroundings() {
        let mut image = blobs();
        image.grey_mut()[25 * 90 + 20] = f32::NAN;
        assert_eq!(detector().detect(&image).len(), 3);
    }
}
