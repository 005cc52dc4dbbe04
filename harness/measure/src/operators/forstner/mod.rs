//! `forstner`: the point closest to all edge lines of a window.

mod kernel;
mod weighted;

use calibench_model::{Covariance, Image, Measurement, PixelPoint, Rejection, Start};

use self::weighted::Gradients;
use crate::operator::{Operator, window_centre};
use crate::parameter::{Parameter, SIGNIFICANCE, Settings};
use crate::registry::{Build, Method};

/// At or below this ratio of the eigenvalues of the normal matrix the window holds a single edge.
///
/// Two edges that differ by `delta` in direction have a ratio of `tan^2(delta / 2)`: 8 degrees reach it. Sobel gradients of one oblique edge,
/// which are up to two degrees off, do not.
const EDGE: f64 = 5e-3;

/// Förstner corner: the point closest, in the least-squares sense, to all edge lines of the window.
///
/// The window of odd side, in pixels, is centred on the pixel nearest to the start; gradients are Sobel, so the image must reach one pixel
/// past the window. One pass, as published, is the default: the window does not follow the result. With more `iterations` it does, until the result stays in
/// its middle pixel. `gauss` weights the gradients by a Gaussian about the start, then about each result, until that moves by less than 1e-3 px.
///
/// Covariance (px^2), `covariance` 0: `sigma0^2 N^-1` with
/// `sigma0^2 = Omega / (m - 2)` from the scatter of the edge lines about the point. On sharp corners that scatter is mostly the pixel
/// grid's, not the noise's: the standard deviation is then several times too large at low noise (7 times at 0.5 % of full scale and a contrast of 60 %, 2 times at 2 %)
/// and right to a factor 1.5 at 5 %. `covariance` 1: the noise of the grey values, given or estimated from the window, is carried
/// through the solution pixel by pixel, to first order: the scatter that noise alone causes, at any level of it (the tests' figures: right to 15 % from 0.5 to 3 %
/// of full scale). Neither holds the bias of the point, which on a sharp corner is larger than both. `N^-1` times the variance of the noise, without the way
/// that noise takes through the gradients, is no covariance of the point: it leaves out how far from the point an edge lies.
///
/// Rejection of what is no corner: in `significance` standard deviations, how far the smaller eigenvalue of the normal matrix is to exceed what noise alone makes it,
/// with the noise as the image shows it; 0, unless photographs are measured, is the operator as published, which takes all of flat noise and a third of bare edges for corners. It is asked where the error ellipse is
/// longer than 0.2 px, as in windows of noise and along edges.
///
/// Rejection by the error ellipse: `roundness` is the least `q = 4 det N / tr^2 N` (1 a circle, 0 a line), `size` the longest semi-axis.
///
/// Source: Galo et al. 2011, Eq. 5; covariance, size and roundness: Förstner & Gülch 1987.
pub struct Forstner {
    window: usize,
    iterations: usize,
    gauss: f64,
    from_noise: bool,
    /// Standard deviation of the noise, 0 if unknown.
    noise: f64,
    roundness: f64,
    /// 0 for any.
    size: f64,
    /// 0 for none.
    significance: f64,
}

/// A point with an error ellipse that is longer, px, may be noise or an edge: noise alone leaves 0.3 to 0.4 px.
const DOUBTFUL: f64 = 0.2;
/// Variance of a Sobel gradient in units of that of the grey values, and the sum over all lags of its squared correlations, which is by how much neighbours
/// make the sum of its squares scatter more.
const GAIN: f64 = 12.0;
const CORRELATED: f64 = 70.0 / 36.0 * 1.5;

/// Step at which a weighted window stops, px.
const STILL: f64 = 1e-3;

const PARAMETERS: &[Parameter] = &[
    Parameter::odd("window", "side of the window, px", [3, 31], 11.0).always_shown(),
    Parameter::whole("iterations", "most passes; from 2 on the window follows the result", [1, 100], 1.0),
    Parameter::real("gauss", "standard deviation of Gaussian weights, px; 0 for equal weights", [0.0, 31.0], 0.0),
    Parameter::named("covariance", "from the scatter of the edge lines, or from the noise of the grey values", &["scatter", "noise"], 0),
    Parameter::real(
        "noise",
        "standard deviation of the noise for covariance=1, as a fraction of full scale; 0 to estimate it",
        [0.0, 1.0],
        0.0,
    ),
    Parameter::real("roundness", "least roundness of the error ellipse, 4 det N / tr^2 N", [0.0, 1.0], 0.0),
    Parameter::real("size", "longest semi-axis of the error ellipse, px; 0 for any", [0.0, 100.0], 0.0),
    Parameter::real(
        SIGNIFICANCE,
        "standard deviations by which the weaker eigenvalue exceeds that of noise, where the error ellipse is longer than 0.2 px; 0: any corner counts",
        [0.0, 100.0],
        0.0,
    ),
];

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "forstner",
        about: "point closest to all edge lines of the window, weighted by the squared Sobel gradient; one pass, or iterated",
        source: "Galo et al. 2011, Eq. 5; Förstner & Gülch 1987",
        version: "1".into(),
        parameters: PARAMETERS,
        build: Build::With(|settings| Box::new(Forstner::with(settings))),
    }
}

impl Forstner {
    /// The operator with a window of `window` px, one pass.
    ///
    /// # Panics
    /// If `window` is not odd and from 3 to 31.
    pub fn new(window: usize) -> Self {
        assert!(window % 2 == 1 && (3..=31).contains(&window), "a window is odd and from 3 to 31 px, found {window}");
        Self { window, iterations: 1, gauss: 0.0, from_noise: false, noise: 0.0, roundness: 0.0, size: 0.0, significance: 0.0 }
    }

    fn with(settings: &Settings) -> Self {
        Self {
            iterations: settings.whole("iterations"),
            gauss: settings.get("gauss"),
            from_noise: settings.get("covariance") > 0.0,
            noise: settings.get("noise"),
            roundness: settings.get("roundness"),
            size: settings.get("size"),
            significance: settings.get("significance"),
            ..Self::new(settings.whole("window"))
        }
    }

    /// One pass: the window around pixel (`x`, `y`), weights about `about` from there.
    fn once(&self, image: &Image, (x, y): (i64, i64), about: (f64, f64)) -> Result<Solution, Rejection> {
        let half = self.window as i64 / 2;
        let plain = self.gauss <= 0.0;
        let gradients = (!plain || self.from_noise).then(|| Gradients::new(image, (x, y), half, self.gauss, about));
        let (sums, count) = match &gradients {
            Some(gradients) if !plain => (gradients.sums(), gradients.weight()),
            _ => (kernel::sums(image, (x - half - 1) as usize, (y - half - 1) as usize, self.window), (self.window * self.window) as f64),
        };
        let (dx, dy, scatter) = solve(&sums, count)?;
        let covariance = match &gradients {
            Some(gradients) if self.from_noise => {
                let variance = if self.noise > 0.0 { Some(self.noise * self.noise) } else { weighted::noise_variance(image, (x, y), half) };
                variance.map(|variance| gradients.covariance(&sums, (dx, dy), variance))
            }
            _ => Some(scatter),
        };
        Ok(Solution { dx, dy, covariance, scatter, sums, count })
    }

    /// The tests of the error ellipse and of significance, of a window around a pixel.
    fn judge(&self, image: &Image, centre: (i64, i64), solution: &Solution) -> Result<(), Rejection> {
        let too_large = self.size > 0.0 && solution.covariance.is_none_or(|covariance| longest(&covariance) > self.size);
        if self.roundness > 0.0 && roundness(&solution.sums) < self.roundness || too_large {
            return Err(Rejection::ErrorEllipse);
        }
        let doubtful = self.significance > 0.0 && longest(&solution.scatter) > DOUBTFUL;
        if doubtful && !self.is_significant(image, centre, solution) { Err(Rejection::NoCorner) } else { Ok(()) }
    }

    /// The variance of the noise, from an area three times as wide as the window where the image has it: the window alone tells the standard deviation to a third.
    fn noise_around(&self, image: &Image, (x, y): (i64, i64)) -> Option<f64> {
        let half = self.window as i64 / 2;
        let room = [x, y, image.width() as i64 - 1 - x, image.height() as i64 - 1 - y]
            .into_iter()
            .fold(3 * half, |least, room| least.min(room - 1));
        weighted::noise_variance(image, (x, y), room.max(half))
    }

    /// Whether the weaker direction holds more than noise does.
    #[inline(never)]
    fn is_significant(&self, image: &Image, centre: (i64, i64), solution: &Solution) -> bool {
        let (sums, count) = (&solution.sums, solution.count);
        let weaker = 0.5 * (sums.gxx + sums.gyy - (sums.gxx - sums.gyy).hypot(2.0 * sums.gxy));
        let noise = if self.noise > 0.0 { Some(self.noise * self.noise) } else { self.noise_around(image, centre) };
        let of_noise = count * GAIN * noise.unwrap_or(0.0);
        weaker > of_noise * (1.0 + self.significance * (2.0 * CORRELATED / count).sqrt())
    }
}

/// What one pass gives, from the window's middle pixel.
struct Solution {
    dx: f64,
    dy: f64,
    covariance: Option<Covariance>,
    /// By the scatter of the edge lines.
    scatter: Covariance,
    sums: kernel::Sums,
    /// The sum of the pixels' weights.
    count: f64,
}

/// Roundness of the error ellipse: 1 a circle, 0 a line.
fn roundness(s: &kernel::Sums) -> f64 {
    4.0 * (s.gxx * s.gyy - s.gxy * s.gxy) / (s.gxx + s.gyy).powi(2)
}

/// The longest semi-axis of an error ellipse, px.
fn longest(c: &Covariance) -> f64 {
    let (mean, difference) = ((c.sxx + c.syy) / 2.0, (c.sxx - c.syy) / 2.0);
    (mean + difference.hypot(c.sxy)).sqrt()
}

impl Operator for Forstner {
    /// # Errors
    /// [`Rejection::Border`] when the window leaves the image, [`Rejection::NotFinite`], [`Rejection::NoCorner`] when the normal matrix has one
    /// vanishing eigenvalue (an edge) or two (a flat patch), [`Rejection::LeftWindow`] when the point is not in the window, or the last window farther
    /// from the first than that is wide; [`Rejection::ErrorEllipse`]; [`Rejection::NotConverged`] when the window still moves after all passes.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        let first = window_centre(image, start, self.window as i64 / 2 + 1)?;
        if self.is_plain() { self.plain(image, first) } else { self.follow(image, start, first) }
    }
}

impl Forstner {
    /// One pass with equal weights, the covariance from the scatter: as published.
    fn is_plain(&self) -> bool {
        self.iterations == 1 && self.gauss <= 0.0 && !self.from_noise
    }

    /// [`Self::once`] for [`Self::is_plain`], without what only the other settings need: it is to cost little more than its sums.
    fn plain(&self, image: &Image, (x, y): (i64, i64)) -> Result<Measurement, Rejection> {
        let half = self.window as i64 / 2;
        let sums = kernel::sums(image, (x - half - 1) as usize, (y - half - 1) as usize, self.window);
        let count = (self.window * self.window) as f64;
        let (dx, dy, covariance) = solve(&sums, count)?;
        if dx.abs() > half as f64 || dy.abs() > half as f64 {
            return Err(Rejection::LeftWindow);
        }
        self.judge(image, (x, y), &Solution { dx, dy, covariance: Some(covariance), scatter: covariance, sums, count })?;
        Ok(Measurement { position: PixelPoint::new(x as f64 + dx, y as f64 + dy), covariance: Some(covariance) })
    }

    /// Passes with a window that follows the result.
    #[inline(never)]
    fn follow(&self, image: &Image, start: &Start, first: (i64, i64)) -> Result<Measurement, Rejection> {
        let half = self.window as i64 / 2;
        let (mut centre, mut before) = (first, first);
        let mut at = start.position;
        for _ in 0..self.iterations {
            let (x, y) = (centre.0 as f64, centre.1 as f64);
            let solution = self.once(image, centre, (at.x - x, at.y - y))?;
            if solution.dx.abs() > half as f64 || solution.dy.abs() > half as f64 {
                return Err(Rejection::LeftWindow);
            }
            let position = PixelPoint::new(x + solution.dx, y + solution.dy);
            let next = position.nearest_pixel().ok_or(Rejection::NotFinite)?;
            // Between two pixels the window may go back and forth for ever: either will do.
            let settled = if self.gauss > 0.0 { position.distance(at) < STILL } else { next == centre || next == before };
            if self.iterations == 1 || settled {
                self.judge(image, centre, &solution)?;
                return Ok(Measurement { position, covariance: solution.covariance });
            }
            if (next.0 - first.0).abs().max((next.1 - first.1).abs()) > self.window as i64 {
                return Err(Rejection::LeftWindow);
            }
            if !image.holds(next.0, next.1, half + 1) {
                return Err(Rejection::Border);
            }
            (before, centre, at) = (centre, next, position);
        }
        Err(Rejection::NotConverged)
    }
}

/// Eq. 5 for the accumulated sums over pixels whose weights sum to `count`: the position from the window's centre and its covariance.
fn solve(s: &kernel::Sums, count: f64) -> Result<(f64, f64, Covariance), Rejection> {
    let trace = s.gxx + s.gyy;
    let determinant = s.gxx * s.gyy - s.gxy * s.gxy;
    if !trace.is_finite() || !determinant.is_finite() {
        return Err(Rejection::NotFinite);
    }
    // For eigenvalues far apart their ratio is det / trace^2.
    if trace <= f64::MIN_POSITIVE || determinant <= EDGE * trace * trace {
        return Err(Rejection::NoCorner);
    }
    let dx = (s.gyy * s.bx - s.gxy * s.by) / determinant;
    let dy = (s.gxx * s.by - s.gxy * s.bx) / determinant;
    let omega = (s.c - s.bx * dx - s.by * dy).max(0.0);
    let scale = omega / (count - 2.0).max(1.0) / determinant;
    Ok((dx, dy, Covariance { sxx: scale * s.gyy, sxy: -scale * s.gxy, syy: scale * s.gxx }))
}

#[cfg(test)]
mod significance;
#[cfg(test)]
mod tests;
