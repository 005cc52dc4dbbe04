//! `forstner`: the point closest to all edge lines of a window, in one pass.

mod kernel;

use calibench_model::{Covariance, Image, Measurement, PixelPoint, Rejection, Start};

use crate::operator::{Operator, window_centre};
use crate::parameter::{Domain, Parameter};
use crate::registry::{Build, Method};

/// At or below this ratio of the eigenvalues of the normal matrix the window holds a single edge.
///
/// Two edges that differ by `delta` in direction have a ratio of `tan^2(delta / 2)`: 8 degrees reach it. Sobel gradients of one oblique edge,
/// which are up to two degrees off, do not.
const EDGE: f64 = 5e-3;

/// Förstner corner: the point closest, in the least-squares sense, to all edge lines of the window.
///
/// The window of odd side, in pixels, is centred on the pixel nearest to the start; gradients are Sobel, so the image must reach one pixel
/// past the window. One pass: the window does not follow the result. The covariance (px^2) is `sigma0^2 N^-1` with
/// `sigma0^2 = Omega / (m - 2)` from the scatter of the edge lines about the point. On sharp corners that scatter is mostly the pixel
/// grid's, not the noise's: the standard deviation is then several times too large at low noise (7 times at 0.5 % of full scale and a contrast of 60 %, 2 times at 2 %)
/// and right to a factor 1.5 at 5 %.
///
/// Source: Galo et al. 2011, Eq. 5; covariance: Förstner & Gülch 1987.
pub struct Forstner {
    window: usize,
}

const PARAMETERS: &[Parameter] = &[Parameter {
    name: "window",
    about: "side of the window, px",
    domain: Domain::Odd { min: 3, max: 31 },
    default: 11.0,
    always_shown: true,
}];

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "forstner",
        about: "point closest to all edge lines of the window, weighted by the squared Sobel gradient, one pass",
        source: "Galo et al. 2011, Eq. 5; Förstner & Gülch 1987",
        version: "1".into(),
        parameters: PARAMETERS,
        build: Build::With(|settings| Box::new(Forstner::new(settings.whole("window")))),
    }
}

impl Forstner {
    /// The operator with a window of `window` px.
    ///
    /// # Panics
    /// If `window` is not odd and from 3 to 31.
    pub fn new(window: usize) -> Self {
        assert!(window % 2 == 1 && (3..=31).contains(&window), "a window is odd and from 3 to 31 px, found {window}");
        Self { window }
    }
}

impl Operator for Forstner {
    /// # Errors
    /// [`Rejection::Border`] when the window leaves the image, [`Rejection::NotFinite`], [`Rejection::NoCorner`] when the normal matrix has one
    /// vanishing eigenvalue (an edge) or two (a flat patch), [`Rejection::LeftWindow`] when the point is not in the window.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        let half = self.window as i64 / 2;
        let (x, y) = window_centre(image, start, half + 1)?;
        let sums = kernel::sums(image, (x - half - 1) as usize, (y - half - 1) as usize, self.window);
        let (dx, dy, covariance) = solve(&sums, self.window)?;
        if dx.abs() > half as f64 || dy.abs() > half as f64 {
            return Err(Rejection::LeftWindow);
        }
        Ok(Measurement { position: PixelPoint::new(x as f64 + dx, y as f64 + dy), covariance: Some(covariance) })
    }
}

/// Eq. 5 for the accumulated sums: the position from the window's centre and its covariance.
fn solve(s: &kernel::Sums, window: usize) -> Result<(f64, f64, Covariance), Rejection> {
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
    let scale = omega / ((window * window - 2) as f64) / determinant;
    Ok((dx, dy, Covariance { sxx: scale * s.gyy, sxy: -scale * s.gxy, syy: scale * s.gxx }))
}

#[cfg(test)]
mod tests;
