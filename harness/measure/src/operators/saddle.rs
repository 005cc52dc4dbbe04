//! `saddle`: the saddle point of a quadratic surface.

use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start};

use crate::operator::{Operator, window_centre};
use crate::parameter::{Parameter, Settings};
use crate::registry::{Build, Method};

/// At or below this ratio of its smaller to its larger curvature the surface is a ridge: it has no point.
const RIDGE: f64 = 1e-3;

/// Saddle of a chess corner: grey values are smoothed by a Gaussian, a quadratic surface is fitted to those in the window by least squares, and its
/// saddle point is the corner.
///
/// The window of odd side, px, is centred on the pixel nearest to the start and moves with the result until that stays in its middle pixel, for at most
/// `iterations` fits (1: as published). Without smoothing only blurred corners look like a saddle as far as the window reaches.
///
/// Source: Chen & Zhang 2005 (a Taylor polynomial of second order of the smoothed image); the fit over a window is that of Lucchese & Mitra 2002.
pub struct Saddle {
    half: i64,
    /// One half of the smoothing weights, from the middle outwards.
    weights: Vec<f64>,
    iterations: usize,
}

const PARAMETERS: &[Parameter] = &[
    Parameter::odd("window", "side of the window of the fit, px", [3, 31], 7.0).always_shown(),
    Parameter::real("sigma", "standard deviation of the smoothing Gaussian, px; 0 for none", [0.0, 5.0], 1.5),
    Parameter::whole("iterations", "most fits", [1, 50], 10.0),
];

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "saddle",
        about: "saddle point of a quadratic surface fitted to the smoothed grey values of the window",
        source: "Chen & Zhang 2005; Lucchese & Mitra 2002",
        version: "1".into(),
        parameters: PARAMETERS,
        build: Build::With(|settings| Box::new(Saddle::new(settings))),
    }
}

impl Saddle {
    fn new(settings: &Settings) -> Self {
        let sigma = settings.get("sigma");
        let radius = (3.0 * sigma).ceil() as usize;
        let raw: Vec<f64> = (0..=radius).map(|d| if d == 0 { 1.0 } else { (-((d * d) as f64) / (2.0 * sigma * sigma)).exp() }).collect();
        let sum = raw[0] + 2.0 * raw[1..].iter().sum::<f64>();
        let weights = raw.into_iter().map(|w| w / sum).collect();
        Self { half: settings.whole("window") as i64 / 2, weights, iterations: settings.whole("iterations") }
    }

    /// The saddle, from the pixel in the middle.
    fn once(&self, image: &Image, (x, y): (i64, i64)) -> Result<(f64, f64), Rejection> {
        let radius = self.weights.len() as i64 - 1;
        let rows: Vec<&[f32]> = image.rows_around(x, y, self.half + radius).ok_or(Rejection::Border)?.collect();
        if rows.iter().any(|row| row.iter().any(|grey| !grey.is_finite())) {
            return Err(Rejection::NotFinite);
        }
        // Counted from the middle, a flat window is exactly zero.
        let middle = f64::from(rows[rows.len() / 2][rows.len() / 2]);
        let side = (2 * self.half + 1) as usize;
        let weigh = |at: &dyn Fn(usize) -> f64| -> f64 {
            let radius = radius as usize;
            self.weights
                .iter()
                .enumerate()
                .skip(1)
                .fold(self.weights[0] * at(radius), |sum, (d, w)| sum + w * (at(radius - d) + at(radius + d)))
        };
        let along: Vec<Vec<f64>> =
            rows.iter().map(|row| (0..side).map(|column| weigh(&|i| f64::from(row[column + i]) - middle)).collect()).collect();
        let smoothed = |column: usize, row: usize| weigh(&|i| along[row + i][column]);
        solve(&moments(side, smoothed))
    }
}

/// Least-squares coefficients of `a x^2 + b x y + c y^2 + d x + e y`. On a square grid about zero these are sums of products, one for each.
fn moments(side: usize, grey: impl Fn(usize, usize) -> f64) -> [f64; 5] {
    let half = (side / 2) as f64;
    let (n, at) = (side as f64, |i: usize| i as f64 - half);
    let second = (0..side).map(|i| at(i) * at(i)).sum::<f64>();
    let mean = second / n;
    let spread = (0..side).map(|i| (at(i) * at(i) - mean).powi(2)).sum::<f64>();
    let mut sums = [0.0; 5];
    for (column, row) in (0..side).flat_map(|row| (0..side).map(move |column| (column, row))) {
        let (x, y, g) = (at(column), at(row), grey(column, row));
        let terms = [(x * x - mean) * g, x * y * g, (y * y - mean) * g, x * g, y * g];
        sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
    }
    let norms = [n * spread, second * second, n * spread, n * second, n * second];
    std::array::from_fn(|i| sums[i] / norms[i])
}

fn solve(&[a, b, c, d, e]: &[f64; 5]) -> Result<(f64, f64), Rejection> {
    let determinant = 4.0 * a * c - b * b;
    if !determinant.is_finite() {
        return Err(Rejection::NotFinite);
    }
    // Product and sum of squares of the curvatures.
    if -determinant <= RIDGE * (4.0 * a * a + 4.0 * c * c + 2.0 * b * b) {
        return Err(Rejection::NoCorner);
    }
    Ok(((b * e - 2.0 * c * d) / determinant, (b * d - 2.0 * a * e) / determinant))
}

impl Operator for Saddle {
    /// # Errors
    /// [`Rejection::Border`], [`Rejection::NotFinite`], [`Rejection::NoCorner`] when the surface has no saddle, [`Rejection::LeftWindow`] when that is
    /// outside the window, or farther from the start than the window is wide.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        let first = window_centre(image, start, self.half + self.weights.len() as i64 - 1)?;
        let mut centre = first;
        let mut before = first;
        for _ in 0..self.iterations {
            let (dx, dy) = self.once(image, centre)?;
            let half = self.half as f64;
            let outside = dx.abs() > half || dy.abs() > half;
            if outside && self.iterations == 1 {
                return Err(Rejection::LeftWindow);
            }
            // A saddle beyond the window is a direction, no more: the window goes as far as it has seen.
            let (dx, dy) = (dx.clamp(-half, half), dy.clamp(-half, half));
            let position = PixelPoint::new(centre.0 as f64 + dx, centre.1 as f64 + dy);
            let next = position.nearest_pixel().ok_or(Rejection::NotFinite)?;
            // Between two pixels the window may go back and forth for ever: either will do.
            if !outside && (next == centre || next == before || self.iterations == 1) {
                return Ok(Measurement { position, covariance: None });
            }
            if (next.0 - first.0).abs().max((next.1 - first.1).abs()) > 2 * self.half + 1 {
                return Err(Rejection::LeftWindow);
            }
            (before, centre) = (centre, next);
        }
        Err(Rejection::NotConverged)
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
        for spec in ["saddle", "saddle:window=11,sigma=1", "saddle:window=9,sigma=0,iterations=1"] {
            conformance::check_on(&*operator(spec), conformance::chess_corner, 1e-6);
        }
    }

    #[test]
    fn a_quadratic_surface_is_found_exactly() {
        let image = Image::from_fn(61, 61, |x, y| {
            let (x, y) = ((x as f64 - 30.3) / 16.0, (y as f64 - 29.6) / 16.0);
            (0.5 + 0.25 * x * y + 0.0625 * (x * x - y * y)) as f32
        });
        for spec in ["saddle:sigma=0", "saddle:window=11", "saddle:window=3,sigma=0.5"] {
            let found = operator(spec).measure(&image, &Start::at(PixelPoint::new(31.0, 28.0))).unwrap();
            assert!(found.position.distance(PixelPoint::new(30.3, 29.6)) < 1e-4, "{spec}: {found:?}");
        }
    }

    #[test]
    fn a_symmetric_chess_corner_is_found_where_it_is() {
        // Away from the middle of its pixel the window is not symmetric about the corner, and the surface is not quadratic: some hundredths.
        for (angle, cx, cy, tolerance) in [(0.3_f64, 30.0, 30.0, 1e-6), (0.7, 30.31, 29.84, 0.06)] {
            let (sin, cos) = angle.sin_cos();
            let image = Image::from_fn(61, 61, |x, y| {
                let (dx, dy) = (x as f64 - cx, y as f64 - cy);
                (0.5 + 0.3 * (0.9 * (dx * cos + dy * sin)).tanh() * (0.9 * (dy * cos - dx * sin)).tanh()) as f32
            });
            for (sx, sy) in [(32.0, 28.0), (28.5, 31.5)] {
                let found = operator("saddle").measure(&image, &Start::at(PixelPoint::new(sx, sy))).unwrap();
                assert!(found.position.distance(PixelPoint::new(cx, cy)) < tolerance, "{angle}: {found:?}");
            }
        }
    }

    #[test]
    fn a_hill_is_no_saddle() {
        let image = Image::from_fn(61, 61, |x, y| (-((x as f64 - 30.0).powi(2) + (y as f64 - 30.0).powi(2)) / 50.0).exp() as f32);
        assert_eq!(operator("saddle").measure(&image, &Start::at(PixelPoint::new(30.0, 30.0))), Err(Rejection::NoCorner));
    }
}
